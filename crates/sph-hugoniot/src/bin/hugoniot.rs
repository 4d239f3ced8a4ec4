//! `hugoniot`: from a case file to the shock Hugoniot u_s(u_p) of a porous solid, with uncertainty.

use std::process::ExitCode;

use clap::Parser;
use sph_hugoniot::cli;

/// Memory in large pages of 2 MiB, where the system has them: a step of many particles is some percent faster than with the
/// system's allocator.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    let arguments = cli::Arguments::parse();
    tracing_subscriber::fmt()
        .with_env_filter(tracing_subscriber::EnvFilter::from_default_env())
        .with_writer(std::io::stderr)
        .with_ansi(arguments.color.is_on())
        .init();
    match cli::execute(arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(cli::FILE_TROUBLE)
        }
    }
}
