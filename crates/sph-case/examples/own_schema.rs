//! A case file of one's own: a schema, its rules, and all faults of a file at once.
//!
//! `cargo run -p sph-case --example own_schema`

use sph_case::units::{Count, Length};
use sph_case::{CaseError, Checker, Faults, Field, Span, read};

/// The file as it is written.
#[derive(Debug, Default, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
struct PlateSchema {
    /// Thickness of the plate.
    thickness: Field<Length>,
    /// Particles across it.
    particles: Field<Count>,
}

/// What the program wants: SI, checked.
#[derive(Debug, PartialEq)]
struct Plate {
    /// Thickness [m].
    thickness: f64,
    /// Particles across it.
    particles: usize,
}

/// What is required, the ranges and the defaults.
fn resolve(schema: PlateSchema, whole: &Span, faults: &Faults) -> Option<Plate> {
    let check = Checker { faults };
    let thickness = check.needed(&schema.thickness, "thickness", whole, 1e-6, 1.0);
    let particles = check.count(&schema.particles, 40, 2, 10_000);
    Some(Plate { thickness: thickness?, particles: particles? })
}

fn plate(text: &str) -> Result<Plate, CaseError> {
    read(text, "plate.ron", "(thickness: \"5 mm\")", resolve)
}

/// Reads a good file and a bad one.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let good = plate("(thickness: \"5 mm\")")?;
    println!("{good:?}");
    if good != (Plate { thickness: 5e-3, particles: 40 }) {
        return Err("it is not what was written".into());
    }
    match plate("(thickness: \"5 GPa\",\n particels: 80)") {
        Err(error) if error.faults.len() == 2 => println!("{}", error.render(false)),
        other => return Err(format!("two faults are expected: {other:?}").into()),
    }
    Ok(())
}
