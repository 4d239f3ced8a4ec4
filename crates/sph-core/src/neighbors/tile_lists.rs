//! Lists of the particles of one tile.
//!
//! The slots of a block come in two parts. The first lists each pair **once**, at the particle that owns it
//! ([`super::search`] decides); a loop that solves a pair for both of its particles runs over this part and adds to a
//! buffer of the tile: the particles of the tile first, then those of other tiles that it meets ("foreign"). For each
//! slot the list says where in the buffer the sums of the eight neighbors stand. The second part lists the pairs that the
//! other particle owns: both parts together are the full list.

use crate::lanes::{LANES, prefetch};
use crate::neighbors::TILE;

/// Marks of particles that have no place in the buffer yet: none needed, and one needed.
const UNMET: u16 = u16::MAX;
const MET: u16 = u16::MAX - 1;

/// Lists of the particles of one tile. Only a search fills them: every entry is below the number of records, every target
/// below the number of targets, and pair loops rely on it.
#[derive(Clone, Debug, Default)]
pub struct TileLists {
    /// First slot of each block, and the end of the last.
    start: Vec<u32>,
    /// Number of slots that list pairs once, in the blocks before each block, and of all.
    once: Vec<u32>,
    /// Slots: the k-th neighbor of each of eight particles.
    slots: Vec<[u32; LANES]>,
    /// Places in the tile's buffer of the neighbors in the slots that list pairs once.
    targets: Vec<[u16; LANES]>,
    /// Particles of other tiles that have a place in the buffer, ascending.
    foreign: Vec<u32>,
    /// Where other tiles have sums for particles of this one.
    pub(super) incoming: Vec<Incoming>,
    /// Places of own particles in the buffer: the tile's particles, filled up to whole blocks.
    n_own: usize,
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
    pub(super) fn new() -> Self {
        Self { start: vec![0], once: vec![0], ..Self::default() }
    }

    /// Adds a block: for each lane the pairs that it owns, and those that the neighbor owns. Lists are filled up with the
    /// particle itself, at distance zero, whose terms vanish.
    pub(super) fn push_block(
        &mut self,
        first_particle: usize,
        owned: &[Vec<u32>; LANES],
        others: &[Vec<u32>; LANES],
    ) {
        for part in [owned, others] {
            let longest = part.iter().map(Vec::len).max().unwrap_or(0);
            for k in 0..longest {
                let mut slot = [0; LANES];
                for l in 0..LANES {
                    slot[l] = part[l].get(k).copied().unwrap_or((first_particle + l) as u32);
                }
                self.slots.push(slot);
            }
            if std::ptr::eq(part, owned) {
                self.once.push(self.once[self.once.len() - 1] + longest as u32);
            }
        }
        self.start.push(self.slots.len() as u32);
        self.n_own += LANES;
    }

    /// Places in the buffer, once all blocks are there: own particles first, then the foreign ones in their order. `seen` has
    /// the tiles that hold particles seen from here, ascending; `owner` tells the particle of a record.
    pub(super) fn set_targets(&mut self, tile: usize, seen: &[u32], owner: impl Fn(u32) -> u32) {
        // Of each particle of this tile and then of the tiles that are seen: its place in the buffer.
        let mut places = vec![UNMET; (1 + seen.len()) * TILE];
        let first_of = |of_tile: usize| match seen.iter().position(|&s| s as usize == of_tile) {
            _ if of_tile == tile => 0,
            found => (1 + found.expect("a neighbor is in a tile that is seen")) * TILE,
        };
        let (mut of_tile, mut first) = (tile, 0);
        let mut index = |particle: u32| {
            // Neighbors come in runs of one tile.
            if particle as usize / TILE != of_tile {
                of_tile = particle as usize / TILE;
                first = first_of(of_tile);
            }
            first + particle as usize % TILE
        };
        let n_once = self.once[self.n_blocks()] as usize;
        let mut met = Vec::with_capacity(n_once);
        for b in 0..self.n_blocks() {
            let first_slot = self.start[b] as usize;
            for slot in &self.slots[first_slot..first_slot + (self.once[b + 1] - self.once[b]) as usize] {
                let mut at = [0; LANES];
                for l in 0..LANES {
                    at[l] = index(owner(slot[l])) as u32;
                    places[at[l] as usize] = MET;
                }
                met.push(at);
            }
        }
        let (own, others) = places.split_at_mut(TILE);
        own.iter_mut().enumerate().for_each(|(k, place)| *place = k as u16);
        let mut foreign = Vec::new();
        for (&t, places) in seen.iter().zip(others.chunks_exact_mut(TILE)) {
            for (k, place) in places.iter_mut().enumerate() {
                if *place == MET {
                    *place = (self.n_own + foreign.len()) as u16;
                    foreign.push((t as usize * TILE + k) as u32);
                }
            }
        }
        assert!(self.n_own + foreign.len() < MET as usize, "tile {tile} meets {} others", foreign.len());
        self.targets = met.iter().map(|at| at.map(|at| places[at as usize])).collect();
        self.foreign = foreign;
        self.slots.shrink_to_fit();
    }

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
