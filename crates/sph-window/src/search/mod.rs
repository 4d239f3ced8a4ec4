//! The search for the frame in which the front stands.
//!
//! The shock velocity is known in any frame (see [`crate::shock`]); a frame in which the front stands lets a short box
//! watch it for as long as one likes.

pub mod bisection;
pub mod frame_tracking;

pub use bisection::{Bisection, Bisector};
pub use frame_tracking::{FrameTracking, Tracker};

use serde::{Deserialize, Serialize};

/// How the frame is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Search {
    /// Boosts by the measured drift of the front.
    FrameTracking(FrameTracking),
    /// The published search: bisection on the drift, each trial from a saved state.
    Bisection(Bisection),
    /// The frame of the start: the front moves through the box.
    FixedFrame,
}

impl Default for Search {
    fn default() -> Self {
        Self::FrameTracking(FrameTracking::default())
    }
}
