//! A compaction curve `α(P)`, turned into u_s(u_p) by the jump conditions.
//!
//! Two forms: a [`CrushCurve`], and the one that was measured on pressed copper powder,
//!
//! ```text
//! α(P) = 1 + (α1 - 1) e^(-a (P - P1)),      α = ρ_s/ρ
//! ```
//!
//! with `P` the longitudinal stress behind the wave, `ρ_s` the density of the solid at that
//! stress and energy, and `α1` the distension behind the precursor of stress `P1` and speed
//! `D1`: `u1 = P1/(ρ00 D1)`, `ρ1 = ρ00 D1/(D1 - u1)`,
//! `e1 = ½ u1²`. For the main wave `e = e1 + ½ (P + P1)(V1 - V)` with
//! `V = α/ρ_s`, and `P(ρ_s, e) = P` of the solid's own equation of state (strengthless)
//! closes the set; then `u_s - u1 = V1 √((P - P1)/(V1 - V))`.
//!
//! Velocities are relative to the undisturbed medium, as they are measured; behind a standing precursor, to the
//! matter at rest there.
//!
//! # Validity
//!
//! From the precursor's stress to the end of the data, for pressed copper powder 0.14 to 3.5 GPa; outside it is
//! an error. The amplitude and speed of the precursor are given to two digits.
//!
//! # Source
//!
//! R. R. Boade, "Principal Hugoniot, second-shock Hugoniot, and release behavior of pressed copper powder", J.
//! Appl. Phys. 41 (1970) 4542-4551. Form of P(ρ, e, α): W. Herrmann, J. Appl. Phys. 40 (1969) 2490-2499.

use super::{CrushCurve, PorousMedium, Precursor};
use crate::error::HugoniotError;
use crate::hugoniot::check_piston;
use crate::jump::{Jump, ShockState};
use crate::material::Material;
use crate::root::turning_point;

/// A kilobar [Pa].
const KILOBAR: f64 = 1e8;

/// Form of a compaction curve.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// Exponential decay behind the precursor [1/Pa].
    Exponential(f64),
    /// A crush curve.
    Crush(CrushCurve),
}

/// A compaction curve behind a precursor; equations, validity and source: [its module](self).
#[derive(Clone, Debug, PartialEq)]
pub struct CompactionCurve {
    medium: PorousMedium,
    precursor: ShockState,
    precursor_distension: f64,
    form: Form,
    greatest_stress: f64,
}

impl CompactionCurve {
    /// Pressed copper powder of Boade (1970): 6400 kg/m³, precursor 1.4 kbar at 1.9 km/s, 0.254 per kbar, data
    /// to 35 kbar.
    ///
    /// # Errors
    ///
    /// A solid that is not denser than 6400 kg/m³.
    pub fn pressed_copper_powder(solid: &Material) -> Result<Self, HugoniotError> {
        Self::new(solid, 6400.0, (1.4 * KILOBAR, 1900.0), 0.254 / KILOBAR, 35.0 * KILOBAR)
    }

    /// A curve from the initial density [kg/m³], stress [Pa] and speed [m/s] of the precursor, decay a [1/Pa],
    /// and the greatest stress of the data [Pa].
    ///
    /// # Errors
    ///
    /// As [`PorousMedium::new`]; a decay or an end of the data that cannot be; [`HugoniotError::NoSolidDensity`] behind the
    /// precursor.
    pub fn new(
        solid: &Material,
        initial_density: f64,
        (stress, speed): (f64, f64),
        decay: f64,
        greatest_stress: f64,
    ) -> Result<Self, HugoniotError> {
        let medium = PorousMedium::new(solid, initial_density, Precursor::Moving { stress, speed })?;
        if !(decay.is_finite() && decay >= 0.0) {
            return Err(HugoniotError::BadNumber { field: "decay", value: decay, unit: "1/Pa", least: 0.0 });
        }
        Self::with_form(medium, Form::Exponential(decay), greatest_stress)
    }

    /// A medium that follows a crush curve, up to a greatest stress [Pa].
    ///
    /// # Errors
    ///
    /// Numbers that make no curve; an end that does not exceed the stress of the precursor;
    /// [`HugoniotError::NoSolidDensity`] behind the precursor.
    pub fn crush(
        medium: PorousMedium,
        curve: CrushCurve,
        greatest_stress: f64,
    ) -> Result<Self, HugoniotError> {
        curve.check()?;
        Self::with_form(medium, Form::Crush(curve), greatest_stress)
    }

