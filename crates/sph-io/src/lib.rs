//! What leaves and enters the process: tables, plots, field images, ParaView snapshots, reports, checkpoints, progress, words
//! to the user.
//!
//! The crate knows no physics: slices, names and units go in, files come out. Every file is written atomically
//! ([`atomic`]): whole or not at all. Every error ([`IoError`]) names its path. Folders are not created.
//!
//! ```
//! use sph_io::plot::{Axis, Figure, Series};
//! use sph_io::table::{Column, Table};
//!
//! let (u_p, u_s) = ([150.0, 200.0], [571.4, 757.1]);
//! let table = Table::new("Hugoniot of porous copper")
//!     .with(Column::float("u_p", "m/s", "particle velocity behind the front", u_p))
//!     .with(Column::float("u_s", "m/s", "shock velocity", u_s));
//! let folder = tempfile::tempdir()?;
//! table.write_csv(folder.path().join("hugoniot.csv"))?;
//! let again = Table::read_csv(folder.path().join("hugoniot.csv"))?;
//! assert_eq!(again.floats("u_s"), Some(&u_s[..])); // every bit
//!
//! Figure::new("Porous copper", Axis::new("u_p [m/s]"), Axis::new("u_s [m/s]"))
//!     .with(Series::points("computed", &u_p, &u_s))
//!     .write_svg(folder.path().join("hugoniot.svg"))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod atomic;
pub mod checkpoint;
pub mod clock;
mod color;
pub mod console;
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
