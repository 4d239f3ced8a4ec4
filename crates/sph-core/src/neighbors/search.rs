//! The search for the pairs of a tile: eight candidates at a time.
//!
//! **Who owns a pair** is decided along a skew line, d = x + 0.3 y + 0.09 z: the particle with the lower d does. Each
//! particle then owns half of its neighbors, on a lattice exactly: blocks are filled evenly. The difference of two
//! particles is computed so that it changes nothing but its sign when they change places, images included; what ties is
//! decided by numbers.

use crate::dimension::{Components, Dimension};
use crate::lanes::{LANES, LaneKernel, Lanes, dispatch};
use crate::neighbors::cell_grid::CellSortedPoints;
use crate::neighbors::{Halo, Reach, TILE, TileLists};

/// Where the filling of whole lanes stands [m]: beyond every reach, and finite when squared.
const FAR: f64 = 1e100;

/// What the search of one tile reads.
pub(super) struct Search<'a, D: Dimension> {
    points: &'a CellSortedPoints<D>,
    halo: &'a Halo<D>,
    size: &'a [f64],
    reach: Reach,
    farthest: f64,
    /// Coordinates and sizes of the sorted points, filled up by whole lanes.
    position: D::AxisColumns,
    size_of: Vec<f64>,
    /// Place of each particle along the skew line [m].
    along: Vec<f64>,
    /// The same for the particle that each sorted point shows, and the shift of the point along the line.
    along_of: Vec<f64>,
    shift_of: Vec<f64>,
    /// Record and particle of each sorted point.
    record_of: Vec<(u32, u32)>,
}

/// Direction of the line that decides who owns a pair: no two points of a lattice near each other lie across it.
const SKEW: [f64; 3] = [1.0, 0.3, 0.09];

/// Place of a point along the skew line [m].
fn along<D: Dimension>(coordinate: impl Fn(usize) -> f64) -> f64 {
    (0..D::COUNT).map(|a| SKEW[a] * coordinate(a)).sum()
}

impl<'a, D: Dimension> Search<'a, D> {
    pub fn new(
        points: &'a CellSortedPoints<D>,
        of_particles: &D::AxisColumns,
        halo: &'a Halo<D>,
        size: &'a [f64],
        reach: Reach,
        farthest: f64,
    ) -> Self {
        let n = size.len();
        let owner = |i: u32| if (i as usize) < n { i as usize } else { halo.owner[i as usize - n] as usize };
        let filled = |column: &[f64]| column.iter().copied().chain([FAR; LANES]).collect();
        let position = Components::from_fn(|a| filled(&points.position[a]));
        let size_of = points.index.iter().map(|&i| size[owner(i)]).chain([0.0; LANES]).collect();
        let line: Vec<f64> = (0..n).map(|i| along::<D>(|a| of_particles[a][i])).collect();
        let shift = |i: u32| (i as usize).checked_sub(n).map_or(0.0, |c| along::<D>(|a| halo.shift[c][a]));
        let along_of = points.index.iter().map(|&i| line[owner(i)]).chain([0.0; LANES]).collect();
        let shift_of = points.index.iter().map(|&i| shift(i)).chain([0.0; LANES]).collect();
        let filling = (n.next_multiple_of(LANES) - n) as u32;
        let record = |i: u32| if (i as usize) < n { i } else { i + filling };
        let record_of = points.index.iter().map(|&i| (record(i), owner(i) as u32)).collect();
        Self {
            points,
            halo,
            size,
            reach,
            farthest,
            position,
            size_of,
            along: line,
            along_of,
            shift_of,
            record_of,
        }
    }

    /// Lists of the particles of a tile, at the given positions.
    pub fn tile(&self, tile: usize, position: &D::AxisColumns) -> TileLists {
        let mut lists = TileLists::new();
        dispatch(TileSearch { search: self, tile, position, lists: &mut lists });
        lists
    }

    /// The particle of a record (copies stand behind the filling).
    fn owner(&self, record: u32) -> u32 {
        let padded = self.size.len().div_ceil(LANES) * LANES;
        if (record as usize) < padded { record } else { self.halo.owner[record as usize - padded] }
    }

