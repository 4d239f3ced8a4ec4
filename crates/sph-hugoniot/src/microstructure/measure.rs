//! What a sample resolves: its narrowest gap between pores and its smallest pore, and what is to be warned of.
//!
//! Circles and ellipses that do not overlap are measured exactly. Any other void is measured on a grid over two by two
//! cells: connected regions of void are pores; a pore's size is twice the depth of its deepest point, a gap the least
//! distance between two of them.

use glam::DVec2;
use serde::Serialize;

use super::Sample;
use super::layout::{Base, Fill, Layout};
use super::shape::Shape;
use crate::config::case::Medium;
use crate::config::units::{LengthKind, show};

/// A gap or a pore below this many particle sizes is not resolved [D].
pub const RESOLVED: f64 = 4.0;

/// Points of the grid along the longer edge of a cell, at most.
const GRID: f64 = 400.0;

/// What a sample resolves, in particle sizes D.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Features {
    /// Number of pores in a cell.
    pub pores: usize,
    /// Narrowest gap between pores [D]; `None` with fewer than two, or if it is one connected void.
    pub smallest_gap: Option<f64>,
    /// Width of the smallest pore [D].
    pub smallest_pore: Option<f64>,
}

/// Measures the voids of a medium.
pub fn features(medium: &Medium) -> Features {
    let (cell, size) = (medium.cell_size(), medium.particle_size);
    let round = round_pores(&medium.layout).map(|pores| exactly(&pores, cell)).filter(|found| found.1 >= 0.0);
    let found = round.unwrap_or_else(|| on_a_grid(medium));
    let in_sizes = |length: f64| length.is_finite().then_some(length / size);
    Features { pores: found.0, smallest_gap: in_sizes(found.1), smallest_pore: in_sizes(found.2) }
}

/// What is to be warned of.
pub fn warnings(medium: &Medium, sample: &Sample, features: &Features) -> Vec<String> {
    let mut list = Vec::new();
    let mut narrow = |what: &str, width: Option<f64>| {
        if let Some(width) = width.filter(|&w| w < RESOLVED) {
            list.push(format!(
                "the {what} is {width:.1} D wide: below {RESOLVED} D it is not resolved; a finer D"
            ));
        }
    };
    narrow("smallest gap between pores", features.smallest_gap);
    narrow("smallest pore", features.smallest_pore);
    list.extend(overlaps(medium));
    list.extend(levels_without_pixels(medium));
    let missed = sample.porosity - medium.porosity;
    if missed.abs() > 0.01 * medium.porosity {
        list.push(format!(
            "porosity {:.4} in place of {:.4}: whole particles miss it by {:.1} %; a finer D",
            sample.porosity,
            medium.porosity,
            100.0 * missed / medium.porosity
        ));
    }
    let particles = sample.particles.len();
    list.extend(
        sample
            .counts
            .iter()
            .enumerate()
            .filter(|(k, n)| **n == 0 && *k > 0)
            .map(|(k, _)| format!("material {} of the case has none of the {particles} particles", k + 1)),
    );
    list
}

/// Round pores that overlap are one void: that may be meant, or a slip.
fn overlaps(medium: &Medium) -> Option<String> {
    let (pores, cell) = (round_pores(&medium.layout)?, medium.cell_size());
    let pairs = (0..pores.len()).flat_map(|k| (0..k).map(move |i| (i, k)));
    let (a, b) = pairs.clone().find(|&(i, k)| pores[i].gap(&pores[k], cell) < 0.0)?;
    let count = pairs.filter(|&(i, k)| pores[i].gap(&pores[k], cell) < 0.0).count();
    let at = |k: usize| {
        let center = pores[k].bounds().0;
        format!("({}, {})", show::<LengthKind>(center.x), show::<LengthKind>(center.y))
    };
    Some(format!(
        "{count} pair(s) of pores overlap and are one void each, the first at {} and {}; move them apart if that is not meant",
        at(a),
        at(b)
    ))
}

/// What gray levels stand for that no pixel of the picture has.
fn levels_without_pixels(medium: &Medium) -> Option<String> {
    let Base::Image(image) = &medium.layout.base else { return None };
    let found = image.fills();
    let (from, range) = image.ranges.iter().enumerate().find(|(_, range)| !found.contains(&range.1))?;
    let lowest = from.checked_sub(1).map_or(0.0, |before| image.ranges[before].0 + 1.0);
    Some(format!(
        "no pixel of {} has a gray level from {lowest} to {}, which stands for {:?}; change `levels` if that is not meant",
        image.file, range.0, range.1
    ))
}

