//! Wendland C2: w = (1 - q/2)⁴ (1 + 2q), -(w')/q = 5 (1 - q/2)³ for q < 2.
//!
//! Normalization 7/(4π) in two dimensions, 21/(16π) in three. Its Fourier transform is positive, so particles do not
//! pair up. The paper prints no support; 2 h is the usual one.
//!
//! Source: H. Wendland, Adv. Comput. Math. 4 (1995) 389; W. Dehnen & H. Aly, MNRAS 425 (2012) 1068.

use std::f64::consts::PI;

use super::SmoothingKernel;
use crate::lanes::Real;

/// Wendland C2, support 2 h; formula, normalization and source: [its module](self).
#[derive(Clone, Copy, Debug, Default)]
pub struct WendlandC2;

impl SmoothingKernel for WendlandC2 {
    const SUPPORT: f64 = 2.0;

    #[inline(always)]
    fn value<R: Real>(q: R) -> R {
        let t = distance_to_edge(q);
        let t2 = t * t;
        t2 * t2 * R::splat(2.0).mul_add(q, R::one())
    }

    #[inline(always)]
    fn minus_slope_over_q<R: Real>(q: R) -> R {
        let t = distance_to_edge(q);
        R::splat(5.0) * t * (t * t)
    }

    fn normalization(dimension_count: usize) -> f64 {
        match dimension_count {
            2 => 7.0 / (4.0 * PI),
            3 => 21.0 / (16.0 * PI),
            n => super::no_such_dimension(n),
        }
    }
}

/// max(1 - q/2, 0). Exact for q in 1..4, so that it is zero at q = 2 and not before.
#[inline(always)]
pub(super) fn distance_to_edge<R: Real>(q: R) -> R {
    R::splat(-0.5).mul_add(q, R::one()).max(R::zero())
}
