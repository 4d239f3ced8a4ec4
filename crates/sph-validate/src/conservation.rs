//! What must be conserved, and how much of it was lost.
//!
//! Each drift is the change over the run that nothing accounts for, over the size of the thing itself: mass over the
//! mass; momentum less the impulse of the constraints over Σ m |u|; energy less their work over the kinetic energy;
//! angular momentum over Σ m |r| |u|, and the two last at the moment when it is greater, start or end. e counts from
//! the reference state, so that the total energy may be zero and is no measure.
//!
//! Pairs exchange mass, momentum and energy with opposite signs, so that their drifts are round-off. Angular momentum
//! has no such guarantee: forces are not along the line between two particles. It applies to bodies in an open domain
//! without constraints.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::metric::{Measurement, Metric};

/// Relative drifts [-] of what must be conserved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Conservation {
    /// Of the mass.
    pub mass: f64,
    /// Of the momentum.
    pub momentum: f64,
    /// Of the energy.
    pub energy: f64,
    /// Of the angular momentum, where it applies.
    pub angular_momentum: Option<f64>,
}

impl Conservation {
    /// Figure of the mass.
    pub const MASS: Metric = Metric::drift("mass_drift");
    /// Figure of the momentum.
    pub const MOMENTUM: Metric = Metric::drift("momentum_drift");
    /// Figure of the energy.
    pub const ENERGY: Metric = Metric::drift("energy_drift");
    /// Figure of the angular momentum.
    pub const ANGULAR_MOMENTUM: Metric = Metric::drift("angular_momentum_drift");

    /// The drifts as figures of a run.
    pub fn measurements(&self) -> impl Iterator<Item = Measurement> {
        let always = [(Self::MASS, self.mass), (Self::MOMENTUM, self.momentum), (Self::ENERGY, self.energy)];
        let angular = self.angular_momentum.map(|drift| (Self::ANGULAR_MOMENTUM, drift));
        always.into_iter().chain(angular).map(|(metric, drift)| Measurement::error_of(metric, drift))
    }
}
