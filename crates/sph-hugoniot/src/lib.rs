//! From a case file to the Hugoniot u_s(u_p) of a porous solid, with uncertainty.

pub mod check;
pub mod cli;
pub mod config;
pub mod estimate;
pub mod microstructure;
pub mod template;
