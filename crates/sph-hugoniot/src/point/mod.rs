//! One point of the Hugoniot: one u_p, run to a steady front.
//!
//! 1. **Start-up.** The window is filled with the medium, the outlet is the piston, the front runs to its place, and what
//!    was compacted on the way leaves through the outlet. Meanwhile the elastic precursor passes and is read
//!    (`observe::PrecursorWatch`). With `search: Bisection` the search runs too.
//! 2. **Blocks.** From then on the front's way through the medium is cut into blocks of whole cells. After each block
//!    [`crate::settle`] says whether the point has settled, and why not; the blocks that agree give u_s, its uncertainty
//!    and the averaged profile. Earlier blocks are dropped.
//! 3. **End.** Settled, or `max_fed_cells` are fed: then the last blocks are reported with the status `not settled`.
//!
//! A step that fails ends the point with the status `failed` and the reason; what was measured until then is kept.
//!
//! A point that is kept on disk ([`crate::restart`]) goes on from its last state, and a point that has ended is not run.

mod result;

use std::time::Instant;

use anyhow::Result;
use serde::{Deserialize, Serialize};
use sph_core::Dim2;
use sph_window::{Observation, Window, WindowError};

use crate::config::Case;
use crate::failure;
use crate::film::Film;
use crate::microstructure::Sample;
use crate::monitor::{FrontView, Monitors};
use crate::observe::{Bin, FrontProfile, PrecursorWatch, ProfileGrid};
use crate::outcome::{PointOutcome, Status};
use crate::restart::Keeper;
use crate::series::SeriesLog;
use crate::settle::{self, BlockRecord, Decision};
use crate::setup;
pub use crate::status::Way;

/// Cells that the front sweeps between two looks at the precursor: it runs several times as fast.
const PRECURSOR_LOOKS: f64 = 0.05;
/// Snapshots of the profile that are kept, one each cell, the newest.
const SNAPSHOTS: usize = 6;
/// Cells over which the place of the front is smoothed for the profiles.
const FRONT_MEMORY: f64 = 2.0;

/// What watches and steers a running point.
pub trait Control: Sync {
    /// True when the point should stop where it is.
    fn interrupted(&self) -> bool;
    /// Told now and then how far the point has come.
    fn progress(&self, way: &Way);
}

/// Runs without being watched.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwatched;

impl Control for Unwatched {
    fn interrupted(&self) -> bool {
        false
    }
    fn progress(&self, _way: &Way) {}
}

/// Runs one point that is kept nowhere; a failure of the method is part of the outcome.
pub fn run(case: &Case, sample: &Sample, particle_velocity: f64, control: &dyn Control) -> PointOutcome {
    run_kept(case, sample, particle_velocity, control, None)
        .unwrap_or_else(|error| PointOutcome::failed(particle_velocity, error.to_string()))
}

/// Runs one point that is kept on disk, or takes it from there if it has ended.
///
/// # Errors
/// If what is kept of the point cannot be read or written.
pub(crate) fn run_kept(
    case: &Case,
    sample: &Sample,
    particle_velocity: f64,
    control: &dyn Control,
    mut keeper: Option<Keeper>,
) -> Result<PointOutcome> {
    if let Some(keeper) = &keeper
        && let Some(outcome) = keeper.outcome()?
    {
        // A process that was killed between the two has left states behind.
        keeper.forget_states()?;
        return Ok(outcome);
    }
    let started = Instant::now();
    let kept = keeper.as_ref().map(|k| k.load(case, sample, particle_velocity)).transpose()?.flatten();
    let point = match kept {
        Some((window, progress)) => Ok(Point { case, sample, particle_velocity, window, progress }),
        None => Point::new(case, sample, particle_velocity),
    };
    let mut outcome = match point {
        Ok(mut point) => {
            let before = point.progress.seconds;
            let status = point.drive(control, &mut keeper, started)?;
            let mut outcome = point.outcome(status);
            outcome.wall_seconds = before;
            outcome
        }
        Err(error) => PointOutcome::failed(particle_velocity, error.to_string()),
    };
    outcome.wall_seconds += started.elapsed().as_secs_f64();
    if let (Some(keeper), false) = (&keeper, outcome.status == Status::Interrupted) {
        keeper.finish(&outcome)?;
    }
    Ok(outcome)
}

/// A point under way.
struct Point<'c> {
    case: &'c Case,
    sample: &'c Sample,
    particle_velocity: f64,
    window: Window<Dim2>,
    progress: PointProgress,
}

