//! One periodic sample of the medium: particles on a lattice, pores cut out.
//!
//! The cell of edge L holds N lattice points; a pore removes the points nearest to its center. The number of removed
//! points is chosen so that the porosity m = N/(N - removed) is as near as whole particles allow to the one asked for:
//! whole shells of equal distance are removed at every pore alike, so the pores are equal and have the lattice's
//! symmetry, and m is nearly the same at every D. Every particle keeps the solid's density ρ0 and the mass ρ0 L²/N.
//!
//! Lattice points lie half a spacing off the cell's edges. Pore centers lie at (L/2, L/2) for the square lattice and at
//! (L/4, L/4), (3L/4, 3L/4) for the centered one: midway between lattice points when their number allows.

use glam::DVec2;
use sph_core::{Dim2, Particle};

use crate::config::case::{Medium, Packing, Pores};

/// Two points at distances that differ by less, relative to the particle size, belong to one shell.
const SAME_SHELL: f64 = 1e-6;
/// Shells this far around the cut, in D, may be exchanged to meet the porosity.
const EXCHANGE: f64 = 0.5;

/// One period of the medium.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Particles sorted by x, then y; at rest, unstressed.
    pub particles: Vec<Particle<Dim2>>,
    /// Edge of the cell [m].
    pub cell: f64,
    /// Density ρ0 of the solid [kg/m³].
    pub density: f64,
    /// Porosity that whole particles reach, m = ρ0/ρ00 [-].
    pub porosity: f64,
    /// Distance from a pore's center of the farthest point removed and of the nearest point kept [m].
    pub cut: (f64, f64),
}

impl Sample {
    /// Density ρ00 of the medium [kg/m³].
    pub fn bulk_density(&self) -> f64 {
        self.density / self.porosity
    }
}

/// Builds the sample of `medium` from a solid of density `density` [kg/m³].
pub fn sample(medium: &Medium, density: f64) -> Sample {
    let lattice = lattice(medium);
    let centers = pore_centers(medium);
    let wanted = lattice.len() as f64 * (1.0 - 1.0 / medium.porosity);
    let distance: Vec<f64> = lattice.iter().map(|p| distance_to_pore(*p, &centers, medium.cell)).collect();
    let removed = removed_points(&distance, wanted, medium.particle_size);
    let kept = |i: &usize| !removed[*i];
    let mut points: Vec<DVec2> = (0..lattice.len()).filter(kept).map(|i| lattice[i]).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mass = density * medium.cell * medium.cell / lattice.len() as f64;
    let size = (medium.cell * medium.cell / lattice.len() as f64).sqrt();
    let edge = |keep: bool, start: f64, pick: fn(f64, f64) -> f64| {
        (0..lattice.len()).filter(|&i| removed[i] != keep).map(|i| distance[i]).fold(start, pick)
    };
    Sample {
        cell: medium.cell,
        density,
        porosity: lattice.len() as f64 / points.len() as f64,
        cut: (edge(false, 0.0, f64::max), edge(true, f64::INFINITY, f64::min)),
        particles: points
            .iter()
            .enumerate()
            .map(|(id, &p)| Particle::at_rest(id as u64, p, mass, size, density))
            .collect(),
    }
}

/// Lattice points of a full cell.
///
/// The hexagonal lattice is fitted to the cell: rows along x, the spacing a of equal area D² = a² √3/2, a whole number
/// of particles in a row and an even number of rows.
fn lattice(medium: &Medium) -> Vec<DVec2> {
    let along = (medium.cell / medium.particle_size).round();
    let (in_row, rows, shift) = match medium.packing {
        Packing::Square => (along, along, 0.0),
        Packing::Hexagonal => {
            let spacing = medium.particle_size * (2.0 / 3f64.sqrt()).sqrt();
            let rows = 2.0 * (medium.cell / (spacing * 3f64.sqrt())).round().max(1.0);
            ((medium.cell / spacing).round().max(1.0), rows, 0.5)
        }
    };
    let (dx, dy) = (medium.cell / in_row, medium.cell / rows);
    let mut points = Vec::with_capacity((in_row * rows) as usize);
    for row in 0..rows as usize {
        let offset = if row % 2 == 0 { 0.5 - 0.5 * shift } else { 0.5 + 0.5 * shift };
        for k in 0..in_row as usize {
            points.push(DVec2::new((k as f64 + offset) * dx, (row as f64 + 0.5) * dy));
        }
    }
    points
}

/// Centers of the pores of one cell.
pub fn pore_centers(medium: &Medium) -> Vec<DVec2> {
    let at = |f: f64| DVec2::splat(f * medium.cell);
    match medium.pores {
        Pores::None => vec![],
        Pores::Square => vec![at(0.5)],
        Pores::CenteredSquare => vec![at(0.25), at(0.75)],
    }
}

/// Distance to the nearest pore center, periodic images included.
fn distance_to_pore(point: DVec2, centers: &[DVec2], cell: f64) -> f64 {
    let nearest_image = |d: f64| d - cell * (d / cell).round();
    let distance = |c: &DVec2| nearest_image(point.x - c.x).hypot(nearest_image(point.y - c.y));
    centers.iter().map(distance).fold(f64::INFINITY, f64::min)
}

