//! Two copper plates meet at 200 m/s: stress and velocity at the interface against the exact state.
//!
//! `cargo run --release -p sph-riemann --example two_plates`

use glam::DVec2;
use sph_core::{Dim2, Domain, Particle, Particles};
use sph_riemann::{Settings, Simulation};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let copper = sph_materials::library::material("porous-copper")?;
    let (size, speed) = (1e-5, 200.0);
    let mut particles = Particles::<Dim2>::default();
    for cell in 0..200 * 4 {
        let (column, row) = ((cell / 4) as f64 - 100.0 + 0.5, (cell % 4) as f64 + 0.5);
        let position = DVec2::new(column, row) * size;
        let mass = copper.reference_density * size * size;
        let mut particle = Particle::<Dim2>::at_rest(cell, position, mass, size, copper.reference_density);
        particle.velocity.x = if column < 0.0 { speed } else { 0.0 };
        particles.push(particle);
    }
    let box_of_plates =
        Domain::new(DVec2::new(-100.0, 0.0) * size, DVec2::new(100.0, 4.0) * size, [false, true]);
    let mut simulation =
        Simulation::new(box_of_plates, vec![copper.clone()], particles, Settings::default())?;
    while simulation.time() < 0.12e-6 {
        simulation.step()?;
    }
    // By symmetry each plate sees a piston of half the speed.
    let waves = sph_materials::hugoniot::piston(&copper, 0.5 * speed)?;
    let exact = waves.final_state();
    let p = simulation.particles();
    let middle: Vec<usize> =
        (0..p.len()).filter(|&i| p.position[0][i].abs() < 20.0 * size + 0.5 * speed * 0.12e-6).collect();
    let mean = |f: &dyn Fn(usize) -> f64| middle.iter().map(|&i| f(i)).sum::<f64>() / middle.len() as f64;
    let stress = mean(&|i| simulation.stress(i)[0]);
    let velocity = mean(&|i| p.velocity[0][i]);
    println!("{} steps to {:.3} us", simulation.step_count(), simulation.time() * 1e6);
    println!("stress   {:8.4} GPa   exact {:8.4} GPa", stress / 1e9, exact.longitudinal_stress / 1e9);
    println!("velocity {:8.3} m/s   exact {:8.3} m/s", velocity, 0.5 * speed);
    let error = (stress / exact.longitudinal_stress).abs() - 1.0;
    assert!(error.abs() < 0.01, "stress is off by {:.2} %", 100.0 * error);
    Ok(())
}
