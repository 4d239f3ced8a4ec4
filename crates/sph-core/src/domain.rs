//! The box that particles live in, with any set of periodic axes.

use crate::dimension::{Components, Dimension, Vector};

/// A box. Its bounds matter on periodic axes; on the others they describe, but do not confine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain<D: Dimension> {
    /// Lower corner [m].
    pub lower: D::Vector,
    /// Upper corner [m].
    pub upper: D::Vector,
    /// True on periodic axes.
    pub periodic: D::Axes<bool>,
}

impl<D: Dimension> Domain<D> {
    /// A box between two corners [m] with the given periodic axes.
    pub fn new(lower: D::Vector, upper: D::Vector, periodic: D::Axes<bool>) -> Self {
        Self { lower, upper, periodic }
    }

    /// No periodic axis.
    pub fn open() -> Self {
        Self::new(D::vector(|_| 0.0), D::vector(|_| 0.0), Components::from_fn(|_| false))
    }

    /// Period of an axis [m]; infinite where it is not periodic.
    pub fn period(&self, axis: usize) -> f64 {
        if self.periodic[axis] { self.upper[axis] - self.lower[axis] } else { f64::INFINITY }
    }

    /// Coordinate `x` of an axis moved into the box on a periodic axis, unchanged on others [m].
    pub fn wrap(&self, axis: usize, x: f64) -> f64 {
        if !self.periodic[axis] {
            return x;
        }
        let (lower, period) = (self.lower[axis], self.period(axis));
        let from_lower = x - lower;
        if from_lower >= 0.0 && from_lower < period && x < self.upper[axis] {
            return x; // Most are inside: no division, no rounding.
        }
        let moved = x - period * ((x - lower) / period).floor();
        // Rounding can put a number just below the lower bound on the upper one.
        if moved >= self.upper[axis] { lower } else { moved }
    }

    /// Shortest of the vectors from `a` to the images of `b` [m].
    pub fn displacement(&self, a: D::Vector, b: D::Vector) -> D::Vector {
        D::vector(|k| {
            let d = b[k] - a[k];
            if self.periodic[k] { d - self.period(k) * (d / self.period(k)).round() } else { d }
        })
    }

    /// Shortest distance between the images of two points [m].
    pub fn distance(&self, a: D::Vector, b: D::Vector) -> f64 {
        self.displacement(a, b).length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::Dim2;
    use glam::DVec2;

    #[test]
    fn a_periodic_axis_wraps_and_an_open_one_does_not() {
        let domain = Domain::<Dim2>::new(DVec2::new(-1.0, 0.0), DVec2::new(1.0, 3.0), [true, false]);
        assert_eq!(domain.wrap(0, 1.5), -0.5);
        assert_eq!(domain.wrap(0, -1.0 - 1e-18), -1.0);
        assert_eq!(domain.wrap(1, 7.0), 7.0);
        let d = domain.displacement(DVec2::new(-0.9, 0.0), DVec2::new(0.9, 2.9));
        assert!((d - DVec2::new(-0.2, 2.9)).length() < 1e-15);
    }

    #[test]
    fn the_way_around_the_division_changes_no_bit() {
        let (lower, upper) = (DVec2::new(-0.3, 0.1), DVec2::new(0.7, 0.4));
        let domain = Domain::<Dim2>::new(lower, upper, [true, true]);
        for a in 0..2 {
            let (lower, upper, period) = (lower[a], upper[a], upper[a] - lower[a]);
            let divided = |x: f64| {
                let moved = x - period * ((x - lower) / period).floor();
                if moved >= upper { lower } else { moved }
            };
            let bounds = [lower, upper].into_iter().flat_map(|x| [x.next_down(), x, x.next_up()]);
            for x in bounds.chain((-40..40).map(|k| 0.037 * k as f64)).chain([-0.0, 1e-300, -1e-300]) {
                assert_eq!(domain.wrap(a, x).to_bits(), divided(x).to_bits(), "{x} along axis {a}");
            }
        }
    }
}
