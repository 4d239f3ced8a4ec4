//! Eight lanes in one AVX-512 register.
//!
//! Invariant of every `unsafe` block here: an [`Avx512`] exists only inside [`super::dispatch_with`], which has checked
//! that the machine has AVX-512 F, DQ and VL. All values are created by functions that only a
//! [`super::LaneKernel`] calls.

use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use super::{LANES, Lanes, Line, Part, Real};

/// Eight numbers in one register.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Avx512(__m512d);

macro_rules! operator {
    ($trait:ident, $method:ident, $intrinsic:ident) => {
        impl $trait for Avx512 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the invariant of this module.
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}
operator!(Add, add, _mm512_add_pd);
operator!(Sub, sub, _mm512_sub_pd);
operator!(Mul, mul, _mm512_mul_pd);
operator!(Div, div, _mm512_div_pd);

impl Neg for Avx512 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm512_xor_pd(self.0, _mm512_set1_pd(-0.0)) })
    }
}

impl AddAssign for Avx512 {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Real for Avx512 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm512_set1_pd(value) })
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm512_fmadd_pd(self.0, b.0, c.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm512_sqrt_pd(self.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm512_max_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm512_min_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm512_abs_pd(self.0) })
    }
    #[inline(always)]
    fn select_less(self, limit: Self, yes: Self, no: Self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe {
            let mask = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, limit.0);
            _mm512_mask_blend_pd(mask, no.0, yes.0)
        })
    }
}

impl Part for Avx512 {
    type Whole = Self;
    const FIRST: usize = 0;
    const COUNT: usize = LANES;
    #[inline(always)]
    fn load(source: &[f64; LANES]) -> Self {
        // SAFETY: the invariant of this module; the source has eight numbers.
        Self(unsafe { _mm512_loadu_pd(source.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, target: &mut [f64; LANES]) {
        // SAFETY: the invariant of this module; the target has eight numbers.
        unsafe { _mm512_storeu_pd(target.as_mut_ptr(), self.0) }
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
            let mut rows = [_mm512_setzero_pd(); LANES];
            for l in 0..LANES {
                let at = indices[l] as usize * stride + line;
                debug_assert!(at < lines.len());
                rows[l] = _mm512_load_pd(lines.as_ptr().add(at).cast());
            }
            wrap(transpose(rows))
        }
    }
    #[inline(always)]
    fn less_mask(self, limit: Self) -> u8 {
        // SAFETY: the invariant of this module.
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, limit.0) }
    }
    #[inline(always)]
    fn transpose(block: [Self; LANES]) -> [Self; LANES] {
        // SAFETY: the invariant of this module.
        unsafe {
            let mut rows = [_mm512_setzero_pd(); LANES];
            for l in 0..LANES {
                rows[l] = block[l].0;
            }
            wrap(transpose(rows))
        }
    }
}

impl Lanes for Avx512 {
    type First = Self;
    type Second = Self;
    const HALVES: bool = false;
    #[inline(always)]
    fn sums_and_maximum(self, other: Self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm512_mask_add_pd(_mm512_max_pd(self.0, other.0), 0x7f, self.0, other.0) })
    }
    #[inline(always)]
    fn pack(numbers: &[u32; LANES], mask: u8) -> [u32; LANES] {
        let mut packed = [0; LANES];
        // SAFETY: the invariant of this module; both arrays have eight numbers.
        unsafe {
            let numbers = _mm256_loadu_si256(numbers.as_ptr().cast());
            _mm256_storeu_si256(packed.as_mut_ptr().cast(), _mm256_maskz_compress_epi32(mask, numbers));
        }
        packed
    }
}

#[inline(always)]
fn wrap(r: [__m512d; LANES]) -> [Avx512; LANES] {
    let [a, b, c, d, e, f, g, h] = r;
    [Avx512(a), Avx512(b), Avx512(c), Avx512(d), Avx512(e), Avx512(f), Avx512(g), Avx512(h)]
}

/// Rows to columns of an 8 × 8 block: pairs of numbers, then pairs of quarters, then halves.
#[inline(always)]
unsafe fn transpose(r: [__m512d; LANES]) -> [__m512d; LANES] {
    const LOW: i32 = 0b10_00_10_00;
    const HIGH: i32 = 0b11_01_11_01;
    // SAFETY: the invariant of this module.
    unsafe {
        // Even and odd numbers of rows 2 k and 2 k + 1, interleaved: e = (r0.0 r1.0 r0.2 r1.2 ...), o = (r0.1 r1.1 ...).
        let (e0, o0) = (_mm512_unpacklo_pd(r[0], r[1]), _mm512_unpackhi_pd(r[0], r[1]));
        let (e1, o1) = (_mm512_unpacklo_pd(r[2], r[3]), _mm512_unpackhi_pd(r[2], r[3]));
        let (e2, o2) = (_mm512_unpacklo_pd(r[4], r[5]), _mm512_unpackhi_pd(r[4], r[5]));
        let (e3, o3) = (_mm512_unpacklo_pd(r[6], r[7]), _mm512_unpackhi_pd(r[6], r[7]));
        // Quarters (0, 2) and (1, 3) of two of them: numbers (0, 4) and (2, 6), or (1, 5) and (3, 7), of four rows.
        let (a0, a1) = (_mm512_shuffle_f64x2::<LOW>(e0, e1), _mm512_shuffle_f64x2::<LOW>(e2, e3));
        let (b0, b1) = (_mm512_shuffle_f64x2::<LOW>(o0, o1), _mm512_shuffle_f64x2::<LOW>(o2, o3));
        let (c0, c1) = (_mm512_shuffle_f64x2::<HIGH>(e0, e1), _mm512_shuffle_f64x2::<HIGH>(e2, e3));
        let (d0, d1) = (_mm512_shuffle_f64x2::<HIGH>(o0, o1), _mm512_shuffle_f64x2::<HIGH>(o2, o3));
        [
            _mm512_shuffle_f64x2::<LOW>(a0, a1),
            _mm512_shuffle_f64x2::<LOW>(b0, b1),
            _mm512_shuffle_f64x2::<LOW>(c0, c1),
            _mm512_shuffle_f64x2::<LOW>(d0, d1),
            _mm512_shuffle_f64x2::<HIGH>(a0, a1),
            _mm512_shuffle_f64x2::<HIGH>(b0, b1),
            _mm512_shuffle_f64x2::<HIGH>(c0, c1),
            _mm512_shuffle_f64x2::<HIGH>(d0, d1),
        ]
    }
}
