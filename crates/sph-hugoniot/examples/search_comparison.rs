//! What it costs to know u_s within a percent: frame tracking, the published bisection, and a long sample that a piston
//! drives in the rest frame.
//!
//! One case, the coarse porous copper below at one u_p. The reference is the mean over many cells of a long tracked run.
//! Each method gives a running estimate of u_s. Two costs are told, in particle-steps: after how many the estimate stays within
//! a percent of the reference for good, and after how many the method itself has ended.
//!
//! * **tracking**: mean over all cells since the start-up material left, at most the last eight; it ends when the point has
//!   settled as `hugoniot run` sees it.
//! * **bisection**: the middle of the bracket after each trial (u_s = u_out + u_p), all trials before it included; it ends after
//!   its second round.
//! * **rest frame**: a sample at rest, as long as the front needs for its cells before the reflected precursor meets it, with
//!   a piston at its end. Mean over the last eight cells; it ends like tracking. The matter ahead of the front moves with the
//!   velocity u_e behind the precursor, so that the piston is driven with u_p + u_e and u_e is taken off the front's speed: the
//!   same jump as in the window, where a rigid inlet has brought the matter ahead to rest. u_e comes from a run before, which
//!   is not counted.
//!
//! `cargo run --release -p sph-hugoniot --example search_comparison [u_p in m/s]`

use std::error::Error;

use sph_core::{Constraint, Dim2, Domain, Particles};
use sph_hugoniot::statistics::{harmonic_mean, standard_error};
use sph_hugoniot::{config, microstructure, settle, setup};
use sph_riemann::Simulation;
use sph_window::profile::{Grid, Profile};
use sph_window::search::bisection::Trial;
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
    /// How far one estimate is from the next by chance [m/s].
    noise: f64,
    /// Particle-steps until the method ended.
    ended: u64,
}

/// The cells since start-up, judged as a point is: true when it has settled.
fn has_settled(cells: &[f64], case: &config::Case) -> bool {
    cells.len().is_multiple_of(case.stop.block_cells)
        && settle::judge(cells, 0.0, &case.stop, case.stop.blocks).decision == settle::Decision::Settled
}

/// Particle-steps after which the estimates stay within the tolerance; `None` if the last one is not.
fn cost(trace: &Trace, reference: f64) -> Option<u64> {
    let good = |u_s: f64| (u_s / reference - 1.0).abs() <= TOLERANCE;
    let bad = trace.iter().rposition(|&(_, u_s)| !good(u_s));
    trace.get(bad.map_or(0, |last| last + 1)).map(|&(steps, _)| steps)
}

