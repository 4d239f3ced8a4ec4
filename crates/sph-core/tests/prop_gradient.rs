//! Corrected gradients are exact on linear fields on any cloud; rotations come out exactly whatever is capped.

mod common;

use common::{Cloud, random};
use proptest::prelude::*;
use rand::RngExt;
use sph_core::correction::{Neighbor, gradient_matrix, spectral_cap};
use sph_core::gradient::{rotation_exact, scalar_sum, spin_matrix, vector_sum};
use sph_core::matrix::Eigen;
use sph_core::{Dim2, Dim3, Dimension, KernelFamily, SquareMatrix, Vector};

/// Least determinant of L, relative to its scale, at which an inverse is asked for.
const FLOOR: f64 = 1e-4;

fn kernels() -> impl Strategy<Value = KernelFamily> {
    prop::sample::select(KernelFamily::ALL.to_vec())
}

fn config() -> ProptestConfig {
    ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() }
}

fn random_matrix<D: Dimension>(seed: u64) -> SquareMatrix<D> {
    let mut random = random(seed);
    SquareMatrix::from_fn(|_, _| random.random_range(-1.0..1.0))
}

/// Offsets, and the values that a field linear in space has there.
fn linear_terms<'a, D: Dimension>(
    cloud: &'a Cloud<D>,
    i: usize,
    gradient: SquareMatrix<D>,
) -> impl Iterator<Item = (Neighbor<D>, D::Vector)> + 'a {
    // U_b,j - U_b,i = (r_j - r_i)_a ∂_a U_b.
    cloud.neighbors[i].iter().map(move |(_, n)| (*n, gradient.transposed().apply(n.offset)))
}

fn linear_fields_have_exact_gradients<D: Dimension>(cloud: &Cloud<D>, seed: u64) -> usize {
    let expected = random_matrix::<D>(seed);
    let slope = D::vector(|a| expected[(a, 0)]);
    let mut tested = 0;
    for i in 0..cloud.packing.len() {
        let l = gradient_matrix(cloud.neighbors[i].iter().map(|(_, n)| *n));
        let Some(inverse) = l.inverse(FLOOR) else { continue };
        let scalar = scalar_sum(cloud.neighbors[i].iter().map(|(_, n)| (*n, slope.dot(n.offset))));
        assert!((inverse.apply(scalar) - slope).length() < 1e-10, "scalar field at particle {i}");
        let sum = vector_sum(linear_terms(cloud, i, expected));
        assert!((inverse * sum - expected).largest() < 1e-10, "vector field at particle {i}");
        let exact = rotation_exact(sum, l, inverse);
        assert!((exact - expected).largest() < 1e-10, "vector field, rotation apart, at particle {i}");
        tested += 1;
    }
    tested
}

fn rotations_have_exact_gradients<D: Dimension>(cloud: &Cloud<D>, cap: f64, seed: u64) -> usize {
    let mut random = random(seed);
    let omega: [f64; 3] =
        std::array::from_fn(|k| if D::COUNT == 3 || k == 2 { random.random_range(-1.0..1.0) } else { 0.0 });
    let expected = spin_matrix::<D>(omega);
    let mut tested = 0;
    for i in 0..cloud.packing.len() {
        let l = gradient_matrix(cloud.neighbors[i].iter().map(|(_, n)| *n));
        let eigen = Eigen::of(l);
        // Neighbors on one line do not show a rotation about it.
        let on_one_line = D::COUNT == 3 && l.trace() - eigen.values[2] < 1e-3 * l.trace();
        if on_one_line || l.trace() == 0.0 {
            continue;
        }
        let sum = vector_sum(linear_terms(cloud, i, expected));
        let found = rotation_exact(sum, l, spectral_cap(l, cap));
        assert!((found - expected).largest() < 1e-11, "particle {i}: {found:?} {expected:?}");
        tested += 1;
    }
    tested
}

/// The largest eigenvalue of K is at most the cap, and K L is the identity where nothing was capped.
fn caps_hold<D: Dimension>(cloud: &Cloud<D>, cap: f64) {
    for list in &cloud.neighbors {
        let l = gradient_matrix(list.iter().map(|(_, n)| *n));
        let (least, k) = (Eigen::of(l).least(), spectral_cap(l, cap));
        let values = Eigen::of(k).values;
        assert!(values.as_ref().iter().all(|v| (0.0..=cap * (1.0 + 1e-14)).contains(v)));
        if least * cap > 1.0 {
            assert!((k * l - SquareMatrix::identity()).largest() < 1e-12);
        }
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn linear_fields_in_the_plane(seed: u64, kernel in kernels(), theta in 0.5..1.0, holes in 0.0..0.4) {
        let cloud = Cloud::<Dim2>::disordered(9, holes, theta, kernel, seed);
        prop_assert!(linear_fields_have_exact_gradients(&cloud, seed) > 20);
    }

    #[test]
    fn linear_fields_in_space(seed: u64, kernel in kernels(), theta in 0.55..0.8, holes in 0.0..0.4) {
        let cloud = Cloud::<Dim3>::disordered(5, holes, theta, kernel, seed);
        prop_assert!(linear_fields_have_exact_gradients(&cloud, seed) > 20);
    }

    #[test]
    fn rotations_in_the_plane(seed: u64, kernel in kernels(), cap in 0.2..10.0, holes in 0.0..0.7) {
        let cloud = Cloud::<Dim2>::disordered(9, holes, 0.6, kernel, seed);
        prop_assert!(rotations_have_exact_gradients(&cloud, cap, seed) > 5);
        caps_hold(&cloud, cap);
    }

    #[test]
    fn rotations_in_space(seed: u64, kernel in kernels(), cap in 0.2..10.0, holes in 0.0..0.7) {
        let cloud = Cloud::<Dim3>::disordered(5, holes, 0.6, kernel, seed);
        prop_assert!(rotations_have_exact_gradients(&cloud, cap, seed) > 5);
        caps_hold(&cloud, cap);
    }

    /// The gradient matrix turns with the cloud.
    #[test]
    fn the_gradient_matrix_turns_with_the_cloud(seed: u64, angle in -3.0..3.0_f64) {
        let cloud = Cloud::<Dim2>::disordered(6, 0.2, 0.6, KernelFamily::WendlandC2, seed);
        let (sin, cos) = angle.sin_cos();
        let turn = SquareMatrix::<Dim2>::from_fn(|r, c| [[cos, -sin], [sin, cos]][r][c]);
        for list in &cloud.neighbors {
            let l = gradient_matrix(list.iter().map(|(_, n)| *n));
            let turned = gradient_matrix(list.iter().map(|(_, n)| Neighbor {
                offset: turn.apply(n.offset),
                kernel_gradient: turn.apply(n.kernel_gradient),
                ..*n
            }));
            prop_assert!((turn * l * turn.transposed() - turned).largest() < 1e-13);
        }
    }

    /// What i takes from j, j takes from i with the opposite sign, to the last bit.
    #[test]
    fn kernel_gradients_are_antisymmetric_to_the_last_bit(
        kernel in kernels(), x in -2.0..2.0, y in -2.0..2.0, z in -2.0..2.0, h in 0.3..2.0
    ) {
        let r = glam::DVec3::new(x, y, z);
        prop_assert_eq!(kernel.gradient::<Dim3>(r, h), -kernel.gradient::<Dim3>(-r, h));
        prop_assert_eq!(kernel.gradient::<Dim2>(r.truncate(), h), -kernel.gradient::<Dim2>(-r.truncate(), h));
    }
}
