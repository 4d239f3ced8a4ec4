//! The whole material: reference density, one equation of state, one strength, one failure rule, one sound speed.
//!
//! [`Material::pressure`] and the sound speeds are called once a particle and step: they allocate nothing and
//! check nothing. What can be checked beforehand is checked by [`Material::validate`], once.

use crate::eos::{EquationOfState, Parameter};
use crate::error::MaterialError;
use crate::failure::{Damage, Failure, TensileState};
use crate::sound::{SoundSpeedModel, THERMODYNAMIC_FLOOR};
use crate::strength::Strength;
use serde::{Deserialize, Serialize};

/// A solid (or a fluid: a solid without strength).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name, for people.
    pub name: String,
    /// Density `ρ0` of the undisturbed material [kg/m³].
    pub reference_density: f64,
    /// Pressure as a function of density and energy.
    pub equation_of_state: EquationOfState,
    /// Resistance to shear.
    pub strength: Strength,
    /// What happens in tension.
    pub failure: Failure,
    /// Which bulk sound speed the contacts use.
    pub sound_speed: SoundSpeedModel,
}

impl Material {
    /// Pressure [Pa] at a density [kg/m³] and specific internal energy [J/kg]; positive in compression.
    #[inline]
    pub fn pressure(&self, density: f64, specific_internal_energy: f64) -> f64 {
        self.equation_of_state.pressure(self.reference_density, density, specific_internal_energy)
    }

    /// Pressure [Pa] that a point carries with what it remembers of tension.
    #[inline]
    pub fn pressure_with(&self, damage: Damage, density: f64, specific_internal_energy: f64) -> f64 {
        self.failure.pressure(damage, density, |rho| self.pressure(rho, specific_internal_energy))
    }

    /// Failure, voids and pressure at the end of a step of `time_step` [s].
    #[inline]
    pub fn advance_failure(
        &self,
        damage: Damage,
        density: f64,
        specific_internal_energy: f64,
        time_step: f64,
    ) -> TensileState {
        self.failure.advance(damage, density, time_step, |rho| self.pressure(rho, specific_internal_energy))
    }

    /// Bulk sound speed `c_b` [m/s] by the material's model, see [`crate::sound`].
    ///
    /// The thermodynamic square is not taken below [`THERMODYNAMIC_FLOOR`] times the quasi-acoustic one.
    #[inline]
    pub fn bulk_sound_speed(&self, density: f64, specific_internal_energy: f64) -> f64 {
        self.bulk_sound_speed_squared(density, specific_internal_energy).sqrt()
    }

    /// Longitudinal sound speed `c_l = √(c_b² + 4G/(3ρ))` [m/s].
    #[inline]
    pub fn longitudinal_sound_speed(&self, density: f64, specific_internal_energy: f64) -> f64 {
        self.longitudinal_sound_speed_with(1.0, density, specific_internal_energy)
    }

    /// Longitudinal sound speed [m/s] of a point with voids of distension `a`: c_b is that of the solid between them, at the
    /// density a ρ.
    #[inline]
    pub fn longitudinal_sound_speed_with(&self, distension: f64, density: f64, energy: f64) -> f64 {
        let shear = 4.0 / 3.0 * self.strength.shear_modulus() / density;
        (self.bulk_sound_speed_squared(distension * density, energy) + shear).sqrt()
    }

    /// Whether the thermodynamic sound speed of this state had to be lifted to its floor; never so for the
    /// quasi-acoustic model.
    #[inline]
    pub fn sound_speed_is_floored(&self, density: f64, specific_internal_energy: f64) -> bool {
        let (eos, rho0) = (&self.equation_of_state, self.reference_density);
        self.sound_speed == SoundSpeedModel::Thermodynamic
            && eos.thermodynamic_sound_speed_squared(rho0, density, specific_internal_energy)
                < THERMODYNAMIC_FLOOR * eos.quasi_acoustic_sound_speed_squared(rho0, density)
    }

    #[inline]
    fn bulk_sound_speed_squared(&self, density: f64, specific_internal_energy: f64) -> f64 {
        let (eos, rho0) = (&self.equation_of_state, self.reference_density);
        let quasi_acoustic = eos.quasi_acoustic_sound_speed_squared(rho0, density);
        match self.sound_speed {
            SoundSpeedModel::QuasiAcoustic => quasi_acoustic,
            SoundSpeedModel::Thermodynamic => {
                let exact = eos.thermodynamic_sound_speed_squared(rho0, density, specific_internal_energy);
                // Not f64::max: that would turn a not-a-number into the floor and hide it.
                let floor = THERMODYNAMIC_FLOOR * quasi_acoustic;
                if exact < floor { floor } else { exact }
            }
        }
    }