/// Noise of the slope ⟨dω/dt⟩ as a velocity [m/s]: scatter of the last trials about the straight line of slope against
/// outlet velocity, over the steepness of that line.
fn slope_noise(audit: &[Trial]) -> f64 {
    let trials: Vec<(f64, f64)> =
        audit.iter().rev().take(6).filter_map(|t| Some((t.outlet_velocity, t.drift?))).collect();
    let n = trials.len() as f64;
    let mean = |value: &dyn Fn(&(f64, f64)) -> f64| trials.iter().map(value).sum::<f64>() / n;
    let (u, d) = (mean(&|t| t.0), mean(&|t| t.1));
    let steepness = mean(&|t| (t.0 - u) * (t.1 - d)) / mean(&|t| (t.0 - u).powi(2));
    let square = mean(&|t| (t.1 - d - steepness * (t.0 - u)).powi(2)) * n / (n - 2.0);
    square.sqrt() / steepness.abs()
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
        Ok(Window::new(feed, case.materials(), case.scheme, settings)?)
    }

    /// Tracking, and the reference: the mean over the last cells of a long run.
    fn tracking(&self) -> Result<(Outcome, f64), Box<dyn Error>> {
        let mut window = self.window(Search::FrameTracking(FrameTracking::default()))?;
        let (mut trace, mut settled, mut count) = (Trace::new(), None, 0);
        let mut end = None;
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
                if end.is_none() && has_settled(&cells, &self.case) {
                    end = Some((trace[trace.len() - 1], standard_error(last(&cells))));
                }
            }
            if cells.len() >= REFERENCE_CELLS {
                let ((ended, velocity), noise) = end.ok_or("tracking has not settled")?;
                let outcome = Outcome { name: "tracking", trace, velocity, noise, ended };
                return Ok((outcome, harmonic_mean(&cells)));
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
        Ok(Outcome { name: "bisection", trace, velocity, noise: slope_noise(window.audit()), ended: spent })
    }

    /// A long sample at rest with a piston that starts at once, in front of which the precursor moves the matter with `ahead`
    /// [m/s]; and the velocity with which it really does.
    fn rest_frame(&self, cells: usize, ahead: f64) -> Result<(Outcome, f64), Box<dyn Error>> {
        let u_p = self.particle_velocity;
        let speed = sph_hugoniot::estimate::shock_velocity(&self.case, self.sample.porosity, u_p);
        let length = (0.5 * cells as f64 * (1.0 + PRECURSOR / speed)).ceil() as usize + 1;
        let mut simulation = self.long_sample(length, u_p + ahead)?;
        let (cell, size) = (self.sample.cell, self.case.medium.particle_size);
        let grid = Grid { length: length as f64 * cell, window: cell, resolution: 0.5 * size };
        let (mut history, mut trace, mut count) = (ShockHistory::new(cell), Trace::new(), 0);
        let (mut end, mut found, mut noise) = (None, ahead, f64::NAN);
        while count < cells {
            simulation.step()?;
            if !simulation.step_count().is_multiple_of(10) {
                continue;
            }
            let profile = Profile::new(simulation.particles(), |_| 0.0, grid, self.sample.height);
            let Some(front) = profile.rightmost_crossing(0.5 * u_p) else { continue };
            history.observe(simulation.time(), front);
            let blocks = history.blocks();
            if blocks.len() > count {
                count = blocks.len();
                found = profile.between(front + 1.5 * cell, front + 3.5 * cell).velocity();
                let speeds: Vec<f64> = blocks.iter().map(|b| b.velocity() - ahead).collect();
                trace.push((simulation.particle_steps(), harmonic_mean(last(&speeds))));
                if end.is_none() && has_settled(&speeds, &self.case) {
                    (end, noise) = (trace.last().copied(), standard_error(last(&speeds)));
                }
            }
        }
        let (ended, velocity) = end.or(trace.last().copied()).ok_or("no cell was swept")?;
        println!(
            "  {length} cells, {} particles, the matter ahead moves with {found:.1} m/s",
            simulation.particles().len()
        );
        Ok((Outcome { name: "rest frame", trace, velocity, noise, ended }, found))
    }

    /// So many cells of the medium at rest; the first four particle sizes are the piston.
    fn long_sample(&self, cells: usize, piston: f64) -> Result<Simulation<Dim2>, Box<dyn Error>> {
        let mut particles = Particles::default();
        for period in 0..cells {
            for &particle in &self.sample.particles {
                let mut particle = particle;
                particle.id = particles.len() as u64;
                particle.position.x += period as f64 * self.sample.cell;
                if particle.position.x < 4.0 * self.case.medium.particle_size {
                    particle.velocity.x = piston;
                    particle.constraint = Constraint::ImposedVelocity;
                }
                particles.push(particle);
            }
        }
        let upper = glam::DVec2::new(cells as f64 * self.sample.cell, self.sample.height);
        let domain = Domain::new(glam::DVec2::ZERO, upper, [false, true]);
        Ok(Simulation::new(domain, self.case.materials(), particles, self.case.scheme)?)
    }
}

/// Runs the comparison and prints its table.
pub fn main() -> Result<(), Box<dyn Error>> {
    let case = config::parse(CASE, "search_comparison.rs")?;
    let sample = microstructure::sample(&case);
    let particle_velocity = std::env::args().nth(1).map_or(Ok(case.points[0]), |text| text.parse())?;
    let study = Study { case, sample, particle_velocity };
    let (tracking, reference) = study.tracking()?;
    println!(
        "u_p = {particle_velocity} m/s, reference {reference:.1} m/s, mean of {REFERENCE_CELLS} cells\n"
    );
    println!("bisection, every trial:");
    let bisection = study.bisection()?;
    println!("\nlong sample in the rest frame:");
    let (_, ahead) = study.rest_frame(16, 0.0)?;
    let (rest, _) = study.rest_frame(28, ahead)?;
    print_table(reference, &[&tracking, &bisection, &rest]);
    Ok(())
}

/// The table; the first method is the one that the others are compared with.
fn print_table(reference: f64, outcomes: &[&Outcome]) {
    println!(
        "\n| method | u_s, m/s | off, % | noise, m/s | within 1 % for good | ended | against tracking |"
    );
    println!("|---|---|---|---|---|---|---|");
    let millions =
        |steps: Option<u64>| steps.map_or("never".to_string(), |n| format!("{:.2} million", n as f64 / 1e6));
    let times = |part: Option<u64>, whole: Option<u64>| {
        part.zip(whole).map_or("-".to_string(), |(a, b)| format!("{:.1}", a as f64 / b as f64))
    };
    let (least, first) = (cost(&outcomes[0].trace, reference), outcomes[0].ended);
    for outcome in outcomes {
        let (steps, off) = (cost(&outcome.trace, reference), 100.0 * (outcome.velocity / reference - 1.0));
        println!(
            "| {} | {:.1} | {off:+.2} | {:.1} | {} | {} | {}, {} |",
            outcome.name,
            outcome.velocity,
            outcome.noise,
            millions(steps),
            millions(Some(outcome.ended)),
            times(steps, least),
            times(Some(outcome.ended), Some(first)),
        );
    }
}
