//! The matrix of the kernel gradient, and what stands for its inverse.
//!
//! ```text
//! L_i = Σ_j V_j ∇_iW_ij ⊗ (r_j - r_i)                                                        paper eq. (12)
//! ```
//!
//! It is the identity where the sum over neighbors differentiates linear fields exactly; its eigenvalues fall towards
//! zero at free surfaces. A corrected gradient multiplies the raw sum by L_i⁻¹, or by what is put in its place:
//!
//! - the rule of the paper: the identity at surface particles, near them and where det L_i is small
//!   ([`SurfaceRule`], [`within_smoothing_length`], [`inverse_or_identity`]);
//! - the spectral cap K_i = Σ min(1/λ, c) n ⊗ n over the eigenpairs (λ, n) of L_i ([`spectral_cap`]), which needs no rule.
//!
//! These are plain versions for one particle. The pair loops of the scheme have vector versions of their own and are
//! tested against these. Valid for positive volumes and kernels that fall with distance: L is then symmetric and not
//! negative.
//!
//! Sources: Rublev & Murzov, arXiv 2410.14646; S. Marrone et al., J. Comput. Phys. 229 (2010) 3652 (surface by the least
//! eigenvalue); P. W. Randles & L. D. Libersky, Comput. Methods Appl. Mech. Eng. 139 (1996) 375 (correction).

use serde::{Deserialize, Serialize};

use crate::dimension::Dimension;
use crate::kernel::KernelFamily;
use crate::matrix::{Eigen, SquareMatrix};

/// Below this eigenvalue a particle is at a surface [-] (paper, after eq. (12)).
pub const SURFACE_EIGENVALUE: f64 = 0.75;

/// Widening of "within the smoothing length" [-]: on a square lattice at θ = 0.5 the next particle stands exactly at h,
/// and rounding would decide.
pub const SMOOTHING_LENGTH_MARGIN: f64 = 1.0001;

/// What particle i knows of its neighbor j.
#[derive(Clone, Copy, Debug)]
pub struct Neighbor<D: Dimension> {
    /// r_j - r_i [m].
    pub offset: D::Vector,
    /// V_j = m_j/ρ_j [m^d].
    pub volume: f64,
    /// ∇_iW_ij [1/m^(d+1)]; points towards j.
    pub kernel_gradient: D::Vector,
}

impl<D: Dimension> Neighbor<D> {
    /// A neighbor at `offset` [m] with volume `volume` [m^d], seen with the smoothing length h_ij [m].
    pub fn new(kernel: KernelFamily, offset: D::Vector, smoothing_length: f64, volume: f64) -> Self {
        Self { offset, volume, kernel_gradient: kernel.gradient::<D>(offset, smoothing_length) }
    }
}

/// L_i = Σ V_j ∇_iW_ij ⊗ (r_j - r_i) [-], paper eq. (12).
pub fn gradient_matrix<D: Dimension>(neighbors: impl IntoIterator<Item = Neighbor<D>>) -> SquareMatrix<D> {
    neighbors.into_iter().fold(SquareMatrix::zero(), |sum, n| {
        sum + SquareMatrix::outer(n.kernel_gradient * n.volume, n.offset)
    })
}

/// K = Σ min(1/λ, c) n ⊗ n over the eigenpairs of the symmetric part of L: the inverse, with no eigenvalue above
/// `largest` (c). Directions without neighbors (λ ≤ 0) get c.
pub fn spectral_cap<D: Dimension>(gradient_matrix: SquareMatrix<D>, largest: f64) -> SquareMatrix<D> {
    Eigen::of(gradient_matrix).map(|value| if value * largest > 1.0 { 1.0 / value } else { largest })
}

/// L⁻¹, or the identity at a surface and where det L < `determinant_floor` (the paper's ε, 0.01-0.1).
pub fn inverse_or_identity<D: Dimension>(
    gradient_matrix: SquareMatrix<D>,
    at_surface: bool,
    determinant_floor: f64,
) -> SquareMatrix<D> {
    if at_surface || gradient_matrix.determinant() < determinant_floor {
        return SquareMatrix::identity();
    }
    gradient_matrix.inverse(f64::EPSILON).unwrap_or(SquareMatrix::identity())
}

/// Which least eigenvalue marks a surface particle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum SurfaceRule {
    /// The least eigenvalue of L below 0.75. Marrone's matrix is this L, so this is what the paper must mean: it marks
    /// exactly one layer for θ ≤ 0.8.
    #[default]
    Intended,
    /// The least eigenvalue of L⁻¹ below 0.75, as printed. The eigenvalues of L⁻¹ *rise* at a surface, so this marks
    /// almost nothing.
    Printed,
}

impl SurfaceRule {
    /// True if a particle with this L is at a surface.
    pub fn marks<D: Dimension>(self, gradient_matrix: SquareMatrix<D>) -> bool {
        let eigen = Eigen::of(gradient_matrix);
        match self {
            Self::Intended => eigen.least() < SURFACE_EIGENVALUE,
            Self::Printed => eigen.values.as_ref().iter().any(|value| 1.0 / value < SURFACE_EIGENVALUE),
        }
    }
}

