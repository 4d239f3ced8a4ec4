//! The search for the pairs of a tile: eight candidates at a time.
//!
//! **Who owns a pair** is decided along a skew line, d = x + 0.3 y + 0.09 z: the particle with the lower d does. Each
//! particle then owns half of its neighbors, on a lattice exactly: blocks are filled evenly. The difference of two
//! particles is computed so that it changes nothing but its sign when they change places, images included; what ties is
//! decided by numbers.
//!
//! Which of eight candidates are listed, and of what kind they are, are masks; the candidates of each kind are packed and
//! written down together. There is no branch for a single candidate: machines guessed half of those wrong.

use crate::dimension::Dimension;
use crate::lanes::{InstructionSet, LANES, LaneKernel, Lanes, dispatch_with};
use crate::neighbors::cell_grid::{CellSortedPoints, Workspace};
use crate::neighbors::draft::{Draft, Near, Row};
use crate::neighbors::{Halo, Reach, TILE, TileLists};

/// Direction of the line that decides who owns a pair: no two points of a lattice near each other lie across it.
const SKEW: [f64; 3] = [1.0, 0.3, 0.09];

/// Place of a point along the skew line [m].
#[inline(always)]
fn along<D: Dimension>(coordinate: impl Fn(usize) -> f64) -> f64 {
    (0..D::COUNT).map(|a| SKEW[a] * coordinate(a)).sum()
}

/// What the search of one tile reads.
pub(super) struct Search<'a, D: Dimension> {
    points: &'a CellSortedPoints<D>,
    position: &'a D::AxisColumns,
    halo: &'a Halo<D>,
    size: &'a [f64],
    reach: Reach,
    farthest: f64,
    /// Sizes of the sorted points, filled up by whole lanes.
    size_of: &'a [f64],
    /// Place along the skew line of the particle that each sorted point shows, and the shift of the point along the line [m].
    along_of: &'a [f64],
    shift_of: &'a [f64],
    /// Record of each sorted point.
    record_of: &'a [u32],
}

impl<'a, D: Dimension> Search<'a, D> {
    /// Sorts particles and their copies for a search that reaches to `farthest` [m].
    pub fn new(
        workspace: &'a mut Workspace<D>,
        position: &'a D::AxisColumns,
        halo: &'a Halo<D>,
        size: &'a [f64],
        reach: Reach,
        farthest: f64,
    ) -> Self {
        let Workspace { points, numbers: [size_of, along_of, shift_of], records: record_of } = workspace;
        points.sort(position, halo, farthest.max(f64::MIN_POSITIVE), record_of);
        let n = size.len();
        let owner = |i: u32| if (i as usize) < n { i as usize } else { halo.owner[i as usize - n] as usize };
        let shift = |i: u32| (i as usize).checked_sub(n).map_or(0.0, |c| along::<D>(|a| halo.shift[c][a]));
        let filling = (n.next_multiple_of(LANES) - n) as u32;
        points.column(|i| size[owner(i)], 0.0, size_of);
        points.column(|i| along::<D>(|a| position[a][owner(i)]), 0.0, along_of);
        points.column(shift, 0.0, shift_of);
        points.column(|i| if (i as usize) < n { i } else { i + filling }, 0, record_of);
        Self { points, position, halo, size, reach, farthest, size_of, along_of, shift_of, record_of }
    }

    /// Lists of the particles of a tile.
    pub fn tile(&self, instructions: InstructionSet, tile: usize, draft: &mut Draft, lists: &mut TileLists) {
        dispatch_with(instructions, TileSearch { search: self, tile, draft });
        draft.finish(tile, |record| self.owner(record), lists);
    }

    /// The particle of a record (copies stand behind the filling).
    fn owner(&self, record: u32) -> u32 {
        let padded = self.size.len().div_ceil(LANES) * LANES;
        if (record as usize) < padded { record } else { self.halo.owner[record as usize - padded] }
    }

