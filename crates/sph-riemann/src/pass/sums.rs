//! Where pairs add up: each is solved once, and serves both of its particles.
//!
//! A tile adds to a buffer of its own that holds its particles and the foreign ones that its pairs meet
//! ([`sph_core::neighbors::TileLists`]). Then its own sums go to the column of all particles, and the foreign ones wait
//! until every tile collects, in the order of the tiles, what others have for it: no two threads write to one place, and
//! every sum has one order whatever the number of threads.

use std::cell::RefCell;

use sph_core::lanes::{InstructionSet, LANES, LaneKernel, Lanes, Line, Part, dispatch_with, prefetch};
use sph_core::neighbors::{NeighborLists, TILE, TileLists};

use crate::dimension::SolidDimension;

/// What the pairs of a tile leave behind.
#[derive(Clone, Debug, Default)]
pub struct TilePairs {
    /// Sums for foreign particles, in the order of the lists; empty if there are none.
    foreign: Vec<Line>,
    /// For each slot that lists pairs once: true if time-centering needs its forces.
    pub(super) marked: Vec<bool>,
    /// Forces of the marked slots [N], one line an axis.
    pub(super) forces: Vec<Line>,
}

impl TilePairs {
    /// True if time-centering has pairs to do in this tile.
    pub fn has_marked(&self) -> bool {
        !self.forces.is_empty()
    }

    /// Bytes in use.
    pub fn bytes(&self) -> usize {
        (self.foreign.len() + self.forces.len()) * size_of::<Line>() + self.marked.len()
    }

    /// No slot of `n_slots` is marked.
    pub(super) fn clear_forces(&mut self, n_slots: usize) {
        self.marked.clear();
        self.marked.resize(n_slots, false);
        self.forces.clear();
    }

    /// Marks slot `place`, the last one so far, and returns where its forces go, one line of each of `axes`.
    #[inline(always)]
    pub(super) fn mark(&mut self, place: usize, axes: usize) -> &mut [Line] {
        if !self.marked[place] {
            self.marked[place] = true;
            self.forces.resize(self.forces.len() + axes, Line::default());
        }
        let first = self.forces.len() - axes;
        &mut self.forces[first..]
    }

    pub(super) fn set_foreign(&mut self, sums: &[Line], instructions: InstructionSet) {
        self.foreign.resize(sums.len(), Line::default());
        dispatch_with(instructions, CopyRecords { into: &mut self.foreign, from: sums });
    }
}

/// Copies some hundred lines. The library's copy of that many bytes takes an instruction that is slow for lines that no
/// cache holds, even if they have been asked for.
pub(super) struct CopyRecords<'a> {
    pub into: &'a mut [Line],
    pub from: &'a [Line],
}

impl LaneKernel for CopyRecords<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        assert_eq!(self.into.len(), self.from.len());
        for (into, from) in self.into.iter_mut().zip(self.from) {
            L::load(&from.0).store(&mut into.0);
        }
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

/// Adds records of sums to those of particles: one after the other, or of the particles with these numbers less `first`.
pub(super) struct AddRecords<'a> {
    pub into: &'a mut [Line],
    pub particles: Option<&'a [u32]>,
    pub first: usize,
    pub sums: &'a [Line],
    /// Lines of a record.
    pub stride: usize,
}

impl LaneKernel for AddRecords<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { into, particles, first, sums, stride } = self;
        for (k, sums) in sums.chunks_exact(stride).enumerate() {
            let place = if let Some(particles) = particles { particles[k] as usize - first } else { k };
            for line in 0..stride {
                let record = &mut into[place * stride + line].0;
                let (new, old) = (L::load(&sums[line].0), L::load(record));
                if line + 1 == stride { new.sums_and_maximum(old) } else { new + old }.store(record);
            }
        }
    }
}

/// Adds to the sums of the particles of tile `tile` what other tiles have for them.
pub fn collect<D: SolidDimension>(
    lists: &NeighborLists<D>,
    pairs: &[TilePairs],
    instructions: InstructionSet,
    tile: usize,
    own: &mut [Line],
) {
    let stride = D::SUM_LINES;
    for incoming in lists.tiles()[tile].incoming() {
        let source = incoming.tile as usize;
        let foreign = &pairs[source].foreign;
        if foreign.is_empty() {
            continue;
        }
        let range = incoming.first as usize..incoming.end as usize;
        let sums = &foreign[range.start * stride..range.end * stride];
        let particles = Some(&lists.tiles()[source].foreign()[range]);
        dispatch_with(instructions, AddRecords { into: own, particles, first: tile * TILE, sums, stride });
    }
}

/// Asks for what [`collect`] will read for the tile after `tile`, whose sums follow those in `own`; and for the lists of the
/// tile after that.
pub fn ask_ahead<D: SolidDimension>(
    lists: &NeighborLists<D>,
    pairs: &[TilePairs],
    tile: usize,
    own: &[Line],
) {
    let stride = D::SUM_LINES;
    let incoming = |ahead: usize| lists.tiles().get(tile + ahead).map_or(&[][..], TileLists::incoming);
    for incoming in incoming(2) {
        let first = incoming.first as usize;
        prefetch(lists.tiles()[incoming.tile as usize].foreign(), first, incoming.end as usize - first);
    }
    for incoming in incoming(1) {
        let source = incoming.tile as usize;
        let range = incoming.first as usize..incoming.end as usize;
        prefetch(&pairs[source].foreign, range.start * stride, range.len() * stride);
        for &particle in &lists.tiles()[source].foreign()[range] {
            prefetch(own, (particle as usize - tile * TILE) * stride, stride);
        }
    }
}

/// Adds the sums of eight particles, in lanes, to the buffer of a tile.
///
/// # Safety
/// `targets` are below the number of records in `buffer`: lists guarantee it of a buffer of their size.
#[inline(always)]
pub(super) unsafe fn add_to_buffer<D: SolidDimension, L: Part>(
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
