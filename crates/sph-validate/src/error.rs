//! What can go wrong in a validation run.

use std::path::PathBuf;

use sph_materials::HugoniotError;
use thiserror::Error;

/// Why a suite gave no result.
#[derive(Debug, Error)]
pub enum ValidateError {
    /// The solver does not accept the problem.
    #[error("{case}: the problem could not be set up: {source}")]
    Setup {
        /// Which run.
        case: String,
        /// What the solver says.
        source: sph_riemann::SetupError,
    },
    /// The particles cannot be placed.
    #[error("{case}: the particles cannot be placed: {reason}")]
    Packing {
        /// Which run.
        case: String,
        /// What is wrong.
        reason: String,
    },
    /// The solver stopped.
    #[error("{case}: numerical failure at t = {:.4} us: {source}", time * 1e6)]
    Numerical {
        /// Which run.
        case: String,
        /// Time reached [s].
        time: f64,
        /// What the solver says.
        source: Box<sph_riemann::StepError>,
    },
    /// The moving window cannot be made, or stopped.
    #[error("{case}: moving window: {source}")]
    Window {
        /// Which run.
        case: String,
        /// What the window says.
        source: Box<sph_window::WindowError>,
    },
    /// What a run waits for did not come in the time or travel allowed.
    #[error("{case}: {reason}")]
    NotReached {
        /// Which run.
        case: String,
        /// What did not come, with the limit.
        reason: String,
    },
    /// The run was interrupted.
    #[error("interrupted")]
    Interrupted,
    /// A material of a suite is not as the suite needs it.
    #[error("material library: {0}")]
    Material(String),
    /// The exact solution of the Riemann problem does not exist.
    #[error("exact solution: {0}")]
    Reference(#[from] crate::reference::riemann::RiemannError),
    /// The exact waves ahead of a piston do not exist.
    #[error("exact solution: {0}")]
    Waves(#[from] HugoniotError),
    /// A file of gates cannot be read, or judges what no run measures.
    #[error("validation/{suite}/gates.ron: {reason}")]
    Gates {
        /// Folder of the suite.
        suite: String,
        /// What is wrong, with line and column.
        reason: String,
    },
    /// The folder holds finished runs, and nothing says what shall happen to them.
    #[error(
        "{}: there are {count} finished runs of an earlier validation; hint: --resume takes over those that this program \
         would give again, --replace throws them away, --out names another folder",
        folder.display()
    )]
    Earlier {
        /// The folder.
        folder: PathBuf,
        /// How many runs.
        count: usize,
    },
    /// A result could not be written.
    #[error("{}: cannot be written: {reason}", path.display())]
    Output {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
}

impl ValidateError {
    /// Exit status of the program: 1 for a file or folder that cannot be written, 2 for bad input, 3 for a numerical failure,
    /// 130 when interrupted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Output { .. } => 1,
            Self::Numerical { .. } | Self::Window { .. } | Self::NotReached { .. } => 3,
            Self::Interrupted => 130,
            _ => 2,
        }
    }
}
