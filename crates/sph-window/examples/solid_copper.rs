//! A steady plastic shock in solid copper, hosted by the window alone: 2 mm are fed through a box of 0.2 mm.
//!
//! Expected: the speed of the plastic wave of a piston of 200 m/s behind its elastic precursor, from the exact solution
//! (`sph_materials::hugoniot::piston`), within half a percent.
//!
//! `cargo run --release -p sph-window --example solid_copper`

use sph_core::{Components, Dim2, Domain, Particle, Particles, dimension::Dimension};
use sph_materials::hugoniot::piston;
use sph_riemann::{Scheme, Settings};
use sph_window::{FeedSample, InletKind, Window, WindowError, WindowSettings};

/// Particle size [m].
const SIZE: f64 = 1e-6;

fn sample(density: f64) -> Result<FeedSample<Dim2>, WindowError> {
    let (columns, rows) = (10, 6);
    let mut particles = Particles::default();
    for index in 0..columns * rows {
        let place = [(index % columns) as f64 + 0.5, (index / columns) as f64 + 0.5];
        let position = Dim2::vector(|axis| SIZE * place[axis]);
        particles.push(Particle::at_rest(index as u64, position, density * SIZE * SIZE, SIZE, density));
    }
    let upper = Dim2::vector(|axis| SIZE * [columns, rows][axis] as f64);
    FeedSample::new(particles, Domain::new(Dim2::vector(|_| 0.0), upper, Components::from_fn(|_| true)))
}

/// Runs the shock and prints its speed beside the exact one.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let copper = sph_materials::library::material("porous-copper")?;
    let particle_velocity = 200.0;
    let exact = piston(&copper, particle_velocity)?.main_wave();
    let settings = WindowSettings {
        inlet: InletKind::ImpedanceMatched { wave_speed: None },
        ..WindowSettings::new(200.0 * SIZE, particle_velocity)
    };
    let sample = sample(copper.reference_density)?;
    let mut window = Window::new(sample, vec![copper], Settings::for_scheme(Scheme::TkcHancock), settings)?;
    while window.fed_length() < 2e-3 {
        let report = window.step()?;
        if let Some(boost) = report.boost.filter(|boost| boost.abs() > 10.0) {
            println!("{:6.1} ns: the frame is boosted by {boost:8.2} m/s", 1e9 * window.time());
        }
    }
    let shock = window.shock_velocity().ok_or("no block of the medium was swept")?;
    let deficit = window.feed_deficit();
    println!("a piston of {particle_velocity:.1} m/s, precursor gone through the inlet");
    println!("fed medium: u_s = {:.1} ± {:.1} m/s", shock.velocity, shock.standard_error);
    println!("at rest:    {:.1} m/s, exact {:.1} m/s", shock.velocity + deficit, exact.wave_speed);
    println!("the ledger closes to {:.1e}", window.ledger_residual());
    if ((shock.velocity + deficit) / exact.wave_speed - 1.0).abs() > 5e-3 {
        return Err("the shock velocity is off by more than half a percent".into());
    }
    Ok(())
}
