//! What it costs to know u_s within a percent: frame tracking, the published bisection, and a long sample that a piston
//! drives in the rest frame.
//!
//! One case, the coarse porous copper below at one u_p. The reference is the mean over many cells of a long tracked run.
//! Each method gives a running estimate of u_s; its cost is the number of particle-steps after which the estimate stays
//! within the tolerance of the reference for good:
//!
//! * **tracking**: mean over all cells since the start-up material left, at most the last eight;
//! * **bisection**: the middle of the bracket after each trial (u_s = u_out + u_p), particle-steps of all trials before it
//!   included;
//! * **rest frame**: a sample as long as the front needs for the same cells, with a piston at its end and the medium at
//!   rest; long enough that the reflected precursor does not meet the front. Mean over the last eight cells.
//!
//! `cargo run --release -p sph-hugoniot --example search_comparison [u_p in m/s]`

use std::error::Error;

use sph_core::{Constraint, Dim2, Domain, Particles};
use sph_hugoniot::statistics::{harmonic_mean, standard_error};
use sph_hugoniot::{config, microstructure, setup};
use sph_riemann::Simulation;
use sph_window::profile::{Grid, Profile};
use sph_window::shock::ShockHistory;
use sph_window::{Bisection, FrameTracking, Search, Window};

const CASE: &str = r#"Case(
    name: "comparison",
    material: Library(name: "porous-copper"),
    medium: (cell: "20 um", pores: CenteredSquare(), porosity: 1.35, particle_size: "2 um"),
    window: (length: Cells(12)),
    points: ["250 m/s"],
)"#;
/// Agreement with the reference that is asked for.
const TOLERANCE: f64 = 0.01;
/// Cells of a running mean.
const CELLS: usize = 8;
/// Cells that the reference is averaged over.
const REFERENCE_CELLS: usize = 40;
/// Speed of the precursor that the long sample is laid out for, above that of its foot [m/s].
const PRECURSOR: f64 = 3500.0;

/// A method's running estimates: (particle-steps, u_s [m/s]).
type Trace = Vec<(u64, f64)>;

/// What a method came to.
struct Outcome {
    name: &'static str,
    trace: Trace,
    velocity: f64,
    noise: f64,
}

/// Particle-steps after which the estimates stay within the tolerance; `None` if the last one is not.
fn cost(trace: &Trace, reference: f64) -> Option<u64> {
    let good = |u_s: f64| (u_s / reference - 1.0).abs() <= TOLERANCE;
    let bad = trace.iter().rposition(|&(_, u_s)| !good(u_s));
    trace.get(bad.map_or(0, |last| last + 1)).map(|&(steps, _)| steps)
}

fn last(cells: &[f64]) -> &[f64] {
    &cells[cells.len().saturating_sub(CELLS)..]
}

struct Study {
    case: config::Case,
    sample: microstructure::Sample,
    particle_velocity: f64,
}

impl Study {
    fn window(&self, search: Search) -> Result<Window<Dim2>, Box<dyn Error>> {
        let case = config::Case { search, ..self.case.clone() };
        let settings = setup::window_settings(&case, self.particle_velocity);
        let feed = setup::feed_sample(&self.sample)?;
        Ok(Window::new(feed, vec![case.material.clone()], case.scheme, settings)?)
    }

    /// Tracking, and the reference: the mean over the last cells of a long run.
    fn tracking(&self) -> Result<(Outcome, f64), Box<dyn Error>> {
        let mut window = self.window(Search::FrameTracking(FrameTracking::default()))?;
        let (mut trace, mut settled, mut count) = (Trace::new(), None, 0);
        loop {
            window.step()?;
            let blocks = window.blocks();
            if !window.is_settled() || blocks.len() == count {
                continue;
            }
            let first = *settled.get_or_insert(blocks.len());
            count = blocks.len();
            let cells: Vec<f64> = blocks[first..].iter().map(|b| b.velocity()).collect();
            if !cells.is_empty() {
                trace.push((window.simulation().particle_steps(), harmonic_mean(last(&cells))));
            }
            if cells.len() >= REFERENCE_CELLS {
                let reference = harmonic_mean(&cells);
                let velocity = trace[CELLS - 1].1;
                let noise = standard_error(&cells[..CELLS]);
                return Ok((Outcome { name: "tracking", trace, velocity, noise }, reference));
            }
        }
    }

