//! Exact plane waves ahead of a piston that pushes into a solid at rest.
//!
//! * [`principal()`]: one shock into a strengthless solid, in closed form for each equation of state;
//! * [`piston`]: with strength, one of four structures, see [`PistonWaves`];
//! * [`elastic_limit`]: the Hugoniot elastic limit (HEL) and the precursor that carries it;
//! * [`overdriven_threshold`]: from which piston velocity on the plastic wave swallows the precursor.
//!
//! # Equations
//!
//! Uniaxial strain, Hooke's law in logarithmic strain: `S_xx = -4/3 G ln(ρ/ρ0)` until
//! `|S_xx| = 2/3 Y` at `ρ_ec = ρ0 e^(Y/2G)` (paper eqs. (30), (31)), constant
//! after. Every wave obeys the jump conditions of [`crate::jump`]. Precursor:
//! `D_ec = V0 √(Σ_ec/(V0 - V_ec))`. The plastic wave starts from the precursor's state,
//! not from rest.
//!
//! Differences from the source: its closed form of `D_ec` lacks the `1/ρ0` under the root.
//!
//! # When which structure stands
//!
//! `u_p ≤ u_ec`: one elastic wave. Above, as long as the plastic wave is slower than `D_ec`:
//! two waves. When it would be as fast or faster: one overdriven shock from rest straight to the yielded state.
//! At the threshold both descriptions give the same state, since the three points lie on one Rayleigh line.
//!
//! # Validity
//!
//! Shocks as discontinuities, heat conduction and rate effects left out; elastic and plastic branch each convex
//! in `V`, which holds for constant G and every equation of state here in compression. The thermodynamic
//! limit of the Mie-Grüneisen model with strength is `ρ/ρ0 < 1 + 2/γ` (without strength the
//! singular point is removable, and [`principal()`] goes on to `s_a/(s_a - 1)`; for `s_a < 1` it ends at
//! `u_p = c_a/(1 - s_a)`).

pub mod principal;

pub use principal::principal;

use crate::error::HugoniotError;
use crate::jump::{Jump, ShockState};
use crate::material::Material;
use crate::root::turning_point;
use crate::shock::Adiabat;
use crate::strength::Strength;

/// The waves between a piston and the undisturbed solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PistonWaves {
    /// No strength: one shock.
    Fluid {
        /// The shock.
        shock: Jump,
    },
    /// Below the elastic limit: one elastic wave.
    Elastic {
        /// The elastic wave.
        wave: Jump,
    },
    /// An elastic precursor and a slower plastic wave behind it.
    TwoWave {
        /// From rest to the elastic limit.
        precursor: Jump,
        /// From the elastic limit to the piston.
        plastic: Jump,
    },
    /// One shock that is faster than any precursor.
    Overdriven {
        /// From rest to the piston.
        shock: Jump,
    },
}

impl PistonWaves {
    /// State of the matter at the piston.
    pub fn final_state(&self) -> ShockState {
        self.main_wave().behind
    }

    /// The wave that reaches the piston's velocity.
    pub fn main_wave(&self) -> Jump {
        match *self {
            Self::Fluid { shock } | Self::Overdriven { shock } => shock,
            Self::Elastic { wave } => wave,
            Self::TwoWave { plastic, .. } => plastic,
        }
    }
}

/// Deviatoric stress `-S_xx = 2/3 Y` [Pa] of uniaxial compression at yield.
fn yielded_shear_stress(material: &Material) -> f64 {
    2.0 / 3.0 * material.strength.yield_strength()
}

/// `-S_xx` [Pa] of elastic uniaxial compression to a density [kg/m³].
fn elastic_shear_stress(material: &Material, density: f64) -> f64 {
    4.0 / 3.0 * material.strength.shear_modulus() * (density / material.reference_density).ln()
}

