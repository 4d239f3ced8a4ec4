//! The command line of `sph-validate`: what can be typed, and which exit code follows.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

use clap::Parser;
use clap::builder::PossibleValuesParser;
use sph_io::progress::{Mode, Progress};
use sph_io::{console, machine};

use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::gate::Significant;
use crate::outcome::Outcome;
use crate::page::page;
use crate::plots::write_pictures;
use crate::provenance::provenance;
use crate::report::{Report, Row};
use crate::runner::{Ended, Settings, Status, plan, run_all};
use crate::store::{Earlier, Store};
use crate::suites::{self, Suite};
use crate::summary::summary;
use crate::user;

/// All gates passed, but for misses that are known.
pub const PASSED: u8 = 0;
/// The case file is wrong: nothing was run.
pub const BAD_INPUT: u8 = 2;
/// A gate was missed that is not known to be, or, asked to be strict, a miss that is known passes.
pub const GATE_MISSED: u8 = 4;
/// Stopped by Ctrl-C; finished runs are kept.
pub const INTERRUPTED: u8 = 130;

const EXAMPLES: &str = "Examples:
  cargo xtask validate                                 quick tier, all suites, all schemes
  cargo xtask validate --tier full --resume            every resolution; goes on where it was interrupted
  cargo xtask validate --suite verny --scheme tkc-hancock --out results/shell
  cargo xtask validate --case validation/cases/riemann-impact.ron --out results/impact

Each run is kept in DIR/runs as soon as it has ended. After Ctrl-C, a crash or a power cut --resume takes over those that
this program would give again, to the last bit, and computes the others; runs of other code are computed again.
Exit codes: 0 all gates passed (but for misses that are known), 1 a file could not be written, 2 bad input, 3 a run failed,
4 a gate was missed (with --strict: or a miss that is known passes), 130 interrupted";

/// Runs problems with known answers, measures the errors and holds them against their gates.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask validate", bin_name = "cargo xtask validate", version, after_help = EXAMPLES)]
pub struct Arguments {
    /// How much is run
    #[arg(long, value_enum, default_value_t)]
    tier: Tier,
    /// Only this problem; may be given more than once
    #[arg(long, value_parser = PossibleValuesParser::new(suites::names()))]
    suite: Vec<String>,
    /// Only this scheme; may be given more than once
    #[arg(long, value_enum)]
    scheme: Vec<SchemeName>,
    /// A problem of your own, in place of the suites: a case file such as those in validation/cases/
    #[arg(long, value_name = "FILE", conflicts_with_all = ["suite", "tier"])]
    case: Option<PathBuf>,
    /// Folder of the report, the plots and the finished runs
    #[arg(long, value_name = "DIR", default_value = "results/validation")]
    out: PathBuf,
    /// Runs side by side; default: as many as there are cores
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Take over the finished runs of an earlier validation in the folder, where the code is the same
    #[arg(long, conflicts_with = "replace")]
    resume: bool,
    /// Throw the finished runs of an earlier validation in the folder away
    #[arg(long)]
    replace: bool,
    /// Exit code 4 also where a miss that is written beside its gate passes: its entry is out of date
    #[arg(long)]
    strict: bool,
}

impl Arguments {
    fn earlier(&self) -> Earlier {
        match (self.resume, self.replace) {
            (true, _) => Earlier::Resume,
            (_, true) => Earlier::Replace,
            _ => Earlier::Refuse,
        }
    }

    /// The command that makes the same report.
    fn command(&self) -> String {
        let what = match &self.case {
            Some(case) => format!("--case {}", machine::quoted(case.display().to_string())),
            None => format!("--tier {}", self.tier.as_str()),
        };
        let mut words = vec![format!("cargo xtask validate {what}")];
        words.extend(self.suite.iter().map(|suite| format!("--suite {suite}")));
        words.extend(self.scheme.iter().map(|scheme| format!("--scheme {scheme}")));
        words.join(" ")
    }

    /// The command that goes on where this one was interrupted.
    fn go_on(&self) -> String {
        let folder = machine::quoted(self.out.display().to_string());
        let strict = if self.strict { " --strict" } else { "" };
        let threads = self.threads.map_or(String::new(), |n| format!(" --threads {n}"));
        format!("{}{strict}{threads} --out {folder} --resume", self.command())
    }
}

