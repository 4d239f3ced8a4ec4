//! The time step and its reason.
//!
//! τ = C min D/(c_l + |U_rel|): c_l of the current state, U_rel the largest speed relative to a neighbor in the last step
//! (paper: no time step is given; the Courant number bounds it).

use std::fmt;

use rayon::prelude::*;

use sph_core::lanes::{LANES, Line};
use sph_core::neighbors::TILE;
use sph_core::particles::Particles;

use crate::dimension::SolidDimension;
use crate::record::Row;

/// Why a step was as long as it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeStepReason {
    /// The Courant condition of a particle.
    Courant {
        /// Its id.
        particle: u64,
        /// Its longitudinal sound speed [m/s].
        sound_speed: f64,
        /// Its largest speed relative to a neighbor [m/s].
        relative_speed: f64,
    },
    /// The caller's limit.
    Limit,
}

impl fmt::Display for TimeStepReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Courant { particle, sound_speed, relative_speed } => write!(
                f,
                "Courant condition of particle {particle}: sound speed {sound_speed:.0} m/s, largest speed relative to a \
                 neighbor {relative_speed:.0} m/s"
            ),
            Self::Limit => f.write_str("the caller's limit"),
        }
    }
}

/// The largest step [s] that the Courant number allows, and its reason. `scratch` has one entry a tile.
pub fn courant_step<D: SolidDimension>(
    particles: &Particles<D>,
    rows: &[Line],
    courant: f64,
    scratch: &mut [(f64, u32)],
) -> (f64, TimeStepReason) {
    let sound_speed = |i: usize| {
        let rows = &rows[i / LANES * Row::count::<D>()..];
        rows[Row::LONGITUDINAL].0[i % LANES] * rows[Row::INVERSE_DENSITY].0[i % LANES]
    };
    let step = |i: usize| particles.size[i] / (sound_speed(i) + particles.relative_speed[i]);
    scratch.par_iter_mut().enumerate().for_each(|(t, least)| {
        let end = ((t + 1) * TILE).min(particles.len());
        // A NaN must win: it is an error to be seen.
        let smaller = |a: (f64, u32), i: usize| if step(i) >= a.0 { a } else { (step(i), i as u32) };
        *least = (t * TILE..end).fold((f64::INFINITY, 0), smaller);
    });
    let (step, i) = scratch.iter().fold((f64::INFINITY, 0), |a, &b| if b.0 >= a.0 { a } else { b });
    let i = i as usize;
    let reason = TimeStepReason::Courant {
        particle: particles.id.get(i).copied().unwrap_or(0),
        sound_speed: if particles.is_empty() { 0.0 } else { sound_speed(i) },
        relative_speed: particles.relative_speed.get(i).copied().unwrap_or(0.0),
    };
    (courant * step, reason)
}

/// Signal speed c_l + |U_rel| [m/s] of a Courant reason; zero for a limit.
pub fn signal_speed(reason: TimeStepReason) -> f64 {
    match reason {
        TimeStepReason::Courant { sound_speed, relative_speed, .. } => sound_speed + relative_speed,
        TimeStepReason::Limit => 0.0,
    }
}