/// The elastic precursor: from rest to the Hugoniot elastic limit.
///
/// # Errors
///
/// [`HugoniotError::NoElasticLimit`] unless the strength is perfectly plastic; [`HugoniotError::ElasticLimitTooDense`] where
/// `Y/2G` is so great that no shock from rest reaches `ρ_ec`.
pub fn elastic_limit(material: &Material) -> Result<Jump, HugoniotError> {
    let Strength::PerfectPlastic { shear_modulus, yield_strength } = material.strength else {
        return Err(HugoniotError::NoElasticLimit { material: material.name.clone() });
    };
    let density = material.reference_density * (yield_strength / (2.0 * shear_modulus)).exp();
    if density <= material.reference_density {
        // So weak that its limit is lost in round-off: there is no jump to speak of.
        return Err(HugoniotError::NoElasticLimit { material: material.name.clone() });
    }
    let ahead = ShockState::at_rest(material.reference_density);
    let shear_stress = |_: f64| yielded_shear_stress(material);
    Adiabat { material, ahead, shear_stress }
        .to_density(density)
        .ok_or_else(|| HugoniotError::ElasticLimitTooDense { material: material.name.clone(), density })
}

/// The waves ahead of a piston of the given velocity [m/s] in a solid at rest.
///
/// # Errors
///
/// A piston that does not push, or one so fast that no state moves with it; those of [`elastic_limit`] but
/// [`HugoniotError::NoElasticLimit`].
pub fn piston(material: &Material, piston_velocity: f64) -> Result<PistonWaves, HugoniotError> {
    check_piston(piston_velocity)?;
    match material.strength {
        Strength::Fluid => Ok(PistonWaves::Fluid { shock: principal(material, piston_velocity)? }),
        Strength::Elastic { .. } => elastic_wave(material, piston_velocity),
        Strength::PerfectPlastic { .. } => {
            let precursor = elastic_limit(material)?;
            if piston_velocity <= precursor.behind.particle_velocity {
                return elastic_wave(material, piston_velocity);
            }
            let plastic = plastic_wave(material, precursor.behind, piston_velocity)?;
            if plastic.wave_speed < precursor.wave_speed {
                return Ok(PistonWaves::TwoWave { precursor, plastic });
            }
            let rest = ShockState::at_rest(material.reference_density);
            Ok(PistonWaves::Overdriven { shock: plastic_wave(material, rest, piston_velocity)? })
        }
    }
}

/// Least piston velocity [m/s] at which the plastic wave has caught the precursor.
///
/// # Errors
///
/// Those of [`elastic_limit`]; [`HugoniotError::PrecursorTooSlow`] where there is no two-wave structure at all;
/// [`HugoniotError::NeverOverdriven`] where the equation of state ends before.
pub fn overdriven_threshold(material: &Material) -> Result<f64, HugoniotError> {
    let precursor = elastic_limit(material)?;
    let u_ec = precursor.behind.particle_velocity;
    let catches_up = |u_p: f64| {
        plastic_wave(material, precursor.behind, u_p).map(|wave| wave.wave_speed >= precursor.wave_speed)
    };
    let weakest = u_ec * (1.0 + 1e-3);
    if catches_up(weakest)? {
        let plastic_speed = plastic_wave(material, precursor.behind, weakest)?.wave_speed;
        return Err(HugoniotError::PrecursorTooSlow { precursor_speed: precursor.wave_speed, plastic_speed });
    }
    let mut low = weakest;
    // A wave slower than the precursor cannot carry matter faster than the precursor.
    while low < precursor.wave_speed {
        let high = 1.1 * low;
        match catches_up(high) {
            Ok(false) => low = high,
            Ok(true) => return Ok(turning_point(low, high, |u_p| catches_up(u_p).unwrap_or(true))),
            Err(_) => break,
        }
    }
    Err(HugoniotError::NeverOverdriven { searched_to: low })
}

fn elastic_wave(material: &Material, piston_velocity: f64) -> Result<PistonWaves, HugoniotError> {
    let ahead = ShockState::at_rest(material.reference_density);
    let shear_stress = |density: f64| elastic_shear_stress(material, density);
    let wave = Adiabat { material, ahead, shear_stress }.to_velocity(piston_velocity)?;
    Ok(PistonWaves::Elastic { wave })
}

fn plastic_wave(material: &Material, ahead: ShockState, piston_velocity: f64) -> Result<Jump, HugoniotError> {
    let shear_stress = |_: f64| yielded_shear_stress(material);
    Adiabat { material, ahead, shear_stress }.to_velocity(piston_velocity)
}

/// A piston must push.
pub(crate) fn check_piston(piston_velocity: f64) -> Result<(), HugoniotError> {
    if piston_velocity.is_finite() && piston_velocity > 0.0 {
        Ok(())
    } else {
        Err(HugoniotError::PistonVelocity { value: piston_velocity })
    }
}
