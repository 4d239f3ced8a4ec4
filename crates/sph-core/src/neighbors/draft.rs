//! The lists of a tile while they are made: what a thread keeps from tile to tile.
//!
//! The lists of eight particles become the slots of a block; once all blocks of a tile are there, the particles that its
//! pairs meet get their places in the tile's buffer. Finished lists are copied, so that they take no more memory than they
//! need.

use crate::lanes::{LANES, Lanes};
use crate::neighbors::TILE;
use crate::neighbors::cell_grid::Vicinity;
use crate::neighbors::tile_lists::TileLists;

/// Records of one particle's neighbors, as they are found.
#[derive(Debug, Default)]
pub(super) struct Row {
    /// The records, and behind them what is left of whole lanes.
    records: Vec<u32>,
    length: usize,
}

impl Row {
    #[inline(always)]
    pub fn clear(&mut self) {
        self.length = 0;
    }

    /// Adds those records whose bits are set in `mask`.
    #[inline(always)]
    pub fn push<L: Lanes>(&mut self, records: &[u32; LANES], mask: u8) {
        *self.room() = L::pack(records, mask);
        self.length += mask.count_ones() as usize;
    }

    /// Adds the records of another row.
    #[inline(always)]
    pub fn append(&mut self, other: &Row) {
        for k in (0..other.length).step_by(LANES) {
            *self.room() = *other.records[k..].first_chunk().expect("rows end with whole lanes");
            self.length += LANES.min(other.length - k);
        }
    }

    /// Whole lanes behind the records.
    #[inline(always)]
    fn room(&mut self) -> &mut [u32; LANES] {
        if self.records.len() < self.length + LANES {
            self.grow();
        }
        self.records[self.length..].first_chunk_mut().expect("there is room")
    }

    #[cold]
    fn grow(&mut self) {
        self.records.resize(2 * self.length.next_multiple_of(LANES) + LANES, 0);
    }

    /// The first `length` records, filled up with `filling`.
    #[inline(always)]
    fn filled(&mut self, length: usize, filling: u32) -> &[u32] {
        if self.records.len() < length {
            self.records.resize(length.next_multiple_of(LANES), 0);
        }
        self.records[self.length..length.max(self.length)].fill(filling);
        &self.records[..length]
    }
}

/// What the search for one particle needs.
#[derive(Debug, Default)]
pub(super) struct Near {
    pub vicinity: Vicinity,
    /// Neighbors in the skin: whose pairs the particle owns, and those that own the pair.
    pub skin: [Row; 2],
}

/// Marks of particles that have no place in the buffer: none needed, and one needed.
const UNMET: u16 = u16::MAX;
const MET: u16 = u16::MAX - 1;
/// Mark of tiles that no pair has met.
const UNSEEN: u32 = u32::MAX;

/// The lists of a tile while they are made.
#[derive(Debug)]
pub(super) struct Draft {
    /// Of each lane of a block: the neighbors whose pairs the particle owns, and those that own the pair.
    pub owned: [Row; LANES],
    pub others: [Row; LANES],
    pub near: Near,
    start: Vec<u32>,
    once: Vec<u32>,
    slots: Vec<[u32; LANES]>,
    /// By tile: where `places` has its particles.
    first_of: Vec<u32>,
    /// Tiles that have been met, this one first.
    seen: Vec<u32>,
    /// Places in the buffer of the particles of the tiles that have been met.
    places: Vec<u16>,
    /// For each slot that lists pairs once: where `places` has the neighbors.
    met: Vec<[u32; LANES]>,
    targets: Vec<[u16; LANES]>,
}

impl Draft {
    pub fn new(n_tiles: usize) -> Self {
        Self {
            owned: Default::default(),
            others: Default::default(),
            near: Near::default(),
            start: vec![0],
            once: vec![0],
            slots: Vec::new(),
            first_of: vec![UNSEEN; n_tiles],
            seen: Vec::new(),
            places: Vec::new(),
            met: Vec::new(),
            targets: Vec::new(),
        }
    }

    /// Adds a block of what `owned` and `others` hold. Lists are filled up with the particle itself, at distance zero,
    /// whose terms vanish.
    pub fn push_block(&mut self, first_particle: usize) {
        let once = self.slots.len();
        push_slots(&mut self.slots, first_particle, &mut self.owned);
        self.once.push(self.once[self.once.len() - 1] + (self.slots.len() - once) as u32);
        push_slots(&mut self.slots, first_particle, &mut self.others);
        self.start.push(self.slots.len() as u32);
    }