    /// Points near particle `i`, in the order of the cells. Pairs of the skin stand last, so that the slots of a block that
    /// no lane needs yet come together and are skipped.
    #[inline(always)]
    fn particle<L: Lanes>(&self, i: usize, position: &D::AxisColumns, lists: &mut Neighbors) {
        let here = D::vector(|a| position[a][i]);
        let (own, factor) = (L::splat(self.size[i]), L::splat(self.reach.factor));
        let skin = L::splat(self.reach.skin);
        let along = L::splat(self.along[i]);
        self.points.runs_near(here, self.farthest, |first, end| {
            for p in (first..end).step_by(LANES) {
                let mut r2 = L::zero();
                for a in 0..D::COUNT {
                    let d = eight::<L>(&self.position[a], p) - L::splat(here[a]);
                    r2 = d.mul_add(d, r2);
                }
                let reach = factor * (own + eight::<L>(&self.size_of, p));
                let cut = reach + skin;
                let of_run = if end - p < LANES { (1u8 << (end - p)) - 1 } else { u8::MAX };
                let mut listed = r2.less_mask(cut * cut) & of_run;
                if listed == 0 {
                    continue;
                }
                let within = r2.less_mask(reach * reach);
                let difference = (eight::<L>(&self.along_of, p) - along) + eight::<L>(&self.shift_of, p);
                let mut owns = L::zero().less_mask(difference);
                let mut ties = !owns & !difference.less_mask(L::zero()) & listed;
                while ties != 0 {
                    let lane = ties.trailing_zeros() as usize;
                    ties &= ties - 1;
                    owns |= u8::from(self.owns_tied(i, p + lane)) << lane;
                    if self.points.index[p + lane] as usize == i {
                        listed &= !(1 << lane); // The particle itself.
                    }
                }
                while listed != 0 {
                    let lane = listed.trailing_zeros() as usize;
                    listed &= listed - 1;
                    let (record, owner) = self.record_of[p + lane];
                    lists.seen[owner as usize / TILE] = true;
                    match (owns >> lane & 1 == 1, within >> lane & 1 == 1) {
                        (true, true) => lists.owned.push(record),
                        (true, false) => lists.owned_skin.push(record),
                        (false, true) => lists.others.push(record),
                        (false, false) => lists.others_skin.push(record),
                    }
                }
            }
        });
        lists.append_skin();
    }

    /// Whether particle `i` owns the pair with sorted point `p`, which lies straight across the skew line.
    #[cold]
    fn owns_tied(&self, i: usize, p: usize) -> bool {
        let owner = self.record_of[p].1 as usize;
        if owner != i {
            return owner > i;
        }
        // An image of the particle itself.
        let shift = (self.points.index[p] as usize).checked_sub(self.size.len()).map(|c| self.halo.shift[c]);
        shift.is_some_and(|s| (0..D::COUNT).find(|&a| s[a] != 0.0).is_some_and(|a| s[a] > 0.0))
    }
}

/// Neighbors of one particle, as they are found.
struct Neighbors {
    owned: Vec<u32>,
    owned_skin: Vec<u32>,
    others: Vec<u32>,
    others_skin: Vec<u32>,
    /// By tile: true if it holds a neighbor of the particles so far.
    seen: Vec<bool>,
}

impl Neighbors {
    fn append_skin(&mut self) {
        self.owned.append(&mut self.owned_skin);
        self.others.append(&mut self.others_skin);
    }
}

#[inline(always)]
fn eight<L: Lanes>(column: &[f64], first: usize) -> L {
    L::load(column[first..first + LANES].try_into().expect("columns are filled up to whole lanes"))
}

/// The search of one tile.
struct TileSearch<'a, 'b, D: Dimension> {
    search: &'a Search<'b, D>,
    tile: usize,
    position: &'a D::AxisColumns,
    lists: &'a mut TileLists,
}

impl<D: Dimension> LaneKernel for TileSearch<'_, '_, D> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { search, tile, position, lists } = self;
        let n = search.size.len();
        let (first, end) = (tile * TILE, ((tile + 1) * TILE).min(n));
        let mut found = Neighbors {
            owned: Vec::new(),
            owned_skin: Vec::new(),
            others: Vec::new(),
            others_skin: Vec::new(),
            seen: vec![false; n.div_ceil(TILE)],
        };
        let mut owned: [Vec<u32>; LANES] = Default::default();
        let mut others: [Vec<u32>; LANES] = Default::default();
        for block in (first..end).step_by(LANES) {
            for lane in 0..LANES {
                owned[lane].clear();
                others[lane].clear();
                if block + lane < end {
                    search.particle::<L>(block + lane, position, &mut found);
                    owned[lane].append(&mut found.owned);
                    others[lane].append(&mut found.others);
                }
            }
            lists.push_block(block, &owned, &others);
        }
        let seen: Vec<u32> = (0..found.seen.len() as u32).filter(|&s| found.seen[s as usize]).collect();
        lists.set_targets(tile, &seen, |record| search.owner(record));
    }
}
