//! Case files of users: the shipped ones, and faults with their places.

use super::*;
use crate::case::Tier;
use crate::watch::Watch;

const IMPACT: &str = include_str!("../../validation/cases/riemann-impact.ron");
const RELEASE: &str = include_str!("../../validation/cases/riemann-release.ron");

fn faults_of(text: &str) -> String {
    match parse(text, "my.ron") {
        Ok(_) => panic!("no fault was found"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn shipped_cases_are_read_and_run() {
    for (text, name, runs) in [(IMPACT, "impact", 6), (RELEASE, "release", 3)] {
        let suite = parse(text, "my.ron").unwrap_or_else(|error| panic!("{error}"));
        let cases = suite.cases(Tier::Quick);
        assert_eq!(cases.len(), runs, "{name}");
        assert!(cases.iter().all(|case| case.variant == name && suite.work(case) > 0.0));
        let coarse = Case { n: 50, ..cases[0].clone() };
        let outcome = suite.run(&coarse, Watch::silent()).expect("a result");
        let error = outcome.figure("stress_l1").expect("its error").value;
        assert!((1e-4..0.1).contains(&error), "{name}: {error} GPa");
        assert!(outcome.conservation.energy.abs() < 1e-10 && outcome.conservation.momentum.abs() < 1e-10);
    }
}

/// The published problem, written as a case: the same answer as from the suite, but for Courant number and limiter.
#[test]
fn exact_solution_is_computed_from_the_case() {
    let text = RELEASE
        .replace(", yield_strength: \"0.6 GPa\"", "")
        .replace("-2 GPa", "-4 GPa")
        .replace("3 us", "2 us");
    let suite = parse(&text, "my.ron").unwrap_or_else(|error| panic!("{error}"));
    let case = Case::new("riemann", SchemeName::Csph, 100);
    let ours = suite.run(&case, Watch::silent()).expect("a result").figure("stress_l1");
    let published = crate::suites::riemann::Riemann::PUBLISHED.run(&case, Watch::silent());
    assert_eq!(
        ours.map(|figure| figure.value),
        published.expect("a result").figure("stress_l1").map(|f| f.value)
    );
}

#[test]
fn all_faults_are_told_at_once_with_places_and_hints() {
    let text = IMPACT
        .replace("\"50 mm\"", "\"50 GPa\"")
        .replace("Csph, TkcHancock", "Csph, TkcHancok")
        .replace("yield_strength", "yeld_strength")
        .replace("100, 200, 400", "100, 7");
    let told = faults_of(&text);
    for part in [
        "`GPa` is a unit of pressure, but this field is a length",
        "did you mean `TkcHancock`?",
        "did you mean `yield_strength`?",
        "7 is out of range",
        "my.ron:",
        "4 faults found",
    ] {
        assert!(told.contains(part), "{part} is missing in\n{told}");
    }
}

#[test]
fn unknown_problem_lists_what_there_is() {
    let told = faults_of("(name: \"a\", problem: Sedov(length: \"1 m\"), resolutions: [100])");
    assert!(told.contains("Sedov") && told.contains("Riemann"), "{told}");
}

#[test]
fn impossible_problems_are_named_with_the_condition_they_break() {
    let with_velocities = |left: &str, right: &str| {
        faults_of(&IMPACT.replace("\"30 m/s\"", left).replace("\"-30 m/s\"", right))
    };
    let vacuum = with_velocities("\"-60 km/s\"", "\"60 km/s\"");
    assert!(vacuum.contains("vacuum"), "{vacuum}");
    let overdriven = with_velocities("\"4 km/s\"", "\"-4 km/s\"");
    assert!(overdriven.contains("overtakes its precursor"), "{overdriven}");
    let nothing = with_velocities("\"5 m/s\"", "\"5 m/s\"");
    assert!(nothing.contains("there is no wave"), "{nothing}");
    let late = faults_of(&IMPACT.replace("3 us", "9 us"));
    assert!(late.contains("the fastest wave runs") && late.contains("at most"), "{late}");
}
