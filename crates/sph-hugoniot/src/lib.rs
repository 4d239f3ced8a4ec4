//! From a case file to the Hugoniot u_s(u_p) of a porous solid, with uncertainty.
//!
//! The way of a case: [`config`] (text to a checked case in SI) → [`microstructure`] (one periodic sample) → [`point`] (one
//! u_p run to a steady front, in a moving window) → [`sweep`] (all points side by side) → [`curve`] (fits). What the program
//! `hugoniot` does besides (tables, pictures, the report, going on with a run) is behind its command line, [`cli`].
//!
//! One point of a coarse porous copper. Pores are shut at 300 m/s, so that the jump conditions leave 1117.7 to 1122.5 m/s:
//!
//! ```
//! use sph_hugoniot::{config, microstructure, point};
//!
//! let text = r#"Case(
//!     name: "one point",
//!     material: Library(name: "porous-copper"),
//!     medium: (cell: "20 um", pores: CenteredSquare(), porosity: 1.35, particle_size: "2 um"),
//!     window: (length: Cells(8)),
//!     points: ["300 m/s"],
//!     stop: (startup_cells: Cells(4), block_cells: 2, tolerance: 0.1, max_fed_cells: 12),
//! )"#;
//! let case = config::parse(text, "one_point.ron")?;
//! let sample = microstructure::sample(&case);
//! let outcome = point::run(&case, &sample, case.points[0], &point::Unwatched);
//! assert!((outcome.shock_velocity / 1120.0 - 1.0).abs() < 0.01, "{}", outcome.status);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! SI units inside; stress is positive in tension, pressure positive in compression. Velocities of observables are
//! relative to the undisturbed medium.

// Units stand in brackets, `[m]`; rustdoc would take them for links.
#![allow(rustdoc::broken_intra_doc_links)]

mod arguments;
mod check;
pub mod cli;
pub mod config;
pub mod curve;
pub mod estimate;
mod failure;
mod film;
pub mod microstructure;
mod monitor;
pub mod observe;
pub mod outcome;
mod paraview;
pub mod point;
mod reference;
mod refine;
mod report;
pub mod restart;
mod run;
pub mod schema;
mod separation;
mod series;
pub mod settle;
pub mod setup;
mod shell;
pub mod statistics;
mod status;
mod study;
pub mod sweep;
pub mod template;
mod zone;