    /// Checks every number; lists all faults.
    ///
    /// # Errors
    ///
    /// One [`MaterialError`] for each number that is not finite or out of its bounds, and
    /// [`MaterialError::NoQuasiAcousticSpeed`] where that speed is asked for and would be zero.
    pub fn validate(&self) -> Result<(), Vec<MaterialError>> {
        let mut parameters =
            vec![Parameter::above("reference_density", self.reference_density, "kg/m³", 0.0)];
        parameters.extend(self.equation_of_state.parameters());
        parameters.extend(self.strength.parameters());
        parameters.extend(self.failure.parameters());
        let mut faults: Vec<_> = parameters.iter().filter(|p| !p.is_good()).map(|p| self.fault(p)).collect();
        let bulk_modulus = self.equation_of_state.reference_bulk_modulus(self.reference_density);
        if self.sound_speed == SoundSpeedModel::QuasiAcoustic && bulk_modulus == 0.0 {
            faults.push(MaterialError::NoQuasiAcousticSpeed { material: self.name.clone() });
        }
        if faults.is_empty() { Ok(()) } else { Err(faults) }
    }

    fn fault(&self, parameter: &Parameter) -> MaterialError {
        let Parameter { name: field, value, unit, least, least_allowed, below } = *parameter;
        let material = self.name.clone();
        if !value.is_finite() {
            MaterialError::NotFinite { material, field, value, unit }
        } else if value >= below {
            MaterialError::NotBelow { material, field, value, unit, bound: below }
        } else if least_allowed {
            MaterialError::BelowLeast { material, field, value, unit, least }
        } else {
            MaterialError::NotAbove { material, field, value, unit, least }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library;

    #[test]
    fn validation_lists_every_fault() {
        let mut copper = library::material("porous-copper").unwrap();
        copper.reference_density = -1.0;
        copper.strength = Strength::PerfectPlastic { shear_modulus: 0.0, yield_strength: f64::NAN };
        let faults = copper.validate().unwrap_err();
        let text: Vec<String> = faults.iter().map(ToString::to_string).collect();
        assert_eq!(text.len(), 3, "{text:?}");
        assert!(text[0].contains("reference_density = -1 kg/m³"), "{}", text[0]);
        assert!(text[2].contains("yield_strength"), "{}", text[2]);
    }

    #[test]
    fn a_gas_has_no_quasi_acoustic_speed() {
        let gas = Material {
            name: "air".into(),
            reference_density: 1.2,
            equation_of_state: EquationOfState::IdealGas(crate::eos::IdealGas { gamma: 1.4 }),
            strength: Strength::Fluid,
            failure: Failure::None,
            sound_speed: SoundSpeedModel::Thermodynamic,
        };
        assert_eq!(gas.validate(), Ok(()));
        let quasi_acoustic = Material { sound_speed: SoundSpeedModel::QuasiAcoustic, ..gas };
        let material = "air".into();
        assert_eq!(quasi_acoustic.validate(), Err(vec![MaterialError::NoQuasiAcousticSpeed { material }]));
        assert_eq!(quasi_acoustic.longitudinal_sound_speed(1.2, 2e5), 0.0);
    }

    #[test]
    fn thermodynamic_speed_is_floored_in_strong_expansion_only() {
        let mut copper = library::material("porous-copper").unwrap();
        copper.sound_speed = SoundSpeedModel::Thermodynamic;
        assert!(!copper.sound_speed_is_floored(9000.0, 0.0));
        assert!((copper.bulk_sound_speed(8960.0, 0.0) - 3930.0).abs() < 1e-9);
        assert!(copper.sound_speed_is_floored(2500.0, 0.0));
        let floored = copper.bulk_sound_speed(2500.0, 0.0);
        assert!((floored - 0.1 * (8960.0 * 3930.0_f64.powi(2) / 2500.0).sqrt()).abs() < 1e-9, "{floored}");
        assert!(copper.bulk_sound_speed(f64::NAN, 0.0).is_nan());
    }

    /// c_l of the sound-wave material is 5099.30 m/s at rest.
    #[test]
    fn longitudinal_speed_of_the_sound_wave_material() {
        let copper = library::material("copper-sound-wave").unwrap();
        let c_l = copper.longitudinal_sound_speed(8960.0, 0.0);
        assert!((c_l - 5099.30).abs() < 0.005, "{c_l}");
    }
}
