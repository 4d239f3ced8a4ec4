//! A relaxed packing: particles that follow the boundaries of pores and materials, isotropic, no lattice.
//!
//! All points of the cell, those of the voids too, start from the lattice, jittered, and are pushed apart,
//!
//! ```text
//! x_i ← x_i - b D² Σ_j V ∇W(r_ij; h),   h = 1.2 D,   Wendland C2
//! ```
//!
//! each confined to its own filling: where its level set φ (negative inside), moved so that the filling has the area of
//! its points, rises above -D/2, it is put back along the normal. The number of points of each filling, and with it mass
//! and porosity, does not change. Voids' points are dropped in the end; they held the solid's surface in place meanwhile.
//!
//! Relaxed packings are hexagonal in patches, with defects between them. The scheme's sums are exact on lattices only: see
//! the guide for what a run makes of them.

use glam::DVec2;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use sph_core::kernel::KernelFamily;
use sph_core::neighbors::Halo;
use sph_core::neighbors::cell_grid::CellSortedPoints;
use sph_core::{Dim2, Domain};

use super::layout::{Fill, Layout};
use crate::config::case::Medium;

/// Steps of the relaxation.
const STEPS: usize = 400;
/// h/D of the push.
const WIDTH: f64 = 1.2;
/// b.
const RATE: f64 = 0.3;
/// Longest way in a step [D].
const LONGEST: f64 = 0.1;
/// Way of the jitter at the start [D].
const JITTER: f64 = 0.2;
/// h/D of the volume sum that tells how well space is filled: that of volume consistency.
const SUM_WIDTH: f64 = 2.0;

/// How well a relaxed packing fills space.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Uniformity {
    /// Relative standard deviation of the volume sum Σ V W(r; 2 D) over all points, after the jitter [-].
    pub jittered: f64,
    /// The same after the relaxation [-].
    pub relaxed: f64,
    /// Root mean square distance of the layer next to a void from where it should stand, D/2 from the boundary, before
    /// and after [D]; zero without voids.
    pub surface: (f64, f64),
}

/// Relaxes the points of a medium; each keeps its filling.
pub(super) fn relax(medium: &Medium, points: &mut [DVec2], fills: &[Fill]) -> Uniformity {
    let cloud = Cloud::new(medium, points.len());
    let walls = Walls::new(medium, fills);
    let before = walls.roughness(points, fills, cloud.size);
    let mut random = Pcg64::seed_from_u64(1);
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
    for point in points.iter_mut() {
        *point += DVec2::new(uniform(), uniform()) * (2.0 * JITTER * cloud.size);
    }
    let jittered = cloud.deviation(points);
    for _ in 0..STEPS {
        let pushes = cloud.pushes(points);
        for (i, push) in pushes.into_iter().enumerate() {
            let moved = points[i] + (push * RATE).clamp_length_max(LONGEST) * cloud.size;
            points[i] = cloud.wrapped(walls.confined(moved, fills[i], cloud.size));
        }
    }
    Uniformity {
        jittered,
        relaxed: cloud.deviation(points),
        surface: (before, walls.roughness(points, fills, cloud.size)),
    }
}

/// The periodic cell and the size of its points.
struct Cloud {
    cell: DVec2,
    /// D [m].
    size: f64,
}

impl Cloud {
    fn new(medium: &Medium, count: usize) -> Self {
        let cell = medium.cell_size();
        Self { cell, size: (cell.x * cell.y / count as f64).sqrt() }
    }

    fn wrapped(&self, point: DVec2) -> DVec2 {
        let wrap = |x: f64, period: f64| {
            let inside = x - period * (x / period).floor();
            if inside < period { inside } else { 0.0 }
        };
        DVec2::new(wrap(point.x, self.cell.x), wrap(point.y, self.cell.y))
    }

    /// Sums over the neighbors of each point: `term(r/D vector)`.
    fn sums<T: Copy + std::ops::AddAssign>(
        &self,
        points: &[DVec2],
        reach: f64,
        zero: T,
        term: impl Fn(DVec2) -> T,
    ) -> Vec<T> {
        let domain = Domain::<Dim2>::new(DVec2::ZERO, self.cell, [true, true]);
        let wrapped: Vec<DVec2> = points.iter().map(|&p| self.wrapped(p)).collect();
        let position: [Vec<f64>; 2] =
            [wrapped.iter().map(|p| p.x).collect(), wrapped.iter().map(|p| p.y).collect()];
        let reach = reach * self.size;
        let halo = Halo::<Dim2>::build(&position, &domain, reach);
        let sorted = CellSortedPoints::<Dim2>::new(&position, &halo, 0.5 * reach);
        let sum = |point: &DVec2| {
            let mut sum = zero;
            sorted.runs_near(*point, reach, |first, end| {
                for k in first..end {
                    let offset = DVec2::new(sorted.position[0][k], sorted.position[1][k]) - *point;
                    sum += term(offset / self.size);
                }
            });
            sum
        };
        wrapped.iter().map(sum).collect()
    }

