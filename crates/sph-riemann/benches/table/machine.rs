//! What the machine can do: fused multiply-adds and bytes a second, measured.

use std::hint::black_box;
use std::time::Instant;

use rayon::prelude::*;
use sph_core::lanes::{InstructionSet, LANES, LaneKernel, Lanes, dispatch_with};

/// Limits of the machine for one and two threads.
pub struct Machine {
    /// Operations a second of each set of instructions, one thread; a fused multiply-add counts two.
    sets: Vec<(InstructionSet, f64)>,
    /// Of the set in use, with one thread and two [1/s].
    operations: [f64; 2],
    /// Bytes a second, read and written, with one thread and two.
    bandwidth: [f64; 2],
}

const ROUNDS: usize = 20_000;

/// Independent chains of multiply-adds: more than latency times units, and not more than there are registers for.
struct FusedMultiplyAdds<'a, const CHAINS: usize>(&'a mut f64);

impl<const CHAINS: usize> LaneKernel for FusedMultiplyAdds<'_, CHAINS> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let factor = L::splat(black_box(1.0 - 1e-9));
        let term = L::splat(black_box(1e-9));
        // All different, so that no two chains are one to the compiler.
        let start = L::load(black_box(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]));
        let mut chains = [start; CHAINS];
        for c in 0..CHAINS {
            chains[c] = start + L::splat(black_box(c as f64));
        }
        for _ in 0..ROUNDS {
            for chain in &mut chains {
                *chain = chain.mul_add(factor, term);
            }
        }
        let mut sum = L::zero();
        for chain in chains {
            sum += chain;
        }
        // Every lane: the compiler leaves out registers that nobody asks for.
        *self.0 = sum.to_array().iter().sum();
    }
}

/// Best rate of some rounds of `work`, which does `amount` on each of `threads`.
fn best(threads: usize, repeats: usize, amount: f64, work: impl Fn(usize) + Sync) -> f64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let time = || {
        let start = Instant::now();
        pool.install(|| (0..threads).into_par_iter().with_max_len(1).for_each(&work));
        start.elapsed().as_secs_f64()
    };
    let least = (0..repeats).map(|_| time()).fold(f64::INFINITY, f64::min);
    amount * threads as f64 / least
}

fn fused(set: InstructionSet, threads: usize, repeats: usize) -> f64 {
    let chains = if set == InstructionSet::Avx512 { 12 } else { 6 };
    let amount = (2 * ROUNDS * chains * LANES) as f64;
    best(threads, repeats, amount, |_| {
        let mut sum = 0.0;
        match chains {
            12 => dispatch_with(set, FusedMultiplyAdds::<12>(&mut sum)),
            _ => dispatch_with(set, FusedMultiplyAdds::<6>(&mut sum)),
        }
        black_box(sum);
    })
}

/// x ← 0.999 x over columns that no cache holds.
fn bandwidth(threads: usize, repeats: usize, length: usize) -> f64 {
    let columns: Vec<std::sync::Mutex<Vec<f64>>> =
        (0..threads).map(|_| std::sync::Mutex::new(vec![1.0; length])).collect();
    best(threads, repeats, (2 * 8 * length) as f64, |t| {
        let mut column = columns[t].lock().expect("one thread a column");
        column.iter_mut().for_each(|x| *x *= 0.999);
        black_box(&mut column);
    })
}

impl Machine {
    /// Measures for about a second.
    pub fn measure(quick: bool) -> Self {
        let (repeats, length) = if quick { (20, 1 << 23) } else { (60, 1 << 24) };
        let sets = InstructionSet::available().into_iter().map(|s| (s, fused(s, 1, repeats))).collect();
        let used = InstructionSet::detect();
        Self {
            sets,
            operations: [1, 2].map(|threads| fused(used, threads, repeats)),
            bandwidth: [1, 2].map(|threads| bandwidth(threads, repeats / 4, length)),
        }
    }

    /// Operations a second with the set in use.
    pub fn operations(&self, threads: usize) -> f64 {
        self.operations[threads.min(2) - 1]
    }

    /// Bytes a second.
    pub fn bandwidth(&self, threads: usize) -> f64 {
        self.bandwidth[threads.min(2) - 1]
    }

    /// Prints the limits.
    pub fn print(&self) {
        for (set, operations) in &self.sets {
            println!("fused multiply-adds, {set:?}, one thread: {:.1} GFlop/s", 1e-9 * operations);
        }
        println!(
            "the set in use: {:.1} GFlop/s with one thread, {:.1} with two",
            1e-9 * self.operations[0],
            1e-9 * self.operations[1]
        );
        println!(
            "memory, read and written: {:.1} GB/s with one thread, {:.1} with two",
            1e-9 * self.bandwidth[0],
            1e-9 * self.bandwidth[1]
        );
    }
}
