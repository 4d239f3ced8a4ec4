//! From values to places on the canvas, linear or logarithmic.

/// Beyond this no axis is drawn: the arithmetic of ranges and ticks must not overflow.
const LARGEST: f64 = 1e300;

/// An axis's range of values and the stretch of the canvas that shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    /// Least and greatest value shown.
    pub range: (f64, f64),
    /// Where they stand on the canvas.
    pub span: (f64, f64),
    pub log: bool,
}

impl Scale {
    /// Where `value` stands; `None` for what has no place (not finite, or not positive on a logarithmic axis).
    pub fn place(&self, value: f64) -> Option<f64> {
        let (low, high) = (self.transform(self.range.0), self.transform(self.range.1));
        let along = self.transform(value);
        if !along.is_finite() {
            return None;
        }
        let fraction = (along - low) / (high - low);
        // Far outside, the place no longer matters; the limit keeps the back end's arithmetic sound.
        let place = self.span.0 + fraction.clamp(-100.0, 100.0) * (self.span.1 - self.span.0);
        place.is_finite().then_some(place)
    }

    fn transform(&self, value: f64) -> f64 {
        if self.log { value.log10() } else { value }
    }
}

/// The range that shows all `values` with a margin on both sides; `(0, 1)` or `(1, 10)` if there are none.
pub(crate) fn range_of(values: impl Iterator<Item = f64>, log: bool, margin: f64) -> (f64, f64) {
    let usable = values.filter(|value| value.abs() <= LARGEST && (!log || *value > 0.0));
    let (low, high) =
        usable.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    match (low <= high, log) {
        (false, false) => (0.0, 1.0),
        (false, true) => (1.0, 10.0),
        (true, false) => widened(low, high, margin),
        (true, true) => {
            let (low, high) = widened(low.log10(), high.log10(), margin);
            (10f64.powf(low).max(1.0 / LARGEST), 10f64.powf(high).min(LARGEST))
        }
    }
}

/// Adds the margin, and gives a single value a range to stand in.
fn widened(low: f64, high: f64, margin: f64) -> (f64, f64) {
    let size = low.abs().max(high.abs());
    let extent = high - low;
    if extent <= 1e-9 * size || extent == 0.0 {
        let half = if size > 0.0 { 0.1 * size } else { 1.0 };
        return (low - half, high + half);
    }
    (low - margin * extent, high + margin * extent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_ends_and_middle() {
        let log = Scale { range: (1.0, 100.0), span: (0.0, 200.0), log: true };
        assert_eq!(log.place(10.0), Some(100.0));
        assert_eq!(log.place(0.0), None);
        assert_eq!(log.place(f64::INFINITY), None);
        assert_eq!(log.place(-1.0), None);
        let linear = Scale { range: (0.0, 4.0), span: (300.0, 100.0), log: false };
        assert_eq!(linear.place(1.0), Some(250.0));
        assert_eq!(linear.place(f64::NAN), None);
        assert_eq!(linear.place(f64::NEG_INFINITY), None);
    }

    #[test]
    fn ranges_stay_usable_for_odd_data() {
        assert_eq!(range_of([].into_iter(), false, 0.1), (0.0, 1.0));
        assert_eq!(range_of([f64::NAN, 2.0].into_iter(), false, 0.1), (1.8, 2.2));
        assert_eq!(range_of([0.0].into_iter(), false, 0.1), (-1.0, 1.0));
        assert_eq!(range_of([1e-320, 1e300, f64::MAX].into_iter(), true, 0.1), (1e-300, 1e300));
        let (low, high) = range_of([-5.0, 0.0, 1.0, 100.0].into_iter(), true, 0.0);
        assert!((low - 1.0).abs() < 1e-12 && (high - 100.0).abs() < 1e-9);
    }
}
