//! By what, on what and how a validation is made: for its report.

use std::time::{Duration, SystemTime};

use sph_core::lanes::InstructionSet;
use sph_io::{clock, machine};

use crate::report::Provenance;
use crate::store::CODE;

/// State of the repository; `cargo xtask validate` tells it.
const COMMIT: &str = "SPH_VALIDATE_COMMIT";

/// What is known of a validation of the given command that began at `begun` and took over so many runs.
pub fn provenance(command: String, begun: SystemTime, taken_over: usize) -> Provenance {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let name = machine::processor().unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    let instructions = InstructionSet::detect();
    Provenance {
        command,
        version: format!("sph-validate {}", env!("CARGO_PKG_VERSION")),
        commit: std::env::var(COMMIT).ok().filter(|commit| !commit.is_empty()),
        code: CODE.to_owned(),
        compiler: env!("SPH_VALIDATE_COMPILER").to_owned(),
        machine: format!("{name}, {cores} cores, {instructions:?}; {}", std::env::consts::OS),
        begun: clock::utc(clock::unix_seconds(begun)),
        seconds: begun.elapsed().unwrap_or(Duration::ZERO).as_secs_f64(),
        taken_over,
    }
}
