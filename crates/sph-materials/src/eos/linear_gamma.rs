//! Linear equation of state with a thermal part of ideal-gas form.
//!
//! \\[ P = c_0^2 (\rho - \rho_0) + (\Gamma - 1)\, \rho\, e \\]
//!
//! Thermodynamic sound speed: \\( c_b^2 = c_0^2 + (\Gamma - 1)\, e + (\Gamma - 1)\, P/\rho \\); quasi-acoustic:
//! \\( c_b^2 = \rho_0 c_0^2/\rho \\).
//!
//! # Validity
//!
//! All positive densities as a formula; \\( c_b^2 \\) stays positive unless the matter is far expanded
//! (\\( P < -\rho c_0^2/(\Gamma - 1) \\) at e = 0). One shock from rest cannot compress beyond
//! \\( \rho/\rho_0 = 1 + 2/(\Gamma - 1) \\). As physics: moderate compression, heat of plastic work included.
//!
//! # Source
//!
//! Rublev & Murzov, arXiv 2410.14646, section 2.1.3.

use super::Parameter;
use serde::{Deserialize, Serialize};

/// Parameters of the model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinearGamma {
    /// Bulk sound speed \\( c_0 \\) of the cold material [m/s].
    pub bulk_sound_speed: f64,
    /// \\( \Gamma \\); the Grüneisen coefficient is \\( \Gamma - 1 \\) [1].
    pub gamma: f64,
}

impl LinearGamma {
    #[inline]
    pub(super) fn pressure(&self, rho0: f64, rho: f64, e: f64) -> f64 {
        self.bulk_sound_speed * self.bulk_sound_speed * (rho - rho0) + (self.gamma - 1.0) * rho * e
    }

    #[inline]
    pub(super) fn pressure_energy_slope(&self, rho: f64) -> f64 {
        (self.gamma - 1.0) * rho
    }

    #[inline]
    pub(super) fn thermodynamic_sound_speed_squared(&self, rho0: f64, rho: f64, e: f64) -> f64 {
        let c0_squared = self.bulk_sound_speed * self.bulk_sound_speed;
        c0_squared + (self.gamma - 1.0) * (e + self.pressure(rho0, rho, e) / rho)
    }

    #[inline]
    pub(super) fn reference_bulk_modulus(&self, rho0: f64) -> f64 {
        rho0 * self.bulk_sound_speed * self.bulk_sound_speed
    }

    pub(super) fn parameters(&self) -> [Parameter; 2] {
        [
            Parameter::above("bulk_sound_speed", self.bulk_sound_speed, "m/s", 0.0),
            Parameter::at_least("gamma", self.gamma, "1", 1.0),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_adds_to_the_cold_pressure() {
        let eos = LinearGamma { bulk_sound_speed: 5328.0, gamma: 2.0 };
        let pressure = eos.pressure(2785.0, 2800.0, 1e4);
        assert_eq!(pressure, 5328.0 * 5328.0 * 15.0 + 2800.0 * 1e4);
    }
}
