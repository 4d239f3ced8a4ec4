//! What can go wrong in a validation run.

use std::path::PathBuf;

use thiserror::Error;

use crate::case::Case;

/// Why a suite gave no result.
#[derive(Debug, Error)]
pub enum ValidateError {
    /// The solver does not accept the problem.
    #[error("{case}: the problem could not be set up: {source}")]
    Setup {
        /// Which run.
        case: Case,
        /// What the solver says.
        source: sph_riemann::SetupError,
    },
    /// The particles cannot be placed.
    #[error("{case}: the particles cannot be placed: {reason}")]
    Packing {
        /// Which run.
        case: Case,
        /// What is wrong.
        reason: String,
    },
    /// The solver stopped.
    #[error("{case}: numerical failure at t = {:.4} us: {source}", time * 1e6)]
    Numerical {
        /// Which run.
        case: Case,
        /// Time reached [s].
        time: f64,
        /// What the solver says.
        source: sph_riemann::StepError,
    },
    /// The shell was still moving when its time was up.
    #[error("{case}: the shell has not stopped after {:.1} us", limit * 1e6)]
    NotStopped {
        /// Which run.
        case: Case,
        /// Time allowed [s].
        limit: f64,
    },
    /// A material of a suite is not as the suite needs it.
    #[error("material library: {0}")]
    Material(String),
    /// The exact solution does not exist.
    #[error("exact solution: {0}")]
    Reference(#[from] crate::reference::riemann::RiemannError),
    /// A file of gates cannot be read.
    #[error("validation/{suite}/gates.ron: {reason}")]
    Gates {
        /// Folder of the suite.
        suite: &'static str,
        /// What is wrong, with line and column.
        reason: String,
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
    /// Exit status of the program: 2 for bad input, 3 for a numerical failure.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Numerical { .. } | Self::NotStopped { .. } => 3,
            _ => 2,
        }
    }
}
