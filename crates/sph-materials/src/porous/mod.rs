//! Jump conditions of a porous medium: what u_s(u_p) must be, whatever happens inside the front.
//!
//! * [`PorousMedium::shut_pores`]: the medium compacts wholly, to its own solid's equation of state;
//! * [`PorousMedium::snow_plow`]: the same with an incompressible solid;
//! * [`CompactionCurve`]: partial compaction along a curve `α(P)`, measured or a [`CrushCurve`].
//!
//! # Shut pores
//!
//! A medium of density `ρ00 = ρ0/m` carries a precursor stress `σ_HEL`. The
//! compaction wave leaves solid of density `ρ`, velocity `u_p` and stress
//! `Σ = -σ_xx`:
//!
//! ```text
//! ρ00 u_s = ρ (u_s - u_p),      Σ = σ_HEL + ρ00 u_s u_p,
//! e = ½ (σ_HEL + Σ)(V00 - V),      P(ρ, e) = Σ - s
//! ```
//!
//! Four equations for `u_s, ρ, Σ, e`, except for `s = -S_xx`, which they leave open:
//! behind a shut front the solid was worked through in all directions, and its mean deviator is anything from
//! zero to that of uniaxial compression at yield. These are the two ends of
//! [`PorousMedium::shock_velocity_range`]:
//!
//! * lower end, [`ShearBehind::None`]: `s = 0`;
//! * upper end, [`ShearBehind::Yielded`]: `s = 2/3 Y`.
//!
//! For the copper of the library, m = 1.3514 (that of a cell of 20 × 20 particles less 104) and a standing
//! precursor of 0.20 GPa:
//!
//! | u_p, m/s | lower, m/s | upper, m/s |
//! |---|---|---|
//! | 150 | 571.3 | 574.0 |
//! | 200 | 757.2 | 760.6 |
//! | 250 | 939.5 | 943.7 |
//! | 300 | 1117.7 | 1122.5 |
//!
//! Such a range is as wide as the deviator is unknown, and no wider: the porosity moves both ends by -0.2 % for
//! 0.001 more in m (m = 1.35 exactly: +0.2 to +0.3 %), the precursor stress by -0.17 % for 0.2 GPa. State both
//! with a number that is quoted.
//!
//! # Which state lies ahead
//!
//! [`Precursor::Standing`] puts the stress ahead of the wave at rest and at `ρ00`: the source's
//! assumption ("the density change in the elastic precursor is small"), and the frame of a window whose inlet
//! imposes one velocity. u_s and u_p are then relative to the matter behind the precursor.
//! [`Precursor::Moving`] adds the precursor's own velocity `σ_HEL/(ρ00 D)` (13 m/s for 0.22
//! GPa at 2.6 km/s) and density; velocities are then relative to the undisturbed medium, and at the same u_p
//! the wave is slower by 20 to 30 m/s. [`Jump::shock_velocity`] and [`Jump::velocity_jump`] of such a wave
//! compare with the former.
//!
//! # Validity
//!
//! The conditions hold once the pores are shut, for the source's copper from `u_p ≈ 150` m/s on;
//! nothing here can tell that they are. With open pores the medium behind is lighter, and by mass conservation
//! u_s lies above the range: it must then be measured or computed. Compaction is normal (stress rises with
//! density) for `m < 1 + 2/γ`; beyond that the heat of compaction wins, and it is an error.
//!
//! # Source
//!
//! Jump conditions and the standing precursor: Rublev & Murzov, arXiv 2410.14646, section 4. Anomalous
//! compaction: Ya. B. Zel'dovich & Yu. P. Raizer, Physics of Shock Waves and High-Temperature Hydrodynamic
//! Phenomena, ch. XI.

pub mod compaction_curve;
pub mod crush_curve;

pub use compaction_curve::CompactionCurve;
pub use crush_curve::CrushCurve;

