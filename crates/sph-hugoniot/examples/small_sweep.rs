//! A sweep from Rust, without files: three points of a coarse porous copper, side by side, and the line through them.
//!
//! Expected: pores are shut at all three, so that the line's slope is near that of the jump conditions of shut pores,
//! (1120 - 759)/100 = 3.61 between u_p = 200 and 300 m/s; coarse, short runs come within five percent.
//!
//! `cargo run --release -p sph-hugoniot --example small_sweep`

use std::sync::Mutex;

use sph_hugoniot::curve::fit::{Fit, Form};
use sph_hugoniot::curve::points::Curve;
use sph_hugoniot::outcome::PointOutcome;
use sph_hugoniot::point::{Control, Unwatched};
use sph_hugoniot::restart::Keeper;
use sph_hugoniot::sweep::{self, Sweep, Watch};
use sph_hugoniot::{cli, config, microstructure};

const CASE: &str = r#"Case(
    name: "small sweep",
    material: Library(name: "porous-copper"),
    medium: (cell: "20 um", pores: CenteredSquare(), porosity: 1.35, particle_size: "2 um"),
    window: (length: Cells(8)),
    points: Range(from: "200 m/s", to: "300 m/s", count: 3),
    stop: (startup_cells: Cells(4), block_cells: 2, tolerance: 0.1, max_fed_cells: 12),
)"#;

/// Takes the outcomes; nothing is kept on disk, and nothing stops the sweep.
#[derive(Default)]
struct Collect(Mutex<Vec<PointOutcome>>);

impl Watch for Collect {
    fn control(&self, _index: usize) -> Box<dyn Control + '_> {
        Box::new(Unwatched)
    }

    fn keeper(&self, _index: usize) -> anyhow::Result<Option<Keeper>> {
        Ok(None)
    }

    fn interrupted(&self) -> bool {
        false
    }

    fn finished(&self, _index: usize, outcome: PointOutcome) -> anyhow::Result<()> {
        println!("{:.0} m/s: u_s = {:.1} m/s", outcome.particle_velocity, outcome.shock_velocity);
        self.0.lock().expect("no point has panicked").push(outcome);
        Ok(())
    }
}

/// Runs the sweep and prints the line.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let case = config::parse(CASE, "small_sweep.rs")?;
    let sample = microstructure::sample(&case);
    let collect = Collect::default();
    let costs = vec![1.0; case.points.len()];
    sweep::run(
        Sweep { case: &case, sample: &sample, points: &case.points },
        &costs,
        cli::available_threads(),
        &collect,
    )?;
    let mut outcomes = collect.0.into_inner()?;
    outcomes.sort_by(|a, b| a.particle_velocity.total_cmp(&b.particle_velocity));
    let bulk_density = case.material.reference_density / sample.porosity;
    let curve = Curve::new(bulk_density, &outcomes.iter().collect::<Vec<_>>());
    let line = Fit::new(Form::Linear, &curve.to_fit()).ok_or("three points make a line")?;
    let slope = (line.shock_velocity(300.0) - line.shock_velocity(200.0)) / 100.0;
    println!("slope of u_s(u_p): {slope:.3}");
    if (slope / 3.61 - 1.0).abs() > 0.05 {
        return Err(format!("the slope is {slope}, far from that of shut pores").into());
    }
    Ok(())
}
