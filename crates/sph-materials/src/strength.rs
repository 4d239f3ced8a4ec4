//! Strength: elastic shear and von Mises perfect plasticity.
//!
//! Elastic rate (Hooke with the Jaumann rate of [`crate::spin`], paper eqs. (4), (26)):
//! `dS/dt = 2G (D - ⅓ tr(D) I) + W S - S W`.
//!
//! Yield: `σ_vM = √(3/2 S:S)` with **all** components of S, `S_zz` too, may not
//! pass `Y`; radial return `S ← S min(1, Y/σ_vM)`. In uniaxial strain the deviator
//! saturates at `|S_xx| = 2Y/3`.
//!
//! Differences from the source: its expression of `σ_vM` leaves out `S_zz`, which would be
//! plane stress; plane strain is what is computed.
//!
//! # Validity
//!
//! Constant `G` and `Y`: no hardening, no rate, pressure or temperature dependence.
//!
//! # Source
//!
//! M. L. Wilkins, "Calculation of elastic-plastic flow", Methods in Computational Physics 3 (1964) 211-263.

use crate::eos::Parameter;
use serde::{Deserialize, Serialize};

/// How matter resists shear.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Strength {
    /// None: the deviator is zero.
    Fluid,
    /// Hooke's law without limit.
    Elastic {
        /// Shear modulus `G` [Pa].
        shear_modulus: f64,
    },
    /// Hooke's law up to the von Mises yield surface of fixed size.
    PerfectPlastic {
        /// Shear modulus `G` [Pa].
        shear_modulus: f64,
        /// Yield strength `Y` in uniaxial stress [Pa].
        yield_strength: f64,
    },
}

impl Strength {
    /// Shear modulus `G` [Pa]; zero for a fluid.
    #[inline]
    pub fn shear_modulus(&self) -> f64 {
        match *self {
            Self::Fluid => 0.0,
            Self::Elastic { shear_modulus } | Self::PerfectPlastic { shear_modulus, .. } => shear_modulus,
        }
    }

    /// Yield strength `Y` [Pa]; zero for a fluid, infinite for an elastic body.
    #[inline]
    pub fn yield_strength(&self) -> f64 {
        match *self {
            Self::Fluid => 0.0,
            Self::Elastic { .. } => f64::INFINITY,
            Self::PerfectPlastic { yield_strength, .. } => yield_strength,
        }
    }

    /// Factor in [0, 1] that brings a deviator back to the yield surface, from its full contraction S:S [Pa²].
    ///
    /// Exactly 1 on and inside the surface.
    #[inline]
    pub fn return_factor(&self, second_invariant: f64) -> f64 {
        let yield_strength = self.yield_strength();
        let von_mises_squared = 1.5 * second_invariant;
        if von_mises_squared <= yield_strength * yield_strength {
            1.0
        } else {
            yield_strength / von_mises_squared.sqrt()
        }
    }

    /// Numbers of the model, for the check of a material.
    pub(crate) fn parameters(&self) -> Vec<Parameter> {
        match *self {
            Self::Fluid => Vec::new(),
            Self::Elastic { shear_modulus } => {
                vec![Parameter::above("shear_modulus", shear_modulus, "Pa", 0.0)]
            }
            Self::PerfectPlastic { shear_modulus, yield_strength } => vec![
                Parameter::above("shear_modulus", shear_modulus, "Pa", 0.0),
                Parameter::above("yield_strength", yield_strength, "Pa", 0.0),
            ],
        }
    }
}

/// Von Mises stress [Pa] of a deviator from its full contraction S:S [Pa²].
#[inline]
pub fn von_mises_stress(second_invariant: f64) -> f64 {
    (1.5 * second_invariant).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S:S of the deviator of uniaxial strain, (1, -1/2, -1/2) s.
    fn uniaxial(s: f64) -> f64 {
        1.5 * s * s
    }

    #[test]
    fn uniaxial_strain_yields_at_two_thirds_of_the_yield_strength() {
        let steel = Strength::PerfectPlastic { shear_modulus: 80e9, yield_strength: 0.3e9 };
        assert_eq!(steel.return_factor(uniaxial(0.199_999e9)), 1.0);
        let factor = steel.return_factor(uniaxial(0.4e9));
        assert!((factor - 0.5).abs() < 1e-15, "{factor}");
    }

    #[test]
    fn fluid_loses_its_deviator_and_elastic_keeps_it() {
        assert_eq!(Strength::Fluid.return_factor(1.0), 0.0);
        assert_eq!(Strength::Fluid.return_factor(0.0), 1.0);
        assert_eq!(Strength::Elastic { shear_modulus: 1e9 }.return_factor(1e300), 1.0);
    }
}