use crate::error::HugoniotError;
use crate::hugoniot::check_piston;
use crate::jump::{Jump, ShockState};
use crate::material::Material;
use crate::root::turning_point;
use crate::shock::Adiabat;

/// Share of a singular density up to which the solid's density is searched.
const BEFORE_THE_LIMIT: f64 = 1.0 - 1e-9;

/// What runs ahead of the compaction wave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Precursor {
    /// Nothing: no stress ahead.
    None,
    /// Stressed matter at rest and at the medium's own density.
    Standing {
        /// `σ_HEL`, positive in compression [Pa].
        stress: f64,
    },
    /// A precursor wave with its own jump conditions.
    Moving {
        /// `σ_HEL`, positive in compression [Pa].
        stress: f64,
        /// Speed of the precursor in the undisturbed medium [m/s].
        speed: f64,
    },
}

/// Mean deviator of the solid behind the compaction wave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShearBehind {
    /// None: mean pressure and longitudinal stress agree.
    None,
    /// That of uniaxial compression at yield, `-S_xx = 2/3 Y`.
    Yielded,
}

/// The two ends between which u_s must lie when the pores are shut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShockVelocityRange {
    /// Without deviator behind the wave [m/s].
    pub lower: f64,
    /// With the deviator of uniaxial compression at yield [m/s].
    pub upper: f64,
}

/// A solid with voids.
#[derive(Clone, Debug, PartialEq)]
pub struct PorousMedium {
    solid: Material,
    initial_density: f64,
    precursor: Precursor,
}

impl PorousMedium {
    /// A medium of initial density `ρ00` [kg/m³].
    ///
    /// # Errors
    ///
    /// A density that is not less than the solid's, a porosity from which on compaction is anomalous, or a
    /// precursor with impossible numbers.
    pub fn new(solid: &Material, initial_density: f64, precursor: Precursor) -> Result<Self, HugoniotError> {
        let solid_density = solid.reference_density;
        if !(initial_density > 0.0 && initial_density < solid_density) {
            return Err(HugoniotError::NotPorous { initial_density, solid_density });
        }
        let medium = Self { solid: solid.clone(), initial_density, precursor };
        let limit = medium.porosity_limit();
        if medium.porosity() >= limit {
            return Err(HugoniotError::AnomalousCompaction { porosity: medium.porosity(), limit });
        }
        medium.check_precursor()?;
        Ok(medium)
    }

    /// A medium of porosity `m = ρ0/ρ00 > 1`.
    ///
    /// # Errors
    ///
    /// As [`PorousMedium::new`].
    pub fn with_porosity(
        solid: &Material,
        porosity: f64,
        precursor: Precursor,
    ) -> Result<Self, HugoniotError> {
        Self::new(solid, solid.reference_density / porosity, precursor)
    }

    /// Density `ρ00` of the undisturbed medium [kg/m³].
    pub fn initial_density(&self) -> f64 {
        self.initial_density
    }

    /// Porosity `m = ρ0/ρ00` [1].
    pub fn porosity(&self) -> f64 {
        self.solid.reference_density / self.initial_density
    }

    /// Porosity from which on compaction is anomalous, `1 + 2ρ0/a(ρ0)`, for Mie-Grüneisen
    /// `1 + 2/γ` [1].
    pub fn porosity_limit(&self) -> f64 {
        let rho0 = self.solid.reference_density;
        1.0 + 2.0 * rho0 / self.solid.equation_of_state.pressure_energy_slope(rho0)
    }

    fn check_precursor(&self) -> Result<(), HugoniotError> {
        let (stress, speed) = match self.precursor {
            Precursor::None => return Ok(()),
            Precursor::Standing { stress } => (stress, f64::MAX),
            Precursor::Moving { stress, speed } => (stress, speed),
        };
        if !(stress.is_finite() && stress >= 0.0) {
            return Err(HugoniotError::BadNumber { field: "stress", value: stress, unit: "Pa", least: 0.0 });
        }
        // The precursor must outrun the matter that it moves: u = stress / (rho00 D) < D.
        let least = (stress / self.initial_density).sqrt();
        if speed.is_finite() && speed > least {
            Ok(())
        } else {
            Err(HugoniotError::NotAbove { field: "speed", value: speed, unit: "m/s", least })
        }
    }

