//! Rows of the report: figures, references, orders and gates; the terminal table and `results.json`.

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;
use sph_io::table::{Column, Table};

use crate::case::{Case, SchemeName, Tier};
use crate::conservation::Conservation;
use crate::error::ValidateError;
use crate::gate::{Gate, GateFile, Significant};
use crate::metric::{Kind, Metric, Target, fitted_order, observed_order};
use crate::outcome::{Cost, Outcome};
use crate::runner::{Ended, suites_of};
use crate::suites::{About, ReferenceKind};

/// One figure with everything that judges it.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Row {
    /// The problem.
    pub suite: String,
    /// Its variant; empty where there is one only.
    pub variant: String,
    /// The scheme.
    pub scheme: SchemeName,
    /// Resolution; absent for the order that is fitted over all of them.
    pub n: Option<u32>,
    /// Name of the figure.
    pub metric: String,
    /// What kind of figure.
    pub kind: Kind,
    /// Its value, in `unit`; null if it is not a number.
    #[schemars(with = "Option<f64>")]
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// What it should be; absent for an order, and for the finest run where that is the reference of the others.
    pub reference: Option<f64>,
    /// Distance from the reference, in `unit`.
    pub error: Option<f64>,
    /// What it must reach; absent for a figure that is only shown.
    pub gate: Option<Gate>,
    /// Order of convergence from the next coarser resolution to this one.
    pub order: Option<f64>,
    /// Whether it passed its gate.
    pub passed: Option<bool>,
    /// Why it missed its gate, where that is written beside the gate and the miss has not grown.
    pub known_miss: Option<String>,
    /// Why it missed its gate before, where that is still written beside the gate and nothing that the entry names at this
    /// resolution misses any more: the entry can be taken out.
    pub mended_miss: Option<String>,
}

/// What one run conserved and cost, or why it failed.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct RunRecord {
    /// Which run.
    #[serde(flatten)]
    pub case: Case,
    /// Drifts of what must be conserved.
    pub conservation: Option<Conservation>,
    /// What it cost.
    pub cost: Option<Cost>,
    /// Million particle-steps per second.
    pub million_particle_steps_per_second: Option<f64>,
    /// Why it gave nothing.
    pub failure: Option<String>,
}

/// What is said of a suite.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SuiteRecord {
    /// Name in commands and files.
    pub name: String,
    /// Title.
    pub title: String,
    /// What `n` counts.
    pub resolution: String,
    /// What the figures are held against.
    pub reference: ReferenceKind,
    /// Where the gates come from.
    pub source: String,
}

/// By what, on what and how a validation was made.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct Provenance {
    /// Command line that makes it again.
    pub command: String,
    /// Version of the program.
    pub version: String,
    /// State of the repository, where it is known.
    pub commit: Option<String>,
    /// Number for everything that a figure of a run can depend on.
    pub code: String,
    /// Version of the compiler.
    pub compiler: String,
    /// Processor, cores, instructions, system.
    pub machine: String,
    /// When it was begun, UTC.
    pub begun: String,
    /// How long it took [s].
    pub seconds: f64,
    /// Finished runs that were taken over from an earlier validation.
    pub taken_over: usize,
}

/// All that a validation found: `results.json`.
///
/// Shares and times are in SI units; figures are in the unit beside them.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Report {
    /// By what, on what and how it was made.
    pub provenance: Provenance,
    /// How much was run.
    pub tier: Tier,
    /// The problems.
    pub suites: Vec<SuiteRecord>,
    /// The figures.
    pub rows: Vec<Row>,
    /// The runs.
    pub runs: Vec<RunRecord>,
}

impl Report {
    /// Judges what has ended; failed runs are kept as records.
    ///
    /// # Errors
    /// If the gates of a suite cannot be read, or are meant for a run that it does not have or a figure that no run has.
    pub fn new(provenance: Provenance, tier: Tier, ended: &[Ended<'_>]) -> Result<Self, ValidateError> {
        let (mut suites, mut rows) = (Vec::new(), Vec::new());
        for suite in suites_of(ended) {
            let about = suite.about();
            let gates = GateFile::read(about.name, about.gates)?;
            if let Some(reason) =
                gates.idle(&[Tier::Quick, Tier::Full].map(|tier| suite.cases(tier)).concat())
            {
                return Err(ValidateError::Gates { suite: about.name.to_owned(), reason });
            }
            let of_suite = ended.iter().filter(|ended| ended.job.case.suite == about.name);
            let outcomes: Vec<&Outcome> = of_suite.filter_map(|ended| ended.result.as_ref().ok()).collect();
            let first = rows.len();
            push_suite(&mut rows, &gates, &about, &outcomes)?;
            mark_mended(&mut rows[first..], &gates);
            suites.push(SuiteRecord {
                name: about.name.to_owned(),
                title: about.title.to_owned(),
                resolution: about.resolution.to_owned(),
                reference: about.reference,
                source: gates.source,
            });
        }
        Ok(Self { provenance, tier, suites, rows, runs: ended.iter().map(record).collect() })
    }

    /// Rows that missed their gate and were not expected to: a known miss is none of them unless it has grown.
    pub fn unexplained(&self) -> impl Iterator<Item = &Row> {
        self.failures().filter(|row| row.known_miss.is_none())
    }

    /// Rows that passed their gate although a miss of theirs is written beside it.
    pub fn mended(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.mended_miss.is_some())
    }

