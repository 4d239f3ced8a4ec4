//! Whole steps, lists amortized: particle-steps per second of a full lattice and of porous copper.
//!
//! `cargo bench -p sph-riemann` prints a throughput in elements (particle-steps) per second. Cases: θ = 0.5 (the shipped
//! case), 0.55 and 0.6; one thread and two; 10⁴ to 10⁶ particles; space.

use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use sph_core::{Components, Dim2, Dim3, Domain, Particle, Particles};
use sph_riemann::{Scheme, Settings, Simulation, SolidDimension};

const SIZE: f64 = 1e-6;

/// A periodic lattice of `cells` particles along each axis in a smooth flow; with two pores in each square of 20, if
/// asked for.
fn lattice<D: SolidDimension>(cells: usize, porous: bool, settings: Settings) -> Simulation<D> {
    let copper = sph_materials::library::material("porous-copper").expect("a library material");
    let length = cells as f64 * SIZE;
    let mut particles = Particles::<D>::default();
    for cell in 0..cells.pow(D::COUNT as u32) {
        let index = |a: usize| cell / cells.pow(a as u32) % cells;
        let position = D::vector(|a| (index(a) as f64 + 0.5) * SIZE);
        let in_pore = |shift: f64| {
            let to_center = |a: usize| (position[a] / SIZE - shift).rem_euclid(20.0) - 10.0;
            to_center(0).hypot(to_center(1)) < 4.06
        };
        if porous && (in_pore(0.0) || in_pore(10.0)) {
            continue;
        }
        let mass = 8960.0 * SIZE.powi(D::COUNT as i32);
        let mut particle = Particle::at_rest(cell as u64, position, mass, SIZE, 8960.0);
        let wave = |a: usize| (2.0 * std::f64::consts::PI * position[a] / (40.0 * SIZE)).sin();
        particle.velocity = D::vector(|a| 60.0 * wave(a) - 400.0);
        particles.push(particle);
    }
    let domain = Domain::new(D::vector(|_| 0.0), D::vector(|_| length), Components::from_fn(|_| true));
    let mut simulation = Simulation::new(domain, vec![copper], particles, settings).expect("a sound set-up");
    advance(&mut simulation, 10);
    simulation
}

fn advance<D: SolidDimension>(simulation: &mut Simulation<D>, steps: u64) {
    for _ in 0..steps {
        simulation.step().expect("a sound step");
    }
}

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
        name: "lattice, theta 0.60, 57 neighbours",
        cells: 40,
        porous: false,
        theta: 0.6,
        scheme: Scheme::TkcHancock,
        threads: 1,
    };
    bench::<Dim3>(criterion, "step in space", &case);
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

criterion_group!(benches, plane, space);
criterion_main!(benches);
