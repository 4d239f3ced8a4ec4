//! How far particles have moved against each other since their lists were built.
//!
//! A pair that is not listed was farther apart than its support and the skin. It matters again only if its particles come
//! nearer to each other by more than that gap; their relative displacement is at least as long. Cells of width W bound it
//! without a look at pairs: two particles whose cells are k apart (the largest difference of their cell coordinates) were
//! farther apart than (k - 1) W, and both lie in every window of (k + 1)^d cells around them. With R the longest support of
//! a pair, lists hold while the range of displacements is no longer than
//!
//! ```text
//! skin        in each window of 2^d cells       k ≤ 1
//! W - R       in each window of 3^d cells       k = 2
//! 2 W - R     over all particles                k > 2
//! ```
//!
//! The common stream costs nothing, nor does a smooth flow, whose differences over two cells are small. Windows are closed
//! across periodic boundaries: images of a particle move as it does.

use rayon::prelude::*;

use super::cell_grid::{self, CountingSort, strip_rank, strip_ranks};
use crate::dimension::{Components, Dimension, Vector};
use crate::domain::Domain;

/// Width of a cell over the reach of the lists, support and skin [-]. The larger it is, the more motion a window of two
/// holds, and the less a window of three matters, which may move by the excess besides.
const WIDTH: f64 = 1.1;

/// Cells a particle, at most: a sparse cloud gets wider cells.
const CELLS_A_PARTICLE: usize = 4;

/// Least displacement along each axis, and the negative of the largest [m]: both are least values, which loops over
/// windows take together.
type Range<D> = (<D as Dimension>::Axes<f64>, <D as Dimension>::Axes<f64>);

/// Particles by cell at the time the lists were built.
#[derive(Clone, Debug, Default)]
pub(super) struct Motion<D: Dimension> {
    /// Number of cells along each axis.
    count: [usize; 3],
    periodic: [bool; 3],
    /// Particles, cell by cell: along strips as they stand in memory, or near it.
    sort: CountingSort,
    /// Longest range of displacements in windows of two and of three cells along each axis, and of all particles [m].
    allowed: [f64; 3],
    /// Of each cell, when last looked at.
    ranges: Vec<Range<D>>,
}

impl<D: Dimension> Motion<D> {
    /// Sorts particles (inside the box on periodic axes) whose lists reach to `farthest` [m] at most, skin included; `keys` is
    /// memory that sorting needs.
    pub fn restart(
        &mut self,
        position: &D::AxisColumns,
        domain: &Domain<D>,
        (farthest, skin): (f64, f64),
        keys: &mut Vec<u32>,
    ) {
        let n = position[0].len();
        let mut width = (WIDTH * farthest).max(f64::MIN_POSITIVE);
        let bounds: [(f64, f64); 3] = std::array::from_fn(|a| bounds(position, domain, a));
        let mut count = cells(&bounds, width);
        while count.iter().map(|&n| n as f64).product::<f64>() > (CELLS_A_PARTICLE * n + 64) as f64 {
            width *= 1.5;
            // An extent that is not finite is not divided by any width.
            count = if width.is_finite() { cells(&bounds, width) } else { [1; 3] };
        }
        // Periodic axes are divided evenly, so that their cells may be wider yet.
        let inverse: [f64; 3] = std::array::from_fn(|a| {
            if a < D::COUNT && domain.periodic[a] { count[a] as f64 / domain.period(a) } else { 1.0 / width }
        });
        self.count = count;
        let cell = |i: usize| {
            let mut at = [0; 3];
            for a in 0..D::COUNT {
                let along = ((position[a][i] - bounds[a].0) * inverse[a]) as u32 as usize;
                at[a] = along.min(count[a] - 1);
            }
            strip_rank(at, count)
        };
        self.sort.sort(n, strip_ranks(count), |i| cell(i) as u32, keys);
        let support = farthest - skin;
        self.periodic = std::array::from_fn(|a| a < D::COUNT && domain.periodic[a]);
        self.allowed = [skin, width - support, 2.0 * width - support];
        self.ranges.resize(strip_ranks(count), nowhere::<D>());
    }

    /// Bytes in use.
    pub fn bytes(&self) -> usize {
        self.sort.bytes() + self.ranges.len() * size_of::<Range<D>>()
    }

    /// How far particles have moved against each other from the positions `then` to those `now`, as a share of what the
    /// lists allow: above 1 they no longer hold.
    pub fn share(&mut self, then: &[Vec<f64>], now: &D::AxisColumns) -> f64 {
        let (order, start) = (&self.sort.order, &self.sort.start);
        self.ranges.par_iter_mut().with_min_len(256).enumerate().for_each(|(c, range)| {
            let members = &order[start[c] as usize..start[c + 1] as usize];
            *range = range_of::<D>(members, then, now);
        });
        let layers = (0..self.count[0]).into_par_iter().map(|x| self.layer(x));
        let (longest, all) = layers.reduce(
            || ([0.0; 2], nowhere::<D>()),
            |(a, all), (b, range)| (std::array::from_fn(|n| a[n].max(b[n])), united::<D>(&all, &range)),
        );
        let squares = [longest[0], longest[1], length_squared::<D>(&all)];
        squares
            .iter()
            .zip(self.allowed)
            .map(|(square, allowed)| share(square.sqrt(), allowed))
            .fold(0.0, f64::max)
    }

