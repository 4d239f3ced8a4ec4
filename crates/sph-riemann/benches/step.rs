//! Whole steps, lists amortized: particle-steps per second of a full lattice and of porous copper; and each stage by itself.
//!
//! `cargo bench -p sph-riemann` prints a throughput in elements (particle-steps) per second. Cases: θ = 0.5 (the shipped
//! case), 0.55 and 0.6; one thread and two; 10⁴ to 10⁶ particles; space.

mod common;

use std::time::{Duration, Instant};

use common::{advance, lattice};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use sph_core::{Dim2, Dim3};
use sph_riemann::{Scheme, Settings, SolidDimension, StepStage};

/// Time of `steps` steps, each set of thirty from the same start: lists are rebuilt as a run rebuilds them.
fn time_steps<D: SolidDimension>(cells: usize, porous: bool, settings: Settings, steps: u64) -> Duration {
    let mut elapsed = Duration::ZERO;
    let mut left = steps;
    while left > 0 {
        let mut simulation = lattice::<D>(cells, porous, settings);
        let batch = left.min(30);
        let start = Instant::now();
        advance(&mut simulation, batch);
        elapsed += start.elapsed();
        left -= batch;
    }
    elapsed
}

struct Case {
    name: &'static str,
    cells: usize,
    porous: bool,
    theta: f64,
    scheme: Scheme,
    threads: usize,
}

fn plane(criterion: &mut Criterion) {
    let case = |name, cells, porous, theta| Case {
        name,
        cells,
        porous,
        theta,
        scheme: Scheme::TkcHancock,
        threads: 1,
    };
    let cases = [
        case("porous, theta 0.50", 360, true, 0.5),
        case("lattice, theta 0.50", 316, false, 0.5),
        case("lattice, theta 0.55", 316, false, 0.55),
        case("lattice, theta 0.60", 316, false, 0.6),
        case("porous, 1e4", 120, true, 0.5),
        case("porous, 1e6", 1160, true, 0.5),
        Case { scheme: Scheme::Csph, ..case("CSPH, porous", 360, true, 0.5) },
        Case { threads: 2, ..case("two threads, porous", 360, true, 0.5) },
        Case { threads: 2, ..case("two threads, porous, 1e4", 120, true, 0.5) },
    ];
    for case in cases {
        bench::<Dim2>(criterion, "step in the plane", &case);
    }
}

fn space(criterion: &mut Criterion) {
    let case = Case {
        name: "lattice, theta 0.60, 57 neighbors",
        cells: 40,
        porous: false,
        theta: 0.6,
        scheme: Scheme::TkcHancock,
        threads: 1,
    };
    bench::<Dim3>(criterion, "step in space", &case);
}

/// Time of one stage in `steps` steps.
fn time_stage<D: SolidDimension>(stage: StepStage, cells: usize, settings: Settings, steps: u64) -> Duration {
    let mut simulation = lattice::<D>(cells, D::COUNT == 2, settings);
    let before = simulation.stage_times().seconds(stage);
    advance(&mut simulation, steps);
    Duration::from_secs_f64(simulation.stage_times().seconds(stage) - before)
}

/// Each stage of a step by itself, as the steps of a run take it: the neighbor lists amortized.
fn stages<D: SolidDimension>(criterion: &mut Criterion, sizes: &[usize], theta: f64) {
    let settings = Settings { smoothing: theta, ..Settings::default() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("threads");
    for &cells in sizes {
        let particles = lattice::<D>(cells, D::COUNT == 2, settings).particles().len();
        let mut group = criterion.benchmark_group(format!("stages {}-D", D::COUNT));
        group.sample_size(10).throughput(Throughput::Elements(particles as u64));
        group.measurement_time(Duration::from_secs(2)).warm_up_time(Duration::from_millis(200));
        for stage in StepStage::ALL {
            group.bench_function(BenchmarkId::new(stage.name(), particles), |bencher| {
                bencher.iter_custom(|steps| {
                    pool.install(|| time_stage::<D>(stage, cells, settings, steps.max(20)))
                        .mul_f64(steps as f64 / steps.max(20) as f64)
                });
            });
        }
        group.finish();
    }
}

fn stages_in_the_plane(criterion: &mut Criterion) {
    stages::<Dim2>(criterion, &[120, 360, 1160], 0.5);
}

fn stages_in_space(criterion: &mut Criterion) {
    stages::<Dim3>(criterion, &[22, 46, 100], 0.6);
}

fn bench<D: SolidDimension>(criterion: &mut Criterion, group: &str, case: &Case) {
    let settings = Settings { smoothing: case.theta, ..Settings::for_scheme(case.scheme) };
    let particles = lattice::<D>(case.cells, case.porous, settings).particles().len();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(case.threads).build().expect("threads");
    let mut group = criterion.benchmark_group(group);
    group.sample_size(10).throughput(Throughput::Elements(particles as u64));
    group.measurement_time(Duration::from_secs(4)).warm_up_time(Duration::from_millis(500));
    group.bench_function(BenchmarkId::new(case.name, particles), |bencher| {
        bencher
            .iter_custom(|steps| pool.install(|| time_steps::<D>(case.cells, case.porous, settings, steps)));
    });
    group.finish();
}

criterion_group!(benches, plane, space, stages_in_the_plane, stages_in_space);
criterion_main!(benches);
