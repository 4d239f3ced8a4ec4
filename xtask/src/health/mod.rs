//! `cargo xtask health`: what a release needs beside passing tests.
//!
//! * licenses of all dependencies fit the project's own ([`licenses`]);
//! * each public crate can be packed, and holds what it should ([`packages`]);
//! * with `--full`: the packed crates build by themselves (`cargo publish --dry-run`), the oldest versions that the
//!   manifests allow build, public interfaces are compared with those of an earlier commit, and known advisories are
//!   looked up. Where a step needs a tool that is not installed, this is told with the command that installs it.

mod licenses;
mod packages;
mod releases;

use std::process::ExitCode;

/// Options of the task.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  cargo xtask health\n  cargo xtask health --full --baseline v0.1.0")]
pub struct Arguments {
    /// Also what takes minutes or a further tool: dry run of publishing, oldest dependencies, interfaces, advisories.
    #[arg(long)]
    full: bool,
    /// Commit or tag whose public interfaces today's are compared with.
    #[arg(long, value_name = "REVISION", requires = "full")]
    baseline: Option<String>,
}

/// What a step found.
pub struct Finding {
    /// The step's name.
    name: &'static str,
    /// Faults; none if it is well.
    faults: Vec<String>,
    /// What was done, or why it was not.
    said: String,
}

/// Looks at everything; exit status 1 if something is not well.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let mut findings = vec![licenses::check()?, packages::check()?];
    if arguments.full {
        findings.push(releases::dry_run()?);
        findings.push(releases::oldest_dependencies()?);
        findings.push(releases::interfaces(arguments.baseline.as_deref())?);
        findings.push(releases::advisories()?);
    }
    for finding in &findings {
        let verdict = if finding.faults.is_empty() { "well" } else { "NOT WELL" };
        println!("{:<22} {verdict:<9} {}", finding.name, finding.said);
        finding.faults.iter().for_each(|fault| eprintln!("error: {}: {fault}", finding.name));
    }
    let well = findings.iter().all(|finding| finding.faults.is_empty());
    Ok(if well { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
