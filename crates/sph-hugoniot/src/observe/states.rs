//! The states ahead of the compaction wave and behind it, and how well they obey the jump conditions.
//!
//! Behind: the plateau between the front's own width and the layer that feels the outlet. Ahead: what the elastic
//! precursor has passed, between the front's width and the inlet. Velocities are relative to the undisturbed medium, so
//! that u_s is the wave's speed in the frame of both states.
//!
//! The motion that is left in the means (a cellular medium closes its pores by jets) carries momentum and energy: its
//! flux ρ⟨u'²⟩ is added to -σ_xx, its kinetic energy to e, before the residuals are taken.

use serde::{Deserialize, Serialize};
use sph_materials::{Jump, ShockState};
use sph_window::PlateauMargins;

use super::profile::{Bin, FrontProfile};

/// A mean state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeanState {
    /// Density of the packing [kg/m³].
    pub packing_density: f64,
    /// The particles' own density [kg/m³].
    pub own_density: f64,
    /// σ_xx [Pa].
    pub stress: f64,
    /// P [Pa].
    pub pressure: f64,
    /// Velocity relative to the undisturbed medium [m/s].
    pub velocity: f64,
    /// Specific internal energy [J/kg].
    pub internal_energy: f64,
    /// Kinetic energy of the motion relative to the mean [J/kg].
    pub fluctuation_energy: f64,
    /// Momentum flux of that motion [Pa].
    pub fluctuation_stress: f64,
}

impl From<Bin> for MeanState {
    fn from(bin: Bin) -> Self {
        Self {
            packing_density: bin.packing_density,
            own_density: bin.own_density,
            stress: bin.stress,
            pressure: bin.pressure,
            velocity: bin.velocity,
            internal_energy: bin.internal_energy,
            fluctuation_energy: bin.fluctuation_energy,
            fluctuation_stress: bin.fluctuation_stress,
        }
    }
}

impl MeanState {
    /// The state as the jump conditions see it: fluctuations counted as stress and energy.
    fn as_shock_state(&self) -> ShockState {
        ShockState {
            density: self.packing_density,
            particle_velocity: self.velocity,
            longitudinal_stress: self.stress - self.fluctuation_stress,
            pressure: self.pressure,
            specific_internal_energy: self.internal_energy + self.fluctuation_energy,
        }
    }
}

/// Both states.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct States {
    /// Between precursor and compaction wave.
    pub ahead: MeanState,
    /// Behind the compaction wave.
    pub behind: MeanState,
}

impl States {
    /// Reads both states from a profile; `None` where the window leaves no room for one of them. `cell` is the edge of
    /// the medium's cell, `particle_size` D [m]; margins in D.
    pub fn read(
        profile: &FrontProfile,
        margins: &PlateauMargins,
        cell: f64,
        particle_size: f64,
    ) -> Option<Self> {
        let (low, high) = profile.range();
        let behind = profile.between(low + margins.outlet * particle_size, -margins.front * particle_size)?;
        // Ahead the front ends sharply; the last cell before the inlet feels the imposed velocity.
        let ahead = profile.between((2.0 * cell).min(0.4 * high), high - cell.min(0.2 * high))?;
        Some(Self { ahead: ahead.into(), behind: behind.into() })
    }

    /// Rise of -σ_xx across the compaction wave [Pa].
    pub fn stress_jump(&self) -> f64 {
        self.ahead.stress - self.behind.stress
    }

    /// u_s from the mass of the plateau, Σρu/Σ(ρ - ρ00) [m/s], with the medium's density ρ00 [kg/m³].
    pub fn mass_balance_velocity(&self, bulk_density: f64) -> f64 {
        let behind = &self.behind;
        behind.packing_density * behind.velocity / (behind.packing_density - bulk_density)
    }

    /// The compaction wave as a jump that moves with u_s [m/s].
    pub fn jump(&self, shock_velocity: f64) -> Jump {
        Jump {
            ahead: self.ahead.as_shock_state(),
            behind: self.behind.as_shock_state(),
            wave_speed: shock_velocity,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::profile::tests::profile_of_step;
    use super::*;

    #[test]
    fn an_exact_step_obeys_mass_conservation_and_shows_its_stresses() {
        let profile = profile_of_step();
        let margins = PlateauMargins { front: 20.0, outlet: 10.0 };
        let states = States::read(&profile, &margins, 20.0, 1.0).unwrap();
        let shock_velocity = 9000.0 * 250.0 / (9000.0 - 6600.0);
        assert!((states.mass_balance_velocity(6600.0) / shock_velocity - 1.0).abs() < 1e-12);
        assert!((states.stress_jump() / 1.6e9 - 1.0).abs() < 1e-12);
        let residuals = states.jump(shock_velocity).residuals();
        assert!(residuals.mass.abs() < 1e-12, "{residuals:?}");
        let momentum = 1.6e9 / (6600.0 * shock_velocity * 250.0) - 1.0;
        assert!(
            residuals.momentum.abs() > 0.5 * momentum.abs(),
            "a stress that does not fit is seen: {residuals:?}"
        );
    }

    #[test]
    fn a_window_without_room_gives_nothing() {
        let profile = profile_of_step();
        let margins = PlateauMargins { front: 60.0, outlet: 40.0 };
        assert_eq!(States::read(&profile, &margins, 20.0, 1.0), None);
    }
}
