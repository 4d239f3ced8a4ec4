//! Wendland C4: w = (1 - q/2)⁶ (1 + 3q + 35/12 q²), -(w')/q = (14/3) (1 - q/2)⁵ (1 + 5/2 q) for q < 2.
//!
//! Normalization 9/(4π) in two dimensions, 495/(256π) in three. Smoother than C2; wants more neighbors.
//!
//! Source: H. Wendland, Adv. Comput. Math. 4 (1995) 389; W. Dehnen & H. Aly, MNRAS 425 (2012) 1068.

use std::f64::consts::PI;

use super::SmoothingKernel;
use super::wendland_c2::distance_to_edge;
use crate::lanes::Real;

/// Wendland C4, support 2 h; formula, normalization and source: [its module](self).
#[derive(Clone, Copy, Debug, Default)]
pub struct WendlandC4;

impl SmoothingKernel for WendlandC4 {
    const SUPPORT: f64 = 2.0;

    #[inline(always)]
    fn value<R: Real>(q: R) -> R {
        let t = distance_to_edge(q);
        let t2 = t * t;
        let polynomial = R::splat(35.0 / 12.0).mul_add(q, R::splat(3.0)).mul_add(q, R::one());
        t2 * t2 * t2 * polynomial
    }

    #[inline(always)]
    fn minus_slope_over_q<R: Real>(q: R) -> R {
        let t = distance_to_edge(q);
        let t2 = t * t;
        t2 * t2 * t * R::splat(35.0 / 3.0).mul_add(q, R::splat(14.0 / 3.0))
    }

    fn normalization(dimension_count: usize) -> f64 {
        match dimension_count {
            2 => 9.0 / (4.0 * PI),
            3 => 495.0 / (256.0 * PI),
            n => super::no_such_dimension(n),
        }
    }
}
