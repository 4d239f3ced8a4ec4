//! By which program, on which machine.

use sph_core::lanes::InstructionSet;

/// Version of this program.
pub const VERSION: &str = concat!("hugoniot ", env!("CARGO_PKG_VERSION"));

/// The processor and what is used of it.
pub fn machine() -> String {
    let cores = crate::cli::available_threads();
    let name = sph_io::machine::processor().unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    format!("{name}, {cores} cores, {:?}; {}", InstructionSet::detect(), std::env::consts::OS)
}
