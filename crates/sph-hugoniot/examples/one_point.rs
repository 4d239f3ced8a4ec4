//! One point of a Hugoniot from Rust, without files: a coarse porous copper at u_p = 300 m/s.
//!
//! Expected: pores are shut, so that the jump conditions leave u_s = 1117.7 to 1122.5 m/s; a coarse, short run comes within
//! one percent.
//!
//! `cargo run --release -p sph-hugoniot --example one_point`

use sph_hugoniot::{config, microstructure, point};

const CASE: &str = r#"Case(
    name: "one point",
    material: Library(name: "porous-copper"),
    medium: (cell: "20 um", pores: CenteredSquare(), porosity: 1.35, particle_size: "2 um"),
    window: (length: Cells(8)),
    points: ["300 m/s"],
    stop: (startup_cells: Cells(4), block_cells: 2, tolerance: 0.1, max_fed_cells: 12),
)"#;

/// Runs the point and prints what it gave.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let case = config::parse(CASE, "one_point.rs")?;
    let sample = microstructure::sample(&case);
    println!("{} particles a cell, m = {:.4}", sample.particles.len(), sample.porosity);

    let outcome = point::run(&case, &sample, case.points[0], &point::Unwatched);
    println!("{}: u_s = {:.1} ± {:.1} m/s", outcome.status, outcome.shock_velocity, outcome.standard_error);
    println!("from the mass of the plateau: {:.1} m/s", outcome.mass_balance_velocity);
    if let Some(precursor) = outcome.precursor {
        println!("precursor: {:.0} m/s, u = {:.1} m/s", precursor.speed, precursor.behind.velocity);
    }
    let states = outcome.states.ok_or("the window left no room for the states")?;
    println!("σ_HEL = {:.3} GPa, Δσ = {:.3} GPa", -states.ahead.stress / 1e9, states.stress_jump() / 1e9);
    println!("pores are {}", states.zone());
    if let Some(residuals) = outcome.residuals {
        let percent = [residuals.mass, residuals.momentum, residuals.energy].map(|part| 100.0 * part);
        let [mass, momentum, energy] = percent;
        println!("jump conditions: mass {mass:+.2} %, momentum {momentum:+.2} %, energy {energy:+.2} %");
    }
    outcome.warnings.iter().for_each(|warning| println!("warning: {warning}"));
    if (outcome.shock_velocity / 1120.0 - 1.0).abs() > 0.01 {
        return Err("u_s is not what the jump conditions leave".into());
    }
    Ok(())
}
