//! What the scheme needs of a dimension beyond [`Dimension`]: sizes of records, algebra of symmetric matrices in the
//! space of motion, rotation.
//!
//! Symmetric matrices are stored as xx, yy, xy in the plane and xx, yy, zz, xy, yz, zx in space ([`symmetric`]). The
//! out-of-plane stress of plane strain is not among them: it does not act on the motion.

use sph_core::dimension::{Components, Dim2, Dim3, Dimension, Value};
use sph_core::lanes::{LANES, Part, Real};

use crate::pass::{Pass, Tile};
use crate::prepare::PrepareTile;
use crate::record::Sides;
use crate::update::UpdateTile;

/// Storage index of component (a, b) of a symmetric matrix in `count` dimensions.
#[inline(always)]
pub const fn symmetric(count: usize, a: usize, b: usize) -> usize {
    match (a == b, a + b) {
        (true, _) => a,
        (false, 1) => count,
        (false, 3) => count + 1,
        (false, _) => count + 2,
    }
}

/// Least eigenvalue of L that is told from zero: a particle without neighbors has none.
const LEAST: f64 = 1e-9;

/// A dimension that solids can be simulated in: [`Dim2`] (plane strain) and [`Dim3`].
pub trait SolidDimension: Dimension {
    /// Components of a symmetric matrix in the space of motion: 3 or 6.
    const STRESS_COUNT: usize;
    /// Components of an antisymmetric one: 1 or 3.
    const SPIN_COUNT: usize;
    /// Cache lines of a record of the first pass.
    const STATE_LINES: usize;
    /// Cache lines of a record of the second pass.
    const SIDES_LINES: usize;
    /// The same in a scheme without reconstruction, whose record ends with the fields.
    const CONSTANT_SIDES_LINES: usize = (Sides::correction::<Self>() - 1) / LANES + 1;
    /// Cache lines of a face record.
    const FACE_LINES: usize;
    /// A face record in registers.
    type FaceRecord<T: Value>: Components<T> + Value;
    /// Cache lines of a record that pairs add to.
    const SUM_LINES: usize;
    /// A record of the first pass in registers.
    type StateRecord<T: Value>: Components<T> + Value;
    /// A record of the second pass in registers.
    type SidesRecord<T: Value>: Components<T> + Value;
    /// A record that pairs add to, in registers.
    type SumsRecord<T: Value>: Components<T> + Value;
    /// A symmetric matrix.
    type Symmetric<T: Value>: Components<T> + Value;
    /// The dual of an antisymmetric matrix.
    type Spin<T: Value>: Components<T> + Value;
    /// The reconstructed fields: velocity components, then stress components.
    type Fields<T: Value>: Components<T> + Value;

    /// K = Σ min(1/λ, cap) n⊗n over the eigenpairs of a symmetric matrix, and its least eigenvalue λ.
    fn capped_inverse<L: Part>(matrix: Self::Symmetric<L>, cap: f64) -> (Self::Symmetric<L>, L);

    /// (tr L I - L)⁻¹ v: turns the dual of a raw antisymmetric sum into an angular velocity.
    fn spin_solve<L: Real>(matrix: Self::Symmetric<L>, dual: Self::Spin<L>) -> Self::Spin<L>;

    /// Runs a pass over one tile with the widest lanes of the machine. Not generic, so that the pair loops are compiled
    /// in this crate and not anew in each one that uses it.
    fn run(pass: &Pass<'_, Self>, tile: Tile<'_>);

