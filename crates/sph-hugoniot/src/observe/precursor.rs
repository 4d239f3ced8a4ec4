//! The elastic precursor, on its first way through the window.
//!
//! At the start the medium ahead is at rest and without stress. Until the precursor comes to the inlet (which reflects it,
//! unless it is matched) its own state and speed can be read: the velocity u_e that it gives to the matter, from the
//! stretch between the compaction front and its own foot; its speed D_e, from the way of the place where the velocity is
//! half of u_e; stress, density and energy, from the same stretch.
//!
//! In a porous medium the precursor is a ramp that spreads, so that D_e belongs to its middle and is not the speed of its
//! foot, and the jump conditions, which are those of a steady wave, are missed by what the ramp gains in length.
//!
//! All velocities are relative to the undisturbed medium; places are those in the medium, X = X_fed + x.

use serde::{Deserialize, Serialize};
use sph_core::Dim2;
use sph_materials::jump::JumpResiduals;
use sph_materials::{Jump, ShockState};
use sph_window::Window;

use super::profile::{FrontProfile, ProfileGrid};
use super::states::MeanState;

/// Part of the speed behind it that says that the precursor has come to a place.
const FOOT: f64 = 0.1;
/// Distance from the inlet at which it counts as arrived: a slow window is looked at seldom, and the inlet stops the matter
/// again [cells].
const NEAR: f64 = 4.0;
/// Distance of the stretch that is read from the front and from the precursor's middle [cells].
const MARGIN: f64 = 1.5;

/// What was read of the precursor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Precursor {
    /// Speed D_e of its middle [m/s].
    pub speed: f64,
    /// The state behind it.
    pub behind: MeanState,
}

impl Precursor {
    /// What the jump conditions are missed by, with undisturbed medium of a density [kg/m³] ahead.
    pub fn residuals(&self, bulk_density: f64) -> JumpResiduals {
        let behind = self.behind.as_shock_state();
        Jump { ahead: ShockState::at_rest(bulk_density), behind, wave_speed: self.speed }.residuals()
    }
}

/// One look at the velocities along x.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Look {
    time: f64,
    /// Swept length minus place in the box [m].
    fed: f64,
    front: f64,
    velocities: Vec<f64>,
}

/// Watches the precursor until it comes to the inlet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PrecursorWatch {
    spacing: f64,
    looks: Vec<Look>,
    found: Option<Precursor>,
    over: bool,
}

impl PrecursorWatch {
    /// The precursor, once it has come to the inlet.
    pub fn found(&self) -> Option<Precursor> {
        self.found
    }

    /// True while the precursor is under way.
    pub fn is_watching(&self) -> bool {
        !self.over
    }

    /// Takes the window's present state in. The medium's cell is `cell` long [m].
    pub fn observe(&mut self, window: &Window<Dim2>, cell: f64) {
        let Some(front) = window.front_position() else { return };
        let profile = window.profile();
        self.spacing = profile.spacing();
        let velocities: Vec<f64> =
            (0..profile.len()).map(|n| profile.around(n).velocity() + window.inlet_velocity()).collect();
        let look = Look { time: window.time(), fed: window.fed_length(), front, velocities };
        let behind = self.value(&look, front + MARGIN * cell);
        let near = window.regions().inlet_start - (NEAR * cell).min(0.3 * window.regions().length);
        let nodes = look.velocities.get((near / self.spacing) as usize..).unwrap_or_default();
        let arrived = nodes.iter().any(|&u| u > FOOT * behind);
        if arrived && behind > 0.0 {
            self.finish(window, cell);
        } else {
            self.looks.push(look);
        }
    }

    fn value(&self, look: &Look, place: f64) -> f64 {
        look.velocities.get((place / self.spacing).round() as usize).copied().unwrap_or(0.0)
    }

    /// Rightmost place where the velocity is above a level [m].
    fn crossing(&self, look: &Look, level: f64) -> Option<f64> {
        let u = &look.velocities;
        let node = u.iter().rposition(|&u| u >= level).filter(|&n| n + 1 < u.len())?;
        let part = (u[node] - level) / (u[node] - u[node + 1]);
        Some((node as f64 + part) * self.spacing)
    }

    /// The precursor has come to the inlet: its state, from the present look, and its speed, from all.
    fn finish(&mut self, window: &Window<Dim2>, cell: f64) {
        self.over = true;
        self.found = self.read(window, cell);
        self.looks = Vec::new();
    }

    fn read(&self, window: &Window<Dim2>, cell: f64) -> Option<Precursor> {
        let last = self.looks.last()?;
        // The velocity right ahead of the front is a first guess of u_e; its middle bounds the stretch that is read.
        let guess = self.value(last, last.front + MARGIN * cell);
        let middle = self.crossing(last, 0.5 * guess)?;
        let (from, to) = (MARGIN * cell, middle - MARGIN * cell - last.front);
        let regions = window.regions();
        let mut profile =
            FrontProfile::new(ProfileGrid::new(0.5 * cell, regions.length), window.sample().cross_section());
        profile.observe(window, last.front, 1.0);
        let behind: MeanState = profile.between(from, to)?.into();
        Some(Precursor { speed: self.speed(last, 0.5 * behind.velocity)?, behind })
    }

    /// Slope of the place of a level against time, over the second half of its way [m/s].
    fn speed(&self, last: &Look, level: f64) -> Option<f64> {
        let places: Vec<(f64, f64)> = self
            .looks
            .iter()
            .filter_map(|look| Some((look.time - last.time, self.crossing(look, level)? + look.fed)))
            .collect();
        let late = &places[places.len() / 2..];
        let n = late.len() as f64;
        let (mean_t, mean_x) = late.iter().fold((0.0, 0.0), |s, p| (s.0 + p.0 / n, s.1 + p.1 / n));
        let (product, square) = late
            .iter()
            .fold((0.0, 0.0), |s, p| (s.0 + (p.0 - mean_t) * (p.1 - mean_x), s.1 + (p.0 - mean_t).powi(2)));
        (late.len() >= 3 && square > 0.0).then(|| product / square)
    }
}
