//! How to run things: validation, benches, documentation, tidiness.
//!
//! Each command is one file. They spawn release builds of the programs and link no numerics.

mod process;
mod validate;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Tasks of the project.
#[derive(Parser)]
#[command(name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Run the problems with known answers and hold the figures against their gates.
    Validate(validate::Arguments),
}

fn main() -> anyhow::Result<ExitCode> {
    match Arguments::parse().task {
        Task::Validate(arguments) => validate::run(&arguments),
    }
}
