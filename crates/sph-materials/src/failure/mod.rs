//! Tensile failure.
//!
//! A point remembers what tension has done to it ([`Damage`]): whether it has failed, and how far voids have opened it.
//! [`Failure::pressure`] gives the pressure that it carries with that memory, [`Failure::advance`] moves the memory on at
//! the end of a step. Both take the pressure of the solid as a function of its density, so a model can ask for the
//! pressure of the solid *between* its voids.
//!
//! | model | what it is | module |
//! |---|---|---|
//! | [`Failure::None`] | unlimited tension | |
//! | [`Failure::TensileCutoff`] | fails at once where the mean tension passes `T`, heals when compressed | below |
//! | [`Failure::VoidGrowth`] | voids grow at a rate above `T`, soften the point and tear it | [`void_growth`] |
//!
//! # The cut-off
//!
//! A point whose mean tension `-P` passes `T` fails. A failed point carries no tension and no shear
//! (`P = 0` in expansion, `S = 0`) until it is compressed again, `P > 0`, which heals it with a zero
//! deviator to start from.
//!
//! ```text
//! intact --- -P > T ---> failed (P := 0, S := 0)
//!   ^                       |
//!   +------- P > 0 ---------+
//! ```
//!
//! Only the pressure and the deviator that are *used* change; density and energy go on by their own equations, so the
//! equation of state says when the gap has closed: the void's volume is recompressed before there is pressure.
//!
//! # Validity of the cut-off
//!
//! No rate, no energy of new surface, no dependence on the size of the point. It is what the source's tensile strength
//! `T` without a rule suggests, and the default.

pub mod void_growth;

use crate::eos::Parameter;
use serde::{Deserialize, Serialize};
pub use void_growth::VoidGrowth;

/// What happens in tension.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Failure {
    /// Unlimited tension.
    None,
    /// Fails where the mean tension passes the tensile strength.
    TensileCutoff {
        /// Tensile strength `T`, a limit of `-P` [Pa].
        tensile_strength: f64,
    },
    /// Voids grow where the mean tension passes the tensile strength, until they meet.
    VoidGrowth(VoidGrowth),
}

/// What a point remembers of tension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damage {
    /// Whether the point has failed.
    pub failed: bool,
    /// Volume over the volume that the same solid would have without the voids that have grown, 1 and more [-].
    pub distension: f64,
}

impl Damage {
    /// Nothing has happened yet.
    pub const NONE: Self = Self { failed: false, distension: 1.0 };
}

/// What a point carries after the failure rule was applied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TensileState {
    /// What the point remembers from now on.
    pub damage: Damage,
    /// Pressure to use [Pa].
    pub pressure: f64,
    /// Share of the yield strength that is left: 1 in an intact point, 0 where it carries no shear [-].
    pub strength_left: f64,
}

impl Failure {
    /// Pressure [Pa] of a point of the given density [kg/m³]; `solid` is the pressure of the solid at a density.
    #[inline]
    pub fn pressure(&self, damage: Damage, density: f64, solid: impl Fn(f64) -> f64) -> f64 {
        match self {
            Self::None => solid(density),
            Self::TensileCutoff { tensile_strength } => {
                cut_off(*tensile_strength, damage.failed, solid(density)).pressure
            }
            Self::VoidGrowth(model) => model.pressure(damage, density, solid),
        }
    }

    /// The state at the end of a step of `time_step` [s]; otherwise as [`Failure::pressure`].
    #[inline]
    pub fn advance(
        &self,
        damage: Damage,
        density: f64,
        time_step: f64,
        solid: impl Fn(f64) -> f64,
    ) -> TensileState {
        match self {
            Self::None => intact(solid(density)),
            Self::TensileCutoff { tensile_strength } => {
                cut_off(*tensile_strength, damage.failed, solid(density))
            }
            Self::VoidGrowth(model) => model.advance(damage, density, time_step, solid),
        }
    }

    /// Tensile strength `T` [Pa]; infinite where there is no limit.
    #[inline]
    pub fn tensile_strength(&self) -> f64 {
        match *self {
            Self::None => f64::INFINITY,
            Self::TensileCutoff { tensile_strength } => tensile_strength,
            Self::VoidGrowth(model) => model.tensile_strength,
        }
    }

    /// Numbers of the model, for the check of a material.
    pub(crate) fn parameters(&self) -> Vec<Parameter> {
        match *self {
            Self::None => Vec::new(),
            Self::TensileCutoff { tensile_strength } => {
                vec![Parameter::above("tensile_strength", tensile_strength, "Pa", 0.0)]
            }
            Self::VoidGrowth(model) => model.parameters(),
        }
    }
}

#[inline]
fn intact(pressure: f64) -> TensileState {
    TensileState { damage: Damage::NONE, pressure, strength_left: 1.0 }
}

/// The cut-off, from the pressure [Pa] of the equation of state.
#[inline]
fn cut_off(tensile_strength: f64, was_failed: bool, pressure: f64) -> TensileState {
    // A point that was failed holds no tension at all, an intact one holds it up to T.
    let breaks = if was_failed { pressure <= 0.0 } else { pressure < -tensile_strength };
    if breaks {
        let damage = Damage { failed: true, ..Damage::NONE };
        TensileState { damage, pressure: 0.0, strength_left: 0.0 }
    } else {
        intact(pressure)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUTOFF: Failure = Failure::TensileCutoff { tensile_strength: 0.35e9 };

    fn apply(was_failed: bool, pressure: f64) -> TensileState {
        let damage = Damage { failed: was_failed, ..Damage::NONE };
        let state = CUTOFF.advance(damage, 1.0, 1e-9, |_| pressure);
        assert_eq!(state.pressure, CUTOFF.pressure(damage, 1.0, |_| pressure));
        state
    }

    #[test]
    fn holds_to_the_strength_then_fails_then_heals() {
        assert_eq!(apply(false, -0.35e9), intact(-0.35e9));
        let failed = Damage { failed: true, distension: 1.0 };
        let broken = TensileState { damage: failed, pressure: 0.0, strength_left: 0.0 };
        assert_eq!(apply(false, -0.350_001e9), broken);
        assert_eq!(apply(true, -1.0), broken);
        assert_eq!(apply(true, 0.0), broken);
        assert_eq!(apply(true, 1.0), intact(1.0));
    }

    #[test]
    fn no_failure_model_leaves_any_tension() {
        assert_eq!(Failure::None.pressure(Damage::NONE, 1.0, |_| -1e12), -1e12);
    }
}
