//! `hugoniot run`: the sweep with everything around it: folder, progress, interrupt, tables, pictures.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use anyhow::{Context, Result};
use sph_io::lock::FolderLock;
use sph_io::progress::{Mode, Progress};
use sph_io::{IoError, clock, console};
use sph_riemann::StageTimes;

use crate::config::Case;
use crate::config::case::Refinement;
use crate::estimate;
use crate::microstructure::{self, Sample};
use crate::outcome::{PointOutcome, Status};
use crate::point::Control;
use crate::refine;
use crate::report::curves::{Curves, load_data};
use crate::report::html::RunFacts;
use crate::report::{Report, earlier, monitors, summary};
use crate::restart::Keeper;
use crate::status::{StatusBoard, Way};
use crate::sweep::{self, Sweep, Watch};

/// How a run is made.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Folder of the results.
    pub folder: PathBuf,
    /// Cores to use.
    pub threads: usize,
    /// Without progress and summary.
    pub quiet: bool,
    /// The summary as JSON.
    pub json: bool,
    /// What happens to results that are there already.
    pub earlier: Earlier,
    /// Time between two states of a point on disk.
    pub keep_every: Duration,
    /// The command that goes on with the run.
    pub go_on: String,
}

/// What happens to results that a run finds in its folder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Earlier {
    /// The run is refused: nothing is lost by accident.
    #[default]
    Refuse,
    /// The run goes on where they end, with the same bits.
    Resume,
    /// They are replaced.
    Replace,
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RunEnd {
    /// All points ran.
    Done,
    /// At least one point failed.
    SomeFailed,
    /// Stopped from outside.
    Interrupted,
    /// Not started: what is in the folder stands against it, as the sentence says.
    Refused(String),
}

impl RunEnd {
    /// A word for it.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::SomeFailed => "some failed",
            Self::Interrupted => "interrupted",
            Self::Refused(_) => "refused",
        }
    }
}

/// Runs all points of a case. `interrupt` is looked at after each step.
///
/// # Errors
/// If a file or folder of the run cannot be read, made or written. A folder that is in use or holds another run, data that
/// cannot be read and failed points are no errors but [`RunEnd`]s.
pub fn run(case: &Case, case_text: &str, options: &RunOptions, interrupt: &AtomicBool) -> Result<RunEnd> {
    let (started, began) = (Instant::now(), SystemTime::now());
    let sample = microstructure::sample(case);
    let _lock = match hold(&options.folder)? {
        Ok(lock) => lock,
        Err(refused) => return Ok(refused),
    };
    // Before earlier results are thrown away all that may refuse the run has had its say.
    let data = match load_data(case) {
        Ok(data) => data,
        Err(error) => return Ok(RunEnd::Refused(error.to_string())),
    };
    if let Some(refusal) = earlier::settle(&options.folder, case, options.earlier)? {
        return Ok(RunEnd::Refused(refusal));
    }
    earlier::clear_leftovers(&options.folder)?;
    let report = Report::create(&options.folder, case, case_text)?;
    let board = StatusBoard::new(&options.folder, &case.name, &options.go_on);
    let to_its_end = || -> Result<(RunEnd, String)> {
        let (outcomes, way_out) = rounds(case, &sample, &report, &board, options, interrupt)?;
        let finished: Vec<&PointOutcome> = outcomes.iter().collect();
        let curves = Curves::new(case, &sample, &finished, &data);
        report.write_curves(&curves)?;
        let facts = RunFacts {
            command: sph_io::machine::command(),
            started: clock::unix_seconds(began),
            seconds: started.elapsed().as_secs_f64(),
            threads: options.threads,
            case_text: case_text.to_owned(),
        };
        report.write_page(&curves, &sample, &finished, &facts)?;
        let end = end_of(&finished, way_out);
        board.finish(end.word());
        let seconds = started.elapsed().as_secs_f64();
        let words = match (options.json, options.quiet) {
            (true, _) => format!("{:#}\n", summary::json(&end, &finished, report.folder(), seconds)),
            (false, false) => summary_text(&curves, &finished, report.folder(), seconds),
            (false, true) => String::new(),
        };
        Ok((end, words))
    };
    // Without this word the run would look killed.
    let (end, words) = to_its_end().inspect_err(|_| board.break_off())?;
    console::print(words)?;
    Ok(end)
}

