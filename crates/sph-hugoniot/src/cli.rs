//! The command line of `hugoniot`: what can be typed, and which exit code follows.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use clap::{Parser, Subcommand};

use crate::config::PARTICLE_VELOCITIES;
use crate::config::units::{Length, LengthKind, Velocity, show};
use crate::report::curves::load_data;
use crate::run::{self, Earlier, RunEnd, RunOptions};
use crate::shell::{self, ColorChoice};
use crate::{check, config, restart, schema, status, study, template};

/// Everything went well.
pub const SUCCESS: u8 = 0;
/// A file could not be read or written: full disk, no permission; what was kept before stands.
pub const FILE_TROUBLE: u8 = 1;
/// The input is wrong: nothing was run.
pub const BAD_INPUT: u8 = 2;
/// At least one point failed; what was computed is kept.
pub const NUMERICAL_FAILURE: u8 = 3;
/// Stopped by Ctrl-C; what was computed is kept.
pub const INTERRUPTED: u8 = 130;

const EXAMPLES: &str = "Examples:
  hugoniot init porous-copper > case.ron     write a commented case file
  hugoniot check case.ron                    porosity reached, particles, memory, time
  hugoniot run case.ron                      all points of the case
  hugoniot run case.ron --up 100,150         two points only
  hugoniot run case.ron --out results/a --threads 2 --quiet
  hugoniot run case.ron --resolutions 2um,1um,0.5um
                                             u_s at vanishing particle size
  hugoniot run case.ron --resume             go on after Ctrl-C, a crash or a power cut
  hugoniot status results/porous-copper      how far a run is, from another terminal
  hugoniot completions bash > ~/.local/share/bash-completion/completions/hugoniot

RUST_LOG=info tells of each point when start-up ends and what each block gives.
Ctrl-C once: the points keep their states and stop; twice: the process ends at once. --resume goes on either way.
Exit codes: 0 done, 1 a file could not be read or written, 2 bad input, 3 a point failed, 130 interrupted";

/// From a case file to the shock Hugoniot u_s(u_p) of a porous solid, with uncertainty.
#[derive(Debug, Parser)]
#[command(name = "hugoniot", version, after_help = EXAMPLES)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Colors in messages
    #[arg(long, global = true, value_enum, default_value_t)]
    pub color: ColorChoice,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a commented case file to standard output
    #[command(after_help = "Example:\n  hugoniot init porous-copper > case.ron")]
    Init {
        /// Name of the template; without it the names are listed
        template: Option<String>,
    },
    /// Show what a case file resolves to; run nothing
    #[command(
        after_help = "Examples:\n  hugoniot check case.ron\n  hugoniot check case.ron --json | jq .porosity_reached"
    )]
    Check {
        /// Case file
        case: PathBuf,
        /// As JSON
        #[arg(long)]
        json: bool,
        /// Cores that the time is estimated for; default: all
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
        threads: Option<u16>,
        /// PNG file for the picture of the sample; default: sample.png in the case's folder of results
        #[arg(long, value_name = "FILE")]
        picture: Option<PathBuf>,
    },
    /// Run the points of a case; results go into its folder
    #[command(
        after_help = "Examples:\n  hugoniot run case.ron\n  hugoniot run case.ron --up 100,150 --out results/two"
    )]
    Run {
        /// Case file
        case: PathBuf,
        /// Particle velocities in m/s, in place of those of the case
        #[arg(long, value_name = "U_P", value_delimiter = ',', value_parser = particle_velocity)]
        up: Vec<f64>,
        /// Particle sizes, in place of that of the case: the sweep with each, and u_s at vanishing size
        #[arg(long, value_name = "D", value_delimiter = ',', value_parser = particle_size)]
        resolutions: Vec<f64>,
        /// Folder of the results, in place of that of the case
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Cores to use; default: all
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
        threads: Option<u16>,
        /// Go on with an earlier run in the folder: finished points are kept, the others go on where they were
        #[arg(long, conflicts_with = "replace")]
        resume: bool,
        /// Throw the results of an earlier run in the folder away
        #[arg(long)]
        replace: bool,
        /// Time between two states of a point on disk, in seconds
        #[arg(long, value_name = "SECONDS", default_value_t = restart::INTERVAL.as_secs_f64(), value_parser = seconds)]
        keep_every: f64,
        /// No progress, no summary; failures are still told
        #[arg(long)]
        quiet: bool,
        /// The summary at the end as JSON
        #[arg(long)]
        json: bool,
    },
    /// Show how far a run is, or how it ended
    #[command(
        after_help = "Examples:\n  hugoniot status results/porous-copper\n  watch -n 2 hugoniot status results/porous-copper\n  \
                      hugoniot status results/porous-copper --json | jq .seconds_left"
    )]
    Status {
        /// Folder of the results
        folder: PathBuf,
        /// As JSON
        #[arg(long)]
        json: bool,
    },
    /// Write the completions for a shell to standard output
    #[command(after_help = "Examples:
  hugoniot completions bash > ~/.local/share/bash-completion/completions/hugoniot
  hugoniot completions zsh > \"${fpath[1]}/_hugoniot\"
  hugoniot completions fish > ~/.config/fish/completions/hugoniot.fish")]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Write the manual pages into a folder
    #[command(after_help = "Example:\n  hugoniot man ~/.local/share/man/man1")]
    Man {
        /// The folder; it is made if it is not there
        folder: PathBuf,
    },
    /// Write the JSON schema of what --json gives to standard output
    #[command(
        after_help = "Examples:\n  hugoniot schema status\n  hugoniot schema check > check.schema.json"
    )]
    Schema {
        /// Which one
        #[arg(value_enum)]
        of: schema::Schema,
    },
}

