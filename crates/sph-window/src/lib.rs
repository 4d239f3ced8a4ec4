//! A window that moves with a shock: feed, inlet, outlet, frame, ledger and the search for the shock velocity.
//!
//! A shock that runs through a long medium is watched in a short box. The medium streams into the box at the right,
//! through the front, and out at the left; one period of it is kept and repeated for ever. The frame of reference is
//! changed until the front stands, and the shock velocity is read from the front's way through the medium, which no
//! change of frame alters.
//!
//! # Rooms
//!
//! | module | question it answers |
//! |---|---|
//! | [`window`] | the whole: a simulation in a window, step by step |
//! | [`settings`] | what a user may choose |
//! | [`region`] | where the inlet, the flow and the outlet are |
//! | [`feed`] | which particle of the endless medium comes next, and where |
//! | [`mod@inlet`] | what is imposed where the medium enters |
//! | [`outlet`] | what is imposed where it leaves, and what is removed |
//! | [`frame`] | which velocities the frame fixes |
//! | [`search`] | how the frame is chosen |
//! | [`profile`] | moving means along x, and where the front is |
//! | [`shock`] | the shock velocity and its uncertainty |
//! | [`plateau`] | the shock velocity from the mass balance behind the front |
//! | [`ledger`] | mass, momentum and energy in and out |
//! | [`state`] | what a restart needs |
//!
//! A shock through a lattice with one pore a cell, and the books of its window (the README follows it to its speed):
//!
//! ```
//! use sph_core::{Components, Dim2, Dimension, Domain, Particle, Particles};
//! use sph_riemann::Settings;
//! use sph_window::{FeedSample, Window, WindowSettings};
//!
//! let copper = sph_materials::library::material("porous-copper")?;
//! let (size, density) = (2e-6, copper.reference_density);
//! let mut particles = Particles::<Dim2>::default();
//! for k in (0..100_u64).filter(|k| !matches!(k, 44 | 45 | 54 | 55)) {
//!     let place = Dim2::vector(|axis| size * ([k / 10, k % 10][axis] as f64 + 0.5));
//!     particles.push(Particle::at_rest(k, place, density * size * size, size, density));
//! }
//! let cell = Domain::new(Dim2::vector(|_| 0.0), Dim2::vector(|_| 10.0 * size), Components::from_fn(|_| true));
//! let sample = FeedSample::new(particles, cell)?;
//! let settings = WindowSettings::new(8.0 * sample.period(), 250.0); // length of the box [m], u_p [m/s]
//! let mut window = Window::new(sample, vec![copper], Settings::default(), settings)?;
//! for _ in 0..50 {
//!     window.step()?;
//! }
//! assert!(window.ledger_residual() < 1e-12); // mass, momentum and energy in and out
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The crate does not know sweeps, case files or where results go.
//!
//! # Source
//!
//! Rublev & Murzov, arXiv 2410.14646, section 3, with frame tracking beside the search by bisection.

// Units in brackets, such as [Pa], read as links to rustdoc.
#![allow(rustdoc::broken_intra_doc_links)]

pub mod error;
pub mod feed;
pub mod frame;
pub mod inlet;
pub mod ledger;
pub mod outlet;
pub mod plateau;
pub mod profile;
pub mod region;
pub mod search;
pub mod settings;
pub mod shock;
pub mod state;
mod steering;
#[cfg(test)]
mod testing;
mod view;
pub mod window;

pub use error::WindowError;
pub use feed::{Feed, FeedSample};
pub use frame::Frame;
pub use inlet::InletKind;
pub use ledger::{Content, Ledger};
pub use profile::{Profile, Slab};
pub use region::{RegionWidths, Regions};
pub use search::frame_tracking::Observation;
pub use search::{Bisection, FrameTracking, Search};
pub use settings::{PlateauMargins, WindowSettings};
pub use shock::{Block, Estimate};
pub use state::{Snapshot, WindowState};
pub use window::{Window, WindowReport};

/// The example of the README, compiled by the tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
