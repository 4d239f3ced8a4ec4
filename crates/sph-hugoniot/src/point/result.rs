//! What a point is worth when it ends: the mean profile, the states that are read from it, and what is doubtful.

use sph_window::search::bisection::{self, Trial};

use super::Point;
use crate::observe::{Fields, FrontProfile, States};
use crate::outcome::{PointOutcome, Status};
use crate::separation;
use crate::settle;
use crate::statistics::harmonic_mean;

impl Point<'_> {
    /// The mean profile of the blocks that count.
    fn profile(&self) -> Option<FrontProfile> {
        let full = self.full_blocks().min(self.progress.profiles.len());
        let counted = match full {
            0 => &self.progress.profiles[..],
            n => &self.progress.profiles[n.saturating_sub(self.blocks())..n],
        };
        let (first, rest) = counted.split_first()?;
        let mut sum = first.clone();
        rest.iter().for_each(|p| sum.merge(p));
        (sum.looks() > 0).then_some(sum)
    }

    /// What the point leaves, ended with this status.
    pub(super) fn outcome(&self, status: Status) -> PointOutcome {
        let window = &self.window;
        let cells = self.counted_cells();
        let profile = self.profile();
        let margins = window.settings().plateau;
        let (cell, size) = (self.sample.cell, self.case.medium.particle_size);
        let is_whole = self.full_blocks() > 0;
        let states =
            profile.as_ref().filter(|_| is_whole).and_then(|p| States::read(p, &margins, cell, size));
        let shock_velocity = if cells.is_empty() { f64::NAN } else { harmonic_mean(&cells) };
        let simulation = window.simulation();
        PointOutcome {
            particle_velocity: self.particle_velocity,
            effective_particle_velocity: window.effective_particle_velocity(),
            shock_velocity,
            standard_error: settle::uncertainty(&self.cell_velocities(), &self.case.stop, self.blocks()),
            averaged_cells: cells.len(),
            mass_balance_velocity: states
                .map_or(f64::NAN, |s| s.mass_balance_velocity(self.sample.bulk_density())),
            residuals: states.map(|s| s.residuals(shock_velocity)),
            states,
            fed_cells: window.fed_cells(),
            steps: window.steps(),
            particle_steps: simulation.particle_steps(),
            particles: simulation.particles().len(),
            ledger_residual: window.ledger_residual(),
            cell_velocities: window
                .blocks()
                .iter()
                .map(|b| (b.end, b.swept + b.length, b.velocity()))
                .collect(),
            blocks: self.progress.log.clone(),
            search: window.audit().to_vec(),
            precursor: self.progress.precursor.found(),
            precursor_missing: self.progress.precursor.missing(),
            precursor_residuals: self
                .progress
                .precursor
                .found()
                .map(|p| p.residuals(self.sample.bulk_density())),
            profile_looks: profile.as_ref().map_or(0, FrontProfile::looks),
            profile: profile.map(|p| p.bins()).unwrap_or_default(),
            snapshots: self.progress.snapshots.clone(),
            warnings: if is_whole { self.warnings(states.as_ref()) } else { Vec::new() },
            fields: Fields::of(window),
            monitors: self.progress.monitors.rows().to_vec(),
            film: self.progress.film.frames().to_vec(),
            series: self.progress.series.clone(),
            stages: window.stage_times(),
            status,
            wall_seconds: 0.0,
        }
    }

    /// What is doubtful about the point, each with what to change.
    fn warnings(&self, states: Option<&States>) -> Vec<String> {
        let cells = self.case.window.cells_at(self.particle_velocity);
        let place = self.case.window.front_place;
        let Some(states) = states else {
            return vec![format!(
                "the window of {cells} cells leaves no room for a state behind the front and one ahead of it; hint: \
                 window: (length: Cells({}))",
                2 * cells
            )];
        };
        let case = self.case;
        let precursor = self.progress.precursor.found();
        let one_wave = separation::finding(
            &case.materials(),
            case.medium.porosity,
            self.particle_velocity,
            harmonic_mean(&self.counted_cells()),
            precursor.as_ref(),
        );
        let search = search_warnings(self.window.audit(), harmonic_mean(&self.counted_cells()));
        one_wave.into_iter().chain(search).chain(states.warnings(self.sample.cell, cells, place)).collect()
    }
}

/// u_in of a bisection that is farther from u_s of the front's way than this part of it is doubted.
const SEARCH_MISS: f64 = 0.02;

/// What is doubtful about a bisection that ended with u_s [m/s] of the front's way.
fn search_warnings(trials: &[Trial], shock_velocity: f64) -> Vec<String> {
    let mut list = Vec::new();
    let moved = trials.iter().filter(|t| t.decision == bisection::Decision::Moved).count();
    if moved > 0 {
        list.push(format!(
            "the bisection moved its bracket {moved} times: no result stood within it; hint: more samples a trial, or a \
             bracket that holds u_s - u_p"
        ));
    }
    let found = trials.iter().rfind(|t| t.decision == bisection::Decision::Found);
    if let Some(u_in) =
        found.map(|t| t.inlet_velocity).filter(|u| (u / shock_velocity - 1.0).abs() > SEARCH_MISS)
    {
        list.push(format!(
            "the bisection ended with u_in = {u_in:.1} m/s, the way of the front gives u_s = {shock_velocity:.1} m/s: the \
             slopes of its trials are noisy; hint: more samples a trial"
        ));
    }
    list
}
