//! Which points are taken away: whole shells, so many that the wanted number is met as nearly as whole shells allow.
//!
//! Points of equal distance form a shell. Taken are the nearest shells, at best with one shell near the cut exchanged; where
//! that is not near enough, single points beside ([`complete`]). Where the voids have no symmetry every point is a shell of its own, and the number is met exactly.

/// Two points at distances that differ by less, relative to the particle size, belong to one shell.
const SAME_SHELL: f64 = 1e-6;
/// Shells this far around the cut, in D, may be exchanged to meet the number.
const EXCHANGE: f64 = 0.5;

/// Whole shells are kept where they miss the porosity by no more than this part.
const WHOLE_SHELLS: f64 = 0.003;

/// A shell: distance and points.
type Shell = (f64, Vec<usize>);

/// What is taken: shells before `end`, with one more exchanged if there is one.
#[derive(Clone, Copy)]
struct Choice {
    miss: f64,
    end: usize,
    exchanged: Option<usize>,
}

/// Marks the points of a lattice that become void: `wanted` of the least distance [m], in whole shells where they meet the
/// porosity nearly enough. `size` is D [m].
pub(super) fn voids(distance: &[f64], wanted: f64, size: f64) -> Vec<bool> {
    let mut removed = nearest_points(distance, wanted, size);
    let all = distance.len() as f64;
    let left = all - removed.iter().filter(|gone| **gone).count() as f64;
    if (left / (all - wanted) - 1.0).abs() > WHOLE_SHELLS {
        complete(&mut removed, distance, wanted);
    }
    removed
}

/// Marks `wanted` points of the least distance [m]; those at an infinite distance are never taken. `size` is D [m].
pub(super) fn nearest_points(distance: &[f64], wanted: f64, size: f64) -> Vec<bool> {
    let shells = shells(distance, size);
    let choice = choose(&shells, wanted, size);
    let mut taken = vec![false; distance.len()];
    for (k, shell) in shells.iter().enumerate() {
        if (k < choice.end) != (choice.exchanged == Some(k)) {
            shell.1.iter().for_each(|&i| taken[i] = true);
        }
    }
    taken
}

/// Meets the number more nearly than whole shells do: single points next to the cut are taken or given back, each with its
/// mirror image through the middle of the lattice (point i and N - 1 - i), so that pores stay alike.
fn complete(taken: &mut [bool], distance: &[f64], wanted: f64) {
    let missing = wanted - taken.iter().filter(|t| **t).count() as f64;
    let take = missing > 0.0;
    let last = taken.len() - 1;
    let mut order: Vec<usize> =
        (0..=last / 2).filter(|&i| taken[i] != take && taken[last - i] != take).collect();
    order.retain(|&i| distance[i].is_finite() && i != last - i);
    let sign = if take { 1.0 } else { -1.0 };
    order.sort_by(|&a, &b| (sign * distance[a]).total_cmp(&(sign * distance[b])).then(a.cmp(&b)));
    for i in order.into_iter().take((0.5 * missing.abs()).round() as usize) {
        taken[i] = take;
        taken[last - i] = take;
    }
}

fn choose(shells: &[Shell], wanted: f64, size: f64) -> Choice {
    let mut best = Choice { miss: wanted, end: 0, exchanged: None };
    let mut consider = |count: f64, end: usize, exchanged: Option<usize>| {
        let miss = (count - wanted).abs();
        if miss < best.miss - 1e-9 {
            best = Choice { miss, end, exchanged };
        }
        miss < 1e-9
    };
    let mut total = 0.0;
    for last in 0..shells.len() {
        total += shells[last].1.len() as f64;
        if consider(total, last + 1, None) {
            break;
        }
        if (total - wanted).abs() > 0.1 * wanted + 50.0 {
            continue;
        }
        let near = |other: &Shell| (other.0 - shells[last].0).abs() < EXCHANGE * size;
        let first = shells[..last].iter().rposition(|s| !near(s)).map_or(0, |k| k + 1);
        let end = shells[last..].iter().position(|s| !near(s)).map_or(shells.len(), |k| last + k);
        for other in (first..end).filter(|&other| other != last) {
            let change = shells[other].1.len() as f64;
            if consider(if other < last { total - change } else { total + change }, last + 1, Some(other)) {
                return best;
            }
        }
    }
    best
}

/// Points of equal distance, from the nearest on.
fn shells(distance: &[f64], size: f64) -> Vec<Shell> {
    let mut order: Vec<usize> = (0..distance.len()).filter(|&i| distance[i].is_finite()).collect();
    order.sort_by(|&a, &b| distance[a].total_cmp(&distance[b]).then(a.cmp(&b)));
    let mut shells: Vec<Shell> = Vec::new();
    for i in order {
        match shells.last_mut() {
            Some(shell) if distance[i] - shell.0 < SAME_SHELL * size => shell.1.push(i),
            _ => shells.push((distance[i], vec![i])),
        }
    }
    shells
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(taken: &[bool]) -> usize {
        taken.iter().filter(|t| **t).count()
    }

    #[test]
    fn single_points_are_taken_to_the_last() {
        let distance: Vec<f64> = (0..1000).map(|k| ((k * 617) % 1000) as f64 * 0.01 - 2.0).collect();
        for wanted in [0.0, 1.0, 137.0, 999.0, 1000.0] {
            let taken = nearest_points(&distance, wanted, 1.0);
            assert_eq!(count(&taken) as f64, wanted);
        }
        let taken = nearest_points(&distance, 200.0, 1.0);
        assert!((0..1000).all(|i| taken[i] == (distance[i] < -0.005)));
    }

    #[test]
    fn shells_stay_whole_and_one_may_be_exchanged() {
        // Shells of 4, 4, 8 and 1 points.
        let distance: Vec<f64> =
            [(1.0, 4), (2.0, 4), (3.0, 8), (3.2, 1)].iter().flat_map(|&(d, n)| vec![d; n]).collect();
        for (wanted, expected) in [(4.0, 4), (5.0, 4), (9.0, 9), (16.0, 16), (17.0, 17)] {
            assert_eq!(count(&nearest_points(&distance, wanted, 1.0)), expected, "{wanted}");
        }
        let mut far = distance.clone();
        far.push(f64::INFINITY);
        assert!(!nearest_points(&far, 18.0, 1.0)[17]);
    }
}
