//! The elastic precursor, on its first way through the window.
//!
//! At the start the medium ahead is at rest and without stress. Until the precursor comes to the inlet (which reflects it,
//! unless it is matched) it can be read. In a porous medium it is no step: matter yields at the walls of the pores first,
//! so that the wave is a **ramp that spreads**. It is read level by level, in the way of Lagrangian gauges: the level u of
//! the particle velocity runs through the matter with
//!
//! ```text
//! c(u) = (w(u) - u)/(1 - ε(u)),      ε(u) = 1 - ρ00/ρ = ∫₀ᵘ du'/c
//! ```
//!
//! where w is its speed in the undisturbed medium's frame: the slope of its place against time. The conservation laws of
//! a ramp follow from its levels; σ is counted positive in compression here:
//!
//! ```text
//! σ(u) = ρ00 ∫₀ᵘ c du',      e(u) = (1/ρ00) ∫₀ᵘ (σ/c) du'
//! ```
//!
//! The first of them is exact at any moment, steady or not; the others hold where levels keep their speed. With one speed
//! for all levels they are the jump conditions of a steady wave. The state behind is read two cells ahead of the compaction
//! front, where that front is not felt yet, and compared with them: the three residuals.
//!
//! Source: R. Fowles & R. F. Williams, J. Appl. Phys. 41 (1970) 360, for the analysis of waves by their phase velocities.

use serde::{Deserialize, Serialize};
use sph_core::Dim2;
use sph_materials::jump::JumpResiduals;
use sph_window::Window;

use super::profile::{FrontProfile, ProfileGrid};
use super::states::MeanState;

/// Levels that the rise is cut into.
const LEVELS: usize = 8;
/// Part of the speed behind it that says that the precursor has come to a place.
const FOOT: f64 = 0.1;
/// Distance from the inlet at which it counts as arrived: the inlet stops the matter [cells], and as a part of the window.
const NEAR: (f64, f64) = (4.0, 0.3);
/// Distance ahead of the front where the state behind the precursor is read [cells].
const BEHIND: f64 = 2.0;
/// Least distance between that place and the precursor's foot [cells].
const ROOM: f64 = 1.5;
/// Part of the looks, the last ones, that speeds are taken from, and how many at least.
const LATE: (f64, usize) = (0.4, 4);
/// Looks that are kept at the most.
const MOST: usize = 2000;

/// What was read of the precursor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Precursor {
    /// Speed relative to the matter, mean over its rise [m/s].
    pub speed: f64,
    /// Speed of its foot, the lowest level [m/s].
    pub foot_speed: f64,
    /// The state behind it; velocities relative to the undisturbed medium.
    pub behind: MeanState,
    /// Speeds c of the levels (k + ½)/8 of the velocity behind [m/s].
    pub level_speeds: [f64; LEVELS],
}

impl Precursor {
    /// What the conservation laws of the ramp are missed by, with undisturbed medium of a density [kg/m³] ahead.
    pub fn residuals(&self, bulk_density: f64) -> JumpResiduals {
        let behind = self.behind.as_shock_state();
        let u = behind.particle_velocity;
        let du = u / LEVELS as f64;
        let (mut stress, mut strain, mut energy) = (0.0, 0.0, 0.0);
        for c in self.level_speeds {
            energy += (stress / c + 0.5 * bulk_density * du) * du / bulk_density;
            stress += bulk_density * c * du;
            strain += du / c;
        }
        JumpResiduals {
            mass: behind.density * (1.0 - strain) / bulk_density - 1.0,
            momentum: 1.0 + stress / behind.longitudinal_stress,
            energy: (behind.specific_internal_energy - energy) / (energy + 0.5 * u * u),
        }
    }
}

/// One look along x: means over a cell, half a cell apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Look {
    time: f64,
    /// Length fed [m].
    fed: f64,
    front: f64,
    /// Middle of the first mean, and their distance [m].
    first: f64,
    spacing: f64,
    means: Vec<MeanState>,
}

/// Watches the precursor until it comes to the inlet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct PrecursorWatch {
    looks: Vec<Look>,
    end: Option<Result<Precursor, String>>,
}

impl PrecursorWatch {
    /// The precursor, once it has come to the inlet.
    pub fn found(&self) -> Option<Precursor> {
        self.end.as_ref().and_then(|end| end.as_ref().ok().copied())
    }

    /// Why there is none.
    pub fn missing(&self) -> Option<String> {
        match &self.end {
            None => Some("the point ended before it had passed".into()),
            Some(end) => end.as_ref().err().cloned(),
        }
    }

    /// True while the precursor is under way.
    pub fn is_watching(&self) -> bool {
        self.end.is_none()
    }

    /// Takes the window's present state in. The medium's cell is `cell` long [m].
    pub fn observe(&mut self, window: &Window<Dim2>, cell: f64) {
        let Some(look) = Look::of(window, cell) else { return };
        let regions = window.regions();
        let end = regions.inlet_start - (NEAR.0 * cell).min(NEAR.1 * regions.length);
        self.take(look, cell, end);
    }

