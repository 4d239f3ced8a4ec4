//! Case files of users: the shipped ones, and faults with their places.

use super::*;
use crate::case::Tier;
use crate::watch::Watch;

const IMPACT: &str = include_str!("../../validation/cases/riemann-impact.ron");
const RELEASE: &str = include_str!("../../validation/cases/riemann-release.ron");

const PISTON: &str = include_str!("../../validation/cases/piston.ron");
const SOUND_WAVE: &str = include_str!("../../validation/cases/sound-wave.ron");
const SHELL: &str = include_str!("../../validation/cases/shell.ron");
const WINDOW: &str = include_str!("../../validation/cases/window.ron");

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

/// Each problem's figure is near what is computed for the user's parameters, at a coarse resolution.
#[test]
fn further_problems_agree_with_their_references() {
    for (text, name, n, figure, at_most) in [
        (PISTON, "slow-piston", 60, "plateau_stress", 0.05),
        (SOUND_WAVE, "pulse", 60, "pulse_peak", 0.1),
        (SHELL, "copper-tube", 4, "stop_radius_by_ring", 0.3),
        (WINDOW, "plastic-shock", 120, "shock_velocity", 40.0),
    ] {
        let suite = parse(text, "my.ron").unwrap_or_else(|error| panic!("{error}"));
        let cases = suite.cases(Tier::Quick);
        assert!(cases.iter().all(|case| case.variant == name && suite.work(case) > 0.0));
        let case = Case { n, scheme: SchemeName::TkcHancock, ..cases[0].clone() };
        let outcome = suite.run(&case, Watch::silent()).unwrap_or_else(|error| panic!("{error}"));
        let found = outcome.figure(figure).expect("a figure");
        let crate::metric::Target::Known(reference) = found.target else { panic!("{name} has a reference") };
        println!("{name}: {figure} {} beside {reference} {}", found.value, found.metric.unit);
        assert!(reference.abs() > at_most && (found.value - reference).abs() < at_most, "{name}: {found:?}");
        assert!(outcome.conservation.energy.abs() < 1e-10, "{name}");
        assert!(!suite.pictures(&[&outcome]).expect("drawn").is_empty());
        assert!(suite.parameters().contains("material"), "a kept run of other parameters is another run");
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
    assert!(
        ["Sedov", "Riemann", "Piston", "SoundWave", "Shell", "Window"].iter().all(|name| told.contains(name)),
        "{told}"
    );
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

#[test]
fn pistons_without_two_waves_are_refused() {
    let at = |velocity: &str| faults_of(&PISTON.replace("120 m/s", velocity));
    let slow = at("5 m/s");
    assert!(slow.contains("there is no plastic wave") && slow.contains("it yields above"), "{slow}");
    let fast = at("900 m/s");
    assert!(fast.contains("overdriven") && fast.contains("below") && fast.contains("Window"), "{fast}");
    let back = at("-50 m/s");
    assert!(back.contains("must be positive"), "{back}");
    let elastic = faults_of(&PISTON.replace("\"porous-copper\"", "\"copper-sound-wave\""));
    assert!(elastic.contains("does not yield"), "{elastic}");
    assert!(faults_of(&PISTON.replace("3.5 us", "5 us")).contains("the fastest wave runs"));
    let window = faults_of(&WINDOW.replace("150 m/s", "5 m/s"));
    assert!(window.contains("there is no plastic wave"), "{window}");
}

#[test]
fn waves_that_are_no_sound_are_refused() {
    let at = |from: &str, to: &str| faults_of(&SOUND_WAVE.replace(from, to));
    let shock = at("\"2 m/s\"", "\"900 m/s\"");
    assert!(shock.contains("steepens towards a shock") && shock.contains("at most"), "{shock}");
    let yields = at("\"26 GPa\"", "\"26 GPa\", yield_strength: \"1 MPa\"");
    assert!(yields.contains("not elastic"), "{yields}");
    assert!(at("\"5 mm\"", "\"2 mm\"").contains("overlap"));
    assert!(at("\"20 mm\"", "\"10 mm\"").contains("a period of 14 mm or more"));
}

#[test]
fn shells_that_do_not_stop_or_flow_are_refused() {
    let with = |what: &str| faults_of(&SHELL.replace("stop_radius: \"34 mm\"", what));
    let fast = with("velocity: \"5 km/s\"");
    assert!(fast.contains("does not stop") && fast.contains("below"), "{fast}");
    let slow = with("velocity: \"1 m/s\"");
    assert!(slow.contains("hardly plastic flow") && slow.contains("at least"), "{slow}");
    assert!(with("").contains("neither `velocity` nor `stop_radius`"));
    assert!(with("velocity: \"90 m/s\", stop_radius: \"34 mm\"").contains("both given"));
    assert!(faults_of(&SHELL.replace("\"50 mm\"", "\"30 mm\"")).contains("greater than the inner"));
}
