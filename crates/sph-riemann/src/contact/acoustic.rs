//! The acoustic contact along one direction.
//!
//! Two half-spaces with impedances z_l and z_r, velocities U_l and U_r and traction components t_l and t_r (tension
//! positive) touch. Along the characteristics of a tension-positive medium σ ∓ z U is constant, so that
//!
//! ```text
//! U* = (z_l U_l + z_r U_r + t_r - t_l) / (z_l + z_r)        = U_l + A
//! t* = (z_r t_l + z_l t_r + z_l z_r (U_r - U_l)) / (z_l + z_r) = t_l + z_l A
//! A  = (t_r - t_l + z_r (U_r - U_l)) / (z_l + z_r)
//! ```
//!
//! The contact of two particles is three such problems: along R (from the left to the right particle) with
//! longitudinal impedances ρ c_l, along S and T with transverse ones ρ c_t.
//!
//! Source: Parshikov & Medin, J. Comput. Phys. 180 (2002) 358; Rublev & Murzov, arXiv 2410.14646, section 2. The paper
//! prints the contact formulas with the signs of a compression-positive stress (−σ_r + σ_l, −z_l z_r (U_r − U_l)); here
//! stress is positive in tension. Valid for waves that are weak against the bulk modulus.

use std::ops::{Add, Div, Mul, Sub};

/// One side of a contact, along one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side<T> {
    /// Impedance z = ρ c [kg/(m² s)].
    pub impedance: T,
    /// Velocity component U [m/s].
    pub velocity: T,
    /// Traction component t [Pa], positive in tension.
    pub traction: T,
}

/// Velocity and traction at the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<T> {
    /// U* [m/s].
    pub velocity: T,
    /// t* [Pa].
    pub traction: T,
}

/// A [m/s]: what the contact adds to the velocity of the left side, from the jumps of traction and velocity.
/// `inverse_sum` is 1/(z_l + z_r).
#[inline(always)]
pub fn velocity_change<T>(traction_jump: T, velocity_jump: T, right_impedance: T, inverse_sum: T) -> T
where
    T: Copy + Add<Output = T> + Mul<Output = T>,
{
    (traction_jump + right_impedance * velocity_jump) * inverse_sum
}

/// Solves the contact of two sides.
#[inline(always)]
pub fn solve<T>(left: Side<T>, right: Side<T>) -> Contact<T>
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Div<Output = T>,
{
    let sum = left.impedance + right.impedance;
    let weighted_velocity = left.impedance * left.velocity + right.impedance * right.velocity;
    let weighted_traction = right.impedance * left.traction + left.impedance * right.traction;
    let shock = left.impedance * right.impedance * (right.velocity - left.velocity);
    Contact {
        velocity: (weighted_velocity + right.traction - left.traction) / sum,
        traction: (weighted_traction + shock) / sum,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEFT: Side<f64> = Side { impedance: 3.0, velocity: 1.5, traction: -2.0 };
    const RIGHT: Side<f64> = Side { impedance: 5.0, velocity: -0.5, traction: 0.25 };

    #[test]
    fn the_contact_lies_on_both_characteristics() {
        let star = solve(LEFT, RIGHT);
        // To the left runs a wave along which t - z U keeps its value, to the right one along which t + z U does.
        let left = star.traction - LEFT.impedance * star.velocity;
        assert!((left - (LEFT.traction - LEFT.impedance * LEFT.velocity)).abs() < 1e-14);
        let right = star.traction + RIGHT.impedance * star.velocity;
        assert!((right - (RIGHT.traction + RIGHT.impedance * RIGHT.velocity)).abs() < 1e-14);
    }

    #[test]
    fn the_change_form_is_the_same_contact() {
        let star = solve(LEFT, RIGHT);
        let a = velocity_change(
            RIGHT.traction - LEFT.traction,
            RIGHT.velocity - LEFT.velocity,
            RIGHT.impedance,
            1.0 / (LEFT.impedance + RIGHT.impedance),
        );
        assert!((LEFT.velocity + a - star.velocity).abs() < 1e-14);
        assert!((LEFT.traction + LEFT.impedance * a - star.traction).abs() < 1e-14);
    }

    #[test]
    fn exchanged_sides_seen_backwards_give_the_same_bits() {
        let back = |s: Side<f64>| Side { velocity: -s.velocity, ..s };
        let (star, mirror) = (solve(LEFT, RIGHT), solve(back(RIGHT), back(LEFT)));
        assert_eq!(star.velocity, -mirror.velocity);
        assert_eq!(star.traction, mirror.traction);
    }
}
