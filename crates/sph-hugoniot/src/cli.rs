//! The command line of `hugoniot`: what each command does, and which exit code follows.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use sph_io::console;

pub use crate::arguments::{Arguments, Command};
use crate::config::units::{Length, LengthKind, show, significant};
use crate::run::{self, Earlier, RunEnd, RunOptions};
use crate::{check, config, shell, status, study, template};

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

/// Runs the command; returns the exit code.
///
/// # Errors
/// What ends the program with exit code 1: a file or folder that cannot be read, made or written, a terminal that is
/// gone. Bad input, failed points and interrupts are no errors here but exit codes.
pub fn execute(arguments: Arguments) -> anyhow::Result<u8> {
    let color = arguments.color.is_on();
    sph_io::progress::set_color(color);
    match arguments.command {
        Command::Init { template } => init(template.as_deref()),
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
            console::print(String::from_utf8_lossy(&shell::completions(shell)))?;
            Ok(SUCCESS)
        }
        Command::Man { folder } => {
            let n_pages = shell::write_manual(&folder)?;
            console::print_line(format_args!("{n_pages} pages in {}", folder.display()))?;
            Ok(SUCCESS)
        }
        Command::Schema { of } => {
            console::print(of.text())?;
            Ok(SUCCESS)
        }
    }
}

fn init(name: Option<&str>) -> anyhow::Result<u8> {
    let names = template::names();
    let Some(name) = name else {
        console::print_line(names.join("\n"))?;
        return Ok(SUCCESS);
    };
    match template::text(name) {
        Some(text) => {
            console::print(text)?;
            Ok(SUCCESS)
        }
        None => {
            let hint = config::fault::name_hint(name, &names);
            console::note(format_args!("error: there is no template {name:?}; hint: {hint}"));
            Ok(BAD_INPUT)
        }
    }
}

/// Reads a case file, once: its text, and the case that it is; its faults go to standard error.
fn load(path: &Path, color: bool) -> Option<(String, config::Case)> {
    let read = || -> Result<(String, config::Case), config::CaseError> {
        let text = config::text_of(path)?;
        let case = config::read(&text, path, None)?;
        Ok((text, case))
    };
    read().map_err(|error| console::note(error.render(color).trim_end())).ok()
}