    /// -D Σ_j V ∇W, the push that each point feels [-].
    fn pushes(&self, points: &[DVec2]) -> Vec<DVec2> {
        let kernel = KernelFamily::WendlandC2;
        let push = |offset| -kernel.gradient::<Dim2>(offset, WIDTH);
        self.sums(points, kernel.support() * WIDTH, DVec2::ZERO, push)
    }

    /// Relative standard deviation of the volume sum.
    fn deviation(&self, points: &[DVec2]) -> f64 {
        let kernel = KernelFamily::WendlandC2;
        let weight = |offset: DVec2| kernel.weight::<Dim2>(offset.length(), SUM_WIDTH);
        let sums = self.sums(points, kernel.support() * SUM_WIDTH, 0.0, weight);
        let mean = sums.iter().sum::<f64>() / sums.len() as f64;
        let square = sums.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / sums.len() as f64;
        square.sqrt() / mean
    }
}

/// Level sets of all fillings, tabulated, each moved so that it has the area of its points.
struct Walls {
    tables: Vec<(Fill, Table)>,
}

impl Walls {
    fn new(medium: &Medium, fills: &[Fill]) -> Self {
        let mut kinds: Vec<Fill> = Vec::new();
        fills.iter().for_each(|f| {
            if !kinds.contains(f) {
                kinds.push(*f);
            }
        });
        let table = |kind: Fill| {
            let share = fills.iter().filter(|f| **f == kind).count() as f64 / fills.len() as f64;
            Table::new(&medium.layout, kind, medium.cell_size(), 0.25 * medium.particle_size, share)
        };
        Self { tables: kinds.iter().map(|&kind| (kind, table(kind))).collect() }
    }

    fn table(&self, fill: Fill) -> Option<&Table> {
        self.tables.iter().find(|t| t.0 == fill).map(|t| &t.1)
    }

    /// The point, or the nearest place inside of its filling, half a particle from the boundary.
    fn confined(&self, point: DVec2, fill: Fill, size: f64) -> DVec2 {
        let Some(table) = self.table(fill) else { return point };
        let mut point = point;
        for _ in 0..3 {
            let excess = table.value(point) + 0.5 * size;
            if !excess.is_finite() || excess <= 0.0 {
                break;
            }
            let normal = table.normal(point);
            point -= normal * excess.min(0.5 * size);
        }
        point
    }

    /// Root mean square distance of the solid's layer at the voids from D/2 off the boundary [D].
    fn roughness(&self, points: &[DVec2], fills: &[Fill], size: f64) -> f64 {
        let Some(table) = self.table(Fill::Void) else { return 0.0 };
        let solid = points.iter().zip(fills).filter(|(_, fill)| **fill != Fill::Void);
        let away = solid.map(|(p, _)| table.value(*p) / size - 0.5).filter(|d| *d < 0.5);
        let (count, sum) = away.fold((0, 0.0), |(n, sum), d| (n + 1, sum + d * d));
        if count == 0 { 0.0 } else { (sum / f64::from(count)).sqrt() }
    }
}

/// A level set on a grid.
struct Table {
    cell: DVec2,
    columns: usize,
    rows: usize,
    values: Vec<f64>,
}

impl Table {
    fn new(layout: &Layout, fill: Fill, cell: DVec2, step: f64, share: f64) -> Self {
        let (columns, rows) = ((cell.x / step).ceil() as usize, (cell.y / step).ceil() as usize);
        let edge = DVec2::new(cell.x / columns as f64, cell.y / rows as f64);
        let at = |k: usize| DVec2::new((k % columns) as f64, (k / columns) as f64) * edge;
        let mut values: Vec<f64> = (0..columns * rows).map(|k| layout.level(fill, at(k), cell)).collect();
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let offset = sorted[((share * values.len() as f64) as usize).min(values.len() - 1)];
        if offset.is_finite() {
            values.iter_mut().for_each(|v| *v -= offset);
        }
        Self { cell, columns, rows, values }
    }

    fn value(&self, point: DVec2) -> f64 {
        let u = point.x / self.cell.x * self.columns as f64;
        let v = point.y / self.cell.y * self.rows as f64;
        let (column, row) = (u.floor(), v.floor());
        let (a, b) = (u - column, v - row);
        let at = |dx: i64, dy: i64| {
            let i = (column as i64 + dx).rem_euclid(self.columns as i64) as usize;
            let k = (row as i64 + dy).rem_euclid(self.rows as i64) as usize;
            self.values[k * self.columns + i]
        };
        (at(0, 0) * (1.0 - a) + at(1, 0) * a) * (1.0 - b) + (at(0, 1) * (1.0 - a) + at(1, 1) * a) * b
    }

    /// Outward unit normal of the level set; zero where it is flat.
    fn normal(&self, point: DVec2) -> DVec2 {
        let step = self.cell.x / self.columns as f64;
        let along = |d: DVec2| self.value(point + d * step) - self.value(point - d * step);
        DVec2::new(along(DVec2::X), along(DVec2::Y)).normalize_or_zero()
    }
}
