//! How often the scheme stepped in: nothing that bounds a value acts in silence.
//!
//! Counts of particle-steps since the start. They are sums of whole numbers: the same for any number of threads.

use std::ops::AddAssign;

use serde::{Deserialize, Serialize};

/// Particle-steps in which a bound acted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interventions {
    /// The inverse of L met its cap ([`crate::SurfaceTreatment::SpectralCap`]): free surfaces.
    pub inverse_capped: u64,
    /// The relaxation of volume consistency met its bound of a thousandth of the density a step.
    pub relaxation_bounded: u64,
    /// A particle failed in tension that was whole before.
    pub failures: u64,
}

impl AddAssign for Interventions {
    fn add_assign(&mut self, other: Self) {
        self.inverse_capped += other.inverse_capped;
        self.relaxation_bounded += other.relaxation_bounded;
        self.failures += other.failures;
    }
}
