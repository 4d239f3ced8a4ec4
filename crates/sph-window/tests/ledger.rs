//! What comes in and goes out is booked to the last bit, with boosts, imposed velocities and a restart.

mod common;

use common::{SIZE, copper, medium, solver, window};
use sph_core::{Dim2, Dim3};
use sph_riemann::SolidDimension;
use sph_window::{FeedSample, FrameTracking, InletKind, Search, Window, WindowSettings};

fn settings(length: f64) -> WindowSettings {
    WindowSettings {
        inlet_velocity: Some(600.0),
        inlet: InletKind::ImpedanceMatched { wave_speed: Some(3000.0) },
        front_place: 0.5,
        search: Search::FrameTracking(FrameTracking { interval: 8.0, ..FrameTracking::default() }),
        ..WindowSettings::new(length, 400.0)
    }
}

/// A slit in each period lets the front stay near its place: one particle in four is missing.
fn slit<D: SolidDimension>(counts: [usize; 3]) -> FeedSample<D> {
    medium(counts, |[x, y, _]| !((2.0..4.0).contains(&x) && y < 4.0))
}

fn the_ledger_closes<D: SolidDimension>(counts: [usize; 3], fed: f64) {
    let sample = slit::<D>(counts);
    let mut window: Window<D> = window(sample, settings(60.0 * SIZE));
    while window.fed_length() < fed * SIZE {
        window.step().unwrap();
        assert!(window.ledger_residual() < 1e-12, "step {}", window.steps());
    }
    let (ledger, frame) = (window.ledger(), window.frame());
    println!(
        "{} in, {} out, {} boosts, residual {:.1e}",
        ledger.particles_fed,
        ledger.particles_removed,
        frame.boosts(),
        window.ledger_residual()
    );
    assert!(ledger.particles_fed > 0 && ledger.particles_removed > 0);
    assert!(frame.boosts() > 1 && window.inlet().deficit != 0.0);
    let mass = ledger.fed.mass / window.sample().cross_section() / window.sample().mean_density();
    let per_period = window.sample().period();
    assert!((mass - window.fed_length()).abs() < per_period, "what is fed is the medium: {mass}");
}

#[test]
fn the_ledger_closes_in_plane_strain() {
    the_ledger_closes::<Dim2>([8, 8, 1], 150.0);
}

#[test]
fn the_ledger_closes_in_space() {
    the_ledger_closes::<Dim3>([8, 6, 6], 60.0);
}

#[test]
fn a_restored_window_makes_the_same_steps() {
    let sample = || slit::<Dim2>([8, 8, 1]);
    let settings = settings(60.0 * SIZE);
    let advance = |window: &mut Window<Dim2>, steps| (0..steps).for_each(|_| assert!(window.step().is_ok()));
    let mut straight = window(sample(), settings);
    advance(&mut straight, 1000);
    // In the middle of the life of a neighbor list, and once more a few steps later.
    for stop in [500, 503] {
        let mut stopped = window(sample(), settings);
        advance(&mut stopped, stop);
        let saved = ron::from_str(&ron::to_string(&stopped.save()).unwrap()).unwrap();
        let particles = stopped.simulation().particles().clone();
        let lists = stopped.simulation().list_positions();
        let mut resumed =
            Window::restore(sample(), vec![copper()], solver(), settings, saved, particles, lists).unwrap();
        advance(&mut resumed, 1000 - stop);
        assert!(straight.frame().boosts() > 0);
        assert_eq!(straight.save(), resumed.save());
        assert!(straight.simulation().particles() == resumed.simulation().particles(), "bit for bit");
    }
}
