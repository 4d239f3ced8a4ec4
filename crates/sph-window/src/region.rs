//! Regions of the window along x.
//!
//! ```text
//! 0        frozen_end    outlet_end                       inlet_start     length
//! | outlet 2    | outlet 1    |   flow:  behind ‖ ahead        | inlet        |  ← feed
//! removal plane                            front
//! ```
//!
//! The medium streams towards -x. In the inlet the velocity is imposed; the flow is free; in outlet 1 the velocity is
//! imposed again (the piston), while the state evolves; in outlet 2 the state is frozen too, so that the free surface
//! behind the removal plane is not felt. Each region is four particle sizes wide by default.
//!
//! Source: moving window of Rublev & Murzov, arXiv 2410.14646, section 3.

use serde::{Deserialize, Serialize};
use sph_core::particles::Constraint;

/// Widths of the regions with imposed velocity, in particle sizes D.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RegionWidths {
    /// Inlet: velocity imposed, state evolves [D].
    pub inlet: f64,
    /// Outlet 1: velocity imposed, state evolves [D].
    pub outlet_velocity: f64,
    /// Outlet 2: velocity and state imposed [D].
    pub outlet_frozen: f64,
}

impl Default for RegionWidths {
    fn default() -> Self {
        Self { inlet: 4.0, outlet_velocity: 4.0, outlet_frozen: 4.0 }
    }
}

/// Where a particle is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// Left of the removal plane.
    Outside,
    /// Outlet 2: frozen.
    OutletFrozen,
    /// Outlet 1: imposed velocity.
    OutletVelocity,
    /// Free flow.
    Flow,
    /// Inlet: imposed velocity.
    Inlet,
}

impl Region {
    /// What the region imposes on the particles in it.
    pub fn constraint(self) -> Constraint {
        match self {
            Self::Flow => Constraint::Free,
            Self::OutletVelocity | Self::Inlet => Constraint::ImposedVelocity,
            Self::OutletFrozen | Self::Outside => Constraint::Frozen,
        }
    }
}

/// Bounds of the regions. The removal plane is x = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regions {
    /// Right end of outlet 2 [m].
    pub frozen_end: f64,
    /// Right end of outlet 1: the piston [m].
    pub outlet_end: f64,
    /// Left end of the inlet [m].
    pub inlet_start: f64,
    /// Right end of the box, where the feed enters [m].
    pub length: f64,
}

impl Regions {
    /// Regions of a box of a length [m] for particles of a size [m].
    pub fn new(length: f64, widths: &RegionWidths, particle_size: f64) -> Self {
        let frozen_end = widths.outlet_frozen * particle_size;
        Self {
            frozen_end,
            outlet_end: frozen_end + widths.outlet_velocity * particle_size,
            inlet_start: length - widths.inlet * particle_size,
            length,
        }
    }

    /// The region of a place [m].
    pub fn region_of(&self, x: f64) -> Region {
        if x < 0.0 {
            Region::Outside
        } else if x < self.frozen_end {
            Region::OutletFrozen
        } else if x < self.outlet_end {
            Region::OutletVelocity
        } else if x < self.inlet_start {
            Region::Flow
        } else {
            Region::Inlet
        }
    }

    /// Middle of the flow [m]: imposed velocities right of it are the inlet's, left of it the outlet's.
    pub fn middle(&self) -> f64 {
        0.5 * (self.outlet_end + self.inlet_start)
    }

    /// Length of the free flow [m].
    pub fn flow_length(&self) -> f64 {
        self.inlet_start - self.outlet_end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_stand_in_order_with_their_constraints() {
        let regions = Regions::new(100.0, &RegionWidths::default(), 1.0);
        let found: Vec<_> = [-0.1, 0.0, 3.9, 4.0, 7.9, 8.0, 95.9, 96.0, 101.0]
            .iter()
            .map(|&x| regions.region_of(x))
            .collect();
        use Region::*;
        let expected =
            [Outside, OutletFrozen, OutletFrozen, OutletVelocity, OutletVelocity, Flow, Flow, Inlet, Inlet];
        assert_eq!(found, expected);
        assert_eq!(Inlet.constraint(), Constraint::ImposedVelocity);
        assert_eq!(Flow.constraint(), Constraint::Free);
        assert_eq!(OutletFrozen.constraint(), Constraint::Frozen);
        assert_eq!(regions.middle(), 52.0);
        assert_eq!(regions.flow_length(), 88.0);
    }
}
