//! `sph-validate`: runs the problems with known answers and holds the figures against their gates.
//!
//! Exit status: 0 when all gates passed, 2 for bad input, 3 for a numerical failure, 4 when a gate was missed.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};

use clap::Parser;
use clap::builder::PossibleValuesParser;
use sph_io::progress::{Mode, Progress};
use sph_validate::case::{Case, SchemeName, Tier};
use sph_validate::error::ValidateError;
use sph_validate::gate::Significant;
use sph_validate::outcome::Outcome;
use sph_validate::plots::write_pictures;
use sph_validate::report::Report;
use sph_validate::runner::{Ended, Status, plan, run_all};
use sph_validate::suites::{self, Suite};
use sph_validate::summary::summary;

const GATE_MISSED: u8 = 4;

/// Runs problems with known answers, measures the errors and holds them against their gates.
#[derive(Parser)]
#[command(name = "sph-validate", version)]
struct Arguments {
    /// How much is run.
    #[arg(long, value_enum, default_value_t)]
    tier: Tier,
    /// Only this problem; may be given more than once.
    #[arg(long, value_parser = PossibleValuesParser::new(suites::names()))]
    suite: Vec<String>,
    /// Only this scheme; may be given more than once.
    #[arg(long, value_enum)]
    scheme: Vec<SchemeName>,
    /// Folder for results.json, summary.md and the plots.
    #[arg(long, default_value = "results/validation")]
    out: PathBuf,
    /// Runs side by side; as many as there are cores by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match validate(&arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

fn validate(arguments: &Arguments) -> Result<u8, ValidateError> {
    create_folder(&arguments.out)?;
    let is_asked =
        |name: &str| arguments.suite.is_empty() || arguments.suite.iter().any(|asked| asked == name);
    let suites: Vec<&dyn Suite> =
        suites::ALL.iter().copied().filter(|suite| is_asked(suite.about().name)).collect();
    let schemes = if arguments.scheme.is_empty() { &SchemeName::ALL[..] } else { &arguments.scheme };
    let jobs = plan(&suites, schemes, arguments.tier);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.map_or(cores, usize::from);
    let label = format!("validation, {} tier, {threads} threads", arguments.tier.as_str());
    let progress = Mutex::new(Progress::new(1.0, label, Mode::Auto));
    let interrupt = AtomicBool::new(false);
    let ended = run_all(jobs, threads, &interrupt, &|status, ended| {
        show(&mut progress.lock().unwrap_or_else(PoisonError::into_inner), status, ended);
    });
    let progress = progress.into_inner().unwrap_or_else(PoisonError::into_inner);
    progress.finish(&format!("{} runs", ended.len()));
    let report = Report::new(command(arguments), arguments.tier, &ended)?;
    write_files(&report, &ended, &arguments.out)?;
    print_tables(&report);
    let failed = ended.iter().filter_map(|ended| ended.result.as_ref().err());
    let worst = failed.inspect(|error| eprintln!("error: {error}")).map(ValidateError::exit_code).max();
    let gate_missed = report.failures().next().is_some();
    Ok(worst.unwrap_or(if gate_missed { GATE_MISSED } else { 0 }))
}

fn create_folder(folder: &Path) -> Result<(), ValidateError> {
    std::fs::create_dir_all(folder)
        .map_err(|error| ValidateError::Output { path: folder.to_owned(), reason: error.to_string() })
}

/// The command that makes the same report.
fn command(arguments: &Arguments) -> String {
    let mut words = vec![format!("cargo xtask validate --tier {}", arguments.tier.as_str())];
    words.extend(arguments.suite.iter().map(|suite| format!("--suite {suite}")));
    words.extend(arguments.scheme.iter().map(|scheme| format!("--scheme {scheme}")));
    words.join(" ")
}

fn write_files(report: &Report, ended: &[Ended<'_>], folder: &Path) -> Result<(), ValidateError> {
    report.write_json(&folder.join("results.json"))?;
    let pictures = write_pictures(ended, folder)?;
    let path = folder.join("summary.md");
    sph_io::write_atomic(&path, summary(report, &pictures).as_bytes())
        .map_err(|error| ValidateError::Output { path, reason: error.to_string() })
}

fn print_tables(report: &Report) {
    for suite in &report.suites {
        println!("{}", report.table(suite));
    }
    let missed: Vec<_> = report.failures().collect();
    println!("{} of {} gates passed", report.n_gates() - missed.len(), report.n_gates());
    for row in missed {
        let n = row.n.map_or("all n".into(), |n| format!("n = {n}"));
        let gate = row.gate.map_or(String::new(), |gate| gate.to_string());
        println!(
            "missed: {} {}{} {n}: {} = {} {}, {gate}",
            row.suite,
            if row.variant.is_empty() { String::new() } else { format!("{} ", row.variant) },
            row.scheme,
            row.metric,
            Significant(row.value),
            row.unit
        );
    }
}

/// Shows where the runs stand; a run that has ended is noted.
fn show(progress: &mut Progress, status: Status, ended: Option<(&Case, &Result<Outcome, ValidateError>)>) {
    match ended {
        Some((case, Ok(outcome))) => progress.note(&format!("{case}: {:.1} s", outcome.cost.seconds)),
        Some((case, Err(error))) => progress.note(&format!("{case}: FAILED, {error}")),
        None => {}
    }
    progress.update(status.share, &format!("{} of {} runs", status.done, status.total));
}