    /// State between the precursor and the compaction wave.
    pub fn state_ahead(&self) -> ShockState {
        let rest = ShockState::at_rest(self.initial_density);
        match self.precursor {
            Precursor::None => rest,
            Precursor::Standing { stress } => {
                ShockState { longitudinal_stress: -stress, pressure: stress, ..rest }
            }
            Precursor::Moving { stress, speed } => {
                let velocity = stress / (self.initial_density * speed);
                ShockState {
                    density: self.initial_density * speed / (speed - velocity),
                    particle_velocity: velocity,
                    longitudinal_stress: -stress,
                    pressure: stress,
                    specific_internal_energy: 0.5 * velocity * velocity,
                }
            }
        }
    }

    /// The compaction wave that shuts the pores ahead of a piston [m/s].
    ///
    /// # Errors
    ///
    /// A piston that does not push or is slower than the matter behind the precursor; a wave that is not slower
    /// than its precursor; a yielded solid behind that would be under mean tension; no state at all.
    pub fn shut_pores(&self, piston_velocity: f64, shear: ShearBehind) -> Result<Jump, HugoniotError> {
        let ahead = self.state_ahead_of(piston_velocity)?;
        let s = self.shear_stress(shear)?;
        let jump = Adiabat { material: &self.solid, ahead, shear_stress: |_: f64| s }
            .to_velocity(piston_velocity)?;
        if jump.behind.pressure < 0.0 {
            let pressure = jump.behind.pressure;
            return Err(HugoniotError::MeanTension { piston_velocity, pressure });
        }
        self.slower_than_precursor(jump)
    }

    /// Shock velocities u_s [m/s], relative to the matter ahead, with and without deviator behind a wave that
    /// shuts the pores.
    ///
    /// # Errors
    ///
    /// As [`PorousMedium::shut_pores`].
    pub fn shock_velocity_range(&self, piston_velocity: f64) -> Result<ShockVelocityRange, HugoniotError> {
        let end = |shear| Ok(self.shut_pores(piston_velocity, shear)?.shock_velocity());
        Ok(ShockVelocityRange { lower: end(ShearBehind::None)?, upper: end(ShearBehind::Yielded)? })
    }

    /// The compaction wave of an incompressible solid (snow-plow): `u_s = u_p m/(m - 1)` if nothing
    /// runs ahead.
    ///
    /// u_s lies above that of the compressible solid as long as the latter is denser than `ρ0` behind
    /// the wave. The stored energy is that of the jump condition; the equation of state is not asked, and
    /// `pressure` is the longitudinal stress.
    ///
    /// # Errors
    ///
    /// As [`PorousMedium::shut_pores`], without those of the equation of state; [`HugoniotError::NotPorous`] behind a
    /// precursor that leaves the medium as dense as its solid.
    pub fn snow_plow(&self, piston_velocity: f64) -> Result<Jump, HugoniotError> {
        let ahead = self.state_ahead_of(piston_velocity)?;
        let density = self.solid.reference_density;
        if density <= ahead.density {
            // A precursor that shuts the pores leaves an incompressible solid nothing to plow.
            return Err(HugoniotError::NotPorous { initial_density: ahead.density, solid_density: density });
        }
        let du = piston_velocity - ahead.particle_velocity;
        let shock_velocity = du / (1.0 - ahead.density / density);
        let sigma = -ahead.longitudinal_stress + ahead.density * shock_velocity * du;
        let volume_loss = 1.0 / ahead.density - 1.0 / density;
        let gain = 0.5 * (sigma - ahead.longitudinal_stress) * volume_loss;
        let behind = ShockState {
            density,
            particle_velocity: piston_velocity,
            longitudinal_stress: -sigma,
            pressure: sigma,
            specific_internal_energy: ahead.specific_internal_energy + gain,
        };
        let wave_speed = ahead.particle_velocity + shock_velocity;
        self.slower_than_precursor(Jump { ahead, behind, wave_speed })
    }