/// Makes the folder and holds it for this process; how the run ends if another is at work there.
///
/// # Errors
/// If the folder cannot be made or locked.
pub(crate) fn hold(folder: &Path) -> Result<Result<FolderLock, RunEnd>> {
    std::fs::create_dir_all(folder)
        .with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
    match FolderLock::acquire(folder) {
        Ok(lock) => Ok(Ok(lock)),
        Err(error @ IoError::Locked { .. }) => Ok(Err(RunEnd::Refused(error.to_string()))),
        Err(error) => Err(error.into()),
    }
}

/// Round after round until no further point is asked for; all outcomes, in the order of u_p, and whether any are missing.
fn rounds(
    case: &Case,
    sample: &Sample,
    report: &Report,
    board: &StatusBoard,
    options: &RunOptions,
    interrupt: &AtomicBool,
) -> Result<(Vec<PointOutcome>, WayOut)> {
    let (mut finished, mut begun) = (Vec::new(), 0);
    let mut points = case.points.clone();
    loop {
        begun += points.len();
        let sweep = Sweep { case, sample, points: &points };
        board.expect(&points);
        finished = round(sweep, finished, report, board, options, interrupt)?;
        let interrupted = interrupt.load(Ordering::Relaxed);
        match next_round(&finished, begun, case.refinement.as_ref(), interrupted) {
            Next::Points(more) => points = more,
            Next::End(way_out) => return Ok((finished, way_out)),
        }
    }
}

/// How the last round ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum WayOut {
    /// Every point that was asked for is at its end.
    Whole,
    /// Stopped from outside, with points not begun or not at their end.
    CutShort,
}

/// What follows a round.
#[derive(Clone, Debug, PartialEq)]
enum Next {
    /// Another round with these points [m/s].
    Points(Vec<f64>),
    /// Nothing.
    End(WayOut),
}

/// What follows a round, `begun` being the number of all points so far. An interrupt that came when all points were at their
/// end has cut nothing short.
fn next_round(
    finished: &[PointOutcome],
    begun: usize,
    refinement: Option<&Refinement>,
    interrupted: bool,
) -> Next {
    if finished.len() < begun || finished.iter().any(|o| o.status == Status::Interrupted) {
        return Next::End(WayOut::CutShort);
    }
    let known: Vec<refine::Known> = finished.iter().map(PointOutcome::known).collect();
    let more = refinement.map_or(Vec::new(), |refinement| refine::next_points(&known, refinement));
    match (more.is_empty(), interrupted) {
        (true, _) => Next::End(WayOut::Whole),
        (false, true) => Next::End(WayOut::CutShort),
        (false, false) => Next::Points(more),
    }
}

/// Runs some points; their outcomes together with the earlier ones, in the order of u_p.
fn round(
    sweep: Sweep<'_>,
    earlier: Vec<PointOutcome>,
    report: &Report,
    board: &StatusBoard,
    options: &RunOptions,
    interrupt: &AtomicBool,
) -> Result<Vec<PointOutcome>> {
    let cost = |&u: &f64| estimate::point(sweep.case, sweep.sample, u).seconds;
    let costs: Vec<f64> = sweep.points.iter().map(cost).collect();
    let mode = if options.quiet { Mode::Quiet } else { Mode::Auto };
    let more = if earlier.is_empty() { "" } else { "more " };
    let label = format!("{}, {}", sweep.case.name, counted(sweep.points.len(), &format!("{more}point")));
    let watcher = Watcher {
        sweep,
        earlier: &earlier,
        report,
        board,
        interrupt,
        keep_every: options.keep_every,
        state: Mutex::new(State {
            outcomes: sweep.points.iter().map(|_| None).collect(),
            parts: vec![0.0; costs.len()],
            progress: Some(Progress::new(costs.iter().sum(), label, mode)),
        }),
        costs: &costs,
    };
    sweep::run(sweep, &costs, options.threads, &watcher)?;
    let new = watcher.finish();
    let mut all = earlier;
    all.extend(new);
    all.sort_by(|a, b| a.particle_velocity.total_cmp(&b.particle_velocity));
    Ok(all)
}

/// `1 point`, `2 points`.
fn counted(count: usize, word: &str) -> String {
    format!("{count} {word}{}", if count == 1 { "" } else { "s" })
}

fn end_of(outcomes: &[&PointOutcome], way_out: WayOut) -> RunEnd {
    if way_out == WayOut::CutShort {
        RunEnd::Interrupted
    } else if outcomes.iter().any(|o| o.has_failed()) {
        RunEnd::SomeFailed
    } else {
        RunEnd::Done
    }
}

