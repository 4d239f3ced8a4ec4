//! M4 cubic spline: w = ¼ [(2 - q)³₊ - 4 (1 - q)³₊], support 2.
//!
//! -(w')/q is 3 - 9q/4 inside q = 1 and ¾ (2 - q)²/q outside. With p = min(q, 1) and m = max(q, 1) both are
//!
//! ```text
//! -(w')/q = ¾ [(2 - m)²₊ / m + 3 (1 - p)]
//! ```
//!
//! The outer branch is not a polynomial, so one division stays, by m ≥ 1.
//!
//! Normalization 10/(7π) in two dimensions, 1/π in three.
//!
//! Source: J. J. Monaghan & J. C. Lattanzio, Astron. Astrophys. 149 (1985) 135.

use std::f64::consts::PI;

use super::SmoothingKernel;
use crate::lanes::Real;

/// M4 cubic spline, support 2 h; formula, normalization and source: [its module](self).
#[derive(Clone, Copy, Debug, Default)]
pub struct CubicSpline;

impl SmoothingKernel for CubicSpline {
    const SUPPORT: f64 = 2.0;

    #[inline(always)]
    fn value<R: Real>(q: R) -> R {
        let outer = (R::splat(2.0) - q).max(R::zero());
        let inner = (R::one() - q).max(R::zero());
        R::splat(0.25) * (outer * outer * outer - R::splat(4.0) * (inner * inner * inner))
    }

    #[inline(always)]
    fn minus_slope_over_q<R: Real>(q: R) -> R {
        let (p, m) = (q.min(R::one()), q.max(R::one()));
        let outer = (R::splat(2.0) - m).max(R::zero());
        R::splat(0.75) * (outer * outer / m + R::splat(3.0) * (R::one() - p))
    }

    fn normalization(dimension_count: usize) -> f64 {
        match dimension_count {
            2 => 10.0 / (7.0 * PI),
            3 => 1.0 / PI,
            n => super::no_such_dimension(n),
        }
    }
}
