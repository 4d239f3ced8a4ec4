//! `cargo xtask fuzz`: readers of everything that a user hands in, under cargo-fuzz.
//!
//! The targets stand in `crates/sph-hugoniot/fuzz`, a workspace of its own. Each is built without a sanitizer (the readers
//! have no unsafe code of their own) and run for a while, from the seeds and from the case files of the project; a panic,
//! an answer that takes longer than [`LONGEST`] and memory beyond [`MOST_MEMORY`] are faults. What the fuzzer has found
//! stays in `fuzz/corpus` and `fuzz/artifacts`, for the next time.

use std::path::Path;
use std::process::{Command, ExitCode};

use crate::process;

/// Time for one answer [s].
const LONGEST: u32 = 10;
/// Memory of the whole process [MB].
const MOST_MEMORY: u32 = 1024;

/// A target, the folders that it starts from, and its longest input [bytes].
type Target = (&'static str, &'static [&'static str], u32);

const TARGETS: [Target; 4] = [
    ("case_file", &["tests/cases/good", "tests/cases/bad", "../../cases"], 8192),
    ("measured_data", &["fuzz/seeds/measured_data"], 4096),
    ("picture", &["fuzz/seeds/picture"], 4096),
    ("checkpoint", &["fuzz/seeds/checkpoint"], 16384),
];

/// What, and how long.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  cargo xtask fuzz\n  cargo xtask fuzz --seconds 600 --target case_file")]
pub struct Arguments {
    /// Time for each target.
    #[arg(long, default_value_t = 60)]
    seconds: u32,
    /// One target only.
    #[arg(long, value_parser = TARGETS.map(|target| target.0))]
    target: Option<String>,
}

/// Exit status 1 if a target found something, or there is no cargo-fuzz.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    if !process::has_subcommand("fuzz") {
        eprintln!("error: cargo-fuzz is not installed; hint: cargo install --locked cargo-fuzz");
        return Ok(ExitCode::FAILURE);
    }
    let mut good = true;
    let wanted = |target: &&Target| arguments.target.as_deref().is_none_or(|name| name == target.0);
    for target in TARGETS.iter().filter(wanted) {
        good &= process::run(&mut command(target, arguments.seconds)?)? == ExitCode::SUCCESS;
    }
    Ok(if good { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn command((name, seeds, longest): &Target, seconds: u32) -> anyhow::Result<Command> {
    let folder = process::root().join("crates").join("sph-hugoniot");
    let corpus = Path::new("fuzz").join("corpus").join(name);
    std::fs::create_dir_all(folder.join(&corpus))?;
    let mut command = process::cargo();
    // The instrumentation needs flags that the stable compiler knows, and takes only when it is told so.
    command.env("RUSTC_BOOTSTRAP", "1").current_dir(folder);
    command.args(["fuzz", "run", "--sanitizer", "none", name]).arg(corpus).args(*seeds).arg("--");
    command.arg(format!("-max_total_time={seconds}")).arg(format!("-timeout={LONGEST}"));
    command.arg(format!("-rss_limit_mb={MOST_MEMORY}")).arg(format!("-max_len={longest}"));
    command.arg("-print_final_stats=1");
    Ok(command)
}
