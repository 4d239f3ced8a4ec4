//! Cells: the order of particles in memory, and the search for neighbors.

use std::ops::Range;

use rayon::prelude::*;

use crate::dimension::{Components, Dimension};
use crate::domain::Domain;
use crate::lanes::LANES;
use crate::memory::resize_scratch;
use crate::neighbors::Halo;
use crate::particles::Particles;

/// Width, in cells, of the strips that particles are ordered along. Neighbors are then a few lines of a strip away, or
/// in the strip beside it: near in memory also where a row of the whole box would not fit a cache.
const STRIP: usize = 8;

/// Where the filling of whole lanes stands [m]: beyond every reach, and finite when squared.
const FAR: f64 = 1e100;

/// Largest number of cells: a sparse cloud gets wider cells than it asked for.
const MAX_CELLS: usize = 1 << 24;

/// A regular grid of cells around points. Cell (a, b, c) has number (a n_b + b) n_c + c, so that cells along the last
/// axis follow each other.
#[derive(Clone, Debug)]
pub struct CellGrid<D: Dimension> {
    lower: D::Vector,
    inverse_width: f64,
    count: [usize; 3],
}

impl<D: Dimension> CellGrid<D> {
    /// Cells at least `width` [m] wide between the least and the largest coordinates along each axis [m].
    fn between(bounds: D::Axes<[f64; 2]>, mut width: f64) -> Self {
        loop {
            let mut count = [1; 3];
            for a in 0..D::COUNT {
                let extent = (bounds[a][1] - bounds[a][0]).max(0.0);
                count[a] = (extent / width).min(1e9) as usize + 1;
            }
            // Without a width, or with an extent that is not finite, no wider cells would do: these.
            let is_hopeless = !(width > 0.0 && width.is_finite());
            if is_hopeless {
                count = [1; 3];
            }
            if count.iter().map(|&n| n as f64).product::<f64>() <= MAX_CELLS as f64 {
                let lower = D::vector(|a| if bounds[a][0].is_finite() { bounds[a][0] } else { 0.0 });
                return Self { lower, inverse_width: 1.0 / width, count };
            }
            width *= 1.5;
        }
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.count.iter().product()
    }

    /// True without cells (never: an empty cloud has one).
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Cell coordinates of a point, given its coordinate along each axis [m].
    #[inline]
    pub fn coordinates(&self, point: impl Fn(usize) -> f64) -> [usize; 3] {
        let mut at = [0; 3];
        for a in 0..D::COUNT {
            let c = (point(a) - self.lower[a]) * self.inverse_width;
            // The cast saturates (a cheap one, to 32 bits): points outside fall into the outermost cells.
            at[a] = (c as u32 as usize).min(self.count[a] - 1);
        }
        at
    }

    #[inline]
    fn number(&self, at: [usize; 3]) -> usize {
        (at[0] * self.count[1] + at[1]) * self.count[2] + at[2]
    }
}

/// Place of a cell along the strips of a grid with `count` cells along each axis: strips of [`STRIP`] cells run along the
/// first axis; within a strip, cells across it follow each other.
#[inline]
pub(super) fn strip_rank(at: [usize; 3], count: [usize; 3]) -> usize {
    let strips = |a: usize| count[a].div_ceil(STRIP);
    let (sy, sz) = (at[1] / STRIP, at[2] / STRIP);
    let wide = |a: usize| count[a].min(STRIP);
    let strip = sz * strips(1) + sy;
    ((strip * count[0] + at[0]) * wide(1) + at[1] % STRIP) * wide(2) + at[2] % STRIP
}

/// Number of such places; some have no cell.
pub(super) fn strip_ranks(count: [usize; 3]) -> usize {
    let padded = |a: usize| count[a].div_ceil(STRIP) * count[a].min(STRIP);
    count[0] * padded(1) * padded(2)
}

/// Least and largest of some numbers; infinite, the other way around, without any.
pub(crate) fn bounds(numbers: &[f64]) -> [f64; 2] {
    let least = |a: f64, b: f64| if b < a { b } else { a };
    // Eight chains at a time do not wait for each other.
    let of_part = |part: &[f64]| {
        let (eights, rest) = part.as_chunks::<LANES>();
        let (mut low, mut high) = ([f64::INFINITY; LANES], [f64::INFINITY; LANES]);
        for eight in eights {
            for l in 0..LANES {
                low[l] = least(low[l], eight[l]);
                high[l] = least(high[l], -eight[l]);
            }
        }
        let both = |mut a: [f64; 2], b: [f64; 2]| {
            (0..2).for_each(|k| a[k] = least(a[k], b[k]));
            a
        };
        let rest = rest.iter().map(|&x| [x, -x]);
        low.into_iter().zip(high).map(|(l, h)| [l, h]).chain(rest).fold([f64::INFINITY; 2], both)
    };
    let parts = numbers.par_chunks(PART).map(of_part);
    let [low, high] = parts.reduce(|| [f64::INFINITY; 2], |a, b| [least(a[0], b[0]), least(a[1], b[1])]);
    [low, -high]
}

