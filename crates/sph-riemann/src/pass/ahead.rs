//! Records asked for ahead of their use.
//!
//! While a pass works on a block of one tile it asks for the records of the same block of the next tile, and for a share of the
//! foreign particles that the pairs of the next tile meet: those beyond it in the order of the particles, that no tile has
//! read yet. What lies behind has been read not long ago.

use sph_core::lanes::{LANES, Line, prefetch};
use sph_core::neighbors::{NeighborLists, TILE_BLOCKS, TileLists};

use crate::dimension::SolidDimension;

/// What the next tile will read.
#[derive(Clone, Copy)]
pub(super) struct Ahead<'a> {
    lists: Option<&'a TileLists>,
    /// First block of the next tile.
    first_block: usize,
}

impl<'a> Ahead<'a> {
    pub(super) fn of<D: SolidDimension>(lists: &'a NeighborLists<D>, index: usize) -> Self {
        Self { lists: lists.tiles().get(index + 1), first_block: (index + 1) * TILE_BLOCKS }
    }

    /// Asks for what block `block` of the next tile reads: the first `lines` lines of records of `stride` lines.
    #[inline(always)]
    pub(super) fn records(&self, block: usize, records: &[Line], stride: usize, lines: usize) {
        let Some(lists) = self.lists else { return };
        let first = (self.first_block + block) * LANES;
        if lines == stride {
            prefetch(records, first * stride, LANES * stride);
        } else {
            for l in 0..LANES {
                prefetch(records, (first + l) * stride, lines);
            }
        }
        let foreign = lists.foreign();
        let (first, end) = (foreign.len() * block / TILE_BLOCKS, foreign.len() * (block + 1) / TILE_BLOCKS);
        for &particle in &foreign[first..end] {
            prefetch(records, particle as usize * stride, lines);
        }
        lists.prefetch(block, TILE_BLOCKS);
    }
}
