//! How far a run is, to be read by another process: `status.json` in its folder, written anew while it goes on.
//!
//! The file is whole at any moment. Whether the run is still alive is not in the file, which a killed process cannot
//! change, but in the lock of the folder, which ends with the process.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use sph_io::clock::{unix_seconds, utc};
use sph_io::lock::FolderLock;
use sph_io::table::{Column, Table};

use crate::check::duration;
use crate::outcome::{PointOutcome, Status};

/// Name of the file.
pub const FILE: &str = "status.json";
/// Version of its form.
pub const FORMAT: u32 = 1;
/// Least time between two writings.
const INTERVAL: Duration = Duration::from_secs(1);

/// The end of a run that an error stopped: a full disk, a folder that must not be written to.
const BROKEN_OFF: &str = "stopped by an error";

/// What a point is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Phase {
    /// Not begun.
    Waiting,
    /// Under way.
    Running,
    /// At its end, whatever that was.
    Ended,
}

/// One point. Numbers that are not known yet are absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PointStatus {
    /// u_p [m/s].
    pub particle_velocity: f64,
    /// What it is doing.
    pub phase: Phase,
    /// Cells that the front has swept.
    pub swept_cells: f64,
    /// Cells that it will have swept at least, as it looks now.
    pub expected_cells: Option<f64>,
    /// u_s so far, or at the end [m/s].
    pub shock_velocity: Option<f64>,
    /// Its standard error [m/s].
    pub standard_error: Option<f64>,
    /// Time that the point took in this run [s].
    pub seconds: f64,
    /// Time left at the pace so far [s].
    pub seconds_left: Option<f64>,
    /// How it ended.
    pub result: Option<String>,
}

/// A run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunStatus {
    /// Version of this form.
    pub format: u32,
    /// Program and version.
    pub program: String,
    /// Name of the case.
    pub case: String,
    /// The command that goes on with the run.
    pub go_on: String,
    /// Process id of the run.
    pub process: u32,
    /// When it began, since 1970 [s].
    pub started: f64,
    /// When this was written, since 1970 [s].
    pub updated: f64,
    /// Time left for the points that are known, at the pace so far [s].
    pub seconds_left: Option<f64>,
    /// How the run ended, in a word; absent while it goes on, and after it was killed.
    pub end: Option<String>,
    /// The points, in the order of u_p.
    pub points: Vec<PointStatus>,
}

/// How far a point has come.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// Cells that the front has swept.
    pub swept_cells: f64,
    /// Cells that it will have swept at least.
    pub expected_cells: f64,
    /// u_s so far [m/s]; `NaN` if there is none.
    pub shock_velocity: f64,
}

/// Keeps the file of a run.
#[derive(Debug)]
pub struct StatusBoard {
    path: PathBuf,
    state: Mutex<Board>,
}

#[derive(Debug)]
struct Board {
    status: RunStatus,
    /// When each point began, and the cells that it had swept then.
    begun: Vec<(f64, Instant, f64)>,
    written: Option<Instant>,
    /// That the file could not be written has been told.
    told: bool,
}

impl StatusBoard {
    /// The board of a run that begins; `go_on` is the command that goes on with it.
    pub fn new(folder: &Path, case: &str, go_on: &str) -> Self {
        let now = unix_seconds(SystemTime::now());
        let status = RunStatus {
            format: FORMAT,
            program: crate::report::machine::VERSION.to_owned(),
            case: case.to_owned(),
            go_on: go_on.to_owned(),
            process: std::process::id(),
            started: now,
            updated: now,
            seconds_left: None,
            end: None,
            points: Vec::new(),
        };
        let state = Mutex::new(Board { status, begun: Vec::new(), written: None, told: false });
        Self { path: folder.join(FILE), state }
    }

    fn state(&self) -> MutexGuard<'_, Board> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Points that will be run.
    pub fn expect(&self, points: &[f64]) {
        let mut board = self.state();
        for &u_p in points {
            board.point(u_p);
        }
        self.write(&mut board, true);
    }

    /// A point on its way; `seconds_left` is that of the whole run.
    pub fn progress(&self, particle_velocity: f64, way: &Way, seconds_left: Option<f64>) {
        let mut board = self.state();
        board.status.seconds_left = seconds_left;
        board.advance(particle_velocity, way);
        self.write(&mut board, false);
    }

    /// A point at its end.
    pub fn ended(&self, outcome: &PointOutcome, cell: f64) {
        let mut board = self.state();
        let point = board.point(outcome.particle_velocity);
        let swept = outcome.cell_velocities.last().map_or(0.0, |c| c.1 / cell);
        point.phase = if outcome.status == Status::Interrupted { Phase::Running } else { Phase::Ended };
        point.swept_cells = point.swept_cells.max(swept);
        point.expected_cells = None;
        point.seconds_left = None;
        point.seconds = outcome.wall_seconds;
        point.shock_velocity = finite(outcome.shock_velocity);
        point.standard_error = finite(outcome.standard_error);
        point.result = Some(outcome.status.to_string());
        self.write(&mut board, true);
    }

