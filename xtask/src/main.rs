//! How to run things: validation, benches, documentation, tidiness.
//!
//! Each command is one file, or a folder where it looks at several things. They start cargo, the programs and the tools of
//! others, and link no numerics.

mod bench;
mod code;
mod docs;
mod files;
mod fuzz;
mod health;
mod process;
mod soak;
mod tidy;
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
    /// Measure what a step costs on this machine, in one table, and count its instructions.
    Bench(bench::Arguments),
    /// Kill runs at random moments, many times: they must end with the same bytes.
    Soak(soak::Arguments),
    /// Feed the readers of case files, measured data, pictures and checkpoints with what a fuzzer thinks of.
    Fuzz(fuzz::Arguments),
    /// Hold the sources against the rules of the house: dependencies, module docs, paths, prints, sizes.
    Tidy,
    /// Look at what a release needs: licenses, packages; with --full a dry run, oldest dependencies, interfaces.
    Health(health::Arguments),
    /// Build rustdoc with warnings denied, check the links of all Markdown files, build the guide.
    Docs(docs::Arguments),
}

fn main() -> anyhow::Result<ExitCode> {
    match Arguments::parse().task {
        Task::Validate(arguments) => validate::run(&arguments),
        Task::Bench(arguments) => bench::run(&arguments),
        Task::Soak(arguments) => soak::run(&arguments),
        Task::Fuzz(arguments) => fuzz::run(&arguments),
        Task::Tidy => tidy::run(),
        Task::Health(arguments) => health::run(&arguments),
        Task::Docs(arguments) => docs::run(&arguments),
    }
}
