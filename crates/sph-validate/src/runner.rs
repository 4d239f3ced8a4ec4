//! Runs cases side by side: one case a thread, the costliest first, each simulation on one thread of its own.
//!
//! A case gives the same bits whatever runs beside it.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::case::Case;
use crate::error::ValidateError;
use crate::suites::{self, Outcome};

/// What is told of the progress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// Cases that have ended.
    pub done: usize,
    /// All cases.
    pub total: usize,
    /// Share of the estimated work that is done, 0 to 1.
    pub share: f64,
}

/// Called from the threads of the runs: with the status, and with the case that has just ended.
pub type Listener<'a> = &'a (dyn Fn(Status, Option<(Case, &Result<Outcome, ValidateError>)>) + Sync);

/// Runs `cases` on `threads` threads; results in the order of `cases`.
pub fn run_all(
    cases: &[Case],
    threads: usize,
    listener: Listener<'_>,
) -> Vec<(Case, Result<Outcome, ValidateError>)> {
    let meter = Meter::new(cases);
    let mut order: Vec<usize> = (0..cases.len()).collect();
    order.sort_by(|&a, &b| suites::work(cases[b]).total_cmp(&suites::work(cases[a])));
    let queue = Mutex::new(VecDeque::from(order));
    let finished = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, cases.len().max(1)) {
            scope.spawn(|| {
                let next = || lock(&queue).pop_front();
                while let Some(k) = next() {
                    let result = run_one(cases[k], |share| listener(meter.note(k, share), None));
                    listener(meter.finish(k), Some((cases[k], &result)));
                    lock(&finished).push((k, result));
                }
            });
        }
    });
    let mut finished = finished.into_inner().unwrap_or_else(PoisonError::into_inner);
    finished.sort_by_key(|&(k, _)| k);
    finished.into_iter().map(|(k, result)| (cases[k], result)).collect()
}

/// One case, with a pool of one thread for all of its parallel loops.
fn run_one(case: Case, progress: impl Fn(f64) + Sync + Send) -> Result<Outcome, ValidateError> {
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(|| suites::run(case, &progress)),
        // Without a pool of its own a case still runs, in the shared one.
        Err(_) => suites::run(case, &progress),
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How much of the estimated work is done.
struct Meter {
    work: Vec<f64>,
    /// Share of each case that is done, as bits of an `f64`.
    shares: Vec<AtomicU64>,
    done: AtomicU64,
}

impl Meter {
    fn new(cases: &[Case]) -> Self {
        Self {
            work: cases.iter().map(|&case| suites::work(case)).collect(),
            shares: cases.iter().map(|_| AtomicU64::new(0)).collect(),
            done: AtomicU64::new(0),
        }
    }

    fn note(&self, k: usize, share: f64) -> Status {
        self.shares[k].store(share.to_bits(), Ordering::Relaxed);
        self.status()
    }

    fn finish(&self, k: usize) -> Status {
        self.done.fetch_add(1, Ordering::Relaxed);
        self.note(k, 1.0)
    }

    fn status(&self) -> Status {
        let shares = self.shares.iter().map(|share| f64::from_bits(share.load(Ordering::Relaxed)));
        let done: f64 = shares.zip(&self.work).map(|(share, work)| share * work).sum();
        Status {
            done: self.done.load(Ordering::Relaxed) as usize,
            total: self.work.len(),
            share: done / self.work.iter().sum::<f64>(),
        }
    }
}
