//! `hugoniot`: from a case file to the shock Hugoniot u_s(u_p) of a porous solid, with uncertainty.

use std::process::ExitCode;

use clap::Parser;
use sph_hugoniot::cli;

fn main() -> ExitCode {
    let arguments = cli::Arguments::parse();
    match cli::execute(arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(cli::BAD_INPUT)
        }
    }
}
