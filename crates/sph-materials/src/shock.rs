//! The shock adiabat from any state of a solid whose deviator behind the wave is a known function of density.
//!
//! With `Σ = P + s`, `s = -S_xx`, and `P(ρ, e) = P(ρ, 0) + a(ρ) e`, the
//! energy condition `e_b = e_a + ½ (Σ_a + Σ_b)(V_a - V_b)` is linear in `P_b`:
//!
//! ```text
//! P_b = (P(ρ, e_a) + h (Σ_a + s))/(1 - h),      h = ½ a(ρ)(V_a - V_b)
//! ```
//!
//! `h = 1` is the limit of compression by one shock. Mass and momentum then give the velocity,
//! `Δu² = (Σ_b - Σ_a)(V_a - V_b)`, and one bisection over the density finds the piston's.

use crate::error::HugoniotError;
use crate::jump::{Jump, ShockState};
use crate::material::Material;
use crate::root::turning_point;

/// Widest first step, as a share of the reference density, in the search for a bracket.
const WIDEST_STEP: f64 = 0.02;
/// Growth of the steps.
const STEP_GROWTH: f64 = 1.05;

/// One shock adiabat: a material, the state ahead and `s(ρ)` behind.
pub(crate) struct Adiabat<'a, S> {
    pub material: &'a Material,
    pub ahead: ShockState,
    /// `s = -S_xx` [Pa] behind the wave at a density [kg/m³].
    pub shear_stress: S,
}

impl<S: Fn(f64) -> f64> Adiabat<'_, S> {
    /// `V_a - V_b` [m³/kg], free of cancellation.
    fn volume_loss(&self, density: f64) -> f64 {
        (density - self.ahead.density) / (density * self.ahead.density)
    }

    /// `Σ_b` and `P_b` [Pa] at a density [kg/m³]; none beyond the limit of compression.
    fn stress_and_pressure(&self, density: f64) -> Option<(f64, f64)> {
        let eos = &self.material.equation_of_state;
        let rho0 = self.material.reference_density;
        let h = 0.5 * eos.pressure_energy_slope(density) * self.volume_loss(density);
        if h >= 1.0 || density >= eos.density_limit(rho0) {
            return None;
        }
        let s = (self.shear_stress)(density);
        let sigma_a = -self.ahead.longitudinal_stress;
        let unheated = self.material.pressure(density, self.ahead.specific_internal_energy);
        let pressure = (unheated + h * (sigma_a + s)) / (1.0 - h);
        Some((pressure + s, pressure))
    }

    /// The jump to a given density above the one ahead; none beyond the limit of compression.
    pub fn to_density(&self, density: f64) -> Option<Jump> {
        let (sigma_b, pressure) = self.stress_and_pressure(density)?;
        let sigma_a = -self.ahead.longitudinal_stress;
        let volume_loss = self.volume_loss(density);
        let mass_flux = ((sigma_b - sigma_a) / volume_loss).sqrt();
        let gain = 0.5 * (sigma_a + sigma_b) * volume_loss;
        let behind = ShockState {
            density,
            particle_velocity: self.ahead.particle_velocity + mass_flux * volume_loss,
            longitudinal_stress: -sigma_b,
            pressure,
            specific_internal_energy: self.ahead.specific_internal_energy + gain,
        };
        let wave_speed = self.ahead.particle_velocity + mass_flux / self.ahead.density;
        Some(Jump { ahead: self.ahead, behind, wave_speed })
    }

    /// Whether the matter behind would move at `velocity_jump` [m/s] or faster; true beyond the limit.
    fn is_fast_enough(&self, density: f64, velocity_jump: f64) -> bool {
        let sigma_a = -self.ahead.longitudinal_stress;
        self.stress_and_pressure(density).is_none_or(|(sigma_b, _)| {
            (sigma_b - sigma_a) * self.volume_loss(density) >= velocity_jump * velocity_jump
        })
    }

    /// The jump to the velocity of a piston [m/s], which must exceed that of the state ahead.
    pub fn to_velocity(&self, piston_velocity: f64) -> Result<Jump, HugoniotError> {
        let velocity_jump = piston_velocity - self.ahead.particle_velocity;
        let is_fast_enough = |density: f64| self.is_fast_enough(density, velocity_jump);
        let (low, high) = self.bracket(velocity_jump, is_fast_enough);
        let density = turning_point(low, high, is_fast_enough);
        // none: the turning point is the limit of compression itself
        self.to_density(density)
            .ok_or(HugoniotError::BeyondCompressionLimit { piston_velocity, density_limit: density })
    }

    /// Densities too low and high enough; steps are small so that the first crossing is found.
    fn bracket(&self, velocity_jump: f64, is_fast_enough: impl Fn(f64) -> bool) -> (f64, f64) {
        let rho0 = self.material.reference_density;
        let bulk_modulus = self.material.equation_of_state.reference_bulk_modulus(rho0);
        let mach_number = velocity_jump / (bulk_modulus / rho0).sqrt();
        let mut step = rho0 * mach_number.min(WIDEST_STEP);
        let mut low = self.ahead.density;
        let mut high = self.ahead.density.max(rho0) + step;
        while !is_fast_enough(high) && high.is_finite() {
            low = high;
            high += step;
            step *= STEP_GROWTH;
        }
        (low, high)
    }
}
