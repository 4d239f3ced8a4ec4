//! How the frame is found, `search` of a case, and whether there is a front to be found.

use sph_materials::Material;
use sph_window::{Bisection, FrameTracking, Search};

use super::field::Field;
use super::resolve::Resolver;
use super::schema::{BisectionSchema, SearchSchema};
use super::units::{VelocityKind, show};
use crate::separation;

/// Least and greatest velocity of an outlet that is accepted [m/s].
const OUTLET: (f64, f64) = (0.0, 2e4);

impl Resolver<'_> {
    /// Tracking if nothing is said.
    pub(super) fn search(&self, field: &Field<SearchSchema>) -> Option<Search> {
        match field {
            Field::Bad(_) => None,
            Field::Absent | Field::Good(SearchSchema::Tracking, _) => {
                Some(Search::FrameTracking(FrameTracking::default()))
            }
            Field::Good(SearchSchema::Bisection(bisection), _) => {
                self.bisection(bisection).map(Search::Bisection)
            }
        }
    }

    /// No front overruns the elastic precursor.
    pub(super) fn fronts_separate<T>(
        &self,
        field: &Field<T>,
        materials: &[Material],
        porosity: f64,
        points: &[f64],
    ) {
        for &u_p in points {
            if let Some((message, hint)) = separation::refusal(materials, porosity, u_p) {
                self.refuse(field.span().unwrap_or(0..0), message, &hint);
            }
        }
    }

    fn bisection(&self, b: &BisectionSchema) -> Option<Bisection> {
        let usual = Bisection::default();
        let samples = self.count(&b.samples, usual.samples as u64, 1, 1000);
        let rounds = self.count(&b.rounds, u64::from(usual.rounds), 1, 10);
        let tolerance = match &b.tolerance {
            Field::Absent => Some(usual.tolerance),
            given => self.quantity(given, 1e-3, 1e3),
        };
        let bracket = self.bracket(b);
        Some(Bisection {
            bracket: bracket?,
            samples: samples? as f64,
            tolerance: tolerance?,
            rounds: u32::try_from(rounds?).ok()?,
            ..usual
        })
    }

    /// Both ends of the bracket, or none.
    fn bracket(&self, b: &BisectionSchema) -> Option<Option<(f64, f64)>> {
        let (from, to) = match (&b.outlet_from, &b.outlet_to) {
            (Field::Absent, Field::Absent) => return Some(None),
            (Field::Absent, given) | (given, Field::Absent) => {
                let hint =
                    "both ends of the bracket, or none: then it lies about the speed of the front on its way";
                self.refuse(given.span()?, "one end of a bracket is given".into(), hint);
                return None;
            }
            (from, to) => (self.quantity(from, OUTLET.0, OUTLET.1)?, self.quantity(to, OUTLET.0, OUTLET.1)?),
        };
        if from >= to {
            let message =
                format!("the bracket ends at {}, where it starts or before", show::<VelocityKind>(to));
            let hint = format!("above `outlet_from`, {}", show::<VelocityKind>(from));
            self.refuse(b.outlet_to.span()?, message, &hint);
            return None;
        }
        Some(Some((from, to)))
    }
}
