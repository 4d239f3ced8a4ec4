//! Case files: text → tree with places → schema → checked case in SI.
//!
//! Three layers, each with its own types: [`schema`] is the file as written, [`resolve`] decides what is required,
//! what the defaults are and what must hold together, and [`case`] is what the rest of the program sees. Every fault of
//! a file is reported at once, with its line and column ([`fault`]).

pub mod case;
pub mod fault;
pub mod field;
pub mod medium;
pub mod node;
pub mod resolve;
mod resolve_layout;
mod resolve_material;
mod resolve_medium;
mod resolve_points;
mod resolve_scheme;
mod resolve_search;
pub mod schema;
pub mod schema_medium;
pub mod syntax;
pub mod tree;
pub mod units;

use std::path::Path;

pub use case::Case;
pub use fault::{CaseError, Fault};

/// Largest case file that is read [bytes].
const MAX_FILE: u64 = 1 << 20;

/// Reads a case file.
pub fn load(path: &Path) -> Result<Case, CaseError> {
    load_with(path, None)
}

/// Reads a case file with another particle size [m] than it has; all that must hold is checked with that one.
pub fn load_with(path: &Path, particle_size: Option<f64>) -> Result<Case, CaseError> {
    let shown = path.display().to_string();
    let refuse = |message: String| CaseError {
        path: shown.clone(),
        text: String::new(),
        faults: vec![Fault::new(0..0, message)],
    };
    let metadata =
        std::fs::metadata(path).map_err(|e| refuse(format!("the case file cannot be read: {e}")))?;
    if metadata.len() > MAX_FILE {
        return Err(refuse(format!(
            "the case file has {} bytes; at most {MAX_FILE} are read",
            metadata.len()
        )));
    }
    let bytes = std::fs::read(path).map_err(|e| refuse(format!("the case file cannot be read: {e}")))?;
    let text =
        String::from_utf8(bytes).map_err(|e| refuse(format!("the case file is not UTF-8 text: {e}")))?;
    let mut case = parse_with(&text, &shown, particle_size)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    for source in &mut case.data {
        if let case::DataSource::Csv { file, .. } = source {
            *file = folder.join(&*file);
        }
    }
    Ok(case)
}

/// Reads a case from text; `path` stands in the messages, and files that the case names are looked for beside it.
pub fn parse(text: &str, path: &str) -> Result<Case, CaseError> {
    parse_with(text, path, None)
}

fn parse_with(text: &str, path: &str, particle_size: Option<f64>) -> Result<Case, CaseError> {
    let faults = fault::Faults::default();
    let root = syntax::parse(text, &faults);
    let case = root.as_ref().and_then(|tree| {
        let mut schema: schema::CaseSchema = tree::read(tree, &faults)?;
        if let (Some(size), field::Field::Good(medium, span)) = (particle_size, &mut schema.medium) {
            let place = medium.particle_size.span().unwrap_or_else(|| span.clone());
            medium.particle_size = field::Field::Good(units::Length::from_si(size), place);
        }
        resolve::resolve(&schema, &tree.span, Path::new(path).parent().unwrap_or(Path::new("")), &faults)
    });
    match case {
        Some(case) if faults.is_empty() => Ok(case),
        _ => {
            Err(CaseError { path: path.into(), text: text.into(), faults: with_paths(faults, root.as_ref()) })
        }
    }
}

/// Adds to each fault the path of the field that it stands at.
fn with_paths(faults: fault::Faults, root: Option<&node::Node>) -> Vec<Fault> {
    let mut list = faults.into_sorted();
    list.retain(|f| !f.message.is_empty());
    for fault in &mut list {
        fault.field = root.map_or(String::new(), |tree| node::path_to(tree, &fault.span));
    }
    list
}
