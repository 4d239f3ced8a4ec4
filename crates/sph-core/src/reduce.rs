//! Sums and extremes over particles that do not depend on the number of threads.
//!
//! Indices are cut into chunks of [`CHUNK`]; a chunk is summed from its first index to its last with Neumaier's
//! compensation, and the chunks are joined along a binary tree whose shape depends on the number of indices alone. So
//! the bits are the same with 1, 2 or N threads, and nothing is allocated.
//!
//! **The seam for processes.** This is the one place where numbers of all particles come together. A process makes its
//! partial result ([`CompensatedSum`], [`Extreme`]); results are joined in the order of the ranks with
//! [`CompensatedSum::join`] and [`Extreme::join`], which any message passing can do after a gather. The bits are then
//! the same for a given number of processes, whatever the number of threads in each.
//!
//! Source: A. Neumaier, Z. Angew. Math. Mech. 54 (1974) 39.

use std::ops::Range;

/// Number of indices that are summed in one go.
pub const CHUNK: usize = 4096;

/// A sum with the rounding errors made so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CompensatedSum {
    sum: f64,
    compensation: f64,
}

impl CompensatedSum {
    /// Adds a number.
    #[inline]
    pub fn add(&mut self, value: f64) {
        let sum = self.sum + value;
        let lost =
            if self.sum.abs() >= value.abs() { (self.sum - sum) + value } else { (value - sum) + self.sum };
        // An infinite sum has lost nothing that could be named; `lost` would turn it into a NaN.
        self.compensation += if sum.is_finite() { lost } else { 0.0 };
        self.sum = sum;
    }

    /// This sum and what `later` has summed.
    pub fn join(mut self, later: Self) -> Self {
        self.add(later.sum);
        self.compensation += later.compensation;
        self
    }

    /// The sum, rounded once.
    pub fn value(self) -> f64 {
        self.sum + self.compensation
    }
}

/// A number and the index that it belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// The number.
    pub value: f64,
    /// Its index.
    pub index: usize,
}

impl Extreme {
    /// The smaller of the two; the lower index between equals. A number that is not one beats all, so that it is seen.
    pub fn join(self, other: Self) -> Self {
        let rank = |e: &Self| (!e.value.is_nan(), e.index);
        if self.value < other.value {
            self
        } else if other.value < self.value {
            other
        } else if rank(&self) <= rank(&other) {
            self
        } else {
            other
        }
    }
}

/// Σ term(i) over `0..count`.
pub fn sum_of(count: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    compensated_sum_of(count, term).value()
}

/// Σ term(i) over `0..count`, not yet rounded: what a process hands on.
pub fn compensated_sum_of(count: usize, term: impl Fn(usize) -> f64 + Sync) -> CompensatedSum {
    let chunk = |range: Range<usize>| {
        let mut sum = CompensatedSum::default();
        range.for_each(|i| sum.add(term(i)));
        sum
    };
    join_chunks(0..count, &chunk, &CompensatedSum::join)
}

/// Sum of the numbers of a column.
pub fn sum(values: &[f64]) -> f64 {
    sum_of(values.len(), |i| values[i])
}

/// Smallest value(i) over `0..count`, with the lowest index that has it; `None` for no indices. If some value is not a
/// number, the first such is returned.
pub fn minimum_of(count: usize, value: impl Fn(usize) -> f64 + Sync) -> Option<Extreme> {
    let chunk =
        |range: Range<usize>| range.map(|index| Extreme { value: value(index), index }).reduce(Extreme::join);
    join_chunks(0..count, &chunk, &|a, b| match (a, b) {
        (Some(a), Some(b)) => Some(a.join(b)),
        (a, b) => a.or(b),
    })
}

/// Results of chunks, joined along a tree that is cut at whole chunks.
fn join_chunks<T: Send>(
    range: Range<usize>,
    chunk: &(impl Fn(Range<usize>) -> T + Sync),
    join: &(impl Fn(T, T) -> T + Sync),
) -> T {
    let chunks = range.len().div_ceil(CHUNK);
    if chunks <= 1 {
        return chunk(range);
    }
    let middle = range.start + chunks / 2 * CHUNK;
    let (first, second) = rayon::join(
        || join_chunks(range.start..middle, chunk, join),
        || join_chunks(middle..range.end, chunk, join),
    );
    join(first, second)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(i: usize) -> f64 {
        (i as f64 * 12.9898).sin() * 10f64.powi((i % 17) as i32)
    }

    #[test]
    fn the_bits_do_not_depend_on_the_number_of_threads() {
        let results = [1, 2, 5].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let least = minimum_of(100_003, noise).unwrap();
                (sum_of(100_003, noise).to_bits(), least.index, least.value.to_bits())
            })
        });
        assert_eq!(results[0], results[1]);
        assert_eq!(results[0], results[2]);
    }

    #[test]
    fn what_cancels_leaves_what_is_small() {
        let n = 3 * CHUNK + 1;
        let total = sum_of(n, |i| match i {
            0 => 1e100,
            i if i == n - 1 => -1e100,
            _ => 0.5,
        });
        assert_eq!(total, 0.5 * (n - 2) as f64);
        assert_eq!(sum(&[]), 0.0);
        assert_eq!(sum(&[f64::INFINITY, 1.0]), f64::INFINITY);
        assert!(sum(&[f64::INFINITY, f64::NEG_INFINITY]).is_nan());
    }

    #[test]
    fn extremes_know_the_first_index_and_do_not_hide_what_is_not_a_number() {
        let values = [3.0, -1.0, 7.0, -1.0, 7.0];
        assert_eq!(minimum_of(5, |i| values[i]), Some(Extreme { value: -1.0, index: 1 }));
        assert_eq!(minimum_of(0, |_| 0.0), None);
        let n = 5 * CHUNK;
        for bad in [0, 1, CHUNK - 1, CHUNK, n - 1] {
            let least = minimum_of(n, |i| if i == bad { f64::NAN } else { 1.0 }).unwrap();
            assert!(least.value.is_nan() && least.index == bad);
        }
    }

    #[test]
    fn partial_sums_of_processes_join() {
        let split = 60_000;
        let first = compensated_sum_of(split, noise);
        let second = compensated_sum_of(100_003 - split, |i| noise(split + i));
        let whole = sum_of(100_003, noise);
        assert!((first.join(second).value() - whole).abs() <= 4.0 * f64::EPSILON * whole.abs());
    }
}
