//! Passes over the pairs: gradients, contact, time-centring.
//!
//! A pass runs over tiles of particles in parallel and over blocks of eight particles within a tile. Each particle
//! gathers its own sums from its own list, in the order of the list: the same bits for any number of threads.

mod centering;
mod closure;
mod contact;
mod gradient;
mod smoothing;

use rayon::prelude::*;
use sph_core::dimension::Components;
use sph_core::lanes::{InstructionSet, LANES, Lanes, Line, dispatch_with};
use sph_core::neighbors::{NeighborLists, TILE, TILE_BLOCKS, TileLists};

use crate::dimension::SolidDimension;
use crate::limiter::Limiter;
use crate::record::Row;
use crate::scheme::SurfaceTreatment;
pub use centering::{CenteredPairs, find_pairs};
pub use closure::ClosureStage;
pub use smoothing::Smoothing;

/// A pass and all that it reads.
#[derive(Clone, Copy)]
pub struct Pass<'a, D: SolidDimension> {
    /// Which pass.
    pub kind: PassKind<'a>,
    /// The pairs.
    pub lists: &'a NeighborLists<D>,
    /// Kernel and smoothing lengths.
    pub smoothing: Smoothing<'a>,
    /// What is done at free surfaces.
    pub surface: SurfaceTreatment,
    /// Records that are read: of the first pass for gradients, of the second for the others.
    pub records: &'a [Line],
    /// Half the time step [s], zero in schemes without a half step.
    pub half_step: f64,
    /// Instructions to use.
    pub instructions: InstructionSet,
}

/// The passes.
#[derive(Clone, Copy)]
pub enum PassKind<'a> {
    /// L, corrected gradients, half step; writes the records of the second pass. With 1 where a rule puts I for L⁻¹.
    Gradient(Option<&'a [f64]>),
    /// Contact of each pair with reconstruction; writes forces, power and velocity gradients.
    Contact(Limiter),
    /// Contact of each pair without reconstruction and correction.
    PlainContact,
    /// Corrects power and velocity gradients for the true acceleration, from δ by axis, over the listed pairs.
    Centering(Limiter, &'a [Vec<f64>], &'a [CenteredPairs]),
    /// A stage of the closure of faces; see [`Pass::close_faces`].
    Closure(ClosureStage<'a>),
}

/// What a pass writes in one tile.
pub struct Tile<'a> {
    /// Number of the tile.
    pub index: usize,
    /// Records of the second pass of the tile's particles; empty unless the pass writes them.
    pub sides: &'a mut [Line],
    /// Rows of the tile's blocks.
    pub rows: &'a mut [Line],
}

impl<D: SolidDimension> Pass<'_, D> {
    /// Runs the pass over all tiles. `sides` holds the records that the pass writes, or is empty.
    ///
    /// # Panics
    /// If there are fewer records than the lists name: the pair loops read them unchecked.
    pub fn run(&self, sides: &mut [Line], rows: &mut [Line]) {
        let needed = self.lists.n_records() * self.stride();
        assert!(self.records.len() >= needed, "{} lines of records, {needed} needed", self.records.len());
        let row_chunk = TILE_BLOCKS * Row::count::<D>();
        let tiles = rows.par_chunks_mut(row_chunk).enumerate();
        if sides.is_empty() {
            tiles.for_each(|(index, rows)| D::run(self, Tile { index, sides: &mut [], rows }));
        } else {
            let own = &mut sides[..self.lists.n_padded() * D::SIDES_LINES];
            tiles
                .zip(own.par_chunks_mut(TILE * D::SIDES_LINES))
                .for_each(|((index, rows), sides)| D::run(self, Tile { index, sides, rows }));
        }
    }

    /// Lines of a record that the pass reads.
    fn stride(&self) -> usize {
        match self.kind {
            PassKind::Gradient(_) => D::STATE_LINES,
            PassKind::Closure(ClosureStage::Sweep) => D::FACE_LINES,
            PassKind::Contact(_)
            | PassKind::PlainContact
            | PassKind::Centering(..)
            | PassKind::Closure(ClosureStage::Gaps | ClosureStage::Forces(_)) => D::SIDES_LINES,
        }
    }

    /// Runs one tile with the widest lanes of this machine.
    pub(crate) fn dispatch(&self, tile: Tile<'_>) {
        let set = self.instructions;
        match self.kind {
            PassKind::Gradient(flags) => {
                dispatch_with(set, gradient::GradientTile { pass: self, tile, flags })
            }
            PassKind::PlainContact => {
                let limiter = Limiter::default(); // Not asked for.
                dispatch_with(set, contact::ContactTile::<D, false> { pass: self, tile, limiter });
            }
            PassKind::Contact(limiter) => {
                dispatch_with(set, contact::ContactTile::<D, true> { pass: self, tile, limiter });
            }
            PassKind::Centering(limiter, delta, pairs) => {
                let pairs = &pairs[tile.index];
                dispatch_with(set, centering::CenteringTile { pass: self, tile, limiter, delta, pairs });
            }
            PassKind::Closure(stage) => {
                dispatch_with(set, closure::ClosureTile { pass: self, tile, stage });
            }
        }
    }

    fn tile_lists(&self, tile: usize) -> &TileLists {
        &self.lists.tiles[tile]
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
/// As [`Lanes::load_records`].
#[inline(always)]
unsafe fn load_line<L: Lanes, R: Components<L>>(
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
fn store_records<L: Lanes, R: Components<L>>(record: &R, lines: &mut [Line], stride: usize) {
    for line in 0..stride {
        let mut numbers = [L::zero(); LANES];
        for k in 0..LANES {
            numbers[k] = record[line * LANES + k];
        }
        let numbers = L::transpose(numbers);
        for l in 0..LANES {
            numbers[l].store(&mut lines[l * stride + line].0);
        }
    }
}
