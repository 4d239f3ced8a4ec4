//! Lists of the particles of one tile.
//!
//! The slots of a block come in two parts. The first lists each pair **once**, at the particle that owns it
//! ([`super::search`] decides); a loop that solves a pair for both of its particles runs over this part and adds to a
//! buffer of the tile: the particles of the tile first, then those of other tiles that it meets ("foreign"). For each
//! slot the list says where in the buffer the sums of the eight neighbors stand. The second part lists the pairs that the
//! other particle owns: both parts together are the full list.

use crate::lanes::{LANES, prefetch};
use crate::neighbors::TILE;

/// Lists of the particles of one tile. Only a search fills them: every entry is below the number of records, every target
/// below the number of targets, and pair loops rely on it.
#[derive(Clone, Debug, Default)]
pub struct TileLists {
    /// First slot of each block, and the end of the last.
    pub(super) start: Vec<u32>,
    /// Number of slots that list pairs once, in the blocks before each block, and of all.
    pub(super) once: Vec<u32>,
    /// Slots: the k-th neighbor of each of eight particles.
    pub(super) slots: Vec<[u32; LANES]>,
    /// Places in the tile's buffer of the neighbors in the slots that list pairs once.
    pub(super) targets: Vec<[u16; LANES]>,
    /// Particles of other tiles that have a place in the buffer, ascending.
    pub(super) foreign: Vec<u32>,
    /// Where other tiles have sums for particles of this one.
    pub(super) incoming: Vec<Incoming>,
    /// Places of own particles in the buffer: the tile's particles, filled up to whole blocks.
    pub(super) n_own: usize,
}

/// Sums that another tile has for particles of this one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Incoming {
    /// The other tile.
    pub tile: u32,
    /// First of its foreign particles that belong here.
    pub first: u32,
    /// End of them.
    pub end: u32,
}

impl TileLists {
    /// Number of blocks.
    #[inline(always)]
    pub fn n_blocks(&self) -> usize {
        self.start.len() - 1
    }

    /// All slots of a block of the tile: every neighbor of each of its particles.
    #[inline(always)]
    pub fn block(&self, block: usize) -> &[[u32; LANES]] {
        &self.slots[self.start[block] as usize..self.start[block + 1] as usize]
    }

    /// The slots of a block that list pairs once, and the places of the neighbors in the tile's buffer.
    #[inline(always)]
    pub fn pairs(&self, block: usize) -> (&[[u32; LANES]], &[[u16; LANES]]) {
        let targets = &self.targets[self.once[block] as usize..self.once[block + 1] as usize];
        (&self.block(block)[..targets.len()], targets)
    }

    /// Asks for a part of the lists ahead of their use: part `part` of `parts`.
    #[inline(always)]
    pub fn prefetch(&self, part: usize, parts: usize) {
        fn share<T>(column: &[T], part: usize, parts: usize) {
            let (first, end) = (column.len() * part / parts, column.len() * (part + 1) / parts);
            prefetch(column, first, end - first);
        }
        share(&self.slots, part, parts);
        share(&self.targets, part, parts);
    }

    /// Number of slots that list pairs once.
    pub fn n_slots_once(&self) -> usize {
        self.targets.len()
    }

    /// Places of own particles in the buffer: they come first, in order.
    pub fn n_own(&self) -> usize {
        self.n_own
    }

    /// Places in the buffer.
    pub fn n_targets(&self) -> usize {
        self.n_own + self.foreign.len()
    }

    /// Particles of other tiles that have places in the buffer, behind the own ones.
    pub fn foreign(&self) -> &[u32] {
        &self.foreign
    }

    /// Where other tiles have sums for particles of this one, in the order of the tiles.
    pub fn incoming(&self) -> &[Incoming] {
        &self.incoming
    }

    /// Bytes that the lists take.
    pub fn bytes(&self) -> usize {
        let words = self.start.len() + self.once.len() + self.foreign.len();
        self.slots.len() * size_of::<[u32; LANES]>()
            + self.targets.len() * size_of::<[u16; LANES]>()
            + words * 4
            + self.incoming.len() * size_of::<Incoming>()
    }
}

/// Fills the incoming sums of all tiles from their foreign particles.
pub(super) fn connect(tiles: &mut [TileLists]) {
    tiles.iter_mut().for_each(|tile| tile.incoming.clear());
    for s in 0..tiles.len() {
        let mut first = 0;
        while let Some(&particle) = tiles[s].foreign.get(first) {
            let tile = particle as usize / TILE;
            let of_tile = tiles[s].foreign[first..].partition_point(|&p| (p as usize) < (tile + 1) * TILE);
            let (first_one, end) = (first as u32, (first + of_tile) as u32);
            tiles[tile].incoming.push(Incoming { tile: s as u32, first: first_one, end });
            first += of_tile;
        }
    }
}
