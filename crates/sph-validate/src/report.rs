//! Rows of the report: figures, references, orders and gates; the terminal table and `results.json`.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use sph_io::table::{Column, Table};

use crate::case::{Case, SchemeName, SuiteName, Tier};
use crate::error::ValidateError;
use crate::gate::{Gate, GateFile, Significant};
use crate::metric::{Metric, fitted_order, observed_order};
use crate::suites::{Cost, Outcome};

/// One figure with everything that judges it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The problem.
    pub suite: SuiteName,
    /// The scheme.
    pub scheme: SchemeName,
    /// Resolution; absent for the order that is fitted over all of them.
    pub n: Option<u32>,
    /// Name of the figure.
    pub metric: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// What it should be; absent for an order.
    pub reference: Option<f64>,
    /// What it must reach; absent for a figure that is only shown.
    pub gate: Option<Gate>,
    /// Order of convergence from the next coarser resolution to this one.
    pub order: Option<f64>,
    /// Whether it passed its gate.
    pub passed: Option<bool>,
}

/// What one run cost, or why it failed.
#[derive(Clone, Debug, Serialize)]
pub struct RunRecord {
    /// Which run.
    #[serde(flatten)]
    pub case: Case,
    /// What it cost.
    pub cost: Option<Cost>,
    /// Why it gave nothing.
    pub failure: Option<String>,
}

/// All that a validation found: `results.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Command line that makes it again.
    pub command: String,
    /// How much was run.
    pub tier: Tier,
    /// The figures.
    pub rows: Vec<Row>,
    /// The runs.
    pub runs: Vec<RunRecord>,
}

impl Report {
    /// Judges the outcomes; failed runs are kept as records.
    pub fn new(
        command: String,
        tier: Tier,
        results: &[(Case, Result<Outcome, ValidateError>)],
    ) -> Result<Self, ValidateError> {
        let outcomes: Vec<&Outcome> = results.iter().filter_map(|(_, result)| result.as_ref().ok()).collect();
        Ok(Self { command, tier, rows: rows(&outcomes)?, runs: results.iter().map(record).collect() })
    }

    /// Rows that missed their gate.
    pub fn failures(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.passed == Some(false))
    }

    /// Number of rows with a gate.
    pub fn n_gates(&self) -> usize {
        self.rows.iter().filter(|row| row.passed.is_some()).count()
    }

    /// Suites that have rows, in order.
    pub fn suites(&self) -> impl Iterator<Item = SuiteName> {
        SuiteName::ALL.into_iter().filter(|&suite| self.rows.iter().any(|row| row.suite == suite))
    }

    /// Writes `results.json`.
    pub fn write_json(&self, path: &Path) -> Result<(), ValidateError> {
        let fault = |reason: String| ValidateError::Output { path: path.to_owned(), reason };
        let mut text = serde_json::to_string_pretty(self).map_err(|error| fault(error.to_string()))?;
        text.push('\n');
        sph_io::write_atomic(path, text.as_bytes()).map_err(|error| fault(error.to_string()))
    }

    /// The table of one suite for the terminal.
    pub fn table(&self, suite: SuiteName) -> String {
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.suite == suite).collect();
        let column = |name: &str, cell: &dyn Fn(&Row) -> String| {
            Column::text(name, "", rows.iter().map(|row| cell(row)).collect::<Vec<_>>())
        };
        let optional = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.2}"));
        Table::new(format!("\n{} (n: {})", suite.title(), suite.resolution_name()))
            .with(column("scheme", &|row| row.scheme.to_string()))
            .with(column("n", &|row| row.n.map_or("all".into(), |n| n.to_string())))
            .with(column("metric", &|row| row.metric.clone()))
            .with(column("value", &|row| format!("{:.5}", Significant(row.value))))
            .with(column("unit", &|row| row.unit.to_owned()))
            .with(column("reference", &|row| {
                row.reference.map_or(String::new(), |value| format!("{:.5}", Significant(value)))
            }))
            .with(column("gate", &|row| row.gate.map_or(String::new(), |gate| gate.to_string())))
            .with(column("order", &|row| optional(row.order)))
            .with(column("passed", &|row| passed_word(row.passed).to_owned()))
            .to_text()
    }
}

/// A gate's verdict as a word.
pub fn passed_word(passed: Option<bool>) -> &'static str {
    match passed {
        Some(true) => "yes",
        Some(false) => "NO",
        None => "",
    }
}

fn record((case, result): &(Case, Result<Outcome, ValidateError>)) -> RunRecord {
    let (cost, failure) = match result {
        Ok(outcome) => (Some(outcome.cost), None),
        Err(error) => (None, Some(error.to_string())),
    };
    RunRecord { case: *case, cost, failure }
}

