//! A step that failed: told so that one knows where to look and what to change.
//!
//! The solver says which particle broke, where, after which stage, when, and what limited the step. Here the place is
//! put beside the front and the ends of the window, the particle's neighborhood is written for ParaView, and the hint
//! is chosen by what broke.

use std::path::Path;

use sph_core::Dim2;
use sph_riemann::StepError;
use sph_window::{Window, WindowError};

use crate::config::Case;
use crate::paraview::Moment;

/// Name of the file with the neighborhood, in the point's folder.
pub const FILE: &str = "failure.vtp";
/// Half the edge of the neighborhood that is written [D].
const NEIGHBORHOOD: f64 = 15.0;
/// A particle this near to an end of the window is told to be there [D].
const END: f64 = 10.0;

/// The failure in full sentences; the neighborhood of what broke goes into `folder`, if there is one.
pub fn explain(window: &Window<Dim2>, error: &WindowError, case: &Case, folder: Option<&Path>) -> String {
    let mut words = error.to_string();
    let WindowError::Step(step) = error else { return words };
    if let Some(place) = place(window, step) {
        words += &format!("; it is {}", where_it_is(window, place, case.medium.particle_size));
        if let Some(folder) = folder {
            words += &write(window, place, case, folder);
        }
    }
    for hint in hints(step, window, case) {
        words += &format!("; {hint}");
    }
    words
}

/// Place of what broke [m]; `None` if it is nowhere.
fn place(window: &Window<Dim2>, error: &StepError) -> Option<[f64; 2]> {
    let particles = window.simulation().particles();
    let place = match error {
        StepError::Broken { position, .. } => [*position.first()?, *position.get(1)?],
        StepError::TimeStep { particle, .. } => {
            let i = particles.id.iter().position(|id| id == particle)?;
            [particles.position[0][i], particles.position[1][i]]
        }
        StepError::Particle(_) | StepError::Empty | StepError::Limit { .. } => return None,
    };
    place.iter().all(|x| x.is_finite()).then_some(place)
}

fn where_it_is(window: &Window<Dim2>, place: [f64; 2], particle_size: f64) -> String {
    let regions = window.regions();
    let near = |end: f64| (place[0] - end).abs() < END * particle_size;
    let end = match (near(regions.outlet_end), near(regions.inlet_start)) {
        (true, _) => ", at the outlet: a longer window moves it away from the front",
        (_, true) => ", at the inlet: a longer window moves it away from the front",
        _ => "",
    };
    match window.front_position() {
        Some(front) if place[0] < front => {
            format!("{:.1} µm behind the front{end}", 1e6 * (front - place[0]))
        }
        Some(front) => format!("{:.1} µm ahead of the front{end}", 1e6 * (place[0] - front)),
        None => format!("{:.1} µm from the left end of the window{end}", 1e6 * place[0]),
    }
}

/// Writes the neighborhood; says where, or why not.
fn write(window: &Window<Dim2>, place: [f64; 2], case: &Case, folder: &Path) -> String {
    let particles = window.simulation().particles();
    let (reach, period) = (NEIGHBORHOOD * case.medium.particle_size, window.sample().cell().period(1));
    let is_near = |i: usize| {
        let across = (particles.position[1][i] - place[1]).rem_euclid(period);
        let along = particles.position[0][i] - place[0];
        // What has no place any more is what one wants to see.
        !along.is_finite() || (along.abs() < reach && across.min(period - across) < reach)
    };
    let path = folder.join(FILE);
    match Moment::of(window, is_near).write(&path) {
        Ok(()) => format!("; its neighborhood, for ParaView: {}", path.display()),
        Err(error) => format!("; its neighborhood could not be written: {error}"),
    }
}

/// What to change, by what broke.
fn hints(error: &StepError, window: &Window<Dim2>, case: &Case) -> Vec<String> {
    let mut hints = Vec::new();
    let courant = case.scheme.courant;
    if courant > 0.5 {
        hints.push(format!("cfl is {courant}: the shipped cases use 0.4"));
    }
    if let StepError::Broken { particle, density, .. } = error {
        let particles = window.simulation().particles();
        let material = particles.id.iter().position(|id| id == particle).map(|i| particles.material[i]);
        let materials = window.simulation().materials();
        let solid = material.and_then(|m| materials.get(usize::from(m))).unwrap_or(&case.material);
        let part = density / solid.reference_density;
        if part < 0.8 {
            let percent = 100.0 * part;
            hints.push(format!(
                "its density has fallen to {percent:.0} % of the solid's, in tension: set tensile_strength, or a lower one"
            ));
        } else if part > 1.4 && part.is_finite() {
            hints.push(format!(
                "its density is {part:.1} times the solid's: is u_p within the equation of state?"
            ));
        }
    }
    hints
}
