//! Equations of state `P(ρ, e)` of a solid: one model a file, behind one closed enum.
//!
//! Every model here is linear in the specific internal energy at fixed density,
//! `P(ρ, e) = P(ρ, 0) + a(ρ) e`, with `a = ∂P / ∂e|_ρ`; the shock
//! solutions of [`crate::hugoniot`] rest on that.
//!
//! Two sound speeds belong to each model:
//!
//! * thermodynamic, exact: `c_b² = ∂P/∂ρ|_e + (P/ρ²) ∂P/∂e|_ρ`;
//! * quasi-acoustic: `c_b² = B/ρ` with the constant `B` of the undisturbed material (Rublev &
//!   Murzov, arXiv 2410.14646, text below paper eq. (8)).
//!
//! The square of the thermodynamic speed may become negative: in strong expansion, where the model leaves the
//! domain in which matter is stable. It is returned as it is; [`crate::Material::bulk_sound_speed`] decides
//! what to do.
//!
//! # Adding a model
//!
//! One file with the five functions and the documentation that the others have, one variant, one arm in each `match` below and
//! in `src/hugoniot/principal.rs`. By hand, since nothing fails without: whether the arm of
//! [`EquationOfState::density_limit`] gives the singular density, and the row in the property tests (`tests/prop_eos.rs`).

pub mod ideal_gas;
pub mod linear;
pub mod linear_gamma;
pub mod logarithmic;
pub mod mie_gruneisen;

pub use ideal_gas::IdealGas;
pub use linear::Linear;
pub use linear_gamma::LinearGamma;
pub use logarithmic::Logarithmic;
pub use mie_gruneisen::MieGruneisen;

use serde::{Deserialize, Serialize};

/// One of the equations of state that the program knows.
///
/// `rho0` is the reference density [kg/m³] of the material, `rho` the density [kg/m³], `e` the specific internal
/// energy [J/kg]. Densities must be positive.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum EquationOfState {
    /// Mie-Grüneisen with the solid's linear shock Hugoniot as reference curve.
    MieGruneisen(MieGruneisen),
    /// Pressure proportional to the logarithm of density; no thermal part.
    Logarithmic(Logarithmic),
    /// Pressure proportional to the excess density; no thermal part.
    Linear(Linear),
    /// Linear in density with an ideal-gas-like thermal part.
    LinearGamma(LinearGamma),
    /// Ideal gas with constant specific heats.
    IdealGas(IdealGas),
}

/// Calls the same function of whichever model is there.
macro_rules! each_model {
    ($self:ident, $model:ident => $call:expr) => {
        match $self {
            EquationOfState::MieGruneisen($model) => $call,
            EquationOfState::Logarithmic($model) => $call,
            EquationOfState::Linear($model) => $call,
            EquationOfState::LinearGamma($model) => $call,
            EquationOfState::IdealGas($model) => $call,
        }
    };
}

impl EquationOfState {
    /// Pressure [Pa], positive in compression.
    #[inline]
    pub fn pressure(&self, rho0: f64, rho: f64, e: f64) -> f64 {
        each_model!(self, model => model.pressure(rho0, rho, e))
    }

    /// `∂P/∂e|_ρ` [kg/m³]: a function of density alone in every model here.
    #[inline]
    pub fn pressure_energy_slope(&self, rho: f64) -> f64 {
        each_model!(self, model => model.pressure_energy_slope(rho))
    }

    /// Square of the thermodynamic bulk sound speed [m²/s²]; negative where the model is unstable.
    #[inline]
    pub fn thermodynamic_sound_speed_squared(&self, rho0: f64, rho: f64, e: f64) -> f64 {
        each_model!(self, model => model.thermodynamic_sound_speed_squared(rho0, rho, e))
    }

    /// Square of the quasi-acoustic bulk sound speed [m²/s²], `B/ρ`.
    #[inline]
    pub fn quasi_acoustic_sound_speed_squared(&self, rho0: f64, rho: f64) -> f64 {
        self.reference_bulk_modulus(rho0) / rho
    }

    /// Bulk modulus `B` of the reference state [Pa], `ρ0 c²` at `ρ0`, e = 0.
    #[inline]
    pub fn reference_bulk_modulus(&self, rho0: f64) -> f64 {
        each_model!(self, model => model.reference_bulk_modulus(rho0))
    }

    /// Density [kg/m³] below which the formula holds; infinite where it has no singular point.
    ///
    /// [`EquationOfState::pressure`] does not check it: past a singular density the formula gives finite,
    /// meaningless numbers.
    pub fn density_limit(&self, rho0: f64) -> f64 {
        match self {
            Self::MieGruneisen(model) => model.density_limit(rho0),
            Self::Logarithmic(_) | Self::Linear(_) | Self::LinearGamma(_) | Self::IdealGas(_) => {
                f64::INFINITY
            }
        }
    }

    /// Parameters by name, value and the condition that each must meet beyond being finite.
    pub(crate) fn parameters(&self) -> Vec<Parameter> {
        each_model!(self, model => model.parameters().to_vec())
    }
}

/// A number of a model as the check of a material sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parameter {
    /// Name of the field.
    pub name: &'static str,
    /// Value in SI units.
    pub value: f64,
    /// SI unit.
    pub unit: &'static str,
    /// Least value, and whether that value itself is allowed.
    pub least: f64,
    /// Whether `least` itself is allowed.
    pub least_allowed: bool,
    /// What the value must stay below; infinite where there is no such bound.
    pub below: f64,
}

impl Parameter {
    /// A number that must be greater than `least`.
    pub const fn above(name: &'static str, value: f64, unit: &'static str, least: f64) -> Self {
        Self { name, value, unit, least, least_allowed: false, below: f64::INFINITY }
    }

    /// A number that must not be less than `least`.
    pub const fn at_least(name: &'static str, value: f64, unit: &'static str, least: f64) -> Self {
        Self { name, value, unit, least, least_allowed: true, below: f64::INFINITY }
    }

    /// The same number, which must be less than `bound` as well.
    pub const fn and_below(self, bound: f64) -> Self {
        Self { below: bound, ..self }
    }

    /// Whether the number is finite and meets its bounds; not-a-number fails.
    pub fn is_good(&self) -> bool {
        self.value.is_finite()
            && self.value < self.below
            && (self.value > self.least || (self.least_allowed && self.value == self.least))
    }
}
