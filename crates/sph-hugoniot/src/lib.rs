//! From a case file to the Hugoniot u_s(u_p) of a porous solid, with uncertainty.

pub mod check;
pub mod cli;
pub mod config;
pub mod estimate;
pub mod microstructure;
pub mod observe;
pub mod outcome;
pub mod point;
pub mod reference;
pub mod report;
pub mod run;
pub mod setup;
pub mod statistics;
pub mod sweep;
pub mod template;
