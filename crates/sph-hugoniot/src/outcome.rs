//! What a point leaves: the row of the table, its profile, its history, its last moment.

use std::fmt;

use serde::{Deserialize, Serialize};
use sph_materials::jump::JumpResiduals;
use sph_riemann::StageTimes;
use sph_window::search::bisection::Trial;

pub use crate::film::Frame;
use crate::monitor::worst;
pub use crate::monitor::{MonitorRow, Worst};
use crate::observe::{Bin, Fields, Precursor, States};
pub use crate::series::SeriesLog;
use crate::settle::BlockRecord;

/// How a point ended.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// Successive blocks agree.
    Settled,
    /// The greatest number of cells was fed before they did.
    NotSettled,
    /// Stopped from outside.
    Interrupted,
    /// The solver or the window could not go on.
    Failed(String),
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Settled => f.write_str("settled"),
            Self::NotSettled => f.write_str("not settled"),
            Self::Interrupted => f.write_str("interrupted"),
            Self::Failed(reason) => write!(f, "failed: {reason}"),
        }
    }
}

/// What a point leaves. Numbers that could not be measured are `NaN`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PointOutcome {
    /// u_p as asked for [m/s].
    pub particle_velocity: f64,
    /// u_p that the ends of the window imposed [m/s].
    pub effective_particle_velocity: f64,
    /// u_s relative to the medium ahead, from the front's way [m/s].
    pub shock_velocity: f64,
    /// Its uncertainty: standard error of the mean and slow drift ([`crate::settle`]) [m/s].
    pub standard_error: f64,
    /// Cells that u_s is averaged over.
    pub averaged_cells: usize,
    /// u_s from the mass of the plateau [m/s].
    pub mass_balance_velocity: f64,
    /// States ahead of the compaction wave and behind it.
    pub states: Option<States>,
    /// What the jump conditions of mass, momentum and energy are missed by [-].
    pub residuals: Option<JumpResiduals>,
    /// Cells fed [-].
    pub fed_cells: f64,
    /// Steps made.
    pub steps: u64,
    /// Particles advanced, summed over the steps.
    pub particle_steps: u64,
    /// Particles in the window at the end.
    pub particles: usize,
    /// Gap of the ledger of mass, momentum and energy [-].
    pub ledger_residual: f64,
    /// (time [s], swept length [m], u_s [m/s]) of each cell that the front swept, from the start.
    pub cell_velocities: Vec<(f64, f64, f64)>,
    /// What was concluded from each block of cells.
    pub blocks: Vec<BlockRecord>,
    /// What a bisection tried; empty with tracking.
    pub search: Vec<Trial>,
    /// The elastic precursor on its first way through the window.
    pub precursor: Option<Precursor>,
    /// Why it could not be read, if so.
    pub precursor_missing: Option<String>,
    /// What its levels miss the conservation of mass, momentum and energy by [-].
    pub precursor_residuals: Option<JumpResiduals>,
    /// Averaged profile in the frame of the front.
    pub profile: Vec<Bin>,
    /// Moments that it is the mean of.
    pub profile_looks: usize,
    /// Profiles of single moments, a cell of the front's way apart.
    pub snapshots: Vec<Vec<Bin>>,
    /// What is doubtful about the point, each with what to change.
    pub warnings: Vec<String>,
    /// The last moment.
    pub fields: Fields,
    /// What was watched, a row for each cell that the front swept.
    pub monitors: Vec<MonitorRow>,
    /// Moments of the front after start-up.
    pub film: Vec<Frame>,
    /// What was written for ParaView.
    pub series: SeriesLog,
    /// Time by stage of the solver.
    pub stages: StageTimes,
    /// How it ended.
    pub status: Status,
    /// Time that it took [s].
    pub wall_seconds: f64,
}

impl PointOutcome {
    /// A point that could not start.
    pub fn failed(particle_velocity: f64, reason: String) -> Self {
        Self {
            particle_velocity,
            effective_particle_velocity: f64::NAN,
            shock_velocity: f64::NAN,
            standard_error: f64::NAN,
            averaged_cells: 0,
            mass_balance_velocity: f64::NAN,
            states: None,
            residuals: None,
            fed_cells: 0.0,
            steps: 0,
            particle_steps: 0,
            particles: 0,
            ledger_residual: f64::NAN,
            cell_velocities: Vec::new(),
            blocks: Vec::new(),
            search: Vec::new(),
            precursor: None,
            precursor_missing: None,
            precursor_residuals: None,
            profile: Vec::new(),
            profile_looks: 0,
            snapshots: Vec::new(),
            warnings: Vec::new(),
            fields: Fields::default(),
            monitors: Vec::new(),
            film: Vec::new(),
            series: SeriesLog::default(),
            stages: StageTimes::default(),
            status: Status::Failed(reason),
            wall_seconds: 0.0,
        }
    }

    /// Particles advanced in a second [1/s].
    pub fn particle_steps_per_second(&self) -> f64 {
        self.particle_steps as f64 / self.wall_seconds
    }

    /// The worst of what was watched; `None` if the front swept no cell.
    pub fn worst(&self) -> Option<Worst> {
        worst(&self.monitors)
    }

    /// True when the solver or the window could not go on.
    pub fn has_failed(&self) -> bool {
        matches!(self.status, Status::Failed(_))
    }

    /// The point as an adaptive sweep sees it.
    pub(crate) fn known(&self) -> crate::refine::Known {
        crate::refine::Known {
            particle_velocity: self.particle_velocity,
            shock_velocity: self.shock_velocity,
            standard_error: self.standard_error,
        }
    }

    /// Name of the point's files: `up_0100`, `up_0062.5`.
    pub fn file_stem(&self) -> String {
        file_stem(self.particle_velocity)
    }
}

/// Name of the files of the point with this u_p [m/s].
pub(crate) fn file_stem(particle_velocity: f64) -> String {
    let (whole, part) = (particle_velocity.trunc(), particle_velocity.fract());
    let part =
        if part == 0.0 { String::new() } else { format!("{part}").trim_start_matches('0').to_string() };
    format!("up_{whole:04}{part}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_have_files_that_sort() {
        let stem = |u_p| PointOutcome::failed(u_p, String::new()).file_stem();
        assert_eq!(stem(50.0), "up_0050");
        assert_eq!(stem(62.5), "up_0062.5");
        assert_eq!(stem(1250.0), "up_1250");
    }
}
