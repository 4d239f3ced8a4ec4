//! `hugoniot`: from a case file to the shock Hugoniot u_s(u_p) of a porous solid, with uncertainty.

use std::process::ExitCode;

use clap::Parser;
use sph_hugoniot::cli;
use tracing_subscriber::EnvFilter;
use tracing_subscriber::filter::LevelFilter;

/// Memory in large pages of 2 MiB, where the system has them: a step of many particles is some percent faster than with the
/// system's allocator.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    let arguments = cli::Arguments::parse();
    // Warnings are told unless RUST_LOG says otherwise: a damaged state must not be passed over in silence.
    let filter = EnvFilter::builder().with_default_directive(LevelFilter::WARN.into()).from_env_lossy();
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .with_ansi(arguments.color.is_on())
        .init();
    match cli::execute(arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            sph_io::console::note(format_args!("error: {error:#}"));
            ExitCode::from(cli::FILE_TROUBLE)
        }
    }
}
