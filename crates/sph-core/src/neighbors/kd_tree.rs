//! Neighbors by a kd-tree: an oracle that shares nothing with the cell lists, and a probe for irregular clouds.
//!
//! The tree (crate `kiddo`) knows periodic axes. It proposes candidates in a radius wider by a rounding margin;
//! [`Domain::distance`] decides, so that its answers agree with [`brute_force`](super::brute_force) to the last bit. For
//! the pair loops of near-uniform particles the cell lists are several times faster; for wide ranges of D, for
//! interpolation and for checks of overlap the tree is the better tool.

use kiddo::{ImmutableKdTree, SquaredEuclidean};

use crate::dimension::Dimension;
use crate::domain::Domain;
use crate::error::CoreError;

/// Relative widening of a search radius that covers the rounding of squared distances.
const ROUNDING_MARGIN: f64 = 1e-9;

/// Points in a box, to be asked for what is near.
pub struct KdTree<D: Dimension> {
    tree: Tree,
    position: D::AxisColumns,
    domain: Domain<D>,
}

/// The tree has its number of axes in its type.
enum Tree {
    Plane(ImmutableKdTree<f64, 2>),
    Space(ImmutableKdTree<f64, 3>),
}

impl<D: Dimension> KdTree<D> {
    /// Builds the tree of points given by axis [m].
    ///
    /// # Errors
    /// If a coordinate is not finite.
    pub fn new(position: &D::AxisColumns, domain: &Domain<D>) -> Result<Self, CoreError> {
        for axis in 0..D::COUNT {
            if let Some(index) = position[axis].iter().position(|x| !x.is_finite()) {
                return Err(CoreError::PositionNotFinite { index, axis, value: position[axis][index] });
            }
        }
        let tree = match D::COUNT {
            2 => Tree::Plane(build(position, domain)?),
            _ => Tree::Space(build(position, domain)?),
        };
        Ok(Self { tree, position: position.clone(), domain: *domain })
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.position[0].len()
    }

    /// True without points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Index of the point nearest to `target`, and its distance [m]; `None` without points.
    pub fn nearest(&self, target: D::Vector) -> Option<(u32, f64)> {
        if self.is_empty() {
            return None;
        }
        let i = match &self.tree {
            Tree::Plane(tree) => nearest(tree, target, &self.domain),
            Tree::Space(tree) => nearest(tree, target, &self.domain),
        };
        Some((i, self.distance(i, target)))
    }

    /// Indices of the points less than `radius` [m] from `target`, sorted, with their distances [m].
    pub fn within(&self, target: D::Vector, radius: f64) -> Vec<(u32, f64)> {
        let mut found = Vec::new();
        self.visit_candidates(target, radius, |i| {
            let distance = self.distance(i, target);
            if distance < radius {
                found.push((i, distance));
            }
        });
        found.sort_unstable_by_key(|&(i, _)| i);
        found
    }

    fn distance(&self, i: u32, target: D::Vector) -> f64 {
        self.domain.distance(target, D::vector(|a| self.position[a][i as usize]))
    }

    /// Calls `visit` with every point within a radius slightly wider than `radius`.
    fn visit_candidates(&self, target: D::Vector, radius: f64, visit: impl FnMut(u32)) {
        if self.is_empty() || radius.is_nan() || radius <= 0.0 {
            return;
        }
        let radius = radius * (1.0 + ROUNDING_MARGIN);
        match &self.tree {
            Tree::Plane(tree) => within(tree, target, radius, &self.domain, visit),
            Tree::Space(tree) => within(tree, target, radius, &self.domain, visit),
        }
    }
}

/// All ordered pairs (i, j), i ≠ j, whose nearest images are less than `reach(D_i, D_j)` [m] apart; sorted.
///
/// The same as [`brute_force::pairs`](super::brute_force::pairs). `reach` must not fall when D_j grows.
///
/// # Errors
/// If a coordinate is not finite.
pub fn pairs<D: Dimension>(
    position: &D::AxisColumns,
    size: &[f64],
    domain: &Domain<D>,
    reach: impl Fn(f64, f64) -> f64,
) -> Result<Vec<(u32, u32)>, CoreError> {
    let tree = KdTree::new(position, domain)?;
    let largest = size.iter().copied().fold(0.0, f64::max);
    let mut found = Vec::new();
    for i in 0..size.len() {
        let here = D::vector(|a| position[a][i]);
        let near = tree.within(here, reach(size[i], largest));
        let listed = near
            .into_iter()
            .filter(|&(j, distance)| j as usize != i && distance < reach(size[i], size[j as usize]));
        found.extend(listed.map(|(j, _)| (i as u32, j)));
    }
    Ok(found)
}

