//! The smallest rows of the quick tier, by the same code and against the same gates as `sph-validate`.

use std::sync::atomic::AtomicBool;

use sph_validate::case::{Case, SchemeName, Tier};
use sph_validate::conservation::Conservation;
use sph_validate::gate::GateFile;
use sph_validate::report::{Provenance, Report};
use sph_validate::runner::{Ended, Job, Settings, run_all};
use sph_validate::suites;

fn run(cases: &[Case], threads: usize) -> Vec<Ended<'static>> {
    let job = |case: &Case| Job { suite: suites::find(&case.suite).expect("a suite"), case: case.clone() };
    let settings = Settings { threads, store: None, interrupt: &AtomicBool::new(false) };
    run_all(cases.iter().map(job).collect(), settings, &|_, _| ())
}

/// Runs `cases`; every gate of these runs must pass.
fn gates_pass(cases: &[Case]) -> Report {
    let ended = run(cases, 2);
    for ended in &ended {
        assert!(ended.result.is_ok(), "{}", ended.result.as_ref().expect_err("a failure"));
    }
    let report = Report::new(Provenance::default(), Tier::Quick, &ended).expect("readable gates");
    println!("{}", report.table(&report.suites[0]));
    assert!(report.n_gates() > 0, "nothing was judged");
    let missed: Vec<_> = report.failures().collect();
    assert!(missed.is_empty(), "{missed:#?}");
    report
}

/// Suites whose figures are bounds at each resolution, without an order: two resolutions do where a run is long.
const WITHOUT_ORDER: [&str; 1] = ["window-porous"];

/// Each suite in both tiers: its own name in its runs, no run twice, three resolutions or more in the full tier, and
/// gates of what must be conserved.
#[test]
fn suites_are_as_they_should_be() {
    for suite in suites::ALL {
        let about = suite.about();
        let gates = GateFile::read(about.name, about.gates).expect("readable gates");
        for tier in [Tier::Quick, Tier::Full] {
            let cases = suite.cases(tier);
            assert!(!cases.is_empty(), "{}", about.name);
            for case in &cases {
                assert_eq!(case.suite, about.name);
                assert!(suite.work(case) > 0.0, "{case}");
                assert_eq!(cases.iter().filter(|other| *other == case).count(), 1, "{case} twice");
                let kin = cases.iter().filter(|other| other.is_kin_of(case)).count();
                let least = if WITHOUT_ORDER.contains(&about.name) { 2 } else { 3 };
                assert!(tier == Tier::Quick || kin >= least, "{case}: {kin} resolutions show no order");
                for metric in [Conservation::MASS, Conservation::MOMENTUM, Conservation::ENERGY] {
                    assert!(gates.of_figure(case, &metric.name, 0.0).is_some(), "{case}: {}", metric.name);
                }
            }
        }
    }
}

#[test]
fn riemann_problem_with_every_scheme() {
    gates_pass(&Case::grid("riemann", &SchemeName::ALL, &[100]));
}

#[test]
fn riemann_problem_converges() {
    let report = gates_pass(&Case::grid("riemann", &[SchemeName::TkcHancock], &[100, 200, 400]));
    assert!(report.rows.iter().any(|row| row.metric == "stress_l1_order" && row.passed == Some(true)));
}

#[test]
fn sound_wave_with_every_scheme() {
    gates_pass(&Case::grid("sound-wave", &SchemeName::ALL, &[100]));
}

#[test]
fn sound_wave_converges() {
    let report = gates_pass(&Case::grid("sound-wave", &[SchemeName::TkcHancock], &[100, 200, 400]));
    assert!(report.rows.iter().any(|row| row.metric == "velocity_l1_order" && row.passed == Some(true)));
}

#[test]
fn shell_with_every_scheme() {
    gates_pass(&Case::grid("verny", &SchemeName::ALL, &[5]));
}

/// One cheap run of the default scheme in each of the further problems.
#[test]
fn further_problems_with_the_default_scheme() {
    let hancock = |suite, variant, n| Case::new(suite, SchemeName::TkcHancock, n).of_variant(variant);
    for case in [
        hancock("piston", "copper", 100),
        hancock("plate-impact", "", 60),
        hancock("window-solid", "200", 120),
        hancock("window-porous", "250", 10),
        hancock("spinning-disc", "", 6),
        hancock("rigid-rotation", "", 1000),
        hancock("vibration", "ring", 5),
        hancock("shells", "aluminum-square", 5),
        hancock("taylor-bar", "copper", 2),
        hancock("gas", "sod", 100),
        hancock("acoustic", "45-deg", 24),
    ] {
        gates_pass(&[case]);
    }
}

/// A run gives the same bits alone and beside another one.
#[test]
fn figures_do_not_depend_on_what_runs_beside() {
    let cases = Case::grid("riemann", &[SchemeName::Csph, SchemeName::TkcHancock], &[50]);
    let bits = |threads| -> Vec<u64> {
        let ended = run(&cases, threads);
        let order: Vec<Case> = ended.iter().map(|ended| ended.job.case.clone()).collect();
        assert_eq!(order, cases, "results in the order of the cases");
        let outcomes: Vec<_> = ended.into_iter().map(|ended| ended.result.expect("a result")).collect();
        outcomes.iter().flat_map(|outcome| outcome.figures()).map(|figure| figure.value.to_bits()).collect()
    };
    assert_eq!(bits(1), bits(2));
}

#[test]
fn disorder_of_a_tenth_with_faces_closed() {
    gates_pass(&[Case::new("disorder", SchemeName::TkcHancock, 200).of_variant("closed-0.1")]);
}

#[test]
fn spall_with_both_models_of_failure() {
    let case = |variant| Case::new("spall", SchemeName::TkcHancock, 50).of_variant(variant);
    gates_pass(&["cutoff", "voids"].map(case));
}

#[test]
fn pores_collapse_at_both_speeds() {
    let case = |variant| Case::new("collapse", SchemeName::TkcHancock, 20).of_variant(variant);
    gates_pass(&["100", "300"].map(case));
}
