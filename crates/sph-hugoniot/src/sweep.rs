//! Points of a case, side by side on the cores.
//!
//! As many points run at once as there are cores; each has its own pool of threads, so that a point never waits for
//! another. With at least as many points as cores every point runs on one thread; with fewer the cores are shared out.
//! The solver gives the same bits on any number of threads, so the results do not depend on it. Points are started in
//! the order of falling expected time: the last ones to run are short.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::config::Case;
use crate::microstructure::Sample;
use crate::outcome::PointOutcome;
use crate::point::{self, Control, Way};
use crate::restart::Keeper;

/// What watches a sweep.
pub trait Watch: Sync {
    /// What watches the point with this index.
    fn control(&self, index: usize) -> Box<dyn Control + '_>;
    /// What keeps the point with this index on disk, if anything does.
    ///
    /// # Errors
    /// If the place cannot be made.
    fn keeper(&self, index: usize) -> anyhow::Result<Option<Keeper>>;
    /// True when no further point should be started.
    fn interrupted(&self) -> bool;
    /// Told when a point has ended; one call at a time. An error ends the sweep: points under way are stopped as by an
    /// interrupt, keep their states, and are not told of.
    ///
    /// # Errors
    /// If the outcome cannot be kept or shown.
    fn finished(&self, index: usize, outcome: PointOutcome) -> anyhow::Result<()>;
}

/// What is run: some points of a case.
#[derive(Clone, Copy, Debug)]
pub struct Sweep<'c> {
    /// The case.
    pub case: &'c Case,
    /// Its sample.
    pub sample: &'c Sample,
    /// u_p of the points [m/s]; indices are places in this list.
    pub points: &'c [f64],
}

/// Runs the points, `costs` being the times expected of each; returns the first error of what keeps and shows them.
///
/// # Errors
/// The first error of [`Watch::keeper`] or [`Watch::finished`], or threads that cannot be started. A point that fails is an
/// outcome, no error.
pub fn run(sweep: Sweep<'_>, costs: &[f64], threads: usize, watch: &dyn Watch) -> anyhow::Result<()> {
    let order = by_falling_cost(costs);
    let workers = threads.clamp(1, sweep.points.len().max(1));
    let next = AtomicUsize::new(0);
    let fault = Fault::default();
    std::thread::scope(|scope| {
        for worker in 0..workers {
            let share = threads_of(worker, workers, threads);
            let (order, next, fault) = (&order, &next, &fault);
            scope.spawn(move || {
                if let Err(error) = work(sweep, order, next, share, watch, fault) {
                    fault.set(error);
                }
            });
        }
    });
    fault.first.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

/// What a sweep failed by.
#[derive(Default)]
struct Fault {
    /// Looked at after each step of each point, which the lock would hold up.
    is_set: AtomicBool,
    first: Mutex<Option<anyhow::Error>>,
}

impl Fault {
    fn set(&self, error: anyhow::Error) {
        self.lock().get_or_insert(error);
        self.is_set.store(true, Ordering::Relaxed);
    }

    fn is_set(&self) -> bool {
        self.is_set.load(Ordering::Relaxed)
    }

    fn lock(&self) -> MutexGuard<'_, Option<anyhow::Error>> {
        self.first.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Takes points from the queue until it is empty, the sweep is interrupted, or it has failed.
fn work(
    sweep: Sweep<'_>,
    order: &[usize],
    next: &AtomicUsize,
    threads: usize,
    watch: &dyn Watch,
    fault: &Fault,
) -> anyhow::Result<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    while let Some(&index) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
        if watch.interrupted() || fault.is_set() {
            break;
        }
        let control = InSweep { control: watch.control(index), fault };
        let keeper = watch.keeper(index)?;
        let Sweep { case, sample, points } = sweep;
        let outcome = pool.install(|| point::run_kept(case, sample, points[index], &control, keeper))?;
        let guard = fault.lock();
        if guard.is_none() {
            watch.finished(index, outcome)?;
        }
    }
    Ok(())
}

