//! Slope limiters for the reconstruction to the contact.
//!
//! A particle sees a neighbor's value differ by d = Φ_j - Φ_i and its own gradient promise g = ∇Φ_i·r_ji. A limiter
//! returns **half** the limited difference, which is what reconstruction adds:
//!
//! ```text
//! Φ_l = Φ_i + half(d, ∇Φ_i·r_ji),   Φ_r = Φ_j - half(d, ∇Φ_j·r_ji)      (paper eqs. (13)-(15))
//! ```
//!
//! The printed limiter compares d with the central g and is not TVD: it overshoots (2.619 for 2.500 in a sound pulse).
//! The others compare d with the upwind difference u = 2 g - d. The limited differences are, with minmod(a, b, …) the
//! argument of least magnitude where all have one sign, else zero:
//!
//! | limiter | limited difference | source |
//! |---|---|---|
//! | [`MinmodPrinted`] | minmod(d, g) | Rublev & Murzov, arXiv 2410.14646, eqs. (14), (15) |
//! | [`MinmodTvd`] | minmod(d, u) | P. L. Roe, Annu. Rev. Fluid Mech. 18 (1986) 337 |
//! | [`VanLeer`] | 2 d u/(d + u) where d u > 0, else 0 | B. van Leer, J. Comput. Phys. 14 (1974) 361 |
//! | [`MonotonizedCentral`] | minmod(g, 2 d, 2 u) | B. van Leer, J. Comput. Phys. 23 (1977) 276 |
//!
//! Valid for any pair of numbers, zeros and equal ones included.
//!
//! **A new limiter** is a type with [`SlopeLimiter`], one variant of [`Limiter`] and one arm of `with_limiter!`.

use serde::{Deserialize, Serialize};
use sph_core::lanes::Real;

/// Half the limited difference.
pub trait SlopeLimiter: Copy + Send + Sync + 'static {
    /// ½ of the limited difference from d = Φ_j - Φ_i and g = ∇Φ·r_ji, in the unit of Φ.
    fn half<R: Real>(difference: R, gradient: R) -> R;

    /// What [`SlopeLimiter::sides`] wants of the gradients: once or twice what they promise.
    const GRADIENT_MULTIPLE: f64 = 1.0;

    /// Φ_l and Φ_r of a contact from the values of both particles and what their gradients promise, times
    /// [`SlopeLimiter::GRADIENT_MULTIPLE`]. The gradients are not exactly zero: limiters that divide need one division for
    /// both sides.
    #[inline(always)]
    fn sides<R: Real>(left: R, right: R, left_gradient: R, right_gradient: R) -> (R, R) {
        let difference = right - left;
        (left + Self::half(difference, left_gradient), right - Self::half(difference, right_gradient))
    }
}

/// The limiters at hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Limiter {
    /// minmod(d, g): the paper's (14), (15).
    MinmodPrinted,
    /// minmod(d, 2 g - d).
    MinmodTvd,
    /// van Leer's harmonic mean of d and 2 g - d.
    #[default]
    VanLeer,
    /// Monotonized central: minmod(g, 2 d, 2 (2 g - d)).
    MonotonizedCentral,
}

impl Limiter {
    /// Every limiter, in the order of declaration.
    pub const ALL: [Self; 4] =
        [Self::MinmodPrinted, Self::MinmodTvd, Self::VanLeer, Self::MonotonizedCentral];

    /// Half the limited difference, for one pair of numbers d and g, in their unit.
    pub fn half(self, difference: f64, gradient: f64) -> f64 {
        with_limiter!(self, M => M::half(difference, gradient))
    }
}

/// Runs an expression with `M` standing for the type of the limiter.
macro_rules! with_limiter {
    ($limiter:expr, $M:ident => $body:expr) => {
        match $limiter {
            $crate::limiter::Limiter::MinmodPrinted => {
                type $M = $crate::limiter::MinmodPrinted;
                $body
            }
            $crate::limiter::Limiter::MinmodTvd => {
                type $M = $crate::limiter::MinmodTvd;
                $body
            }
            $crate::limiter::Limiter::VanLeer => {
                type $M = $crate::limiter::VanLeer;
                $body
            }
            $crate::limiter::Limiter::MonotonizedCentral => {
                type $M = $crate::limiter::MonotonizedCentral;
                $body
            }
        }
    };
}
pub(crate) use with_limiter;

