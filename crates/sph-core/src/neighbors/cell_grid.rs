//! Cells: the order of particles in memory, and the search for neighbors.

use rayon::prelude::*;

use crate::dimension::{Components, Dimension};
use crate::domain::Domain;
use crate::lanes::LANES;
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
    /// Cells at least `width` [m] wide around all points.
    pub fn around(position: &[&[f64]], width: f64) -> Self {
        let bounds = |a: usize| {
            position[a].iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, u), &x| (l.min(x), u.max(x)))
        };
        let bounds: Vec<(f64, f64)> = (0..D::COUNT).map(bounds).collect();
        let mut width = width;
        loop {
            let mut count = [1; 3];
            for a in 0..D::COUNT {
                let extent = (bounds[a].1 - bounds[a].0).max(0.0);
                count[a] = (extent / width).min(1e9) as usize + 1;
            }
            if count.iter().map(|&n| n as f64).product::<f64>() <= MAX_CELLS as f64 {
                let lower = D::vector(|a| if bounds[a].0.is_finite() { bounds[a].0 } else { 0.0 });
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
            // The cast saturates: points outside fall into the outermost cells.
            at[a] = (c as usize).min(self.count[a] - 1);
        }
        at
    }

    #[inline]
    fn number(&self, at: [usize; 3]) -> usize {
        (at[0] * self.count[1] + at[1]) * self.count[2] + at[2]
    }

    /// Place of a cell along the strips: strips of [`STRIP`] cells run along the first axis; within a strip, cells across
    /// it follow each other.
    fn strip_rank(&self, at: [usize; 3]) -> usize {
        let strips = |a: usize| self.count[a].div_ceil(STRIP);
        let (sy, sz) = (at[1] / STRIP, at[2] / STRIP);
        let wide = |a: usize| self.count[a].min(STRIP);
        let strip = sz * strips(1) + sy;
        ((strip * self.count[0] + at[0]) * wide(1) + at[1] % STRIP) * wide(2) + at[2] % STRIP
    }

    fn strip_ranks(&self) -> usize {
        let padded = |a: usize| self.count[a].div_ceil(STRIP) * self.count[a].min(STRIP);
        self.count[0] * padded(1) * padded(2)
    }
}

/// Stable counting sort: indices `0..keys.len()` by key, and the first place of every key.
pub(crate) fn counting_sort(keys: &[u32], n_keys: usize) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0u32; n_keys + 1];
    for &key in keys {
        start[key as usize + 1] += 1;
    }
    for k in 0..n_keys {
        start[k + 1] += start[k];
    }
    let mut next = start.clone();
    let mut order = vec![0u32; keys.len()];
    for (i, &key) in keys.iter().enumerate() {
        order[next[key as usize] as usize] = i as u32;
        next[key as usize] += 1;
    }
    (order, start)
}

/// Moves particles into the box on periodic axes and sorts them in cell order: along strips of cells of the given width
/// [m]. Particles of one cell keep their order.
pub fn sort_particles<D: Dimension>(particles: &mut Particles<D>, domain: &Domain<D>, width: f64) {
    for a in (0..D::COUNT).filter(|&a| domain.periodic[a]) {
        particles.position[a].iter_mut().for_each(|x| *x = domain.wrap(a, *x));
    }
    let columns: Vec<&[f64]> = particles.position.as_ref().iter().map(Vec::as_slice).collect();
    let grid = CellGrid::<D>::around(&columns, width);
    let key = |i: usize| grid.strip_rank(grid.coordinates(|a| columns[a][i])) as u32;
    let keys: Vec<u32> = (0..particles.len()).into_par_iter().map(key).collect();
    let (order, _) = counting_sort(&keys, grid.strip_ranks());
    if order.iter().enumerate().any(|(k, &i)| k as u32 != i) {
        particles.gather(&order);
    }
}

/// Points sorted by cell: runs of cells along the last axis are runs of points.
#[derive(Clone, Debug)]
pub struct CellSortedPoints<D: Dimension> {
    grid: CellGrid<D>,
    /// First point of every cell.
    start: Vec<u32>,
    /// Index of each point in the order that it was given in.
    pub index: Vec<u32>,
    /// Coordinates of each point, sorted, and of as many as eight behind them that are [`FAR`] from all [m].
    pub position: D::AxisColumns,
}

impl<D: Dimension> CellSortedPoints<D> {
    /// Sorts points into cells at least `width` [m] wide.
    pub fn new(position: &D::AxisColumns, width: f64) -> Self {
        let columns: Vec<&[f64]> = position.as_ref().iter().map(Vec::as_slice).collect();
        let grid = CellGrid::<D>::around(&columns, width);
        let key = |i: usize| grid.number(grid.coordinates(|a| columns[a][i])) as u32;
        let keys: Vec<u32> = (0..columns[0].len()).into_par_iter().map(key).collect();
        let (index, start) = counting_sort(&keys, grid.len());
        let mut points = Self { grid, start, index, position: Components::from_fn(|_| Vec::new()) };
        points.position = Components::from_fn(|a| points.column(|i| columns[a][i as usize], FAR));
        points
    }

    /// Numbers of the points, told by their index, in the order of the cells, and of the filling behind them.
    pub fn column<T: Copy + Send + Sync>(
        &self,
        value: impl Fn(u32) -> T + Sync + Send,
        filling: T,
    ) -> Vec<T> {
        let mut column = Vec::with_capacity(self.index.len() + LANES);
        self.index.par_iter().map(|&i| value(i)).collect_into_vec(&mut column);
        column.extend([filling; LANES]);
        column
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
        let last = D::COUNT - 1;
        let middle = if D::COUNT == 3 { low[1]..=high[1] } else { 0..=0 };
        for x in low[0]..=high[0] {
            for y in middle.clone() {
                let mut from = [x, y, 0];
                from[last] = low[last];
                let mut to = [x, y, 0];
                to[last] = high[last];
                let (first, end) = (self.start[self.grid.number(from)], self.start[self.grid.number(to) + 1]);
                run(first as usize, end as usize);
            }
        }
    }

    /// True if points within `reach` [m] of a point are those that `vicinity` has.
    #[inline(always)]
    pub fn is_known(&self, point: D::Vector, reach: f64, vicinity: &Vicinity) -> bool {
        let [low, high] = self.cells_near(point, reach).map(|cell| self.grid.number(cell));
        (low, high) == vicinity.cells
    }

    /// Finds the points that may lie within `reach` [m] of a point. Points of one cell see the same: where the one before
    /// was there too, there is nothing to do.
    #[inline(always)]
    pub fn look_around(&self, point: D::Vector, reach: f64, vicinity: &mut Vicinity) {
        let cells = self.cells_near(point, reach);
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