    /// Takes a look in; the precursor has passed when its foot is at `end` [m].
    fn take(&mut self, look: Look, cell: f64, end: f64) {
        let behind = look.front + BEHIND * cell;
        let foot = look.at(behind).and_then(|state| look.crossing(FOOT * state.velocity));
        self.looks.push(look);
        if behind >= end || foot.is_some_and(|foot| foot >= end) || self.looks.len() >= MOST {
            self.end = Some(read(&self.looks, cell));
            self.looks = Vec::new();
        }
    }
}

impl Look {
    fn of(window: &Window<Dim2>, cell: f64) -> Option<Self> {
        let front = window.front_position()?;
        let half = 0.5 * cell;
        let count = (window.regions().length / half).ceil() as usize;
        let grid = ProfileGrid { bin: half, behind: 0, ahead: count };
        let mut profile = FrontProfile::new(grid, window.sample().cross_section());
        profile.observe(window, 0.0, 1.0);
        let (low, high) = profile.range();
        let nodes = ((high - low) / half - 0.5).max(0.0) as usize;
        let mean = |k: usize| profile.between(low + k as f64 * half, low + k as f64 * half + cell);
        let means: Vec<MeanState> = (0..nodes).map_while(mean).map(MeanState::from).collect();
        let (time, fed) = (window.time(), window.fed_length());
        Some(Self { time, fed, front, first: low + half, spacing: half, means })
    }

    /// The state at a place in the box [m], between the two nearest means.
    fn at(&self, place: f64) -> Option<MeanState> {
        let index = (place - self.first) / self.spacing;
        let node = index.floor().max(0.0) as usize;
        let (a, b) = (self.means.get(node)?, self.means.get(node + 1)?);
        Some(a.toward(b, (index - node as f64).clamp(0.0, 1.0)))
    }

    /// Rightmost place in the box where the velocity falls through a level [m].
    fn crossing(&self, level: f64) -> Option<f64> {
        let u = |n: usize| self.means[n].velocity;
        let node =
            (0..self.means.len().saturating_sub(1)).rev().find(|&n| u(n) >= level && u(n + 1) < level)?;
        let part = (u(node) - level) / (u(node) - u(node + 1));
        (level > 0.0).then_some(self.first + (node as f64 + part) * self.spacing)
    }
}

/// The precursor from all looks, or why it cannot be read.
fn read(looks: &[Look], cell: f64) -> Result<Precursor, String> {
    let count = ((LATE.0 * looks.len() as f64) as usize).max(LATE.1);
    let late = looks
        .get(looks.len().saturating_sub(count)..)
        .filter(|late| late.len() >= LATE.1)
        .ok_or_else(|| format!("it passed within {} looks", looks.len()))?;
    let middle = &late[late.len() / 2];
    let place = middle.front + BEHIND * cell;
    let behind = middle.at(place).ok_or("the front was too near to the inlet")?;
    let room = middle.crossing(FOOT * behind.velocity).map_or(0.0, |foot| (foot - place) / cell);
    if room < ROOM {
        return Err(format!(
            "its foot had left the front by {:.1} cells only when it came to the inlet: a longer window; if that does not \
             help the front is as fast as it is",
            room + BEHIND
        ));
    }
    let level_speeds = level_speeds(late, behind.velocity)?;
    let speed = level_speeds.iter().sum::<f64>() / LEVELS as f64;
    Ok(Precursor { speed, foot_speed: level_speeds[0], behind, level_speeds })
}

/// c of each level of a rise to `velocity` [m/s].
fn level_speeds(late: &[Look], velocity: f64) -> Result<[f64; LEVELS], String> {
    let du = velocity / LEVELS as f64;
    let (mut speeds, mut strain) = ([0.0; LEVELS], 0.0);
    for (k, speed) in speeds.iter_mut().enumerate() {
        let level = (k as f64 + 0.5) * du;
        let way: Option<Vec<(f64, f64)>> =
            late.iter().map(|look| Some((look.time, look.crossing(level)? + look.fed))).collect();
        let way = way.ok_or_else(|| format!("its level of {level:.1} m/s was not there all the time"))?;
        // The strain up to the level itself, with the speed of the one below for the last half step.
        *speed = (slope(&way) - level) / (1.0 - strain);
        if *speed <= 0.0 || !speed.is_finite() {
            return Err(format!("its level of {level:.1} m/s does not run ahead"));
        }
        strain += du / *speed;
    }
    Ok(speeds)
}

/// Slope of the straight line through places [m] over times [s].
fn slope(way: &[(f64, f64)]) -> f64 {
    let n = way.len() as f64;
    let (t, x) = way.iter().fold((0.0, 0.0), |s, p| (s.0 + p.0 / n, s.1 + p.1 / n));
    let (product, square) =
        way.iter().fold((0.0, 0.0), |s, p| (s.0 + (p.0 - t) * (p.1 - x), s.1 + (p.0 - t).powi(2)));
    product / square
}

