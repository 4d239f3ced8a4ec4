//! The log of a bisection: what was tried, and what followed.

use serde::{Deserialize, Serialize};

/// What a line of the audit log is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stage {
    /// The way of the front to its place.
    Approach,
    /// A trial of the bisection.
    Trial,
    /// The run between two rounds.
    Settle,
}

/// What followed from a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Decision {
    /// The state was saved.
    Saved,
    /// The front moves ahead: the outlet must be faster.
    Raise,
    /// The front falls back: the outlet must be slower.
    Lower,
    /// The bracket is narrow: the round has ended.
    Found,
    /// The result stands at an end of the bracket: the bracket is moved.
    Moved,
}

/// A line of the audit log.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Round, from 1 on; 0 for the approach.
    pub round: u32,
    /// What it was.
    pub stage: Stage,
    /// Time of the state that it started from [s].
    pub start: f64,
    /// `u_out` [m/s].
    pub outlet_velocity: f64,
    /// `u_in = u_out + u_p` [m/s], `u_s` if the front stands.
    pub inlet_velocity: f64,
    /// `⟨dω/dt⟩` [1/s]; none for the approach.
    pub drift: Option<f64>,
    /// Periods of the medium that were fed [-].
    pub fed: f64,
    /// Particles advanced in it.
    pub particle_steps: u64,
    /// Bracket of `u_out` after it [m/s].
    pub bracket: (f64, f64),
    /// What followed.
    pub decision: Decision,
}
