//! The frame of reference of the window.
//!
//! The medium ahead moves with `-u_in`, the outlet with `-u_out`; their difference
//! `u_p = u_in - u_out` alone is physics. Adding one velocity `w` to everything (all particles and both
//! imposed velocities) is a change of frame and disturbs nothing: `u_in → u_in - w`. Changing
//! `u_out` alone would send a wave through the box.

use serde::{Deserialize, Serialize};

/// Velocities that the frame fixes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    particle_velocity: f64,
    inlet_velocity: f64,
    boosted: f64,
    boosts: u64,
}

impl Frame {
    /// A frame in which the medium ahead streams with `inlet_velocity` [m/s] towards -x and a piston follows it with
    /// the `particle_velocity` [m/s] relative to it.
    pub fn new(particle_velocity: f64, inlet_velocity: f64) -> Self {
        Self { particle_velocity, inlet_velocity, boosted: 0.0, boosts: 0 }
    }

    /// `u_p` [m/s].
    pub fn particle_velocity(&self) -> f64 {
        self.particle_velocity
    }

    /// `u_in` [m/s]: the undisturbed medium moves with its negative.
    pub fn inlet_velocity(&self) -> f64 {
        self.inlet_velocity
    }

    /// `u_out = u_in - u_p` [m/s]: the outlet moves with its negative.
    pub fn outlet_velocity(&self) -> f64 {
        self.inlet_velocity - self.particle_velocity
    }

    /// Sum of all boosts [m/s].
    pub fn boosted(&self) -> f64 {
        self.boosted
    }

    /// Number of boosts.
    pub fn boosts(&self) -> u64 {
        self.boosts
    }

    /// Books a velocity [m/s] that is added to everything along x.
    pub fn boost(&mut self, velocity: f64) {
        self.inlet_velocity -= velocity;
        self.boosted += velocity;
        self.boosts += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_boost_keeps_the_particle_velocity() {
        let mut frame = Frame::new(250.0, 300.0);
        for w in [-600.0, 33.3, 1e-3] {
            frame.boost(w);
        }
        assert_eq!(frame.particle_velocity(), 250.0);
        assert!((frame.inlet_velocity() - (300.0 - frame.boosted())).abs() < 1e-9);
        assert!((frame.inlet_velocity() - frame.outlet_velocity() - 250.0).abs() < 1e-12);
        assert_eq!(frame.boosts(), 3);
    }
}
