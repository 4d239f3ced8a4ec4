//! One table of what a step costs: `cargo xtask bench` runs it and adds counts of instructions.
//!
//! Prints the limits of the machine as it is now (fused multiply-adds a second and bytes a second, one thread and two), then
//! for each case particle-steps per second, nanoseconds a pair, bytes a particle, the share of each stage, and how near the
//! step comes to the limits: `arithmetic` is the number of operations of its pair loops ([`model`]) over its time and over
//! the fused multiply-add limit (a multiply-add counts two); `memory` is its bytes read and written once a step over the
//! bandwidth. The best of some runs of thirty steps counts, rebuilds of the lists included where they fall into it.
//!
//! `--quick`: fewer cases and runs. `--cases RUNS CASE...`: these cases, that many runs each. `--long RUNS CASE...`: the same
//! in runs of 120 steps, since lists with a wide skin live longer than thirty. `--least STEPS CASE...`: the least time of each
//! stage in that many single steps, in nanoseconds a particle, which says something on a busy machine too. `--count CASE
//! STEPS`: nothing but these steps of a case, for a counter of instructions.

#[path = "../common/mod.rs"]
mod common;
mod machine;
mod model;

use std::time::Instant;

use common::{advance, lattice};
use machine::Machine;
use sph_core::lanes::InstructionSet;
use sph_core::{Dim2, Dim3};
use sph_riemann::{Scheme, Settings, Simulation, SolidDimension, StageTimes, StepStage};

/// Steps of a run.
const STEPS: u64 = 30;
/// Steps of a long run: lists with a wide skin outlive a short one.
const LONG: u64 = 120;

/// What is measured.
#[derive(Clone, Copy)]
struct Case {
    name: &'static str,
    dimensions: usize,
    cells: usize,
    porous: bool,
    theta: f64,
    scheme: Scheme,
    threads: usize,
    quick: bool,
}

const fn case(name: &'static str, cells: usize, porous: bool, theta: f64) -> Case {
    Case { name, dimensions: 2, cells, porous, theta, scheme: Scheme::TkcHancock, threads: 1, quick: false }
}

const CASES: [Case; 17] = [
    Case { quick: true, ..case("porous-1e4", 120, true, 0.5) },
    Case { quick: true, ..case("porous-1e5", 360, true, 0.5) },
    case("porous-1e6", 1160, true, 0.5),
    Case { threads: 2, quick: true, ..case("porous-1e4", 120, true, 0.5) },
    Case { threads: 2, ..case("porous-1e5", 360, true, 0.5) },
    Case { threads: 2, ..case("porous-1e6", 1160, true, 0.5) },
    case("lattice-0.50-1e5", 316, false, 0.5),
    Case { quick: true, ..case("lattice-0.55-1e5", 316, false, 0.55) },
    Case { quick: true, ..case("lattice-0.60-1e5", 316, false, 0.6) },
    case("lattice-0.55-1e4", 100, false, 0.55),
    case("lattice-0.55-1e6", 1000, false, 0.55),
    Case { scheme: Scheme::Csph, quick: true, ..case("csph-porous-1e5", 360, true, 0.5) },
    Case { scheme: Scheme::Csph, ..case("csph-lattice-0.55-1e5", 316, false, 0.55) },
    Case { dimensions: 3, quick: true, ..case("space-0.60-1e4", 22, false, 0.6) },
    Case { dimensions: 3, ..case("space-0.60-1e5", 46, false, 0.6) },
    Case { dimensions: 3, ..case("space-0.60-1e6", 100, false, 0.6) },
    Case { dimensions: 3, threads: 2, ..case("space-0.60-1e5", 46, false, 0.6) },
];

/// What a case showed.
struct Measured {
    particles: usize,
    /// Best time of a particle-step [s].
    seconds: f64,
    times: StageTimes,
    /// Neighbors within the support of the kernel, a particle.
    neighbors: f64,
    bytes: f64,
}

impl Case {
    fn settings(&self) -> Settings {
        Settings { smoothing: self.theta, ..Settings::for_scheme(self.scheme) }
    }

    fn measure(&self, runs: usize, steps: u64) -> Measured {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads).build().expect("threads");
        pool.install(|| match self.dimensions {
            2 => self.run::<Dim2>(runs, steps),
            _ => self.run::<Dim3>(runs, steps),
        })
    }

    fn run<D: SolidDimension>(&self, runs: usize, steps: u64) -> Measured {
        let mut best: Option<Measured> = None;
        for _ in 0..runs {
            let mut simulation = lattice::<D>(self.cells, self.porous, self.settings());
            let before = *simulation.stage_times();
            let start = Instant::now();
            advance(&mut simulation, steps);
            let seconds = start.elapsed().as_secs_f64();
            let measured = measured(&simulation, seconds / steps as f64, &before);
            if best.as_ref().is_none_or(|best| measured.seconds < best.seconds) {
                best = Some(measured);
            }
        }
        best.expect("at least one run")
    }
}

/// `seconds`: of a step.
fn measured<D: SolidDimension>(simulation: &Simulation<D>, seconds: f64, before: &StageTimes) -> Measured {
    let particles = simulation.particles().len();
    let n = particles as f64;
    Measured {
        particles,
        seconds: seconds / n,
        times: simulation.stage_times().since(before),
        neighbors: active_pairs(simulation) as f64 / n,
        bytes: simulation.bytes() as f64 / n,
    }
}