/// minmod(d, g).
#[derive(Clone, Copy, Debug)]
pub struct MinmodPrinted;
/// minmod(d, 2 g - d).
#[derive(Clone, Copy, Debug)]
pub struct MinmodTvd;
/// Harmonic mean of d and 2 g - d.
#[derive(Clone, Copy, Debug)]
pub struct VanLeer;
/// minmod(g, 2 d, 2 (2 g - d)).
#[derive(Clone, Copy, Debug)]
pub struct MonotonizedCentral;

/// The number of least absolute value if both have one sign, else zero: max(0, min(a, b)) + min(0, max(a, b)).
#[inline(always)]
fn minmod<R: Real>(a: R, b: R) -> R {
    a.min(b).max(R::zero()) + a.max(b).min(R::zero())
}

impl SlopeLimiter for MinmodPrinted {
    #[inline(always)]
    fn half<R: Real>(difference: R, gradient: R) -> R {
        R::splat(0.5) * minmod(difference, gradient)
    }
}

impl SlopeLimiter for MinmodTvd {
    #[inline(always)]
    fn half<R: Real>(difference: R, gradient: R) -> R {
        R::splat(0.5) * minmod(difference, gradient + gradient - difference)
    }
}

impl SlopeLimiter for VanLeer {
    /// With t = d/g the harmonic mean 2 d u/(d + u) is g t (2 - t) where d u > 0, that is where 0 < t < 2. A gradient of
    /// zero gives t = ±∞ or NaN, and `max` turns both into zero.
    #[inline(always)]
    fn half<R: Real>(difference: R, gradient: R) -> R {
        let t = difference / gradient;
        gradient * (t * (R::splat(-0.5).mul_add(t, R::one()))).max(R::zero())
    }

    const GRADIENT_MULTIPLE: f64 = 2.0;

    /// With q = 2 g on each side, one division d/(q_l q_r) gives ½ t = d/q of both. Half the limited difference is
    /// d (1 - ½ t) where 0 < t < 2: where the factor lies between zero and one. Asked for as "less than the next number above
    /// one", which is false for NaN: the machine then takes the comparison as it is, without its opposite.
    #[inline(always)]
    fn sides<R: Real>(left: R, right: R, left_gradient: R, right_gradient: R) -> (R, R) {
        let (zero, one, above_one) = (R::zero(), R::one(), R::splat(1.0_f64.next_up()));
        let minus_difference = left - right;
        let scale = minus_difference / (left_gradient * right_gradient);
        let (l, r) = (scale.mul_add(right_gradient, one), scale.mul_add(left_gradient, one));
        let share_l = l.select_less(above_one, l.max(zero), zero);
        let share_r = r.select_less(above_one, r.max(zero), zero);
        ((-minus_difference).mul_add(share_l, left), minus_difference.mul_add(share_r, right))
    }
}