/// How far a point has come, beside its window.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct PointProgress {
    last_look: Option<Observation>,
    /// Place of the front, smoothed over [`FRONT_MEMORY`] [m].
    mean_front: f64,
    /// Swept length from which blocks are counted, once known [m].
    blocks_from: Option<f64>,
    /// One profile for each block; the last one is under way.
    profiles: Vec<FrontProfile>,
    /// What is watched.
    monitors: Monitors,
    /// Moments of the front.
    film: Film,
    /// What was written for ParaView.
    series: SeriesLog,
    /// What was concluded from each block.
    log: Vec<BlockRecord>,
    /// The precursor on its first way.
    precursor: PrecursorWatch,
    /// Cells swept when it was looked at last.
    precursor_look: f64,
    /// Profiles of single moments, the newest last.
    snapshots: Vec<Vec<Bin>>,
    /// Time that earlier runs took [s].
    seconds: f64,
}

impl<'c> Point<'c> {
    fn new(case: &'c Case, sample: &'c Sample, particle_velocity: f64) -> Result<Self, WindowError> {
        let feed = setup::feed_sample(sample)?;
        let settings = setup::window_settings(case, particle_velocity);
        let window = Window::new(feed, case.materials(), case.scheme, settings)?;
        Ok(Self { case, sample, particle_velocity, window, progress: PointProgress::default() })
    }

    fn drive(
        &mut self,
        control: &dyn Control,
        keeper: &mut Option<Keeper>,
        started: Instant,
    ) -> Result<Status> {
        loop {
            let interrupted = control.interrupted();
            if let Some(keeper) = keeper.as_mut().filter(|k| interrupted || k.is_due()) {
                let seconds = self.progress.seconds + started.elapsed().as_secs_f64();
                keeper.save(&self.window, &PointProgress { seconds, ..self.progress.clone() })?;
            }
            if interrupted {
                return Ok(Status::Interrupted);
            }
            let observation = match self.window.step() {
                Ok(report) => {
                    self.progress.monitors.step(&report.step);
                    report.observation
                }
                Err(error) => {
                    let folder = keeper.as_ref().map(Keeper::folder);
                    return Ok(Status::Failed(failure::explain(&self.window, &error, self.case, folder)));
                }
            };
            let Some(observation) = observation else { continue };
            let stage = self.stage();
            let status = self.look(&observation);
            if let Some(keeper) = keeper.as_mut().filter(|_| self.stage() != stage) {
                keeper.make_due();
            }
            self.write_moment(observation.swept, keeper.as_ref())?;
            control.progress(&self.way(&observation));
            if let Some(status) = status {
                return Ok(status);
            }
        }
    }

    /// What ends with a state on disk, however short ago the last one was: start-up, each block, each trial of a search.
    fn stage(&self) -> (usize, usize) {
        (self.progress.profiles.len(), self.window.audit().len())
    }

    /// Writes the moment for ParaView, if the case asks for it and the point is kept on disk.
    fn write_moment(&mut self, swept: f64, keeper: Option<&Keeper>) -> Result<()> {
        let (Some(settings), Some(keeper)) = (&self.case.output.snapshots, keeper) else { return Ok(()) };
        let swept_cells = swept / self.sample.cell;
        Ok(self.progress.series.look(settings, &self.window, swept_cells, keeper.folder())?)
    }

    fn way(&self, now: &Observation) -> Way {
        Way {
            swept_cells: now.swept / self.sample.cell,
            expected_cells: self.expected_cells(),
            shock_velocity: self.window.shock_velocity().map_or(f64::NAN, |estimate| estimate.velocity),
        }
    }

    /// Takes a look at the front in; the status if the point has come to its end.
    fn look(&mut self, now: &Observation) -> Option<Status> {
        let before = self.progress.last_look.replace(*now).unwrap_or(*now);
        if now.time < before.time {
            self.progress.monitors.take_back(&self.window, now.swept, self.sample.cell);
        }
        self.watch_precursor(now);
        self.smooth_front(now, &before);
        self.record(now.swept);
        if self.progress.blocks_from.is_none() && self.startup_is_over() {
            self.end_startup(now);
        }
        if let Some(profile) = self.progress.profiles.last_mut() {
            profile.observe(&self.window, self.progress.mean_front, now.time - before.time);
            self.take_snapshot(now, &before);
        }
        if self.progress.blocks_from.is_some() && self.full_blocks() >= self.progress.profiles.len() {
            if self.judge() == Decision::Settled {
                return Some(Status::Settled);
            }
            self.progress.profiles.push(self.new_profile());
        }
        let limit = self.case.stop.max_fed_cells as f64;
        (!self.window.is_searching() && self.window.fed_cells() >= limit).then_some(Status::NotSettled)
    }

    fn watch_precursor(&mut self, now: &Observation) {
        let swept = now.swept / self.sample.cell;
        let is_due = swept - self.progress.precursor_look >= PRECURSOR_LOOKS;
        if self.progress.precursor.is_watching() && is_due {
            self.progress.precursor.observe(&self.window, self.sample.cell);
            self.progress.precursor_look = swept;
        }
    }

