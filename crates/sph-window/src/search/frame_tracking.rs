//! Frame tracking: boost by the measured drift.
//!
//! In a frame where the front drifts with `v_f = u_s - u_b`, a boost of everything by `-v_f` stops it. When
//! the front first reaches the wanted place it is stopped outright. From then on, each time that it has swept an interval
//! of whole periods of the medium in a time `Δt`, the frame is boosted by
//!
//! ```text
//! w = -g v_f - p (x_f - x_w)/Δt
//! ```
//!
//! half of the measured drift (g = 0.5, since the drift over one period is noisy) and a weak pull (p = 0.1) towards the
//! wanted place `x_w`. The drift and place of one interval map to the next with the matrix `(1, 1; -p, 1-g-p)`,
//! whose eigenvalues have the modulus `√(1-g)` and little turn: it settles without ringing.
//!
//! This is ours; the published search, [`super::bisection`], is that of Rublev & Murzov, arXiv 2410.14646, section 3.1.

use serde::{Deserialize, Serialize};

/// Settings of frame tracking.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FrameTracking {
    /// Part g of the measured drift that a boost takes away [-].
    pub gain: f64,
    /// Part p of the distance to the wanted place that a boost undoes in one interval [-].
    pub pull: f64,
    /// Least swept length between boosts, in particle sizes [D]; rounded up to whole periods of the medium.
    pub interval: f64,
}

impl Default for FrameTracking {
    fn default() -> Self {
        Self { gain: 0.5, pull: 0.1, interval: 20.0 }
    }
}

/// One look at the front.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Observation {
    /// Time [s].
    pub time: f64,
    /// Place of the front in the box [m].
    pub front: f64,
    /// Length of the medium that the front has swept [m].
    pub swept: f64,
}

impl Observation {
    /// Shock velocity between an earlier observation and this one [m/s].
    fn velocity_since(&self, earlier: &Self) -> f64 {
        (self.swept - earlier.swept) / (self.time - earlier.time)
    }
}

/// What tracking wants and knows beside its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Target {
    /// Wanted place of the front [m].
    pub front: f64,
    /// Swept length between boosts, whole periods of the medium [m].
    pub interval: f64,
    /// Velocity `u_b` with which the medium comes in [m/s].
    pub inlet_velocity: f64,
}

/// State of frame tracking.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tracker {
    reference: Option<Observation>,
    halfway: bool,
    arrived: bool,
}

impl Tracker {
    /// True once the front has been at its wanted place.
    pub fn arrived(&self) -> bool {
        self.arrived
    }

    /// Takes an observation in and returns the velocity [m/s] to boost everything by, if a boost is due.
    pub(crate) fn observe(
        &mut self,
        now: &Observation,
        target: &Target,
        settings: &FrameTracking,
    ) -> Option<f64> {
        let Some(reference) = self.reference else {
            self.reference = Some(*now);
            return None;
        };
        if !self.arrived {
            return self.approach(now, &reference, target);
        }
        if now.swept - reference.swept < target.interval {
            return None;
        }
        self.reference = Some(*now);
        let drift = now.velocity_since(&reference) - target.inlet_velocity;
        let pull = (now.front - target.front) / (now.time - reference.time);
        Some(-settings.gain * drift - settings.pull * pull)
    }

    /// On the way to the wanted place: the speed is measured over the second half of it.
    fn approach(&mut self, now: &Observation, reference: &Observation, target: &Target) -> Option<f64> {
        if now.front >= target.front {
            self.arrived = true;
            self.reference = Some(*now);
            return Some(target.inlet_velocity - now.velocity_since(reference));
        }
        if !self.halfway && now.front - reference.front >= 0.5 * (target.front - reference.front) {
            self.halfway = true;
            self.reference = Some(*now);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A front of 940 m/s with noise in a box; returns the largest distance from the wanted place after settling, and
    /// the last inlet velocity.
    fn track(noise: f64) -> (f64, f64) {
        let (shock, wanted) = (940.0, 1.2e-4);
        let mut inlet_velocity = 250.0;
        let (mut tracker, settings) = (Tracker::default(), FrameTracking::default());
        let (mut front, mut swept, mut farthest) = (8e-6, 8e-6, 0.0_f64);
        for step in 0..40_000 {
            let time = step as f64 * 1e-10;
            let wiggle = noise * (0.37 * step as f64).sin();
            let now = Observation { time, front: front + wiggle, swept: swept + wiggle };
            let target = Target { front: wanted, interval: 2e-5, inlet_velocity };
            inlet_velocity -= tracker.observe(&now, &target, &settings).unwrap_or(0.0);
            if step > 20_000 {
                farthest = farthest.max((front - wanted).abs());
            }
            front += 1e-10 * (shock - inlet_velocity);
            swept += 1e-10 * shock;
        }
        assert!(tracker.arrived());
        (farthest, inlet_velocity)
    }

    #[test]
    fn the_front_is_brought_to_its_place_and_stays() {
        let (farthest, inlet_velocity) = track(0.0);
        assert!(farthest < 1e-8, "{farthest}");
        assert!((inlet_velocity - 940.0).abs() < 0.1, "{inlet_velocity}");
        let (farthest, inlet_velocity) = track(4e-7);
        assert!(farthest < 3e-6, "{farthest}");
        assert!((inlet_velocity - 940.0).abs() < 60.0, "{inlet_velocity}");
    }
}