/// Runs the command; returns the exit code.
///
/// # Errors
/// If the folder of results is in use, holds runs that are neither to be kept nor replaced, or cannot be written; gates that
/// cannot be read. Bad input, failed runs and missed gates are exit codes.
pub fn execute(arguments: &Arguments) -> Result<u8, ValidateError> {
    if let Some(path) = &arguments.case {
        return match user::load(path) {
            Ok(suite) => validate(arguments, &[suite.as_ref()]),
            Err(error) => {
                let color = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
                console::note(error.render(color).trim_end());
                Ok(BAD_INPUT)
            }
        };
    }
    let is_asked =
        |name: &str| arguments.suite.is_empty() || arguments.suite.iter().any(|asked| asked == name);
    let suites: Vec<&dyn Suite> =
        suites::ALL.iter().copied().filter(|suite| is_asked(suite.about().name)).collect();
    validate(arguments, &suites)
}

fn validate(arguments: &Arguments, suites: &[&dyn Suite]) -> Result<u8, ValidateError> {
    let begun = SystemTime::now();
    let store = Store::open(&arguments.out, arguments.earlier())?;
    let schemes = if arguments.scheme.is_empty() { &SchemeName::ALL[..] } else { &arguments.scheme };
    let jobs = plan(suites, schemes, arguments.tier);
    if jobs.is_empty() {
        console::note(
            "nothing to run: the suites that were asked for have no runs with these schemes in this tier",
        );
        return Ok(BAD_INPUT);
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.map_or(cores, usize::from);
    let what = match &arguments.case {
        Some(case) => case.display().to_string(),
        None => format!("{} tier", arguments.tier.as_str()),
    };
    let label = format!("validation, {what}, {threads} threads");
    let progress = Mutex::new(Progress::new(1.0, label, Mode::Auto));
    let interrupt = stop_on_interrupt();
    let taken_over =
        jobs.iter().filter(|job| store.load(&job.case, &job.suite.parameters()).is_some()).count();
    let settings = Settings { threads, store: Some(&store), interrupt: &interrupt };
    let ended = run_all(jobs, settings, &|status, ended| {
        show(&mut progress.lock().unwrap_or_else(PoisonError::into_inner), status, ended);
    });
    let progress = progress.into_inner().unwrap_or_else(PoisonError::into_inner);
    let finished = ended.iter().filter(|ended| ended.result.is_ok()).count();
    progress.finish(&format!("{finished} of {} runs", ended.len()));
    if is_interrupted(&ended) {
        let go_on = arguments.go_on();
        console::note(format_args!("stopped; {finished} finished runs are kept. Go on with: {go_on}"));
        return Ok(INTERRUPTED);
    }
    let provenance = provenance(arguments.command(), begun, taken_over);
    let report = Report::new(provenance, arguments.tier, &ended)?;
    write_files(&report, &ended, &arguments.out)?;
    let told = console::print(tables(&report));
    told.map_err(|error| ValidateError::Output { path: "the tables".into(), reason: error.to_string() })?;
    let failed = ended.iter().filter_map(|ended| ended.result.as_ref().err());
    let worst = failed
        .inspect(|error| console::note(format_args!("error: {error}")))
        .map(ValidateError::exit_code)
        .max();
    let out_of_date = arguments.strict && report.mended().next().is_some();
    let gate_missed = report.unexplained().next().is_some() || out_of_date;
    Ok(worst.unwrap_or(if gate_missed { GATE_MISSED } else { PASSED }))
}

/// True if a run was kept from its end. A Ctrl-C that came after the last run has stopped nothing: there is a report.
fn is_interrupted(ended: &[Ended<'_>]) -> bool {
    ended.iter().any(|ended| matches!(ended.result, Err(ValidateError::Interrupted)))
}

/// The first Ctrl-C asks the runs to stop; the second ends the process at once. Where no handler can be set, Ctrl-C ends
/// the process, which loses no more than the runs under way.
fn stop_on_interrupt() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&flag);
    let _ = ctrlc::set_handler(move || {
        if seen.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
        console::note("interrupted: finished runs are kept; again to stop at once");
    });
    flag
}

