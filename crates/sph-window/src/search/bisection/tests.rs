//! The steps of the search on a front that is known, with and without noise.

use super::*;

const SHOCK: f64 = 940.0;
const PISTON: f64 = 250.0;
const RATIO: f64 = SHOCK / (SHOCK - PISTON);

/// A front in a box of 240 µm that is full of the medium, one particle a µm, `noise` particles up and down.
struct Front {
    time: f64,
    place: f64,
    fed: f64,
    inlet: f64,
    noise: f64,
}

impl Front {
    fn look(&self, steps: u64) -> Look {
        let wiggle = self.noise * (5.1e9 * self.time).sin();
        let particles = (240.0 + (self.place * 1e6) * (RATIO - 1.0) * 40.0 + wiggle).round() as usize;
        let now = Observation { time: self.time, front: self.place, swept: self.fed + self.place };
        Look { now, fed: self.fed, particles, particle_steps: 1000 * steps }
    }
}

fn search(settings: &Bisection, noise: f64) -> (Bisector, Option<f64>) {
    let mut front = Front { time: 0.0, place: 8e-6, fed: 0.0, inlet: PISTON, noise };
    let (mut saved, mut bisector) = ((0.0, 0.0, 0.0), Bisector::default());
    for step in 0..400_000 {
        let target = Target { front: 1.2e-4, interval: 2e-5, inlet_velocity: front.inlet };
        let around = Surroundings { target, particle_velocity: PISTON, period: 2e-5, length: 2.4e-4 };
        match bisector.observe(&front.look(step), &around, settings) {
            Some(Order::SaveAndTry(outlet)) => {
                saved = (front.time, front.place, front.fed);
                front.inlet = outlet + PISTON;
            }
            Some(Order::Restore(outlet)) => {
                (front.time, front.place, front.fed) = saved;
                front.inlet = outlet + PISTON;
            }
            Some(Order::Finish(outlet)) => return (bisector, Some(outlet + PISTON)),
            Some(Order::GiveUp) => return (bisector, None),
            None => {}
        }
        front.time += 2e-10;
        front.fed += 2e-10 * front.inlet;
        front.place += 2e-10 * (SHOCK - front.inlet);
    }
    panic!("the search does not end: {:?}", bisector.audit().last());
}

#[test]
fn the_published_steps_are_taken_in_their_order() {
    let settings = Bisection::default();
    let (bisector, found) = search(&settings, 0.0);
    assert!((found.unwrap() - SHOCK).abs() < 2.0, "{found:?}");
    let audit = bisector.audit();
    assert_eq!((audit[0].stage, audit[0].decision), (Stage::Approach, Decision::Saved));
    let settle = audit.iter().position(|t| t.stage == Stage::Settle).unwrap();
    assert_eq!(audit[settle - 1].decision, Decision::Found);
    assert!((audit[settle].fed - 6.0).abs() < 0.1, "half a box: {}", audit[settle].fed);
    let trials: Vec<_> = audit.iter().filter(|t| t.stage == Stage::Trial).collect();
    // The bracket of 0.4 u_s is halved to below 1 m/s: nine times a round.
    assert_eq!(trials.len(), 18);
    assert!(trials.iter().all(|t| (t.fed - 3.0).abs() < 0.05 && t.particle_steps > 0));
    let mut clear = trials.iter().filter(|t| (t.inlet_velocity - SHOCK).abs() > 3.0);
    assert!(clear.all(|t| (t.drift > Some(0.0)) == (t.inlet_velocity < SHOCK)), "{trials:#?}");
    assert!(bisector.is_done() && bisector.arrived());
}

#[test]
fn a_bracket_beside_the_root_is_moved_and_a_hopeless_one_given_up() {
    let settings = Bisection { bracket: Some((500.0, 600.0)), rounds: 1, ..Bisection::default() };
    let (bisector, found) = search(&settings, 0.0);
    assert!((found.unwrap() - SHOCK).abs() < 2.0, "{found:?}");
    assert!(bisector.audit().iter().any(|t| t.decision == Decision::Moved));
    let settings = Bisection { bracket: Some((0.0, 20.0)), tolerance: 8.0, rounds: 1, ..settings };
    let (bisector, found) = search(&settings, 0.0);
    assert_eq!(found, None, "{:?}", bisector.audit().last());
}

/// Slopes of pure noise, as in a window of a few cells: the bracket does not wander off to a result.
#[test]
fn a_bracket_that_runs_away_is_given_up() {
    let settings = Bisection { rounds: 1, ..Bisection::default() };
    for noise in [3e4, -3e4] {
        let (bisector, found) = search(&settings, noise);
        let moved = bisector.audit().iter().filter(|t| t.decision == Decision::Moved).count();
        println!("{noise}: {found:?} after {moved} moves");
        assert!(found.is_none_or(|u_s| (u_s / SHOCK - 1.0).abs() < 0.6), "{found:?}");
    }
    let mut bisector = Bisector { speed: SHOCK, whole: (100.0, 140.0), ..Bisector::default() };
    bisector.bracket = (60.0, 104.0);
    assert!(!bisector.has_run_away(PISTON));
    bisector.bracket = (1396.0, 1440.0);
    assert!(bisector.has_run_away(PISTON));
    (bisector.bracket, bisector.whole) = ((0.0, 0.5), (0.0, 40.0));
    assert!(bisector.is_cut_off(1.0), "an outlet that stands");
}

#[test]
fn noise_of_the_slope_goes_into_the_result() {
    let (_, found) = search(&Bisection { rounds: 1, ..Bisection::default() }, 60.0);
    assert!((found.unwrap() - SHOCK).abs() < 40.0, "{found:?}");
}
