//! M6 quintic spline: w = (3 - q)⁵₊ - 6 (2 - q)⁵₊ + 15 (1 - q)⁵₊, support 3.
//!
//! -(w')/q is 5 (24 - 24 q² + 10 q³) inside q = 1 and 5 [(3 - q)⁴₊ - 6 (2 - q)⁴₊]/q outside. With p = min(q, 1) and
//! m = max(q, 1) both are
//!
//! ```text
//! -(w')/q = 5 {[(3 - m)⁴₊ - 6 (2 - m)⁴₊] / m + 14 - 24 p² + 10 p³}
//! ```
//!
//! The outer branches are not polynomials, so one division stays, by m ≥ 1.
//!
//! Normalization 7/(478π) in two dimensions, 1/(120π) in three.
//!
//! Source: J. P. Morris, P. J. Fox & Y. Zhu, J. Comput. Phys. 136 (1997) 214.

use std::f64::consts::PI;

use super::SmoothingKernel;
use crate::lanes::Real;

/// M6 quintic spline, support 3 h; formula, normalization and source: [its module](self).
#[derive(Clone, Copy, Debug, Default)]
pub struct Quintic;

impl SmoothingKernel for Quintic {
    const SUPPORT: f64 = 3.0;

    #[inline(always)]
    fn value<R: Real>(q: R) -> R {
        let power = |edge: f64| {
            let t = (R::splat(edge) - q).max(R::zero());
            let t2 = t * t;
            t2 * t2 * t
        };
        power(3.0) - R::splat(6.0) * power(2.0) + R::splat(15.0) * power(1.0)
    }

    #[inline(always)]
    fn minus_slope_over_q<R: Real>(q: R) -> R {
        let (p, m) = (q.min(R::one()), q.max(R::one()));
        let power = |edge: f64| {
            let t = (R::splat(edge) - m).max(R::zero());
            let t2 = t * t;
            t2 * t2
        };
        let outer = (power(3.0) - R::splat(6.0) * power(2.0)) / m;
        // Exactly zero at p = 1.
        let inner = R::splat(10.0).mul_add(p, R::splat(-24.0)).mul_add(p * p, R::splat(14.0));
        R::splat(5.0) * (outer + inner)
    }

    fn normalization(dimension_count: usize) -> f64 {
        match dimension_count {
            2 => 7.0 / (478.0 * PI),
            3 => 1.0 / (120.0 * PI),
            n => super::no_such_dimension(n),
        }
    }
}