    /// How many gates were passed, how many misses are known ones, and how many of those pass, in a sentence.
    pub fn tally(&self) -> String {
        let (missed, unexplained) = (self.failures().count(), self.unexplained().count());
        let mut words = format!("{} of {} gates passed", self.n_gates() - missed, self.n_gates());
        if missed > unexplained {
            words += &format!(", {} misses are known and told with their causes", missed - unexplained);
        }
        match self.mended().count() {
            0 => words,
            1 => format!("{words}, 1 known miss passes"),
            mended => format!("{words}, {mended} known misses pass"),
        }
    }

    /// Rows that missed their gate.
    pub fn failures(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.passed == Some(false))
    }

    /// Number of rows with a gate.
    pub fn n_gates(&self) -> usize {
        self.rows.iter().filter(|row| row.passed.is_some()).count()
    }

    /// Writes `results.json`, and `results.schema.json` that says what it is made of.
    ///
    /// # Errors
    /// [`ValidateError::Output`] if a file cannot be written.
    pub fn write_json(&self, folder: &Path) -> Result<(), ValidateError> {
        write_json(&folder.join("results.json"), self)?;
        write_json(&folder.join("results.schema.json"), &schema())
    }

    /// The table of one suite for the terminal.
    pub fn table(&self, suite: &SuiteRecord) -> String {
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.suite == suite.name).collect();
        let column = |name: &str, cell: &dyn Fn(&Row) -> String| {
            Column::text(name, "", rows.iter().map(|row| cell(row)).collect::<Vec<_>>())
        };
        let optional = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.2}"));
        let mut table = Table::new(format!("\n{} (n: {})", suite.title, suite.resolution));
        if rows.iter().any(|row| !row.variant.is_empty()) {
            table = table.with(column("variant", &|row| row.variant.clone()));
        }
        table
            .with(column("scheme", &|row| row.scheme.to_string()))
            .with(column("n", &|row| row.n.map_or("all".into(), |n| n.to_string())))
            .with(column("metric", &|row| row.metric.clone()))
            .with(column("value", &|row| format!("{:.5}", Significant(row.value))))
            .with(column("unit", &|row| row.unit.clone()))
            .with(column("reference", &|row| {
                row.reference.map_or(String::new(), |value| format!("{:.5}", Significant(value)))
            }))
            .with(column("gate", &|row| row.gate.map_or(String::new(), |gate| gate.to_string())))
            .with(column("order", &|row| optional(row.order)))
            .with(column("passed", &|row| passed_word(row).to_owned()))
            .to_text()
    }
}

/// JSON Schema of `results.json`.
pub fn schema() -> schemars::Schema {
    let settings = schemars::generate::SchemaSettings::draft2020_12().for_serialize();
    settings.into_generator().into_root_schema_for::<Report>()
}

fn write_json(path: &Path, content: &impl Serialize) -> Result<(), ValidateError> {
    let fault = |reason: String| ValidateError::Output { path: path.to_owned(), reason };
    let mut text = serde_json::to_string_pretty(content).map_err(|error| fault(error.to_string()))?;
    text.push('\n');
    sph_io::write_atomic(path, text.as_bytes()).map_err(|error| fault(error.to_string()))
}

/// A gate's verdict as a word.
fn passed_word(row: &Row) -> &'static str {
    match row.passed {
        Some(true) if row.mended_miss.is_some() => "yes, mended",
        Some(true) => "yes",
        Some(false) if row.known_miss.is_some() => "no, known",
        Some(false) => "NO",
        None => "",
    }
}

fn record(ended: &Ended<'_>) -> RunRecord {
    let outcome = ended.result.as_ref().ok();
    RunRecord {
        case: ended.job.case.clone(),
        conservation: outcome.map(|outcome| outcome.conservation),
        cost: outcome.map(|outcome| outcome.cost),
        million_particle_steps_per_second: outcome.map(|outcome| outcome.cost.rate()),
        failure: ended.result.as_ref().err().map(ToString::to_string),
    }
}

/// What a figure of an outcome should be; nothing where the outcome itself is the finest of its kin, which the others
/// are held against.
pub fn reference_of(outcome: &Outcome, metric: &Metric, outcomes: &[&Outcome]) -> Option<f64> {
    match outcome.figure(&metric.name)?.target {
        Target::Known(reference) => Some(reference),
        Target::Finest => {
            let kin = outcomes.iter().filter(|other| other.case.is_kin_of(&outcome.case));
            let finest = kin.max_by_key(|other| other.case.n)?;
            (finest.case.n > outcome.case.n)
                .then(|| finest.figure(&metric.name).map(|figure| figure.value))?
        }
    }
}

