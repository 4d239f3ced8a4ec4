//! The solid of a case: from the library, with another strength, or in full by its equation of state.

use sph_case::fault::name_hint;
use sph_case::units::{Density, Number, Pressure};
use sph_case::{Field, Span};
use sph_materials::eos::{Linear, LinearGamma, Logarithmic, MieGruneisen};
use sph_materials::{EquationOfState, Failure, Material, SoundSpeedModel, Strength, library};

use super::super::schema::*;
use super::Resolver;

/// Moduli and strengths that are accepted [Pa].
const STRENGTH: (f64, f64) = (1.0, 1e13);

impl Resolver<'_> {
    pub(super) fn material(&self, field: &Field<MaterialSchema>, group: &Span) -> Option<Material> {
        let schema = field.required("material", group, self.faults())?;
        let span = field.span().unwrap_or(group.clone());
        let material = match schema {
            MaterialSchema::Library(library) => self.library_material(library, &span),
            MaterialSchema::Logarithmic(m) => {
                let modulus = self.modulus(&m.bulk_modulus, "bulk_modulus", &span);
                let law = modulus.map(|bulk_modulus| Logarithmic { bulk_modulus });
                self.solid(
                    &m.density,
                    law.map(EquationOfState::Logarithmic),
                    (&m.shear_modulus, &m.yield_strength),
                    &span,
                )
            }
            MaterialSchema::Linear(m) => {
                let speed = self.checker.needed(&m.bulk_sound_speed, "bulk_sound_speed", &span, 1.0, 1e5);
                let law = speed.map(|bulk_sound_speed| Linear { bulk_sound_speed });
                self.solid(
                    &m.density,
                    law.map(EquationOfState::Linear),
                    (&m.shear_modulus, &m.yield_strength),
                    &span,
                )
            }
            MaterialSchema::LinearGamma(m) => {
                let speed = self.checker.needed(&m.bulk_sound_speed, "bulk_sound_speed", &span, 1.0, 1e5);
                let gamma = self.needed_number(&m.gamma, "gamma", &span, (1.0, 10.0));
                let law = speed.zip(gamma);
                let law = law.map(|(bulk_sound_speed, gamma)| LinearGamma { bulk_sound_speed, gamma });
                self.solid(
                    &m.density,
                    law.map(EquationOfState::LinearGamma),
                    (&m.shear_modulus, &m.yield_strength),
                    &span,
                )
            }
            MaterialSchema::MieGruneisen(m) => {
                let speed = self.checker.needed(&m.bulk_sound_speed, "bulk_sound_speed", &span, 1.0, 1e5);
                let slope = self.needed_number(&m.hugoniot_slope, "hugoniot_slope", &span, (0.0, 5.0));
                let gruneisen =
                    self.needed_number(&m.gruneisen_coefficient, "gruneisen_coefficient", &span, (0.0, 10.0));
                let law = speed.zip(slope).zip(gruneisen);
                let law = law.map(|((bulk_sound_speed, hugoniot_slope), gruneisen_coefficient)| {
                    MieGruneisen { bulk_sound_speed, hugoniot_slope, gruneisen_coefficient }
                });
                self.solid(
                    &m.density,
                    law.map(EquationOfState::MieGruneisen),
                    (&m.shear_modulus, &m.yield_strength),
                    &span,
                )
            }
        }?;
        for fault in material.validate().err().into_iter().flatten() {
            self.checker.refuse(span.clone(), fault.to_string(), "see the guide on materials");
        }
        Some(material)
    }

    fn modulus(&self, field: &Field<Pressure>, name: &str, span: &Span) -> Option<f64> {
        self.checker.needed(field, name, span, STRENGTH.0, STRENGTH.1)
    }

    fn needed_number(
        &self,
        field: &Field<Number>,
        name: &str,
        span: &Span,
        (low, high): (f64, f64),
    ) -> Option<f64> {
        field.required(name, span, self.faults())?;
        self.checker.number(field, low, low, high)
    }

    /// A named material; strength that is given beside the name replaces the library's.
    fn library_material(&self, m: &LibrarySchema, span: &Span) -> Option<Material> {
        let name = m.name.required("name", span, self.faults())?;
        let Ok(mut material) = library::material(name) else {
            let message = format!("no material of the library is called {name:?}");
            self.checker.refuse(
                m.name.span().unwrap_or_default(),
                message,
                &name_hint(name, &library::names()),
            );
            return None;
        };
        let given = |field: &Field<Pressure>, usual: f64| match field {
            Field::Absent => Some(usual),
            given => self.checker.quantity(given, STRENGTH.0, STRENGTH.1),
        };
        if !matches!((&m.shear_modulus, &m.yield_strength), (Field::Absent, Field::Absent)) {
            let shear_modulus = given(&m.shear_modulus, material.strength.shear_modulus());
            let yield_strength = given(&m.yield_strength, material.strength.yield_strength());
            material.strength = perfectly_plastic(shear_modulus?, yield_strength?);
        }
        Some(material)
    }

    fn solid(
        &self,
        density: &Field<Density>,
        equation_of_state: Option<EquationOfState>,
        (shear_modulus, yield_strength): (&Field<Pressure>, &Field<Pressure>),
        span: &Span,
    ) -> Option<Material> {
        let density = self.checker.needed(density, "density", span, 1.0, 1e5);
        let shear_modulus = self.modulus(shear_modulus, "shear_modulus", span);
        let yield_strength = match yield_strength {
            Field::Absent => Some(f64::INFINITY),
            given => self.checker.quantity(given, STRENGTH.0, STRENGTH.1),
        };
        Some(Material {
            name: "solid".into(),
            reference_density: density?,
            equation_of_state: equation_of_state?,
            strength: perfectly_plastic(shear_modulus?, yield_strength?),
            failure: Failure::None,
            sound_speed: SoundSpeedModel::Thermodynamic,
        })
    }
}

