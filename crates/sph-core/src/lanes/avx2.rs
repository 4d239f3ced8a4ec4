//! Eight lanes in two AVX2 registers.
//!
//! Invariant of every `unsafe` block here: an [`Avx2`] exists only inside [`super::dispatch_with`], which has checked
//! that the machine has AVX2 and fused multiply-add.

use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use super::{LANES, Lanes, Line, PLACES, Real};

/// Eight numbers in two registers.
#[derive(Clone, Copy, Debug)]
pub struct Avx2(__m256d, __m256d);

macro_rules! operator {
    ($trait:ident, $method:ident, $intrinsic:ident) => {
        impl $trait for Avx2 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the invariant of this module.
                unsafe { Self($intrinsic(self.0, other.0), $intrinsic(self.1, other.1)) }
            }
        }
    };
}
operator!(Add, add, _mm256_add_pd);
operator!(Sub, sub, _mm256_sub_pd);
operator!(Mul, mul, _mm256_mul_pd);
operator!(Div, div, _mm256_div_pd);

impl Neg for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: the invariant of this module.
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            Self(_mm256_xor_pd(self.0, sign), _mm256_xor_pd(self.1, sign))
        }
    }
}

impl AddAssign for Avx2 {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Real for Avx2 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: the invariant of this module.
        unsafe { Self(_mm256_set1_pd(value), _mm256_set1_pd(value)) }
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        // SAFETY: the invariant of this module.
        unsafe { Self(_mm256_fmadd_pd(self.0, b.0, c.0), _mm256_fmadd_pd(self.1, b.1, c.1)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the invariant of this module.
        unsafe { Self(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: the invariant of this module.
        unsafe { Self(_mm256_max_pd(self.0, other.0), _mm256_max_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: the invariant of this module.
        unsafe { Self(_mm256_min_pd(self.0, other.0), _mm256_min_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: the invariant of this module.
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            Self(_mm256_andnot_pd(sign, self.0), _mm256_andnot_pd(sign, self.1))
        }
    }
    #[inline(always)]
    fn select_less(self, limit: Self, yes: Self, no: Self) -> Self {
        // SAFETY: the invariant of this module.
        unsafe {
            Self(
                _mm256_blendv_pd(no.0, yes.0, _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, limit.0)),
                _mm256_blendv_pd(no.1, yes.1, _mm256_cmp_pd::<_CMP_LT_OQ>(self.1, limit.1)),
            )
        }
    }
}

impl Lanes for Avx2 {
    #[inline(always)]
    fn load(source: &[f64; LANES]) -> Self {
        // SAFETY: the invariant of this module; the source has eight numbers.
        unsafe { Self(_mm256_loadu_pd(source.as_ptr()), _mm256_loadu_pd(source.as_ptr().add(4))) }
    }
    #[inline(always)]
    fn store(self, target: &mut [f64; LANES]) {
        // SAFETY: the invariant of this module; the target has eight numbers.
        unsafe {
            _mm256_storeu_pd(target.as_mut_ptr(), self.0);
            _mm256_storeu_pd(target.as_mut_ptr().add(4), self.1);
        }
    }
    #[inline(always)]
    unsafe fn load_records(
        lines: &[Line],
        stride: usize,
        line: usize,
        indices: &[u32; LANES],
    ) -> [Self; LANES] {
        // SAFETY: the invariant of this module; the caller promises that the records exist.
        unsafe {
            let mut rows = [Self(_mm256_setzero_pd(), _mm256_setzero_pd()); LANES];
            for l in 0..LANES {
                let at = indices[l] as usize * stride + line;
                debug_assert!(at < lines.len());
                let row = lines.as_ptr().add(at).cast::<f64>();
                rows[l] = Self(_mm256_load_pd(row), _mm256_load_pd(row.add(4)));
            }
            Self::transpose(rows)
        }
    }
    #[inline(always)]
    fn transpose(block: [Self; LANES]) -> [Self; LANES] {
        // SAFETY: the invariant of this module.
        unsafe {
            let r = block;
            let a = transpose([r[0].0, r[1].0, r[2].0, r[3].0]);
            let b = transpose([r[4].0, r[5].0, r[6].0, r[7].0]);
            let c = transpose([r[0].1, r[1].1, r[2].1, r[3].1]);
            let d = transpose([r[4].1, r[5].1, r[6].1, r[7].1]);
            [
                Self(a[0], b[0]),
                Self(a[1], b[1]),
                Self(a[2], b[2]),
                Self(a[3], b[3]),
                Self(c[0], d[0]),
                Self(c[1], d[1]),
                Self(c[2], d[2]),
                Self(c[3], d[3]),
            ]
        }
    }
    #[inline(always)]
    fn sums_and_maximum(self, other: Self) -> Self {
        // SAFETY: the invariant of this module.
        unsafe {
            let (sum, larger) = (_mm256_add_pd(self.1, other.1), _mm256_max_pd(self.1, other.1));
            Self(_mm256_add_pd(self.0, other.0), _mm256_blend_pd::<0b1000>(sum, larger))
        }
    }
    #[inline(always)]
    fn less_mask(self, limit: Self) -> u8 {
        // SAFETY: the invariant of this module.
        unsafe {
            let low = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, limit.0));
            let high = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.1, limit.1));
            (low | high << 4) as u8
        }
    }
    #[inline(always)]
    fn pack(numbers: &[u32; LANES], mask: u8) -> [u32; LANES] {
        let mut packed = [0; LANES];
        // SAFETY: the invariant of this module; all arrays have eight numbers.
        unsafe {
            let numbers = _mm256_loadu_si256(numbers.as_ptr().cast());
            let places = _mm256_cvtepu8_epi32(_mm_loadl_epi64(PLACES[mask as usize].as_ptr().cast()));
            _mm256_storeu_si256(packed.as_mut_ptr().cast(), _mm256_permutevar8x32_epi32(numbers, places));
        }
        packed
    }
}

/// Rows to columns of a 4 × 4 block.
#[inline(always)]
unsafe fn transpose(r: [__m256d; 4]) -> [__m256d; 4] {
    // SAFETY: the invariant of this module.
    unsafe {
        let (e0, o0) = (_mm256_unpacklo_pd(r[0], r[1]), _mm256_unpackhi_pd(r[0], r[1]));
        let (e1, o1) = (_mm256_unpacklo_pd(r[2], r[3]), _mm256_unpackhi_pd(r[2], r[3]));
        [
            _mm256_permute2f128_pd::<0x20>(e0, e1),
            _mm256_permute2f128_pd::<0x20>(o0, o1),
            _mm256_permute2f128_pd::<0x31>(e0, e1),
            _mm256_permute2f128_pd::<0x31>(o0, o1),
        ]
    }
}
