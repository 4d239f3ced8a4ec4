//! Records: what pair loops read of a neighbour, packed into whole cache lines.
//!
//! The first pass (gradients) reads [`State`] records, the second (contact) [`Sides`] records. Numbers follow each other
//! in a record in the order of the offsets below; the position comes first, where the halo expects it.

use sph_core::dimension::Dimension;

use crate::dimension::SolidDimension;

/// Offsets in the record of the first pass: position, volume, velocity, stress.
pub struct State;

impl State {
    /// V = m/ρ [m^d].
    #[inline(always)]
    pub const fn volume<D: Dimension>() -> usize {
        D::COUNT
    }
    /// First of the fields that gradients are taken of: velocity components [m/s], then stress components [Pa].
    #[inline(always)]
    pub const fn fields<D: Dimension>() -> usize {
        D::COUNT + 1
    }
}

/// Offsets in the record of the second pass: position, volume, impedances, torque, then the fields at the half step, the
/// correction K and the slopes of the fields.
pub struct Sides;

impl Sides {
    /// V = m/ρ [m^d].
    #[inline(always)]
    pub const fn volume<D: Dimension>() -> usize {
        D::COUNT
    }
    /// Longitudinal impedance ρ c_l [kg/(m² s)].
    #[inline(always)]
    pub const fn longitudinal<D: Dimension>() -> usize {
        D::COUNT + 1
    }
    /// Transverse impedance ρ c_t [kg/(m² s)].
    #[inline(always)]
    pub const fn transverse<D: Dimension>() -> usize {
        D::COUNT + 2
    }
    /// Torque of the capped part of the stress [Pa]: one number in the plane, three in space.
    #[inline(always)]
    pub const fn torque<D: Dimension>() -> usize {
        D::COUNT + 3
    }
    /// Velocity components [m/s], then stress components [Pa].
    #[inline(always)]
    pub const fn fields<D: SolidDimension>() -> usize {
        Self::torque::<D>() + D::SPIN_COUNT
    }
    /// K, symmetric, in the order of the stress components.
    #[inline(always)]
    pub const fn correction<D: SolidDimension>() -> usize {
        Self::fields::<D>() + D::COUNT + D::STRESS_COUNT
    }
    /// Slopes of the fields: derivative a of field f at `slopes + f * COUNT + a`.
    #[inline(always)]
    pub const fn slopes<D: SolidDimension>() -> usize {
        Self::correction::<D>() + D::STRESS_COUNT
    }
}

/// Rows of a block's scratch: row r holds one number of each of the eight particles of the block.
pub struct Row;

impl Row {
    /// 1/ρ [m³/kg].
    pub const INVERSE_DENSITY: usize = 0;
    /// ρ c_b² [Pa], zero where the state is frozen.
    pub const BULK_MODULUS: usize = 1;
    /// Shear modulus G [Pa], zero where the state is frozen or the particle has failed.
    pub const SHEAR_MODULUS: usize = 2;
    /// Yield strength Y [Pa].
    pub const YIELD_STRENGTH: usize = 3;
    /// Pressure P [Pa].
    pub const PRESSURE: usize = 4;
    /// 1 where the particle moves freely, 0 where its velocity is imposed.
    pub const FREE: usize = 5;
    /// ρ c_l [kg/(m² s)].
    pub const LONGITUDINAL: usize = 6;
    /// ρ c_t [kg/(m² s)].
    pub const TRANSVERSE: usize = 7;
    /// Least eigenvalue of L [-].
    pub const LEAST_EIGENVALUE: usize = 8;
    /// Largest squared speed relative to a neighbour [m²/s²].
    pub const RELATIVE_SPEED_SQUARED: usize = 9;
    /// Power of the contact forces per volume [W/m³].
    pub const POWER: usize = 10;
    /// First row of the force per volume [N/m³], one row an axis.
    pub const FORCE: usize = 11;

    /// First row of the half-step change of the velocity [m/s].
    #[inline(always)]
    pub const fn half_step<D: Dimension>() -> usize {
        Self::FORCE + D::COUNT
    }
    /// First row of the raw velocity gradient R [1/s]: derivative a of component b at `+ a * COUNT + b`.
    #[inline(always)]
    pub const fn velocity_gradient<D: Dimension>() -> usize {
        Self::half_step::<D>() + D::COUNT
    }
    /// First row of K.
    #[inline(always)]
    pub const fn correction<D: Dimension>() -> usize {
        Self::velocity_gradient::<D>() + D::COUNT * D::COUNT
    }
    /// First row of L.
    #[inline(always)]
    pub const fn gradient_matrix<D: SolidDimension>() -> usize {
        Self::correction::<D>() + D::STRESS_COUNT
    }
    /// Number of rows.
    #[inline(always)]
    pub const fn count<D: SolidDimension>() -> usize {
        Self::gradient_matrix::<D>() + D::STRESS_COUNT
    }
}
