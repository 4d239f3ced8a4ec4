//! Neighbor lists with a skin.
//!
//! Pairs with r_ij < s (D_i + D_j) + skin are listed, both ways (i sees j and j sees i), so that each particle gathers
//! its own sums in a fixed order. The lists stay good until some pair has moved by more than the skin against each
//! other; [`NeighborLists::outlived`] tells it from the ranges of displacement in tiles of particles that see each other.
//!
//! **Layout.** Eight consecutive particles are a block; slot k of a block holds the k-th neighbor of each. Lists of a
//! block are padded to the longest with the particle itself, at distance zero, whose terms vanish. [`TILE_BLOCKS`]
//! blocks are a tile: the unit of parallel work. Indices up to `n_padded` are particles; those behind are [`Halo`]
//! copies. The first slots of a block list each pair once, for loops that serve both particles of a pair: [`TileLists`].
//!
//! The modules `brute_force` and `kd_tree` find the same pairs in independent ways; tests hold the lists to them.

pub mod brute_force;
pub mod cell_grid;
mod draft;
pub mod halo;
pub mod kd_tree;
mod motion;
mod search;
mod tile_lists;

use rayon::prelude::*;

use crate::dimension::Dimension;
use crate::domain::Domain;
use crate::lanes::{InstructionSet, LANES};
use cell_grid::Workspace;
use draft::Draft;
pub use halo::Halo;
use motion::Motion;
use search::Search;
pub use tile_lists::{Incoming, TileLists};

/// Blocks in a tile.
pub const TILE_BLOCKS: usize = 32;
/// Particles in a tile.
pub const TILE: usize = TILE_BLOCKS * LANES;

/// Neighbor lists of all particles, in blocks and tiles.
#[derive(Clone, Debug, Default)]
pub struct NeighborLists<D: Dimension> {
    n_particles: usize,
    halo: Halo<D>,
    workspace: Workspace<D>,
    tiles: Vec<TileLists>,
    /// Positions when the lists were built.
    reference: Vec<Vec<f64>>,
    motion: Motion<D>,
}

/// What decides which pairs are listed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// s in r_ij < s (D_i + D_j): kernel support (in smoothing lengths) times θ [-].
    pub factor: f64,
    /// Distance beyond it within which pairs are listed too [m].
    pub skin: f64,
}

impl<D: Dimension> NeighborLists<D> {
    /// Builds lists for particles inside the box (on periodic axes), best sorted in cell order.
    ///
    /// # Panics
    /// If the pairs of a tile meet more than 65,000 particles of other tiles: sizes then differ by so much that a large particle
    /// sees that many small ones. If positions and sizes are not as many.
    pub fn build(position: &D::AxisColumns, size: &[f64], domain: &Domain<D>, reach: Reach) -> Self {
        let mut lists = Self::default();
        lists.rebuild(position, size, domain, reach);
        lists
    }

    /// Builds the lists anew, in the memory that they have.
    ///
    /// # Panics
    /// As [`NeighborLists::build`].
    pub fn rebuild(&mut self, position: &D::AxisColumns, size: &[f64], domain: &Domain<D>, reach: Reach) {
        self.rebuild_with(InstructionSet::detect(), position, size, domain, reach);
    }

    /// The same with the given set of instructions: the lists do not depend on it.
    ///
    /// # Panics
    /// As [`NeighborLists::build`], and if the machine does not have the set.
    pub fn rebuild_with(
        &mut self,
        instructions: InstructionSet,
        position: &D::AxisColumns,
        size: &[f64],
        domain: &Domain<D>,
        reach: Reach,
    ) {
        let n_particles = size.len();
        for a in 0..D::COUNT {
            assert_eq!(position[a].len(), n_particles, "positions along axis {a} and sizes must be as many");
        }
        // Pair loops trust the lists: should a panic stop the build, there are none.
        self.n_particles = 0;
        let mut tiles = std::mem::take(&mut self.tiles);
        let largest = size.iter().fold(0.0_f64, |a, &b| a.max(b));
        let farthest = 2.0 * reach.factor * largest + reach.skin;
        self.halo = Halo::<D>::build(position, domain, farthest);
        let search = Search::new(&mut self.workspace, position, &self.halo, size, reach, farthest);
        let n_tiles = size.len().div_ceil(TILE);
        tiles.resize_with(n_tiles, TileLists::default);
        tiles.par_iter_mut().enumerate().for_each_init(
            || Draft::new(n_tiles),
            |draft, (t, lists)| search.tile(instructions, t, draft, lists),
        );
        tile_lists::connect(&mut tiles);
        self.reference.resize_with(D::COUNT, Vec::new);
        (0..D::COUNT).for_each(|a| self.reference[a].clone_from(&position[a]));
        self.motion.restart(position, domain, (farthest, reach.skin), &mut self.workspace.records);
        (self.tiles, self.n_particles) = (tiles, n_particles);
    }

    /// Number of particles.
    pub fn n_particles(&self) -> usize {
        self.n_particles
    }

    /// Copies across periodic boundaries; copy h has index `n_padded() + h`.
    pub fn halo(&self) -> &Halo<D> {
        &self.halo
    }

    /// Memory that only a rebuild needs, for other sums over sorted particles to use in between.
    pub fn workspace_mut(&mut self) -> &mut Workspace<D> {
        &mut self.workspace
    }

    /// The lists, tile by tile.
    pub fn tiles(&self) -> &[TileLists] {
        &self.tiles
    }

    /// Number of particles, filled up to whole blocks: the index of the first copy.
    pub fn n_padded(&self) -> usize {
        self.n_particles.div_ceil(LANES) * LANES
    }

    /// Number of records that pair loops read: particles, filling, copies.
    pub fn n_records(&self) -> usize {
        self.n_padded() + self.halo.len()
    }

    /// Positions when the lists were built, by axis [m].
    pub fn reference(&self) -> &[Vec<f64>] {
        &self.reference
    }

    /// The particle that a record shows.
    pub fn owner(&self, record: usize) -> usize {
        if record < self.n_padded() { record } else { self.halo.owner[record - self.n_padded()] as usize }
    }

    /// Slots of a block.
    #[inline(always)]
    pub fn block(&self, block: usize) -> &[[u32; LANES]] {
        self.tiles[block / TILE_BLOCKS].block(block % TILE_BLOCKS)
    }

    /// Records listed for a particle (without itself).
    pub fn neighbors(&self, i: usize) -> impl Iterator<Item = u32> + '_ {
        self.block(i / LANES).iter().map(move |slot| slot[i % LANES]).filter(move |&j| j as usize != i)
    }

    /// Bytes that the lists take.
    pub fn bytes(&self) -> usize {
        let halo = self.halo.len() * (4 + size_of::<D::Vector>());
        self.tiles.iter().map(TileLists::bytes).sum::<usize>()
            + halo
            + self.n_particles * 8 * D::COUNT
            + self.workspace.bytes()
            + self.motion.bytes()
    }

    /// True if some pair that is not listed may have come within its support: see the module `motion`.
    pub fn outlived(&mut self, position: &D::AxisColumns) -> bool {
        self.motion_share(position) > 1.0
    }

    /// How far particles have moved against each other since the lists were built, as a share of what they allow: lists with
    /// more than 1 are outlived.
    pub fn motion_share(&mut self, position: &D::AxisColumns) -> f64 {
        self.motion.share(&self.reference, position)
    }
}
