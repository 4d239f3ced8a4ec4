//! `cargo xtask soak`: runs are killed at random moments, many times, and must end with the same bytes.
//!
//! It is the test `soak` of `sph-hugoniot` with more kills: SIGKILL after a random time, states on disk cut or changed in
//! between, another number of threads each time; at the end every file is held against those of a run that was left
//! alone. `cargo test` runs the same, in the same build, with a few kills.

use std::process::ExitCode;

use crate::process;

/// How long.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  cargo xtask soak --kills 20 --seed 7")]
pub struct Arguments {
    /// Kills of each of the three cases; a hundred take a few minutes.
    #[arg(long, default_value_t = 100)]
    kills: u32,
    /// Seed of the random moments; each seed is another soak.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Exit status: that of the test.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let mut command = process::cargo();
    command.args(["test", "--quiet", "--package", "sph-hugoniot", "--test", "soak"]);
    command.args(["--", "--nocapture"]).current_dir(process::root());
    command.env("SOAK_KILLS", arguments.kills.to_string()).env("SOAK_SEED", arguments.seed.to_string());
    process::hand_over(&mut command)
}
