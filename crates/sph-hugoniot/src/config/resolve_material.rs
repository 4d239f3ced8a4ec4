//! The solid of a case: from the library with changes, or in full.

use sph_materials::eos::MieGruneisen;
use sph_materials::{EquationOfState, Failure, Material, SoundSpeedModel, Strength, VoidGrowth, library};

use super::fault::{Fault, Span, name_hint};
use super::field::Field;
use super::resolve::{Resolver, span_of};
use super::schema::{CaseSchema, FailureSchema, LibrarySchema, MaterialSchema, SolidSchema};

/// Least and greatest modulus or strength that is accepted [Pa].
const STRENGTH: (f64, f64) = (1.0, 1e13);

/// Most materials of a case.
const MOST: usize = 16;

impl Resolver<'_> {
    /// The materials of a case: the only one, or the list.
    pub(super) fn materials(&self, schema: &CaseSchema, whole: &Span) -> Option<Vec<Material>> {
        let (list, span) = match &schema.materials {
            Field::Absent => {
                let material = schema.material.required("material", whole, self.faults)?;
                return self.material(material, &span_of(&schema.material)).map(|m| vec![m]);
            }
            Field::Bad(_) => return None,
            Field::Good(list, span) => (list, span),
        };
        if let Some(other) = schema.material.span() {
            self.refuse(other, "both `material` and `materials` are given".into(), "leave one out");
            return None;
        }
        if list.is_empty() || list.len() > MOST {
            let message = format!("{} materials", list.len());
            self.refuse(
                span.clone(),
                message,
                &format!("from 1 to {MOST}; the first fills what nothing else does"),
            );
            return None;
        }
        let read: Vec<Option<Material>> =
            list.iter().map(|field| field.get().and_then(|m| self.material(m, &span_of(field)))).collect();
        let materials: Vec<Material> = read.into_iter().collect::<Option<_>>()?;
        for (k, material) in materials.iter().enumerate() {
            if materials[..k].iter().any(|m| m.name == material.name) {
                let message = format!("two materials are called {:?}", material.name);
                self.refuse(
                    span_of(&list[k]),
                    message,
                    "`called: \"…\"` gives a library's material another name",
                );
                return None;
            }
        }
        Some(materials)
    }

    pub(super) fn material(&self, material: &MaterialSchema, group: &Span) -> Option<Material> {
        let material = match material {
            MaterialSchema::Library(m) => self.library_material(m, group)?,
            MaterialSchema::MieGruneisen(m) => self.solid(m, group)?,
        };
        for fault in material.validate().err().into_iter().flatten() {
            self.faults.push(Fault::new(group.clone(), fault.to_string()));
        }
        Some(material)
    }

    /// A named material; what is given beside the name replaces the library's numbers.
    fn library_material(&self, m: &LibrarySchema, group: &Span) -> Option<Material> {
        let shear_modulus = self.quantity(&m.shear_modulus, STRENGTH.0, STRENGTH.1);
        let yield_strength = self.quantity(&m.yield_strength, STRENGTH.0, STRENGTH.1);
        let tensile_strength = self.quantity(&m.tensile_strength, STRENGTH.0, STRENGTH.1);
        let name = m.name.required("name", group, self.faults)?;
        let Ok(mut material) = library::material(name) else {
            let span = m.name.span().unwrap_or_default();
            let message = format!("no material of the library is called {name:?}");
            self.refuse(span, message, &name_hint(name, &library::names()));
            return None;
        };
        if let Some(called) = m.called.get() {
            material.name.clone_from(called);
        }
        let shear_modulus = shear_modulus.or(Some(material.strength.shear_modulus()).filter(|&g| g > 0.0));
        let known_yield = match material.strength {
            Strength::PerfectPlastic { yield_strength, .. } => Some(yield_strength),
            Strength::Fluid | Strength::Elastic { .. } => None,
        };
        material.strength = strength(shear_modulus, yield_strength.or(known_yield));
        let known = Some(material.failure.tensile_strength()).filter(|t| t.is_finite());
        let unchanged = matches!((&m.tensile_strength, &m.tensile_failure), (Field::Absent, Field::Absent));
        if !unchanged {
            material.failure = self.failure(&m.tensile_failure, tensile_strength.or(known))?;
        }
        material.sound_speed = self.choice(&m.contact_sound_speed, SoundSpeedModel::Thermodynamic)?;
        Some(material)
    }

    fn solid(&self, m: &SolidSchema, group: &Span) -> Option<Material> {
        let density = self.needed(&m.density, "density", group, 1.0, 1e5);
        let bulk_sound_speed = self.needed(&m.bulk_sound_speed, "bulk_sound_speed", group, 1.0, 1e5);
        m.hugoniot_slope.required("hugoniot_slope", group, self.faults);
        m.gruneisen_coefficient.required("gruneisen_coefficient", group, self.faults);
        let hugoniot_slope = self.number(&m.hugoniot_slope, 1.5, 0.0, 5.0);
        let gruneisen_coefficient = self.number(&m.gruneisen_coefficient, 1.7, 0.0, 10.0);
        let shear_modulus = self.quantity(&m.shear_modulus, STRENGTH.0, STRENGTH.1);
        let yield_strength = self.quantity(&m.yield_strength, STRENGTH.0, STRENGTH.1);
        let tensile_strength = self.quantity(&m.tensile_strength, STRENGTH.0, STRENGTH.1);
        if let (Field::Absent, Field::Good(_, span)) = (&m.shear_modulus, &m.yield_strength) {
            let message = "a yield strength without a shear modulus".to_string();
            self.refuse(span.clone(), message, "add `shear_modulus: …`, or leave both out for a fluid");
        }
        Some(Material {
            name: m.name.get().cloned().unwrap_or_else(|| "solid".into()),
            reference_density: density?,
            equation_of_state: EquationOfState::MieGruneisen(MieGruneisen {
                bulk_sound_speed: bulk_sound_speed?,
                hugoniot_slope: hugoniot_slope?,
                gruneisen_coefficient: gruneisen_coefficient?,
            }),
            strength: strength(shear_modulus, yield_strength),
            failure: self.failure(&m.tensile_failure, tensile_strength)?,
            sound_speed: self.choice(&m.contact_sound_speed, SoundSpeedModel::Thermodynamic)?,
        })
    }

    /// The failure model, from the strength [Pa] that is known.
    fn failure(&self, field: &Field<FailureSchema>, tensile_strength: Option<f64>) -> Option<Failure> {
        let (v, span) = match (field, tensile_strength) {
            (Field::Bad(_), _) => return None,
            (Field::Absent | Field::Good(FailureSchema::Cutoff, _), strength) => {
                let cutoff = |tensile_strength| Failure::TensileCutoff { tensile_strength };
                return Some(strength.map_or(Failure::None, cutoff));
            }
            (Field::Good(FailureSchema::VoidGrowth(v), span), _) => (v, span),
        };
        let usual = VoidGrowth::of_strength(tensile_strength.unwrap_or(1.0));
        let initial_distension =
            self.number(&v.initial_distension, usual.initial_distension, 1.0 + 1e-9, 1.2);
        let viscosity = match v.viscosity {
            Field::Absent => Some(usual.viscosity),
            _ => self.quantity(&v.viscosity, 1e-6, 1e6),
        };
        let coalescence_porosity =
            self.number(&v.coalescence_porosity, usual.coalescence_porosity, 0.2, 0.99);
        if tensile_strength.is_none() {
            let message = "growth of voids without a tensile strength".to_string();
            self.refuse(span.clone(), message, "add `tensile_strength: …`, where growth begins");
        }
        Some(Failure::VoidGrowth(VoidGrowth {
            tensile_strength: tensile_strength?,
            initial_distension: initial_distension?,
            viscosity: viscosity?,
            coalescence_porosity: coalescence_porosity?,
        }))
    }
}

/// Strength from what is known of it.
fn strength(shear_modulus: Option<f64>, yield_strength: Option<f64>) -> Strength {
    match (shear_modulus, yield_strength) {
        (Some(shear_modulus), Some(yield_strength)) => {
            Strength::PerfectPlastic { shear_modulus, yield_strength }
        }
        (Some(shear_modulus), None) => Strength::Elastic { shear_modulus },
        (None, _) => Strength::Fluid,
    }
}
