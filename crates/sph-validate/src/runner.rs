//! Runs cases side by side, the costliest first. A simulation has one thread of its own, or as many as its share of all
//! work deserves: on many cores the costliest run alone would last longer than all others together.
//!
//! A case gives the same bits whatever runs beside it, on any number of threads.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::outcome::Outcome;
use crate::store::Store;
use crate::suites::Suite;
use crate::watch::Watch;

/// A run to be done.
#[derive(Clone)]
pub struct Job<'s> {
    /// Its suite.
    pub suite: &'s dyn Suite,
    /// Which run.
    pub case: Case,
}

/// A run that has ended.
pub struct Ended<'s> {
    /// Which run.
    pub job: Job<'s>,
    /// What it gave.
    pub result: Result<Outcome, ValidateError>,
}

/// The runs of a tier: all of `suites`, those with one of `schemes`.
pub fn plan<'s>(suites: &[&'s dyn Suite], schemes: &[SchemeName], tier: Tier) -> Vec<Job<'s>> {
    let of_suite =
        |&suite: &&'s dyn Suite| suite.cases(tier).into_iter().map(move |case| Job { suite, case });
    suites.iter().flat_map(of_suite).filter(|job| schemes.contains(&job.case.scheme)).collect()
}

/// The suites of runs, each once, in the order of their first runs.
pub fn suites_of<'s>(ended: &[Ended<'s>]) -> Vec<&'s dyn Suite> {
    let mut suites: Vec<&'s dyn Suite> = Vec::new();
    for suite in ended.iter().map(|ended| ended.job.suite) {
        if suites.iter().all(|other| other.about().name != suite.about().name) {
            suites.push(suite);
        }
    }
    suites
}

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

/// Called from the threads of the runs: with the status, and with the run that has just ended.
pub type Listener<'a> = &'a (dyn Fn(Status, Option<(&Case, &Result<Outcome, ValidateError>)>) + Sync);

/// How runs are made.
#[derive(Clone, Copy)]
pub struct Settings<'a> {
    /// Runs side by side.
    pub threads: usize,
    /// Finished runs on disk: taken over from there, and kept there.
    pub store: Option<&'a Store>,
    /// Once it is set, runs under way stop.
    pub interrupt: &'a AtomicBool,
}

/// Runs `jobs`; results in their order.
pub fn run_all<'s>(jobs: Vec<Job<'s>>, settings: Settings<'_>, listener: Listener<'_>) -> Vec<Ended<'s>> {
    let meter = Meter::new(&jobs);
    let mut finished: Vec<(usize, Result<Outcome, ValidateError>)> = Vec::new();
    for (k, outcome) in kept(&jobs, settings.store) {
        meter.finish(k);
        finished.push((k, Ok(outcome)));
    }
    let is_open = |k: &usize| finished.iter().all(|(done, _)| done != k);
    let mut order: Vec<usize> = (0..jobs.len()).filter(is_open).collect();
    order.sort_by(|&a, &b| meter.work[b].total_cmp(&meter.work[a]));
    let queue = Mutex::new(VecDeque::from(order));
    let finished = Mutex::new(finished);
    std::thread::scope(|scope| {
        for _ in 0..settings.threads.clamp(1, jobs.len().max(1)) {
            scope.spawn(|| {
                let next = || lock(&queue).pop_front();
                while let Some(k) = next() {
                    let tell = |share| listener(meter.note(k, share), None);
                    let result = run_one(&jobs[k], settings, meter.threads(k, settings.threads), &tell);
                    listener(meter.finish(k), Some((&jobs[k].case, &result)));
                    lock(&finished).push((k, result));
                }
            });
        }
    });
    let mut finished = finished.into_inner().unwrap_or_else(PoisonError::into_inner);
    finished.sort_by_key(|&(k, _)| k);
    let results = finished.into_iter().map(|(_, result)| result);
    jobs.into_iter().zip(results).map(|(job, result)| Ended { job, result }).collect()
}

/// Jobs, by their places, whose outcomes are on disk.
fn kept<'j>(jobs: &'j [Job<'_>], store: Option<&'j Store>) -> impl Iterator<Item = (usize, Outcome)> + 'j {
    let load = move |job: &Job<'_>| store?.load(&job.case, &job.suite.parameters());
    jobs.iter().enumerate().filter_map(move |(k, job)| Some((k, load(job)?)))
}

/// One run; kept on disk when it has ended.
fn run_one(
    job: &Job<'_>,
    settings: Settings<'_>,
    threads: usize,
    tell: &(dyn Fn(f64) + Sync),
) -> Result<Outcome, ValidateError> {
    let watch = Watch::new(tell, settings.interrupt);
    watch.check()?;
    let outcome = run_alone(job, threads, watch)?;
    if let Some(store) = settings.store {
        store.save(&outcome, &job.suite.parameters())?;
    }
    Ok(outcome)
}

/// One run, with a pool of its own for all of its parallel loops.
fn run_alone(job: &Job<'_>, threads: usize, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(|| job.suite.run(&job.case, watch)),
        // Without a pool of its own a case still runs, in the shared one.
        Err(_) => job.suite.run(&job.case, watch),
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
    fn new(jobs: &[Job<'_>]) -> Self {
        Self {
            work: jobs.iter().map(|job| job.suite.work(&job.case)).collect(),
            shares: jobs.iter().map(|_| AtomicU64::new(0)).collect(),
            done: AtomicU64::new(0),
        }
    }

    /// Threads of a run, of so many: its share of all work, one at least.
    fn threads(&self, k: usize, threads: usize) -> usize {
        let share = self.work[k] / self.work.iter().sum::<f64>();
        ((threads as f64 * share).round() as usize).clamp(1, threads.max(1))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_go_by_the_share_of_the_work() {
        let of = |work: &[f64]| Meter {
            work: work.to_vec(),
            shares: work.iter().map(|_| AtomicU64::new(0)).collect(),
            done: AtomicU64::new(0),
        };
        let one_large = of(&[8.0, 1.0, 1.0]);
        assert_eq!([0, 1, 2].map(|k| one_large.threads(k, 10)), [8, 1, 1]);
        assert_eq!([0, 1, 2].map(|k| one_large.threads(k, 1)), [1, 1, 1]);
        assert_eq!(of(&[3.0]).threads(0, 4), 4, "one run has all threads");
        assert_eq!(of(&[0.0]).threads(0, 4), 1, "work that is not known");
    }
}