/// Reads a particle velocity: `100`, `100 m/s`, `0.1 km/s`.
fn particle_velocity(text: &str) -> Result<f64, String> {
    let value = match text.trim().parse::<f64>() {
        Ok(value) => value,
        Err(_) => Velocity::parse(text)?.si,
    };
    let (low, high) = PARTICLE_VELOCITIES;
    match (low..=high).contains(&value) {
        true => Ok(value),
        false => Err(format!("{value} m/s is out of range; hint: from {low} to {high} m/s")),
    }
}

/// Reads a particle size: `1um`, `500 nm`.
fn particle_size(text: &str) -> Result<f64, String> {
    let size = Length::parse(text)?.si;
    if size > 0.0 { Ok(size) } else { Err(format!("{text} is no particle size; hint: such as 1um")) }
}

/// Reads a time in seconds.
fn seconds(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("{text:?} is no number of seconds"))?;
    if (0.0..=1e6).contains(&value) {
        Ok(value)
    } else {
        Err(format!("{value} s is out of range; hint: 0 to 1e6"))
    }
}

/// Runs the command; returns the exit code.
///
/// # Errors
/// What ends the program with exit code 1: a file or folder that cannot be read, made or written, a terminal that is
/// gone. Bad input, failed points and interrupts are no errors here but exit codes.
pub fn execute(arguments: Arguments) -> anyhow::Result<u8> {
    let color = arguments.color.is_on();
    sph_io::progress::set_color(color);
    match arguments.command {
        Command::Init { template } => Ok(init(template.as_deref())),
        Command::Check { case, json, threads, picture } => check_case(&case, json, threads, picture, color),
        Command::Run { case, up, resolutions, out, threads, resume, replace, keep_every, quiet, json } => {
            let earlier = match (resume, replace) {
                (true, _) => Earlier::Resume,
                (_, true) => Earlier::Replace,
                _ => Earlier::Refuse,
            };
            let threads = threads.map_or_else(available_threads, usize::from);
            let keep_every = Duration::from_secs_f64(keep_every);
            let folder = out.unwrap_or_default();
            let go_on = String::new();
            let options = RunOptions { folder, threads, quiet, json, earlier, keep_every, go_on };
            run_case(&case, Changes { up, resolutions }, options, color)
        }
        Command::Status { folder, json } => show_status(&folder, json),
        Command::Completions { shell } => {
            std::io::stdout().write_all(&shell::completions(shell))?;
            Ok(SUCCESS)
        }
        Command::Man { folder } => {
            let n_pages = shell::write_manual(&folder)?;
            println!("{n_pages} pages in {}", folder.display());
            Ok(SUCCESS)
        }
        Command::Schema { of } => {
            print!("{}", of.text());
            Ok(SUCCESS)
        }
    }
}

fn init(name: Option<&str>) -> u8 {
    let names = template::names();
    let Some(name) = name else {
        println!("{}", names.join("\n"));
        return SUCCESS;
    };
    match template::text(name) {
        Some(text) => {
            print!("{text}");
            SUCCESS
        }
        None => {
            eprintln!(
                "error: there is no template {name:?}; hint: {}",
                config::fault::name_hint(name, &names)
            );
            BAD_INPUT
        }
    }
}

/// Reads a case file; its faults go to standard error.
fn load(path: &Path, color: bool) -> Option<config::Case> {
    config::load(path).map_err(|error| eprintln!("{}", error.render(color).trim_end())).ok()
}

/// Tells how far the run in a folder is.
fn show_status(folder: &Path, json: bool) -> anyhow::Result<u8> {
    let Some(found) = status::read(folder)? else {
        let below = status::runs_below(folder);
        let hint = match below.is_empty() {
            true => "the folder of results, as `hugoniot check` names it".to_owned(),
            false => format!("the folder of one run, such as {}", below.join(", ")),
        };
        eprintln!("error: {}: no run has written here; hint: {hint}", folder.display());
        return Ok(BAD_INPUT);
    };
    if json {
        println!("{}", serde_json::to_string_pretty(&found)?);
    } else {
        print!("{}", found.to_text());
    }
    Ok(SUCCESS)
}

