//! Where an adaptive sweep puts its next points.
//!
//! A sweep goes in rounds. After each, the curve between neighbors is asked how far it may be from the straight line that
//! joins them. With the second divided differences `κ` at both ends of an interval of length h:
//!
//! ```text
//! e = (h² |κ_a κ_b|)/(|κ_a| + |κ_b|)      (κ_a κ_b > 0),
//! e = ⅛ h² min(|κ_a|, |κ_b|)      otherwise
//! ```
//!
//! The first is exact for one kink within the interval and equal spacings, and four times too large for a smooth curve:
//! where pores shut, the Hugoniot has a kink, and it must not be missed. A kink at a point itself gives zero: there is
//! nothing to be gained. An outermost interval knows one difference only, and takes ⅛h²|κ|. Intervals with e above the
//! tolerance, and above twice what the standard errors of u_s could feign, get a point in their middle, the worst first.
//!
//! Each round depends on the finished points alone. So a run that was interrupted chooses the same points again, and no
//! finished one is computed twice.

use crate::config::case::Refinement;

/// Neighbors closer than this get no point between them [m/s].
const LEAST_SPACING: f64 = 1.0;
/// New points are multiples of this [m/s].
const GRID: f64 = 0.1;
/// Standard deviations by which a deviation must exceed noise.
const NOISE: f64 = 2.0;

/// A finished point of the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// u_p [m/s].
    pub particle_velocity: f64,
    /// u_s [m/s]; `NaN` if the point failed.
    pub shock_velocity: f64,
    /// Standard error of u_s [m/s]; `NaN` if unknown.
    pub standard_error: f64,
}

/// An interval between neighbors and how far the curve may be from its straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Its ends [m/s].
    pub ends: (f64, f64),
    /// Possible deviation of u_s from the straight line [m/s].
    pub deviation: f64,
    /// The deviation that standard errors alone could feign [m/s].
    pub noise: f64,
    /// The deviation relative to u_s [-].
    pub relative: f64,
}

/// The points of the next round [m/s], rising; none once the curve is resolved or the points are used up.
pub fn next_points(known: &[Known], refinement: &Refinement) -> Vec<f64> {
    let room = refinement.max_points.saturating_sub(known.len());
    let mut wanted: Vec<Gap> = gaps(known).into_iter().filter(|g| is_open(g, refinement)).collect();
    wanted.sort_by(|a, b| b.relative.total_cmp(&a.relative).then(a.ends.0.total_cmp(&b.ends.0)));
    let middles = wanted.iter().map(|g| middle(g.ends));
    let new = middles.filter(|m| known.iter().all(|k| (k.particle_velocity - m).abs() > 0.5 * GRID));
    let mut points: Vec<f64> = new.take(room).collect();
    points.sort_by(f64::total_cmp);
    points
}

fn is_open(gap: &Gap, refinement: &Refinement) -> bool {
    gap.relative > refinement.tolerance
        && gap.deviation > NOISE * gap.noise
        && gap.ends.1 - gap.ends.0 >= 2.0 * LEAST_SPACING
}

fn middle((low, high): (f64, f64)) -> f64 {
    (0.5 * (low + high) / GRID).round() * GRID
}

/// All intervals between points that have a u_s, from the least u_p on.
pub fn gaps(known: &[Known]) -> Vec<Gap> {
    let mut points: Vec<Known> = known.iter().copied().filter(|k| k.shock_velocity.is_finite()).collect();
    points.sort_by(|a, b| a.particle_velocity.total_cmp(&b.particle_velocity));
    let bends: Vec<Option<(f64, f64)>> = (0..points.len()).map(|k| bend(&points, k)).collect();
    (1..points.len()).map(|k| gap(&points[k - 1], &points[k], bends[k - 1], bends[k])).collect()
}

/// Second divided difference at a point and its standard error [1/(m/s)]; none at the ends.
fn bend(points: &[Known], at: usize) -> Option<(f64, f64)> {
    let (before, here, after) = (points.get(at.checked_sub(1)?)?, points[at], points.get(at + 1)?);
    let left = here.particle_velocity - before.particle_velocity;
    let right = after.particle_velocity - here.particle_velocity;
    let scale = 2.0 / (left + right);
    let weights = [scale / left, -scale * (1.0 / left + 1.0 / right), scale / right];
    let three = [before, &here, after];
    let value = weights.iter().zip(three).map(|(w, k)| w * k.shock_velocity).sum();
    let error = |k: &Known| if k.standard_error.is_finite() { k.standard_error } else { 0.0 };
    let square: f64 = weights.iter().zip(three).map(|(w, k)| (w * error(k)).powi(2)).sum();
    Some((value, square.sqrt()))
}

