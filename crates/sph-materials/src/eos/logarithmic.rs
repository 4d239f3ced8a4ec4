//! Logarithmic equation of state: constant bulk modulus.
//!
//! ```text
//! P = B ln(ρ/ρ0)
//! ```
//!
//! The energy has no part in it; `c_b² = B/ρ` exactly, so the quasi-acoustic and the thermodynamic
//! sound speed agree. Together with logarithmic strain it makes the elastic-plastic waves of
//! [`crate::hugoniot`] solvable by hand.
//!
//! # Validity
//!
//! All positive densities as a formula. As physics: strains of a few percent, where the rise of the bulk
//! modulus with pressure and the heat of the shock do not count.
//!
//! # Source
//!
//! Rublev & Murzov, arXiv 2410.14646, paper eq. (24).

use super::Parameter;
use serde::{Deserialize, Serialize};

/// Parameters of the logarithmic equation of state; formula, validity and source: [its module](self).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Logarithmic {
    /// Bulk modulus `B` [Pa].
    pub bulk_modulus: f64,
}

impl Logarithmic {
    #[inline]
    pub(super) fn pressure(&self, rho0: f64, rho: f64, _e: f64) -> f64 {
        self.bulk_modulus * (rho / rho0).ln()
    }

    #[inline]
    pub(super) fn pressure_energy_slope(&self, _rho: f64) -> f64 {
        0.0
    }

    #[inline]
    pub(super) fn thermodynamic_sound_speed_squared(&self, _rho0: f64, rho: f64, _e: f64) -> f64 {
        self.bulk_modulus / rho
    }

    #[inline]
    pub(super) fn reference_bulk_modulus(&self, _rho0: f64) -> f64 {
        self.bulk_modulus
    }

    pub(super) fn parameters(&self) -> [Parameter; 1] {
        [Parameter::above("bulk_modulus", self.bulk_modulus, "Pa", 0.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_of_a_doubled_density() {
        let eos = Logarithmic { bulk_modulus: 73e9 };
        let pressure = eos.pressure(2688.9, 2.0 * 2688.9, 1e6);
        assert!((pressure - 50.599_744_180_87e9).abs() < 1.0, "{pressure}");
    }
}
