//! The search for the pairs of a tile: eight candidates at a time.

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
}

impl<'a, D: Dimension> Search<'a, D> {
    pub fn new(
        points: &'a CellSortedPoints<D>,
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
        Self { points, halo, size, reach, farthest, position, size_of }
    }

    /// Lists of the particles of a tile, at the given positions.
    pub fn tile(&self, tile: usize, position: &D::AxisColumns) -> TileLists {
        let mut lists = TileLists { start: vec![0], ..Default::default() };
        dispatch(TileSearch { search: self, tile, position, lists: &mut lists });
        lists.slots.shrink_to_fit();
        lists
    }

    /// Turns point indices into record indices (copies stand behind the filling) and notes the tiles that are seen.
    fn mark_seen(&self, found: &mut [u32], seen: &mut [bool]) {
        let n = self.size.len();
        let filling = (n.div_ceil(LANES) * LANES - n) as u32;
        for j in found {
            let owner = if (*j as usize) < n {
                *j
            } else {
                let owner = self.halo.owner[*j as usize - n];
                *j += filling;
                owner
            };
            seen[owner as usize / TILE] = true;
        }
    }

    /// Points near particle `i`, in the order of the cells: those within reach in `found`, those in the skin in `beyond`.
    /// Pairs of the skin stand last, so that the slots of a block that no lane needs yet come together and are skipped.
    #[inline(always)]
    fn particle<L: Lanes>(
        &self,
        i: usize,
        position: &D::AxisColumns,
        found: &mut Vec<u32>,
        beyond: &mut Vec<u32>,
    ) {
        let here = D::vector(|a| position[a][i]);
        let (own, factor) = (L::splat(self.size[i]), L::splat(self.reach.factor));
        let skin = L::splat(self.reach.skin);
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
                let within = r2.less_mask(reach * reach);
                while listed != 0 {
                    let lane = listed.trailing_zeros() as usize;
                    listed &= listed - 1;
                    let j = self.points.index[p + lane];
                    if j as usize != i {
                        if within >> lane & 1 == 1 { found.push(j) } else { beyond.push(j) }
                    }
                }
            }
        });
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
        let mut found: [Vec<u32>; LANES] = Default::default();
        let mut beyond = Vec::new();
        let mut seen = vec![false; n.div_ceil(TILE)];
        for block in (first..end).step_by(LANES) {
            for lane in 0..LANES {
                found[lane].clear();
                if block + lane < end {
                    beyond.clear();
                    search.particle::<L>(block + lane, position, &mut found[lane], &mut beyond);
                    found[lane].extend_from_slice(&beyond);
                    search.mark_seen(&mut found[lane], &mut seen);
                }
            }
            let longest = found.iter().map(Vec::len).max().unwrap_or(0);
            for k in 0..longest {
                let mut slot = [0; LANES];
                for l in 0..LANES {
                    slot[l] = found[l].get(k).copied().unwrap_or((block + l) as u32);
                }
                lists.slots.push(slot);
            }
            lists.start.push(lists.slots.len() as u32);
        }
        lists.seen = (0..seen.len() as u32).filter(|&s| seen[s as usize]).collect();
    }
}
