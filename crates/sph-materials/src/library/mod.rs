//! Named materials: one RON file each, every number with its unit and source.
//!
//! The files lie in `src/library/` and are part of the compiled crate. A number is written as
//! `(value: 43.0, unit: "GPa", source: "…")`; units are converted to SI while reading, and a unit that does not
//! measure its quantity is an error. The tests read every file.
//!
//! | name | for |
//! |---|---|
//! | `porous-copper` | the solid copper of the porous-copper simulations |
//! | `aluminium-riemann` | elastic-plastic Riemann problem |
//! | `copper-sound-wave` | longitudinal sound wave |
//! | `aluminium-verney` | collapsing cylindrical shell |
//!
//! # Adding a material
//!
//! One file, one line in `TEXTS`.

mod entry;

pub use entry::{Entry, SourcedNumber};

use crate::error::LibraryError;
use crate::material::Material;

/// Name and text of every entry.
const TEXTS: &[(&str, &str)] = &[
    ("porous-copper", include_str!("porous-copper.ron")),
    ("aluminium-riemann", include_str!("aluminium-riemann.ron")),
    ("copper-sound-wave", include_str!("copper-sound-wave.ron")),
    ("aluminium-verney", include_str!("aluminium-verney.ron")),
];

/// Names of all materials.
pub fn names() -> Vec<&'static str> {
    TEXTS.iter().map(|(name, _)| *name).collect()
}

/// The material of that name.
///
/// # Errors
///
/// [`LibraryError::UnknownMaterial`] with the nearest name and all names.
pub fn material(name: &str) -> Result<Material, LibraryError> {
    Ok(entry(name)?.material)
}

/// The material of that name, with unit and source of each number.
///
/// # Errors
///
/// [`LibraryError::UnknownMaterial`] with the nearest name and all names.
pub fn entry(name: &str) -> Result<Entry, LibraryError> {
    match TEXTS.iter().find(|(known, _)| *known == name) {
        Some((known, text)) => Entry::read(known, text),
        None => Err(unknown(name)),
    }
}

fn unknown(name: &str) -> LibraryError {
    let distance = |known: &str| strsim::damerau_levenshtein(&name.to_lowercase(), known);
    let nearest = names().into_iter().min_by_key(|known| distance(known)).unwrap_or_default();
    LibraryError::UnknownMaterial { name: name.to_owned(), nearest, known: names() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{EquationOfState, Failure, Strength};

    #[test]
    fn every_entry_reads_is_valid_and_names_a_source_for_each_number() {
        for name in names() {
            let entry = entry(name).unwrap();
            assert_eq!(entry.material.name, name);
            assert!(!entry.description.is_empty());
            assert!(entry.numbers.iter().all(|number| number.source.len() > 10), "{name}");
            entry.material.validate().unwrap();
        }
    }

    #[test]
    fn copper_is_that_of_table_1() {
        let copper = material("porous-copper").unwrap();
        assert_eq!(copper.reference_density, 8960.0);
        let EquationOfState::MieGruneisen(eos) = copper.equation_of_state else { panic!("{copper:?}") };
        assert_eq!((eos.bulk_sound_speed, eos.hugoniot_slope, eos.gruneisen_coefficient), (3930.0, 1.5, 1.7));
        assert_eq!(copper.strength, Strength::PerfectPlastic { shear_modulus: 43e9, yield_strength: 0.35e9 });
        assert_eq!(copper.failure, Failure::TensileCutoff { tensile_strength: 0.35e9 });
    }

    #[test]
    fn a_wrong_name_gets_the_nearest_and_all() {
        let message = material("porous-coper").unwrap_err().to_string();
        assert!(
            message.contains("did you mean `porous-copper`?") && message.contains("aluminium-verney"),
            "{message}"
        );
    }

    #[test]
    fn a_material_survives_a_round_trip_through_text() {
        for name in names() {
            let material = material(name).unwrap();
            let text = ron::to_string(&material).unwrap();
            assert_eq!(ron::from_str::<Material>(&text).unwrap(), material);
        }
        let with_a_stranger = "(name: \"x\", reference_density: 1.0, color: 3)";
        assert!(ron::from_str::<Material>(with_a_stranger).unwrap_err().to_string().contains("color"));
    }
}