fn gap(low: &Known, high: &Known, at_low: Option<(f64, f64)>, at_high: Option<(f64, f64)>) -> Gap {
    let h = high.particle_velocity - low.particle_velocity;
    let (deviation, noise) = match (at_low, at_high) {
        (Some(a), Some(b)) => (between(h, a.0, b.0), h * h * a.1.max(b.1) / 8.0),
        (Some(only), None) | (None, Some(only)) => (h * h * only.0.abs() / 8.0, h * h * only.1 / 8.0),
        (None, None) => (0.0, 0.0),
    };
    let mean = 0.5 * (low.shock_velocity + high.shock_velocity).abs();
    let ends = (low.particle_velocity, high.particle_velocity);
    Gap { ends, deviation, noise, relative: deviation / mean }
}

fn between(h: f64, a: f64, b: f64) -> f64 {
    if a * b > 0.0 { h * h * a * b / (a + b).abs() } else { h * h * a.abs().min(b.abs()) / 8.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REFINEMENT: Refinement = Refinement { tolerance: 0.003, max_points: 24 };

    fn at(u_p: f64, curve: impl Fn(f64) -> f64) -> Known {
        Known { particle_velocity: u_p, shock_velocity: curve(u_p), standard_error: 0.2 }
    }

    /// Runs rounds to their end; all points.
    fn sweep(first: &[f64], refinement: &Refinement, curve: impl Fn(f64) -> f64 + Copy) -> Vec<f64> {
        let mut known: Vec<Known> = first.iter().map(|&u| at(u, curve)).collect();
        loop {
            let next = next_points(&known, refinement);
            if next.is_empty() {
                known.sort_by(|a, b| a.particle_velocity.total_cmp(&b.particle_velocity));
                return known.iter().map(|k| k.particle_velocity).collect();
            }
            known.extend(next.iter().map(|&u| at(u, curve)));
        }
    }

    #[test]
    fn points_gather_at_a_kink_and_nowhere_else() {
        let kinked =
            |u: f64| if u < 131.7 { 230.0 + 1.9 * u } else { 230.0 + 1.9 * 131.7 + 3.6 * (u - 131.7) };
        let points = sweep(&[50.0, 112.5, 175.0, 237.5, 300.0], &REFINEMENT, kinked);
        let (low, high) = points.windows(2).map(|w| (w[0], w[1])).find(|w| w.1 > 131.7).unwrap();
        assert!(high - low < 10.0, "the kink lies between {low} and {high}: {points:?}");
        assert!(points.len() <= 14, "{points:?}");
        assert_eq!(points.iter().filter(|u| **u > 190.0).count(), 2, "nothing to find there: {points:?}");
    }

    #[test]
    fn linear_interpolation_ends_within_the_tolerance() {
        let curve = |u: f64| 14.58 + 3.573 * u - 0.003 * u * u;
        let points = sweep(&[50.0, 112.5, 175.0, 237.5, 300.0], &REFINEMENT, curve);
        for pair in points.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let line = 0.5 * (curve(pair[0]) + curve(pair[1]));
            assert!((line / curve(middle) - 1.0).abs() < REFINEMENT.tolerance, "{pair:?}");
        }
    }

    #[test]
    fn a_straight_line_and_noise_alone_ask_for_nothing() {
        assert_eq!(sweep(&[50.0, 100.0, 150.0, 200.0], &REFINEMENT, |u| 200.0 + 2.0 * u).len(), 4);
        let noisy = |u: f64, shift| Known {
            shock_velocity: 400.0 + shift,
            standard_error: 5.0,
            particle_velocity: u,
        };
        let known = [noisy(50.0, 0.0), noisy(60.0, 6.0), noisy(70.0, -5.0), noisy(80.0, 4.0)];
        assert!(next_points(&known, &REFINEMENT).is_empty());
    }

    #[test]
    fn the_points_are_limited_and_a_failed_one_is_not_tried_again() {
        let curve = |u: f64| u * u;
        let few = Refinement { max_points: 7, ..REFINEMENT };
        assert_eq!(sweep(&[50.0, 100.0, 200.0, 300.0], &few, curve).len(), 7);
        let mut known: Vec<Known> = [50.0, 100.0, 200.0, 300.0].iter().map(|&u| at(u, curve)).collect();
        known.push(Known { particle_velocity: 150.0, shock_velocity: f64::NAN, standard_error: f64::NAN });
        assert!(!next_points(&known, &REFINEMENT).contains(&150.0));
    }

    #[test]
    fn the_order_of_the_finished_points_does_not_matter() {
        let curve = |u: f64| 100.0 + 0.02 * u * u;
        let mut known: Vec<Known> = [50.0, 90.0, 120.0, 200.0, 300.0].iter().map(|&u| at(u, curve)).collect();
        let before = next_points(&known, &REFINEMENT);
        known.reverse();
        assert_eq!(next_points(&known, &REFINEMENT), before);
        assert!(before.len() > 1 && before.is_sorted());
    }
}