/// Point of the tree for a point of space: measured from the lower corner and inside the box on periodic axes.
fn in_box<D: Dimension, const N: usize>(point: D::Vector, domain: &Domain<D>) -> [f64; N] {
    std::array::from_fn(|a| {
        if domain.periodic[a] { domain.wrap(a, point[a]) - domain.lower[a] } else { point[a] }
    })
}

fn build<D: Dimension, const N: usize>(
    position: &D::AxisColumns,
    domain: &Domain<D>,
) -> Result<ImmutableKdTree<f64, N>, CoreError> {
    let point = |i: usize| in_box(D::vector(|a| position[a][i]), domain);
    let points: Vec<[f64; N]> = (0..position[0].len()).map(point).collect();
    ImmutableKdTree::new_from_slice(&points).map_err(|e| CoreError::KdTree(e.to_string()))
}

fn nearest<D: Dimension, const N: usize>(
    tree: &ImmutableKdTree<f64, N>,
    target: D::Vector,
    domain: &Domain<D>,
) -> u32 {
    let (target, periods) = (in_box(target, domain), std::array::from_fn(|a| domain.period(a)));
    let query = tree.query(&target).periodic_boundary_condition(&periods);
    query.nearest_one::<SquaredEuclidean<f64>>().execute().item
}

fn within<D: Dimension, const N: usize>(
    tree: &ImmutableKdTree<f64, N>,
    target: D::Vector,
    radius: f64,
    domain: &Domain<D>,
    mut visit: impl FnMut(u32),
) {
    let (target, periods) = (in_box(target, domain), std::array::from_fn(|a| domain.period(a)));
    let query = tree.query(&target).periodic_boundary_condition(&periods);
    let found = query.within::<SquaredEuclidean<f64>>(radius * radius).unsorted().without_distances();
    found.execute().into_iter().for_each(|found| visit(found.item));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::{Dim2, Dim3};
    use glam::{DVec2, DVec3};

    #[test]
    fn the_nearest_point_is_found_across_a_periodic_side() {
        let domain = Domain::<Dim2>::new(DVec2::splat(-1.0), DVec2::ONE, [true, false]);
        let tree = KdTree::new(&[vec![-0.9, 0.4, 3.2], vec![0.0, 0.0, 5.0]], &domain).unwrap();
        let (i, distance) = tree.nearest(DVec2::new(0.9, 0.0)).unwrap();
        assert_eq!(i, 0);
        assert!((distance - 0.2).abs() < 1e-15);
        assert_eq!(tree.nearest(DVec2::new(1.1, 4.5)).unwrap().0, 2, "points outside are moved into the box");
    }

    #[test]
    fn points_within_a_radius_come_sorted_and_the_distance_must_be_less() {
        let domain = Domain::<Dim3>::open();
        let tree = KdTree::new(&[vec![2.0, 0.0, 1.0, 0.5], vec![0.0; 4], vec![0.0; 4]], &domain).unwrap();
        assert_eq!(tree.within(DVec3::ZERO, 1.0), [(1, 0.0), (3, 0.5)]);
        assert_eq!(tree.within(DVec3::ZERO, f64::INFINITY).len(), 4);
        assert_eq!(tree.within(DVec3::ZERO, 0.0), []);
    }

    #[test]
    fn many_points_in_one_place_and_no_points_at_all_are_no_trouble() {
        let domain = Domain::<Dim2>::open();
        let tree = KdTree::new(&[vec![1.0; 200], vec![1.0; 200]], &domain).unwrap();
        assert_eq!(tree.within(DVec2::ONE, 0.1).len(), 200);
        let empty = KdTree::new(&[vec![], vec![]], &domain).unwrap();
        assert_eq!(empty.nearest(DVec2::ONE), None);
        assert_eq!(empty.within(DVec2::ONE, 1.0), []);
    }

    #[test]
    fn a_coordinate_that_is_not_a_number_is_told() {
        let error =
            KdTree::<Dim2>::new(&[vec![0.0, 1.0], vec![0.0, f64::NAN]], &Domain::open()).err().unwrap();
        assert!(matches!(error, CoreError::PositionNotFinite { index: 1, axis: 1, .. }));
        assert!(error.to_string().contains("point 1"));
    }
}
