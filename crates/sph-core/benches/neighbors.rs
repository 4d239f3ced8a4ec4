//! Finding neighbors: `cargo bench -p sph-core --bench neighbors`.
//!
//! Lists of a jittered lattice with the paper's θ = 0.55 (support 1.1 (D_i + D_j)) and a skin of 0.2 D, built for
//! particles in cell order, and the check whether they still hold; beside it the kd-tree on a smaller cloud.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{box_of, jitter, plain_lattice};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use sph_core::neighbors::cell_grid::sort_particles;
use sph_core::neighbors::{NeighborLists, Reach, kd_tree};
use sph_core::{Dim2, Dim3, Dimension, Domain, Particle, Particles};

/// The allocator of the programs.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const REACH: Reach = Reach { factor: 1.1, skin: 0.2 };

/// `edge` particles of size 1 along each axis, in cell order, in a box that is periodic in y.
fn particles<D: Dimension>(edge: usize) -> (Particles<D>, Domain<D>) {
    let domain = box_of::<D>(|_| edge as f64, |a| a == 1);
    let mut packing = plain_lattice::<D>().fill_box::<D>(domain.lower, domain.upper, 1.0).unwrap();
    jitter(&mut packing, 0.1, 1);
    let mut particles = Particles::default();
    for (id, position) in packing.points().enumerate() {
        particles.push(Particle::at_rest(id as u64, position, 1.0, 1.0, 1.0));
    }
    sort_particles(&mut particles, &domain, 2.4);
    (particles, domain)
}

fn bench_dimension<D: Dimension>(criterion: &mut Criterion, edge: usize, tree_edge: usize) {
    let mut group = criterion.benchmark_group(format!("neighbors {}-D", D::COUNT));
    group.sample_size(10);
    let (p, domain) = particles::<D>(edge);
    group.throughput(Throughput::Elements(p.len() as u64));
    let build = || NeighborLists::<D>::build(&p.position, &p.size, &domain, REACH);
    group.bench_function(BenchmarkId::new("cell lists", p.len()), |b| b.iter(build));
    let mut lists = build();
    group.bench_function(BenchmarkId::new("outlived", p.len()), |b| b.iter(|| lists.outlived(&p.position)));

    let (p, domain) = particles::<D>(tree_edge);
    group.throughput(Throughput::Elements(p.len() as u64));
    let cut = |a: f64, b: f64| REACH.factor * (a + b) + REACH.skin;
    let search = || kd_tree::pairs(&p.position, &p.size, &domain, cut).unwrap();
    group.bench_function(BenchmarkId::new("kd-tree", p.len()), |b| b.iter(search));
    group.finish();
}

fn both_dimensions(criterion: &mut Criterion) {
    bench_dimension::<Dim2>(criterion, 316, 100);
    bench_dimension::<Dim3>(criterion, 46, 20);
}

criterion_group!(benches, both_dimensions);
criterion_main!(benches);
