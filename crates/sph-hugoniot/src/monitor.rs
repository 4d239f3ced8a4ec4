//! What is watched in every run: whether the numbers of a point stay what they should be.
//!
//! A row for each cell that the front sweeps: the books of momentum and energy, the most extreme specific internal
//! energies, the packing against the particles' own density, the virtual work of volume consistency, what limited the
//! time step, the share of failed particles, and how often a bound acted. A row costs one pass over the particles.
//!
//! `W = ∫ P |dV|` of the density that volume consistency changed is compared with the energy that the
//! shock puts in, `½ u_p²` of each unit of mass that was swept.

use serde::{Deserialize, Serialize};
use sph_core::{Constraint, Dim2};
use sph_riemann::{Interventions, StepReport, TimeStepReason};
use sph_window::Window;

use crate::observe::{FrontProfile, ProfileGrid, States};

/// The state of a point when its front left a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MonitorRow {
    /// Time [s].
    pub time: f64,
    /// Length of the medium that the front has swept [m].
    pub swept: f64,
    /// Gap of the books of momentum, as a part of all that was booked [-].
    pub momentum_gap: f64,
    /// Gap of the books of energy, as a part of all that was booked [-].
    pub energy_gap: f64,
    /// Largest specific internal energy of a free particle over the mean behind the front; zero before there is one [-].
    pub energy_largest_over_mean: f64,
    /// Least specific internal energy of a free particle [J/kg].
    pub energy_least: f64,
    /// Density of the packing over the particles' own, behind the front at this moment [-].
    pub packing_over_own: f64,
    /// Virtual work of volume consistency since the start, as a share of the energy that the shock put in [-].
    pub relaxation_share: f64,
    /// Share of particles that are failed in tension [-].
    pub failed_share: f64,
    /// Share of particles whose sound speed stands at its floor [-].
    pub floored_share: f64,
    /// Shortest step since the row before [s].
    pub time_step_least: f64,
    /// Mean step since the row before [s].
    pub time_step_mean: f64,
    /// Sound speed of the particle that limited the shortest step [m/s].
    pub limiting_sound_speed: f64,
    /// Its largest speed relative to a neighbor [m/s].
    pub limiting_relative_speed: f64,
    /// Bounds that acted since the start.
    pub interventions: Interventions,
    /// Boosts of frame tracking that were bounded since the start.
    pub boosts_bounded: u64,
}

/// The rows of a point, and the steps since the last of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Monitors {
    rows: Vec<MonitorRow>,
    shortest: Option<Shortest>,
    steps: u64,
    /// Time at the last row [s].
    since: f64,
    /// Whole cells swept at the last row.
    cells: i64,
}

/// The shortest step since the last row.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Shortest {
    time_step: f64,
    sound_speed: f64,
    relative_speed: f64,
}

/// Where the front is, and what medium it sweeps.
#[derive(Clone, Copy, Debug)]
pub struct FrontView {
    /// Place of the front in the box, smoothed [m].
    pub front: f64,
    /// Length that it has swept [m].
    pub swept: f64,
    /// Edge of the medium's cell [m].
    pub cell: f64,
    /// Particle size D [m].
    pub particle_size: f64,
    /// Density ρ00 of the medium [kg/m³].
    pub bulk_density: f64,
}

/// The worst of all rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Largest gap of the books of momentum [-].
    pub momentum_gap: f64,
    /// Largest gap of the books of energy [-].
    pub energy_gap: f64,
    /// Largest specific internal energy over the mean [-].
    pub energy_largest_over_mean: f64,
    /// Least specific internal energy of a free particle [J/kg].
    pub energy_least: f64,
    /// Share of the virtual work at the end [-].
    pub relaxation_share: f64,
    /// Largest share of failed particles [-].
    pub failed_share: f64,
    /// Largest share of particles at the floor of the sound speed [-].
    pub floored_share: f64,
    /// Shortest step [s].
    pub time_step_least: f64,
    /// Bounds that acted, to the end.
    pub interventions: Interventions,
    /// Boosts of frame tracking that were bounded.
    pub boosts_bounded: u64,
}

impl Monitors {
    /// Takes a step in.
    pub fn step(&mut self, report: &StepReport<Dim2>) {
        self.steps += 1;
        let (sound_speed, relative_speed) = match report.reason {
            TimeStepReason::Courant { sound_speed, relative_speed, .. } => (sound_speed, relative_speed),
            TimeStepReason::Limit => (f64::NAN, f64::NAN),
        };
        if self.shortest.is_none_or(|s| report.time_step < s.time_step) {
            self.shortest = Some(Shortest { time_step: report.time_step, sound_speed, relative_speed });
        }
    }

    /// Takes a look: a row if the front has come into another cell.
    pub fn look(&mut self, window: &Window<Dim2>, view: &FrontView) {
        let cells = (view.swept / view.cell).floor() as i64;
        if cells == self.cells {
            return;
        }
        self.rows.push(self.row(window, view));
        (self.cells, self.steps, self.since, self.shortest) = (cells, 0, window.time(), None);
    }

    /// Goes on from an earlier state, at `swept` [m], that a search has come back to: what was seen since the last row was
    /// of a trial, and belongs to no row.
    pub fn take_back(&mut self, window: &Window<Dim2>, swept: f64, cell: f64) {
        let cells = (swept / cell).floor() as i64;
        (self.cells, self.steps, self.since, self.shortest) = (cells, 0, window.time(), None);
    }

