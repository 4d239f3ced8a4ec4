//! Tests of the report: verdicts, orders, references of the finest run, fields of the JSON.

use super::*;
use crate::metric::Measurement;
use crate::runner::Job;
use crate::suites::Suite;
use crate::watch::Watch;

const VELOCITY_L1: Metric = Metric::norm("velocity_l1", "m/s");
const PERIOD: Metric = Metric::converging_value("period", "us");

/// A suite that only has a table of gates.
struct Paper;

impl Suite for Paper {
    fn about(&self) -> About {
        About {
            name: "paper",
            title: "Paper",
            resolution: "particles",
            reference: ReferenceKind::Analytic,
            gates: r#"(
                source: "a test",
                figures: [(scheme: TkcHancock, metric: "velocity_l1",
                           printed: {100: "0.0163", 200: "0.00348", 400: "7.9e-4"})],
                limits: [(metric: "energy_drift", error_at_most: 1e-10)],
                orders: [(metric: "velocity_l1", at_least: 1.85)],
                known: [(metric: "velocity_l1", reached: {100: "0.030"}, cause: "a reason")],
            )"#,
        }
    }

    fn cases(&self, _: Tier) -> Vec<Case> {
        [100, 200, 400].map(|n| Case::new("paper", SchemeName::TkcHancock, n)).to_vec()
    }

    fn work(&self, _: &Case) -> f64 {
        1.0
    }

    fn run(&self, case: &Case, _: Watch<'_>) -> Result<Outcome, ValidateError> {
        Err(ValidateError::NotReached { case: case.to_string(), reason: "never run".into() })
    }
}

fn ended(n: u32, measurement: Measurement) -> Ended<'static> {
    let case = Case::new("paper", SchemeName::TkcHancock, n);
    let outcome = Outcome {
        case: case.clone(),
        measurements: vec![measurement],
        conservation: Conservation { energy: 1e-15, ..Conservation::default() },
        curves: Vec::new(),
        fields: Vec::new(),
        cost: Cost::default(),
    };
    Ended { job: Job { suite: &Paper, case }, result: Ok(outcome) }
}

fn report(errors: [f64; 3]) -> Report {
    let of = |(n, error)| ended(n, Measurement::error_of(VELOCITY_L1, error));
    let ended: Vec<Ended<'_>> = [100, 200, 400].into_iter().zip(errors).map(of).collect();
    Report::new(Provenance::default(), Tier::Quick, &ended).expect("good gates")
}

#[test]
fn good_figures_pass_every_gate() {
    let report = report([0.0065, 0.0008, 0.0001]);
    let table = report.table(&report.suites[0]);
    assert_eq!((report.n_gates(), report.failures().count()), (7, 0), "{table}");
}

#[test]
fn one_bad_figure_fails_its_own_gate_and_that_of_the_order() {
    let report = report([0.0065, 0.0008, 0.0018]);
    let failed: Vec<_> = report.failures().map(|row| (row.n, row.metric.as_str())).collect();
    assert_eq!(failed, [(Some(400), "velocity_l1"), (None, "velocity_l1_order")]);
}

#[test]
fn not_a_number_fails() {
    assert!(report([f64::NAN, 0.0018, 0.0004]).unexplained().count() >= 1);
}

/// A miss that is written beside its gate stays a miss, but fails nothing; one that has grown does.
#[test]
fn known_miss_is_told_and_one_that_has_grown_fails() {
    let known = report([0.031, 0.0008, 0.0001]);
    assert_eq!((known.failures().count(), known.unexplained().count()), (1, 0));
    assert_eq!(known.rows[0].known_miss.as_deref(), Some("a reason"));
    assert_eq!(known.tally(), "6 of 7 gates passed, 1 misses are known and told with their causes");
    let grown = report([0.033, 0.0008, 0.0001]);
    assert_eq!((grown.failures().count(), grown.unexplained().count()), (1, 1));
    assert_eq!(grown.tally(), "6 of 7 gates passed");
}

/// An entry whose miss is mended is told, so that it does not stay and hide the next one.
#[test]
fn known_miss_that_passes_is_told_by_row_and_tally() {
    let mended = report([0.0065, 0.0008, 0.0001]);
    let told: Vec<_> = mended.mended().map(|row| (row.n, row.metric.as_str())).collect();
    assert_eq!(told, [(Some(100), "velocity_l1")], "n = 200 and 400 are not in the entry");
    assert_eq!(mended.rows[0].mended_miss.as_deref(), Some("a reason"));
    assert_eq!(mended.tally(), "7 of 7 gates passed, 1 known miss passes");
    assert!(mended.table(&mended.suites[0]).contains("yes, mended"));
    for still in [0.031, 0.033, f64::NAN] {
        assert_eq!(report([still, 0.0008, 0.0001]).mended().count(), 0, "{still}");
    }
}