/// Numbers that one thread looks at in one go.
const PART: usize = 1 << 14;

/// Indices sorted by key.
#[derive(Clone, Debug, Default)]
pub(crate) struct CountingSort {
    /// Indices by key; in their order where keys are equal.
    pub order: Vec<u32>,
    /// First place of every key, and the end of the last.
    pub start: Vec<u32>,
}

impl CountingSort {
    /// Sorts the indices below `count`, whose keys are below `n_keys`. Each thread sorts what has keys in its own range:
    /// every thread reads all keys, but none writes where another does. `keys` is memory for them.
    pub fn sort(
        &mut self,
        count: usize,
        n_keys: usize,
        key: impl Fn(usize) -> u32 + Send + Sync,
        keys: &mut Vec<u32>,
    ) {
        let Self { order, start } = self;
        resize_scratch(keys, count, 0);
        resize_scratch(order, count, 0);
        (0..count).into_par_iter().with_min_len(PART).map(key).collect_into_vec(keys);
        let keys = keys.as_slice();
        let span = n_keys.div_ceil(rayon::current_num_threads()).max(1);
        // `start[k + 2]` counts key k, then `start[k + 1]` is its next place, and `start[k]` its first in the end.
        start.clear();
        start.resize(n_keys + 2, 0);
        start[2..].par_chunks_mut(span).enumerate().for_each(|(range, counts)| {
            for &key in keys {
                if let Some(count) = counts.get_mut((key as usize).wrapping_sub(range * span)) {
                    *count += 1;
                }
            }
        });
        for k in 2..start.len() {
            start[k] += start[k - 1];
        }
        let ends = (1..=n_keys.div_ceil(span)).map(|range| start[1 + (range * span).min(n_keys)] as usize);
        let (mut rest, mut first) = (order.as_mut_slice(), 0);
        let split = |end: usize| {
            let (part, behind) =
                std::mem::take(&mut rest).split_at_mut(end - std::mem::replace(&mut first, end));
            rest = behind;
            part
        };
        let parts: Vec<&mut [u32]> = ends.map(split).collect();
        let ranges = start[1..=n_keys].par_chunks_mut(span).zip(parts).enumerate();
        ranges.for_each(|(range, (next, part))| {
            let first = next[0];
            for (i, &key) in keys.iter().enumerate() {
                if let Some(next) = next.get_mut((key as usize).wrapping_sub(range * span)) {
                    part[(*next - first) as usize] = i as u32;
                    *next += 1;
                }
            }
        });
        start.truncate(n_keys + 1);
    }

    /// Bytes in use.
    pub fn bytes(&self) -> usize {
        (self.order.len() + self.start.len()) * 4
    }
}

/// Moves particles into the box on periodic axes and sorts them in cell order: along strips of cells of the given width
/// [m]. Particles of one cell keep their order.
pub fn sort_particles<D: Dimension>(particles: &mut Particles<D>, domain: &Domain<D>, width: f64) {
    for a in (0..D::COUNT).filter(|&a| domain.periodic[a]) {
        particles.position[a].par_iter_mut().with_min_len(PART).for_each(|x| *x = domain.wrap(a, *x));
    }
    let position = &particles.position;
    let grid = CellGrid::<D>::between(Components::from_fn(|a| bounds(&position[a])), width);
    let mut sort = CountingSort::default();
    let key = |i: usize| strip_rank(grid.coordinates(|a| position[a][i]), grid.count) as u32;
    sort.sort(particles.len(), strip_ranks(grid.count), key, &mut Vec::new());
    if sort.order.iter().enumerate().any(|(k, &i)| k as u32 != i) {
        particles.gather(&sort.order);
    }
}

/// Particles and their copies sorted by cell: runs of cells along the last axis are runs of points.
#[derive(Clone, Debug)]
pub struct CellSortedPoints<D: Dimension> {
    grid: CellGrid<D>,
    /// The points by cell: indices of particles, then those of copies.
    sort: CountingSort,
    /// Coordinates of each point, sorted, and of as many as eight behind them that are far from all [m].
    pub position: D::AxisColumns,
}

impl<D: Dimension> Default for CellSortedPoints<D> {
    fn default() -> Self {
        let grid = CellGrid::between(Components::splat([0.0; 2]), 1.0);
        Self { grid, sort: CountingSort::default(), position: Components::from_fn(|_| Vec::new()) }
    }
}

