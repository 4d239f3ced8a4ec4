//! How a stress deviator turns with the matter.
//!
//! With the velocity gradient `(∇U)_kl = ∂U_k/∂x_l` the spin is its antisymmetric
//! part with the factor one half, `W = ½ (∇U - ∇Uᵀ)`, and the Jaumann rate of Hooke's
//! law reads
//!
//! ```text
//! dS/dt = 2G (D - ⅓ tr(D) I) + W S - S W
//! ```
//!
//! Over one step `τ` with constant spin the last two terms turn S rigidly. [`rotate`] does this with
//! the Cayley transform `R = (I - ½ τ W)⁻¹ (I + ½ τ W)`: a true rotation for any
//! step, about the exact axis, by the angle `2 arctan(ωτ/2)`, so the invariants of S stay and
//! the angle is second-order accurate.
//!
//! Differences from the source: paper eqs. (22), (23) rotate by the full curl and with the opposite sign; a
//! rigid turn would rotate S twice as far and backwards. The array of paper eq. (20) is the transpose of the
//! gradient used here.
//!
//! # Source
//!
//! T. J. R. Hughes & J. Winget, Int. J. Numer. Meth. Engng 15 (1980) 1862-1867 (the Cayley form).

/// A 3 × 3 array, rows first.
pub type Tensor3 = [[f64; 3]; 3];

/// Spin `W = ½ (∇U - ∇Uᵀ)` [1/s] of a velocity gradient
/// `∂U_k/∂x_l` [1/s].
#[inline]
pub fn spin(velocity_gradient: &Tensor3) -> Tensor3 {
    let g = velocity_gradient;
    std::array::from_fn(|k| std::array::from_fn(|l| 0.5 * (g[k][l] - g[l][k])))
}

/// `W S - S W` [Pa/s]: the rate at which spin W [1/s] turns a symmetric S [Pa].
#[inline]
pub fn rotation_rate(spin: &Tensor3, deviator: &Tensor3) -> Tensor3 {
    let (w, s) = (spin, deviator);
    std::array::from_fn(|k| {
        std::array::from_fn(|l| (0..3).map(|n| w[k][n] * s[n][l] - s[k][n] * w[n][l]).sum())
    })
}

/// Jaumann rate of Hooke's law: dS/dt [Pa/s] from the velocity gradient [1/s] and the shear modulus [Pa].
#[inline]
pub fn elastic_rate(deviator: &Tensor3, velocity_gradient: &Tensor3, shear_modulus: f64) -> Tensor3 {
    let g = velocity_gradient;
    let mean = (g[0][0] + g[1][1] + g[2][2]) / 3.0;
    let mut rate = rotation_rate(&spin(g), deviator);
    for k in 0..3 {
        for l in 0..3 {
            let isotropic = if k == l { mean } else { 0.0 };
            rate[k][l] += 2.0 * shear_modulus * (0.5 * (g[k][l] + g[l][k]) - isotropic);
        }
    }
    rate
}

/// Turns a symmetric deviator [Pa] by the spin [1/s] over a time step [s]: `R S Rᵀ`.
#[inline]
pub fn rotate(deviator: &Tensor3, spin: &Tensor3, time_step: f64) -> Tensor3 {
    let r = rotation(spin, time_step);
    let s = deviator;
    let rs: Tensor3 =
        std::array::from_fn(|k| std::array::from_fn(|l| (0..3).map(|n| r[k][n] * s[n][l]).sum()));
    std::array::from_fn(|k| std::array::from_fn(|l| (0..3).map(|n| rs[k][n] * r[l][n]).sum()))
}

/// The Cayley rotation: with `A = ½ τ W` of axial vector a,
/// `R = I + 2 (A + A²)/(1 + a²)`.
#[inline]
fn rotation(spin: &Tensor3, time_step: f64) -> Tensor3 {
    let half = 0.5 * time_step;
    let axis = [half * spin[2][1], half * spin[0][2], half * spin[1][0]];
    let [x, y, z] = axis;
    let factor = 2.0 / (1.0 + x * x + y * y + z * z);
    let a = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let squared = x * x + y * y + z * z;
    std::array::from_fn(|k| {
        std::array::from_fn(|l| {
            let identity = if k == l { 1.0 } else { 0.0 };
            identity + factor * (a[k][l] + axis[k] * axis[l] - identity * squared)
        })
    })
}

