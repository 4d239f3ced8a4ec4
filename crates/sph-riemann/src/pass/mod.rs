//! Passes over the pairs: gradients, contact, time-centering.
//!
//! A pass runs over tiles of particles in parallel and over blocks of eight particles within a tile. Each particle
//! gathers its own sums from its own list, in the order of the list: the same bits for any number of threads.

mod ahead;
mod centering;
mod closure;
mod contact;
mod gradient;
mod smoothing;
mod sums;

use rayon::prelude::*;
use sph_core::dimension::Components;
use sph_core::lanes::{InstructionSet, LANES, Line, Part, dispatch_with};
use sph_core::neighbors::{NeighborLists, TILE, TILE_BLOCKS};

use crate::dimension::SolidDimension;
use crate::limiter::Limiter;
use crate::record::Row;
use crate::scheme::SurfaceTreatment;
pub use centering::Deltas;
pub use smoothing::{Sizes, Smoothing};
use sums::{AddRecords, CopyRecords};
pub use sums::{TilePairs, ask_ahead, collect};

/// What all passes read.
#[derive(Clone, Copy)]
pub struct Pass<'a, D: SolidDimension> {
    /// The pairs.
    pub lists: &'a NeighborLists<D>,
    /// Kernel and smoothing lengths.
    pub smoothing: Smoothing<'a>,
    /// What is done at free surfaces.
    pub surface: SurfaceTreatment,
    /// Records that are read: of the first pass for gradients, of the second for contacts and time-centering.
    pub records: &'a [Line],
    /// Half the time step [s], zero in schemes without a half step.
    pub half_step: f64,
    /// Instructions to use.
    pub instructions: InstructionSet,
}

/// A pass over one tile, with what it writes.
pub struct Tile<'a> {
    index: usize,
    work: Work<'a>,
}

enum Work<'a> {
    Gradients {
        flags: Option<&'a [f64]>,
        sides: &'a mut [Line],
        rows: &'a mut [Line],
    },
    Contacts {
        limiter: Option<Limiter>,
        pairs: &'a mut TilePairs,
        buffer: &'a mut [Line],
        /// Where the sums of the tile's particles go afterwards.
        sums: &'a [Line],
    },
    Centering {
        pairs: &'a TilePairs,
        buffer: &'a mut [Line],
        sums: &'a [Line],
    },
    Closure {
        stage: closure::Stage<'a>,
        rows: &'a [Line],
        output: &'a mut [Line],
    },
}

