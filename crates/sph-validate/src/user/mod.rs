//! Problems of the user's own: a case file → a suite whose exact reference is computed, not looked up.
//!
//! Two stages, as for every case file of the house: `schema` is the file as written, `resolve` makes a checked problem
//! in SI, or a list of all faults with their places. What the exact solution refuses (vacuum, overdriven shock, nothing
//! that moves, no plastic wave) is a fault of the problem, with the condition that it breaks.
//!
//! A user's problem has no gates: its figures are shown beside their references, with the observed orders.

mod resolve;
mod schema;

use std::path::Path;

use sph_case::CaseError;

use crate::case::{Case, SchemeName};
use crate::suites::Suite;

/// What a user's case says besides the problem.
#[derive(Clone, Debug, PartialEq)]
pub struct User<P> {
    /// What it is called: the variant of its runs.
    pub name: String,
    /// Schemes to run.
    pub schemes: Vec<SchemeName>,
    /// Resolutions, coarse to fine.
    pub resolutions: Vec<u32>,
    /// The problem.
    pub problem: P,
}

impl User<()> {
    /// The same with its problem.
    fn with<P>(self, problem: P) -> User<P> {
        User { name: self.name, schemes: self.schemes, resolutions: self.resolutions, problem }
    }
}

impl<P> User<P> {
    /// The runs of the case, of the suite of that name.
    pub fn cases(&self, suite: &str) -> Vec<Case> {
        let grid = Case::grid(suite, &self.schemes, &self.resolutions).into_iter();
        grid.map(|case| case.of_variant(&self.name)).collect()
    }
}

/// Reads a case file.
///
/// # Errors
/// All faults of the file, with their places.
pub fn load(path: &Path) -> Result<Box<dyn Suite>, CaseError> {
    parse(&sph_case::text_of(path)?, &path.display().to_string())
}

/// Reads a case from text; `path` stands in the messages.
///
/// # Errors
/// All faults of the text, with their places.
pub fn parse(text: &str, path: &str) -> Result<Box<dyn Suite>, CaseError> {
    sph_case::read(text, path, "examples: validation/cases/ in the repository", |schema, whole, faults| {
        resolve::resolve(&schema, whole, faults)
    })
}

#[cfg(test)]
mod tests;
