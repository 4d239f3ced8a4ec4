//! Kernel and smoothing lengths as pair loops need them.

use sph_core::kernel::KernelFamily;
use sph_core::lanes::{LANES, Lanes};

/// Kernel, θ and particle sizes. Where all particles have one size, h is one number and the sizes are not read.
#[derive(Clone, Copy, Debug)]
pub struct Smoothing<'a> {
    kernel: KernelFamily,
    theta: f64,
    normalization: f64,
    power: i32,
    uniform: Option<Scales<f64>>,
    size: &'a [f64],
}

/// 1/h [1/m] and the factor of (r_j - r_i) in ∇W, without the kernel's shape [1/m^(d+2)].
#[derive(Clone, Copy, Debug)]
pub struct Scales<T> {
    /// 1/h [1/m].
    pub inverse_h: T,
    /// Normalization over h^(d+2) [1/m^(d+2)].
    pub slope: T,
}

impl<'a> Smoothing<'a> {
    /// Smoothing for records of the given sizes [m] in `count` dimensions.
    pub fn new(kernel: KernelFamily, theta: f64, count: usize, size: &'a [f64]) -> Self {
        let normalization = kernel.normalization(count);
        let power = count as i32 + 2;
        let first = size.first().copied().unwrap_or(1.0);
        let uniform = size.iter().all(|&s| s == first).then(|| {
            let inverse_h = 1.0 / (2.0 * theta * first);
            Scales { inverse_h, slope: normalization * inverse_h.powi(power) }
        });
        Self { kernel, theta, normalization, power, uniform, size }
    }

    /// Radius of the support in smoothing lengths.
    pub fn support(&self) -> f64 {
        self.kernel.support()
    }

    /// Sizes of eight particles, where they are needed.
    #[inline(always)]
    pub(super) fn own<L: Lanes>(&self, indices: &[u32; LANES]) -> L {
        if self.uniform.is_some() { L::zero() } else { L::gather(self.size, indices) }
    }

    /// Scales of eight pairs.
    #[inline(always)]
    pub(super) fn scales<L: Lanes>(&self, own: L, indices: &[u32; LANES]) -> Scales<L> {
        if let Some(scales) = self.uniform {
            return Scales { inverse_h: L::splat(scales.inverse_h), slope: L::splat(scales.slope) };
        }
        let h = L::splat(self.theta) * (own + L::gather(self.size, indices));
        let inverse_h = L::one() / h;
        let mut slope = L::splat(self.normalization);
        for _ in 0..self.power {
            slope = slope * inverse_h;
        }
        Scales { inverse_h, slope }
    }

    /// -(dw/dq)/q.
    #[inline(always)]
    pub(super) fn minus_slope_over_q<L: Lanes>(&self, q: L) -> L {
        self.kernel.minus_slope_over_q(q)
    }
}