impl<D: Dimension> CellSortedPoints<D> {
    /// Sorts particles and their copies into cells at least `width` [m] wide.
    pub fn new(position: &D::AxisColumns, halo: &Halo<D>, width: f64) -> Self {
        let mut points = Self::default();
        points.sort(position, halo, width, &mut Vec::new());
        points
    }

    /// Sorts anew, in the memory that there is; `keys` is more of it.
    pub fn sort(&mut self, position: &D::AxisColumns, halo: &Halo<D>, width: f64, keys: &mut Vec<u32>) {
        let n = position[0].len();
        let coordinate = |i: usize, a: usize| match i.checked_sub(n) {
            None => position[a][i],
            Some(copy) => position[a][halo.owner[copy] as usize] + halo.shift[copy][a],
        };
        let all_bounds = |a: usize| {
            let copies: Vec<f64> = (n..n + halo.len()).map(|i| coordinate(i, a)).collect();
            let ([low, high], [l, h]) = (bounds(&position[a]), bounds(&copies));
            [low.min(l), high.max(h)]
        };
        let grid = CellGrid::<D>::between(Components::from_fn(all_bounds), width);
        let key = |i: usize| grid.number(grid.coordinates(|a| coordinate(i, a))) as u32;
        self.sort.sort(n + halo.len(), grid.len(), key, keys);
        self.grid = grid;
        for a in 0..D::COUNT {
            let mut column = std::mem::take(&mut self.position[a]);
            self.column(|i| coordinate(i as usize, a), FAR, &mut column);
            self.position[a] = column;
        }
    }

    /// Fills a column with numbers of the points, told by their index, in the order of the cells, and of the filling behind
    /// them.
    pub fn column<T: Copy + Send + Sync>(
        &self,
        value: impl Fn(u32) -> T + Sync + Send,
        filling: T,
        column: &mut Vec<T>,
    ) {
        resize_scratch(column, self.index().len() + LANES, filling);
        let points = self.index().par_iter().with_min_len(PART).map(|&i| value(i));
        points.chain([filling; LANES].into_par_iter()).collect_into_vec(column);
    }

    /// Index of each point: those of particles, then those of copies.
    pub fn index(&self) -> &[u32] {
        &self.sort.order
    }

    /// Bytes in use.
    pub fn bytes(&self) -> usize {
        self.sort.bytes() + self.position.as_ref().iter().map(Vec::len).sum::<usize>() * 8
    }

    /// Calls `run(first, end)` for each run of sorted points that may lie within `reach` [m] of a point.
    #[inline]
    pub fn runs_near(&self, point: D::Vector, reach: f64, run: impl FnMut(usize, usize)) {
        self.runs(self.cells_near(point, reach), run);
    }

    /// Lowest and highest coordinates of the cells within `reach` [m] of a point.
    #[inline(always)]
    fn cells_near(&self, point: D::Vector, reach: f64) -> [[usize; 3]; 2] {
        [self.grid.coordinates(|a| point[a] - reach), self.grid.coordinates(|a| point[a] + reach)]
    }

    #[inline(always)]
    fn runs(&self, [low, high]: [[usize; 3]; 2], mut run: impl FnMut(usize, usize)) {
        let (last, start) = (D::COUNT - 1, &self.sort.start);
        let middle = if D::COUNT == 3 { low[1]..=high[1] } else { 0..=0 };
        for x in low[0]..=high[0] {
            for y in middle.clone() {
                let mut from = [x, y, 0];
                from[last] = low[last];
                let mut to = [x, y, 0];
                to[last] = high[last];
                let (first, end) = (start[self.grid.number(from)], start[self.grid.number(to) + 1]);
                run(first as usize, end as usize);
            }
        }
    }

    /// Calls `work` for each cell that holds some of the given sorted points, with its coordinates and the range of those points.
    #[inline(always)]
    pub fn cells_of(&self, points: Range<usize>, mut work: impl FnMut([usize; 3], Range<usize>)) {
        let mut first = points.start;
        while first < points.end {
            let cell = self.grid.coordinates(|a| self.position[a][first]);
            let end = (self.sort.start[self.grid.number(cell) + 1] as usize).min(points.end);
            work(cell, first..end);
            first = end;
        }
    }

    /// Finds the points that may lie within `reach` [m] of those in a cell.
    #[inline(always)]
    pub fn look_around_cell(&self, cell: [usize; 3], reach: f64, vicinity: &mut Vicinity) {
        // A whole number of cells stays that number, whatever the rounding.
        let span = (reach * self.grid.inverse_width * (1.0 - 1e-12)).ceil() as usize;
        let low = cell.map(|c| c.saturating_sub(span));
        let high = std::array::from_fn(|a| (cell[a] + span).min(self.grid.count[a] - 1));
        self.look_at([low, high], vicinity);
    }

