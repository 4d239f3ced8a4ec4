//! What can be wrong: with a material, with a name, with a wave that is asked for.

use thiserror::Error;

/// A number of a material that cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MaterialError {
    /// Infinite or not a number.
    #[error("material `{material}`: {field} = {value} {unit} is not a finite number")]
    NotFinite {
        /// Name of the material.
        material: String,
        /// Field that is wrong.
        field: &'static str,
        /// Its value, SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// Must be strictly greater than a bound.
    #[error("material `{material}`: {field} = {value} {unit} must be greater than {least}")]
    NotAbove {
        /// Name of the material.
        material: String,
        /// Field that is wrong.
        field: &'static str,
        /// Its value, SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// The bound.
        least: f64,
    },
    /// Must be at least a bound.
    #[error("material `{material}`: {field} = {value} {unit} must not be less than {least}")]
    BelowLeast {
        /// Name of the material.
        material: String,
        /// Field that is wrong.
        field: &'static str,
        /// Its value, SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// The bound.
        least: f64,
    },
}

/// A material that the library cannot give.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LibraryError {
    /// No material of that name.
    #[error("no material is named `{name}`; did you mean `{nearest}`? The library has: {}", known.join(", "))]
    UnknownMaterial {
        /// Name that was asked for.
        name: String,
        /// Known name with the fewest letters to change.
        nearest: &'static str,
        /// All known names.
        known: Vec<&'static str>,
    },
    /// The text of an entry does not read as an entry.
    #[error("material entry `{name}`: {message}")]
    Syntax {
        /// Name of the entry.
        name: String,
        /// What the reader said, with line and column.
        message: String,
    },
    /// A number has a unit that does not measure its quantity.
    #[error("material entry `{name}`: {field} has unit `{unit}`; known units of a {dimension} are {}", known.join(", "))]
    Unit {
        /// Name of the entry.
        name: String,
        /// Field of the number.
        field: &'static str,
        /// Unit that was written.
        unit: String,
        /// What the field measures.
        dimension: &'static str,
        /// Units that would do.
        known: Vec<&'static str>,
    },
    /// A number of an entry is out of its bounds.
    #[error("material entry `{name}`: {}", faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Invalid {
        /// Name of the entry.
        name: String,
        /// Every fault.
        faults: Vec<MaterialError>,
    },
}