    /// Points near particle `i`, in the order of the cells. Pairs of the skin stand last, so that the slots of a block that
    /// no lane needs yet come together and are skipped.
    #[inline(always)]
    fn particle<L: Lanes>(&self, i: usize, near: &mut Near, owned: &mut Row, others: &mut Row) {
        let here = D::vector(|a| self.position[a][i]);
        let (own, factor) = (L::splat(self.size[i]), L::splat(self.reach.factor));
        let Near { vicinity, skin: [owned_skin, others_skin] } = near;
        let width = L::splat(self.reach.skin);
        let line = L::splat(along::<D>(|a| here[a]));
        [&mut *owned, others, owned_skin, others_skin].into_iter().for_each(Row::clear);
        self.points.look_around(here, self.farthest, vicinity);
        for &(p, count) in &vicinity.eights {
            let p = p as usize;
            let mut r2 = L::zero();
            for a in 0..D::COUNT {
                let d = eight::<L>(&self.points.position[a], p) - L::splat(here[a]);
                r2 = d.mul_add(d, r2);
            }
            let reach = factor * (own + eight::<L>(self.size_of, p));
            let cut = reach + width;
            let of_run = if count < LANES as u32 { (1u8 << count) - 1 } else { u8::MAX };
            let mut listed = r2.less_mask(cut * cut) & of_run;
            if listed == 0 {
                continue;
            }
            let within = r2.less_mask(reach * reach);
            let difference = (eight::<L>(self.along_of, p) - line) + eight::<L>(self.shift_of, p);
            let mut owns = L::zero().less_mask(difference);
            let ties = !owns & !difference.less_mask(L::zero()) & listed;
            // Most ties are the particle itself: found without a branch.
            let first = ties.trailing_zeros() as usize % LANES;
            let itself = u8::from(self.record_of[p + first] as usize == i) << first;
            listed &= !itself;
            if ties & !itself != 0 {
                let (owns_tied, itself) = self.tied(i, p, ties);
                (owns, listed) = (owns | owns_tied, listed & !itself);
            }
            let records =
                self.record_of[p..p + LANES].try_into().expect("columns are filled up to whole lanes");
            owned.push::<L>(records, listed & within & owns);
            others.push::<L>(records, listed & within & !owns);
            owned_skin.push::<L>(records, listed & !within & owns);
            others_skin.push::<L>(records, listed & !within & !owns);
        }
        owned.append(owned_skin);
        others.append(others_skin);
    }

    /// Of the sorted points from `p` on that lie straight across the skew line: those whose pair particle `i` owns, and the
    /// particle itself.
    #[cold]
    fn tied(&self, i: usize, p: usize, ties: u8) -> (u8, u8) {
        let (mut owns, mut itself) = (0, 0);
        for lane in (0..LANES).filter(|lane| ties >> lane & 1 == 1) {
            owns |= u8::from(self.owns_tied(i, p + lane)) << lane;
            itself |= u8::from(self.points.index()[p + lane] as usize == i) << lane;
        }
        (owns, itself)
    }

    fn owns_tied(&self, i: usize, p: usize) -> bool {
        let owner = self.owner(self.record_of[p]) as usize;
        if owner != i {
            return owner > i;
        }
        // An image of the particle itself.
        let shift =
            (self.points.index()[p] as usize).checked_sub(self.size.len()).map(|c| self.halo.shift[c]);
        shift.is_some_and(|s| (0..D::COUNT).find(|&a| s[a] != 0.0).is_some_and(|a| s[a] > 0.0))
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
    draft: &'a mut Draft,
}

impl<D: Dimension> LaneKernel for TileSearch<'_, '_, D> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { search, tile, draft } = self;
        let (first, end) = (tile * TILE, ((tile + 1) * TILE).min(search.size.len()));
        for block in (first..end).step_by(LANES) {
            for lane in 0..LANES {
                let (owned, others) = (&mut draft.owned[lane], &mut draft.others[lane]);
                if block + lane < end {
                    search.particle::<L>(block + lane, &mut draft.near, owned, others);
                } else {
                    [owned, others].into_iter().for_each(Row::clear);
                }
            }
            draft.push_block(block);
        }
    }
}