    fn with_form(medium: PorousMedium, form: Form, greatest_stress: f64) -> Result<Self, HugoniotError> {
        let precursor = medium.state_ahead();
        if !(greatest_stress.is_finite() && greatest_stress > precursor.pressure) {
            return Err(HugoniotError::NotAbove {
                field: "greatest_stress",
                value: greatest_stress,
                unit: "Pa",
                least: precursor.pressure,
            });
        }
        let energy = precursor.specific_internal_energy;
        let solid_density = medium.solid_density(precursor.pressure, |_| energy)?;
        let precursor_distension = solid_density / precursor.density;
        Ok(Self { medium, precursor, precursor_distension, form, greatest_stress })
    }

    /// Distension `α1` behind the precursor [1].
    pub fn precursor_distension(&self) -> f64 {
        self.precursor_distension
    }

    /// Distension `α` behind the main wave at a stress [Pa] within the data [1].
    pub fn distension(&self, stress: f64) -> f64 {
        match self.form {
            Form::Crush(curve) => curve.distension(stress),
            Form::Exponential(decay) => {
                let left = (-decay * (stress - self.precursor.pressure)).exp();
                1.0 + (self.precursor_distension - 1.0) * left
            }
        }
    }

    /// The main wave of a given stress behind [Pa].
    ///
    /// # Errors
    ///
    /// [`HugoniotError::OutsideCurve`] outside the data; [`HugoniotError::PrecursorOvertaken`];
    /// [`HugoniotError::NoSolidDensity`] where the solid does not come to that stress;
    /// [`HugoniotError::NotCompacted`] where the curve leaves more volume than there is behind the precursor.
    pub fn wave_of_stress(&self, stress: f64) -> Result<Jump, HugoniotError> {
        let ahead = self.precursor;
        if !(stress > ahead.pressure && stress <= self.greatest_stress) {
            let (least, greatest) = (ahead.pressure, self.greatest_stress);
            return Err(HugoniotError::OutsideCurve { stress, least, greatest });
        }
        let jump = self.jump_to(stress)?;
        self.medium.slower_than_precursor(jump)
    }

    fn jump_to(&self, stress: f64) -> Result<Jump, HugoniotError> {
        let ahead = self.precursor;
        let alpha = self.distension(stress);
        let volume_loss = |rho_s: f64| 1.0 / ahead.density - alpha / rho_s;
        let energy = |rho_s: f64| {
            ahead.specific_internal_energy + 0.5 * (stress + ahead.pressure) * volume_loss(rho_s)
        };
        let rho_s = self.medium.solid_density(stress, energy)?;
        let (density, loss) = (rho_s / alpha, volume_loss(rho_s));
        if loss <= 0.0 {
            return Err(HugoniotError::NotCompacted { stress, density, density_ahead: ahead.density });
        }
        let mass_flux = ((stress - ahead.pressure) / loss).sqrt();
        let behind = ShockState {
            density,
            particle_velocity: ahead.particle_velocity + mass_flux * loss,
            longitudinal_stress: -stress,
            pressure: stress,
            specific_internal_energy: energy(rho_s),
        };
        Ok(Jump { ahead, behind, wave_speed: ahead.particle_velocity + mass_flux / ahead.density })
    }

    /// The main wave ahead of a piston [m/s].
    ///
    /// # Errors
    ///
    /// A piston that does not push, is slower than the matter behind the precursor, or too fast for the data; as
    /// [`CompactionCurve::wave_of_stress`].
    pub fn wave(&self, piston_velocity: f64) -> Result<Jump, HugoniotError> {
        check_piston(piston_velocity)?;
        self.medium.state_ahead_of(piston_velocity)?;
        let velocity = |stress: f64| self.jump_to(stress).map(|jump| jump.behind.particle_velocity);
        let greatest = velocity(self.greatest_stress)?;
        if piston_velocity > greatest {
            return Err(HugoniotError::BeyondCurve { piston_velocity, greatest });
        }
        let least_stress = self.precursor.pressure * (1.0 + 1e-12);
        let is_fast_enough = |p: f64| velocity(p).is_ok_and(|u| u >= piston_velocity);
        let stress = turning_point(least_stress, self.greatest_stress, is_fast_enough);
        self.wave_of_stress(stress)
    }

    /// State behind the precursor.
    pub fn precursor_state(&self) -> ShockState {
        self.precursor
    }
}