fn write_files(report: &Report, ended: &[Ended<'_>], folder: &Path) -> Result<(), ValidateError> {
    report.write_json(folder)?;
    let pictures = write_pictures(ended, folder)?;
    let fault = |path: PathBuf, reason: String| ValidateError::Output { path, reason };
    let path = folder.join("summary.md");
    sph_io::write_atomic(&path, summary(report, &pictures).as_bytes())
        .map_err(|error| fault(path, error.to_string()))?;
    let path = folder.join("report.html");
    page(report, ended)?.write(&path).map_err(|error| fault(path, error.to_string()))
}

/// The tables of all suites, the tally, and each gate that was missed or is out of date.
fn tables(report: &Report) -> String {
    let mut lines: Vec<String> = report.suites.iter().map(|suite| report.table(suite).to_string()).collect();
    lines.push(match report.n_gates() {
        0 => "there are no gates: the figures stand beside their references".into(),
        _ => report.tally(),
    });
    for row in report.failures() {
        let word = if row.known_miss.is_some() { "known miss" } else { "missed" };
        let cause = row.known_miss.as_ref().map_or(String::new(), |cause| format!(": {cause}"));
        lines.push(format!("{word}: {}{cause}", judged(row)));
    }
    for row in report.mended() {
        let (figure, suite) = (judged(row), &row.suite);
        lines.push(format!(
            "a known miss passes: {figure}; take its entry out of validation/{suite}/gates.ron"
        ));
    }
    lines.push(String::new());
    lines.join("\n")
}

/// A figure with its gate, in a line.
fn judged(row: &Row) -> String {
    let n = row.n.map_or("all n".into(), |n| format!("n = {n}"));
    let gate = row.gate.map_or(String::new(), |gate| gate.to_string());
    let variant = if row.variant.is_empty() { String::new() } else { format!("{} ", row.variant) };
    let value = Significant(row.value);
    format!("{} {variant}{} {n}: {} = {value} {}, {gate}", row.suite, row.scheme, row.metric, row.unit)
}

/// Shows where the runs stand; a run that has ended is noted.
fn show(progress: &mut Progress, status: Status, ended: Option<(&Case, &Result<Outcome, ValidateError>)>) {
    match ended {
        Some((case, Ok(outcome))) => progress.note(&format!("{case}: {:.1} s", outcome.cost.seconds)),
        Some((_, Err(ValidateError::Interrupted))) | None => {}
        Some((case, Err(error))) => progress.note(&format!("{case}: FAILED, {error}")),
    }
    progress.update(status.share, &format!("{} of {} runs", status.done, status.total));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outcome::Cost;
    use crate::runner::Job;

    #[test]
    fn command_that_goes_on_is_what_a_shell_takes_for_the_same() {
        let typed = ["sph-validate", "--suite", "riemann", "--out", "my results/it's"];
        let arguments = |more: &[&str]| {
            Arguments::try_parse_from(typed.iter().chain(more).copied()).expect("a command").go_on()
        };
        let expected =
            r"cargo xtask validate --tier quick --suite riemann --out 'my results/it'\''s' --resume";
        assert_eq!(arguments(&[]), expected);
        let expected = r"cargo xtask validate --tier quick --suite riemann --strict --threads 1 --out 'my results/it'\''s' --resume";
        assert_eq!(arguments(&["--strict", "--threads", "1"]), expected);
    }

    /// Whether something was stopped is for the runs to say: the signal may come when all have ended.
    #[test]
    fn only_a_run_that_was_stopped_is_an_interruption() {
        let suite = suites::find("riemann").expect("it is in the list");
        let case = Case::new("riemann", SchemeName::Csph, 100);
        let whole = Outcome {
            case: case.clone(),
            measurements: Vec::new(),
            conservation: Default::default(),
            curves: Vec::new(),
            fields: Vec::new(),
            cost: Cost::default(),
        };
        let ended = |result| Ended { job: Job { suite, case: case.clone() }, result };
        let failed = || ValidateError::NotReached { case: case.to_string(), reason: "no front".into() };
        assert!(!is_interrupted(&[ended(Ok(whole.clone())), ended(Err(failed()))]));
        assert!(is_interrupted(&[ended(Ok(whole)), ended(Err(ValidateError::Interrupted))]));
    }
}
