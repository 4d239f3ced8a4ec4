//! Where pairs add up: each is solved once, and serves both of its particles.
//!
//! A tile adds to a buffer of its own that holds its particles and the foreign ones that its pairs meet
//! ([`sph_core::neighbors::TileLists`]). Then its own sums go to the column of all particles, and the foreign ones wait
//! until every tile collects, in the order of the tiles, what others have for it: no two threads write to one place, and
//! every sum has one order whatever the number of threads.

use std::cell::RefCell;

use sph_core::lanes::{LANES, Lanes, Line};
use sph_core::neighbors::{NeighborLists, TILE};

use crate::dimension::SolidDimension;

/// What the pairs of a tile leave behind.
#[derive(Clone, Debug, Default)]
pub struct TilePairs {
    /// Sums for foreign particles, in the order of the lists; empty if there are none.
    foreign: Vec<Line>,
    /// For each slot that lists pairs once: true if time-centring needs its forces.
    pub(super) marked: Vec<bool>,
    /// Forces of the marked slots [N], one line an axis.
    pub(super) forces: Vec<Line>,
}

impl TilePairs {
    /// True if time-centring has pairs to do in this tile.
    pub fn has_marked(&self) -> bool {
        !self.forces.is_empty()
    }

    /// Bytes in use.
    pub fn bytes(&self) -> usize {
        (self.foreign.len() + self.forces.len()) * size_of::<Line>() + self.marked.len()
    }

    pub(super) fn clear_forces(&mut self) {
        self.marked.clear();
        self.forces.clear();
    }

    pub(super) fn set_foreign(&mut self, sums: &[Line]) {
        self.foreign.clear();
        self.foreign.extend_from_slice(sums);
    }
}

/// Runs `work` with zeroed lines of this thread's buffer.
pub(super) fn with_buffer(lines: usize, work: impl FnOnce(&mut [Line])) {
    thread_local! {
        static BUFFER: RefCell<Vec<Line>> = const { RefCell::new(Vec::new()) };
    }
    BUFFER.with_borrow_mut(|buffer| {
        buffer.clear();
        buffer.resize(lines, Line::default());
        work(buffer);
    });
}

/// Adds one record of sums to another.
pub(super) fn add<D: SolidDimension>(record: &mut [Line], sums: &[Line]) {
    let last = D::SUM_LINES - 1;
    for (line, (into, from)) in record.iter_mut().zip(sums).enumerate() {
        let largest = into.0[LANES - 1].max(from.0[LANES - 1]);
        for k in 0..LANES {
            into.0[k] += from.0[k];
        }
        if line == last {
            into.0[LANES - 1] = largest;
        }
    }
}

/// Adds to the sums of the particles of tile `tile` what other tiles have for them.
pub fn collect<D: SolidDimension>(
    lists: &NeighborLists<D>,
    pairs: &[TilePairs],
    tile: usize,
    own: &mut [Line],
) {
    for incoming in lists.tiles()[tile].incoming() {
        let source = incoming.tile as usize;
        let range = incoming.first as usize..incoming.end as usize;
        let sums = pairs[source].foreign.chunks_exact(D::SUM_LINES).skip(range.start);
        for (particle, sums) in lists.tiles()[source].foreign()[range].iter().zip(sums) {
            let at = (*particle as usize - tile * TILE) * D::SUM_LINES;
            add::<D>(&mut own[at..at + D::SUM_LINES], sums);
        }
    }
}

/// Adds the sums of eight particles, in lanes, to the buffer of a tile.
///
/// # Safety
/// `targets` are below the number of records in `buffer`: lists guarantee it of a buffer of their size.
#[inline(always)]
pub(super) unsafe fn add_to_buffer<D: SolidDimension, L: Lanes>(
    record: &D::SumsRecord<L>,
    buffer: &mut [Line],
    targets: &[u32; LANES],
) {
    for line in 0..D::SUM_LINES {
        let mut numbers = [L::zero(); LANES];
        for k in 0..LANES {
            numbers[k] = record[line * LANES + k];
        }
        // SAFETY: the caller's promise.
        unsafe {
            if line + 1 == D::SUM_LINES {
                L::add_to_records::<true>(numbers, buffer, D::SUM_LINES, line, targets);
            } else {
                L::add_to_records::<false>(numbers, buffer, D::SUM_LINES, line, targets);
            }
        }
    }
}