impl SlopeLimiter for MonotonizedCentral {
    #[inline(always)]
    fn half<R: Real>(difference: R, gradient: R) -> R {
        minmod(R::splat(0.5) * gradient, minmod(difference, gradient + gradient - difference))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_a_straight_line_every_limiter_gives_half_the_difference() {
        for limiter in Limiter::ALL {
            for d in [-3.0, -1e-9, 0.0, 2.5e9] {
                assert_eq!(limiter.half(d, d), 0.5 * d, "{limiter:?}");
            }
        }
    }

    #[test]
    fn at_an_extremum_every_limiter_gives_zero() {
        for limiter in Limiter::ALL {
            assert_eq!(limiter.half(1.0, -0.5), 0.0, "{limiter:?}");
            assert_eq!(limiter.half(1.0, 0.0), 0.0, "{limiter:?}");
            assert_eq!(limiter.half(0.0, 0.0), 0.0, "{limiter:?}");
        }
    }

    #[test]
    fn upwind_limiters_stay_between_the_values() {
        // Φ_l must lie between Φ_i and Φ_j, and not pass the upwind neighbor mirrored: 0 ≤ half ≤ d and half ≤ 2 g - d.
        for limiter in [Limiter::MinmodTvd, Limiter::VanLeer, Limiter::MonotonizedCentral] {
            for k in -40..=40 {
                let g = 0.1 * k as f64;
                let half = limiter.half(1.0, g);
                let upwind = (2.0 * g - 1.0).max(0.0);
                assert!((0.0..=1.0).contains(&half), "{limiter:?} {g} {half}");
                assert!(half <= upwind + 1e-15, "{limiter:?} {g} {half}");
            }
        }
    }

    #[test]
    fn the_printed_limiter_passes_the_upwind_bound() {
        // d = 1, g = 0.6: the neighbor on the other side is only 2 g - d = 0.2 away, and half must not be more.
        let (difference, gradient) = (1.0, 0.6);
        assert_eq!(Limiter::MinmodPrinted.half(difference, gradient), 0.3);
        assert!(Limiter::MinmodTvd.half(difference, gradient) <= 0.1 + 1e-15);
    }

    /// As the pair loop calls it: the gradients times the multiple that the limiter asks for.
    fn sides_of<M: SlopeLimiter>(left: f64, right: f64, l: f64, r: f64) -> (f64, f64) {
        M::sides(left, right, M::GRADIENT_MULTIPLE * l, M::GRADIENT_MULTIPLE * r)
    }

    #[test]
    fn both_sides_at_once_are_the_same_limiter() {
        let values = [-2.0e9, -1.0, -1e-3, 1e-100, 0.5, 1.0, 3.0e9];
        let triples =
            || values.iter().flat_map(|&d| values.iter().flat_map(move |&l| values.map(|r| (d, l, r))));
        for (limiter, (d, l, r)) in
            Limiter::ALL.into_iter().flat_map(|m| triples().map(move |triple| (m, triple)))
        {
            let (left, right) = (0.25, 0.25 + d);
            let both = with_limiter!(limiter, M => sides_of::<M>(left, right, l, r));
            let one = (left + limiter.half(right - left, l), right - limiter.half(right - left, r));
            let near = |a: f64, b: f64| (a - b).abs() <= 4.0 * f64::EPSILON * (b.abs() + d.abs());
            assert!(near(both.0, one.0) && near(both.1, one.1), "{limiter:?} {d} {l} {r}: {both:?} {one:?}");
        }
    }

    #[test]
    fn shares_are_clipped_bit_for_bit_and_nan_gives_zero() {
        let numbers =
            [0.0, -0.0, 1.0, -1.0, 0.5, 1.0_f64.next_up(), 2.0, -3e9, 1e-100, f64::INFINITY, f64::NAN];
        for (right, l, r) in
            numbers.iter().flat_map(|&d| numbers.iter().flat_map(move |&l| numbers.map(|r| (d, l, r))))
        {
            let left: f64 = 0.0;
            let scale = (left - right) / (l * r);
            let clip = |share: f64| if share > 0.0 && share <= 1.0 { share } else { 0.0 };
            let (share_l, share_r) = (clip(scale.mul_add(r, 1.0)), clip(scale.mul_add(l, 1.0)));
            let expected = ((right - left).mul_add(share_l, left), (left - right).mul_add(share_r, right));
            let found = VanLeer::sides(left, right, l, r);
            let bits = |x: f64| if x.is_nan() { 1 } else { x.to_bits() };
            assert_eq!(bits(found.0), bits(expected.0), "{right} {l} {r}");
            assert_eq!(bits(found.1), bits(expected.1), "{right} {l} {r}");
        }
    }

    #[test]
    fn van_leer_is_the_harmonic_mean() {
        let (d, g): (f64, f64) = (0.7, 1.1);
        let u = 2.0 * g - d;
        assert!((Limiter::VanLeer.half(d, g) - d * u / (d + u)).abs() < 1e-15);
    }
}
