//! The feed against the endless medium written out by hand.

use proptest::prelude::*;
use sph_core::{Components, Constraint, Dim2, Dimension, Domain, Particle, Particles};
use sph_window::{Feed, FeedSample};

/// A sample with particles at parts of the period, in any order, of a cell that starts anywhere.
fn sample(places: &[f64], start: f64, period: f64) -> FeedSample<Dim2> {
    let mut particles = Particles::default();
    for (k, part) in places.iter().enumerate() {
        let position = Dim2::vector(|axis| if axis == 0 { start + part * period } else { 0.1 * k as f64 });
        particles.push(Particle::at_rest(k as u64, position, 1.0, 0.1, 1.0));
    }
    let lower = Dim2::vector(|axis| if axis == 0 { start } else { 0.0 });
    let upper = Dim2::vector(|axis| if axis == 0 { start + period } else { 10.0 });
    FeedSample::new(particles, Domain::new(lower, upper, Components::from_fn(|_| true))).unwrap()
}

proptest! {
    #[test]
    fn each_particle_of_the_endless_medium_comes_once_in_its_place(
        places in prop::collection::vec(0.0..0.999, 1..12),
        start in -3.0..3.0,
        period in 0.3..4.0,
        moves in prop::collection::vec(0.0..3.0, 1..60),
    ) {
        let edge = 2.5;
        let mut feed = Feed::new(sample(&places, start, period));
        let mut came = Vec::new();
        let mut moved = 0.0_f64;
        let moves: Vec<f64> = moves;
        for step in moves {
            came.extend(feed.next_layer(edge, -1.0, Constraint::Free).map(|p| p.position[0] + moved));
            feed.advance(-step);
            moved += step;
        }
        came.extend(feed.next_layer(edge, -1.0, Constraint::Free).map(|p| p.position[0] + moved));
        prop_assert!(came.is_sorted(), "the medium comes from left to right");
        let count = (0_u32..)
            .map(|n| places.iter().filter(|&part| (f64::from(n) + part) * period < edge + moved).count())
            .take_while(|&count| count > 0)
            .sum::<usize>();
        // One may stand on the edge to the last bit.
        prop_assert!(came.len().abs_diff(count) <= 1, "{} {count}", came.len());
        let mut sorted = places.clone();
        sorted.sort_by(f64::total_cmp);
        for (index, place) in came.iter().enumerate() {
            let exact = ((index / places.len()) as f64 + sorted[index % places.len()]) * period;
            prop_assert!((place - exact).abs() < 1e-11, "{place} {exact}");
        }
        prop_assert!((feed.fed_length() - moved).abs() < 1e-11);
    }
}