    /// Squares of the longest ranges in windows of two and of three cells that begin in the cells with the first coordinate
    /// `x` [m²], and the range of these cells.
    fn layer(&self, x: usize) -> ([f64; 2], Range<D>) {
        let inner = D::COUNT - 1;
        let middle = if D::COUNT == 3 { self.count[1] } else { 1 };
        // Windows across the periodic boundary come last; those that come twice do no harm.
        let again = if self.periodic[inner] { self.count[inner].min(2) } else { 0 };
        let (mut longest, mut all) = ([0.0_f64; 2], nowhere::<D>());
        for y in 0..middle {
            let (mut last_two, mut last_three, mut before) = (nowhere::<D>(), nowhere::<D>(), nowhere::<D>());
            for z in (0..self.count[inner]).chain(0..again) {
                let [one, two, three] = self.columns([x, y, z]);
                all = united::<D>(&all, &one);
                longest[0] = longest[0].max(length_squared::<D>(&united::<D>(&last_two, &two)));
                let pair = united::<D>(&last_three, &three);
                longest[1] = longest[1].max(length_squared::<D>(&united::<D>(&before, &pair)));
                (last_two, before, last_three) = (two, last_three, three);
            }
        }
        (longest, all)
    }

    /// Ranges of the cells with one coordinate along the last axis, over one, two and three cells along each other axis,
    /// from `at` on.
    #[inline]
    fn columns(&self, at: [usize; 3]) -> [Range<D>; 3] {
        let [x, y, last] = at;
        let mut ranges = [nowhere::<D>(); 3];
        for i in 0..3 {
            let Some(x) = self.inside(0, x + i) else { break };
            if D::COUNT == 2 {
                let cell = &self.ranges[strip_rank([x, last, 0], self.count)];
                (i..3).for_each(|n| ranges[n] = united::<D>(&ranges[n], cell));
                continue;
            }
            for j in 0..3 {
                let Some(y) = self.inside(1, y + j) else { break };
                let cell = &self.ranges[strip_rank([x, y, last], self.count)];
                (i.max(j)..3).for_each(|n| ranges[n] = united::<D>(&ranges[n], cell));
            }
        }
        ranges
    }

    /// A cell coordinate, closed across a periodic boundary; `None` beyond an open one.
    #[inline]
    fn inside(&self, axis: usize, at: usize) -> Option<usize> {
        if at < self.count[axis] { Some(at) } else { self.periodic[axis].then_some(at % self.count[axis]) }
    }
}

/// Bounds of the cells along an axis: the box, or the particles where the axis is open [m].
fn bounds<D: Dimension>(position: &D::AxisColumns, domain: &Domain<D>, axis: usize) -> (f64, f64) {
    if axis >= D::COUNT || position[0].is_empty() {
        return (0.0, 0.0);
    }
    if domain.periodic[axis] {
        return (domain.lower[axis], domain.upper[axis]);
    }
    let [low, high] = cell_grid::bounds(&position[axis]);
    (low, high)
}

/// Number of cells at least `width` [m] wide along each axis.
fn cells(bounds: &[(f64, f64); 3], width: f64) -> [usize; 3] {
    std::array::from_fn(|a| (((bounds[a].1 - bounds[a].0) / width).min(1e9) as usize).max(1))
}

/// The range of no particle.
fn nowhere<D: Dimension>() -> Range<D> {
    (Components::splat(f64::INFINITY), Components::splat(f64::INFINITY))
}

#[inline(always)]
fn united<D: Dimension>(a: &Range<D>, b: &Range<D>) -> Range<D> {
    let mut range = *a;
    for k in 0..D::COUNT {
        range.0[k] = if b.0[k] < range.0[k] { b.0[k] } else { range.0[k] };
        range.1[k] = if b.1[k] < range.1[k] { b.1[k] } else { range.1[k] };
    }
    range
}

/// Range of the displacements of some particles.
#[inline]
fn range_of<D: Dimension>(members: &[u32], then: &[Vec<f64>], now: &D::AxisColumns) -> Range<D> {
    let mut range = nowhere::<D>();
    for &i in members {
        for a in 0..D::COUNT {
            let moved = now[a][i as usize] - then[a][i as usize];
            // A comparison in place of `min`: one instruction.
            range.0[a] = if moved < range.0[a] { moved } else { range.0[a] };
            range.1[a] = if -moved < range.1[a] { -moved } else { range.1[a] };
        }
    }
    range
}

/// A length over what is allowed.
fn share(length: f64, allowed: f64) -> f64 {
    if length > 0.0 { length / allowed } else { 0.0 }
}

/// Square of the length of a range [m²], zero without particles.
#[inline(always)]
fn length_squared<D: Dimension>(range: &Range<D>) -> f64 {
    let extent = D::vector(|a| (-range.1[a] - range.0[a]).max(0.0));
    extent.dot(extent)
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::dimension::Dim2;

    /// A particle that has flown off without end must not keep the search for wider cells going.
    #[test]
    fn a_particle_without_a_place_ends_the_search_for_wider_cells() {
        let domain = Domain::<Dim2>::new(DVec2::ZERO, DVec2::ONE, [false; 2]);
        let position = [vec![0.1, f64::INFINITY, 0.3], vec![0.1, 0.2, 0.3]];
        let mut motion = Motion::<Dim2>::default();
        motion.restart(&position, &domain, (0.1, 0.01), &mut Vec::new());
        assert_eq!(motion.count, [1; 3]);
    }
}
