//! Eight numbers at a time.
//!
//! The pair loops work on eight consecutive particles at once, one per lane. A sum over neighbors is then eight
//! independent sums, each in the order of its own list: no horizontal sums, and the same bits whatever the width of the
//! registers. [`Lanes`] is implemented for AVX-512 (one register), AVX2 with fused multiply-add (two registers) and
//! plain arrays; [`dispatch`] picks the widest that the machine has, at run time.
//!
//! **Same bits everywhere.** Every implementation performs the same IEEE operations in the same order: fused
//! multiply-add only where [`Real::mul_add`] is written, correctly rounded division and square root, no approximate
//! reciprocals. `max` and `min` return the second operand if either is NaN, as the x86 instructions do.
//!
//! A pair loop with more numbers than the registers of a machine hold may be written for a [`Part`] of the lanes and run for each
//! half of a block in turn, where [`Lanes::HALVES`] says so: with AVX2. Sums keep their order.
//!
//! [`Real`] is what formulas need of a number; `f64` has it too, so a kernel function is written once for both.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod exp;
mod plain;
mod prefetch;
#[cfg(test)]
mod tests;

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

// The lane types stay private: only `dispatch_with` can make a kernel run with them, after it has checked the machine.
#[cfg(target_arch = "x86_64")]
use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
use avx512::Avx512;
pub use exp::exp;
use plain::Plain;
pub use prefetch::prefetch;

/// Number of lanes, and the number of particles in a block.
pub const LANES: usize = 8;

/// One line of a record: eight numbers in 64 bytes, one cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub struct Line(pub [f64; LANES]);

/// What formulas need of a number.
pub trait Real:
    crate::dimension::Value
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// The same number in every lane.
    fn splat(value: f64) -> Self;
    /// `self * b + c`, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// The larger; `other` if either is NaN.
    fn max(self, other: Self) -> Self;
    /// The smaller; `other` if either is NaN.
    fn min(self, other: Self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// `yes` where `self < limit`, else `no` (also for NaN).
    fn select_less(self, limit: Self, yes: Self, no: Self) -> Self;
    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }
    /// One.
    #[inline(always)]
    fn one() -> Self {
        Self::splat(1.0)
    }
}

/// Some of eight lanes: all of them, or one half. Pair loops are written for a part and run for each of a block, one after the
/// other: a loop whose numbers do not fit the registers of a machine eight lanes at a time may fit them four at a time.
/// Arguments and results have places for eight, of which a part reads and writes its own.
pub trait Part: Real {
    /// All eight lanes.
    type Whole: Lanes;
    /// The first of its lanes.
    const FIRST: usize;
    /// How many lanes it has.
    const COUNT: usize;
    /// Its lanes of eight consecutive numbers.
    fn load(source: &[f64; LANES]) -> Self;
    /// Writes its lanes to their places in memory.
    fn store(self, target: &mut [f64; LANES]);
    /// Line `line` of its records of eight, of `stride` lines each, transposed: element `k` of the result holds number `k` of
    /// every record.
    ///
    /// # Panics
    /// In debug builds, if a record is outside `lines`.
    ///
    /// # Safety
    /// `indices[l] as usize * stride + line < lines.len()` for every lane: the neighbor list guarantees it.
    unsafe fn load_records(
        lines: &[Line],
        stride: usize,
        line: usize,
        indices: &[u32; LANES],
    ) -> [Self; LANES];
    /// Columns to rows: lane `l` of element `k` becomes lane `k` of element `l`, for each of its lanes `l`; other rows mean
    /// nothing.
    fn transpose(block: [Self; LANES]) -> [Self::Whole; LANES];
    /// Writes line `line` of its records of eight consecutive ones of `stride` lines each: lane `l` of element `k` becomes
    /// number `k` of record `l`.
    ///
    /// # Panics
    /// If there are fewer lines.
    #[inline(always)]
    fn store_records(block: [Self; LANES], lines: &mut [Line], stride: usize, line: usize) {
        let rows = Self::transpose(block);
        for l in Self::FIRST..Self::FIRST + Self::COUNT {
            rows[l].store(&mut lines[l * stride + line].0);
        }
    }
    /// Adds to line `line` of its records of eight, of `stride` lines each, one after the other: lane `l` of element `k` goes
    /// to number `k` of record `indices[l]`, as [`Lanes::sums_and_maximum`] has it if `MAXIMUM`.
    ///
    /// # Panics
    /// In debug builds, if a record is outside `lines`.
    ///
    /// # Safety
    /// `indices[l] as usize * stride + line < lines.len()` for every lane: the neighbor list guarantees it.
    #[inline(always)]
    unsafe fn add_to_records<const MAXIMUM: bool>(
        block: [Self; LANES],
        lines: &mut [Line],
        stride: usize,
        line: usize,
        indices: &[u32; LANES],
    ) {
        let rows = Self::transpose(block);
        for l in Self::FIRST..Self::FIRST + Self::COUNT {
            let at = indices[l] as usize * stride + line;
            debug_assert!(at < lines.len());
            // SAFETY: the caller's promise.
            let record = unsafe { &mut lines.get_unchecked_mut(at).0 };
            let old = Self::Whole::load(record);
            if MAXIMUM { rows[l].sums_and_maximum(old) } else { rows[l] + old }.store(record);
        }
    }
    /// Bit `l` is set where `self < limit` in lane `l`.
    fn less_mask(self, limit: Self) -> u8;
    /// Number `indices[l]` of a column, for each of its lanes.
    #[inline(always)]
    fn gather(column: &[f64], indices: &[u32; LANES]) -> Self {
        let mut numbers = [0.0; LANES];
        for l in Self::FIRST..Self::FIRST + Self::COUNT {
            numbers[l] = column[indices[l] as usize];
        }
        Self::load(&numbers)
    }
    /// True if `self < limit` in some lane.
    #[inline(always)]
    fn any_less(self, limit: Self) -> bool {
        self.less_mask(limit) != 0
    }
    /// Its lanes at their places in an array; the others are zero.
    #[inline(always)]
    fn to_array(self) -> [f64; LANES] {
        let mut array = [0.0; LANES];
        self.store(&mut array);
        array
    }
}

