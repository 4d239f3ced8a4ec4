//! Neighbors by looking at every pair: slow, and plainly right. The oracle of the tests.

use crate::dimension::Dimension;
use crate::domain::Domain;

/// All ordered pairs (i, j), i ≠ j, whose nearest images are less than `reach(D_i, D_j)` [m] apart; sorted.
///
/// `position` has one column per axis [m], `size` the particle sizes D [m].
///
/// # Panics
/// If the columns have different lengths.
pub fn pairs<D: Dimension>(
    position: &D::AxisColumns,
    size: &[f64],
    domain: &Domain<D>,
    reach: impl Fn(f64, f64) -> f64,
) -> Vec<(u32, u32)> {
    let point = |i: usize| D::vector(|a| position[a][i]);
    let mut found = Vec::new();
    for i in 0..size.len() {
        for j in (0..size.len()).filter(|&j| j != i) {
            if domain.distance(point(i), point(j)) < reach(size[i], size[j]) {
                found.push((i as u32, j as u32));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::{Dim2, Dim3};
    use glam::{DVec2, DVec3};

    #[test]
    fn pairs_are_ordered_and_see_across_periodic_sides_only() {
        let position = [vec![0.05, 0.95, 0.5], vec![0.5, 0.5, 0.5]];
        let size = [0.2; 3];
        let reach = |a: f64, b: f64| 0.5 * (a + b);
        let open = Domain::<Dim2>::new(DVec2::ZERO, DVec2::ONE, [false, true]);
        assert_eq!(pairs(&position, &size, &open, reach), []);
        let closed = Domain::<Dim2>::new(DVec2::ZERO, DVec2::ONE, [true, false]);
        assert_eq!(pairs(&position, &size, &closed, reach), [(0, 1), (1, 0)]);
    }

    #[test]
    fn reach_is_that_of_the_pair_and_the_distance_must_be_less() {
        let position = [vec![0.0, 1.0, 3.0], vec![0.0; 3], vec![0.0; 3]];
        let domain = Domain::<Dim3>::new(DVec3::ZERO, DVec3::ONE, [false; 3]);
        let found = pairs(&position, &[0.5, 1.5, 2.5], &domain, |a, b| 0.5 * (a + b));
        assert_eq!(found, [], "distances 1, 2, 3 against 1, 2, 1.5");
        let found = pairs(&position, &[0.5, 1.5, 2.5], &domain, |a, b| 0.51 * (a + b));
        assert_eq!(found, [(0, 1), (1, 0), (1, 2), (2, 1)]);
    }
}
