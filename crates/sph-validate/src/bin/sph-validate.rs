//! `sph-validate`: runs the problems with known answers and holds the figures against their gates.
//!
//! Exit status: 0 when all gates passed (but for known misses), 1 when a file could not be written, 2 for bad input, 3 for
//! a numerical failure, 4 when a gate was missed, 130 when interrupted.

use std::process::ExitCode;

use clap::Parser;
use sph_validate::cli::{Arguments, execute};

/// Memory in large pages of 2 MiB, where the system has them: a step of many particles is some percent faster than with the
/// system's allocator.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    match execute(&Arguments::parse()) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            sph_io::console::note(format_args!("error: {error}"));
            ExitCode::from(error.exit_code())
        }
    }
}
