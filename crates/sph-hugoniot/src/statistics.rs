//! Standard error of a mean of correlated values.

/// Fewest batches whose scatter is trusted.
const LEAST_BATCHES: usize = 4;

/// Standard error of the mean of consecutive values by batch means.
///
/// The values are averaged in batches of 1, 2, 4, … values, as long as four batches remain; each batch length gives
/// s/√n from the scatter of its batch means, and the largest counts. Positive correlation makes long batches scatter
/// more than independent values would, so that it is counted; negative correlation (a front that is late in one cell is
/// early in the next) makes them scatter less, and the single values' scatter stays as the safe side.
/// `NaN` for fewer than two values.
///
/// Source: batch means, e.g. H. Flyvbjerg & H. G. Petersen, J. Chem. Phys. 91 (1989) 461.
pub fn standard_error(values: &[f64]) -> f64 {
    if values.len() < 2 {
        return f64::NAN;
    }
    let mut largest = independent_error(values);
    let mut batch = 2;
    while values.len() / batch >= LEAST_BATCHES {
        // The newest values count: the remainder at the start is left out.
        let start = values.len() % batch;
        let means: Vec<f64> = values[start..].chunks(batch).map(mean).collect();
        largest = largest.max(independent_error(&means));
        batch *= 2;
    }
    largest
}

/// s/√n of values taken as independent.
fn independent_error(values: &[f64]) -> f64 {
    let (n, center) = (values.len() as f64, mean(values));
    let squares: f64 = values.iter().map(|v| (v - center).powi(2)).sum();
    (squares / (n - 1.0) / n).sqrt()
}

/// Arithmetic mean, in the unit of the values.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Mean velocity [m/s] over cells of equal length: their length over their time.
pub fn harmonic_mean(velocities: &[f64]) -> f64 {
    1.0 / mean(&velocities.iter().map(|v| 1.0 / v).collect::<Vec<_>>())
}

/// Slope of the least-squares line through consecutive values, per value; zero for fewer than two.
pub(crate) fn line_slope(values: &[f64]) -> f64 {
    let (middle, center) = (0.5 * (values.len() as f64 - 1.0), mean(values));
    let (mut product, mut square) = (0.0, 0.0);
    for (k, value) in values.iter().enumerate() {
        let offset = k as f64 - middle;
        product += offset * (value - center);
        square += offset * offset;
    }
    if square > 0.0 { product / square } else { 0.0 }
}

/// (greatest - least)/mean of the values: how far successive blocks disagree.
pub(crate) fn relative_spread(values: &[f64]) -> f64 {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (greatest - least) / mean(values).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    /// First-order autoregressive noise of variance one.
    fn noise(correlation: f64, n: usize, seed: u64) -> Vec<f64> {
        let mut random = rand_pcg::Pcg64::seed_from_u64(seed);
        let mut value = 0.0;
        let mut next = || {
            let white: f64 = (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
            value = correlation * value + (1.0 - correlation * correlation).sqrt() * white;
            value
        };
        (0..n + 50).map(|_| next()).skip(50).collect()
    }

    /// True standard error of the mean of n values of such noise.
    fn exact(correlation: f64, n: f64) -> f64 {
        ((1.0 + correlation) / (1.0 - correlation) / n).sqrt()
    }

    #[test]
    fn independent_values_give_the_usual_error() {
        let errors: Vec<f64> = (0..200).map(|seed| standard_error(&noise(0.0, 16, seed))).collect();
        let found = mean(&errors) / exact(0.0, 16.0);
        assert!((1.0..1.4).contains(&found), "on the safe side, but not by much: {found}");
    }

    #[test]
    fn correlation_widens_the_error() {
        let errors: Vec<f64> = (0..50).map(|seed| standard_error(&noise(0.8, 512, seed))).collect();
        let found = mean(&errors) / exact(0.8, 512.0);
        assert!((0.8..1.4).contains(&found), "{found}");
        let naive = mean(&(0..50).map(|seed| independent_error(&noise(0.8, 512, seed))).collect::<Vec<_>>());
        assert!(naive < 0.5 * exact(0.8, 512.0), "the naive error is far too small");
    }

    #[test]
    fn anticorrelated_values_keep_their_own_scatter() {
        let values: Vec<f64> = (0..16).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert!(standard_error(&values) > 0.2);
        assert!(standard_error(&values[..1]).is_nan());
        assert!((relative_spread(&[99.0, 101.0]) - 0.02).abs() < 1e-15);
        assert!((line_slope(&[1.0, 3.0, 5.0, 7.0]) - 2.0).abs() < 1e-15 && line_slope(&[4.0]) == 0.0);
        assert!((harmonic_mean(&[2.0, 6.0]) - 3.0).abs() < 1e-15);
    }
}