#[cfg(test)]
mod tests {
    use super::*;

    const DENSITY: f64 = 6637.0;
    const CELL: f64 = 2e-5;
    /// Velocity behind the precursor, and of the compaction wave and its matter [m/s].
    const BEHIND_U: f64 = 12.0;
    const SHOCK: (f64, f64) = (400.0, 100.0);

    /// A centered ramp whose levels run with speeds that fall from `foot` to `top` [m/s], at a time [s].
    fn look(time: f64, foot: f64, top: f64) -> Look {
        let front = SHOCK.0 * time;
        // Speeds in the laboratory; the matter of a level has run (strain) x back in the mean.
        let state = |x: f64| {
            let u = if x < front {
                SHOCK.1
            } else {
                // Invert w(u) = x/t on a table of levels.
                let table = ramp(foot, top);
                table.iter().rev().find(|level| level.w >= x / time).map_or(0.0, |level| level.u)
            };
            let table = ramp(foot, top);
            let level = table.iter().rev().find(|level| level.u <= u.min(BEHIND_U)).copied().unwrap_or(REST);
            MeanState {
                packing_density: DENSITY / (1.0 - level.strain),
                own_density: 8960.0,
                stress: -level.stress,
                pressure: level.stress,
                velocity: u,
                internal_energy: level.energy,
                fluctuation_energy: 0.0,
                fluctuation_stress: 0.0,
                fluctuation_energy_flux: 0.0,
            }
        };
        let means = (0..48).map(|k| state((k as f64 + 0.5) * 0.5 * CELL)).collect();
        Look { time, fed: 0.0, front, first: 0.25 * CELL, spacing: 0.5 * CELL, means }
    }

    const REST: Level = Level { u: 0.0, w: 0.0, strain: 0.0, stress: 0.0, energy: 0.0 };

    #[derive(Clone, Copy)]
    struct Level {
        u: f64,
        w: f64,
        strain: f64,
        stress: f64,
        energy: f64,
    }

    /// The ramp by small steps of u: c(u) falls linearly.
    fn ramp(foot: f64, top: f64) -> Vec<Level> {
        const STEPS: usize = 2000;
        let du = BEHIND_U / STEPS as f64;
        let mut level = REST;
        (0..STEPS)
            .map(|k| {
                let c = foot + (top - foot) * (k as f64 + 0.5) / STEPS as f64;
                level.energy += (level.stress / c + 0.5 * DENSITY * du) * du / DENSITY;
                level.stress += DENSITY * c * du;
                level.strain += du / c;
                level.u += du;
                level.w = level.u + c * (1.0 - level.strain);
                level
            })
            .collect()
    }

    fn watched(foot: f64, top: f64) -> PrecursorWatch {
        let mut watch = PrecursorWatch::default();
        for k in 1..600 {
            if watch.is_watching() {
                watch.take(look(2e-9 * f64::from(k), foot, top), CELL, 4e-4);
            }
        }
        watch
    }

    #[test]
    fn a_spreading_ramp_obeys_the_conservation_laws_of_its_levels() {
        let watch = watched(2700.0, 1300.0);
        let found = watch.found().unwrap_or_else(|| panic!("{:?}", watch.missing()));
        println!("{found:?}");
        let residuals = found.residuals(DENSITY);
        assert!(residuals.worst() < 0.02, "{residuals:?}");
        assert!((found.foot_speed / 2650.0 - 1.0).abs() < 0.02, "{found:?}");
        assert!((found.behind.velocity - BEHIND_U).abs() < 1e-9);
        // One speed for all levels would miss the energy: the check is no identity.
        let steady = Precursor { level_speeds: [found.speed; LEVELS], ..found };
        assert!(steady.residuals(DENSITY).energy.abs() > 2.0 * residuals.energy.abs());
    }

    #[test]
    fn levels_of_one_speed_give_the_jump_conditions() {
        use sph_materials::{Jump, ShockState};
        let behind = MeanState { velocity: 12.0, ..look(1e-7, 2600.0, 2500.0).means[12] };
        let steady = Precursor { speed: 2550.0, foot_speed: 2550.0, behind, level_speeds: [2550.0; LEVELS] };
        let ramp = steady.residuals(DENSITY);
        let ahead = ShockState::at_rest(DENSITY);
        let jump = Jump { ahead, behind: behind.as_shock_state(), wave_speed: 2550.0 }.residuals();
        assert!((ramp.mass - jump.mass).abs() < 1e-4, "{ramp:?} {jump:?}");
        assert!((ramp.momentum - jump.momentum).abs() < 1e-4, "{ramp:?} {jump:?}");
    }

    #[test]
    fn what_cannot_be_read_says_why() {
        let fast = watched(470.0, 430.0);
        assert!(fast.found().is_none());
        assert!(fast.missing().unwrap().contains("a longer window"), "{:?}", fast.missing());
        assert!(PrecursorWatch::default().missing().unwrap().contains("ended before"));
    }
}
