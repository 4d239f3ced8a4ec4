//! Points of a case, side by side on the cores.
//!
//! As many points run at once as there are cores; each has its own pool of threads, so that a point never waits for
//! another. With at least as many points as cores every point runs on one thread; with fewer the cores are shared out.
//! The solver gives the same bits on any number of threads, so the results do not depend on it. Points are started in
//! the order of falling expected time: the last ones to run are short.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::config::Case;
use crate::microstructure::Sample;
use crate::outcome::PointOutcome;
use crate::point::{self, Control};
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
    /// Told when a point has ended; one call at a time. An error ends the sweep.
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
    let error = Mutex::new(None);
    std::thread::scope(|scope| {
        for worker in 0..workers {
            let share = threads_of(worker, workers, threads);
            let (order, next, error) = (&order, &next, &error);
            scope.spawn(move || {
                if let Err(e) = work(sweep, order, next, share, watch, error) {
                    lock(error).get_or_insert(e);
                }
            });
        }
    });
    error.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).map_or(Ok(()), Err)
}

/// Takes points from the queue until it is empty, the sweep is interrupted, or it has failed.
fn work(
    sweep: Sweep<'_>,
    order: &[usize],
    next: &AtomicUsize,
    threads: usize,
    watch: &dyn Watch,
    error: &Mutex<Option<anyhow::Error>>,
) -> anyhow::Result<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    while let Some(&index) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
        if watch.interrupted() || lock(error).is_some() {
            break;
        }
        let control = watch.control(index);
        let keeper = watch.keeper(index)?;
        let Sweep { case, sample, points } = sweep;
        let outcome =
            pool.install(|| point::run_kept(case, sample, points[index], control.as_ref(), keeper))?;
        let guard = lock(error);
        if guard.is_none() {
            watch.finished(index, outcome)?;
        }
    }
    Ok(())
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
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
    use super::*;

    #[test]
    fn cores_are_shared_out_without_rest() {
        for (workers, threads) in [(1, 1), (1, 8), (2, 2), (3, 8), (8, 8)] {
            let shares: Vec<usize> = (0..workers).map(|w| threads_of(w, workers, threads)).collect();
            assert_eq!(shares.iter().sum::<usize>(), threads, "{shares:?}");
        }
        assert_eq!(by_falling_cost(&[1.0, 3.0, 2.0, 3.0]), [1, 3, 2, 0]);
    }
}
