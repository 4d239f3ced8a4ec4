//! Case files: text → tree with places → the caller's schema → whatever the caller makes of it.
//!
//! A schema is a set of types with serde's `Deserialize`, all of whose fields are [`Field`]s: absent, refused, or read,
//! with their places. Quantities ([`units`]) are texts of number and unit. Every fault of a file is noted in one list
//! ([`fault`]) and reading goes on behind it, so that one run tells the user all of it. What is required, which ranges
//! hold and what the defaults are is decided behind the schema, with [`Checker`] for the usual cases.
//!
//! ```
//! use sph_case::units::{Length, LengthKind};
//! use sph_case::{Checker, Field, read};
//!
//! #[derive(Debug, Default, serde::Deserialize)]
//! #[serde(default, deny_unknown_fields)]
//! struct Schema {
//!     cell: Field<Length>,
//! }
//!
//! let resolve = |schema: Schema, whole: &std::ops::Range<usize>, faults: &sph_case::Faults| {
//!     Checker { faults }.needed(&schema.cell, "cell", whole, 1e-9, 1.0)
//! };
//! let cell = read("(cell: \"20 um\")", "case.ron", "", resolve).unwrap();
//! assert!((cell - 20e-6).abs() < 1e-18);
//! let error = read("(cell: \"20 GPa\", size: 3)", "case.ron", "", resolve).unwrap_err();
//! assert_eq!(error.faults.len(), 2);
//! assert!(error.to_string().contains("`GPa` is a unit of pressure, but this field is a length"));
//! ```
//!
//! The crate knows no physics and no defaults.

pub mod check;
pub mod fault;
pub mod field;
mod node;
mod syntax;
mod tree;
pub mod units;

use std::io::Read;
use std::path::Path;

use serde::Deserialize;

pub use check::Checker;
pub use fault::{CaseError, Fault, Faults, Span};
pub use field::Field;

/// Largest case file that is read [bytes].
const MAX_FILE: u64 = 1 << 20;

/// The text of a case file, without the mark that some editors put at its beginning.
///
/// # Errors
/// A file that cannot be read, is too large, or is no text.
pub fn text_of(path: &Path) -> Result<String, CaseError> {
    let refuse = |text: String, span: Span, message: String, hint: Option<String>| {
        let faults = vec![hint.into_iter().fold(Fault::new(span, message), Fault::hint)];
        CaseError { path: path.display().to_string(), text, faults, left_out: 0 }
    };
    let unreadable = |error: std::io::Error| {
        refuse(String::new(), 0..0, format!("the case file cannot be read: {error}"), hint(path, &error))
    };
    let mut bytes = Vec::new();
    // Not by the length that the system tells: a device or a pipe has none, and may never end.
    let mut file = std::fs::File::open(path).map_err(unreadable)?.take(MAX_FILE + 1);
    file.read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_FILE {
        let message =
            format!("the case file has more than {MAX_FILE} bytes, which are the most that are read");
        return Err(refuse(String::new(), 0..0, message, None));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        // The text up to there is the same with what cannot be read made visible.
        let (at, bytes) = (error.utf8_error().valid_up_to(), error.as_bytes());
        let shown = String::from_utf8_lossy(bytes).into_owned();
        let message = format!("the case file is not UTF-8 text: byte {:#04x} means nothing here", bytes[at]);
        let is_utf16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
        let hint = if is_utf16 { "this looks like UTF-16: save it as UTF-8" } else { "save it as UTF-8" };
        refuse(shown, at..at + char::REPLACEMENT_CHARACTER.len_utf8(), message, Some(hint.into()))
    })?;
    Ok(text.strip_prefix('\u{feff}').map(String::from).unwrap_or(text))
}

/// From where a file that is not there was looked for.
fn hint(path: &Path, error: &std::io::Error) -> Option<String> {
    let is_missing = error.kind() == std::io::ErrorKind::NotFound && path.is_relative();
    let here = std::env::current_dir().ok().filter(|_| is_missing)?;
    Some(format!("the path is relative to {}", here.display()))
}

/// Reads a case from text: into its schema `S`, and with `resolve` (schema, place of the whole, list of faults) into
/// what the caller wants. `path` stands in the messages, `example` is the hint beside an empty file.
///
/// # Errors
/// All faults that were noted.
pub fn read<S, T>(
    text: &str,
    path: &str,
    example: &str,
    resolve: impl FnOnce(S, &Span, &Faults) -> Option<T>,
) -> Result<T, CaseError>
where
    S: for<'de> Deserialize<'de>,
{
    let faults = Faults::default();
    let root = syntax::parse(text, example, &faults);
    let case = root.as_ref().and_then(|tree| {
        let schema: S = tree::read(tree, &faults)?;
        resolve(schema, &tree.span, &faults)
    });
    match case {
        Some(case) if faults.is_empty() => Ok(case),
        _ => {
            let left_out = faults.left_out();
            let faults = with_paths(faults, root.as_ref());
            Err(CaseError { path: path.into(), text: text.into(), faults, left_out })
        }
    }
}

/// Adds to each fault the path of the field that it stands at.
fn with_paths(faults: Faults, root: Option<&node::Node>) -> Vec<Fault> {
    let mut list = faults.into_sorted();
    list.retain(|f| !f.message.is_empty());
    for fault in &mut list {
        fault.field = root.map_or(String::new(), |tree| node::path_to(tree, &fault.span));
    }
    list
}
