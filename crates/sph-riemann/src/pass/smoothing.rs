//! Kernel and smoothing lengths as pair loops need them.

use std::hint::black_box;

use sph_core::kernel::{KernelFamily, SmoothingKernel, WendlandC2};
use sph_core::lanes::{LANES, Part};

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
    /// Reach of the kernel where all have one size [m], else over the sum of two sizes [-]; a few roundings longer.
    reach: f64,
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
        let reach = kernel.support() * theta * (1.0 + 8.0 * f64::EPSILON);
        let (uniform, reach, size): (_, _, &[f64]) = match sizes {
            Sizes::Uniform(size) => (Some(scales(size)), 2.0 * reach * size, &[]),
            Sizes::Each(sizes) => (None, reach, sizes),
        };
        let is_default = black_box(kernel == KernelFamily::WendlandC2);
        Self { kernel, is_default, theta, normalization, power, uniform, reach, size }
    }

    /// Radius of the support in smoothing lengths.
    pub fn support(&self) -> f64 {
        self.kernel.support()
    }

    /// Squared distance beyond which pairs are out of reach of the kernel [m²]: told without a root. Pairs at the very edge
    /// may lie within it, and have a slope of zero.
    #[inline(always)]
    pub(super) fn reach_squared<L: Part>(&self, own: L, indices: &[u32; LANES]) -> L {
        let reach = if self.uniform.is_some() {
            L::splat(self.reach)
        } else {
            L::splat(self.reach) * (own + L::gather(self.size, indices))
        };
        reach * reach
    }

    /// Sizes of eight particles, where they are needed.
    #[inline(always)]
    pub(super) fn own<L: Part>(&self, indices: &[u32; LANES]) -> L {
        if self.uniform.is_some() { L::zero() } else { L::gather(self.size, indices) }
    }

    /// Scales of eight pairs.
    #[inline(always)]
    pub(super) fn scales<L: Part>(&self, own: L, indices: &[u32; LANES]) -> Scales<L> {
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
    pub(super) fn minus_slope_over_q<L: Part>(&self, q: L) -> L {
        if self.is_default { WendlandC2::minus_slope_over_q(q) } else { self.kernel.minus_slope_over_q(q) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph_core::lanes::{LaneKernel, Lanes, dispatch};

    /// Pairs whose distances q are within a few roundings of the edge of the support.
    struct AtTheEdge<'a>(Smoothing<'a>, &'a mut Vec<(f64, bool)>);

    impl LaneKernel for AtTheEdge<'_> {
        #[inline(always)]
        fn run<L: Lanes>(self) {
            let (smoothing, indices) = (self.0, [0, 1, 2, 3, 4, 5, 6, 7]);
            let own = smoothing.own::<L>(&indices);
            let scales = smoothing.scales(own, &indices);
            for ulp in -40..=40 {
                let edge = L::splat(smoothing.support() * (1.0 + f64::from(ulp) * f64::EPSILON));
                let dx = edge / scales.inverse_h;
                let squared = dx * dx;
                let q = squared.sqrt() * scales.inverse_h;
                let within = squared.less_mask(smoothing.reach_squared(own, &indices));
                for (l, q) in q.to_array().into_iter().enumerate() {
                    self.1.push((q, within >> l & 1 == 1));
                }
            }
        }
    }

    #[test]
    fn no_pair_within_the_support_is_out_of_reach() {
        let sizes: Vec<f64> = (0..8).map(|k| 1e-6 * (1.0 + 0.37 * f64::from(k))).collect();
        for sizes in [Sizes::Uniform(3.3e-7), Sizes::Each(&sizes)] {
            for kernel in [KernelFamily::WendlandC2, KernelFamily::CubicSpline] {
                for theta in [0.5, 0.55, 0.6, 0.7] {
                    let mut seen = Vec::new();
                    dispatch(AtTheEdge(Smoothing::new(kernel, theta, 2, sizes), &mut seen));
                    assert!(
                        seen.iter().all(|&(q, within)| within || q >= kernel.support()),
                        "{theta} {seen:?}"
                    );
                    assert!(seen.iter().any(|&(_, within)| !within), "only the very edge counts as within");
                    assert!(seen.iter().any(|&(q, _)| q < kernel.support()));
                }
            }
        }
    }
}
