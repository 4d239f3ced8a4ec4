//! What leaves and enters the process: tables, plots, field images, ParaView snapshots, reports, checkpoints, progress.
//!
//! The crate knows no physics: slices, names and units go in, files come out. Every file is written atomically
//! ([`atomic`]): whole or not at all. Every error ([`IoError`]) names its path. Folders are not created.

pub mod atomic;
pub mod checkpoint;
pub mod clock;
mod color;
mod draw;
mod error;
pub mod field_image;
pub mod html;
pub mod lock;
pub mod machine;
pub mod plot;
pub mod progress;
pub mod snapshot;
pub mod table;

pub use atomic::{write_atomic, write_atomic_with};
pub use color::Color;
pub use error::IoError;

/// The examples of the crate's README, so that they are compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
