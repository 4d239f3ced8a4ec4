//! A short film of the front: what lies around it, at some moments after start-up.
//!
//! The frames follow the front, a quarter of a cell of its way apart: pores come in from the right and close. Single
//! precision is enough to look at, and keeps the states on disk small.

use serde::{Deserialize, Serialize};
use sph_core::Dim2;
use sph_window::Window;

/// Frames of a film.
const FRAMES: usize = 6;
/// Cells of the front's way between two frames.
const APART: f64 = 0.25;
/// Cells that are shown behind the front, and ahead of it.
const VIEW: (f64, f64) = (3.0, 2.0);

/// The particles around the front at one moment; places relative to the front.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Time [s].
    pub time: f64,
    /// Length of the medium that the front has swept [m].
    pub swept: f64,
    /// Extent of the view: from, to, height [m].
    pub extent: (f64, f64, f64),
    /// x - x_front [m].
    pub x: Vec<f32>,
    /// y within the cell [m].
    pub y: Vec<f32>,
    /// Edge of the square that a particle is drawn in [m].
    pub size: Vec<f32>,
    /// u_x relative to the undisturbed medium [m/s].
    pub velocity: Vec<f32>,
    /// Equivalent plastic strain [-].
    pub plastic_strain: Vec<f32>,
}

/// The frames so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Film {
    frames: Vec<Frame>,
}

impl Film {
    /// Takes a frame if one is due: the front stands at `front` and has swept `swept` of cells of edge `cell` [m].
    pub fn look(&mut self, window: &Window<Dim2>, front: f64, swept: f64, cell: f64) {
        let is_due = self.frames.last().is_none_or(|last| swept - last.swept >= APART * cell);
        if self.frames.len() < FRAMES && is_due {
            self.frames.push(Frame::of(window, front, swept, cell));
        }
    }

    /// The frames, in the order of time.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }
}

impl Frame {
    fn of(window: &Window<Dim2>, front: f64, swept: f64, cell: f64) -> Self {
        let particles = window.simulation().particles();
        let (from, to) = (-VIEW.0 * cell, VIEW.1 * cell);
        let (lower, height) = (window.sample().cell().lower.y, window.sample().cell().period(1));
        let mut frame = Self { time: window.time(), swept, extent: (from, to, height), ..Self::default() };
        for i in 0..particles.len() {
            let x = particles.position[0][i] - front;
            if (from - cell..to + cell).contains(&x) {
                frame.x.push(x as f32);
                frame.y.push((particles.position[1][i] - lower).rem_euclid(height) as f32);
                frame.size.push(crate::observe::drawn_size(particles.mass[i], particles.density[i]) as f32);
                frame.velocity.push((particles.velocity[0][i] + window.inlet_velocity()) as f32);
                frame.plastic_strain.push(particles.plastic_strain[i] as f32);
            }
        }
        frame
    }
}
