//! The states ahead of the compaction wave and behind it, and how well they obey the jump conditions.
//!
//! Behind: the plateau between the front's own width and the layer that feels the outlet. Ahead: what the elastic
//! precursor has passed, between the front's width and the inlet. Velocities are relative to the undisturbed medium, so
//! that u_s is the wave's speed in the frame of both states.
//!
//! The motion that is left in the means (a cellular medium closes its pores by jets) carries momentum and energy: its
//! flux ρ⟨u'²⟩ is added to -σ_xx, its kinetic energy to e, and what it carries out of the front to the balance of energy,
//! before the residuals are taken.

use serde::{Deserialize, Serialize};
use sph_materials::jump::JumpResiduals;
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
    /// Energy flux of that motion along the wave [W/m²].
    pub fluctuation_energy_flux: f64,
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
            fluctuation_energy_flux: bin.fluctuation_energy_flux,
        }
    }
}

impl MeanState {
    /// The state a part of the way toward another.
    pub(super) fn toward(&self, other: &Self, part: f64) -> Self {
        let mix = |value: fn(&Self) -> f64| value(self) + part * (value(other) - value(self));
        Self {
            packing_density: mix(|s| s.packing_density),
            own_density: mix(|s| s.own_density),
            stress: mix(|s| s.stress),
            pressure: mix(|s| s.pressure),
            velocity: mix(|s| s.velocity),
            internal_energy: mix(|s| s.internal_energy),
            fluctuation_energy: mix(|s| s.fluctuation_energy),
            fluctuation_stress: mix(|s| s.fluctuation_stress),
            fluctuation_energy_flux: mix(|s| s.fluctuation_energy_flux),
        }
    }

    /// The state as the jump conditions see it: fluctuations counted as stress and energy.
    pub(super) fn as_shock_state(&self) -> ShockState {
        ShockState {
            density: self.packing_density,
            particle_velocity: self.velocity,
            longitudinal_stress: self.stress - self.fluctuation_stress,
            pressure: self.pressure,
            specific_internal_energy: self.internal_energy + self.fluctuation_energy,
        }
    }
}

/// Packing over own density from which on pores count as shut.
const SHUT: f64 = 0.995;
/// Room ahead of the front that the state there needs: its own margins, and a cell [cells].
const ROOM_AHEAD: f64 = 3.5;
/// Part of the velocity jump within which matter counts as relaxed.
const RELAXED: f64 = 0.02;

/// What stands behind the compaction wave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Zone {
    /// Solid: packing and own density agree to half a percent.
    PoresShut,
    /// A medium with smaller pores.
    PoresOpen,
}

impl std::fmt::Display for Zone {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::PoresShut => "shut",
            Self::PoresOpen => "open",
        })
    }
}

/// Both states.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct States {
    /// Between precursor and compaction wave.
    pub ahead: MeanState,
    /// Behind the compaction wave.
    pub behind: MeanState,
    /// How far behind the front the matter still moves differently from the state behind, over a cell's mean [m].
    pub relaxation_length: f64,
    /// How far behind the front there is room in the window [m].
    pub room_behind: f64,
    /// How far ahead of the front there is room in the window [m].
    pub room_ahead: f64,
}

impl States {
    /// Reads both states from a profile; `None` where the window leaves no room for one of them. `cell` is the edge of
    /// the medium's cell, `particle_size` D [m]; margins in D.
    pub(crate) fn read(
        profile: &FrontProfile,
        margins: &PlateauMargins,
        cell: f64,
        particle_size: f64,
    ) -> Option<Self> {
        let (low, high) = profile.range();
        let behind = profile.between(low + margins.outlet * particle_size, -margins.front * particle_size)?;
        // Ahead the front ends sharply; the last cell before the inlet feels the imposed velocity.
        let ahead = profile.between((2.0 * cell).min(0.4 * high), high - cell.min(0.2 * high))?;
        let relaxation_length = relaxation_length(profile, &ahead, &behind, cell);
        Some(Self {
            ahead: ahead.into(),
            behind: behind.into(),
            relaxation_length,
            room_behind: -low,
            room_ahead: high,
        })
    }

    /// What stands behind the compaction wave.
    pub fn zone(&self) -> Zone {
        let shut = self.behind.packing_density / self.behind.own_density >= SHUT;
        if shut { Zone::PoresShut } else { Zone::PoresOpen }
    }

    /// Volume of pores over volume of space behind the compaction wave [-].
    pub fn pores_left(&self) -> f64 {
        1.0 - self.behind.packing_density / self.behind.own_density
    }

