//! Gradients from sums over neighbors.
//!
//! With L_i of [`correction`](crate::correction) and K_i the matrix that stands for its inverse,
//!
//! ```text
//! (∇Φ)_i = K_i Σ_j V_j (Φ_j - Φ_i) ∇_iW_ij                                                   [`scalar_sum`]
//! R_ab   = Σ_j V_j ∂_aW (U_b,j - U_b,i),   (∇U)_ab = ∂_a U_b                                  [`vector_sum`]
//! ```
//!
//! For a field linear in space the sums are L_i times its gradient, so that K_i = L_i⁻¹ makes them exact on any cloud.
//! A capped K_i is not exact across a surface, and there it would turn a rigid rotation into strain. So the rotation is
//! taken out first ([`rotation_exact`]): with the spin W that the neighbors show,
//!
//! ```text
//! ∇U = W + K (R - L W),      W_ab = ε_bca Ω_c,
//! Ω  = (tr L I - L)⁻¹ q,     q_e  = ε_eab R_ab               in space,
//! Ω  = (R_xy - R_yx)/tr L                                     in the plane (along z).
//! ```
//!
//! U = Ω × r has the gradient W; then R = L W and q = (tr L I - L) Ω, so the rotation comes out exactly whatever K is.
//! Where K = L⁻¹ the result is L⁻¹ R, whatever W is.
//!
//! In every gradient of a vector here the row a is the axis of the derivative and the column b the component. These are
//! plain versions for one particle, the reference of the pair loops.

use crate::correction::Neighbor;
use crate::dimension::Dimension;
use crate::matrix::{Eigen, SquareMatrix};

/// Below this share of tr L an eigenvalue of tr L I - L is taken for zero: the neighbors stand on one line and show no
/// rotation about it.
const NO_ROTATION: f64 = 1e-12;

/// Σ V_j (Φ_j - Φ_i) ∇_iW_ij [unit of Φ/m] from the neighbors and Φ_j - Φ_i.
pub fn scalar_sum<D: Dimension>(terms: impl IntoIterator<Item = (Neighbor<D>, f64)>) -> D::Vector {
    terms
        .into_iter()
        .fold(D::vector(|_| 0.0), |sum, (n, difference)| sum + n.kernel_gradient * (n.volume * difference))
}

/// R_ab = Σ V_j ∂_aW (U_b,j - U_b,i) [unit of U/m] from the neighbors and U_j - U_i.
pub fn vector_sum<D: Dimension>(
    terms: impl IntoIterator<Item = (Neighbor<D>, D::Vector)>,
) -> SquareMatrix<D> {
    terms.into_iter().fold(SquareMatrix::zero(), |sum, (n, difference)| {
        sum + SquareMatrix::outer(n.kernel_gradient * n.volume, difference)
    })
}

/// The angular velocity Ω (x, y, z) [rad/s] that the neighbors show; along z in the plane.
pub fn angular_velocity<D: Dimension>(
    vector_sum: SquareMatrix<D>,
    gradient_matrix: SquareMatrix<D>,
) -> [f64; 3] {
    let trace = gradient_matrix.trace();
    let q = axial(vector_sum);
    if D::COUNT == 2 {
        return [0.0, 0.0, if trace > 0.0 { q[2] / trace } else { 0.0 }];
    }
    let eigen = Eigen::of(gradient_matrix);
    let mut omega = [0.0; 3];
    for k in 0..3 {
        let (n, inertia) = (&eigen.vectors[k], trace - eigen.values[k]);
        if inertia > NO_ROTATION * trace {
            let along = (0..3).map(|a| n[a] * q[a]).sum::<f64>() / inertia;
            (0..3).for_each(|a| omega[a] += along * n[a]);
        }
    }
    omega
}