    /// Finds the points that may lie within `reach` [m] of a point. Points of one cell see the same: where the one before
    /// was there too, there is nothing to do.
    #[inline(always)]
    pub fn look_around(&self, point: D::Vector, reach: f64, vicinity: &mut Vicinity) {
        self.look_at(self.cells_near(point, reach), vicinity);
    }

    #[inline(always)]
    fn look_at(&self, cells: [[usize; 3]; 2], vicinity: &mut Vicinity) {
        let [low, high] = cells.map(|cell| self.grid.number(cell));
        if (low, high) == vicinity.cells {
            return;
        }
        vicinity.cells = (low, high);
        vicinity.eights.clear();
        self.runs(cells, |first, end| {
            vicinity.eights.extend((first..end).step_by(LANES).map(|p| (p as u32, (end - p) as u32)));
        });
    }
}

/// Memory for sorted points and columns of theirs. It is kept from one search to the next: a machine takes longer to hand out
/// new memory than to fill it.
#[derive(Clone, Debug, Default)]
pub struct Workspace<D: Dimension> {
    /// The sorted points.
    pub points: CellSortedPoints<D>,
    /// Columns of the sorted points.
    pub numbers: [Vec<f64>; 3],
    /// A column of the sorted points; before that, the keys that they are sorted by.
    pub records: Vec<u32>,
}

impl<D: Dimension> Workspace<D> {
    /// Bytes in use.
    pub fn bytes(&self) -> usize {
        let numbers: usize = self.numbers.iter().map(Vec::len).sum();
        self.points.bytes() + numbers * 8 + self.records.len() * 4
    }
}

/// Runs of sorted points near a place, taken apart into whole lanes.
#[derive(Clone, Debug)]
pub struct Vicinity {
    /// Numbers of the lowest and the highest cell.
    cells: (usize, usize),
    /// First of eight points, and the number of points from it to the end of the run: those beyond do not count.
    pub eights: Vec<(u32, u32)>,
}

impl Default for Vicinity {
    /// Nowhere yet.
    fn default() -> Self {
        Self { cells: (usize::MAX, 0), eights: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_of_threads_sorts_the_same_and_keeps_the_order_of_equals() {
        let key = |i: usize| (i * 7919 % 1009 % 37) as u32;
        for (count, n_keys) in [(0, 1), (1, 40), (5000, 37)] {
            let mut expected: Vec<u32> = (0..count as u32).collect();
            expected.sort_by_key(|&i| key(i as usize));
            for threads in [1, 2, 5, 64] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let mut sort = CountingSort::default();
                pool.install(|| sort.sort(count, n_keys, key, &mut Vec::new()));
                assert_eq!(sort.order, expected, "{count} indices, {threads} threads");
                let first =
                    |k: usize| expected.iter().filter(|&&i| (key(i as usize) as usize) < k).count() as u32;
                let start: Vec<u32> = (0..=n_keys).map(first).collect();
                assert_eq!(sort.start, start, "{count} indices, {threads} threads");
            }
        }
    }

    /// No width divides an extent without end, and no number of cells of no width fills any: the search must end all the same.
    #[test]
    fn a_grid_of_no_width_or_without_bounds_has_one_cell() {
        use crate::dimension::Dim2;
        for (bounds, width) in [
            ([[0.0, 1.0], [0.0, 1.0]], 0.0),
            ([[0.0, 1.0], [0.0, 1.0]], f64::NAN),
            ([[0.0, f64::INFINITY], [0.0, 1.0]], 0.1),
            ([[f64::NEG_INFINITY, f64::INFINITY], [0.0, 1.0]], 0.1),
        ] {
            let grid = CellGrid::<Dim2>::between(bounds, width);
            assert_eq!(grid.len(), 1, "{bounds:?} {width}");
            assert_eq!(grid.coordinates(|_| 0.5), [0; 3], "{bounds:?} {width}");
        }
    }

    #[test]
    fn bounds_leave_out_what_is_not_a_number() {
        let mut numbers: Vec<f64> = (0..100).map(|i| ((i * 37) % 101) as f64 - 50.0).collect();
        numbers[3] = f64::NAN;
        let least = numbers.iter().fold(f64::INFINITY, |a, &b| a.min(b));
        let largest = numbers.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
        assert_eq!(bounds(&numbers), [least, largest]);
        assert_eq!(bounds(&[]), [f64::INFINITY, f64::NEG_INFINITY]);
    }
}
