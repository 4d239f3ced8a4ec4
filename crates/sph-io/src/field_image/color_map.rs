//! From values to colors.

use super::Field;
use crate::Color;

/// Part of the values at each end that a chosen range leaves out: a single hot particle must not bleach the rest.
const LEFT_OUT: f64 = 0.002;

/// A set of colors along a range of values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColorMap {
    /// Dark blue to yellow, perceptually uniform (viridis): for quantities that begin somewhere and grow.
    Sequential,
    /// Black over red to pale yellow, perceptually uniform (inferno): for heat and damage.
    Heat,
    /// Blue over white to red: for signed quantities; white is zero unless a range is given.
    Diverging,
    /// A color for each whole number below this one: for kinds of things, see [`Field::categories`].
    Categories(usize),
}

impl ColorMap {
    /// The color at a fraction of the range, from 0 to 1.
    #[must_use]
    pub fn color(self, fraction: f64) -> Color {
        let t = fraction.clamp(0.0, 1.0);
        let color = match self {
            Self::Sequential => colorous::VIRIDIS.eval_continuous(t),
            Self::Heat => colorous::INFERNO.eval_continuous(t),
            Self::Diverging => colorous::RED_BLUE.eval_continuous(1.0 - t),
            Self::Categories(count) => return category((t * count as f64) as usize, count),
        };
        Color::rgb(color.r, color.g, color.b)
    }

    /// The color of what no particle covers: grays that the map does not contain.
    #[must_use]
    pub const fn void(self) -> Color {
        match self {
            Self::Sequential | Self::Heat => Color::rgb(236, 236, 236),
            Self::Diverging => Color::rgb(190, 190, 190),
            Self::Categories(_) => Color::WHITE,
        }
    }
}

/// The color of a kind: metals first, told apart by color-blind readers too.
fn category(kind: usize, count: usize) -> Color {
    const COLORS: [Color; 6] = [
        Color::rgb(201, 122, 66),
        Color::rgb(96, 125, 160),
        Color::rgb(0, 158, 115),
        Color::rgb(204, 121, 167),
        Color::rgb(240, 190, 60),
        Color::rgb(60, 60, 60),
    ];
    COLORS[kind.min(count.saturating_sub(1)) % COLORS.len()]
}

/// The values at the ends of the color bar.
pub(super) fn range(field: &Field) -> (f64, f64) {
    if let Some(range) = field.range {
        return range;
    }
    if let ColorMap::Categories(count) = field.map {
        return (-0.5, count.max(1) as f64 - 0.5);
    }
    let mut values: Vec<f64> = field.values.iter().copied().filter(|value| value.is_finite()).collect();
    if values.is_empty() {
        return (0.0, 1.0);
    }
    values.sort_unstable_by(f64::total_cmp);
    let last = values.len() - 1;
    let n_left_out = (LEFT_OUT * last as f64) as usize;
    let (low, high) = (values[n_left_out], values[last - n_left_out]);
    match field.map {
        ColorMap::Diverging => with_extent(-low.abs().max(high.abs()), low.abs().max(high.abs())),
        _ => with_extent(low, high),
    }
}

/// A uniform field gets a range around its value.
fn with_extent(low: f64, high: f64) -> (f64, f64) {
    let size = low.abs().max(high.abs());
    if high - low > 1e-9 * size {
        (low, high)
    } else {
        let half = if size > 0.0 { 0.05 * size } else { 1.0 };
        (low - half, high + half)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hot_particle_does_not_set_the_range() {
        let mut values: Vec<f64> = (0..1000).map(f64::from).collect();
        values[500] = 1e9;
        values[501] = f64::NAN;
        let (low, high) = range(&Field::new("e", values, ColorMap::Sequential));
        assert!(low < 3.0 && (990.0..1000.0).contains(&high), "{low} {high}");
    }

    #[test]
    fn signed_fields_are_centered_and_uniform_ones_have_a_range() {
        assert_eq!(range(&Field::new("v", [-3.0, 1.0], ColorMap::Diverging)), (-3.0, 3.0));
        assert_eq!(range(&Field::new("v", [0.0], ColorMap::Diverging)), (-1.0, 1.0));
        assert_eq!(range(&Field::new("v", [10.0], ColorMap::Sequential)), (9.5, 10.5));
        assert_eq!(range(&Field::new("v", [], ColorMap::Sequential)), (0.0, 1.0));
    }

    #[test]
    fn kinds_have_colors_of_their_own() {
        let field = Field::categories("kind", [0.0, 2.0, 1.0], vec!["a".into(), "b".into(), "c".into()]);
        let (low, high) = range(&field);
        let color = |value: f64| field.map.color((value - low) / (high - low));
        assert!(color(0.0) != color(1.0) && color(1.0) != color(2.0) && color(0.0) != color(2.0));
        assert_eq!(color(1.0), category(1, 3));
    }
}
