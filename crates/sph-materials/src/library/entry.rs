//! How an entry of the library is written, and how it becomes a [`Material`].

use crate::eos::{EquationOfState, Linear, LinearGamma, Logarithmic, MieGruneisen};
use crate::error::LibraryError;
use crate::failure::{Failure, VoidGrowth};
use crate::material::Material;
use crate::sound::SoundSpeedModel;
use crate::strength::Strength;
use serde::Deserialize;

/// A material with the origin of its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The material, in SI units.
    pub material: Material,
    /// What it is and what it is for.
    pub description: String,
    /// Every number as the file has it, in the order of the fields.
    pub numbers: Vec<SourcedNumber>,
}

/// One number of an entry.
#[derive(Clone, Debug, PartialEq)]
pub struct SourcedNumber {
    /// Field of the material.
    pub field: &'static str,
    /// Value in `unit`.
    pub value: f64,
    /// Unit as written in the file.
    pub unit: String,
    /// Value in SI units.
    pub si_value: f64,
    /// Where the number comes from.
    pub source: String,
}

/// A number as the file has it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NumberText {
    value: f64,
    unit: String,
    source: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EntryText {
    name: String,
    description: String,
    reference_density: NumberText,
    equation_of_state: EosText,
    strength: StrengthText,
    failure: FailureText,
    sound_speed: SoundSpeedModel,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
enum EosText {
    MieGruneisen {
        bulk_sound_speed: NumberText,
        hugoniot_slope: NumberText,
        gruneisen_coefficient: NumberText,
    },
    Logarithmic {
        bulk_modulus: NumberText,
    },
    Linear {
        bulk_sound_speed: NumberText,
    },
    LinearGamma {
        bulk_sound_speed: NumberText,
        gamma: NumberText,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
enum StrengthText {
    Fluid,
    Elastic { shear_modulus: NumberText },
    PerfectPlastic { shear_modulus: NumberText, yield_strength: NumberText },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
enum FailureText {
    None,
    TensileCutoff {
        tensile_strength: NumberText,
    },
    VoidGrowth {
        tensile_strength: NumberText,
        initial_distension: NumberText,
        viscosity: NumberText,
        coalescence_porosity: NumberText,
    },
}

/// What a number measures: a name for messages and the known units with their SI factors.
struct Quantity {
    dimension: &'static str,
    units: &'static [(&'static str, f64)],
}

const DENSITY: Quantity = Quantity { dimension: "density", units: &[("kg/m³", 1.0), ("g/cm³", 1e3)] };
const PRESSURE: Quantity =
    Quantity { dimension: "pressure", units: &[("Pa", 1.0), ("MPa", 1e6), ("GPa", 1e9)] };
const VELOCITY: Quantity = Quantity { dimension: "velocity", units: &[("m/s", 1.0), ("km/s", 1e3)] };
const VISCOSITY: Quantity = Quantity { dimension: "viscosity", units: &[("Pa s", 1.0)] };
const PURE: Quantity = Quantity { dimension: "pure number", units: &[("1", 1.0)] };

/// Turns the numbers of one entry into SI and remembers them.
struct Reader<'a> {
    name: &'a str,
    numbers: Vec<SourcedNumber>,
}

impl Entry {
    pub(super) fn read(name: &str, text: &str) -> Result<Self, LibraryError> {
        let syntax = |message: String| LibraryError::Syntax { name: name.to_owned(), message };
        let text: EntryText = ron::from_str(text).map_err(|error| syntax(error.to_string()))?;
        if text.name != name {
            return Err(syntax(format!("it calls itself `{}`", text.name)));
        }
        let mut reader = Reader { name, numbers: Vec::new() };
        let material = Material {
            name: text.name,
            reference_density: reader.si("reference_density", text.reference_density, &DENSITY)?,
            equation_of_state: reader.equation_of_state(text.equation_of_state)?,
            strength: reader.strength(text.strength)?,
            failure: reader.failure(text.failure)?,
            sound_speed: text.sound_speed,
        };
        material.validate().map_err(|faults| LibraryError::Invalid { name: name.to_owned(), faults })?;
        Ok(Self { material, description: text.description, numbers: reader.numbers })
    }
}

impl Reader<'_> {
    fn si(
        &mut self,
        field: &'static str,
        text: NumberText,
        quantity: &Quantity,
    ) -> Result<f64, LibraryError> {
        let NumberText { value, unit, source } = text;
        let Some((_, factor)) = quantity.units.iter().find(|(known, _)| *known == unit) else {
            let known = quantity.units.iter().map(|(known, _)| *known).collect();
            return Err(LibraryError::Unit {
                name: self.name.to_owned(),
                field,
                unit,
                dimension: quantity.dimension,
                known,
            });
        };
        let si_value = value * factor;
        self.numbers.push(SourcedNumber { field, value, unit, si_value, source });
        Ok(si_value)
    }

    fn equation_of_state(&mut self, text: EosText) -> Result<EquationOfState, LibraryError> {
        Ok(match text {
            EosText::MieGruneisen { bulk_sound_speed, hugoniot_slope, gruneisen_coefficient } => {
                EquationOfState::MieGruneisen(MieGruneisen {
                    bulk_sound_speed: self.si("bulk_sound_speed", bulk_sound_speed, &VELOCITY)?,
                    hugoniot_slope: self.si("hugoniot_slope", hugoniot_slope, &PURE)?,
                    gruneisen_coefficient: self.si("gruneisen_coefficient", gruneisen_coefficient, &PURE)?,
                })
            }
            EosText::Logarithmic { bulk_modulus } => EquationOfState::Logarithmic(Logarithmic {
                bulk_modulus: self.si("bulk_modulus", bulk_modulus, &PRESSURE)?,
            }),
            EosText::Linear { bulk_sound_speed } => EquationOfState::Linear(Linear {
                bulk_sound_speed: self.si("bulk_sound_speed", bulk_sound_speed, &VELOCITY)?,
            }),
            EosText::LinearGamma { bulk_sound_speed, gamma } => EquationOfState::LinearGamma(LinearGamma {
                bulk_sound_speed: self.si("bulk_sound_speed", bulk_sound_speed, &VELOCITY)?,
                gamma: self.si("gamma", gamma, &PURE)?,
            }),
        })
    }

    fn strength(&mut self, text: StrengthText) -> Result<Strength, LibraryError> {
        Ok(match text {
            StrengthText::Fluid => Strength::Fluid,
            StrengthText::Elastic { shear_modulus } => {
                Strength::Elastic { shear_modulus: self.si("shear_modulus", shear_modulus, &PRESSURE)? }
            }
            StrengthText::PerfectPlastic { shear_modulus, yield_strength } => Strength::PerfectPlastic {
                shear_modulus: self.si("shear_modulus", shear_modulus, &PRESSURE)?,
                yield_strength: self.si("yield_strength", yield_strength, &PRESSURE)?,
            },
        })
    }

    fn failure(&mut self, text: FailureText) -> Result<Failure, LibraryError> {
        Ok(match text {
            FailureText::None => Failure::None,
            FailureText::TensileCutoff { tensile_strength } => Failure::TensileCutoff {
                tensile_strength: self.si("tensile_strength", tensile_strength, &PRESSURE)?,
            },
            FailureText::VoidGrowth {
                tensile_strength,
                initial_distension,
                viscosity,
                coalescence_porosity,
            } => Failure::VoidGrowth(VoidGrowth {
                tensile_strength: self.si("tensile_strength", tensile_strength, &PRESSURE)?,
                initial_distension: self.si("initial_distension", initial_distension, &PURE)?,
                viscosity: self.si("viscosity", viscosity, &VISCOSITY)?,
                coalescence_porosity: self.si("coalescence_porosity", coalescence_porosity, &PURE)?,
            }),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = include_str!("copper-sound-wave.ron");

    #[test]
    fn a_unit_that_does_not_measure_the_quantity_is_an_error() {
        let wrong = GOOD.replacen("\"kg/m³\"", "\"GPa\"", 1);
        let message = Entry::read("copper-sound-wave", &wrong).unwrap_err().to_string();
        assert!(
            message.contains("reference_density has unit `GPa`; known units of a density are kg/m³"),
            "{message}"
        );
    }

    #[test]
    fn a_misspelled_field_an_impossible_number_and_a_wrong_name_are_errors() {
        let read = |text: &str| Entry::read("copper-sound-wave", text).unwrap_err().to_string();
        assert!(read(&GOOD.replacen("description", "descripton", 1)).contains("descripton"));
        assert!(read(&GOOD.replacen("value: ", "value: -", 1)).contains("must be greater than 0"));
        assert!(
            read(&GOOD.replacen("name: \"copper", "name: \"gold", 1))
                .contains("calls itself `gold-sound-wave`")
        );
    }
}
