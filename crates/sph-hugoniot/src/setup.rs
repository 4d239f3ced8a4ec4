//! Case → what the window wants: the repeated sample and the window's settings.

use glam::DVec2;
use sph_core::{Dim2, Domain, Particles};
use sph_window::{
    FeedSample, FrameTracking, PlateauMargins, RegionWidths, Search, WindowError, WindowSettings,
};

use crate::config::Case;
use crate::microstructure::Sample;

/// The sample as the window repeats it.
///
/// # Errors
/// If the sample cannot be fed: see [`FeedSample::new`].
pub fn feed_sample(sample: &Sample) -> Result<FeedSample<Dim2>, WindowError> {
    let mut particles = Particles::default();
    sample.particles.iter().for_each(|&p| particles.push(p));
    let cell = Domain::new(DVec2::ZERO, DVec2::new(sample.cell, sample.height), [true, true]);
    FeedSample::new(particles, cell)
}

/// Settings of the window for one u_p [m/s].
pub fn window_settings(case: &Case, particle_velocity: f64) -> WindowSettings {
    let (window, size) = (&case.window, case.medium.particle_size);
    let cell = case.medium.cell / size;
    let length = window.cells_at(particle_velocity) as f64 * case.medium.cell;
    WindowSettings {
        front_place: window.front_place,
        regions: RegionWidths {
            inlet: window.region_width,
            outlet_velocity: window.region_width,
            outlet_frozen: window.region_width,
        },
        inlet: window.inlet,
        search: search(case.search, cell),
        block: cell,
        plateau: margins(window.front_place * length / size - 2.0 * window.region_width),
        ..WindowSettings::new(length, particle_velocity)
    }
}

/// The search, with boosts once a cell of so many particle sizes.
fn search(search: Search, cell: f64) -> Search {
    match search {
        Search::FrameTracking(tracking) => {
            Search::FrameTracking(FrameTracking { interval: cell, ..tracking })
        }
        other => other,
    }
}

/// What is left out of a plateau of `length` particle sizes between outlet and front: the front's own width, about two
/// cells at D = 1 µm, and the layer that feels the outlet; less where the window is short.
pub(crate) fn margins(length: f64) -> PlateauMargins {
    PlateauMargins { front: (0.45 * length).min(40.0), outlet: (0.15 * length).min(10.0) }
}
