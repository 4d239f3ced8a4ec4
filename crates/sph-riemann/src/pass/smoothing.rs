//! Kernel and smoothing lengths as pair loops need them.

use std::hint::black_box;

use sph_core::kernel::{KernelFamily, SmoothingKernel, WendlandC2};
use sph_core::lanes::{LANES, Lanes};

/// Sizes D of the particles that records show [m].
#[derive(Clone, Copy, Debug)]
pub enum Sizes<'a> {
    /// All have this one.
    Uniform(f64),
    /// One for each record.
    Each(&'a [f64]),
}

impl Sizes<'_> {
    /// Size of the particle of a record [m].
    pub fn of(&self, record: usize) -> f64 {
        match self {
            Self::Uniform(size) => *size,
            Self::Each(sizes) => sizes[record],
        }
    }
}

/// Kernel, θ and particle sizes. Where all particles have one size, h is one number and the sizes are not read.
#[derive(Clone, Copy, Debug)]
pub struct Smoothing<'a> {
    kernel: KernelFamily,
    /// True for Wendland C2. The compiler must not know that it is: pair loops then have a branch for it, and not a jump
    /// through a table, which costs more.
    is_default: bool,
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
    /// Smoothing for records of the given sizes in `count` dimensions.
    pub fn new(kernel: KernelFamily, theta: f64, count: usize, sizes: Sizes<'a>) -> Self {
        let normalization = kernel.normalization(count);
        let power = count as i32 + 2;
        let scales = |size: f64| {
            let inverse_h = 1.0 / (2.0 * theta * size);
            Scales { inverse_h, slope: normalization * inverse_h.powi(power) }
        };
        let (uniform, size): (_, &[f64]) = match sizes {
            Sizes::Uniform(size) => (Some(scales(size)), &[]),
            Sizes::Each(sizes) => (None, sizes),
        };
        let is_default = black_box(kernel == KernelFamily::WendlandC2);
        Self { kernel, is_default, theta, normalization, power, uniform, size }
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
        if self.is_default { WendlandC2::minus_slope_over_q(q) } else { self.kernel.minus_slope_over_q(q) }
    }
}