    fn row(&self, window: &Window<Dim2>, view: &FrontView) -> MonitorRow {
        let simulation = window.simulation();
        let particles = simulation.particles();
        let [_, momentum_gap, energy_gap] = window.ledger().relative_residuals(&window.content());
        let energy = Energies::of(window, view);
        let input = 0.5 * window.effective_particle_velocity().powi(2) * view.bulk_density * view.swept;
        let n = particles.len() as f64;
        let material = |i: usize| &simulation.materials()[particles.material[i] as usize];
        let is_floored = |i: &usize| {
            material(*i).sound_speed_is_floored(particles.density[*i], particles.specific_internal_energy[*i])
        };
        let shortest = self.shortest.unwrap_or(Shortest {
            time_step: f64::NAN,
            sound_speed: f64::NAN,
            relative_speed: f64::NAN,
        });
        MonitorRow {
            time: window.time(),
            swept: view.swept,
            momentum_gap,
            energy_gap,
            energy_largest_over_mean: energy.ratio(),
            energy_least: energy.least,
            packing_over_own: packing_over_own(window, view),
            relaxation_share: simulation.relaxation_work() / (input * window.sample().cross_section()),
            failed_share: particles.failed.iter().filter(|&&f| f).count() as f64 / n,
            floored_share: (0..particles.len()).filter(is_floored).count() as f64 / n,
            time_step_least: shortest.time_step,
            time_step_mean: (window.time() - self.since) / self.steps as f64,
            limiting_sound_speed: shortest.sound_speed,
            limiting_relative_speed: shortest.relative_speed,
            interventions: simulation.interventions(),
            boosts_bounded: window.boosts_bounded(),
        }
    }

    /// The rows.
    pub fn rows(&self) -> &[MonitorRow] {
        &self.rows
    }
}

/// The worst of some rows; `None` of none.
pub fn worst(rows: &[MonitorRow]) -> Option<Worst> {
    let last = rows.last()?;
    // NaN must show: it is the worst there is.
    let fold = |value: fn(&MonitorRow) -> f64, is_worse: fn(f64, f64) -> bool| {
        rows.iter()
            .map(value)
            .reduce(|a, b| if a.is_nan() || is_worse(a, b) { a } else { b })
            .unwrap_or(f64::NAN)
    };
    let largest = |value| fold(value, |a, b| a >= b);
    let least = |value| fold(value, |a, b| a <= b);
    Some(Worst {
        momentum_gap: largest(|r| r.momentum_gap),
        energy_gap: largest(|r| r.energy_gap),
        energy_largest_over_mean: largest(|r| r.energy_largest_over_mean),
        energy_least: least(|r| r.energy_least),
        relaxation_share: last.relaxation_share,
        failed_share: largest(|r| r.failed_share),
        floored_share: largest(|r| r.floored_share),
        time_step_least: least(|r| r.time_step_least),
        interventions: last.interventions,
        boosts_bounded: last.boosts_bounded,
    })
}

/// Specific internal energies of free particles [J/kg].
struct Energies {
    largest: f64,
    least: f64,
    /// Mean behind the front; `NaN` before there is matter behind it.
    mean: f64,
}

impl Energies {
    fn of(window: &Window<Dim2>, view: &FrontView) -> Self {
        let particles = window.simulation().particles();
        let mut this = Self { largest: f64::NEG_INFINITY, least: f64::INFINITY, mean: f64::NAN };
        let (mut energy, mut mass) = (0.0, 0.0);
        // At start-up the outlet is a piston; what its imposed motion does to its own particles is no state of matter.
        for i in (0..particles.len()).filter(|&i| particles.constraint[i] == Constraint::Free) {
            let e = particles.specific_internal_energy[i];
            this.largest = this.largest.max(e);
            this.least = this.least.min(e);
            if particles.position[0][i] < view.front {
                energy += particles.mass[i] * e;
                mass += particles.mass[i];
            }
        }
        this.mean = energy / mass;
        this
    }

    /// Largest over mean, zero before there is matter behind the front.
    fn ratio(&self) -> f64 {
        if self.mean.is_nan() && self.largest.is_finite() { 0.0 } else { self.largest / self.mean }
    }
}

fn packing_over_own(window: &Window<Dim2>, view: &FrontView) -> f64 {
    let grid = ProfileGrid::new(0.25 * view.cell, window.regions().length);
    let mut profile = FrontProfile::new(grid, window.sample().cross_section());
    profile.observe(window, view.front, 1.0);
    let states = States::read(&profile, &window.settings().plateau, view.cell, view.particle_size);
    states.map_or(f64::NAN, |s| s.behind.packing_density / s.behind.own_density)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(momentum_gap: f64, energy_least: f64) -> MonitorRow {
        MonitorRow { momentum_gap, energy_least, ..MonitorRow::default() }
    }

    #[test]
    fn the_worst_is_the_largest_or_the_least_and_not_a_number_shows() {
        assert_eq!(worst(&[]), None);
        let rows = [row(1e-15, -3.0), row(4e-15, 2.0), row(2e-15, -1.0)];
        let found = worst(&rows).unwrap();
        assert_eq!((found.momentum_gap, found.energy_least), (4e-15, -3.0));
        let broken = [row(1e-15, 0.0), row(f64::NAN, 0.0), row(1e-15, 0.0)];
        assert!(worst(&broken).unwrap().momentum_gap.is_nan());
    }
}
