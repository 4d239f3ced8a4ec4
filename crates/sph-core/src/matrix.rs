//! Small square matrices, as many rows as there are space dimensions: what the plain formulas of
//! [`correction`](crate::correction) and [`gradient`](crate::gradient) are written in.

use std::ops::{Add, Index, Mul, Sub};

use crate::dimension::{Components, Dimension};

/// A square matrix; element (row, column).
#[derive(Clone, Copy, Debug)]
pub struct SquareMatrix<D: Dimension> {
    rows: D::Axes<D::Axes<f64>>,
}

impl<D: Dimension> SquareMatrix<D> {
    /// Matrix from a function of row and column.
    #[inline]
    pub fn from_fn(mut element: impl FnMut(usize, usize) -> f64) -> Self {
        Self { rows: Components::from_fn(|r| Components::from_fn(|c| element(r, c))) }
    }

    /// All elements zero.
    pub fn zero() -> Self {
        Self::from_fn(|_, _| 0.0)
    }

    /// Ones on the diagonal.
    pub fn identity() -> Self {
        Self::from_fn(|r, c| if r == c { 1.0 } else { 0.0 })
    }

    /// a ⊗ b: element (r, c) is a_r b_c.
    pub fn outer(a: D::Vector, b: D::Vector) -> Self {
        Self::from_fn(|r, c| a[r] * b[c])
    }

    /// Rows and columns exchanged.
    pub fn transposed(self) -> Self {
        Self::from_fn(|r, c| self[(c, r)])
    }

    /// ½ (M + Mᵀ).
    pub fn symmetric_part(self) -> Self {
        Self::from_fn(|r, c| 0.5 * (self[(r, c)] + self[(c, r)]))
    }

    /// Sum of the diagonal.
    pub fn trace(self) -> f64 {
        (0..D::COUNT).map(|a| self[(a, a)]).sum()
    }

    /// The matrix times a vector.
    pub fn apply(self, v: D::Vector) -> D::Vector {
        D::vector(|r| (0..D::COUNT).map(|c| self[(r, c)] * v[c]).sum())
    }

    /// Largest absolute element: the scale of the matrix.
    pub fn largest(self) -> f64 {
        let rows = self.rows.as_ref().iter();
        rows.flat_map(|row| row.as_ref())
            .fold(0.0, |m: f64, x| if x.is_nan() { f64::NAN } else { m.max(x.abs()) })
    }

    /// Determinant.
    pub fn determinant(self) -> f64 {
        if D::COUNT == 2 {
            return self[(0, 0)] * self[(1, 1)] - self[(0, 1)] * self[(1, 0)];
        }
        (0..3).map(|c| self[(0, c)] * self.cofactor(0, c)).sum()
    }

    /// The inverse; `None` where |det| is not above `floor` × scale^d, d the number of dimensions: then the matrix is
    /// singular for the purpose, whatever the size of its elements.
    pub fn inverse(self, floor: f64) -> Option<Self> {
        let scale = self.largest();
        let determinant = self.determinant();
        // A scale of zero or NaN fails this too.
        let regular = determinant.abs() > floor * scale.powi(D::COUNT as i32);
        regular.then(|| Self::from_fn(|r, c| self.cofactor(c, r) / determinant))
    }

    /// Signed minor of element (row, column).
    fn cofactor(self, r: usize, c: usize) -> f64 {
        if D::COUNT == 2 {
            let sign = if r == c { 1.0 } else { -1.0 };
            return sign * self[(1 - r, 1 - c)];
        }
        // Going round in cycles has the right sign built in.
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        self[(r1, c1)] * self[(r2, c2)] - self[(r1, c2)] * self[(r2, c1)]
    }
}

impl<D: Dimension> Index<(usize, usize)> for SquareMatrix<D> {
    type Output = f64;
    #[inline]
    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        &self.rows[row][column]
    }
}

impl<D: Dimension> Add for SquareMatrix<D> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::from_fn(|r, c| self[(r, c)] + other[(r, c)])
    }
}

impl<D: Dimension> Sub for SquareMatrix<D> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::from_fn(|r, c| self[(r, c)] - other[(r, c)])
    }
}

impl<D: Dimension> Mul<f64> for SquareMatrix<D> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self::from_fn(|r, c| self[(r, c)] * factor)
    }
}

impl<D: Dimension> Mul for SquareMatrix<D> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::from_fn(|r, c| (0..D::COUNT).map(|k| self[(r, k)] * other[(k, c)]).sum())
    }
}

/// Eigenvalues and eigenvectors of a symmetric matrix.
#[derive(Clone, Copy, Debug)]
pub struct Eigen<D: Dimension> {
    /// Eigenvalues, ascending.
    pub values: D::Axes<f64>,
    /// Unit eigenvectors, in the order of the values.
    pub vectors: D::Axes<D::Axes<f64>>,
}