/// Stops a point from outside, or because the sweep has failed: nobody would be told of its end.
struct InSweep<'w> {
    control: Box<dyn Control + 'w>,
    fault: &'w Fault,
}

impl Control for InSweep<'_> {
    fn interrupted(&self) -> bool {
        self.fault.is_set() || self.control.interrupted()
    }

    fn progress(&self, way: &Way) {
        self.control.progress(way);
    }
}

/// Indices from the most expensive point to the cheapest.
fn by_falling_cost(costs: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..costs.len()).collect();
    order.sort_by(|&a, &b| costs[b].total_cmp(&costs[a]).then(a.cmp(&b)));
    order
}

/// Threads of one worker when `threads` are shared out.
fn threads_of(worker: usize, workers: usize, threads: usize) -> usize {
    (threads / workers + usize::from(worker < threads % workers)).max(1)
}

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};
    use std::time::Duration;

    use super::*;
    use crate::{config, microstructure, template};

    /// Point 0 cannot be shown at its end, which comes when point 1 is under way.
    struct Broken<'f> {
        folder: &'f Path,
        is_under_way: AtomicBool,
    }

    impl Broken<'_> {
        fn point(&self, index: usize) -> PathBuf {
            self.folder.join(index.to_string())
        }
    }

    struct Waits<'f>(&'f Broken<'f>, usize);

    impl Control for Waits<'_> {
        fn interrupted(&self) -> bool {
            let Self(Broken { is_under_way, .. }, index) = self;
            if *index == 1 {
                is_under_way.store(true, Ordering::Relaxed);
                return false;
            }
            while !is_under_way.load(Ordering::Relaxed) {
                std::thread::sleep(Duration::from_millis(1));
            }
            true
        }
        fn progress(&self, _way: &Way) {}
    }

    impl Watch for Broken<'_> {
        fn control(&self, index: usize) -> Box<dyn Control + '_> {
            Box::new(Waits(self, index))
        }
        fn keeper(&self, index: usize) -> anyhow::Result<Option<Keeper>> {
            Keeper::new(&self.point(index), Duration::from_secs(1_000_000)).map(Some)
        }
        fn interrupted(&self) -> bool {
            false
        }
        fn finished(&self, index: usize, _outcome: PointOutcome) -> anyhow::Result<()> {
            anyhow::ensure!(index != 0, "the table cannot be written");
            Ok(())
        }
    }

    #[test]
    fn an_error_stops_the_points_under_way_and_they_keep_their_states() {
        let folder = tempfile::tempdir().unwrap();
        let case = config::parse(template::text("smoke").unwrap(), "smoke.ron").unwrap();
        let sample = microstructure::sample(&case);
        let watch = Broken { folder: folder.path(), is_under_way: AtomicBool::new(false) };
        let sweep = Sweep { case: &case, sample: &sample, points: &[300.0, 310.0] };
        let error = run(sweep, &[1.0, 1.0], 2, &watch).unwrap_err().to_string();
        assert!(error.contains("the table cannot be written"), "{error}");
        let files = std::fs::read_dir(watch.point(1)).unwrap().map(|entry| entry.unwrap().file_name());
        let files: Vec<String> = files.map(|name| name.to_string_lossy().into_owned()).collect();
        assert_eq!(files, ["state-0000000001.ckpt"], "stopped where it was, not run to its end");
    }

    #[test]
    fn cores_are_shared_out_without_rest() {
        for (workers, threads) in [(1, 1), (1, 8), (2, 2), (3, 8), (8, 8)] {
            let shares: Vec<usize> = (0..workers).map(|w| threads_of(w, workers, threads)).collect();
            assert_eq!(shares.iter().sum::<usize>(), threads, "{shares:?}");
        }
        assert_eq!(by_falling_cost(&[1.0, 3.0, 2.0, 3.0]), [1, 3, 2, 0]);
    }
}
