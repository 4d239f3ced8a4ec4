//! Tests of the gates: which rows they hold, how printed numbers are read, what a known miss allows.

use super::*;
use crate::case::Tier;

#[test]
fn files_of_all_suites_are_good() {
    for about in crate::suites::ALL.iter().map(|suite| suite.about()) {
        let file = GateFile::read(about.name, about.gates).expect("a readable file");
        assert!(!file.source.is_empty(), "{}", about.name);
    }
}

#[test]
fn printed_figures_leave_half_a_unit_of_the_last_digit() {
    let limit = |text| Printed::read(text).expect("a number").error_at_most(0.0, 0.0);
    assert!((limit("0.0450") - 0.04505).abs() < 1e-12);
    assert!((limit("7.9e-4") - 7.95e-4).abs() < 1e-12);
    assert!((limit("-0.10") - 0.105).abs() < 1e-12);
    let reached = Printed::read("66.56").expect("a number").error_at_most(66.54, 0.05);
    assert!((reached - (1.05 * 0.02 + 0.005)).abs() < 1e-12);
    assert_eq!(Printed::read("about 3"), None);
    assert_eq!(Printed::read("NaN"), None);
}

#[test]
fn gates_hold_on_both_sides_of_the_reference_and_refuse_nan() {
    let gate = Gate::ErrorAtMost(0.1);
    assert!(gate.passes(1.05, 1.0) && gate.passes(0.95, 1.0));
    assert!(!gate.passes(1.2, 1.0) && !gate.passes(0.8, 1.0) && !gate.passes(f64::NAN, 1.0));
    assert!(Gate::AtLeast(2.0).passes(2.0, 0.0) && !Gate::AtLeast(2.0).passes(f64::NAN, 0.0));
}

const TEXT: &str = r#"(
    source: "nowhere",
    figures: [(scheme: TkcHancock, metric: "stress_l1", printed: {100: "0.045"})],
    reached: [(variant: "copper", metric: "stress_l1", printed: {100: "0.02"})],
    limits: [(metric: "energy_drift", error_at_most: 1e-10)],
    orders: [(scheme: Csph, metric: "stress_l1", at_least: 0.4)],
)"#;

#[test]
fn gates_hold_the_rows_that_they_are_meant_for() {
    let file = GateFile::read("test", TEXT).expect("a readable file");
    let gate = |case: &Case, metric: &str| match file.of_figure(case, metric, 0.0) {
        Some(Gate::ErrorAtMost(limit)) => limit,
        _ => f64::NAN,
    };
    let case = Case::new("test", SchemeName::TkcHancock, 100);
    assert!((gate(&case, "stress_l1") - 0.0455).abs() < 1e-12);
    let copper = case.clone().of_variant("copper");
    assert!((gate(&copper, "stress_l1") - (1.05 * 0.02 + 0.005)).abs() < 1e-12, "the narrower one");
    assert!(gate(&Case { n: 101, ..copper.clone() }, "stress_l1").is_nan());
    let csph = Case::new("test", SchemeName::Csph, 7);
    assert!(gate(&csph, "stress_l1").is_nan() && gate(&csph, "energy_drift") == 1e-10);
    assert_eq!(file.of_order(&csph, "stress_l1"), Some(Gate::AtLeast(0.4)));
    assert_eq!(file.of_order(&copper, "stress_l1"), None);
    assert_eq!(file.unmeasured(&csph, &["stress_l1", "energy_drift"]), None);
    assert_eq!(file.unmeasured(&csph, &["stress_l1"]), Some("energy_drift"));
}

#[test]
fn faults_of_a_file_of_gates_are_told_with_their_place() {
    let fault = |text: &str| GateFile::read("test", text).expect_err("a fault").to_string();
    assert!(fault("(\n    sorce: \"a\",\n)").contains("2:"), "{}", fault("(\n    sorce: \"a\",\n)"));
    let number = r#"(source: "a", figures: [(metric: "m", printed: {1: "about 3"})])"#;
    assert!(fault(number).contains("`about 3` is not a printed number"));
}

