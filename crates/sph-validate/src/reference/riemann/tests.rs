//! The exact solution against published and independent numbers.

use proptest::prelude::*;

use super::*;

fn aluminum() -> Solid {
    Solid { density: 2688.9, bulk_modulus: 73e9, shear_modulus: 23e9, yield_strength: 0.3e9 }
}

fn paper(release: Release) -> Solution {
    let solid = aluminum();
    solve(solid, solid.at_compressive_yield(-4e9), solid.at_rest(), release).expect("the paper's problem")
}

fn close(what: &str, value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{what}: {value}, expected {expected} ± {tolerance}");
}

#[test]
fn jumps_give_the_numbers_of_the_closed_formulas() {
    let solution = paper(Release::Jump);
    let table = [
        ("elastic release", &solution.left[0], -2.647826, 79.1662, -6029.91),
        ("plastic release", &solution.left[1], -1.931996, 129.3953, -5018.10),
        ("precursor", &solution.right[0], -0.676087, 40.4285, 6219.28),
        ("plastic compression", &solution.right[1], -1.931996, 129.3953, 5256.26),
    ];
    for (name, wave, stress, velocity, speed) in table {
        close(&format!("{name}: stress"), wave.behind.stress / 1e9, stress, 6e-7);
        close(&format!("{name}: velocity"), wave.behind.velocity, velocity, 6e-5);
        close(&format!("{name}: speed"), wave.head, speed, 6e-3);
        assert_eq!(wave.head, wave.tail, "{name} is a jump");
    }
}

#[test]
fn fans_move_the_states_by_a_millionth() {
    let solution = paper(Release::Fan);
    close("contact stress", solution.contact_stress / 1e9, -1.931995, 6e-7);
    close("contact velocity", solution.contact_velocity, 129.395233, 6e-7);
    let table = [
        ("elastic head", solution.left[0].head, -6049.63),
        ("elastic tail", solution.left[0].tail, -6010.05),
        ("plastic head", solution.left[1].head, -5030.62),
        ("plastic tail", solution.left[1].tail, -5005.51),
    ];
    for (name, speed, expected) in table {
        close(name, speed, expected, 6e-3);
    }
}

#[test]
fn every_sampled_state_obeys_the_equation_of_state_and_yield() {
    let (solid, solution) = (aluminum(), paper(Release::Fan));
    for k in -700..=700 {
        let state = solution.sample(10.0 * f64::from(k));
        let stress = state.deviator - solid.bulk_modulus * (state.density / solid.density).ln();
        close("stress", state.stress, stress, 1e-6 * solid.yield_strength);
        assert!(state.deviator.abs() <= solid.deviator_limit() * (1.0 + 1e-9));
    }
}

#[test]
fn fans_are_continuous_and_jumps_are_not() {
    let solution = paper(Release::Fan);
    for (ray, jump) in
        [(-6049.63, 0.0), (-6010.05, 0.0), (-5030.62, 0.0), (5256.26, 1.26e9), (6219.28, 0.68e9)]
    {
        let change = (solution.sample(ray - 0.1).stress - solution.sample(ray + 0.1).stress).abs();
        close(&format!("change of stress at {ray} m/s"), change, jump, 0.02e9);
    }
}

/// Mass and momentum in a fixed box change only by what flows through its ends: the integral form of the laws.
#[test]
fn sampled_profile_conserves_mass_and_momentum() {
    let solution = paper(Release::Fan);
    let (left, right) = (solution.sample(-7e3), solution.sample(7e3));
    let cells = 1_400_000;
    let width = 14e3 / f64::from(cells);
    let (mut mass, mut momentum) = (0.0, 0.0);
    for k in 0..cells {
        let state = solution.sample(-7e3 + (f64::from(k) + 0.5) * width);
        mass += state.density * width;
        momentum += state.density * state.velocity * width;
    }
    close("mass", mass / (7e3 * (left.density + right.density)), 1.0, 1e-8);
    close("momentum", momentum / (right.stress - left.stress), 1.0, 1e-5);
}

#[test]
fn middle_ray_has_the_middle_stress() {
    let solution = paper(Release::Fan);
    for wave in &solution.left {
        let found = solution.sample(solution.middle_ray(wave)).stress;
        close("stress on the middle ray", found / 1e9, wave.middle_stress() / 1e9, 1e-9);
    }
    assert_eq!(solution.middle_ray(&solution.right[1]), solution.right[1].head);
}

#[test]
fn weak_jump_has_no_plastic_wave() {
    let solid = aluminum();
    let pushed = State { velocity: 10.0, ..solid.at_rest() };
    let solution = solve(solid, pushed, solid.at_rest(), Release::Fan).expect("elastic impact");
    assert_eq!((solution.left.len(), solution.right.len()), (1, 1));
    assert_eq!(solution.right[0].branch, Branch::Elastic);
    close("impact halves the velocity", solution.contact_velocity, 5.0, 1e-9);
}

#[test]
fn impossible_problems_are_named() {
    let solid = aluminum();
    let rest = solid.at_rest();
    let soft = Solid { yield_strength: 0.0, ..solid };
    assert!(matches!(
        solve(soft, rest, rest, Release::Fan),
        Err(RiemannError::Parameter { name: "yield strength", .. })
    ));
    let strained = State { deviator: 0.3e9, ..rest };
    assert!(matches!(
        solve(solid, rest, strained, Release::Fan),
        Err(RiemannError::BeyondYield { side: Side::Right, .. })
    ));
    let fast = State { velocity: 7e3, ..rest };
    let overdriven = solve(solid, fast, rest, Release::Fan).expect_err("a single shock");
    assert!(matches!(overdriven, RiemannError::Overdriven { .. }), "{overdriven}");
    let leaving = State { velocity: -1e6, ..rest };
    let vacuum = solve(solid, leaving, rest, Release::Fan).expect_err("nothing holds them");
    assert!(vacuum.to_string().contains("vacuum"), "{vacuum}");
    let colliding = State { velocity: 1e6, ..rest };
    assert!(matches!(solve(solid, colliding, rest, Release::Fan), Err(RiemannError::Collapse { .. })));
}

proptest! {
    /// Mirror the problem: the same stress, the opposite velocity.
    #[test]
    fn mirrored_problem_has_the_mirrored_solution(u in -150.0..150.0f64, s in -3e9..-0.3e9f64) {
        let solid = aluminum();
        let left = State { velocity: u, ..solid.at_compressive_yield(s) };
        let right = solid.at_rest();
        let direct = solve(solid, left, right, Release::Fan).expect("direct");
        let mirrored = solve(solid, right, State { velocity: -u, ..left }, Release::Fan).expect("mirrored");
        prop_assert!((direct.contact_stress - mirrored.contact_stress).abs() < 10.0);
        prop_assert!((direct.contact_velocity + mirrored.contact_velocity).abs() < 1e-6);
    }

    /// Add one velocity to everything: a change of frame.
    #[test]
    fn solution_is_galilean(v in -500.0..500.0f64, ray in -6500.0..6500.0f64) {
        let solid = aluminum();
        let (left, right) = (solid.at_compressive_yield(-4e9), solid.at_rest());
        let boost = |state: State| State { velocity: state.velocity + v, ..state };
        let fixed = solve(solid, left, right, Release::Fan).expect("fixed").sample(ray);
        let moved = solve(solid, boost(left), boost(right), Release::Fan).expect("moved").sample(ray + v);
        prop_assert!((fixed.velocity + v - moved.velocity).abs() < 1e-6);
        prop_assert!((fixed.stress - moved.stress).abs() < 100.0);
    }
}
