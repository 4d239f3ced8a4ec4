//! The frame is a gauge: any frame shows the same shock.

mod common;

use common::{SIZE, copper, medium, solver, window};
use sph_core::Dim2;
use sph_riemann::Settings;
use sph_window::{Estimate, FeedSample, FrameTracking, PlateauMargins, Search, Window, WindowSettings};
use std::collections::HashMap;

/// A porous strip: one square pore in each period.
fn porous() -> FeedSample<Dim2> {
    medium([12, 8, 1], |[x, y, _]| !((3.0..7.0).contains(&x) && (2.0..6.0).contains(&y)))
}

/// Places relative to a front of reference, velocities relative to the medium, densities and energies, by identifier.
fn picture(window: &Window<Dim2>, origin: f64) -> HashMap<u64, [f64; 6]> {
    let particles = window.simulation().particles();
    let picture = |i: usize| {
        let (position, velocity) = (particles.position_of(i), particles.velocity_of(i));
        let x = (position.x + window.fed_length() - origin) / SIZE;
        let u = velocity.x + window.inlet_velocity();
        [x, position.y / SIZE, u, velocity.y, particles.density[i], particles.specific_internal_energy[i]]
    };
    (0..particles.len()).map(|i| (particles.id[i], picture(i))).collect()
}

/// As long as no frame has exchanged particles at its ends, the steps differ by nothing but the frame.
#[test]
fn early_steps_are_the_same_in_any_frame_to_round_off() {
    let run = |inlet_velocity: f64, boosts: [f64; 2]| {
        let settings = WindowSettings {
            inlet_velocity: Some(inlet_velocity),
            search: Search::FixedFrame,
            exchange_drift: 3.9,
            ..WindowSettings::new(160.0 * SIZE, 250.0)
        };
        let solver = Settings { skin: Some(1.0), ..solver() };
        let mut window = Window::new(porous(), vec![copper()], solver, settings).unwrap();
        for boost in boosts {
            (0..12).for_each(|_| assert!(window.step().is_ok()));
            window.boost(boost);
        }
        (0..12).for_each(|_| assert!(window.step().is_ok()));
        assert_eq!(window.simulation().stage_times().rebuilds, 1);
        (window.time(), picture(&window, 0.0))
    };
    let (time, still) = run(250.0, [0.0, 0.0]);
    let compacted = still.values().filter(|p| p[2] > 100.0).count();
    assert!(compacted > 50, "{compacted}");
    for (inlet_velocity, boosts) in [(900.0, [0.0, 0.0]), (250.0, [-500.0, 333.3])] {
        let (other_time, moving) = run(inlet_velocity, boosts);
        assert!((other_time / time - 1.0).abs() < 1e-9);
        assert_eq!(still.len(), moving.len());
        for (id, a) in &still {
            let b = &moving[id];
            let scale = [1.0, 1.0, 250.0, 250.0, 8960.0, 31_250.0];
            let worst = (0..6).map(|k| (a[k] - b[k]).abs() / scale[k]).fold(0.0, f64::max);
            assert!(worst < 1e-9, "particle {id}: {a:?} {b:?}");
        }
    }
}

/// Different frames and boosts, the same piston: the same shock velocity within the scatter.
#[test]
fn the_shock_velocity_is_the_same_in_any_frame() {
    let run = |search: Search, inlet_velocity: f64, length: f64| {
        let settings = WindowSettings {
            inlet_velocity: Some(inlet_velocity),
            search,
            front_place: 0.5,
            plateau: PlateauMargins { front: 20.0, outlet: 6.0 },
            ..WindowSettings::new(length * SIZE, 300.0)
        };
        let mut window = window(porous(), settings);
        while window.blocks().len() < 24 {
            window.step().unwrap();
        }
        assert!(window.ledger_residual() < 1e-12);
        let last = window.blocks().split_off(12);
        (Estimate::from_blocks(last).unwrap(), window.mass_balance_velocity())
    };
    let fast = FrameTracking { gain: 1.0, pull: 0.05, ..FrameTracking::default() };
    let runs = [
        run(Search::FixedFrame, 500.0, 240.0),
        run(Search::FrameTracking(FrameTracking::default()), 300.0, 170.0),
        run(Search::FrameTracking(fast), 700.0, 170.0),
    ];
    let reference = &runs[0].0;
    for (estimate, balance) in &runs {
        println!(
            "u_s = {:.1} ± {:.1} m/s, balance {balance:.1?}",
            estimate.velocity, estimate.standard_error
        );
        let error = estimate.standard_error.hypot(reference.standard_error);
        assert!((estimate.velocity - reference.velocity).abs() < 3.0 * error);
        assert!((estimate.velocity / reference.velocity - 1.0).abs() < 0.01);
        if let Some(balance) = balance {
            assert!((estimate.velocity / balance - 1.0).abs() < 0.02, "mass balance: {balance}");
        }
    }
    assert!(runs[1].1.is_some() && runs[2].1.is_some(), "a front that stands has a plateau");
}
