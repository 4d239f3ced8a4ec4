//! What can go wrong in a window.

use sph_riemann::{SetupError, StepError};

/// Why a window cannot be built or cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// A number of the settings is out of its bounds.
    #[error("{field} = {value} {unit}: {reason}")]
    Setting {
        /// Name of the setting.
        field: &'static str,
        /// Its value, in `unit`.
        value: f64,
        /// Unit of the value.
        unit: &'static str,
        /// What is wanted instead.
        reason: &'static str,
    },
    /// The sample of the medium cannot be repeated along x.
    #[error("sample of the medium: {0}")]
    Sample(String),
    /// A state to restore does not belong to this window.
    #[error("saved state of the window: {0}")]
    State(String),
    /// No front: the mean velocity lies on one side of the half-way level everywhere.
    #[error("at t = {time:.4e} s no shock front is left in the window")]
    FrontLost {
        /// Time [s].
        time: f64,
    },
    /// The front ran into the inlet: the frame followed too slowly, or the box is too short.
    #[error(
        "at t = {time:.4e} s the shock front (x = {front:.4e} m) reached the inlet (x = {inlet:.4e} m); \
         hint: a longer box, a front place further left, or an inlet velocity nearer to the shock velocity"
    )]
    FrontAtInlet {
        /// Time [s].
        time: f64,
        /// Place of the front [m].
        front: f64,
        /// Left end of the inlet region [m].
        inlet: f64,
    },
    /// The front never came to its place.
    #[error(
        "at t = {time:.4e} s the shock front has swept {swept:.4e} m and has not come to its place in the window \
         (x = {wanted:.4e} m), it stands at x = {front:.4e} m; hint: a smaller inlet velocity at the start"
    )]
    FrontNotArrived {
        /// Time [s].
        time: f64,
        /// Length of the medium that the front has swept [m].
        swept: f64,
        /// Place of the front [m].
        front: f64,
        /// Wanted place [m].
        wanted: f64,
    },
    /// The bisection found no bracket in which the drift of the front changes its sign.
    #[error(
        "at t = {time:.4e} s the bisection has moved its bracket of outlet velocities time and again, now [{low:.1}, \
         {high:.1}] m/s, and the drift of the front has one sign in all of it; hint: a bracket that holds u_s - u_p, or \
         more samples a trial"
    )]
    NoBracket {
        /// Time [s].
        time: f64,
        /// Lower end of the last bracket [m/s].
        low: f64,
        /// Upper end of the last bracket [m/s].
        high: f64,
    },
    /// The solver refused the particles or its settings.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A step failed.
    #[error(transparent)]
    Step(#[from] StepError),
}
