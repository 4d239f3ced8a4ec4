//! Which bulk sound speed the contact between particles uses.
//!
//! * quasi-acoustic: `c_b = √(B/ρ)` with the constant bulk modulus of the reference state (Rublev
//!   & Murzov, arXiv 2410.14646, below paper eq. (8)); always positive, too low in strong shocks;
//! * thermodynamic: `c_b² = ∂P/∂ρ|_e + (P/ρ²) ∂P/∂e|_ρ`:
//!   exact, the better choice at high pressure.
//!
//! With the shear modulus: `c_l = √(c_b² + 4G/(3ρ))`, `c_t = √(G/ρ)` (paper eq. (8)).

use serde::{Deserialize, Serialize};

/// Model of the bulk sound speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum SoundSpeedModel {
    /// From the constant bulk modulus of the reference state.
    QuasiAcoustic,
    /// From the derivatives of the equation of state.
    Thermodynamic,
}

/// Least square of the thermodynamic bulk sound speed, as a share of the quasi-acoustic one.
///
/// In strong expansion an equation of state may have `c_b² ≤ 0`, with which no contact can be solved.
/// There [`crate::Material::bulk_sound_speed`] takes this share of `B/ρ`, that is a tenth of the
/// quasi-acoustic speed. Whether a state is that far out can be asked:
/// [`crate::Material::sound_speed_is_floored`].
pub const THERMODYNAMIC_FLOOR: f64 = 0.01;
