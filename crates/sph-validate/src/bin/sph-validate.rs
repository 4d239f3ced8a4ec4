//! `sph-validate`: runs the problems with known answers and holds the figures against their gates.
//!
//! Exit status: 0 when all gates passed (but for known misses), 1 when a file could not be written, 2 for bad input, 3 for
//! a numerical failure, 4 when a gate was missed, 130 when interrupted.

use std::process::ExitCode;

use clap::Parser;
use sph_validate::cli::{Arguments, execute};

fn main() -> ExitCode {
    match execute(&Arguments::parse()) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}