/// Marks the points to remove: the nearest whole shells, at best with one shell near the cut exchanged.
fn removed_points(distance: &[f64], wanted: f64, size: f64) -> Vec<bool> {
    let shells = shells(distance, size);
    let mut best: (f64, Vec<bool>) = (wanted, vec![false; shells.len()]);
    let mut consider = |taken: &[bool]| {
        let count: usize = shells.iter().zip(taken).filter(|(_, t)| **t).map(|(s, _)| s.1.len()).sum();
        let miss = (count as f64 - wanted).abs();
        if miss < best.0 - 1e-9 {
            best = (miss, taken.to_vec());
        }
    };
    let mut taken = vec![false; shells.len()];
    let mut total = 0.0;
    for last in 0..shells.len() {
        total += shells[last].1.len() as f64;
        taken[last] = true;
        consider(&taken);
        if (total - wanted).abs() > 0.1 * wanted + 50.0 {
            continue;
        }
        for other in 0..shells.len() {
            if other != last && (shells[other].0 - shells[last].0).abs() < EXCHANGE * size {
                taken[other] = !taken[other];
                consider(&taken);
                taken[other] = !taken[other];
            }
        }
    }
    let mut removed = vec![false; distance.len()];
    for (shell, _) in shells.iter().zip(&best.1).filter(|(_, t)| **t) {
        shell.1.iter().for_each(|&i| removed[i] = true);
    }
    removed
}

/// Points of equal distance, from the nearest on: (distance, indices).
fn shells(distance: &[f64], size: f64) -> Vec<(f64, Vec<usize>)> {
    let mut order: Vec<usize> = (0..distance.len()).filter(|&i| distance[i].is_finite()).collect();
    order.sort_by(|&a, &b| distance[a].total_cmp(&distance[b]).then(a.cmp(&b)));
    let mut shells: Vec<(f64, Vec<usize>)> = Vec::new();
    for i in order {
        match shells.last_mut() {
            Some(shell) if distance[i] - shell.0 < SAME_SHELL * size => shell.1.push(i),
            _ => shells.push((distance[i], vec![i])),
        }
    }
    shells
}

#[cfg(test)]
mod tests {
    use super::*;

    fn medium(pores: Pores, size: f64, packing: Packing) -> Medium {
        let (radius, porosity) = if pores == Pores::None { (0.0, 1.0) } else { (4.06e-6, 1.35) };
        Medium { cell: 20e-6, pores, radius, porosity, particle_size: size, packing }
    }

    #[test]
    fn the_published_medium_has_296_of_400_particles() {
        let sample = sample(&medium(Pores::CenteredSquare, 1e-6, Packing::Square), 8960.0);
        assert_eq!(sample.particles.len(), 296);
        assert!((sample.porosity - 400.0 / 296.0).abs() < 1e-15);
        assert!(sample.cut.0 < 4.06e-6 && 4.06e-6 < sample.cut.1, "{:?}", sample.cut);
        let mass: f64 = sample.particles.iter().map(|p| p.mass).sum();
        assert!((mass / (20e-6 * 20e-6) / sample.bulk_density() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn porosity_is_the_same_at_every_particle_size_and_packing() {
        for packing in [Packing::Square, Packing::Hexagonal] {
            for pores in [Pores::Square, Pores::CenteredSquare] {
                for (size, tolerance) in [(2e-6, 0.035), (1e-6, 0.015), (0.5e-6, 0.004), (0.25e-6, 0.001)] {
                    let m = sample(&medium(pores, size, packing), 8960.0).porosity;
                    assert!((m - 1.35).abs() < tolerance, "{packing:?} {pores:?} D = {size}: m = {m}");
                }
            }
        }
    }

    #[test]
    fn pores_are_mirror_symmetric_and_alike() {
        for size in [2e-6, 1e-6, 0.5e-6] {
            let sample = sample(&medium(Pores::CenteredSquare, size, Packing::Square), 8960.0);
            let key = |x: f64, y: f64| {
                let wrap = |v: f64| ((v.rem_euclid(20e-6) / size).floor()) as i64;
                (wrap(x), wrap(y))
            };
            let all: std::collections::HashSet<_> =
                sample.particles.iter().map(|p| key(p.position.x, p.position.y)).collect();
            for p in &sample.particles {
                let (x, y) = (p.position.x, p.position.y);
                assert!(all.contains(&key(10e-6 - x, y)), "mirror");
                assert!(all.contains(&key(y, x)), "turn by 90 degrees and mirror");
                assert!(all.contains(&key(x + 10e-6, y + 10e-6)), "second pore like the first");
            }
        }
    }

    #[test]
    fn the_solid_is_full_and_sorted() {
        for packing in [Packing::Square, Packing::Hexagonal] {
            let sample = sample(&medium(Pores::None, 1e-6, packing), 8960.0);
            assert_eq!(sample.porosity, 1.0);
            assert!(sample.particles.is_sorted_by(|a, b| a.position.x <= b.position.x));
            assert!(
                sample
                    .particles
                    .iter()
                    .all(|p| (0.0..20e-6).contains(&p.position.x) && (0.0..20e-6).contains(&p.position.y))
            );
            let mass: f64 = sample.particles.iter().map(|p| p.mass).sum();
            assert!((mass / (8960.0 * 4e-10) - 1.0).abs() < 1e-13);
        }
    }
}
