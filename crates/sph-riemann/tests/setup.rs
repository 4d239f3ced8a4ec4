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

/// Every column is looked at before the first step: its length, and its values.
#[test]
fn a_column_that_cannot_be_is_named() {
    let copper = sph_materials::library::material("porous-copper").expect("a library material");
    let begin = |change: &dyn Fn(&mut Particles<Dim2>)| {
        let (domain, mut particles) = porous_block::<Dim2>(10, 0.0, 0.0);
        change(&mut particles);
        Simulation::new(domain, vec![copper.clone()], particles, Settings::default()).map(|_| ())
    };
    assert_eq!(begin(&|_| ()), Ok(()));
    let short = |result: Result<(), SetupError>| match result {
        Err(SetupError::Column { name, length, count }) => (name, count - length),
        other => panic!("{other:?}"),
    };
    assert_eq!(short(begin(&|p| p.deviator[1].truncate(p.id.len() - 1))), ("deviator_yy".to_owned(), 1));
    assert_eq!(short(begin(&|p| p.failed.truncate(p.id.len() - 1))), ("failed".to_owned(), 1));
    for (field, change) in [
        ("deviator", &(|p: &mut Particles<Dim2>| p.deviator[0][3] = f64::NAN) as &dyn Fn(&mut _)),
        ("relative speed", &|p: &mut Particles<Dim2>| p.relative_speed[3] = f64::INFINITY),
        ("distension", &|p: &mut Particles<Dim2>| p.distension[3] = 0.0),
        ("plastic strain", &|p: &mut Particles<Dim2>| p.plastic_strain[3] = f64::NAN),
    ] {
        let Err(SetupError::Particle { field: told, .. }) = begin(change) else { panic!("{field}") };
        assert_eq!(told, field);
    }
}

/// Neighbor lists of a checkpoint are built from positions that are numbers, or not at all.
#[test]
fn list_positions_that_are_not_finite_are_refused() {
    let copper = sph_materials::library::material("porous-copper").expect("a library material");
    let (domain, particles) = porous_block::<Dim2>(10, 0.0, 0.0);
    let saved = simulation::<Dim2>(10, 0.0, Settings::default()).clock();
    let mut positions: Vec<Vec<f64>> = particles.position.to_vec();
    positions[1][2] = f64::INFINITY;
    let settings = Settings::default();
    let restored =
        Simulation::restore(domain, vec![copper], particles, settings, saved, Some(&positions)).map(|_| ());
    assert_eq!(restored, Err(SetupError::ListPosition { particle: 2, axis: 1, value: f64::INFINITY }));
}