/// W_ab = ε_bca Ω_c [1/s]: the gradient of U = Ω × r.
pub fn spin_matrix<D: Dimension>(omega: [f64; 3]) -> SquareMatrix<D> {
    SquareMatrix::from_fn(|a, b| match (3 + b - a) % 3 {
        0 => 0.0,
        1 => omega[(b + 1) % 3],
        _ => -omega[(a + 1) % 3],
    })
}

/// ∇U = W + K (R - L W) [1/s]: exact on rigid rotations for any K, and on linear fields for K = L⁻¹.
pub fn rotation_exact<D: Dimension>(
    vector_sum: SquareMatrix<D>,
    gradient_matrix: SquareMatrix<D>,
    correction: SquareMatrix<D>,
) -> SquareMatrix<D> {
    let spin = spin_matrix(angular_velocity(vector_sum, gradient_matrix));
    spin + correction * (vector_sum - gradient_matrix * spin)
}

/// q_e = ε_eab M_ab; in the plane only q_z.
fn axial<D: Dimension>(m: SquareMatrix<D>) -> [f64; 3] {
    let component = |a: usize, b: usize| if a.max(b) < D::COUNT { m[(a, b)] - m[(b, a)] } else { 0.0 };
    [component(1, 2), component(2, 0), component(0, 1)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::{Dim2, Dim3};
    use crate::kernel::KernelFamily;
    use glam::DVec3;

    #[test]
    fn the_plane_form_is_omega_times_j() {
        let w = spin_matrix::<Dim2>([0.0, 0.0, 3.0]);
        assert_eq!([[w[(0, 0)], w[(0, 1)]], [w[(1, 0)], w[(1, 1)]]], [[0.0, 3.0], [-3.0, 0.0]]);
    }

    #[test]
    fn the_spin_matrix_is_the_gradient_of_the_rotation() {
        let omega = DVec3::new(1.0, -2.0, 0.5);
        let w = spin_matrix::<Dim3>(omega.to_array());
        let r = DVec3::new(0.3, 0.7, -1.1);
        // U_b = r_a ∂_a U_b.
        let velocity = w.transposed().apply(r);
        assert!((velocity - omega.cross(r)).length() < 1e-15);
        let q = axial(w);
        assert!((0..3).all(|e| q[e] == 2.0 * omega[e]), "the curl is twice the angular velocity: {q:?}");
    }

    #[test]
    fn neighbors_on_a_line_show_the_rotation_across_it_only() {
        let omega = DVec3::new(1.0, -2.0, 0.5);
        let neighbors = [-1.0, 1.0, 2.0].map(|x| {
            let n = Neighbor::<Dim3>::new(KernelFamily::WendlandC2, DVec3::new(x, 0.0, 0.0), 1.3, 1.0);
            (n, omega.cross(n.offset))
        });
        let l = crate::correction::gradient_matrix(neighbors.map(|(n, _)| n));
        let found = DVec3::from(angular_velocity(vector_sum(neighbors), l));
        assert!((found - DVec3::new(0.0, -2.0, 0.5)).length() < 1e-14, "{found}");
        assert_eq!(angular_velocity(SquareMatrix::<Dim3>::zero(), SquareMatrix::zero()), [0.0; 3]);
        assert_eq!(angular_velocity(SquareMatrix::<Dim2>::zero(), SquareMatrix::zero()), [0.0; 3]);
    }

    #[test]
    fn the_sums_are_the_gradient_matrix_times_the_gradient() {
        let slope = DVec3::new(2.0, -1.0, 0.3);
        let terms: Vec<(Neighbor<Dim3>, f64)> = (0..12)
            .map(|k| {
                let angle = k as f64;
                let offset = DVec3::new(angle.sin(), (1.7 * angle).cos(), (2.9 * angle).sin());
                (Neighbor::new(KernelFamily::CubicSpline, offset, 1.0, 0.1), slope.dot(offset))
            })
            .collect();
        let l = crate::correction::gradient_matrix(terms.iter().map(|t| t.0));
        assert!((scalar_sum(terms) - l.apply(slope)).length() < 1e-15);
    }
}