/// Eight numbers in registers.
pub trait Lanes: Part<Whole = Self> {
    /// What a pair loop with many numbers works on first: all lanes, or half of them if `HALVES`.
    type First: Part;
    /// The other half, if `HALVES`.
    type Second: Part;
    /// Whether such a loop takes one half after the other.
    const HALVES: bool;
    /// The numbers whose bits are set in `mask`, in their order, at the front; those behind mean nothing.
    fn pack(numbers: &[u32; LANES], mask: u8) -> [u32; LANES];
    /// The sums of both in all lanes but the last, which holds the larger of both (`other` if either is NaN).
    fn sums_and_maximum(self, other: Self) -> Self;
    /// Eight numbers of a column from number `first` on; the last one again where the column ends before.
    #[inline(always)]
    fn load_from(column: &[f64], first: usize) -> Self {
        if let Some(eight) = column[first..].first_chunk() {
            return Self::load(eight);
        }
        let mut numbers = [0.0; LANES];
        for l in 0..LANES {
            numbers[l] = column[(first + l).min(column.len() - 1)];
        }
        Self::load(&numbers)
    }
    /// Writes the lanes to a column from number `first` on, as far as it goes.
    #[inline(always)]
    fn store_to(self, column: &mut [f64], first: usize) {
        let rest = &mut column[first..];
        if let Some(eight) = rest.first_chunk_mut() {
            self.store(eight);
        } else {
            let length = rest.len();
            rest.copy_from_slice(&self.to_array()[..length]);
        }
    }
}

/// For each mask: the places of its set bits, in order.
static PLACES: [[u8; LANES]; 256] = {
    let mut places = [[0; LANES]; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut lane, mut count) = (0, 0);
        while lane < LANES {
            if mask >> lane & 1 == 1 {
                places[mask][count] = lane as u8;
                count += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    places
};

impl Real for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        f64::mul_add(self, b, c)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn select_less(self, limit: Self, yes: Self, no: Self) -> Self {
        if self < limit { yes } else { no }
    }
}

/// A computation written for any lanes. Mark `run` with `#[inline(always)]`: it is compiled into functions that have
/// the instructions of each set enabled.
pub trait LaneKernel {
    /// The computation with lanes `L`.
    fn run<L: Lanes>(self);
}

/// Sets of instructions, from plain to wide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// Arrays of eight numbers, left to the compiler.
    Plain,
    /// AVX2 with fused multiply-add: two registers of four numbers.
    Avx2,
    /// AVX-512 (F, DQ, VL): one register of eight numbers.
    Avx512,
}

impl InstructionSet {
    /// The widest set that this machine has. The environment variable `SPH_LANES` (`plain`, `avx2`, `avx512`) asks for
    /// a narrower one, for comparison; a wider one than the machine has is never taken.
    pub fn detect() -> Self {
        static DETECTED: std::sync::OnceLock<InstructionSet> = std::sync::OnceLock::new();
        *DETECTED.get_or_init(|| {
            let wanted = match std::env::var("SPH_LANES").as_deref() {
                Ok("plain") => Self::Plain,
                Ok("avx2") => Self::Avx2,
                _ => Self::Avx512,
            };
            Self::available().into_iter().rfind(|set| *set <= wanted).unwrap_or(Self::Plain)
        })
    }

    /// All sets that this machine has, from plain to wide.
    pub fn available() -> Vec<Self> {
        #[allow(unused_mut)]
        let mut list = vec![Self::Plain];
        #[cfg(target_arch = "x86_64")]
        {
            if has_avx2() {
                list.push(Self::Avx2);
            }
            if has_avx512() {
                list.push(Self::Avx512);
            }
        }
        list
    }
}

#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") && is_x86_feature_detected!("popcnt")
}

#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
        && has_avx2()
}

/// Runs a computation with the widest lanes of this machine.
#[inline]
pub fn dispatch<K: LaneKernel>(kernel: K) {
    dispatch_with(InstructionSet::detect(), kernel);
}

/// Runs a computation with the given set of instructions.
///
/// # Panics
/// If the machine does not have the set.
#[inline]
pub fn dispatch_with<K: LaneKernel>(set: InstructionSet, kernel: K) {
    match set {
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx512 => {
            assert!(has_avx512());
            // SAFETY: the machine has the instructions; the line above has just checked it.
            unsafe { run_avx512(kernel) }
        }
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 => {
            assert!(has_avx2());
            // SAFETY: the machine has the instructions; the line above has just checked it.
            unsafe { run_avx2(kernel) }
        }
        _ => kernel.run::<Plain>(),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma,popcnt")]
fn run_avx512<K: LaneKernel>(kernel: K) {
    align_stack();
    kernel.run::<Avx512>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,popcnt")]
fn run_avx2<K: LaneKernel>(kernel: K) {
    align_stack();
    kernel.run::<Avx2>();
}

/// Makes the compiler begin the stack of the function it is called from at a whole cache line. It keeps registers there that
/// do not fit the machine, and aligns their places only if it knows before it hands out registers that something wants it:
/// else each of them lies across two lines, or not, as the depth of the calls before has it.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn align_stack() {
    let mut line = Line::default();
    std::hint::black_box(&mut line);
}