    /// The same for the preparation of a tile.
    fn prepare(tile: PrepareTile<'_, Self>);

    /// The same for the update of a tile.
    fn update(tile: UpdateTile<'_, Self>);
}

/// Component (a, b) of the velocity gradient ∂U_b/∂x_a of a rigid turn: ε_bca Ω_c.
#[inline(always)]
pub fn spin_matrix<D: SolidDimension, L: Real>(spin: &D::Spin<L>, a: usize, b: usize) -> L {
    if a == b {
        return L::zero();
    }
    let sign = if (b + 3 - a) % 3 == 1 { 1.0 } else { -1.0 };
    let c = if D::SPIN_COUNT == 1 { 0 } else { 3 - a - b };
    if sign > 0.0 { spin[c] } else { -spin[c] }
}

/// Dual ε_eab R_ab of the antisymmetric part of a matrix: R_xy - R_yx in the plane.
#[inline(always)]
pub fn dual<D: SolidDimension, L: Real>(matrix: &D::Axes<D::Axes<L>>) -> D::Spin<L> {
    let mut spin = D::Spin::<L>::splat(L::zero());
    for e in 0..D::SPIN_COUNT {
        let (a, b) = if D::SPIN_COUNT == 1 { (0, 1) } else { ((e + 1) % 3, (e + 2) % 3) };
        spin[e] = matrix[a][b] - matrix[b][a];
    }
    spin
}

/// Product of a symmetric matrix and a vector.
#[inline(always)]
pub fn times<D: SolidDimension, L: Real>(matrix: &D::Symmetric<L>, vector: &D::Axes<L>) -> D::Axes<L> {
    let mut product = D::Axes::<L>::splat(L::zero());
    for a in 0..D::COUNT {
        let mut sum = matrix[symmetric(D::COUNT, a, 0)] * vector[0];
        for b in 1..D::COUNT {
            sum = matrix[symmetric(D::COUNT, a, b)].mul_add(vector[b], sum);
        }
        product[a] = sum;
    }
    product
}

/// Scalar product.
#[inline(always)]
pub fn dot<D: SolidDimension, L: Real>(u: &D::Axes<L>, v: &D::Axes<L>) -> L {
    let mut sum = u[0] * v[0];
    for a in 1..D::COUNT {
        sum = u[a].mul_add(v[a], sum);
    }
    sum
}

/// c × e, c the dual of an antisymmetric matrix: c (-e_y, e_x) in the plane.
#[inline(always)]
pub fn cross<D: SolidDimension, L: Real>(spin: &D::Spin<L>, e: &D::Axes<L>) -> D::Axes<L> {
    let mut product = D::Axes::<L>::splat(L::zero());
    for b in 0..D::COUNT {
        for a in 0..D::COUNT {
            // (c × e)_b = ε_bca c_c e_a, the velocity of a rigid turn.
            if a != b {
                product[b] = spin_matrix::<D, L>(spin, a, b).mul_add(e[a], product[b]);
            }
        }
    }
    product
}

impl SolidDimension for Dim2 {
    const STRESS_COUNT: usize = 3;
    const SPIN_COUNT: usize = 1;
    const STATE_LINES: usize = 1;
    const SIDES_LINES: usize = 3;
    const FACE_LINES: usize = 1;
    type FaceRecord<T: Value> = [T; 8];
    const SUM_LINES: usize = 1;
    type StateRecord<T: Value> = [T; 8];
    type SidesRecord<T: Value> = [T; 24];
    type SumsRecord<T: Value> = [T; 8];
    type Symmetric<T: Value> = [T; 3];
    type Spin<T: Value> = [T; 1];
    type Fields<T: Value> = [T; 5];

    /// With m the mean of the eigenvalues λ_1 ≥ λ_2 and f = min(1/λ, cap): K = ½(f_1 + f_2) I + s (L - m I), where
    /// s = (f_1 - f_2)/(λ_1 - λ_2), which is -f_1 f_2 as long as nothing is capped.
    #[inline(always)]
    fn capped_inverse<L: Part>(matrix: [L; 3], cap: f64) -> ([L; 3], L) {
        let [xx, yy, xy] = matrix;
        let half = L::splat(0.5);
        let (one, floor) = (L::one(), L::splat(LEAST));
        let mean = half * (xx + yy);
        let difference = half * (xx - yy);
        let radius = difference.mul_add(difference, xy * xy).sqrt();
        let (large, least) = (mean + radius, mean - radius);
        let cap = L::splat(cap);
        let f_large = (one / large.max(floor)).min(cap);
        let f_least = (one / least.max(floor)).min(cap);
        let plain = -(f_large * f_least);
        let capped = (f_large - f_least) / (radius + radius).max(floor);
        let slope = f_least.select_less(cap, plain, capped);
        let center = half * (f_large + f_least);
        ([slope.mul_add(difference, center), center - slope * difference, slope * xy], least)
    }

    #[inline(always)]
    fn spin_solve<L: Real>(matrix: [L; 3], dual: [L; 1]) -> [L; 1] {
        [dual[0] / (matrix[0] + matrix[1]).max(L::splat(LEAST))]
    }

    fn run(pass: &Pass<'_, Self>, tile: Tile<'_>) {
        pass.dispatch(tile);
    }

    fn prepare(tile: PrepareTile<'_, Self>) {
        tile.dispatch();
    }

    fn update(tile: UpdateTile<'_, Self>) {
        tile.dispatch();
    }
}

impl SolidDimension for Dim3 {
    const STRESS_COUNT: usize = 6;
    const SPIN_COUNT: usize = 3;
    const STATE_LINES: usize = 2;
    const SIDES_LINES: usize = 7;
    const FACE_LINES: usize = 2;
    type FaceRecord<T: Value> = [T; 16];
    const SUM_LINES: usize = 2;
    type StateRecord<T: Value> = [T; 16];
    type SidesRecord<T: Value> = [T; 56];
    type SumsRecord<T: Value> = [T; 16];
    type Symmetric<T: Value> = [T; 6];
    type Spin<T: Value> = [T; 3];
    type Fields<T: Value> = [T; 9];

    /// Cofactors where nothing is capped; eigenpairs, one lane after the other, where something is.
    #[inline(always)]
    fn capped_inverse<L: Part>(matrix: [L; 6], cap: f64) -> ([L; 6], L) {
        let lanes = matrix.map(|component| component.to_array());
        let mut inverse = [[0.0; LANES]; 6];
        let mut least = [0.0; LANES];
        for l in L::FIRST..L::FIRST + L::COUNT {
            let (k, smallest) = capped_inverse_3(lanes.map(|component| component[l]), cap);
            (0..6).for_each(|c| inverse[c][l] = k[c]);
            least[l] = smallest;
        }
        (inverse.map(|component| L::load(&component)), L::load(&least))
    }

    #[inline(always)]
    fn spin_solve<L: Real>(matrix: [L; 6], dual: [L; 3]) -> [L; 3] {
        let [xx, yy, zz, xy, yz, zx] = matrix;
        // M = tr L I - L, its inverse by cofactors.
        let m = [yy + zz, xx + zz, xx + yy, -xy, -yz, -zx];
        let (inverse, _) = cofactor_inverse(m, L::splat(LEAST));
        times::<Dim3, L>(&inverse, &dual)
    }

    fn run(pass: &Pass<'_, Self>, tile: Tile<'_>) {
        pass.dispatch(tile);
    }

    fn prepare(tile: PrepareTile<'_, Self>) {
        tile.dispatch();
    }

    fn update(tile: UpdateTile<'_, Self>) {
        tile.dispatch();
    }
}

/// Inverse of a symmetric 3 × 3 matrix by cofactors and its determinant, the latter not below `floor`.
#[inline(always)]
fn cofactor_inverse<L: Real>([xx, yy, zz, xy, yz, zx]: [L; 6], floor: L) -> ([L; 6], L) {
    let cofactors = [
        yy * zz - yz * yz,
        xx * zz - zx * zx,
        xx * yy - xy * xy,
        zx * yz - xy * zz,
        xy * zx - xx * yz,
        xy * yz - yy * zx,
    ];
    let determinant = xx * cofactors[0] + xy * cofactors[3] + zx * cofactors[5];
    let scale = L::one() / determinant.max(floor);
    let [a, b, c, d, e, f] = cofactors;
    ([a * scale, b * scale, c * scale, d * scale, e * scale, f * scale], determinant)
}

/// Σ min(1/λ, cap) n⊗n of one symmetric 3 × 3 matrix, and its least eigenvalue (or 1/cap and more, if that is all that
/// is known).
fn capped_inverse_3(m: [f64; 6], cap: f64) -> ([f64; 6], f64) {
    let [xx, yy, zz, xy, yz, zx] = m;
    // Nothing is capped if L - max(1/cap, 3/4) I is positive definite: its leading minors tell. 3/4 is where a surface is seen.
    let bound = (1.0 / cap).max(0.75);
    let (a, b, c) = (xx - bound, yy - bound, zz - bound);
    let (_, determinant) = cofactor_inverse([a, b, c, xy, yz, zx], LEAST);
    if a > 0.0 && a * b - xy * xy > 0.0 && determinant > 0.0 {
        return (cofactor_inverse(m, LEAST).0, bound);
    }
    let eigen = nalgebra::Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz).symmetric_eigen();
    let mut inverse = nalgebra::Matrix3::zeros();
    for k in 0..3 {
        let n = eigen.eigenvectors.column(k);
        inverse += n * n.transpose() * (1.0 / eigen.eigenvalues[k].max(LEAST)).min(cap);
    }
    let i = inverse;
    ([i.m11, i.m22, i.m33, i.m12, i.m23, i.m13], eigen.eigenvalues.min())
}