    /// The run at its end.
    pub fn finish(&self, end: &str) {
        let mut board = self.state();
        board.status.end = Some(end.to_owned());
        board.status.seconds_left = None;
        self.write(&mut board, true);
    }

    /// The run at its end by an error, which tells more than that this file, too, could not be written.
    pub fn break_off(&self) {
        self.state().told = true;
        self.finish(BROKEN_OFF);
    }

    /// Writes the file, if it is time. That nobody can read it is no reason to stop a run; it is told once.
    fn write(&self, board: &mut Board, now: bool) {
        if !now && board.written.is_some_and(|last| last.elapsed() < INTERVAL) {
            return;
        }
        board.status.updated = unix_seconds(SystemTime::now());
        let text = serde_json::to_string_pretty(&board.status).unwrap_or_default();
        if let Err(error) = sph_io::write_atomic(&self.path, text.as_bytes())
            && !std::mem::replace(&mut board.told, true)
        {
            tracing::warn!("{error}; `hugoniot status` does not see how far the run is");
        }
        board.written = Some(Instant::now());
    }
}

impl Board {
    fn point(&mut self, particle_velocity: f64) -> &mut PointStatus {
        let points = &mut self.status.points;
        let at = points.partition_point(|p| p.particle_velocity < particle_velocity);
        if points.get(at).is_none_or(|p| p.particle_velocity != particle_velocity) {
            points.insert(at, PointStatus::waiting(particle_velocity));
        }
        &mut points[at]
    }

    fn advance(&mut self, particle_velocity: f64, way: &Way) {
        let found = self.begun.iter().find(|b| b.0 == particle_velocity).copied();
        let (_, since, first) = found.unwrap_or_else(|| {
            self.begun.push((particle_velocity, Instant::now(), way.swept_cells));
            (particle_velocity, Instant::now(), way.swept_cells)
        });
        let (seconds, done) = (since.elapsed().as_secs_f64(), way.swept_cells - first);
        let left = seconds * (way.expected_cells - way.swept_cells).max(0.0) / done;
        let point = self.point(particle_velocity);
        point.phase = Phase::Running;
        point.swept_cells = way.swept_cells;
        point.expected_cells = finite(way.expected_cells);
        point.shock_velocity = finite(way.shock_velocity);
        point.seconds = seconds;
        point.seconds_left = finite(left);
    }
}

impl PointStatus {
    fn waiting(particle_velocity: f64) -> Self {
        Self {
            particle_velocity,
            phase: Phase::Waiting,
            swept_cells: 0.0,
            expected_cells: None,
            shock_velocity: None,
            standard_error: None,
            seconds: 0.0,
            seconds_left: None,
            result: None,
        }
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// What a look at a folder finds: the file, and whether the run is alive.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Found {
    /// `running`, `done`, `some failed`, `interrupted`, `stopped by an error`, or `killed`.
    pub state: String,
    /// What the run wrote last.
    #[serde(flatten)]
    pub status: RunStatus,
}

/// Reads the status of a folder; `None` if no run was ever there.
///
/// # Errors
/// If the file cannot be read, or is not what a run writes.
pub fn read(folder: &Path) -> Result<Option<Found>> {
    let path = folder.join(FILE);
    if !path.exists() {
        return Ok(None);
    }
    // The lock first: a run that ends between the two looks is then seen with its last word.
    let holder = FolderLock::holder(folder)?;
    let text =
        std::fs::read_to_string(&path).with_context(|| format!("{}: cannot be read", path.display()))?;
    let status: RunStatus = serde_json::from_str(&text)
        .with_context(|| format!("{}: is not what a run of this version writes", path.display()))?;
    let state = match (&status.end, holder) {
        (None, Some(_)) => "running".to_owned(),
        (None, None) => "killed".to_owned(),
        (Some(end), _) => end.clone(),
    };
    Ok(Some(Found { state, status }))
}

/// Folders of runs just below a folder, in the order of their names: those of a resolution study.
pub fn runs_below(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let runs = entries.map(|entry| entry.path()).filter(|path| path.join(FILE).exists());
    let mut names: Vec<String> = runs.map(|path| path.display().to_string()).collect();
    names.sort();
    names
}

impl Found {
    /// The text for people.
    pub fn to_text(&self) -> String {
        let (status, now) = (&self.status, unix_seconds(SystemTime::now()));
        let ended = status.points.iter().filter(|p| p.phase == Phase::Ended).count();
        let n = status.points.len();
        let age = duration((now - status.updated).max(0.0));
        let head = format!("{}: {}, {ended} of {n} points ended", status.case, self.state);
        let tail = match self.state.as_str() {
            "running" => {
                let left =
                    status.seconds_left.map_or(String::new(), |s| format!("; about {} left", duration(s)));
                format!(
                    "{left} (process {}, begun {}, {age} ago looked at)",
                    status.process,
                    utc(status.started)
                )
            }
            "killed" => format!(
                "; process {} is gone, its last word is {age} old\ngo on with: {}",
                status.process, status.go_on
            ),
            "interrupted" | BROKEN_OFF => format!(" {age} ago\ngo on with: {}", status.go_on),
            _ => format!(" {age} ago"),
        };
        format!("{head}{tail}\n{}", self.table().to_text())
    }

