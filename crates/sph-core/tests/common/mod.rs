//! Disordered clouds for the property tests and the benches.

// Each test binary uses a part of this.
#![allow(dead_code)]

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use sph_core::correction::Neighbor;
use sph_core::geometry::{Lattice, Packing};
use sph_core::neighbors::kd_tree;
use sph_core::{Dimension, Domain, KernelFamily};

/// Random numbers of a seed, the same everywhere.
pub fn random(seed: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed)
}

/// The lattice along the axes.
pub fn plain_lattice<D: Dimension>() -> Lattice {
    if D::COUNT == 2 { Lattice::Square } else { Lattice::Cubic }
}

/// A box from zero to `edge` on each axis.
pub fn box_of<D: Dimension>(edge: impl Fn(usize) -> f64, periodic: impl Fn(usize) -> bool) -> Domain<D> {
    Domain::new(D::vector(|_| 0.0), D::vector(edge), sph_core::Components::from_fn(periodic))
}

/// Moves every point by up to `amplitude` particle sizes along each axis.
pub fn jitter<D: Dimension>(packing: &mut Packing<D>, amplitude: f64, seed: u64) {
    let mut random = random(seed);
    let reach = amplitude * packing.size;
    for a in 0..D::COUNT {
        packing.position[a].iter_mut().for_each(|x| *x += random.random_range(-reach..=reach));
    }
}

/// A cloud with unequal sizes, and the neighbors of each particle.
pub struct Cloud<D: Dimension> {
    pub packing: Packing<D>,
    pub size: Vec<f64>,
    pub neighbors: Vec<Vec<(usize, Neighbor<D>)>>,
}

impl<D: Dimension> Cloud<D> {
    /// A jittered lattice of `edge` particles along each axis in an open box, with a share `holes` of the particles
    /// missing, sizes between 0.8 and 1.2, and h_ij = θ (D_i + D_j).
    pub fn disordered(edge: usize, holes: f64, theta: f64, kernel: KernelFamily, seed: u64) -> Self {
        let upper = D::vector(|_| edge as f64);
        let mut packing = plain_lattice::<D>().fill_box::<D>(D::vector(|_| 0.0), upper, 1.0).unwrap();
        jitter(&mut packing, 0.25, seed);
        let mut random = random(seed ^ 0x5eed);
        let kept: Vec<bool> = (0..packing.len()).map(|_| random.random_range(0.0..1.0) >= holes).collect();
        let mut cloud = Packing::empty(1.0);
        for i in (0..packing.len()).filter(|&i| kept[i]) {
            cloud.push(packing.point(i), packing.volume[i]);
        }
        let size: Vec<f64> = (0..cloud.len()).map(|_| random.random_range(0.8..1.2)).collect();
        let volume: Vec<f64> = size.iter().map(|d| d.powi(D::COUNT as i32)).collect();
        cloud.volume = volume;
        let neighbors = neighbors(&cloud, &size, theta, kernel);
        Self { packing: cloud, size, neighbors }
    }
}

/// Neighbors of every particle of an open cloud.
fn neighbors<D: Dimension>(
    cloud: &Packing<D>,
    size: &[f64],
    theta: f64,
    kernel: KernelFamily,
) -> Vec<Vec<(usize, Neighbor<D>)>> {
    let support = kernel.support() * theta;
    let pairs =
        kd_tree::pairs(&cloud.position, size, &Domain::<D>::open(), |a, b| support * (a + b)).unwrap();
    let mut lists = vec![Vec::new(); size.len()];
    for (i, j) in pairs {
        let (i, j) = (i as usize, j as usize);
        let offset = cloud.point(j) - cloud.point(i);
        lists[i].push((j, Neighbor::new(kernel, offset, theta * (size[i] + size[j]), cloud.volume[j])));
    }
    lists
}