    /// What is doubtful about states in a window of so many cells of a length [m] with the front at this part of it.
    pub fn warnings(&self, cell: f64, window_cells: usize, front_place: f64) -> Vec<String> {
        let mut list = Vec::new();
        let in_cells = |length: f64| length / cell;
        // The state behind is read where the matter has relaxed: three cells of that must be left.
        let needed = self.relaxation_length + 3.0 * cell;
        if needed > self.room_behind {
            let cells = (in_cells(needed + 1.5 * cell) / front_place).ceil().max(window_cells as f64 + 2.0);
            list.push(format!(
                "box too short for the relaxation zone: the matter still relaxes {:.1} cells behind the front, and the \
                 window has room for {:.1}; hint: window: (length: Cells({cells}))",
                in_cells(self.relaxation_length),
                in_cells(self.room_behind),
            ));
        }
        if self.room_ahead < ROOM_AHEAD * cell {
            list.push(format!(
                "the window has room for {:.1} cells ahead of the front, too few for the state behind the precursor; hint: \
                 window: (length: Cells({})), or a smaller front_place than {front_place}",
                in_cells(self.room_ahead),
                (window_cells as f64 * (ROOM_AHEAD + 0.5) * cell / self.room_ahead).ceil(),
            ));
        }
        list
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

    /// By how much the compaction wave, moving with u_s [m/s], misses the conservation laws, motion about the mean counted.
    pub fn residuals(&self, shock_velocity: f64) -> JumpResiduals {
        let residuals = self.jump(shock_velocity).residuals();
        JumpResiduals { energy: residuals.energy + self.energy_carried_off(), ..residuals }
    }

    /// Part of the compaction wave's work, (q_a - q_b)/(Σ_b Δu), that leaves the front as sound and with jets [-]. It turns
    /// into heat farther behind, so e near the front lies below the jump condition by so much.
    pub fn energy_carried_off(&self) -> f64 {
        let flux = self.ahead.fluctuation_energy_flux - self.behind.fluctuation_energy_flux;
        let stress_behind = -self.behind.as_shock_state().longitudinal_stress;
        flux / (stress_behind * (self.behind.velocity - self.ahead.velocity))
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

/// Distance from the front to the farthest cell behind it whose mean velocity is not that of the state behind; the last
/// cell, which feels the outlet, is left out.
fn relaxation_length(profile: &FrontProfile, ahead: &Bin, behind: &Bin, cell: f64) -> f64 {
    let jump = (behind.velocity - ahead.velocity).abs();
    let mut place = profile.range().0 + cell;
    while place + cell <= 0.0 {
        let bin = profile.between(place, place + cell);
        if bin.is_some_and(|bin| (bin.velocity - behind.velocity).abs() > RELAXED * jump) {
            return -place;
        }
        place += 0.5 * cell;
    }
    0.0
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
        let residuals = states.residuals(shock_velocity);
        assert!(residuals.mass.abs() < 1e-12, "{residuals:?}");
        let momentum = 1.6e9 / (6600.0 * shock_velocity * 250.0) - 1.0;
        assert!(
            residuals.momentum.abs() > 0.5 * momentum.abs(),
            "a stress that does not fit is seen: {residuals:?}"
        );
    }

    #[test]
    fn energy_that_sound_carries_backwards_closes_the_balance() {
        let profile = profile_of_step();
        let margins = PlateauMargins { front: 20.0, outlet: 10.0 };
        let mut states = States::read(&profile, &margins, 20.0, 1.0).unwrap();
        let shock_velocity = 9000.0 * 250.0 / (9000.0 - 6600.0);
        let still = states.residuals(shock_velocity).energy;
        // A tenth of the work Σ_b Δu leaves to the left, and is missing in e: u_s ρ00 Δe.
        let work = 1.8e9 * (states.behind.velocity - states.ahead.velocity);
        states.behind.fluctuation_energy_flux = -0.1 * work;
        states.behind.internal_energy -= 0.1 * work / (6600.0 * shock_velocity);
        assert!((states.energy_carried_off() - 0.1).abs() < 1e-12);
        assert!((states.residuals(shock_velocity).energy - still).abs() < 1e-9);
    }

    #[test]
    fn a_window_without_room_gives_nothing() {
        let profile = profile_of_step();
        let margins = PlateauMargins { front: 60.0, outlet: 40.0 };
        assert_eq!(States::read(&profile, &margins, 20.0, 1.0), None);
    }
}