    fn table(&self) -> Table {
        let points = &self.status.points;
        let words = |name: &str, unit: &str, word: &dyn Fn(&PointStatus) -> String| {
            let column = Column::text(name, "", points.iter().map(word).collect::<Vec<_>>());
            Column { unit: unit.to_owned(), ..column }
        };
        let killed = self.state != "running";
        let phase = |p: &PointStatus| match (&p.result, p.phase) {
            (Some(result), _) => result.split(':').next().unwrap_or(result).to_owned(),
            (None, Phase::Running) if killed => "stopped".to_owned(),
            (None, Phase::Running) => "running".to_owned(),
            (None, _) => "waiting".to_owned(),
        };
        let cells = |p: &PointStatus| match p.expected_cells {
            Some(expected) => format!("{:.1} of {expected:.0}", p.swept_cells),
            None if p.phase == Phase::Waiting => String::new(),
            None => format!("{:.1}", p.swept_cells),
        };
        let speed = |p: &PointStatus| match (p.shock_velocity, p.standard_error) {
            (Some(u_s), Some(error)) => format!("{u_s:.1} ± {error:.1}"),
            (Some(u_s), None) => format!("{u_s:.0} so far"),
            _ => String::new(),
        };
        let time = |p: &PointStatus| if p.seconds > 0.0 { duration(p.seconds) } else { String::new() };
        let left = |p: &PointStatus| match p.seconds_left {
            Some(seconds) if !killed => duration(seconds),
            _ => String::new(),
        };
        let u_p: Vec<f64> = points.iter().map(|p| p.particle_velocity).collect();
        Table::new("")
            .with(Column::float("u_p", "m/s", "", u_p))
            .with(words("point", "", &phase))
            .with(words("cells", "", &cells))
            .with(words("u_s", "m/s", &speed))
            .with(words("time", "", &time))
            .with(words("left", "", &left))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_tells_of_each_point_and_a_look_tells_whether_the_run_lives() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(read(folder.path()).unwrap(), None);
        let lock = FolderLock::acquire(folder.path()).unwrap();
        let board = StatusBoard::new(folder.path(), "test", "hugoniot run case.ron --resume");
        board.expect(&[200.0, 100.0]);
        board.progress(
            200.0,
            &Way { swept_cells: 3.0, expected_cells: 12.0, shock_velocity: f64::NAN },
            Some(9.0),
        );
        board.ended(&PointOutcome::failed(100.0, "broken".into()), 1e-5);
        let found = read(folder.path()).unwrap().unwrap();
        assert_eq!(found.state, "running");
        assert_eq!(
            found.status.points.iter().map(|p| p.particle_velocity).collect::<Vec<_>>(),
            [100.0, 200.0]
        );
        let text = found.to_text();
        for part in ["1 of 2 points ended", "about 9 s left", "failed", "3.0 of 12"] {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }

        drop(lock);
        let text = read(folder.path()).unwrap().unwrap().to_text();
        assert!(
            text.contains("killed") && text.contains("go on with: hugoniot run case.ron --resume"),
            "{text}"
        );
        assert!(text.contains("stopped"), "{text}");

        // A point that was stopped has a result so far, and is not at its end.
        let stopped =
            PointOutcome { status: Status::Interrupted, ..PointOutcome::failed(200.0, String::new()) };
        board.ended(&stopped, 1e-5);
        let text = read(folder.path()).unwrap().unwrap().to_text();
        assert!(text.contains("1 of 2 points ended") && text.contains("interrupted"), "{text}");

        board.break_off();
        let text = read(folder.path()).unwrap().unwrap().to_text();
        assert!(
            text.contains("test: stopped by an error, 1 of 2") && text.contains("go on with: "),
            "{text}"
        );

        board.finish("done");
        assert_eq!(read(folder.path()).unwrap().unwrap().state, "done");
    }

    #[test]
    fn another_file_of_that_name_is_told() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(FILE), "{}").unwrap();
        let error = format!("{:#}", read(folder.path()).unwrap_err());
        assert!(error.contains("status.json") && error.contains("not what a run"), "{error}");
    }
}