/// Figures of every run, then the orders, suite by suite and scheme by scheme.
fn rows(outcomes: &[&Outcome]) -> Result<Vec<Row>, ValidateError> {
    let mut groups: BTreeMap<(SuiteName, SchemeName), Vec<&Outcome>> = BTreeMap::new();
    for outcome in outcomes {
        groups.entry((outcome.case.suite, outcome.case.scheme)).or_default().push(outcome);
    }
    let mut rows = Vec::new();
    for ((suite, scheme), mut group) in groups {
        let gates = GateFile::of(suite)?;
        group.sort_by_key(|outcome| outcome.case.n);
        for metric in group[0].measurements.iter().map(|measurement| measurement.metric) {
            push_metric(&mut rows, &gates, &group, metric);
        }
        let with_order = group[0].measurements.iter().filter(|m| m.metric.has_order());
        let orders = with_order.filter_map(|m| order_row(suite, scheme, &gates, &group, m.metric));
        rows.extend(orders);
    }
    Ok(rows)
}

/// The rows of one metric, coarse to fine.
fn push_metric(rows: &mut Vec<Row>, gates: &GateFile, group: &[&Outcome], metric: Metric) {
    let mut coarser = None;
    for outcome in group {
        let case = outcome.case;
        let Some(measurement) = outcome.measurements.iter().find(|m| m.metric == metric) else { continue };
        let gate = gates.of_measurement(case, measurement);
        let this = (case.n, measurement.error());
        let order = coarser.filter(|_| metric.has_order()).map(|coarse| observed_order(coarse, this));
        coarser = Some(this);
        rows.push(Row {
            suite: case.suite,
            scheme: case.scheme,
            n: Some(case.n),
            metric: metric.as_str().to_owned(),
            value: measurement.value,
            unit: metric.unit(),
            reference: Some(measurement.reference),
            gate,
            order,
            passed: gate.map(|gate| gate.passes(measurement.value, measurement.reference)),
        });
    }
}

/// The order fitted over all resolutions; its gate is judged from three of them on.
fn order_row(
    suite: SuiteName,
    scheme: SchemeName,
    gates: &GateFile,
    group: &[&Outcome],
    metric: Metric,
) -> Option<Row> {
    let error = |outcome: &&Outcome| Some((outcome.case.n, outcome.error(metric)?));
    let errors: Vec<(u32, f64)> = group.iter().filter_map(error).collect();
    let value = fitted_order(&errors)?;
    let gate = gates.of_order(scheme, metric).filter(|_| errors.len() >= 3);
    Some(Row {
        suite,
        scheme,
        n: None,
        metric: format!("{}_order", metric.as_str()),
        value,
        unit: "-",
        reference: None,
        gate,
        order: Some(value),
        passed: gate.map(|gate| gate.passes(value, 0.0)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::Measurement;

    fn outcome(n: u32, error: f64) -> (Case, Result<Outcome, ValidateError>) {
        let case = Case { suite: SuiteName::SoundWave, scheme: SchemeName::TkcHancock, n };
        let measurements = vec![Measurement::error_of(Metric::VelocityL1, error)];
        let cost = Cost::default();
        (case, Ok(Outcome { case, measurements, curve: Vec::new(), fields: Vec::new(), cost }))
    }

    fn report(errors: [f64; 3]) -> Report {
        let results = [outcome(100, errors[0]), outcome(200, errors[1]), outcome(400, errors[2])];
        Report::new("test".into(), Tier::Quick, &results).expect("good gates")
    }

    #[test]
    fn good_figures_pass_every_gate() {
        let report = report([0.0065, 0.0008, 0.0001]);
        assert_eq!(
            (report.n_gates(), report.failures().count()),
            (4, 0),
            "{}",
            report.table(SuiteName::SoundWave)
        );
    }

    #[test]
    fn one_bad_figure_fails_its_own_gate_and_that_of_the_order() {
        let report = report([0.0065, 0.0008, 0.0018]);
        let failed: Vec<_> = report.failures().map(|row| (row.n, row.metric.as_str())).collect();
        assert_eq!(failed, [(Some(400), "velocity_l1"), (None, "velocity_l1_order")]);
    }

    #[test]
    fn not_a_number_fails() {
        assert!(report([f64::NAN, 0.0018, 0.0004]).failures().count() >= 1);
    }

    #[test]
    fn json_has_the_agreed_fields() {
        let json = serde_json::to_value(report([0.0065, 0.0008, 0.0001])).expect("JSON");
        let row = &json["rows"][1];
        assert_eq!(
            (&row["suite"], &row["scheme"], &row["n"]),
            (&"sound-wave".into(), &"tkc-hancock".into(), &200.into())
        );
        assert_eq!(
            (&row["metric"], &row["unit"], &row["passed"]),
            (&"velocity_l1".into(), &"m/s".into(), &true.into())
        );
        assert!(
            row["gate"]["error_at_most"].as_f64().is_some_and(|limit| limit > 0.0008 && limit <= 0.003485)
        );
        assert!(row["order"].as_f64().is_some_and(|order| (order - 3.022).abs() < 0.01));
        assert_eq!(row["reference"], 0.0);
    }
}