/// True if a particle at distance `r` [m] is within the smoothing length `h` [m]: near a surface particle the paper
/// takes the identity too.
pub fn within_smoothing_length(r: f64, h: f64) -> bool {
    r < SMOOTHING_LENGTH_MARGIN * h
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::{Dim2, Dim3};
    use glam::{DVec2, DVec3};

    /// L at the middle of a square lattice of unit size where `keep` holds, h = 2 θ.
    fn square_lattice(theta: f64, keep: impl Fn(i32, i32) -> bool) -> SquareMatrix<Dim2> {
        let points = (-6..=6).flat_map(|x| (-6..=6).map(move |y| (x, y))).filter(|&(x, y)| keep(x, y));
        gradient_matrix(points.map(|(x, y)| {
            Neighbor::new(KernelFamily::WendlandC2, DVec2::new(x as f64, y as f64), 2.0 * theta, 1.0)
        }))
    }

    fn cubic_lattice(theta: f64, keep: impl Fn(i32) -> bool) -> SquareMatrix<Dim3> {
        let cube = (-4..=4).flat_map(|x| (-4..=4).flat_map(move |y| (-4..=4).map(move |z| (x, y, z))));
        gradient_matrix(cube.filter(|&(x, _, _)| keep(x)).map(|(x, y, z)| {
            let offset = DVec3::new(x as f64, y as f64, z as f64);
            Neighbor::new(KernelFamily::WendlandC2, offset, 2.0 * theta, 1.0)
        }))
    }

    #[test]
    fn the_matrix_of_a_full_lattice_is_a_multiple_of_the_identity_near_one() {
        for theta in [0.5, 0.6, 0.7] {
            let l = square_lattice(theta, |_, _| true);
            assert!((l - SquareMatrix::identity() * l[(0, 0)]).largest() < 1e-15);
            assert!((l[(0, 0)] - 1.0).abs() < 0.1, "{theta}: {l:?}");
            let l = cubic_lattice(theta, |_| true);
            assert!((l[(0, 0)] - 1.0).abs() < 0.1, "{theta}: {l:?}");
        }
        // The wider the kernel, the nearer to one.
        let error = |theta: f64| (square_lattice(theta, |_, _| true)[(0, 0)] - 1.0).abs();
        assert!(error(1.4) < 5e-3, "{}", error(1.4));
    }

    #[test]
    fn the_intended_rule_marks_one_layer_and_the_printed_rule_none() {
        for theta in [0.5, 0.55, 0.6, 0.7, 0.8] {
            let layer = |depth: i32| square_lattice(theta, |x, _| x >= -depth);
            let least = |depth: i32| Eigen::of(layer(depth)).least();
            assert!((0.47..0.51).contains(&least(0)), "{theta}: {}", least(0));
            assert!(least(1) >= 0.766, "{theta}: {}", least(1));
            assert!(SurfaceRule::Intended.marks(layer(0)));
            assert!((1..4).all(|depth| !SurfaceRule::Intended.marks(layer(depth))));
            assert!((0..4).all(|depth| !SurfaceRule::Printed.marks(layer(depth))));
            let corner = Eigen::of(square_lattice(theta, |x, y| x >= 0 && y >= 0)).least();
            assert!((0.16..0.36).contains(&corner), "{theta}: {corner}");
        }
    }

    #[test]
    fn the_next_particle_of_a_square_lattice_is_within_the_smoothing_length() {
        assert!(within_smoothing_length(1.0 + 1e-15, 1.0));
        assert!(!within_smoothing_length(1.001, 1.0));
    }

    #[test]
    fn the_cap_is_the_inverse_inside_and_bounded_at_surfaces() {
        let inside = square_lattice(0.6, |x, y| 2 * x + y > -4);
        assert!((spectral_cap(inside, 2.5) * inside - SquareMatrix::identity()).largest() < 1e-14);
        // A film one particle thick has nothing across it.
        let film = square_lattice(0.6, |x, _| x == 0);
        let k = spectral_cap(film, 2.5);
        assert_eq!(k[(0, 0)], 2.5);
        assert!((k[(1, 1)] * film[(1, 1)] - 1.0).abs() < 1e-14);
        let alone = spectral_cap(SquareMatrix::<Dim3>::zero(), 2.5);
        assert!((alone - SquareMatrix::identity() * 2.5).largest() == 0.0);
        let half = cubic_lattice(0.6, |x| x >= 0);
        assert!(Eigen::of(spectral_cap(half, 1.5)).values[2] <= 1.5 + 1e-14);
    }

    #[test]
    fn the_rule_puts_the_identity_at_surfaces_and_where_the_determinant_is_small() {
        let full = square_lattice(0.6, |_, _| true);
        let inverse = inverse_or_identity(full, false, 0.05);
        assert!((inverse * full - SquareMatrix::identity()).largest() < 1e-14);
        let film = square_lattice(0.6, |x, _| x == 0);
        for l in [inverse_or_identity(full, true, 0.05), inverse_or_identity(film, false, 0.05)] {
            assert!((l - SquareMatrix::identity()).largest() == 0.0);
        }
    }

    #[test]
    fn the_matrix_is_symmetric_to_rounding() {
        let l = gradient_matrix((0..20).map(|k| {
            let offset = DVec3::new((k as f64).sin(), (2.1 * k as f64).cos(), (3.3 * k as f64).sin());
            Neighbor::<Dim3>::new(KernelFamily::Quintic, offset, 0.9, 0.1 + 0.01 * offset.length())
        }));
        assert!((l - l.transposed()).largest() < 1e-16);
    }
}
