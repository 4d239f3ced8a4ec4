//! Ideal gas with constant specific heats.
//!
//! ```text
//! P = (γ - 1) ρ e
//! ```
//!
//! Thermodynamic sound speed: `c_b² = γ (γ - 1) e`. There is no cold pressure and so no
//! quasi-acoustic speed (B = 0): such a material needs [`crate::SoundSpeedModel::Thermodynamic`], and
//! [`crate::Material::validate`] refuses it without.
//!
//! # Validity
//!
//! Gases far from condensation; e > 0. Here for shock-tube problems of the contact alone, with
//! [`crate::Strength::Fluid`]: a gas at e = 0 has neither pressure nor sound, and no contact can be solved.
//! One shock compresses to `(γ + 1)/(γ - 1)` at most.
//!
//! # Source
//!
//! Ya. B. Zel'dovich and Yu. P. Raizer, Physics of Shock Waves and High-Temperature Hydrodynamic Phenomena, ch. I.

use super::Parameter;
use serde::{Deserialize, Serialize};

/// Parameters of an ideal gas; formula, validity and source: [its module](self).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IdealGas {
    /// Ratio of specific heats `γ` [1].
    pub gamma: f64,
}

impl IdealGas {
    #[inline]
    pub(super) fn pressure(&self, _rho0: f64, rho: f64, e: f64) -> f64 {
        (self.gamma - 1.0) * rho * e
    }

    #[inline]
    pub(super) fn pressure_energy_slope(&self, rho: f64) -> f64 {
        (self.gamma - 1.0) * rho
    }

    #[inline]
    pub(super) fn thermodynamic_sound_speed_squared(&self, _rho0: f64, _rho: f64, e: f64) -> f64 {
        self.gamma * (self.gamma - 1.0) * e
    }

    #[inline]
    pub(super) fn reference_bulk_modulus(&self, _rho0: f64) -> f64 {
        0.0
    }

    pub(super) fn parameters(&self) -> [Parameter; 1] {
        [Parameter::above("gamma", self.gamma, "1", 1.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn air_at_rest() {
        let air = IdealGas { gamma: 1.4 };
        // ρ = 1, P = 1: e = 2.5, c = sqrt(1.4).
        assert!((air.pressure(1.0, 1.0, 2.5) - 1.0).abs() < 1e-15);
        assert!((air.thermodynamic_sound_speed_squared(1.0, 1.0, 2.5) - 1.4).abs() < 1e-15);
    }
}