/// [`rotate`] in plane strain, turning about z: `(S_xx, S_yy, S_xy)` [Pa] by `W_yx τ`
/// [rad].
///
/// `S_zz` and the sum `S_xx + S_yy` stay as they are.
#[inline]
pub fn rotate_plane(s_xx: f64, s_yy: f64, s_xy: f64, turn: f64) -> (f64, f64, f64) {
    let half = 0.5 * turn;
    let inverse = 1.0 / (1.0 + half * half);
    let (cosine, sine) = ((1.0 - half * half) * inverse, turn * inverse);
    // double angle
    let (cosine_2, sine_2) = (cosine * cosine - sine * sine, 2.0 * sine * cosine);
    let (mean, difference) = (0.5 * (s_xx + s_yy), 0.5 * (s_xx - s_yy));
    let turned = difference * cosine_2 - s_xy * sine_2;
    (mean + turned, mean - turned, s_xy * cosine_2 + difference * sine_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rigid turn about z at 1 rad/s, counter-clockwise: U = (-y, x).
    const TURNING: Tensor3 = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
    /// Deviator with S_xx = 1000 and no shear.
    const PULLED: Tensor3 = [[1000.0, 0.0, 0.0], [0.0, -400.0, 0.0], [0.0, 0.0, -600.0]];

    /// `PULLED` after a turn by an angle about z, by hand.
    fn turned(angle: f64) -> Tensor3 {
        let (mean, half_difference) = (300.0, 700.0);
        let (c, s) = ((2.0 * angle).cos(), (2.0 * angle).sin());
        let xy = half_difference * s;
        [[mean + half_difference * c, xy, 0.0], [xy, mean - half_difference * c, 0.0], [0.0, 0.0, -600.0]]
    }

    fn worst_difference(a: &Tensor3, b: &Tensor3) -> f64 {
        (0..9).map(|n| (a[n / 3][n % 3] - b[n / 3][n % 3]).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_rigid_turn_of_a_fifth_of_a_radian_turns_the_deviator_exactly() {
        let (steps, angle) = (1000, 0.2);
        let mut s = PULLED;
        for _ in 0..steps {
            s = rotate(&s, &spin(&TURNING), angle / f64::from(steps));
        }
        // Cayley: 2 * 700 * (angle^3 / 12 steps^2) = 9.3e-7
        assert!(worst_difference(&s, &turned(angle)) < 1e-6, "{s:?}");
    }

    #[test]
    fn the_printed_rates_turn_it_too_when_integrated_in_small_steps() {
        let (steps, angle) = (20_000, 0.2);
        let mut s = PULLED;
        for _ in 0..steps {
            let rate = elastic_rate(&s, &TURNING, 43e9);
            s = std::array::from_fn(|k| {
                std::array::from_fn(|l| s[k][l] + rate[k][l] * angle / f64::from(steps))
            });
        }
        // explicit Euler: error of the order of 700 * 2 * 0.2^2 / 20,000
        assert!(worst_difference(&s, &turned(angle)) < 5e-3, "{s:?}");
    }

    #[test]
    fn the_angle_is_second_order_accurate() {
        let error = |steps: u32| {
            let mut s = PULLED;
            for _ in 0..steps {
                s = rotate(&s, &TURNING, 0.2 / f64::from(steps));
            }
            worst_difference(&s, &turned(0.2))
        };
        let ratio = error(4) / error(8);
        assert!((ratio - 4.0).abs() < 0.05, "{ratio}");
    }

    #[test]
    fn plane_and_general_rotation_agree() {
        let s = [[3.0, 5.0, 0.0], [5.0, -1.0, 0.0], [0.0, 0.0, -2.0]];
        let general = rotate(&s, &TURNING, 0.3);
        let (xx, yy, xy) = rotate_plane(3.0, -1.0, 5.0, 0.3);
        let plane = [[xx, xy, 0.0], [xy, yy, 0.0], [0.0, 0.0, -2.0]];
        assert!(worst_difference(&general, &plane) < 1e-14, "{general:?} {plane:?}");
    }

    #[test]
    fn shear_strain_gives_hookean_shear_stress() {
        let sheared = [[0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
        let rate = elastic_rate(&[[0.0; 3]; 3], &sheared, 43e9);
        assert_eq!((rate[0][1], rate[1][0], rate[0][0]), (43e9, 43e9, 0.0));
    }
}