impl<D: SolidDimension> Pass<'_, D> {
    /// The first pass: L, corrected gradients, half step. Writes the records of the second pass, and rows. `flags` has 1
    /// where a rule puts I for L⁻¹.
    ///
    /// # Panics
    /// If there are fewer records than the lists name: the pair loops read them unchecked; or if there are not as many rows,
    /// sums and tiles as in the lists.
    pub fn gradients(&self, flags: Option<&[f64]>, sides: &mut [Line], rows: &mut [Line]) {
        self.check_records(D::STATE_LINES);
        let own = &mut sides[..self.lists.n_padded() * D::SIDES_LINES];
        assert_eq!(rows.len(), self.lists.n_padded() / LANES * Row::count::<D>());
        let rows = rows.par_chunks_mut(TILE_BLOCKS * Row::count::<D>());
        rows.zip(own.par_chunks_mut(TILE * D::SIDES_LINES)).enumerate().for_each(|(index, (rows, sides))| {
            D::run(self, Tile { index, work: Work::Gradients { flags, sides, rows } });
        });
    }

    /// The second pass: the contact of each pair, with reconstruction if there is a limiter. Writes the sums of each
    /// particle, without what [`collect`] adds from other tiles, and what the pairs of each tile leave behind.
    ///
    /// # Panics
    /// As [`Pass::gradients`].
    pub fn contacts(&self, limiter: Option<Limiter>, sums: &mut [Line], pairs: &mut [TilePairs]) {
        self.check_records(if limiter.is_some() { D::SIDES_LINES } else { D::CONSTANT_SIDES_LINES });
        self.run_with_buffers(sums, pairs, |index, pairs, buffer, own| {
            D::run(self, Tile { index, work: Work::Contacts { limiter, pairs, buffer, sums: own } });
            let from = &buffer[..own.len()];
            dispatch_with(self.instructions, CopyRecords { into: own, from });
            true
        });
    }

    /// Time-centering of the pairs that the contact pass has marked: adds to the sums.
    ///
    /// # Panics
    /// As [`Pass::gradients`].
    pub fn centering(&self, sums: &mut [Line], pairs: &mut [TilePairs]) {
        self.check_records(D::SIDES_LINES);
        self.run_with_buffers(sums, pairs, |index, pairs, buffer, own| {
            if pairs.has_marked() {
                D::run(self, Tile { index, work: Work::Centering { pairs, buffer, sums: own } });
                let (sums, stride) = (&buffer[..own.len()], D::SUM_LINES);
                let add = AddRecords { into: own, particles: None, first: 0, sums, stride };
                dispatch_with(self.instructions, add);
            }
            pairs.has_marked()
        });
    }

    /// Runs `work` on each tile with a zeroed buffer of the size that its lists ask for and the tile's part of the sums,
    /// and keeps the foreign sums, if there are any.
    fn run_with_buffers(
        &self,
        sums: &mut [Line],
        pairs: &mut [TilePairs],
        work: impl Fn(usize, &mut TilePairs, &mut [Line], &mut [Line]) -> bool + Sync,
    ) {
        assert_eq!(sums.len(), self.lists.n_padded() * D::SUM_LINES);
        assert_eq!(pairs.len(), self.lists.tiles().len());
        let tiles = sums.par_chunks_mut(TILE * D::SUM_LINES).zip(pairs.par_iter_mut()).enumerate();
        tiles.for_each(|(index, (own, pairs))| {
            sums::with_buffer(self.lists.tiles()[index].n_targets() * D::SUM_LINES, |buffer| {
                let any = work(index, pairs, buffer, own);
                pairs.set_foreign(if any { &buffer[own.len()..] } else { &[] }, self.instructions);
            });
        });
    }

    fn check_records(&self, stride: usize) {
        let needed = self.lists.n_records() * stride;
        assert!(self.records.len() >= needed, "{} lines of records, {needed} needed", self.records.len());
    }

    /// Runs one tile with the widest lanes of this machine.
    pub(crate) fn dispatch(&self, tile: Tile<'_>) {
        let (set, index) = (self.instructions, tile.index);
        match tile.work {
            Work::Gradients { flags, sides, rows } => {
                dispatch_with(set, gradient::GradientTile { pass: self, index, flags, sides, rows })
            }
            Work::Contacts { limiter: Some(limiter), pairs, buffer, sums } => dispatch_with(
                set,
                contact::ContactTile::<D, true> { pass: self, index, limiter, pairs, buffer, sums },
            ),
            Work::Contacts { limiter: None, pairs, buffer, sums } => {
                let limiter = Limiter::default(); // Not asked for.
                dispatch_with(
                    set,
                    contact::ContactTile::<D, false> { pass: self, index, limiter, pairs, buffer, sums },
                );
            }
            Work::Centering { pairs, buffer, sums } => {
                dispatch_with(set, centering::CenteringTile { pass: self, index, pairs, buffer, sums })
            }
            Work::Closure { stage, rows, output } => {
                dispatch_with(set, closure::ClosureTile { pass: self, index, stage, rows, output })
            }
        }
    }
}

/// Indices of the particles of a block.
#[inline(always)]
fn own_indices(block: usize) -> [u32; LANES] {
    let mut indices = [0; LANES];
    for l in 0..LANES {
        indices[l] = (block * LANES + l) as u32;
    }
    indices
}

/// Line `line` of eight records as the first numbers of `record` from `8 line` on.
///
/// # Safety
/// As [`Part::load_records`].
#[inline(always)]
unsafe fn load_line<L: Part, R: Components<L>>(
    record: &mut R,
    records: &[Line],
    stride: usize,
    line: usize,
    indices: &[u32; LANES],
) {
    // SAFETY: the caller's promise.
    let numbers = unsafe { L::load_records(records, stride, line, indices) };
    for k in 0..LANES {
        record[line * LANES + k] = numbers[k];
    }
}

/// Writes a record of each of eight particles, `stride` lines each.
#[inline(always)]
pub(crate) fn store_records<L: Part, R: Components<L>>(record: &R, lines: &mut [Line], stride: usize) {
    for line in 0..stride {
        let mut numbers = [L::zero(); LANES];
        for k in 0..LANES {
            numbers[k] = record[line * LANES + k];
        }
        L::store_records(numbers, lines, stride, line);
    }
}
