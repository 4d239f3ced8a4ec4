//! Root of a function of one variable by bisection to the last bit.
//!
//! The shock solutions need a root at most a few times a run: safe matters, fast does not.

/// The point in [`low`, `high`] where `is_above` turns from false to true.
///
/// `is_above(low)` is taken to be false and `is_above(high)` to be true.
pub(crate) fn turning_point(mut low: f64, mut high: f64, is_above: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if is_above(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::turning_point;

    #[test]
    fn square_root_of_two() {
        let root = turning_point(0.0, 2.0, |x| x * x >= 2.0);
        assert!((root - std::f64::consts::SQRT_2).abs() <= f64::EPSILON, "{root}");
    }
}