/// Elastic where there is no limit.
fn perfectly_plastic(shear_modulus: f64, yield_strength: f64) -> Strength {
    if yield_strength.is_finite() {
        Strength::PerfectPlastic { shear_modulus, yield_strength }
    } else {
        Strength::Elastic { shear_modulus }
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;
    use sph_case::Checker;
    use sph_materials::eos::IdealGas;

    use super::*;

    #[derive(Debug, Default, Deserialize)]
    #[serde(default)]
    struct Only {
        material: Field<MaterialSchema>,
    }

    fn read(text: &str) -> EquationOfState {
        let read = sph_case::read(text, "my.ron", "", |only: Only, whole, faults| {
            Resolver { checker: Checker { faults } }.material(&only.material, whole)
        });
        read.unwrap_or_else(|error| panic!("{error}")).equation_of_state
    }

    /// A law as a case file has it. An equation of state that is new is missing here until it has its schema, or a reason
    /// to have none.
    fn written(law: &EquationOfState) -> Option<String> {
        let (name, parameters) = match law {
            EquationOfState::Logarithmic(m) => {
                ("Logarithmic", format!("bulk_modulus: \"{} Pa\"", m.bulk_modulus))
            }
            EquationOfState::Linear(m) => {
                ("Linear", format!("bulk_sound_speed: \"{} m/s\"", m.bulk_sound_speed))
            }
            EquationOfState::LinearGamma(m) => (
                "LinearGamma",
                format!("bulk_sound_speed: \"{} m/s\", gamma: {:?}", m.bulk_sound_speed, m.gamma),
            ),
            EquationOfState::MieGruneisen(m) => (
                "MieGruneisen",
                format!(
                    "bulk_sound_speed: \"{} m/s\", hugoniot_slope: {:?}, gruneisen_coefficient: {:?}",
                    m.bulk_sound_speed, m.hugoniot_slope, m.gruneisen_coefficient
                ),
            ),
            // The problems of users are those of solids.
            EquationOfState::IdealGas(_) => return None,
        };
        let solid = "density: \"8000 kg/m3\", shear_modulus: \"40 GPa\"";
        Some(format!("(material: {name}({solid}, {parameters}))"))
    }

    #[test]
    fn every_law_of_a_solid_is_read_as_it_is_written() {
        let gas = EquationOfState::IdealGas(IdealGas { gamma: 1.4 });
        assert_eq!(written(&gas), None);
        for law in [
            EquationOfState::Logarithmic(Logarithmic { bulk_modulus: 1.5e11 }),
            EquationOfState::Linear(Linear { bulk_sound_speed: 4000.0 }),
            EquationOfState::LinearGamma(LinearGamma { bulk_sound_speed: 4000.0, gamma: 2.5 }),
            EquationOfState::MieGruneisen(MieGruneisen {
                bulk_sound_speed: 4000.0,
                hugoniot_slope: 1.5,
                gruneisen_coefficient: 2.0,
            }),
        ] {
            let text = written(&law).expect("a schema");
            assert_eq!(read(&text), law, "{text}");
        }
    }
}
