//! Solid copper in the window against the exact waves of a piston: elastic precursor and plastic wave.

mod common;

use common::{SIZE, copper, solid, window};
use sph_core::Dim2;
use sph_materials::hugoniot::{PistonWaves, piston};
use sph_window::{InletKind, Window, WindowSettings};

/// Way of the precursor through the medium [m] at this moment: half its velocity jump, coming from the right.
fn precursor_way(window: &Window<Dim2>, velocity: f64) -> Option<f64> {
    let level = -window.ahead_velocity() + 0.5 * velocity;
    Some(window.fed_length() + window.profile().rightmost_crossing(level)?)
}

/// The precursor runs ahead of the plastic front, which the window follows, until it nears the inlet.
fn both_waves_are_exact(particle_velocity: f64) {
    let PistonWaves::TwoWave { precursor, plastic } = piston(&copper(), particle_velocity).unwrap() else {
        panic!("two waves expected")
    };
    let settings =
        WindowSettings { front_place: 0.3, ..WindowSettings::new(220.0 * SIZE, particle_velocity) };
    let mut window = window(solid::<Dim2>([10, 4, 1]), settings);
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
        if way - window.fed_length() > 200.0 * SIZE {
            break;
        }
    }
    let first: (f64, f64) = first.expect("the front came to its place before the precursor left");
    let precursor_speed = (last.1 - first.1) / (last.0 - first.0);
    let plastic_speed = window.shock_velocity().unwrap();
    println!(
        "u_p {particle_velocity}: precursor {precursor_speed:.1} ({:.1}), plastic {:.1} ± {:.1} ({:.1}) m/s, \
         {} steps, ledger {:.1e}",
        precursor.wave_speed,
        plastic_speed.velocity,
        plastic_speed.standard_error,
        plastic.wave_speed,
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

/// An impedance-matched inlet lets the precursor out and goes on to feed a medium in the state behind it: the window sees
/// the plastic wave alone, of the same piston.
#[test]
fn the_precursor_leaves_through_a_matched_inlet() {
    let total = 200.0;
    let PistonWaves::TwoWave { precursor, plastic } = piston(&copper(), total).unwrap() else {
        panic!("two waves expected")
    };
    let inlet = InletKind::ImpedanceMatched { wave_speed: None };
    let settings = WindowSettings { inlet, ..WindowSettings::new(120.0 * SIZE, total) };
    let mut window = window(solid::<Dim2>([10, 4, 1]), settings);
    while window.fed_length() < 2500.0 * SIZE {
        window.step().unwrap();
    }
    let (shock, state) = (window.shock_velocity().unwrap(), plastic.ahead);
    let (from, to) = window.ahead().unwrap();
    let ahead = window.profile().between(from, to);
    // The window counts lengths of the undisturbed medium: mass flux over ρ00.
    let exact = plastic.shock_velocity() * state.density / copper().reference_density;
    println!(
        "deficit {:.2} ({:.2}) m/s, ahead {:.4e} ({:.4e}) Pa, {:.2} ({:.2}) kg/m³; u_s {:.1} ± {:.1} ({exact:.1}) m/s",
        window.inlet().deficit,
        state.particle_velocity,
        ahead.stress(),
        state.longitudinal_stress,
        ahead.packing_density(),
        state.density,
        shock.velocity,
        shock.standard_error,
    );
    let off = |measured: f64, exact: f64| (measured / exact - 1.0).abs();
    assert!(off(window.inlet().deficit, precursor.behind.particle_velocity) < 0.05);
    assert!(off(-ahead.velocity(), window.ahead_velocity()) < 1e-3);
    assert!(off(shock.velocity, exact) < 5e-3);
}