fn check_case(
    path: &Path,
    json: bool,
    threads: Option<u16>,
    picture: Option<PathBuf>,
    color: bool,
) -> anyhow::Result<u8> {
    let Some(case) = load(path, color) else { return Ok(BAD_INPUT) };
    if let Err(error) = load_data(&case) {
        eprintln!("error: {error}");
        return Ok(BAD_INPUT);
    }
    let picture = picture.unwrap_or_else(|| Path::new(&case.output.directory).join("sample.png"));
    let mut check = check::Check::new(case, threads.map_or_else(available_threads, usize::from));
    check.draw(&picture);
    if json {
        println!("{}", serde_json::to_string_pretty(&check)?);
    } else {
        print!("{}", check.to_text());
    }
    Ok(SUCCESS)
}

/// What of a case is replaced on the command line.
#[derive(Debug, Default)]
struct Changes {
    /// Points [m/s].
    up: Vec<f64>,
    /// Particle sizes of a study [m].
    resolutions: Vec<f64>,
}

impl Changes {
    fn sorted(mut self) -> Self {
        self.up.sort_by(f64::total_cmp);
        self.up.dedup();
        // The coarsest run comes first: it is done soon, and shows soon what is wrong.
        self.resolutions.sort_by(|a, b| b.total_cmp(a));
        self.resolutions.dedup();
        self
    }

    fn apply(&self, case: &mut config::Case) {
        if !self.up.is_empty() {
            (case.points, case.refinement) = (self.up.clone(), None);
        }
    }

    /// Tells which points no front can have in this case; true if there is one.
    fn are_refused(&self, case: &config::Case) -> bool {
        let (material, porosity) = (&case.material, case.medium.porosity);
        let refusals = self.up.iter().filter_map(|&u| crate::separation::refusal(material, porosity, u));
        let refusals: Vec<String> =
            refusals.map(|(text, hint)| format!("error: {text}; hint: {hint}")).collect();
        if !refusals.is_empty() {
            eprintln!("{}", refusals.join("\n"));
        }
        !refusals.is_empty()
    }

    /// The options that make these changes again.
    fn words(&self) -> String {
        let list = |name: &str, items: Vec<String>| {
            if items.is_empty() { String::new() } else { format!(" {name} {}", items.join(",")) }
        };
        let sizes = self.resolutions.iter().map(|&d| show::<LengthKind>(d).replace(' ', "")).collect();
        list("--up", self.up.iter().map(f64::to_string).collect()) + &list("--resolutions", sizes)
    }
}

/// The case at each particle size of a study; `None` if one cannot be, which is told.
fn study_cases(path: &Path, changes: &Changes, color: bool) -> Option<Vec<config::Case>> {
    let mut cases = Vec::new();
    for &size in &changes.resolutions {
        let case = config::load_with(path, Some(size));
        let told = |error: config::CaseError| {
            let size = show::<LengthKind>(size);
            eprintln!("with --resolutions {size}:\n{}", error.render(color).trim_end());
        };
        let mut case = case.map_err(told).ok()?;
        changes.apply(&mut case);
        if case.refinement.is_some() {
            eprintln!(
                "error: {}: an adaptive sweep chooses other points at each particle size; hint: --up names the points",
                path.display()
            );
            return None;
        }
        cases.push(case);
    }
    Some(cases)
}

fn run_case(path: &Path, changes: Changes, mut options: RunOptions, color: bool) -> anyhow::Result<u8> {
    let changes = changes.sorted();
    let Some(mut case) = load(path, color) else { return Ok(BAD_INPUT) };
    if changes.are_refused(&case) {
        return Ok(BAD_INPUT);
    }
    changes.apply(&mut case);
    let Some(cases) = study_cases(path, &changes, color) else { return Ok(BAD_INPUT) };
    let text = std::fs::read_to_string(path)?;
    if options.folder.as_os_str().is_empty() {
        options.folder = PathBuf::from(&case.output.directory);
    }
    let interrupt = stop_on_interrupt()?;
    let word = |path: &Path| sph_io::machine::quoted(path.to_string_lossy().into_owned());
    let go_on =
        format!("hugoniot run {}{} --out {} --resume", word(path), changes.words(), word(&options.folder));
    options.go_on.clone_from(&go_on);
    // What was kept before stands, also where a file could not be written: the way on is the same.
    let end = match cases.is_empty() {
        true => run::run(&case, &text, &options, &interrupt),
        false => study::run(&cases, &text, &options, &interrupt),
    }
    .map_err(|error| {
        error.context(format!("the run has stopped (once this is mended, go on with: {go_on})"))
    })?;
    if end == RunEnd::Interrupted {
        eprintln!("stopped; go on with: {go_on}");
    }
    Ok(match end {
        RunEnd::Refused(reason) => {
            eprintln!("error: {reason}");
            BAD_INPUT
        }
        RunEnd::Done => SUCCESS,
        RunEnd::SomeFailed => NUMERICAL_FAILURE,
        RunEnd::Interrupted => INTERRUPTED,
    })
}

/// The first Ctrl-C asks the points to stop; the second ends the process at once.
fn stop_on_interrupt() -> anyhow::Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&flag);
    ctrlc::set_handler(move || {
        if seen.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
        eprintln!("interrupted: writing what was computed; again to stop at once");
    })?;
    Ok(flag)
}

/// Cores of this machine.
pub fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
