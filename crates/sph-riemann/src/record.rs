//! Records: what pair loops read of a neighbor, packed into whole cache lines.
//!
//! The first pass (gradients) reads [`State`] records, the second (contact) [`Sides`] records, time-centering [`Centered`]
//! records, which take the place of the first. Numbers follow each other in a record in the order of the offsets below;
//! the position comes first, where the halo expects it. Pairs add up to [`Sums`] records.

use sph_core::dimension::Dimension;
use sph_core::lanes::LANES;

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
    /// V = m/ρ [m^d]; with a minus sign where the half step is to be centered on the true acceleration.
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

/// The records that the equations of state fill.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prepared {
    /// [`State`], for gradients.
    State,
    /// [`Sides`] up to the fields, as they are: for a scheme without reconstruction.
    ConstantSides,
}

impl Prepared {
    /// Cache lines of a record.
    #[inline(always)]
    pub fn lines<D: SolidDimension>(self) -> usize {
        match self {
            Self::State => D::STATE_LINES,
            Self::ConstantSides => D::CONSTANT_SIDES_LINES,
        }
    }

    /// Rows of a block that are used.
    #[inline(always)]
    pub fn rows<D: SolidDimension>(self) -> usize {
        match self {
            Self::State => Row::count::<D>(),
            Self::ConstantSides => Row::COUNT_WITHOUT_PASS,
        }
    }
}

/// Offsets in the record of time-centering: that of the second pass, where the impedances of marked particles make room for δ
/// once the contacts are solved.
pub struct Centered;

impl Centered {
    /// First component of δ [m/s], by which the half step of the velocity is corrected.
    #[inline(always)]
    pub const fn delta<D: Dimension>() -> usize {
        Sides::longitudinal::<D>()
    }
}

/// Offsets in the record that pairs add to: force, power, raw velocity gradient; the last number of the record is the
/// largest squared speed relative to a neighbor [m²/s²], not a sum.
pub struct Sums;

impl Sums {
    /// First component of the force [N], per meter of depth in the plane.
    pub const FORCE: usize = 0;

    /// Power of the contact forces [W], per meter of depth in the plane.
    #[inline(always)]
    pub const fn power<D: Dimension>() -> usize {
        D::COUNT
    }
    /// First component of the raw velocity gradient times the particle's volume, V R [m^d/s]: derivative a of component b
    /// at `+ a * COUNT + b`.
    #[inline(always)]
    pub const fn gradient<D: Dimension>() -> usize {
        D::COUNT + 1
    }
    /// Largest squared speed relative to a neighbor [m²/s²].
    #[inline(always)]
    pub const fn relative_speed_squared<D: SolidDimension>() -> usize {
        D::SUM_LINES * LANES - 1
    }
}

/// Rows of a block's scratch: row r holds one number of each of the eight particles of the block. What only the first pass
/// reads makes room for what it finds.
pub struct Row;

impl Row {
    /// 1/ρ [m³/kg]; after the first pass, half a step later.
    pub const INVERSE_DENSITY: usize = 0;
    /// Pressure P [Pa].
    pub const PRESSURE: usize = 1;
    /// ρ c_l [kg/(m² s)].
    pub const LONGITUDINAL: usize = 2;
    /// ρ c_t [kg/(m² s)], up to the first pass.
    pub const TRANSVERSE: usize = 3;
    /// Rows that a scheme without reconstruction uses; those that follow are for the first pass.
    pub const COUNT_WITHOUT_PASS: usize = 4;
    /// ρ c_b² [Pa], zero where the state is frozen, or failed and not under pressure; up to the first pass.
    pub const BULK_MODULUS: usize = 4;
    /// Shear modulus G [Pa], zero where the state is frozen or the particle has failed; up to the first pass.
    pub const SHEAR_MODULUS: usize = 5;
    /// Yield strength Y [Pa], up to the first pass.
    pub const YIELD_STRENGTH: usize = 6;
    /// 1 where the particle moves freely, 0 where its velocity is imposed; up to the first pass.
    pub const FREE: usize = 7;
    /// Rows that the material and the state fill.
    pub const COUNT_BEFORE: usize = 8;
    /// Least eigenvalue of L [-], from the first pass on.
    pub const LEAST_EIGENVALUE: usize = Self::TRANSVERSE;

    /// First row of L, from the first pass on.
    #[inline(always)]
    pub const fn gradient_matrix<D: SolidDimension>() -> usize {
        Self::LEAST_EIGENVALUE + 1
    }
    /// Number of rows.
    #[inline(always)]
    pub const fn count<D: SolidDimension>() -> usize {
        let after = Self::gradient_matrix::<D>() + D::STRESS_COUNT;
        if after > Self::COUNT_BEFORE { after } else { Self::COUNT_BEFORE }
    }
}
