//! The smallest rows of the quick tier, by the same code and against the same gates as `sph-validate`.

use sph_validate::case::{Case, SchemeName, SuiteName, Tier};
use sph_validate::report::Report;
use sph_validate::runner::run_all;

/// Runs `n` of all `schemes`; every gate of these runs must pass.
fn gates_pass(suite: SuiteName, schemes: &[SchemeName], resolutions: &[u32]) -> Report {
    let of_scheme = |&scheme| resolutions.iter().map(move |&n| Case { suite, scheme, n });
    let cases: Vec<Case> = schemes.iter().flat_map(of_scheme).collect();
    let results = run_all(&cases, 2, &|_, _| ());
    for (_, result) in &results {
        assert!(result.is_ok(), "{}", result.as_ref().expect_err("a failure"));
    }
    let report = Report::new("test".into(), Tier::Quick, &results).expect("readable gates");
    println!("{}", report.table(suite));
    assert!(report.n_gates() > 0, "nothing was judged");
    let missed: Vec<_> = report.failures().collect();
    assert!(missed.is_empty(), "{missed:#?}");
    report
}

#[test]
fn riemann_problem_with_every_scheme() {
    gates_pass(SuiteName::Riemann, &SchemeName::ALL, &[100]);
}

#[test]
fn riemann_problem_converges() {
    let report = gates_pass(SuiteName::Riemann, &[SchemeName::TkcHancock], &[100, 200, 400]);
    assert!(report.rows.iter().any(|row| row.metric == "stress_l1_order" && row.passed == Some(true)));
}

#[test]
fn sound_wave_with_every_scheme() {
    gates_pass(SuiteName::SoundWave, &SchemeName::ALL, &[100]);
}

#[test]
fn sound_wave_converges() {
    let report = gates_pass(SuiteName::SoundWave, &[SchemeName::TkcHancock], &[100, 200, 400]);
    assert!(report.rows.iter().any(|row| row.metric == "velocity_l1_order" && row.passed == Some(true)));
}

#[test]
fn shell_with_every_scheme() {
    gates_pass(SuiteName::Verny, &SchemeName::ALL, &[5]);
}

/// A run gives the same bits alone and beside another one.
#[test]
fn figures_do_not_depend_on_what_runs_beside() {
    let case = |scheme| Case { suite: SuiteName::Riemann, scheme, n: 50 };
    let cases = [case(SchemeName::Csph), case(SchemeName::TkcHancock)];
    let bits = |threads| -> Vec<u64> {
        let results = run_all(&cases, threads, &|_, _| ());
        let order: Vec<Case> = results.iter().map(|(case, _)| *case).collect();
        assert_eq!(order, cases, "results in the order of the cases");
        let outcomes = results.into_iter().map(|(_, result)| result.expect("a result"));
        outcomes.flat_map(|outcome| outcome.measurements).map(|m| m.value.to_bits()).collect()
    };
    assert_eq!(bits(1), bits(2));
}