    /// Gives places in the buffer, own particles first, then the foreign ones in their order, and hands the lists over.
    /// `owner` tells the particle of a record.
    pub fn finish(&mut self, tile: usize, owner: impl Fn(u32) -> u32, lists: &mut TileLists) {
        see(tile, &mut self.first_of, &mut self.seen, &mut self.places);
        self.meet(owner);
        lists.n_own = (self.start.len() - 1) * LANES;
        lists.foreign.clear();
        self.places[..TILE].iter_mut().enumerate().for_each(|(k, place)| *place = k as u16);
        self.seen[1..].sort_unstable();
        for &t in &self.seen[1..] {
            let first = self.first_of[t as usize] as usize;
            for (k, places) in
                self.places[first..first + TILE].as_chunks_mut::<LANES>().0.iter_mut().enumerate()
            {
                if *places == [UNMET; LANES] {
                    continue; // Most particles are met by no foreign pair.
                }
                for (l, place) in places.iter_mut().enumerate().filter(|(_, place)| **place == MET) {
                    *place = (lists.n_own + lists.foreign.len()) as u16;
                    lists.foreign.push(t * TILE as u32 + (k * LANES + l) as u32);
                }
            }
        }
        let foreign = lists.foreign.len();
        assert!(lists.n_own + foreign < MET as usize, "tile {tile} meets {foreign} others");
        copy(&mut lists.start, &self.start);
        copy(&mut lists.once, &self.once);
        copy(&mut lists.slots, &self.slots);
        self.targets.clear();
        self.targets.extend(self.met.iter().map(|at| at.map(|at| self.places[at as usize])));
        copy(&mut lists.targets, &self.targets);
        self.clear();
    }

    /// Marks the particles that need a place, and notes where their places are.
    #[inline(always)]
    fn meet(&mut self, owner: impl Fn(u32) -> u32) {
        let Self { start, once, slots, first_of, seen, places, met, .. } = self;
        for b in 0..start.len() - 1 {
            let first = start[b] as usize;
            let slots = &slots[first..first + (once[b + 1] - once[b]) as usize];
            met.extend(slots.iter().map(|slot| {
                let mut at = [0; LANES];
                for l in 0..LANES {
                    let particle = owner(slot[l]) as usize;
                    let tile = particle / TILE;
                    if first_of[tile] == UNSEEN {
                        see(tile, first_of, seen, places);
                    }
                    at[l] = first_of[tile] + (particle % TILE) as u32;
                    places[at[l] as usize] = MET;
                }
                at
            }));
        }
    }

    fn clear(&mut self) {
        self.start.truncate(1);
        self.once.truncate(1);
        self.slots.clear();
        self.seen.drain(..).for_each(|t| self.first_of[t as usize] = UNSEEN);
        self.places.clear();
        self.met.clear();
    }
}

/// Room for the places of the particles of a tile that has not been seen before.
#[cold]
fn see(tile: usize, first_of: &mut [u32], seen: &mut Vec<u32>, places: &mut Vec<u16>) {
    first_of[tile] = places.len() as u32;
    seen.push(tile as u32);
    places.resize(places.len() + TILE, UNMET);
}

/// Slots of eight lists, as many as the longest has.
#[inline(always)]
fn push_slots(slots: &mut Vec<[u32; LANES]>, first_particle: usize, lists: &mut [Row; LANES]) {
    let longest = lists.iter().map(|row| row.length).max().unwrap_or(0);
    let mut filling = first_particle as u32;
    let lists = lists.each_mut().map(|row| {
        filling += 1;
        row.filled(longest, filling - 1)
    });
    slots.extend((0..longest).map(|k| std::array::from_fn(|l| lists[l][k])));
}

/// A copy that takes little more memory than it needs; a rebuild finds room there for a few more.
fn copy<T: Copy>(target: &mut Vec<T>, source: &[T]) {
    target.clear();
    if target.capacity() < source.len() {
        target.reserve_exact(source.len() + source.len() / 16);
    }
    target.extend_from_slice(source);
}
