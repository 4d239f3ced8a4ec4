//! Principal Hugoniot: one shock from rest into a strengthless solid, in closed form.
//!
//! With `r = ρ/ρ0`:
//!
//! | equation of state | `u_s(u_p)` |
//! |---|---|
//! | Mie-Grüneisen | `c_a + s_a u_p`, by construction |
//! | linear | `½ u_p + √(¼ u_p² + c0²)`, from `u_s² = c0² r` |
//! | linear-Γ | `w + √(w² + c0²)`, `w = ¼ (Γ + 1) u_p`, from `u_s² = c0² r/(1 - ½(Γ - 1)(r - 1))` |
//! | ideal gas | `½ (γ + 1) u_p`: the strong shock, since it starts from rest at e = 0 |
//! | logarithmic | `r u_p/(r - 1)` with `u_p² = (B/ρ0) ln r (1 - 1/r)`, one root |
//!
//! # Validity
//!
//! A shock outruns its piston, `u_s > u_p`. Mie-Grüneisen with `s_a < 1` does so for `u_p < c_a/(1 - s_a)` only: the density
//! behind grows without bound there, and no faster piston has a shock. The others end where a double no longer tells `u_s`
//! from `u_p`.

use super::check_piston;
use crate::eos::{EquationOfState, Logarithmic};
use crate::error::HugoniotError;
use crate::jump::{Jump, ShockState};
use crate::material::Material;
use crate::root::turning_point;

/// The shock ahead of a piston [m/s] if the solid had no strength.
///
/// # Errors
///
/// [`HugoniotError::PistonVelocity`] for a piston that does not push; [`HugoniotError::BeyondCompressionLimit`] where no shock
/// outruns it, see [the module](self), or a number of the state behind is no longer finite.
pub fn principal(material: &Material, piston_velocity: f64) -> Result<Jump, HugoniotError> {
    check_piston(piston_velocity)?;
    let (rho0, u_p) = (material.reference_density, piston_velocity);
    let u_s = shock_velocity(&material.equation_of_state, rho0, u_p);
    let pressure = rho0 * u_s * u_p;
    let density = rho0 * u_s / (u_s - u_p);
    if !(u_s > u_p && density.is_finite() && pressure.is_finite()) {
        let density_limit = material.equation_of_state.density_limit(rho0);
        return Err(HugoniotError::BeyondCompressionLimit { piston_velocity, density_limit });
    }
    let behind = ShockState {
        density,
        particle_velocity: u_p,
        longitudinal_stress: -pressure,
        pressure,
        specific_internal_energy: 0.5 * u_p * u_p,
    };
    Ok(Jump { ahead: ShockState::at_rest(rho0), behind, wave_speed: u_s })
}

fn shock_velocity(eos: &EquationOfState, rho0: f64, u_p: f64) -> f64 {
    match eos {
        EquationOfState::MieGruneisen(model) => model.bulk_sound_speed + model.hugoniot_slope * u_p,
        EquationOfState::Linear(model) => (0.5 * u_p).hypot(model.bulk_sound_speed) + 0.5 * u_p,
        EquationOfState::LinearGamma(model) => {
            let w = 0.25 * (model.gamma + 1.0) * u_p;
            w + w.hypot(model.bulk_sound_speed)
        }
        EquationOfState::IdealGas(model) => 0.5 * (model.gamma + 1.0) * u_p,
        EquationOfState::Logarithmic(model) => logarithmic_shock_velocity(model, rho0, u_p),
    }
}

/// With `L = ln r`: `L (1 - e^(-L)) = ρ0 u_p²/B`, `u_s = u_p/(1 - e^(-L))`.
fn logarithmic_shock_velocity(model: &Logarithmic, rho0: f64, u_p: f64) -> f64 {
    let mach_squared = rho0 * u_p * u_p / model.bulk_modulus;
    let compression = |log_ratio: f64| -(-log_ratio).exp_m1();
    // L(1 - e^-L) lies above M^2 at L = M^2 + 2 M: about L^2 for small L, about L for large.
    let high = mach_squared + 2.0 * mach_squared.sqrt();
    let log_ratio = turning_point(0.0, high, |l| l * compression(l) >= mach_squared);
    u_p / compression(log_ratio)
}