    /// Distension `α = ρ_s/ρ` of matter of a stress [Pa] and density [kg/m³] behind the compaction
    /// wave: the solid at that stress, strengthless, and at the energy that the jump conditions give.
    ///
    /// # Errors
    ///
    /// A stress that is not finite or a density that is not positive and finite; [`HugoniotError::NoSolidDensity`] where
    /// both do not go together, so that the solid does not come to that stress at that energy.
    pub fn distension_behind(&self, stress: f64, density: f64) -> Result<f64, HugoniotError> {
        if !stress.is_finite() {
            return Err(HugoniotError::NotFinite { field: "stress", value: stress, unit: "Pa" });
        }
        if !(density.is_finite() && density > 0.0) {
            let (field, value, unit) = ("density", density, "kg/m³");
            return Err(HugoniotError::NotAbove { field, value, unit, least: 0.0 });
        }
        let ahead = self.state_ahead();
        let volume_loss = 1.0 / ahead.density - 1.0 / density;
        let energy = ahead.specific_internal_energy + 0.5 * (stress + ahead.pressure) * volume_loss;
        Ok(self.solid_density(stress, |_| energy)? / density)
    }

    /// Density [kg/m³] at which the solid has a pressure [Pa], its energy [J/kg] being a function of that
    /// density. From half of the reference density to the equation of state's limit; at a given energy the pressure
    /// may have a greatest value before.
    fn solid_density(&self, pressure: f64, energy: impl Fn(f64) -> f64) -> Result<f64, HugoniotError> {
        let is_dense_enough = |density: f64| self.solid.pressure(density, energy(density)) >= pressure;
        let rho0 = self.solid.reference_density;
        let highest = BEFORE_THE_LIMIT * self.solid.equation_of_state.density_limit(rho0).min(f64::MAX);
        let (low, mut high) = (0.5 * rho0, rho0);
        while !is_dense_enough(high) && high < highest {
            high = (1.01 * high).min(highest);
        }
        if is_dense_enough(low) || !is_dense_enough(high) {
            return Err(HugoniotError::NoSolidDensity { pressure });
        }
        Ok(turning_point(low, high, is_dense_enough))
    }

    fn state_ahead_of(&self, piston_velocity: f64) -> Result<ShockState, HugoniotError> {
        check_piston(piston_velocity)?;
        let ahead = self.state_ahead();
        let precursor_velocity = ahead.particle_velocity;
        if piston_velocity <= precursor_velocity {
            return Err(HugoniotError::BelowPrecursor { piston_velocity, precursor_velocity });
        }
        Ok(ahead)
    }

    fn shear_stress(&self, shear: ShearBehind) -> Result<f64, HugoniotError> {
        let yield_strength = self.solid.strength.yield_strength();
        match shear {
            ShearBehind::None => Ok(0.0),
            ShearBehind::Yielded if yield_strength.is_finite() => Ok(2.0 / 3.0 * yield_strength),
            ShearBehind::Yielded => Err(HugoniotError::NoElasticLimit { material: self.solid.name.clone() }),
        }
    }

    fn slower_than_precursor(&self, jump: Jump) -> Result<Jump, HugoniotError> {
        match self.precursor {
            Precursor::Moving { speed, .. } if jump.wave_speed >= speed => {
                Err(HugoniotError::PrecursorOvertaken { wave_speed: jump.wave_speed, precursor_speed: speed })
            }
            _ => Ok(jump),
        }
    }
}
