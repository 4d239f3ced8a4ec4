//! From a case file to the Hugoniot u_s(u_p) of a porous solid, with uncertainty.
//!
//! The way of a case: [`config`] (text to a checked case in SI) → [`microstructure`] (one periodic sample) → [`point`] (one
//! u_p run to a steady front, in a moving window) → [`sweep`] (all points side by side) → `report` (tables and
//! pictures). `run` ties them together for the command line, [`cli`].
//!
//! SI units inside; stress is positive in tension, pressure positive in compression. Velocities of observables are
//! relative to the undisturbed medium.

// Units stand in brackets, `[m]`; rustdoc would take them for links.
#![allow(rustdoc::broken_intra_doc_links)]

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
