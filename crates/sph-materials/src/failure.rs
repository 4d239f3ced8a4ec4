//! Tensile failure.
//!
//! The source gives a tensile strength \\( T \\) and no rule. The rule here: a point whose mean tension
//! \\( -P \\) passes \\( T \\) fails. A failed point carries no tension and no shear (\\( P = 0 \\) in
//! expansion, \\( S = 0 \\)) until it is compressed again, \\( P > 0 \\), which heals it with a zero deviator
//! to start from.
//!
//! ```text
//! intact --- -P > T ---> failed (P := 0, S := 0)
//!   ^                       |
//!   +------- P > 0 ---------+
//! ```
//!
//! Only the pressure and the deviator that are *used* change; density and energy go on by their own equations,
//! so the equation of state says when the gap has closed.
//!
//! # Validity
//!
//! A cut-off, not a damage model: no rate, no energy of new surface, no dependence on the size of the point. A
//! regular particle lattice under tension needs it: without a cut-off it clumps numerically.

use crate::eos::Parameter;
use serde::{Deserialize, Serialize};

/// What happens in tension.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Failure {
    /// Unlimited tension.
    None,
    /// Fails where the mean tension passes the tensile strength.
    TensileCutoff {
        /// Tensile strength \\( T \\), a limit of \\( -P \\) [Pa].
        tensile_strength: f64,
    },
}

/// What a point carries after the failure rule was applied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TensileState {
    /// Whether the point is failed from now on.
    pub failed: bool,
    /// Pressure to use [Pa].
    pub pressure: f64,
    /// Factor on the deviator: 0 where failed, else 1.
    pub deviator_factor: f64,
}

impl Failure {
    /// Applies the rule to the pressure [Pa] of the equation of state; `was_failed` is the point's memory.
    #[inline]
    pub fn apply(&self, was_failed: bool, pressure: f64) -> TensileState {
        let intact = TensileState { failed: false, pressure, deviator_factor: 1.0 };
        match *self {
            Self::None => intact,
            Self::TensileCutoff { tensile_strength } => {
                // A point that was failed holds no tension at all, an intact one holds it up to T.
                let least_pressure = if was_failed { 0.0 } else { -tensile_strength };
                let breaks = if was_failed { pressure <= least_pressure } else { pressure < least_pressure };
                if breaks {
                    TensileState { failed: true, pressure: 0.0, deviator_factor: 0.0 }
                } else {
                    intact
                }
            }
        }
    }

    /// Tensile strength \\( T \\) [Pa]; infinite where there is no limit.
    #[inline]
    pub fn tensile_strength(&self) -> f64 {
        match *self {
            Self::None => f64::INFINITY,
            Self::TensileCutoff { tensile_strength } => tensile_strength,
        }
    }

    /// Numbers of the model, for the check of a material.
    pub(crate) fn parameters(&self) -> Vec<Parameter> {
        match *self {
            Self::None => Vec::new(),
            Self::TensileCutoff { tensile_strength } => {
                vec![Parameter::above("tensile_strength", tensile_strength, "Pa", 0.0)]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUTOFF: Failure = Failure::TensileCutoff { tensile_strength: 0.35e9 };

    #[test]
    fn holds_to_the_strength_then_fails_then_heals() {
        assert_eq!(
            CUTOFF.apply(false, -0.35e9),
            TensileState { failed: false, pressure: -0.35e9, deviator_factor: 1.0 }
        );
        let broken = TensileState { failed: true, pressure: 0.0, deviator_factor: 0.0 };
        assert_eq!(CUTOFF.apply(false, -0.350_001e9), broken);
        assert_eq!(CUTOFF.apply(true, -1.0), broken);
        assert_eq!(CUTOFF.apply(true, 0.0), broken);
        assert_eq!(
            CUTOFF.apply(true, 1.0),
            TensileState { failed: false, pressure: 1.0, deviator_factor: 1.0 }
        );
    }

    #[test]
    fn no_failure_model_leaves_any_tension() {
        assert_eq!(Failure::None.apply(false, -1e12).pressure, -1e12);
    }
}