fn summary_text(curves: &Curves<'_>, outcomes: &[&PointOutcome], folder: &Path, seconds: f64) -> String {
    let mut stages = StageTimes::default();
    outcomes.iter().for_each(|o| stages.merge(&o.stages));
    let mut lines = vec![summary::points(outcomes).to_text()];
    lines.extend(curves.lines());
    lines.extend([String::new(), summary::stages(&stages).to_text()]);
    let steps: u64 = outcomes.iter().map(|o| o.particle_steps).sum();
    let core_seconds: f64 = outcomes.iter().map(|o| o.wall_seconds).sum();
    let rate = steps as f64 / core_seconds / 1e6;
    lines.push(format!(
        "{seconds:.1} s; {rate:.2} million particle-steps/s in a point; lists rebuilt {} times; \
         results in {}, open report.html there",
        stages.rebuilds,
        folder.display()
    ));
    lines.extend(monitors::interventions(outcomes).iter().map(|line| format!("bound that acted: {line}")));
    lines.push(String::new());
    lines.join("\n")
}

/// Keeps the state of a sweep and what is shown of it.
struct Watcher<'r> {
    sweep: Sweep<'r>,
    /// Outcomes of earlier rounds.
    earlier: &'r [PointOutcome],
    report: &'r Report,
    board: &'r StatusBoard,
    interrupt: &'r AtomicBool,
    keep_every: Duration,
    costs: &'r [f64],
    state: Mutex<State>,
}

struct State {
    outcomes: Vec<Option<PointOutcome>>,
    /// Part of each point that is done [-].
    parts: Vec<f64>,
    progress: Option<Progress>,
}

impl Watcher<'_> {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Shows how far the sweep is; the time left.
    fn show(&self, index: usize, part: f64, message: &str) -> Option<Duration> {
        let mut state = self.state();
        state.parts[index] = part.min(1.0);
        let done = state.parts.iter().zip(self.costs).map(|(part, cost)| part * cost).sum();
        let progress = state.progress.as_mut()?;
        progress.update(done, message);
        progress.eta()
    }

    fn note(&self, line: &str) {
        if let Some(progress) = &mut self.state().progress {
            progress.note(line);
        }
    }

    /// The outcomes, in the order of u_p.
    fn finish(self) -> Vec<PointOutcome> {
        let state = self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        let outcomes: Vec<PointOutcome> = state.outcomes.into_iter().flatten().collect();
        if let Some(progress) = state.progress {
            let ended = outcomes.iter().filter(|outcome| outcome.status != Status::Interrupted).count();
            progress.finish(&format!("{ended} of {} ended", counted(self.costs.len(), "point")));
        }
        outcomes
    }
}

impl Watch for Watcher<'_> {
    fn control(&self, index: usize) -> Box<dyn Control + '_> {
        Box::new(PointControl { watcher: self, index })
    }

    fn keeper(&self, index: usize) -> Result<Option<Keeper>> {
        let folder = self.report.point_folder(self.sweep.points[index]);
        Keeper::new(&folder, self.keep_every).map(Some)
    }

    fn interrupted(&self) -> bool {
        self.interrupt.load(Ordering::Relaxed)
    }

    fn finished(&self, index: usize, outcome: PointOutcome) -> Result<()> {
        self.report.write_point(self.sweep.case, &outcome)?;
        self.board.ended(&outcome, self.sweep.sample.cell);
        let line = summary::line(&outcome);
        match outcome.status {
            Status::Failed(_) => console::note(&line),
            _ => self.note(&line),
        }
        let mut state = self.state();
        state.outcomes[index] = Some(outcome);
        let mut finished: Vec<&PointOutcome> = state.outcomes.iter().flatten().chain(self.earlier).collect();
        finished.sort_by(|a, b| a.particle_velocity.total_cmp(&b.particle_velocity));
        self.report.write_table(self.sweep.case, self.sweep.sample, &finished)?;
        drop(state);
        self.show(index, 1.0, "");
        Ok(())
    }
}

struct PointControl<'w> {
    watcher: &'w Watcher<'w>,
    index: usize,
}

impl Control for PointControl<'_> {
    fn interrupted(&self) -> bool {
        self.watcher.interrupted()
    }

    fn progress(&self, way: &Way) {
        let u_p = self.watcher.sweep.points[self.index];
        let (swept, expected) = (way.swept_cells, way.expected_cells);
        let message = format!("u_p = {u_p} m/s, cell {swept:.0} of {expected:.0}");
        let left = self.watcher.show(self.index, swept / expected, &message);
        self.watcher.board.progress(u_p, way, left.map(|left| left.as_secs_f64()));
    }
}

#[cfg(test)]
#[path = "run_tests.rs"]
mod tests;
