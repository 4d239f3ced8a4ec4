//! Solid copper in the window against the exact waves of a piston: elastic precursor and plastic wave.

mod common;

use common::{SIZE, copper, solid, window};
use sph_core::Dim2;
use sph_materials::hugoniot::{PistonWaves, piston};
use sph_window::{InletKind, Window, WindowSettings};

/// Way of the precursor through the medium [m] at this moment: half its velocity jump, coming from the right.
fn precursor_way(window: &Window<Dim2>, velocity: f64) -> Option<f64> {
    let level = -window.inlet_velocity() + 0.5 * velocity;
    Some(window.fed_length() + window.profile().rightmost_crossing(level)?)
}

/// The precursor runs ahead of the plastic front, which the window follows, until it nears the inlet.
fn both_waves_are_exact(particle_velocity: f64) {
    let PistonWaves::TwoWave { precursor, plastic } = piston(&copper(), particle_velocity).unwrap() else {
        panic!("two waves expected")
    };
    let settings =
        WindowSettings { front_place: 0.3, ..WindowSettings::new(260.0 * SIZE, particle_velocity) };
    let mut window = window(solid::<Dim2>([10, 6, 1]), settings);
    let (mut first, mut last) = (None, (0.0, 0.0));
    loop {
        if window.step().unwrap().observation.is_none() {
            continue;
        }
        let way = precursor_way(&window, precursor.behind.particle_velocity).expect("a precursor");
        if window.is_settled() {
            first.get_or_insert((window.time(), way));
            last = (window.time(), way);
        }
        if way - window.fed_length() > 240.0 * SIZE {
            break;
        }
    }
    let first: (f64, f64) = first.expect("the front came to its place before the precursor left");
    let precursor_speed = (last.1 - first.1) / (last.0 - first.0);
    let plastic_speed = window.shock_velocity().unwrap();
    println!(
        "u_p {particle_velocity}: precursor {precursor_speed:.1} ({:.1}), plastic {:.1} ± {:.1} ({:.1}) m/s, \
         balance {:.1} m/s, {} steps, ledger {:.1e}",
        precursor.wave_speed,
        plastic_speed.velocity,
        plastic_speed.standard_error,
        plastic.wave_speed,
        window.mass_balance_velocity().unwrap_or(f64::NAN),
        window.steps(),
        window.ledger_residual(),
    );
    let off = |measured: f64, exact: f64| (measured / exact - 1.0).abs();
    assert!(off(precursor_speed, precursor.wave_speed) < 5e-3);
    assert!(off(plastic_speed.velocity, plastic.wave_speed) < 5e-3);
    assert!(window.ledger_residual() < 1e-12);
}

#[test]
fn both_waves_are_exact_at_100_m_per_s() {
    both_waves_are_exact(100.0);
}

#[test]
fn both_waves_are_exact_at_200_m_per_s() {
    both_waves_are_exact(200.0);
}

/// An impedance-matched inlet lets the precursor out: the medium that is then fed moves with the precursor's velocity,
/// and the window sees the plastic wave alone.
#[test]
fn the_precursor_leaves_through_a_matched_inlet() {
    let total = 200.0;
    let PistonWaves::TwoWave { precursor, plastic } = piston(&copper(), total).unwrap() else {
        panic!("two waves expected")
    };
    let settings = WindowSettings {
        front_place: 0.5,
        inlet: InletKind::ImpedanceMatched { wave_speed: None },
        ..WindowSettings::new(120.0 * SIZE, total)
    };
    let mut window = window(solid::<Dim2>([10, 6, 1]), settings);
    while window.fed_length() < 3000.0 * SIZE {
        window.step().unwrap();
    }
    let deficit = window.frame().inlet_velocity() - window.inlet_velocity();
    let shock = window.shock_velocity().unwrap();
    println!(
        "deficit {deficit:.2} ({:.2}), u_s {:.1} ± {:.1} ({:.1})",
        precursor.behind.particle_velocity,
        shock.velocity,
        shock.standard_error,
        plastic.shock_velocity()
    );
    assert!((deficit / precursor.behind.particle_velocity - 1.0).abs() < 0.05);
    assert!((shock.velocity / plastic.shock_velocity() - 1.0).abs() < 5e-3);
}
