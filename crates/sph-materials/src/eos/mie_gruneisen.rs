//! Mie-Grüneisen equation of state on the solid's linear shock Hugoniot `u_s = c_a + s_a u_p`.
//!
//! ```text
//! P(ρ, e) = P_ref + γ ρ (e - e_ref),      x = ρ0/ρ,      η = 1 - x
//! ```
//!
//! * compression, `x ≤ 1`: `P_ref = ρ0 c_a² η / (1 - s_a η)²`,
//!   `e_ref = ½ [c_a η / (1 - s_a η)]²`: the Rankine-Hugoniot states
//!   `P = ρ0 u_s u_p`, `e = u_p²/2`;
//! * expansion, `x > 1`: `P_ref = ρ0 c_a² η`, `e_ref = ½ c_a² η²`.
//!
//! `P` and `∂P/∂ρ` are continuous at `x = 1`.
//!
//! Differences from the source: paper eq. (6) prints `P_ref` without the square in the denominator;
//! that would not be the Hugoniot which `e_ref` belongs to.
//!
//! # Validity
//!
//! Singular where `1 - s_a η → 0`, that is at `ρ = ρ0 s_a/(s_a - 1)` (3 ρ0 for the
//! copper of the library) if `s_a > 1`: see [`MieGruneisen::density_limit`]. The linear Hugoniot itself
//! is a fit to data, for metals good to particle velocities of a few km/s. `γ` is constant,
//! `γρ` is not; melting and vaporization are absent, so strongly expanded hot states
//! (`x ≳ 1.1`) are only qualitative; with the copper of the library at e = 0, `c_b²` turns
//! negative below `ρ ≈ ρ0/3`.
//!
//! # Source
//!
//! Rublev & Murzov, arXiv 2410.14646, paper eqs. (5) to (7).

use super::Parameter;
use serde::{Deserialize, Serialize};

/// Parameters of the Mie-Grüneisen equation of state; formula, validity and source: [its module](self).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MieGruneisen {
    /// Intercept `c_a` of the linear shock Hugoniot, the bulk sound speed at rest [m/s].
    pub bulk_sound_speed: f64,
    /// Slope `s_a` of the linear shock Hugoniot [1].
    pub hugoniot_slope: f64,
    /// Grüneisen coefficient `γ` [1].
    pub gruneisen_coefficient: f64,
}

/// Reference curve at one density: pressure, energy and their derivatives by `η`.
struct Reference {
    pressure: f64,
    energy: f64,
    pressure_slope: f64,
    energy_slope: f64,
}

impl MieGruneisen {
    #[inline]
    pub(super) fn pressure(&self, rho0: f64, rho: f64, e: f64) -> f64 {
        let eta = 1.0 - rho0 / rho;
        let c_eta = self.bulk_sound_speed * eta;
        let inverse = self.inverse_denominator(eta);
        let u_p = c_eta * inverse; // on the Hugoniot: the particle velocity
        rho0 * self.bulk_sound_speed * u_p * inverse
            + self.gruneisen_coefficient * rho * (e - 0.5 * u_p * u_p)
    }

    /// `1/(1 - s_aη)` in compression, 1 in expansion.
    #[inline]
    fn inverse_denominator(&self, eta: f64) -> f64 {
        1.0 / (1.0 - self.hugoniot_slope * eta.max(0.0))
    }

    #[inline]
    fn reference(&self, rho0: f64, eta: f64) -> Reference {
        let c_squared = self.bulk_sound_speed * self.bulk_sound_speed;
        let inverse = self.inverse_denominator(eta);
        let inverse_squared = inverse * inverse;
        let slope = self.hugoniot_slope * eta.max(0.0);
        Reference {
            pressure: rho0 * c_squared * eta * inverse_squared,
            energy: 0.5 * c_squared * eta * eta * inverse_squared,
            pressure_slope: rho0 * c_squared * (1.0 + slope) * inverse_squared * inverse,
            energy_slope: c_squared * eta * inverse_squared * inverse,
        }
    }

    #[inline]
    pub(super) fn pressure_energy_slope(&self, rho: f64) -> f64 {
        self.gruneisen_coefficient * rho
    }

    #[inline]
    pub(super) fn thermodynamic_sound_speed_squared(&self, rho0: f64, rho: f64, e: f64) -> f64 {
        let x = rho0 / rho;
        let gamma = self.gruneisen_coefficient;
        let reference = self.reference(rho0, 1.0 - x);
        let pressure = reference.pressure + gamma * rho * (e - reference.energy);
        // d(eta)/d(rho) = x / rho
        let cold = (reference.pressure_slope - gamma * rho * reference.energy_slope) * x / rho;
        cold + gamma * (e - reference.energy) + gamma * pressure / rho
    }

    #[inline]
    pub(super) fn reference_bulk_modulus(&self, rho0: f64) -> f64 {
        rho0 * self.bulk_sound_speed * self.bulk_sound_speed
    }

    /// Density [kg/m³] at which `1 - s_a (1 - x)` vanishes; infinite for `s_a ≤ 1`.
    pub fn density_limit(&self, rho0: f64) -> f64 {
        let s = self.hugoniot_slope;
        if s > 1.0 { rho0 * s / (s - 1.0) } else { f64::INFINITY }
    }

    pub(super) fn parameters(&self) -> [Parameter; 3] {
        [
            Parameter::above("bulk_sound_speed", self.bulk_sound_speed, "m/s", 0.0),
            Parameter::at_least("hugoniot_slope", self.hugoniot_slope, "1", 0.0),
            Parameter::at_least("gruneisen_coefficient", self.gruneisen_coefficient, "1", 0.0),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COPPER: MieGruneisen =
        MieGruneisen { bulk_sound_speed: 3930.0, hugoniot_slope: 1.5, gruneisen_coefficient: 1.7 };

    /// A shock of known u_p: P = rho0 u_s u_p must come out of (rho, e) behind it.
    #[test]
    fn reference_curve_is_the_shock_hugoniot() {
        let (rho0, u_p) = (8960.0, 1000.0);
        let u_s = 3930.0 + 1.5 * u_p;
        let pressure = COPPER.pressure(rho0, rho0 * u_s / (u_s - u_p), 0.5 * u_p * u_p);
        assert!((pressure / (rho0 * u_s * u_p) - 1.0).abs() < 1e-13, "{pressure}");
    }

    #[test]
    fn singular_density_of_copper_is_three_times_the_reference() {
        assert_eq!(COPPER.density_limit(8960.0), 3.0 * 8960.0);
        assert!(COPPER.pressure(8960.0, 2.999_999 * 8960.0, 0.0).abs() > 1e18);
    }

    /// x = 1.25, e = 0: P = rho0 c_a^2 (-1/4) - gamma (rho0 / 1.25) c_a^2 / 32, no denominator in expansion.
    #[test]
    fn expansion_has_no_hugoniot_denominator() {
        let bulk_modulus = 8960.0 * 3930.0 * 3930.0;
        let expected = -bulk_modulus * (0.25 + 1.7 / 1.25 / 32.0);
        let pressure = COPPER.pressure(8960.0, 8960.0 / 1.25, 0.0);
        assert!((pressure / expected - 1.0).abs() < 1e-14, "{pressure} {expected}");
    }
}