    /// The published search: a first result after its first round, the final one after the second.
    fn bisection(&self) -> Result<Outcome, Box<dyn Error>> {
        let mut window = self.window(Search::Bisection(Bisection::default()))?;
        while window.is_searching() {
            window.step()?;
        }
        let (mut spent, mut trace) = (0, Trace::new());
        for trial in window.audit() {
            spent += trial.particle_steps;
            let middle = 0.5 * (trial.bracket.0 + trial.bracket.1) + self.particle_velocity;
            println!(
                "  {:?} {}: u_out {:7.1}, drift {:+.2e} 1/s, {:?}, u_s in [{:.1}, {:.1}]",
                trial.stage,
                trial.round,
                trial.outlet_velocity,
                trial.drift.unwrap_or(f64::NAN),
                trial.decision,
                trial.bracket.0 + self.particle_velocity,
                trial.bracket.1 + self.particle_velocity
            );
            if trial.drift.is_some() {
                trace.push((spent, middle));
            }
        }
        let velocity = window.frame().inlet_velocity();
        // What the drift of the front says in the frame that was found: its error is that of the search.
        let round = |n: u32| {
            window.audit().iter().rev().find(|t| t.round == n).map_or(f64::NAN, |t| t.inlet_velocity)
        };
        Ok(Outcome { name: "bisection", trace, velocity, noise: (round(2) - round(1)).abs() })
    }

    /// A long sample at rest with a piston that starts at once.
    fn rest_frame(&self, cells: usize) -> Result<Outcome, Box<dyn Error>> {
        let speed =
            sph_hugoniot::estimate::shock_velocity(&self.case, self.sample.porosity, self.particle_velocity);
        let length = (0.5 * cells as f64 * (1.0 + PRECURSOR / speed)).ceil() as usize + 1;
        let mut simulation = self.long_sample(length)?;
        let (cell, size) = (self.sample.cell, self.case.medium.particle_size);
        let grid = Grid { length: length as f64 * cell, window: cell, resolution: 0.5 * size };
        let (mut history, mut trace) = (ShockHistory::new(cell), Trace::new());
        let mut count = 0;
        while history.blocks().len() < cells {
            // The box of the profile follows the piston, so that the mean behind the front stays whole.
            simulation.step()?;
            if simulation.step_count() % 10 != 0 {
                continue;
            }
            let profile = Profile::new(simulation.particles(), |_| 0.0, grid, cell);
            let Some(front) = profile.rightmost_crossing(0.5 * self.particle_velocity) else { continue };
            history.observe(simulation.time(), front);
            let blocks = history.blocks();
            if blocks.len() > count {
                count = blocks.len();
                let speeds: Vec<f64> = blocks.iter().map(|b| b.velocity()).collect();
                trace.push((simulation.particle_steps(), harmonic_mean(last(&speeds))));
            }
        }
        let speeds: Vec<f64> = history.blocks().iter().map(|b| b.velocity()).collect();
        let velocity = harmonic_mean(last(&speeds));
        println!("  {length} cells, {} particles", simulation.particles().len());
        Ok(Outcome { name: "rest frame", trace, velocity, noise: standard_error(last(&speeds)) })
    }

    /// So many cells of the medium at rest; the first four particle sizes are the piston.
    fn long_sample(&self, cells: usize) -> Result<Simulation<Dim2>, Box<dyn Error>> {
        let mut particles = Particles::default();
        for period in 0..cells {
            for &particle in &self.sample.particles {
                let mut particle = particle;
                particle.id = particles.len() as u64;
                particle.position.x += period as f64 * self.sample.cell;
                if particle.position.x < 4.0 * self.case.medium.particle_size {
                    particle.velocity.x = self.particle_velocity;
                    particle.constraint = Constraint::ImposedVelocity;
                }
                particles.push(particle);
            }
        }
        let upper = glam::DVec2::new(cells as f64 * self.sample.cell, self.sample.cell);
        let domain = Domain::new(glam::DVec2::ZERO, upper, [false, true]);
        Ok(Simulation::new(domain, vec![self.case.material.clone()], particles, self.case.scheme)?)
    }
}

/// Runs the comparison and prints its table.
pub fn main() -> Result<(), Box<dyn Error>> {
    let case = config::parse(CASE, "search_comparison.rs")?;
    let sample = microstructure::sample(&case.medium, case.material.reference_density);
    let particle_velocity = std::env::args().nth(1).map_or(Ok(case.points[0]), |text| text.parse())?;
    let study = Study { case, sample, particle_velocity };
    let (tracking, reference) = study.tracking()?;
    println!(
        "u_p = {particle_velocity} m/s, reference {reference:.1} m/s, mean of {REFERENCE_CELLS} cells\n"
    );
    println!("bisection, every trial:");
    let bisection = study.bisection()?;
    println!("\nlong sample in the rest frame:");
    let rest = study.rest_frame(24)?;
    println!(
        "\n| method | u_s, m/s | off, % | noise, m/s | particle-steps to stay within 1 % | against tracking |"
    );
    println!("|---|---|---|---|---|---|");
    let least = cost(&tracking.trace, reference).unwrap_or(u64::MAX) as f64;
    for result in [&tracking, &bisection, &rest] {
        let steps = cost(&result.trace, reference);
        println!(
            "| {} | {:.1} | {:+.2} | {:.1} | {} | {} |",
            result.name,
            result.velocity,
            100.0 * (result.velocity / reference - 1.0),
            result.noise,
            steps.map_or("never".to_string(), |n| format!("{:.2} million", n as f64 / 1e6)),
            steps.map_or("-".to_string(), |n| format!("{:.1}", n as f64 / least)),
        );
    }
    Ok(())
}
