//! Points and measured data of a case: lists, ranges, adaptive sweeps.

use std::path::{Path, PathBuf};

use super::case::{DataSource, Refinement};
use super::field::Field;
use super::resolve::{PARTICLE_VELOCITIES, Resolver, span_of};
use super::schema::{AdaptiveSchema, DataSchema, PointsSchema, RangeSchema};
use super::units::{Velocity, VelocityKind, show};
use crate::curve::measured::{self, DataError};
use sph_case::Span;

/// Most points of a case.
const MAX_POINTS: usize = 1000;

impl Resolver<'_> {
    /// Points of the first round [m/s], rising, and how more are chosen.
    pub(super) fn points(
        &self,
        points: &PointsSchema,
        group: &Span,
    ) -> Option<(Vec<f64>, Option<Refinement>)> {
        match points {
            PointsSchema::List(list) => Some((self.listed_points(list, group)?, None)),
            PointsSchema::Range(range) => Some((self.range(range, group)?, None)),
            PointsSchema::Adaptive(adaptive) => self.adaptive(adaptive, group),
        }
    }

    fn listed_points(&self, list: &[Field<Velocity>], group: &Span) -> Option<Vec<f64>> {
        self.number_of_points(list.len(), 1, group)?;
        let mut points: Vec<f64> = Vec::new();
        for field in list {
            let Some(velocity) = self.quantity(field, PARTICLE_VELOCITIES.0, PARTICLE_VELOCITIES.1) else {
                continue;
            };
            match points.contains(&velocity) {
                true => self.refuse(
                    span_of(field),
                    format!("{velocity} m/s is listed twice"),
                    "list each point once",
                ),
                false => points.push(velocity),
            }
        }
        points.sort_by(f64::total_cmp);
        (!points.is_empty()).then_some(points)
    }

    fn number_of_points(&self, count: usize, least: usize, span: &Span) -> Option<()> {
        if (least..=MAX_POINTS).contains(&count) {
            return Some(());
        }
        let hint = format!("from {least} to {MAX_POINTS}, such as [\"50 m/s\", \"100 m/s\"]");
        self.refuse(span.clone(), format!("{count} points"), &hint);
        None
    }

    /// Both ends [m/s], in this order.
    fn ends(&self, from: &Field<Velocity>, to: &Field<Velocity>, group: &Span) -> Option<(f64, f64)> {
        let (low, high) = PARTICLE_VELOCITIES;
        let start = self.needed(from, "from", group, low, high);
        let end = self.needed(to, "to", group, low, high);
        let (start, end) = (start?, end?);
        if start < end {
            return Some((start, end));
        }
        let (a, b) = (show::<VelocityKind>(start), show::<VelocityKind>(end));
        self.refuse(
            span_of(to),
            format!("the range ends at {b}, not above its start {a}"),
            "exchange the two",
        );
        None
    }

    fn range(&self, range: &RangeSchema, group: &Span) -> Option<Vec<f64>> {
        let ends = self.ends(&range.from, &range.to, group);
        let step = self.quantity(&range.step, 0.1, PARTICLE_VELOCITIES.1);
        let count = self.count(&range.count, 0, 2, MAX_POINTS as u64);
        match (&range.step, &range.count) {
            (Field::Absent, Field::Absent) | (Field::Good(..), Field::Good(..)) => {
                let message = "a range takes either a step or a count".to_string();
                self.refuse(group.clone(), message, "step: \"25 m/s\", or count: 11");
                None
            }
            (Field::Absent, _) => Some(evenly(ends?, count?)),
            (_, _) => {
                let ((from, to), step) = (ends?, step?);
                // A last step that misses the end by rounding alone still reaches it.
                let steps = ((to - from) / step + 1e-9).floor() as usize;
                self.number_of_points(steps + 1, 2, &span_of(&range.step))?;
                Some((0..=steps).map(|k| rounded(from + k as f64 * step)).collect())
            }
        }
    }

    fn adaptive(&self, a: &AdaptiveSchema, group: &Span) -> Option<(Vec<f64>, Option<Refinement>)> {
        let ends = self.ends(&a.from, &a.to, group);
        let tolerance = self.number(&a.tolerance, 0.005, 1e-4, 0.2);
        let max_points = self.count(&a.max_points, 16, 4, MAX_POINTS as u64);
        let initial = self.count(&a.initial_points, 5, 4, MAX_POINTS as u64);
        let (max_points, initial) = (max_points?, initial?);
        if initial > max_points {
            let message = format!("{initial} initial points are more than the {max_points} at most");
            self.refuse(a.initial_points.span().unwrap_or(group.clone()), message, "raise max_points");
            return None;
        }
        Some((evenly(ends?, initial), Some(Refinement { tolerance: tolerance?, max_points })))
    }

    /// Measured curves, in the order of the file; their files are looked for in `folder`.
    pub(super) fn data(
        &self,
        data: &Field<Vec<Field<DataSchema>>>,
        folder: &Path,
    ) -> Option<Vec<DataSource>> {
        match data {
            Field::Absent => Some(Vec::new()),
            Field::Bad(_) => None,
            Field::Good(list, _) => {
                let sources: Vec<Option<DataSource>> =
                    list.iter().map(|s| self.data_source(s, folder)).collect();
                sources.into_iter().collect()
            }
        }
    }

    /// A curve, with what is wrong with its file.
    fn data_source(&self, source: &Field<DataSchema>, folder: &Path) -> Option<DataSource> {
        match source.get()? {
            DataSchema::Boade1970 => Some(DataSource::Boade1970),
            DataSchema::Csv(csv) => {
                let file = csv.file.required("file", &span_of(source), self.faults)?;
                if file.is_empty() {
                    self.refuse(
                        span_of(&csv.file),
                        "the file has no name".into(),
                        "such as \"measured.csv\"",
                    );
                    return None;
                }
                let name = csv.name.get();
                if let Err(error) = measured::load(&folder.join(file), name.map(String::as_str)) {
                    let hint = match &error {
                        DataError::Unreadable { .. } => "a CSV file, its path relative to the case file",
                        DataError::Faults { .. } => {
                            "columns `u_p [m/s]` and `u_s [m/s]`; `u_p_error`, `u_s_error`, `u_ahead` and `source` may be there"
                        }
                    };
                    for message in error.to_string().lines() {
                        self.refuse(span_of(&csv.file), message.into(), hint);
                    }
                    return None;
                }
                Some(DataSource::Csv { file: PathBuf::from(file), name: name.cloned() })
            }
        }
    }
}

/// Evenly spaced values from one end to the other.
fn evenly((from, to): (f64, f64), count: usize) -> Vec<f64> {
    (0..count).map(|k| rounded(from + (to - from) * k as f64 / (count - 1) as f64)).collect()
}

/// A tenth of a millimeter a second: names of files stay short.
fn rounded(velocity: f64) -> f64 {
    (velocity * 1e4).round() / 1e4
}