/// Listed pairs within the support, each counted at both of its particles.
fn active_pairs<D: SolidDimension>(simulation: &Simulation<D>) -> usize {
    let (p, lists) = (simulation.particles(), simulation.lists());
    let reach = simulation.settings().kernel.support() * simulation.settings().smoothing;
    let within = |i: usize, j: u32| {
        let j = lists.owner(j as usize);
        let distance = simulation.domain().distance(p.position_of(i), p.position_of(j));
        distance < reach * (p.size[i] + p.size[j])
    };
    (0..p.len()).map(|i| lists.neighbors(i).filter(|&j| within(i, j)).count()).sum()
}

fn print(case: &Case, m: &Measured, machine: &Machine) {
    let operations = model::operations(case.dimensions, m.neighbors, case.scheme.reconstructs());
    let arithmetic = operations / m.seconds / machine.operations(case.threads);
    let memory = 2.0 * m.bytes / m.seconds / machine.bandwidth(case.threads);
    print!(
        "{:<22} {:>7} {:>2} {:>7.2} {:>7.1} {:>6.2} {:>6.0} {:>5.0} {:>5.0}  ",
        case.name,
        m.particles,
        case.threads,
        1e-6 / m.seconds,
        m.neighbors,
        1e9 * m.seconds / (0.5 * m.neighbors),
        m.bytes,
        100.0 * arithmetic,
        100.0 * memory
    );
    for (_, _, share) in m.times.table() {
        print!(" {:>4.0}", 100.0 * share);
    }
    println!();
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["--count", name, steps] => count(name, steps.parse().expect("a number of steps")),
        [which @ ("--cases" | "--long"), runs, ref names @ ..] => {
            let steps = if which == "--long" { LONG } else { STEPS };
            let runs = runs.parse().expect("a number of runs");
            table(true, (runs, steps), &|case| names.contains(&case.name))
        }
        ["--least", steps, ref names @ ..] => least(steps.parse().expect("a number of steps"), names),
        ["--quick"] => table(true, (3, STEPS), &|case| case.quick),
        [] => table(false, (5, STEPS), &|_| true),
        _ => {
            eprintln!(
                "table: options are --quick, --cases RUNS CASE..., --long RUNS CASE..., --least STEPS CASE..., or --count CASE STEPS"
            );
            std::process::exit(2);
        }
    }
}

/// The least time of each stage in some single steps, rebuilds apart, and of a step between rebuilds.
fn least(steps: u64, names: &[&str]) {
    println!(
        "case, particles, threads; {}; a step [ns a particle]",
        StepStage::ALL.map(StepStage::name).join(", ")
    );
    for case in CASES.iter().filter(|case| names.contains(&case.name)) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(case.threads).build().expect("threads");
        let (particles, stages, whole) = pool.install(|| match case.dimensions {
            2 => least_of::<Dim2>(case, steps),
            _ => least_of::<Dim3>(case, steps),
        });
        print!("{:<22} {particles:>7} {:>2} ", case.name, case.threads);
        stages.iter().for_each(|stage| print!(" {stage:>6.1}"));
        println!("  {whole:>6.1}");
    }
}

fn least_of<D: SolidDimension>(case: &Case, steps: u64) -> (usize, [f64; 7], f64) {
    let mut simulation = lattice::<D>(case.cells, case.porous, case.settings());
    let particles = simulation.particles().len();
    let (mut stages, mut whole) = ([f64::INFINITY; 7], f64::INFINITY);
    for _ in 0..steps {
        let (before, start) = (*simulation.stage_times(), Instant::now());
        let rebuilt = simulation.step().expect("a sound step").rebuilt;
        let seconds = start.elapsed().as_secs_f64();
        let spent = simulation.stage_times().since(&before);
        for (least, &stage) in stages.iter_mut().zip(&StepStage::ALL) {
            // Lists and volumes take no time where nothing is rebuilt.
            let now = 1e9 * spent.seconds(stage) / particles as f64;
            *least = if now > 0.0 { least.min(now) } else { *least };
        }
        whole = if rebuilt { whole } else { whole.min(1e9 * seconds / particles as f64) };
    }
    (particles, stages, whole)
}

/// Nothing but steps: a counter of instructions sees little else when it subtracts two runs.
fn count(name: &str, steps: u64) {
    let Some(case) = CASES.iter().find(|c| c.name == name) else {
        eprintln!("table: no case {name}");
        std::process::exit(2);
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("threads");
    let particles = pool.install(|| match case.dimensions {
        2 => steps_of::<Dim2>(case, steps),
        _ => steps_of::<Dim3>(case, steps),
    });
    println!("{particles}");
}

fn steps_of<D: SolidDimension>(case: &Case, steps: u64) -> usize {
    let mut simulation = lattice::<D>(case.cells, case.porous, case.settings());
    advance(&mut simulation, steps);
    simulation.particles().len()
}

fn table(quick: bool, (runs, steps): (usize, u64), wanted: &dyn Fn(&Case) -> bool) {
    let machine = Machine::measure(quick);
    println!("instructions: {:?}", InstructionSet::detect());
    machine.print();
    println!();
    println!(
        "case, particles, threads, million particle-steps/s, neighbors within the support, ns a pair, bytes a particle,"
    );
    println!("% of the machine's arithmetic and of its memory, then % of the time in each stage:");
    println!("{}", StepStage::ALL.map(StepStage::name).join(", "));
    for case in CASES.iter().filter(|case| wanted(case)) {
        print(case, &case.measure(runs, steps), &machine);
    }
}