#[test]
fn numbers_are_shown_with_significant_digits() {
    let shown = |value| format!("{:.4}", Significant(value));
    assert_eq!(shown(66.55714), "66.56");
    assert_eq!(shown(0.000_795_12), "0.0007951");
    assert_eq!(shown(1.234_4e-9), "1.234e-9");
    assert_eq!(shown(0.0), "0");
    assert_eq!(shown(f64::NAN), "NaN");
}

#[test]
fn limits_by_resolution_hold_their_resolution_alone() {
    let text = r#"(source: "a", limits: [(metric: "m", error_at_most: 3)],
                   limits_by_resolution: [(metric: "m", error_at_most: {10: 2, 20: 0.5})])"#;
    let file = GateFile::read("test", text).expect("a readable file");
    let gate = |n| file.of_figure(&Case::new("test", SchemeName::Csph, n), "m", 0.0);
    assert_eq!([10, 20, 40].map(gate), [2.0, 0.5, 3.0].map(|limit| Some(Gate::ErrorAtMost(limit))));
}

#[test]
fn known_miss_is_held_to_what_was_reached() {
    let text =
        r#"(source: "a", known: [(scheme: Csph, metric: "m", reached: {10: "-0.90"}, cause: "too coarse")])"#;
    let file = GateFile::read("test", text).expect("a readable file");
    let case = Case::new("test", SchemeName::Csph, 10);
    let cause = |case: &Case, value| file.known_cause(case, "m", value, 0.0);
    assert_eq!(cause(&case, -0.94), Some("too coarse"));
    assert_eq!(cause(&case, 0.94), Some("too coarse"), "the distance counts");
    assert_eq!(cause(&case, -0.97), None, "it has grown");
    assert_eq!(cause(&case, f64::NAN), None);
    assert_eq!(cause(&Case { n: 20, ..case.clone() }, -0.1), None, "nothing is said of this resolution");
    assert_eq!(cause(&Case::new("test", SchemeName::TkcHancock, 10), -0.1), None);
    assert_eq!(file.unmeasured(&case, &[]), Some("m"), "a known miss of a figure that nobody measures");
}

#[test]
fn entries_that_judge_nothing_are_told() {
    let cases = [Case::new("test", SchemeName::Csph, 10), Case::new("test", SchemeName::Csph, 20)];
    let idle = |entries: &str| {
        GateFile::read("test", &format!("(source: \"a\", {entries})")).expect("a readable file").idle(&cases)
    };
    assert_eq!(idle("limits: [(scheme: Csph, metric: \"m\", error_at_most: 1)]"), None);
    let told = idle("limits: [(variant: \"cooper\", metric: \"m\", error_at_most: 1)]");
    assert_eq!(told.as_deref(), Some("`m`, variant \"cooper\": no run of the suite is meant"));
    let told = idle("orders: [(scheme: TkcMuscl, metric: \"m\", at_least: 1)]");
    assert_eq!(told.as_deref(), Some("`m`, tkc-muscl: no run of the suite is meant"));
    let told = idle("limits_by_resolution: [(metric: \"m\", error_at_most: {10: 1, 15: 2})]");
    assert_eq!(told.as_deref(), Some("`m`: no run of the suite has n = 15"));
}

#[test]
fn every_entry_of_every_suite_judges_a_run() {
    let mut told = Vec::new();
    for suite in crate::suites::ALL {
        let about = suite.about();
        let file = GateFile::read(about.name, about.gates).expect("a readable file");
        let cases = [Tier::Quick, Tier::Full].map(|tier| suite.cases(tier)).concat();
        told.extend(file.idle(&cases).map(|entry| format!("{}: {entry}", about.name)));
    }
    assert!(told.is_empty(), "{told:#?}");
}