/// Tells how far the run in a folder is.
fn show_status(folder: &Path, json: bool) -> anyhow::Result<u8> {
    let Some(found) = status::read(folder)? else {
        let below = status::runs_below(folder);
        let hint = match below.is_empty() {
            true => "the folder of results, as `hugoniot check` names it".to_owned(),
            false => format!("the folder of one run, such as {}", below.join(", ")),
        };
        console::note(format_args!("error: {}: no run has written here; hint: {hint}", folder.display()));
        return Ok(BAD_INPUT);
    };
    if json {
        console::print_line(serde_json::to_string_pretty(&found)?)?;
    } else {
        console::print(found.to_text())?;
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
    let Some((_, case)) = load(path, color) else { return Ok(BAD_INPUT) };
    let picture = picture.unwrap_or_else(|| Path::new(&case.output.directory).join("sample.png"));
    let mut check = check::Check::new(case, threads.map_or_else(available_threads, usize::from));
    check.draw(&picture);
    if json {
        console::print_line(serde_json::to_string_pretty(&check)?)?;
    } else {
        console::print(check.to_text())?;
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

    /// Tells which points cannot be in this case; true if there is one.
    fn are_refused(&self, case: &config::Case) -> bool {
        let (materials, porosity) = (case.materials(), case.medium.porosity);
        let refusal = |&u_p: &f64| {
            crate::separation::refusal(&materials, porosity, u_p)
                .or_else(|| ends_before_it_settles(case, u_p))
        };
        let refusals = self.up.iter().filter_map(refusal);
        let refusals: Vec<String> =
            refusals.map(|(text, hint)| format!("error: {text}; hint: {hint}")).collect();
        if !refusals.is_empty() {
            console::note(refusals.join("\n"));
        }
        !refusals.is_empty()
    }

    /// The options that make these changes again.
    fn words(&self) -> String {
        let list = |name: &str, items: Vec<String>| {
            if items.is_empty() { String::new() } else { format!(" {name} {}", items.join(",")) }
        };
        let sizes = self.resolutions.iter().map(|&d| same_size(d)).collect();
        list("--up", self.up.iter().map(f64::to_string).collect()) + &list("--resolutions", sizes)
    }
}

/// Message and hint where the cells that the case feeds at most do not suffice for a point of u_p [m/s]: slow fronts have
/// longer windows.
fn ends_before_it_settles(case: &config::Case, u_p: f64) -> Option<(String, String)> {
    let (most, needed) = (case.stop.max_fed_cells, case.stop.least_fed_cells(case.window.cells_at(u_p)));
    (most < needed).then(|| {
        (
            format!("u_p = {u_p} m/s: {most} cells end before the point can settle"),
            format!("in the case file, stop: (max_fed_cells: {needed}) or more: start-up and the blocks that must agree"),
        )
    })
}

/// A particle size [m] as an argument that is read as the same number.
fn same_size(size: f64) -> String {
    let texts = [show::<LengthKind>(size).replace(' ', ""), format!("{}um", significant(size * 1e6))];
    let same = |text: &String| Length::parse(text).is_ok_and(|read| read.si == size);
    texts.into_iter().find(same).unwrap_or_else(|| format!("{size:e}m"))
}

/// The case of a text at each particle size of a study; `None` if one cannot be, which is told.
fn study_cases(text: &str, path: &Path, changes: &Changes, color: bool) -> Option<Vec<config::Case>> {
    let mut cases = Vec::new();
    for &size in &changes.resolutions {
        let case = config::read(text, path, Some(size));
        let told = |error: config::CaseError| {
            let size = show::<LengthKind>(size);
            console::note(format_args!("with --resolutions {size}:\n{}", error.render(color).trim_end()));
        };
        let mut case = case.map_err(told).ok()?;
        changes.apply(&mut case);
        if case.refinement.is_some() {
            console::note(format_args!(
                "error: {}: an adaptive sweep chooses other points at each particle size; hint: --up names the points",
                path.display()
            ));
            return None;
        }
        cases.push(case);
    }
    Some(cases)
}

fn run_case(path: &Path, changes: Changes, mut options: RunOptions, color: bool) -> anyhow::Result<u8> {
    let changes = changes.sorted();
    // All that runs and all that is kept comes from this one text, however the file changes meanwhile.
    let Some((text, mut case)) = load(path, color) else { return Ok(BAD_INPUT) };
    if changes.are_refused(&case) {
        return Ok(BAD_INPUT);
    }
    changes.apply(&mut case);
    let Some(cases) = study_cases(&text, path, &changes, color) else { return Ok(BAD_INPUT) };
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
        console::note(format_args!("stopped; go on with: {go_on}"));
    }
    Ok(match end {
        RunEnd::Refused(reason) => {
            console::note(format_args!("error: {reason}"));
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
        console::note(format_args!("interrupted: writing what was computed; again to stop at once"));
    })?;
    Ok(flag)
}

/// Cores of this machine.
pub fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_that_cannot_settle_in_the_cells_of_the_file_is_told() {
        let text = template::text("porous-copper").unwrap();
        let text = text
            .replace("max_fed_cells: 60", "max_fed_cells: 26")
            .replace("\"50 m/s\", \"75 m/s\", \"100 m/s\", \"130 m/s\", ", "");
        let case = config::parse(&text, "case.ron").unwrap();
        assert_eq!(ends_before_it_settles(&case, 200.0), None);
        let (message, hint) = ends_before_it_settles(&case, 50.0).unwrap();
        assert_eq!(message, "u_p = 50 m/s: 26 cells end before the point can settle");
        assert!(hint.contains("max_fed_cells: 32"), "{hint}");
        let changes = |u_p| Changes { up: vec![u_p], ..Changes::default() };
        assert!(changes(50.0).are_refused(&case) && !changes(200.0).are_refused(&case));
    }

    #[test]
    fn sizes_to_go_on_with_are_read_as_the_same_numbers() {
        for (size, text) in [(1e-6, "1um"), (5e-7, "0.5um"), (1e-6 / 1.3, "7.692307692307691e-7m")] {
            assert_eq!(same_size(size), text);
            assert_eq!(Length::parse(text).unwrap().si, size);
        }
    }
}
