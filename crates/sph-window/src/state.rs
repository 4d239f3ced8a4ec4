//! What a restart needs beside the particles, the sample and the settings.

use crate::feed::FeedState;
use crate::frame::Frame;
use crate::inlet::InletState;
use crate::ledger::Ledger;
use crate::plateau::MassBalance;
use crate::search::frame_tracking::Observation;
use crate::search::{Bisector, Tracker};
use crate::shock::ShockHistory;
use serde::{Deserialize, Serialize};
use sph_core::dimension::Dimension;
use sph_core::particles::Particles;
use sph_riemann::Clock;

/// State of a window, without the particles (see [`crate::Window::save`]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WindowState {
    /// Cursor of the feed.
    pub feed: FeedState,
    /// Clock of the simulation.
    pub clock: Clock,
    /// Everything else.
    pub progress: Progress,
}

/// A whole state, kept in memory: what the trials of a bisection start from.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot<D: Dimension> {
    /// All but the particles.
    pub state: WindowState,
    /// The particles, in their order.
    pub particles: Particles<D>,
    /// Positions that the neighbor lists were built from, by axis [m]; `None` if new ones are due.
    pub list_positions: Option<Vec<Vec<f64>>>,
}

/// How far a window has come.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Time [s].
    pub time: f64,
    /// Steps made.
    pub steps: u64,
    /// Frame of reference.
    pub frame: Frame,
    /// Stress that arrives at the inlet.
    pub inlet: InletState,
    /// Mass, momentum and energy in and out.
    pub ledger: Ledger,
    /// Passages of the front.
    pub history: ShockHistory,
    /// Progress of frame tracking.
    pub tracker: Tracker,
    /// Progress of a bisection. It is not taken back with the rest.
    pub bisector: Bisector,
    /// Mass balance of the plateau since the start-up material left.
    pub balance: MassBalance,
    /// Way of the matter at the ends since the last exchange there [m].
    pub drift: f64,
    /// Time of the last exchange [s].
    pub exchanged: f64,
    /// Swept length from which on the start-up material has left, once known [m].
    pub settled_from: Option<f64>,
    /// Boosts that were bounded, so that the outlet would not move to the right and bring matter back in.
    pub boosts_bounded: u64,
    /// The last look at the front.
    pub observation: Option<Observation>,
}

impl Progress {
    /// The start of a run.
    pub fn new(frame: Frame, ledger: Ledger, history: ShockHistory) -> Self {
        Self {
            time: 0.0,
            steps: 0,
            frame,
            inlet: InletState::default(),
            ledger,
            history,
            tracker: Tracker::default(),
            bisector: Bisector::default(),
            balance: MassBalance::default(),
            drift: 0.0,
            exchanged: 0.0,
            settled_from: None,
            boosts_bounded: 0,
            observation: None,
        }
    }
}
