//! Case files: text → tree with places → schema → checked case in SI.
//!
//! Three layers, each with its own types: `schema` is the file as written, `resolve` decides what is required,
//! what the defaults are and what must hold together, and [`case`] is what the rest of the program sees. Every fault of
//! a file is reported at once, with its line and column.

pub mod case;
pub mod medium;
mod resolve;
mod resolve_image;
mod resolve_layout;
mod resolve_material;
mod resolve_medium;
mod resolve_points;
mod resolve_scheme;
mod resolve_search;
mod resolve_shapes;
mod schema;
mod schema_medium;

use std::path::Path;

pub use case::Case;
pub(crate) use resolve::PARTICLE_VELOCITIES;
pub use sph_case::{CaseError, Fault};
pub(crate) use sph_case::{fault, field, text_of, units};

/// Reads a case file.
///
/// # Errors
/// [`CaseError`] with every fault of the file, each at its place; also if the file cannot be read.
pub fn load(path: &Path) -> Result<Case, CaseError> {
    read(&text_of(path)?, path, None)
}

/// Reads the text of a case file, with another particle size [m] than it has if one is given; all that must hold is checked
/// with that one.
///
/// # Errors
/// [`CaseError`] with every fault of the text, each at its place.
pub(crate) fn read(text: &str, path: &Path, particle_size: Option<f64>) -> Result<Case, CaseError> {
    let shown = path.display().to_string();
    let mut case = parse_with(text, &shown, particle_size)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    for source in &mut case.data {
        if let case::DataSource::Csv { file, .. } = source {
            *file = folder.join(&*file);
        }
    }
    Ok(case)
}

/// Reads a case from text; `path` stands in the messages, and files that the case names are looked for beside it.
///
/// # Errors
/// [`CaseError`] with every fault of the text, each at its place.
pub fn parse(text: &str, path: &str) -> Result<Case, CaseError> {
    parse_with(text, path, None)
}

fn parse_with(text: &str, path: &str, particle_size: Option<f64>) -> Result<Case, CaseError> {
    let folder = Path::new(path).parent().unwrap_or(Path::new(""));
    let example = "`hugoniot init porous-copper` writes a case";
    sph_case::read(text, path, example, |mut schema: schema::CaseSchema, whole, faults| {
        if let (Some(size), field::Field::Good(medium, span)) = (particle_size, &mut schema.medium) {
            let place = medium.particle_size.span().unwrap_or_else(|| span.clone());
            medium.particle_size = field::Field::Good(units::Length::from_si(size), place);
        }
        resolve::resolve(&schema, whole, folder, faults)
    })
}