    fn end_startup(&mut self, now: &Observation) {
        let (u_p, cells) = (self.particle_velocity, now.swept / self.sample.cell);
        tracing::info!(u_p, cells, "start-up is over");
        self.progress.blocks_from = Some(now.swept);
        self.progress.profiles.push(self.new_profile());
        let blocks = self.window.blocks();
        let before: Vec<f64> = blocks.iter().map(|b| b.velocity()).collect();
        let first = blocks.first().map_or(0.0, |b| b.swept / self.sample.cell);
        self.progress.log = settle::startup_records(&before, first, self.case.stop.block_cells);
    }

    /// Judges the blocks, and logs it.
    fn judge(&mut self) -> Decision {
        let from = self.progress.blocks_from.unwrap_or(0.0);
        let first = self.window.blocks().iter().find(|b| b.swept >= from).map_or(from, |b| b.swept);
        let first = first / self.sample.cell;
        let record = settle::judge(&self.cell_velocities(), first, &self.case.stop, self.blocks());
        let u_p = self.particle_velocity;
        tracing::info!(
            u_p,
            cells = record.to,
            u_s = record.mean,
            error = record.error,
            "{}",
            record.decision
        );
        self.progress.log.push(record);
        record.decision
    }

    /// Keeps the profile of this moment if the front has come into a new cell.
    fn take_snapshot(&mut self, now: &Observation, before: &Observation) {
        let cell = |o: &Observation| (o.swept / self.sample.cell).floor();
        if cell(now) <= cell(before) {
            return;
        }
        let mut profile = self.new_profile();
        profile.observe(&self.window, self.progress.mean_front, 1.0);
        if self.progress.snapshots.len() == SNAPSHOTS {
            self.progress.snapshots.remove(0);
        }
        self.progress.snapshots.push(profile.bins());
    }

    /// The front hops from pore to pore; profiles are taken where it is on the mean of a few cells, so that the pores
    /// pass through them.
    fn smooth_front(&mut self, now: &Observation, before: &Observation) {
        if self.progress.mean_front == 0.0 {
            self.progress.mean_front = now.front;
        }
        // A bisection goes back to its saved state.
        let swept = ((now.swept - before.swept) / self.sample.cell).max(0.0);
        self.progress.mean_front +=
            (1.0 - (-swept / FRONT_MEMORY).exp()) * (now.front - self.progress.mean_front);
    }

    /// Watches, and films the front once start-up is over.
    fn record(&mut self, swept: f64) {
        let (sample, front) = (self.sample, self.progress.mean_front);
        let view = FrontView {
            front,
            swept,
            cell: sample.cell,
            particle_size: self.case.medium.particle_size,
            bulk_density: sample.bulk_density(),
        };
        self.progress.monitors.look(&self.window, &view);
        if self.progress.blocks_from.is_some() {
            self.progress.film.look(&self.window, front, swept, sample.cell);
        }
    }

    fn new_profile(&self) -> FrontProfile {
        let bin = self.sample.cell / self.case.output.bins_per_cell as f64;
        let grid = ProfileGrid::new(bin, self.window.regions().length);
        FrontProfile::new(grid, self.window.sample().cross_section())
    }

    fn startup_is_over(&self) -> bool {
        match self.case.stop.startup_cells {
            None => self.window.is_settled(),
            Some(cells) => !self.window.is_searching() && self.window.fed_cells() >= cells as f64,
        }
    }

    /// u_s over each cell that the front swept since start-up [m/s].
    fn cell_velocities(&self) -> Vec<f64> {
        let from = self.progress.blocks_from.unwrap_or(f64::INFINITY);
        self.window.blocks().iter().filter(|b| b.swept >= from).map(|b| b.velocity()).collect()
    }

    fn full_blocks(&self) -> usize {
        self.cell_velocities().len() / self.case.stop.block_cells
    }

    /// Blocks that must agree.
    fn blocks(&self) -> usize {
        self.case.stop.blocks
    }

    /// Cells that u_s is averaged over.
    fn counted_cells(&self) -> Vec<f64> {
        settle::stretch(&self.cell_velocities(), &self.case.stop, self.blocks()).to_vec()
    }

    /// Cells that the front will have swept at the earliest end.
    fn expected_cells(&self) -> f64 {
        let stop = &self.case.stop;
        let cells = self.case.window.cells_at(self.particle_velocity);
        let blocks = self.progress.profiles.len().max(self.blocks()) * stop.block_cells;
        let start = self.progress.blocks_from.map(|from| from / self.sample.cell);
        start.unwrap_or(stop.startup_at(cells) as f64 + 0.5 * cells as f64) + blocks as f64
    }
}

#[cfg(test)]
mod tests;