impl<D: Dimension> Eigen<D> {
    /// Of the symmetric part of a matrix.
    pub fn of(matrix: SquareMatrix<D>) -> Self {
        let symmetric = matrix.symmetric_part();
        let pairs = if D::COUNT == 2 { eigen_plane(symmetric) } else { eigen_space(symmetric) };
        Self {
            values: Components::from_fn(|k| pairs[k].0),
            vectors: Components::from_fn(|k| Components::from_fn(|a| pairs[k].1[a])),
        }
    }

    /// Least eigenvalue.
    pub fn least(&self) -> f64 {
        self.values[0]
    }

    /// Σ f(λ) n ⊗ n over the eigenpairs: the function `f` of the matrix.
    pub fn map(&self, f: impl Fn(f64) -> f64) -> SquareMatrix<D> {
        let term = |k: usize| {
            let n = &self.vectors[k];
            let factor = f(self.values[k]);
            SquareMatrix::from_fn(|r, c| factor * n[r] * n[c])
        };
        (1..D::COUNT).fold(term(0), |sum, k| sum + term(k))
    }
}

/// Value and unit vector.
type Pair = (f64, [f64; 3]);

/// By hand: mean ± radius of Mohr's circle; the vector is taken from the column that does not cancel.
fn eigen_plane<D: Dimension>(m: SquareMatrix<D>) -> [Pair; 3] {
    let (mean, half) = (0.5 * (m[(0, 0)] + m[(1, 1)]), 0.5 * (m[(0, 0)] - m[(1, 1)]));
    let shear = m[(0, 1)];
    let radius = half.hypot(shear);
    let (x, y) = if half >= 0.0 { (half + radius, shear) } else { (shear, radius - half) };
    let length = x.hypot(y);
    let (x, y) = if length > 0.0 { (x / length, y / length) } else { (1.0, 0.0) };
    [(mean - radius, [-y, x, 0.0]), (mean + radius, [x, y, 0.0]), (f64::NAN, [0.0; 3])]
}

/// By nalgebra's symmetric QR, sorted.
fn eigen_space<D: Dimension>(m: SquareMatrix<D>) -> [Pair; 3] {
    let eigen = nalgebra::Matrix3::from_fn(|r, c| m[(r, c)]).symmetric_eigen();
    let pair = |k: usize| (eigen.eigenvalues[k], std::array::from_fn(|a| eigen.eigenvectors[(a, k)]));
    let mut pairs: [Pair; 3] = std::array::from_fn(pair);
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::{Dim2, Dim3};

    fn sample<D: Dimension>(seed: usize) -> SquareMatrix<D> {
        SquareMatrix::from_fn(|r, c| ((seed * 7 + r * 5 + c * 3 + 1) as f64 * 1.37).sin())
    }

    fn eigenpairs_rebuild_the_matrix<D: Dimension>() {
        for seed in 0..50 {
            let m = sample::<D>(seed).symmetric_part();
            let eigen = Eigen::of(m);
            assert!((eigen.map(|x| x) - m).largest() < 1e-14);
            assert!((eigen.map(|_| 1.0) - SquareMatrix::identity()).largest() < 1e-14);
            assert!((1..D::COUNT).all(|k| eigen.values[k - 1] <= eigen.values[k]));
        }
        for m in [SquareMatrix::<D>::zero(), SquareMatrix::identity() * 3.0] {
            assert!((Eigen::of(m).map(|x| x) - m).largest() == 0.0);
        }
    }

    #[test]
    fn eigenpairs_rebuild_the_matrix_in_both_dimensions() {
        eigenpairs_rebuild_the_matrix::<Dim2>();
        eigenpairs_rebuild_the_matrix::<Dim3>();
    }

    fn inverse_times_matrix_is_the_identity<D: Dimension>() {
        for seed in 0..50 {
            for scale in [1e-30, 1.0, 1e30] {
                let m = sample::<D>(seed) * scale;
                let Some(inverse) = m.inverse(1e-3) else { continue };
                assert!((inverse * m - SquareMatrix::identity()).largest() < 1e-11);
            }
        }
    }

    #[test]
    fn inverse_times_matrix_is_the_identity_in_both_dimensions() {
        inverse_times_matrix_is_the_identity::<Dim2>();
        inverse_times_matrix_is_the_identity::<Dim3>();
    }

    #[test]
    fn a_matrix_is_singular_relative_to_its_own_scale() {
        let thin = |s: f64| SquareMatrix::<Dim2>::from_fn(|r, c| [[1.0, 0.0], [0.0, 1e-3]][r][c] * s);
        for scale in [1e-200, 1.0, 1e100] {
            assert!(thin(scale).inverse(0.01).is_none());
        }
        assert!(thin(1e20).inverse(1e-4).is_some());
        assert!(SquareMatrix::<Dim3>::zero().inverse(0.0).is_none());
        assert!((SquareMatrix::<Dim3>::identity() * f64::NAN).inverse(0.0).is_none());
    }

    #[test]
    fn the_determinant_of_a_product_is_the_product_of_the_determinants() {
        let (a, b) = (sample::<Dim3>(1), sample::<Dim3>(2));
        assert!(((a * b).determinant() - a.determinant() * b.determinant()).abs() < 1e-14);
    }
}
