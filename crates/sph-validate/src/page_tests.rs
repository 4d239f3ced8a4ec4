//! Tests of the page: it says what passed, what was missed and what failed.

use super::*;
use crate::case::{Case, Tier};
use crate::conservation::Conservation;
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::{Cost, Curve};
use crate::report::Provenance;
use crate::runner::Job;
use crate::suites;

fn ended(result: impl Fn(Case) -> Result<Outcome, ValidateError>) -> Ended<'static> {
    let suite = suites::find("riemann").expect("in the list");
    let case = Case::new("riemann", SchemeName::TkcHancock, 100);
    Ended { job: Job { suite, case: case.clone() }, result: result(case) }
}

/// All figures that the gates ask for, each with the error given.
fn outcome(case: Case, error: f64) -> Outcome {
    let shift = |name| Measurement::error_of(Metric::value(name, "mm"), 0.0);
    let shifts = ["precursor_shift", "plastic_compression_shift", "elastic_release_shift"].map(shift);
    let norm = Measurement::error_of(Metric::norm("stress_l1", "GPa"), error);
    Outcome {
        case,
        measurements: std::iter::once(norm).chain(shifts).collect(),
        conservation: Conservation::default(),
        curves: vec![Curve::new("profile", vec![(-1.0, 0.0), (1.0, -1.0)])],
        fields: Vec::new(),
        cost: Cost { particles: 7, steps: 2, particle_steps: 14, seconds: 0.5 },
    }
}

fn html(ended: &[Ended<'_>]) -> String {
    let report = Report::new(Provenance::default(), Tier::Quick, ended).expect("good gates");
    page(&report, ended).expect("pictures").to_html().expect("a page")
}

#[test]
fn page_says_what_passed_and_what_was_missed() {
    let good = html(&[ended(|case| Ok(outcome(case, 0.04)))]);
    assert!(good.contains("1 runs: 4 of 4 gates passed"), "the verdict");
    assert!(
        good.contains("data:image/svg+xml") && good.contains("Elastic-plastic Riemann problem"),
        "plots and title"
    );
    let bad = html(&[ended(|case| Ok(outcome(case, 0.9)))]);
    assert!(bad.contains("3 of 4 gates passed") && bad.contains("Gates that were missed"), "the verdict");
}

#[test]
fn known_miss_that_passes_is_told_on_the_page_and_in_the_summary() {
    let ended = [ended(|case| Ok(outcome(case, 0.04)))];
    let mut report = Report::new(Provenance::default(), Tier::Quick, &ended).expect("good gates");
    let texts = |report: &Report| {
        let page = page(report, &ended).expect("pictures").to_html().expect("a page");
        [page, crate::summary::summary(report, &[])]
    };
    assert!(texts(&report).iter().all(|text| !text.contains("Known misses that pass")));
    report.rows[0].mended_miss = Some("a reason".into());
    for text in texts(&report) {
        assert!(text.contains("Known misses that pass") && text.contains("1 known miss passes"), "{text}");
    }
}

#[test]
fn failed_run_is_told_and_spoils_the_verdict() {
    let text = html(&[ended(|case| {
        Err(ValidateError::NotReached { case: case.to_string(), reason: "no stop after 5 us".into() })
    })]);
    assert!(text.contains("1 runs failed") && text.contains("no stop after 5 us"));
}
