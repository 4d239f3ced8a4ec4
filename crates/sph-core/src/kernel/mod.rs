//! Smoothing kernels W(r, h): a bell of unit integral, zero beyond a few smoothing lengths.
//!
//! With q = r/h and d dimensions
//!
//! ```text
//! W(r, h)   = normalization(d) h^-d value(q)
//! ∇_i W_ij  = -(W'_ij / h) e_R = normalization(d) h^-(d + 2) minus_slope_over_q(q) (r_j - r_i)
//! ```
//!
//! where e_R = (r_j - r_i)/r_ij points from i to j and W' = dW/dq < 0. The gradient is taken with respect to r_i, as in
//! the paper, and points towards the neighbor.
//!
//! The formulas are written once for numbers and for lanes of a register ([`Real`]): no branches, so that a pair beyond
//! the support adds an exact zero, and no division by q, so that a particle paired with itself adds no NaN.
//!
//! **A new kernel** is one file here with a type that implements [`SmoothingKernel`], one variant of [`KernelFamily`]
//! and one arm in the macro below; the tests run over [`KernelFamily::ALL`].
//!
//! [`packing`] is none of these: the kernel of volume sums.
//!
//! Source of the paper's choice: Rublev & Murzov, arXiv 2410.14646, section 2 (Wendland C2).

pub mod cubic_spline;
pub mod packing;
pub mod quintic;
pub mod wendland_c2;
pub mod wendland_c4;

pub use cubic_spline::CubicSpline;
pub use quintic::Quintic;
pub use wendland_c2::WendlandC2;
pub use wendland_c4::WendlandC4;

use serde::{Deserialize, Serialize};

use crate::dimension::{Dimension, Vector};
use crate::lanes::Real;

/// The shape w(q) of a smoothing kernel, q = r/h.
pub trait SmoothingKernel {
    /// Radius of the support in smoothing lengths: w(q) = 0 for q ≥ `SUPPORT`.
    const SUPPORT: f64;
    /// w(q), not normalized [-]. Exactly zero beyond the support.
    fn value<R: Real>(q: R) -> R;
    /// -(dw/dq)/q ≥ 0 [-]. Finite at q = 0, exactly zero beyond the support.
    fn minus_slope_over_q<R: Real>(q: R) -> R;
    /// Factor that makes the integral of w(r/h) h^-d over space equal to one [-].
    ///
    /// # Panics
    /// Unless `dimension_count` is 2 or 3.
    fn normalization(dimension_count: usize) -> f64;
}

/// The kernels at hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum KernelFamily {
    /// Wendland C2, support 2 h: the paper's.
    #[default]
    WendlandC2,
    /// Wendland C4, support 2 h.
    WendlandC4,
    /// M4 cubic spline, support 2 h.
    CubicSpline,
    /// M6 quintic spline, support 3 h.
    Quintic,
}

/// Runs an expression with `K` standing for the type of the kernel.
macro_rules! with_kernel {
    ($family:expr, $K:ident => $body:expr) => {
        match $family {
            KernelFamily::WendlandC2 => {
                type $K = WendlandC2;
                $body
            }
            KernelFamily::WendlandC4 => {
                type $K = WendlandC4;
                $body
            }
            KernelFamily::CubicSpline => {
                type $K = CubicSpline;
                $body
            }
            KernelFamily::Quintic => {
                type $K = Quintic;
                $body
            }
        }
    };
}

impl KernelFamily {
    /// Every kernel, in the order of declaration.
    pub const ALL: [Self; 4] = [Self::WendlandC2, Self::WendlandC4, Self::CubicSpline, Self::Quintic];

    /// Radius of the support in smoothing lengths [-].
    pub fn support(self) -> f64 {
        with_kernel!(self, K => K::SUPPORT)
    }

    /// w(q), not normalized [-].
    #[inline(always)]
    pub fn value<R: Real>(self, q: R) -> R {
        with_kernel!(self, K => K::value(q))
    }

    /// -(dw/dq)/q ≥ 0, not normalized [-].
    #[inline(always)]
    pub fn minus_slope_over_q<R: Real>(self, q: R) -> R {
        with_kernel!(self, K => K::minus_slope_over_q(q))
    }

    /// Factor that makes the integral of w(r/h) h^-d over space equal to one [-].
    ///
    /// # Panics
    /// Unless `dimension_count` is 2 or 3.
    pub fn normalization(self, dimension_count: usize) -> f64 {
        with_kernel!(self, K => K::normalization(dimension_count))
    }

    /// W(r, h) [1/m^d] at distance `r` [m] for the smoothing length `h` [m].
    pub fn weight<D: Dimension>(self, r: f64, h: f64) -> f64 {
        self.normalization(D::COUNT) * h.powi(-(D::COUNT as i32)) * self.value(r / h)
    }

    /// ∇_i W(|r_ji|, h) [1/m^(d+1)] for the vector `r_ji` = r_j - r_i from i to j [m].
    pub fn gradient<D: Dimension>(self, r_ji: D::Vector, h: f64) -> D::Vector {
        let scale = self.normalization(D::COUNT) * h.powi(-(D::COUNT as i32) - 2);
        r_ji * (scale * self.minus_slope_over_q(r_ji.length() / h))
    }
}

/// What [`SmoothingKernel::normalization`] says of other numbers of dimensions.
#[cold]
fn no_such_dimension(dimension_count: usize) -> ! {
    panic!("kernels are normalized in 2 and 3 dimensions, not in {dimension_count}")
}

#[cfg(test)]
mod tests;