/// Distance of a figure from what it should be; not a number where that is not known.
pub fn error_of(outcome: &Outcome, metric: &Metric, outcomes: &[&Outcome]) -> f64 {
    let distance = || {
        let figure = outcome.figure(&metric.name)?;
        Some((figure.value - reference_of(outcome, metric, outcomes)?).abs())
    };
    distance().unwrap_or(f64::NAN)
}

/// Figures of every run, then the orders, variant by variant and scheme by scheme.
fn push_suite(
    rows: &mut Vec<Row>,
    gates: &GateFile,
    about: &About,
    outcomes: &[&Outcome],
) -> Result<(), ValidateError> {
    let mut seen: Vec<&Case> = Vec::new();
    for first in outcomes {
        if seen.iter().any(|case| case.is_kin_of(&first.case)) {
            continue;
        }
        seen.push(&first.case);
        let mut kin: Vec<&Outcome> =
            outcomes.iter().copied().filter(|outcome| outcome.case.is_kin_of(&first.case)).collect();
        kin.sort_by_key(|outcome| outcome.case.n);
        let metrics: Vec<Metric> = kin[0].figures().map(|figure| figure.metric).collect();
        let names: Vec<&str> = metrics.iter().map(|metric| metric.name.as_ref()).collect();
        if let Some(metric) = gates.unmeasured(&first.case, &names) {
            let reason = format!("`{metric}` is no figure of {}; it has {}", first.case, names.join(", "));
            return Err(ValidateError::Gates { suite: about.name.to_owned(), reason });
        }
        metrics.iter().for_each(|metric| push_metric(rows, gates, &kin, metric));
        let with_order = metrics.iter().filter(|metric| metric.has_order());
        rows.extend(with_order.filter_map(|metric| order_row(gates, &kin, metric)));
    }
    Ok(())
}

/// The rows of one metric, coarse to fine.
fn push_metric(rows: &mut Vec<Row>, gates: &GateFile, kin: &[&Outcome], metric: &Metric) {
    let mut coarser = None;
    for outcome in kin {
        let Some(figure) = outcome.figure(&metric.name) else { continue };
        let case = &outcome.case;
        let reference = reference_of(outcome, metric, kin);
        let gate = reference.and_then(|reference| gates.of_figure(case, &metric.name, reference));
        let error = reference.map(|reference| (figure.value - reference).abs());
        let this = error.map(|error| (case.n, error));
        let orders = coarser.zip(this).filter(|_| metric.has_order());
        let order = orders.map(|(coarse, this)| observed_order(coarse, this));
        coarser = this;
        let passed = gate.zip(reference).map(|(gate, reference)| gate.passes(figure.value, reference));
        let known_miss = reference.filter(|_| passed == Some(false));
        let known_miss = known_miss.and_then(|to| gates.known_cause(case, &metric.name, figure.value, to));
        rows.push(Row {
            suite: case.suite.clone(),
            variant: case.variant.clone(),
            scheme: case.scheme,
            n: Some(case.n),
            metric: metric.name.to_string(),
            kind: metric.kind,
            value: figure.value,
            unit: metric.unit.to_string(),
            reference,
            error,
            gate,
            order,
            passed,
            known_miss: known_miss.map(str::to_owned),
            mended_miss: None,
        });
    }
}

/// Notes known misses that pass: those whose entry names no row at this resolution that still misses.
fn mark_mended(rows: &mut [Row], gates: &GateFile) {
    let entry = |row: &Row| {
        let case = Case::new(&row.suite, row.scheme, row.n?).of_variant(&row.variant);
        let (number, cause) = gates.entry_of_miss(&case, &row.metric)?;
        Some((number, case.n, cause.to_owned(), row.passed?))
    };
    let named: Vec<_> = rows.iter().map(entry).collect();
    let still = |number: usize, n: u32| {
        named.iter().flatten().any(|other| (other.0, other.1, other.3) == (number, n, false))
    };
    for (row, named) in rows.iter_mut().zip(&named) {
        let Some((number, n, cause, _)) = named else { continue };
        row.mended_miss = (!still(*number, *n)).then(|| cause.clone());
    }
}

/// The order fitted over all resolutions; its gate is judged from three of them on.
fn order_row(gates: &GateFile, kin: &[&Outcome], metric: &Metric) -> Option<Row> {
    let error = |outcome: &&Outcome| {
        let reference = reference_of(outcome, metric, kin)?;
        Some((outcome.case.n, (outcome.figure(&metric.name)?.value - reference).abs()))
    };
    let errors: Vec<(u32, f64)> = kin.iter().filter_map(error).collect();
    let value = fitted_order(&errors)?;
    let case = &kin[0].case;
    let gate = gates.of_order(case, &metric.name).filter(|_| errors.len() >= 3);
    Some(Row {
        suite: case.suite.clone(),
        variant: case.variant.clone(),
        scheme: case.scheme,
        n: None,
        metric: format!("{}_order", metric.name),
        kind: metric.kind,
        value,
        unit: "-".into(),
        reference: None,
        error: None,
        gate,
        order: Some(value),
        passed: gate.map(|gate| gate.passes(value, 0.0)),
        known_miss: None,
        mended_miss: None,
    })
}

#[cfg(test)]
#[path = "report_tests.rs"]
mod tests;
