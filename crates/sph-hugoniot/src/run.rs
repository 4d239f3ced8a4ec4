//! `hugoniot run`: the sweep with everything around it: folder, progress, interrupt, tables, pictures.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use sph_io::IoError;
use sph_io::lock::FolderLock;
use sph_io::progress::{Mode, Progress};
use sph_riemann::StageTimes;

use crate::config::Case;
use crate::estimate;
use crate::microstructure::{self, Sample};
use crate::outcome::{PointOutcome, Status};
use crate::point::Control;
use crate::report::{Report, earlier, summary};
use crate::restart::Keeper;
use crate::sweep::{self, Watch};

/// How a run is made.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Folder of the results.
    pub folder: PathBuf,
    /// Cores to use.
    pub threads: usize,
    /// Without progress and summary.
    pub quiet: bool,
    /// What happens to results that are there already.
    pub earlier: Earlier,
    /// Time between two states of a point on disk.
    pub keep_every: Duration,
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

/// Runs all points of a case. `interrupt` is looked at after each step.
pub fn run(case: &Case, case_text: &str, options: &RunOptions, interrupt: &AtomicBool) -> Result<RunEnd> {
    let started = Instant::now();
    let sample = microstructure::sample(&case.medium, case.material.reference_density);
    std::fs::create_dir_all(&options.folder)
        .with_context(|| format!("{}: the folder cannot be made", options.folder.display()))?;
    let _lock = match FolderLock::acquire(&options.folder) {
        Ok(lock) => lock,
        Err(error @ IoError::Locked { .. }) => return Ok(RunEnd::Refused(error.to_string())),
        Err(error) => return Err(error.into()),
    };
    if let Some(refusal) = earlier::settle(&options.folder, case, options.earlier)? {
        return Ok(RunEnd::Refused(refusal));
    }
    let report = Report::create(&options.folder, case, case_text)?;
    let costs: Vec<f64> = case.points.iter().map(|&u| estimate::point(case, &sample, u).seconds).collect();
    let mode = if options.quiet { Mode::Quiet } else { Mode::Auto };
    let label = format!("{}, {} points", case.name, case.points.len());
    let watcher = Watcher {
        case,
        sample: &sample,
        report: &report,
        interrupt,
        keep_every: options.keep_every,
        state: Mutex::new(State {
            outcomes: case.points.iter().map(|_| None).collect(),
            parts: vec![0.0; costs.len()],
            progress: Some(Progress::new(costs.iter().sum(), label, mode)),
        }),
        costs: &costs,
    };
    sweep::run(case, &sample, &costs, options.threads, &watcher)?;
    let outcomes = watcher.finish();
    let finished: Vec<&PointOutcome> = outcomes.iter().collect();
    report.write_curves(case, &sample, &finished)?;
    if !options.quiet {
        print_summary(&finished, report.folder(), started.elapsed().as_secs_f64());
    }
    Ok(end_of(&finished, interrupt))
}

fn end_of(outcomes: &[&PointOutcome], interrupt: &AtomicBool) -> RunEnd {
    if interrupt.load(Ordering::Relaxed) {
        RunEnd::Interrupted
    } else if outcomes.iter().any(|o| o.has_failed()) {
        RunEnd::SomeFailed
    } else {
        RunEnd::Done
    }
}

fn print_summary(outcomes: &[&PointOutcome], folder: &Path, seconds: f64) {
    let mut stages = StageTimes::default();
    outcomes.iter().for_each(|o| stages.merge(&o.stages));
    println!("{}", summary::points(outcomes).to_text());
    println!("{}", summary::stages(&stages).to_text());
    let steps: u64 = outcomes.iter().map(|o| o.particle_steps).sum();
    let core_seconds: f64 = outcomes.iter().map(|o| o.wall_seconds).sum();
    let rate = steps as f64 / core_seconds / 1e6;
    println!(
        "{seconds:.1} s; {rate:.2} million particle-steps/s in a point; results in {}",
        folder.display()
    );
}

/// Keeps the state of a sweep and what is shown of it.
struct Watcher<'r> {
    case: &'r Case,
    sample: &'r Sample,
    report: &'r Report,
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

    fn show(&self, index: usize, part: f64, message: &str) {
        let mut state = self.state();
        state.parts[index] = part.min(1.0);
        let done = state.parts.iter().zip(self.costs).map(|(part, cost)| part * cost).sum();
        if let Some(progress) = &mut state.progress {
            progress.update(done, message);
        }
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
            progress.finish(&format!("{} points", outcomes.len()));
        }
        outcomes
    }
}

impl Watch for Watcher<'_> {
    fn control(&self, index: usize) -> Box<dyn Control + '_> {
        Box::new(PointControl { watcher: self, index })
    }

    fn keeper(&self, index: usize) -> Result<Option<Keeper>> {
        let folder = self.report.point_folder(self.case.points[index]);
        Keeper::new(&folder, self.keep_every).map(Some)
    }

    fn interrupted(&self) -> bool {
        self.interrupt.load(Ordering::Relaxed)
    }

    fn finished(&self, index: usize, outcome: PointOutcome) -> Result<()> {
        self.report.write_point(self.case, &outcome)?;
        let line = summary::line(&outcome);
        match outcome.status {
            Status::Failed(_) => eprintln!("{line}"),
            _ => self.note(&line),
        }
        let mut state = self.state();
        state.outcomes[index] = Some(outcome);
        let finished: Vec<&PointOutcome> = state.outcomes.iter().flatten().collect();
        self.report.write_table(self.case, self.sample, &finished)?;
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

    fn progress(&self, swept_cells: f64, expected_cells: f64) {
        let u_p = self.watcher.case.points[self.index];
        let message = format!("u_p = {u_p} m/s, cell {swept_cells:.0} of {expected_cells:.0}");
        self.watcher.show(self.index, swept_cells / expected_cells, &message);
    }
}
