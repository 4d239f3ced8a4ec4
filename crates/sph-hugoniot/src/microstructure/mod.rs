//! One periodic sample of the medium: particles that fill a cell, voids cut out, materials dealt out.
//!
//! A cell of length and height L × H holds N points of a lattice, each of the volume L H/N. The [`layout`] says what is
//! where; the voids' points are removed, the others become particles of their material, with its density and the volume of their
//! point.
//!
//! **Porosity is met by adjusting the cut.** With m the porosity asked for, N (1 - 1/m) points are to be removed: those of
//! the least distance to the voids, so that all boundaries move alike. m, and with it the mean density, is then the same
//! at every particle size, to a particle or two. Pores on a lattice keep their symmetry: whole shells of equal distance
//! from the centers are removed at every pore alike (`cut`), as long as they miss m by less than 0.3 %; else pairs of
//! single points are taken or given back, and pores stay alike. The parts of materials
//! are met in the same way.
//!
//! With one material every particle has the mass ρ0 L H/N; porosity is m = ρ0/ρ00 = (all volume)/(solid volume).

mod cut;
pub mod image;
mod lattice;
pub mod layout;
pub(crate) mod measure;
pub(crate) mod picture;
pub mod placement;
pub(crate) mod relax;
pub mod shape;
pub mod spheres;

use glam::DVec2;
use sph_core::{Dim2, Particle};

pub(crate) use lattice::pore_centers;

use crate::config::Case;
use crate::config::case::{Medium, Packing};
use layout::Fill;
use relax::Uniformity;

/// One period of the medium.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Particles sorted by x, then y; at rest, unstressed.
    pub particles: Vec<Particle<Dim2>>,
    /// Length of the cell along x, the way of the wave [m].
    pub cell: f64,
    /// Height of the cell [m].
    pub height: f64,
    /// Density ρ0 of the solid part, the mean of all materials [kg/m³].
    pub density: f64,
    /// Porosity that whole particles reach, m = ρ0/ρ00 [-].
    pub porosity: f64,
    /// Of the farthest point removed and of the nearest point kept [m]: distance from a pore's center for pores on a
    /// lattice, else from the voids' boundary.
    pub cut: (f64, f64),
    /// Particles of each material of the case.
    pub counts: Vec<usize>,
    /// How well a relaxed packing fills space.
    pub uniformity: Option<Uniformity>,
}

impl Sample {
    /// Density ρ00 of the medium [kg/m³].
    pub fn bulk_density(&self) -> f64 {
        self.density / self.porosity
    }
}

/// The sample of a case.
pub fn sample(case: &Case) -> Sample {
    let densities: Vec<f64> = case.materials().iter().map(|m| m.reference_density).collect();
    build(&case.medium, &densities)
}

/// Builds the sample of a medium from materials of these densities [kg/m³].
pub fn build(medium: &Medium, densities: &[f64]) -> Sample {
    let mut lattice = lattice::points(medium);
    let distance = distances_to_voids(medium, &lattice);
    let wanted = lattice.len() as f64 * (1.0 - 1.0 / medium.porosity);
    let removed = cut::voids(&distance, wanted, medium.particle_size);
    let fills = deal(medium, &lattice, &removed);
    let uniformity = (medium.packing == Packing::Relaxed).then(|| relax::relax(medium, &mut lattice, &fills));
    let volume = volume_of_a_point(medium, lattice.len());
    let edge = |keep: bool, start: f64, pick: fn(f64, f64) -> f64| {
        (0..lattice.len()).filter(|&i| removed[i] != keep).map(|i| distance[i]).fold(start, pick)
    };
    let particles = particles(medium, &lattice, &fills, densities);
    let counts: Vec<usize> = (0..densities.len())
        .map(|k| particles.iter().filter(|p| usize::from(p.material) == k).count())
        .collect();
    Sample {
        cell: medium.cell,
        height: medium.height,
        density: mean_density(&particles, densities, volume),
        porosity: lattice.len() as f64 / particles.len() as f64,
        cut: (edge(false, f64::NEG_INFINITY, f64::max), edge(true, f64::INFINITY, f64::min)),
        particles,
        counts,
        uniformity,
    }
}

fn volume_of_a_point(medium: &Medium, count: usize) -> f64 {
    medium.cell * medium.height / count as f64
}

/// Mean density of the solid; exactly that of the only material where there is but one.
fn mean_density(particles: &[Particle<Dim2>], densities: &[f64], volume: f64) -> f64 {
    match particles.split_first() {
        Some((first, rest)) if rest.iter().all(|p| p.material == first.material) => {
            densities[usize::from(first.material)]
        }
        _ => particles.iter().map(|p| p.mass).sum::<f64>() / (particles.len() as f64 * volume),
    }
}

/// What the cut goes by: for pores on a lattice the distance to the nearest center, else the level set of the voids.
fn distances_to_voids(medium: &Medium, points: &[DVec2]) -> Vec<f64> {
    let cell = medium.cell_size();
    let centers = pore_centers(medium.pores, cell);
    if !centers.is_empty() && !medium.has_other_voids() {
        return points.iter().map(|p| lattice::distance_to_center(*p, &centers, cell)).collect();
    }
    points.iter().map(|p| medium.layout.level(Fill::Void, *p, cell)).collect()
}

/// Deals materials out to the points that are left: each gets as many as its part of the cell says, nearest first; the
/// first material that occurs gets the rest.
fn deal(medium: &Medium, points: &[DVec2], removed: &[bool]) -> Vec<Fill> {
    let cell = medium.cell_size();
    let mut materials: Vec<u16> = medium.materials();
    materials.sort_unstable();
    let rest = Fill::Material(materials.first().copied().unwrap_or(0));
    let mut fills: Vec<Fill> = removed.iter().map(|&gone| if gone { Fill::Void } else { rest }).collect();
    for &material in materials.iter().skip(1) {
        let fill = Fill::Material(material);
        let free = |i: usize| fills[i] == rest;
        let level =
            |i: usize| if free(i) { medium.layout.level(fill, points[i], cell) } else { f64::INFINITY };
        let levels: Vec<f64> = (0..points.len()).map(level).collect();
        let wanted = medium.layout.share(fill, cell) * points.len() as f64;
        let taken = cut::nearest_points(&levels, wanted, medium.particle_size);
        (0..points.len()).filter(|&i| taken[i]).for_each(|i| fills[i] = fill);
    }
    fills
}

/// Particles of all points that are not void, sorted by x, then y.
fn particles(medium: &Medium, points: &[DVec2], fills: &[Fill], densities: &[f64]) -> Vec<Particle<Dim2>> {
    let mut solid: Vec<(DVec2, u16)> = Vec::with_capacity(points.len());
    for (&point, fill) in points.iter().zip(fills) {
        if let Fill::Material(material) = fill {
            solid.push((point, *material));
        }
    }
    solid.sort_by(|(a, _), (b, _)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let size = volume_of_a_point(medium, points.len()).sqrt();
    let particle = |(id, &(point, material)): (usize, &(DVec2, u16))| {
        let density = densities[usize::from(material)];
        let mass = density * medium.cell * medium.height / points.len() as f64;
        Particle { material, ..Particle::at_rest(id as u64, point, mass, size, density) }
    };
    solid.iter().enumerate().map(particle).collect()
}

#[cfg(test)]
mod tests;
