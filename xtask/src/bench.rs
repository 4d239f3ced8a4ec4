//! `cargo xtask bench`: what a step costs on this machine, in one table, and how many instructions it takes.
//!
//! Builds the bench `table` of `sph-riemann` and runs it. Then, where there is valgrind, counts the instructions of a
//! particle-step by the difference of two runs under `cachegrind`: these counts do not depend on what else the machine does.
//! Valgrind knows no AVX-512, so they are those of AVX2.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

use anyhow::{Context, ensure};

use crate::process;

/// What to measure.
#[derive(clap::Args)]
pub struct Arguments {
    /// Fewer cases and runs: about a minute.
    #[arg(long)]
    quick: bool,
    /// Instruction counts alone.
    #[arg(long)]
    counts: bool,
}

/// Cases whose instructions are counted, and steps of the shorter and the longer run.
const COUNTED: [(&str, u64, u64); 4] =
    [("porous-1e4", 2, 12), ("lattice-0.55-1e4", 2, 12), ("csph-porous-1e5", 1, 3), ("space-0.60-1e4", 1, 4)];

/// Exit status: that of the bench.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let program = build()?;
    if !arguments.counts {
        let mut command = Command::new(&program);
        let status = process::run(command.args(arguments.quick.then_some("--quick")))?;
        if status != ExitCode::SUCCESS {
            return Ok(status);
        }
    }
    println!("\ninstructions a particle-step (AVX2; between rebuilds and with them, as the steps fall):");
    if Command::new("valgrind").arg("--version").stdout(Stdio::null()).status().is_err() {
        println!("not counted: there is no valgrind");
        return Ok(ExitCode::SUCCESS);
    }
    for &(case, few, many) in COUNTED.iter().take(if arguments.quick { 2 } else { COUNTED.len() }) {
        let (fewer, particles) = count(&program, case, few)?;
        let (more, _) = count(&program, case, many)?;
        let each = (more - fewer) / ((many - few) as f64 * particles);
        println!("{case:<22} {particles:>7} {each:>7.0}");
    }
    Ok(ExitCode::SUCCESS)
}

/// Builds the bench and returns the program.
fn build() -> anyhow::Result<PathBuf> {
    let mut command = process::cargo();
    command.args(["bench", "--quiet", "--package", "sph-riemann", "--bench", "table", "--no-run"]);
    command.arg("--message-format=json").current_dir(process::root()).stderr(Stdio::inherit());
    let output = command.output().context("cannot start cargo")?;
    ensure!(output.status.success(), "the bench does not build");
    let messages = String::from_utf8_lossy(&output.stdout);
    let mut program = messages.lines().filter_map(|line| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        let is_table = message["target"]["name"] == "table";
        message["executable"].as_str().filter(|_| is_table).map(PathBuf::from)
    });
    program.next_back().context("cargo names no program for the bench `table`")
}

/// Instructions of a run of some steps, and the number of particles.
fn count(program: &Path, case: &str, steps: u64) -> anyhow::Result<(f64, f64)> {
    let mut command = Command::new("valgrind");
    command.args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]);
    command.arg(program).args(["--count", case, &steps.to_string()]).env("SPH_LANES", "avx2");
    let output = command.output().context("cannot start valgrind")?;
    let log = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "valgrind failed on {case}:\n{log}");
    // ==1234== I   refs:      1,234,567,890
    let refs = log.lines().find(|line| line.contains("refs:")).context("valgrind tells no count")?;
    let digits: String = refs.rsplit(':').next().unwrap_or("").chars().filter(char::is_ascii_digit).collect();
    let particles = String::from_utf8_lossy(&output.stdout).trim().parse();
    Ok((digits.parse().context("a count")?, particles.context("a number of particles")?))
}
