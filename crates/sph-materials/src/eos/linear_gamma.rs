//! Linear equation of state with a thermal part of ideal-gas form.
//!
//! ```text
//! P = c0² (ρ - ρ0) + (Γ - 1) ρ e
//! ```
//!
//! Thermodynamic sound speed: `c_b² = c0² + (Γ - 1) e + (Γ - 1) P/ρ`; quasi-acoustic:
//! `c_b² = ρ0 c0²/ρ`.
//!
//! # Validity
//!
//! All positive densities as a formula; `c_b²` stays positive unless the matter is far expanded
//! (`P < -ρ c0²/(Γ - 1)` at e = 0). One shock from rest cannot compress beyond
//! `ρ/ρ0 = 1 + 2/(Γ - 1)`. As physics: moderate compression, heat of plastic work included.
//!
//! # Source
//!
//! Rublev & Murzov, arXiv 2410.14646, section 2.1.3.

use super::Parameter;
use serde::{Deserialize, Serialize};

/// Parameters of the linear-Γ equation of state; formula, validity and source: [its module](self).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinearGamma {
    /// Bulk sound speed `c0` of the cold material [m/s].
    pub bulk_sound_speed: f64,
    /// `Γ`; the Grüneisen coefficient is `Γ - 1` [1].
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
