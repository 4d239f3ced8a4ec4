//! What is done with a point whose outcome on disk cannot be used.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use super::{Control, Way, run_kept};
use crate::outcome::{PointOutcome, Status};
use crate::restart::Keeper;
use crate::{config, microstructure, template};

/// u_p of the point [m/s].
const U_P: f64 = 300.0;

/// Stops a point after some steps.
struct After(AtomicU32);

impl Control for After {
    fn interrupted(&self) -> bool {
        self.0.fetch_sub(1, Ordering::Relaxed) <= 1
    }
    fn progress(&self, _way: &Way) {}
}

/// Goes on with the point in a folder for some steps.
fn go_on(folder: &Path, steps: u32) -> anyhow::Result<PointOutcome> {
    let case = config::parse(template::text("smoke").unwrap(), "smoke.ron").unwrap();
    let sample = microstructure::sample(&case);
    let keeper = Keeper::new(folder, Duration::from_secs(1_000_000)).unwrap();
    run_kept(&case, &sample, U_P, &After(AtomicU32::new(steps + 1)), Some(keeper))
}

fn states(folder: &Path) -> Vec<PathBuf> {
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let is_state = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().starts_with("state-");
    paths.filter(is_state).collect()
}

#[test]
fn a_damaged_outcome_is_set_aside_and_the_point_goes_on_from_its_state() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(go_on(folder.path(), 5).unwrap().steps, 5);
    let outcome = folder.path().join("outcome.ckpt");
    std::fs::write(&outcome, "cut short").unwrap();
    let more = go_on(folder.path(), 3).unwrap();
    assert_eq!((more.steps, more.status), (8, Status::Interrupted), "not from the beginning");
    assert!(!outcome.exists() && folder.path().join("outcome.ckpt.damaged").exists());
    assert_eq!(states(folder.path()).len(), 2);
}

#[test]
fn an_outcome_of_another_version_is_an_error_and_the_states_stay() {
    let folder = tempfile::tempdir().unwrap();
    go_on(folder.path(), 5).unwrap();
    let outcome = folder.path().join("outcome.ckpt");
    let bytes = [&b"sph-ckpt"[..], &99_u32.to_le_bytes()].concat();
    std::fs::write(&outcome, bytes).unwrap();
    let error = go_on(folder.path(), 1).unwrap_err().to_string();
    assert!(error.contains("outcome.ckpt") && error.contains("version 99"), "{error}");
    assert!(outcome.exists());
    assert_eq!(states(folder.path()).len(), 1);
}

#[test]
fn a_whole_outcome_stands_for_the_point_and_its_states_go() {
    let folder = tempfile::tempdir().unwrap();
    go_on(folder.path(), 5).unwrap();
    let kept = PointOutcome::failed(U_P, "as it was".into());
    sph_io::checkpoint::write(folder.path().join("outcome.ckpt"), &kept, &[]).unwrap();
    assert_eq!(go_on(folder.path(), 1).unwrap().status, kept.status);
    assert!(states(folder.path()).is_empty());
}

/// Runs to its end.
struct Never;

impl Control for Never {
    fn interrupted(&self) -> bool {
        false
    }
    fn progress(&self, _way: &Way) {}
}

#[test]
fn rows_of_a_search_hold_steps_of_one_trial_only() {
    let search = "search: Bisection(samples: 2, rounds: 1, tolerance: \"60 m/s\"), points:";
    let text = template::text("smoke")
        .unwrap()
        .replace("points:", search)
        .replace("max_fed_cells: 12", "max_fed_cells: 8");
    let case = config::parse(&text, "smoke.ron").unwrap();
    let sample = microstructure::sample(&case);
    let outcome = run_kept(&case, &sample, U_P, &Never, None).unwrap();
    assert!(outcome.search.len() > 2, "{:?}", outcome.search);
    let went_back = outcome.monitors.windows(2).filter(|rows| rows[1].time <= rows[0].time).count();
    assert!(went_back > 1, "trials leave rows");
    for row in &outcome.monitors {
        // The mean of steps is as long as their shortest at least, and no step is ten times another here.
        let ratio = row.time_step_mean / row.time_step_least;
        assert!((1.0..10.0).contains(&ratio), "{ratio} at {} s", row.time);
    }
}
