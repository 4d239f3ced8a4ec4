//! Rigid rotation: a free elastic disc keeps its angular momentum and its shape; a stress turns with the body.

use glam::DVec2;
use sph_core::{Dim2, Domain, Particle, Particles};
use sph_riemann::{Settings, Simulation, SurfaceTreatment};

const SIZE: f64 = 1e-3;
const DENSITY: f64 = 8960.0;

/// A disc of 12 particles' radius that turns with 2 % of the sound speed at its rim.
fn disc(settings: Settings) -> (Simulation<Dim2>, f64) {
    let mut copper = sph_materials::library::material("copper-sound-wave").expect("a library material");
    copper.failure = sph_materials::Failure::None;
    let (radius, turn) = (12.0 * SIZE, 0.02 * 5000.0 / (12.0 * SIZE));
    let mut particles = Particles::<Dim2>::default();
    for (i, j) in (-12..12).flat_map(|i| (-12..12).map(move |j| (i, j))) {
        let position = DVec2::new(i as f64 + 0.5, j as f64 + 0.5) * SIZE;
        if position.length() < radius {
            let id = particles.len() as u64;
            let mut particle = Particle::at_rest(id, position, DENSITY * SIZE * SIZE, SIZE, DENSITY);
            particle.velocity = position.perp() * turn;
            particles.push(particle);
        }
    }
    let simulation =
        Simulation::new(Domain::open(), vec![copper], particles, settings).expect("a sound set-up");
    (simulation, 2.0 * std::f64::consts::PI / turn)
}

fn angular_momentum(simulation: &Simulation<Dim2>) -> f64 {
    let p = simulation.particles();
    (0..p.len()).map(|i| p.mass[i] * p.position_of(i).perp_dot(p.velocity_of(i))).sum()
}

fn share_left_after(settings: Settings, turns: f64) -> f64 {
    let (mut simulation, period) = disc(settings);
    let before = angular_momentum(&simulation);
    while simulation.time() < turns * period {
        simulation.step().expect("a sound step");
    }
    angular_momentum(&simulation) / before
}

#[test]
fn a_free_disc_keeps_its_angular_momentum_over_a_turn() {
    let share = share_left_after(Settings::default(), 1.0);
    assert!(share > 0.999 && share < 1.001, "{share} of the angular momentum is left after a turn");
}

#[test]
fn the_intended_rule_loses_it() {
    let surface = SurfaceTreatment::Intended { determinant_floor: 0.05 };
    let share = share_left_after(Settings { surface, ..Settings::default() }, 0.5);
    assert!(share < 0.9, "{share} of the angular momentum is left after half a turn");
}
