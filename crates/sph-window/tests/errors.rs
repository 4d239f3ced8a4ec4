//! A front that cannot be kept in view is named.

mod common;

use common::{SIZE, copper, solid, solver, window};
use sph_core::Dim2;
use sph_window::{InletKind, Search, Window, WindowError, WindowSettings};

/// Steps until something fails.
fn failure(settings: WindowSettings) -> WindowError {
    let mut window = window(solid::<Dim2>([8, 4, 1]), settings);
    loop {
        if let Err(error) = window.step() {
            return error;
        }
        assert!(window.steps() < 20_000, "no failure");
    }
}

#[test]
fn a_front_that_runs_into_the_inlet_is_named() {
    let settings = WindowSettings { search: Search::FixedFrame, ..WindowSettings::new(60.0 * SIZE, 300.0) };
    let error = failure(settings);
    assert!(matches!(error, WindowError::FrontAtInlet { .. }), "{error}");
    assert!(error.to_string().contains("a longer box"), "{error}");
}

#[test]
fn a_front_that_never_leaves_the_outlet_is_named() {
    let error =
        failure(WindowSettings { inlet_velocity: Some(6000.0), ..WindowSettings::new(40.0 * SIZE, 300.0) });
    assert!(matches!(error, WindowError::FrontNotArrived { .. }), "{error}");
    assert!(error.to_string().contains("a smaller inlet velocity"), "{error}");
}

#[test]
fn a_matched_inlet_needs_room_for_what_it_reads() {
    let inlet = InletKind::ImpedanceMatched { wave_speed: None };
    let settings = WindowSettings { inlet, front_place: 0.6, ..WindowSettings::new(40.0 * SIZE, 300.0) };
    let error = Window::new(solid::<Dim2>([8, 4, 1]), vec![copper()], solver(), settings).err().unwrap();
    assert!(error.to_string().starts_with("front_place = 0.6"), "{error}");
}
