//! `cargo xtask health`: what a release needs beside passing tests.
//!
//! * licenses of all dependencies fit the project's own ([`licenses`]);
//! * each public crate can be packed, and holds what it should ([`packages`]);
//! * with `--full`: the packed crates build by themselves (`cargo publish --dry-run`), the oldest versions that the
//!   manifests allow build, public interfaces are compared with those of an earlier commit, and known advisories are
//!   looked up. A step that could not be made, for want of a tool or of the advisory database, is told with what helps,
//!   and does not count as passed;
//! * with `--advisories`: known advisories are looked up in a copy of their database, without a network ([`advisories`]).

mod advisories;
mod licenses;
mod packages;
mod releases;

use std::path::PathBuf;
use std::process::ExitCode;

/// Options of the task.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  cargo xtask health\n  cargo xtask health --full --baseline v0.1.0
  cargo xtask health --advisories ../advisory-db")]
pub struct Arguments {
    /// Also what takes minutes or a further tool: dry run of publishing, oldest dependencies, interfaces, advisories.
    #[arg(long)]
    full: bool,
    /// Commit or tag whose public interfaces today's are compared with; the latest tag by itself.
    #[arg(long, value_name = "REVISION", requires = "full")]
    baseline: Option<String>,
    /// A copy of the RustSec database to look advisories up in, without a network; yanked versions are then not looked for.
    #[arg(long, value_name = "FOLDER")]
    advisories: Option<PathBuf>,
}

/// What a step found.
pub struct Finding {
    /// The step's name.
    name: &'static str,
    /// Faults; none if it is well.
    faults: Vec<String>,
    /// What kept the step from being made, and what helps.
    not_made: Option<String>,
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
    }
    if arguments.full || arguments.advisories.is_some() {
        findings.push(advisories::check(arguments.advisories.as_deref())?);
    }
    for finding in &findings {
        println!("{:<22} {:<9} {}", finding.name, finding.verdict(), finding.said);
        finding.faults.iter().for_each(|fault| eprintln!("error: {}: {fault}", finding.name));
        finding.not_made.iter().for_each(|why| eprintln!("not made: {}: {why}", finding.name));
    }
    let well = findings.iter().all(Finding::is_well);
    Ok(if well { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

impl Finding {
    fn of(name: &'static str, said: String, faults: Vec<String>) -> Self {
        Self { name, faults, not_made: None, said }
    }

    /// A step that was not made is not passed.
    fn not_made(name: &'static str, said: String, why: String) -> Self {
        Self { name, faults: Vec::new(), not_made: Some(why), said }
    }

    fn without_tool(name: &'static str, tool: &str) -> Self {
        let why = format!("{tool} is not installed; hint: cargo install --locked {tool}");
        Self::not_made(name, tool.to_owned(), why)
    }

    fn is_well(&self) -> bool {
        self.faults.is_empty() && self.not_made.is_none()
    }

    fn verdict(&self) -> &'static str {
        match (self.faults.is_empty(), &self.not_made) {
            (false, _) => "NOT WELL",
            (true, Some(_)) => "NOT MADE",
            (true, None) => "well",
        }
    }
}
