//! What a simulation refuses, and what it tells of its particles.

mod common;

use common::{advance, porous_block, simulation};
use sph_core::{Dim2, Particle, Particles};
use sph_materials::{Failure, VoidGrowth};
use sph_riemann::{Settings, SetupError, Simulation, StepError};

#[test]
fn a_limit_that_is_no_length_of_time_is_refused() {
    let mut simulation = simulation::<Dim2>(10, 0.1, Settings::default());
    for limit in [0.0, -1e-9, f64::NEG_INFINITY, f64::NAN] {
        let refused = simulation.step_at_most(limit);
        let Err(StepError::Limit { limit: told }) = refused else { panic!("{limit}: {refused:?}") };
        assert_eq!(told.to_bits(), limit.to_bits());
    }
    assert_eq!((simulation.time(), simulation.step_count()), (0.0, 0));
    let report = simulation.step_at_most(1e-12).expect("a sound step");
    assert_eq!(report.time_step, 1e-12);
}

#[test]
fn nothing_has_no_time_step() {
    let (domain, _) = porous_block::<Dim2>(10, 0.0, 0.0);
    let copper = sph_materials::library::material("porous-copper").expect("a library material");
    let empty = Particles::default();
    let mut simulation =
        Simulation::new(domain, vec![copper], empty, Settings::default()).expect("nothing wrong");
    assert!(matches!(simulation.step(), Err(StepError::Empty)));
}

#[test]
fn particles_changed_from_outside_are_checked() {
    let mut simulation = simulation::<Dim2>(10, 0.1, Settings::default());
    advance(&mut simulation, 1);
    let mut stranger = Particle::at_rest(4711, [1e-6, 1e-6].into(), 1e-8, 1e-6, 8960.0);
    stranger.material = 3;
    simulation.particles_mut().push(stranger);
    let fault = SetupError::NoSuchMaterial { particle: 4711, material: 3, count: 1 };
    assert_eq!(simulation.step(), Err(StepError::Particle(fault.clone())));
    assert_eq!(simulation.step(), Err(StepError::Particle(fault)), "until it is mended");
    let particles = simulation.particles_mut();
    let last = particles.len() - 1;
    particles.material[last] = 0;
    particles.density[last] = f64::NAN;
    let refused = simulation.step();
    let Err(StepError::Particle(SetupError::Particle { particle: 4711, field: "density", .. })) = refused
    else {
        panic!("{refused:?}")
    };
    let particles = simulation.particles_mut();
    particles.density[last] = 8960.0;
    advance(&mut simulation, 1);
}

/// The sound speed that is told is that of the time step and the contacts, with voids too.
#[test]
fn sound_speed_is_that_of_the_step() {
    let (domain, mut particles) = porous_block::<Dim2>(10, 0.0, 0.0);
    let mut copper = sph_materials::library::material("porous-copper").expect("a library material");
    copper.failure = Failure::VoidGrowth(VoidGrowth::of_strength(0.35e9));
    for i in 0..particles.len() {
        particles.distension[i] = 1.0 + 0.02 * (i % 7) as f64;
        particles.density[i] = 8960.0 / particles.distension[i];
    }
    let mut simulation =
        Simulation::new(domain, vec![copper], particles, Settings::default()).expect("a sound set-up");
    let p = simulation.particles();
    let least = (0..p.len())
        .map(|i| p.size[i] / simulation.longitudinal_sound_speed(i))
        .fold(f64::INFINITY, f64::min);
    let step = simulation.step().expect("a sound step").time_step;
    assert!((step / (0.4 * least) - 1.0).abs() < 1e-12, "{step:e} s, {least:e} s");
}
