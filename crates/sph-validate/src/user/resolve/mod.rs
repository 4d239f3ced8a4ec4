//! Schema → problem: required fields, defaults, ranges, and what the exact solution says. All faults are noted.
//!
//! Here: name, schemes, resolutions. [`material`] has the solids, [`problems`] the problems with the conditions that their
//! exact solutions put.

mod material;
mod problems;

use sph_case::{Checker, Faults, Field, Span};

use super::User;
use super::schema::*;
use crate::case::SchemeName;
use crate::suites::Suite;
use crate::suites::piston::Piston;
use crate::suites::riemann::Riemann;
use crate::suites::sound_wave::SoundWave;
use crate::suites::verny::Verny;
use crate::suites::window_solid::WindowSolid;

/// The newest format of these files.
const CASE_FORMAT: u64 = 1;

/// Turns what was written into a suite; `None` when a fault was noted, here or before.
pub fn resolve(schema: &CaseSchema, whole: &Span, faults: &Faults) -> Option<Box<dyn Suite>> {
    let r = Resolver { checker: Checker { faults } };
    r.checker.format(&schema.format, CASE_FORMAT);
    let name = r.name(&schema.name, whole);
    let schemes = r.schemes(&schema.schemes).unwrap_or_default();
    let problem = schema.problem.required("problem", whole, faults);
    let span = schema.problem.span().unwrap_or(whole.clone());
    let range = problem.map_or((1, 20_000), ProblemSchema::resolutions);
    let resolutions = r.resolutions(&schema.resolutions, whole, range).unwrap_or_default();
    let user = User { name: name.unwrap_or_default(), schemes, resolutions, problem: () };
    let suite = r.suite(problem?, &span, user)?;
    faults.is_empty().then_some(suite)
}

impl ProblemSchema {
    /// Least and greatest resolution that is accepted: what `n` counts differs.
    fn resolutions(&self) -> (u64, u64) {
        match self {
            Self::Riemann(_) | Self::Piston(_) | Self::SoundWave(_) => (20, 20_000),
            Self::Shell(_) => (3, 400),
            Self::Window(_) => (80, 20_000),
        }
    }
}

struct Resolver<'f> {
    checker: Checker<'f>,
}

impl Resolver<'_> {
    /// The suite of the problem.
    fn suite(&self, problem: &ProblemSchema, span: &Span, user: User<()>) -> Option<Box<dyn Suite>> {
        Some(match problem {
            ProblemSchema::Riemann(riemann) => {
                Box::new(Riemann { user: Some(user.with(self.riemann(riemann, span)?)) })
            }
            ProblemSchema::Piston(piston) => {
                Box::new(Piston { user: Some(user.with(self.piston(piston, span)?)) })
            }
            ProblemSchema::SoundWave(wave) => {
                Box::new(SoundWave::new(Some(user.with(self.sound_wave(wave, span)?))))
            }
            ProblemSchema::Shell(shell) => Box::new(Verny::new(Some(user.with(self.shell(shell, span)?)))),
            ProblemSchema::Window(window) => {
                Box::new(WindowSolid { user: Some(user.with(self.window(window, span)?)) })
            }
        })
    }

    fn faults(&self) -> &Faults {
        self.checker.faults
    }

    /// The name goes into file names.
    fn name(&self, field: &Field<String>, whole: &Span) -> Option<String> {
        let name = field.required("name", whole, self.faults())?;
        let is_good = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if !name.is_empty() && name.chars().all(is_good) {
            return Some(name.clone());
        }
        let message = format!("{name:?} cannot be a part of file names");
        self.checker.refuse(field.span().unwrap_or_default(), message, "letters, digits, `-` and `_`");
        None
    }

    fn schemes(&self, field: &Field<Vec<Field<SchemeName>>>) -> Option<Vec<SchemeName>> {
        match field {
            Field::Absent => Some(SchemeName::ALL.to_vec()),
            Field::Bad(_) => None,
            Field::Good(list, span) if list.is_empty() => {
                let hint = "`Csph`, `TkcMuscl`, `TkcHancock`; all if left out";
                self.checker.refuse(span.clone(), "no scheme is named".into(), hint);
                None
            }
            Field::Good(list, _) => {
                let mut schemes: Vec<SchemeName> =
                    list.iter().map(|scheme| scheme.get().copied()).collect::<Option<_>>()?;
                schemes.sort_unstable();
                schemes.dedup();
                Some(schemes)
            }
        }
    }

    fn resolutions(
        &self,
        field: &Field<Vec<Field<sph_case::units::Count>>>,
        whole: &Span,
        (low, high): (u64, u64),
    ) -> Option<Vec<u32>> {
        let list = field.required("resolutions", whole, self.faults())?;
        if list.is_empty() {
            let hint = "three or more show an order of convergence, such as [100, 200, 400]";
            self.checker.refuse(field.span().unwrap_or_default(), "no resolution is given".into(), hint);
            return None;
        }
        let counts: Vec<Option<usize>> = list.iter().map(|n| self.checker.count(n, low, low, high)).collect();
        let mut resolutions: Vec<u32> =
            counts.into_iter().map(|n| u32::try_from(n?).ok()).collect::<Option<_>>()?;
        resolutions.sort_unstable();
        resolutions.dedup();
        Some(resolutions)
    }
}
