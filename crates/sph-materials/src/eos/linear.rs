//! Linear equation of state: constant sound speed.
//!
//! ```text
//! P = c0² (ρ - ρ0)
//! ```
//!
//! The energy has no part in it; the thermodynamic sound speed is `c0` at every density, the
//! quasi-acoustic one `c0 √(ρ0/ρ)`.
//!
//! # Validity
//!
//! All positive densities as a formula, with `P → -ρ0 c0²` for `ρ → 0`. As physics:
//! small density changes, sound waves.
//!
//! # Source
//!
//! Rublev & Murzov, arXiv 2410.14646, section 2.1.2.

use super::Parameter;
use serde::{Deserialize, Serialize};

/// Parameters of the linear equation of state; formula, validity and source: [its module](self).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Linear {
    /// Bulk sound speed `c0` [m/s].
    pub bulk_sound_speed: f64,
}

impl Linear {
    #[inline]
    pub(super) fn pressure(&self, rho0: f64, rho: f64, _e: f64) -> f64 {
        self.bulk_sound_speed * self.bulk_sound_speed * (rho - rho0)
    }

    #[inline]
    pub(super) fn pressure_energy_slope(&self, _rho: f64) -> f64 {
        0.0
    }

    #[inline]
    pub(super) fn thermodynamic_sound_speed_squared(&self, _rho0: f64, _rho: f64, _e: f64) -> f64 {
        self.bulk_sound_speed * self.bulk_sound_speed
    }

    #[inline]
    pub(super) fn reference_bulk_modulus(&self, rho0: f64) -> f64 {
        rho0 * self.bulk_sound_speed * self.bulk_sound_speed
    }

    pub(super) fn parameters(&self) -> [Parameter; 1] {
        [Parameter::above("bulk_sound_speed", self.bulk_sound_speed, "m/s", 0.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_kilogram_per_cubic_meter_more() {
        let eos = Linear { bulk_sound_speed: 4148.0 };
        assert_eq!(eos.pressure(8960.0, 8961.0, 0.0), 4148.0 * 4148.0);
    }
}