/// The pores if all voids are circles or ellipses in solid, over which nothing is painted.
fn round_pores(layout: &Layout) -> Option<Vec<Shape>> {
    let solid = matches!(layout.base, Base::Uniform(Fill::Material(_)));
    let first = layout.painted.iter().position(|p| p.fill == Fill::Void).unwrap_or(layout.painted.len());
    let pores: Vec<Shape> = layout.painted[first..].iter().map(|p| p.shape.clone()).collect();
    let round = |s: &Shape| matches!(s, Shape::Circle { .. } | Shape::Ellipse { .. });
    let void = layout.painted[first..].iter().all(|p| p.fill == Fill::Void && round(&p.shape));
    (solid && void).then_some(pores)
}

/// Number, narrowest gap and smallest width; infinite where there is none.
fn exactly(pores: &[Shape], cell: DVec2) -> (usize, f64, f64) {
    let mut gap = f64::INFINITY;
    for (k, a) in pores.iter().enumerate() {
        for b in &pores[..k] {
            gap = gap.min(a.gap(b, cell));
        }
        // To its own images: along each axis at least the cell less its extent.
        let own = cell - 2.0 * a.bounds().1;
        gap = gap.min(own.min_element());
    }
    (pores.len(), gap, pores.iter().map(Shape::width).fold(f64::INFINITY, f64::min))
}

/// The same on a grid over two by two cells.
fn on_a_grid(medium: &Medium) -> (usize, f64, f64) {
    let cell = medium.cell_size();
    let step = (0.25 * medium.particle_size).max(cell.max_element() / GRID);
    let (columns, rows) = ((cell.x / step).ceil() as usize, (cell.y / step).ceil() as usize);
    let edge = DVec2::new(cell.x / columns as f64, cell.y / rows as f64);
    let at = |k: usize| (DVec2::new((k % columns) as f64, (k / columns) as f64) + 0.5) * edge;
    let one: Vec<f64> = (0..columns * rows).map(|k| medium.layout.level(Fill::Void, at(k), cell)).collect();
    let grid = Grid { columns: 2 * columns, rows: 2 * rows };
    let level = |k: usize| one[(k / grid.columns % rows) * columns + k % grid.columns % columns];
    let mut owner = grid.components(&level);
    let count = owner.iter().copied().max().unwrap_or(0);
    let mut depth = vec![0.0_f64; count];
    for k in (0..owner.len()).filter(|&k| owner[k] > 0) {
        depth[owner[k] - 1] = depth[owner[k] - 1].max(-level(k));
    }
    grid.spread(&mut owner);
    let mut gap = f64::INFINITY;
    for k in 0..owner.len() {
        for neighbor in grid.neighbors(k) {
            if owner[k] != owner[neighbor] {
                gap = gap.min(level(k).max(0.0) + level(neighbor).max(0.0) + edge.max_element());
            }
        }
    }
    (count.div_ceil(4), gap, depth.iter().map(|d| 2.0 * d).fold(f64::INFINITY, f64::min))
}

/// A periodic grid of squares.
struct Grid {
    columns: usize,
    rows: usize,
}

impl Grid {
    fn neighbors(&self, k: usize) -> [usize; 4] {
        let (column, row) = (k % self.columns, k / self.columns);
        let (right, left) = ((column + 1) % self.columns, (column + self.columns - 1) % self.columns);
        let (above, below) = ((row + 1) % self.rows, (row + self.rows - 1) % self.rows);
        [
            row * self.columns + right,
            row * self.columns + left,
            above * self.columns + column,
            below * self.columns + column,
        ]
    }

    /// Numbers from 1 for each connected region of void, 0 in the solid.
    fn components(&self, level: &dyn Fn(usize) -> f64) -> Vec<usize> {
        let mut owner = vec![0; self.columns * self.rows];
        let mut count = 0;
        for start in 0..owner.len() {
            if owner[start] != 0 || level(start) >= 0.0 {
                continue;
            }
            count += 1;
            owner[start] = count;
            let mut open = vec![start];
            while let Some(k) = open.pop() {
                for neighbor in self.neighbors(k) {
                    if owner[neighbor] == 0 && level(neighbor) < 0.0 {
                        owner[neighbor] = count;
                        open.push(neighbor);
                    }
                }
            }
        }
        owner
    }

    /// Gives each square of the solid to the region that it is reached from first.
    fn spread(&self, owner: &mut [usize]) {
        let mut front: Vec<usize> = (0..owner.len()).filter(|&k| owner[k] > 0).collect();
        while !front.is_empty() {
            let mut next = Vec::new();
            for k in front {
                for neighbor in self.neighbors(k) {
                    if owner[neighbor] == 0 {
                        owner[neighbor] = owner[k];
                        next.push(neighbor);
                    }
                }
            }
            front = next;
        }
    }
}