/// An entry without a scheme names a row of each: it has had its day when none of them misses.
#[test]
fn entry_of_several_rows_is_mended_when_all_pass() {
    let both = |csph: f64| {
        let mut other = ended(100, Measurement::error_of(VELOCITY_L1, csph));
        other.job.case.scheme = SchemeName::Csph;
        other.result.as_mut().expect("an outcome").case.scheme = SchemeName::Csph;
        let ended = [ended(100, Measurement::error_of(VELOCITY_L1, 0.0065)), other];
        let mut report = Report::new(Provenance::default(), Tier::Quick, &ended).expect("good gates");
        // The figure of CSPH is judged too.
        let gate = report.rows[0].gate.expect("a gate");
        for row in report.rows.iter_mut().filter(|row| row.scheme == SchemeName::Csph) {
            row.passed = (row.metric == "velocity_l1").then(|| gate.passes(row.value, 0.0)).or(row.passed);
        }
        let gates = GateFile::read("paper", Paper.about().gates).expect("good gates");
        mark_mended(&mut report.rows, &gates);
        report.mended().count()
    };
    assert_eq!((both(0.0065), both(0.031)), (2, 0));
}

#[test]
fn finest_run_is_the_reference_where_no_answer_is_known() {
    let of = |(n, value)| ended(n, Measurement::against_finest(PERIOD, value));
    let runs = [(10, 5.4), (20, 5.1), (40, 5.0)].map(of);
    let outcomes: Vec<&Outcome> = runs.iter().filter_map(|run| run.result.as_ref().ok()).collect();
    let mut rows = Vec::new();
    push_suite(&mut rows, &GateFile::default(), &Paper.about(), &outcomes).expect("no gates");
    let periods: Vec<&Row> = rows.iter().filter(|row| row.metric == "period").collect();
    assert_eq!(periods.iter().map(|row| row.reference).collect::<Vec<_>>(), [Some(5.0), Some(5.0), None]);
    assert!(periods[1].order.is_some_and(|order| (order - 2.0).abs() < 1e-9), "{:?}", periods[1]);
    assert_eq!((periods[2].error, periods[2].order), (None, None));
}

#[test]
fn gate_of_a_figure_that_no_run_measures_is_an_error() {
    let runs = [ended(10, Measurement::error_of(PERIOD, 1.0))];
    let error =
        Report::new(Provenance::default(), Tier::Quick, &runs).expect_err("no velocity_l1").to_string();
    assert!(
        error.contains("`velocity_l1` is no figure of paper tkc-hancock n = 10; it has period, "),
        "{error}"
    );
}

#[test]
fn json_has_the_agreed_fields() {
    let json = serde_json::to_value(report([0.0065, 0.0008, 0.0001])).expect("JSON");
    let row = &json["rows"][1];
    assert_eq!(
        (&row["suite"], &row["scheme"], &row["n"]),
        (&"paper".into(), &"tkc-hancock".into(), &200.into())
    );
    assert_eq!(
        (&row["metric"], &row["unit"], &row["passed"]),
        (&"velocity_l1".into(), &"m/s".into(), &true.into())
    );
    assert!(row["gate"]["error_at_most"].as_f64().is_some_and(|limit| limit > 0.0008 && limit <= 0.003485));
    assert!(row["order"].as_f64().is_some_and(|order| (order - 3.022).abs() < 0.01));
    assert_eq!(row["reference"], 0.0);
    assert_eq!(json["runs"][0]["conservation"]["energy"], 1e-15);
}

/// Every field of the JSON is in its schema, with a type that fits.
#[test]
fn schema_describes_the_json() {
    let schema = serde_json::to_value(schema()).expect("JSON");
    let report = serde_json::to_value(report([f64::NAN, 0.0008, 0.0001])).expect("JSON");
    assert_eq!(report["rows"][0]["value"], serde_json::Value::Null);
    for (part, value) in [
        ("Row", &report["rows"][0]),
        ("RunRecord", &report["runs"][0]),
        ("Provenance", &report["provenance"]),
    ] {
        let described = schema["$defs"][part]["properties"].as_object().expect(part);
        let found = value.as_object().expect(part);
        assert_eq!(found.keys().collect::<Vec<_>>(), described.keys().collect::<Vec<_>>(), "{part}");
    }
    assert_eq!(schema["$defs"]["Row"]["properties"]["value"]["type"], serde_json::json!(["number", "null"]));
}
