//! Eight lanes in two AVX2 registers, and either half of them in one.
//!
//! A machine with AVX2 has sixteen registers of four numbers. Eight lanes of a loop with many numbers at a time would keep most
//! of them on the stack: such loops take one half after the other.
//!
//! Invariant of every `unsafe` block here: a [`Half`] exists only inside [`super::dispatch_with`], which has checked
//! that the machine has AVX2 and fused multiply-add.

use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use super::{LANES, Lanes, Line, PLACES, Part, Real};

/// Numbers in a register.
const HALF: usize = LANES / 2;

/// Four numbers in a register: lanes 4 `WHICH` to 4 `WHICH` + 3 of eight.
#[derive(Clone, Copy, Debug)]
pub struct Half<const WHICH: usize>(__m256d);

/// Eight numbers in two registers.
#[derive(Clone, Copy, Debug)]
pub struct Avx2(Half<0>, Half<1>);

macro_rules! operator {
    ($trait:ident, $method:ident, $intrinsic:ident) => {
        impl<const WHICH: usize> $trait for Half<WHICH> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the invariant of this module.
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
        impl $trait for Avx2 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self($trait::$method(self.0, other.0), $trait::$method(self.1, other.1))
            }
        }
    };
}
operator!(Add, add, _mm256_add_pd);
operator!(Sub, sub, _mm256_sub_pd);
operator!(Mul, mul, _mm256_mul_pd);
operator!(Div, div, _mm256_div_pd);

impl<const WHICH: usize> Neg for Half<WHICH> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm256_xor_pd(self.0, _mm256_set1_pd(-0.0)) })
    }
}

impl Neg for Avx2 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl<const WHICH: usize> AddAssign for Half<WHICH> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl AddAssign for Avx2 {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const WHICH: usize> Real for Half<WHICH> {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm256_set1_pd(value) })
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm256_fmadd_pd(self.0, b.0, c.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm256_sqrt_pd(self.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm256_max_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm256_min_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: the invariant of this module.
        Self(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
    }
    #[inline(always)]
    fn select_less(self, limit: Self, yes: Self, no: Self) -> Self {
        // Written bit by bit: where one of the two is zero the compiler then leaves a single operation behind the comparison.
        // SAFETY: the invariant of this module.
        Self(unsafe {
            let less = _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, limit.0);
            _mm256_or_pd(_mm256_and_pd(less, yes.0), _mm256_andnot_pd(less, no.0))
        })
    }
}

impl Real for Avx2 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self(Real::splat(value), Real::splat(value))
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        Self(self.0.mul_add(b.0, c.0), self.1.mul_add(b.1, c.1))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1.max(other.1))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0), self.1.min(other.1))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn select_less(self, limit: Self, yes: Self, no: Self) -> Self {
        Self(self.0.select_less(limit.0, yes.0, no.0), self.1.select_less(limit.1, yes.1, no.1))
    }
}

impl<const WHICH: usize> Part for Half<WHICH> {
    type Whole = Avx2;
    const FIRST: usize = WHICH * HALF;
    const COUNT: usize = HALF;
    #[inline(always)]
    fn load(source: &[f64; LANES]) -> Self {
        // SAFETY: the invariant of this module; the source has eight numbers.
        Self(unsafe { _mm256_loadu_pd(source.as_ptr().add(Self::FIRST)) })
    }
    #[inline(always)]
    fn store(self, target: &mut [f64; LANES]) {
        // SAFETY: the invariant of this module; the target has eight numbers.
        unsafe { _mm256_storeu_pd(target.as_mut_ptr().add(Self::FIRST), self.0) }
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
            let mut rows = [[_mm256_setzero_pd(); HALF]; 2];
            for l in 0..HALF {
                let at = indices[Self::FIRST + l] as usize * stride + line;
                debug_assert!(at < lines.len());
                let row = lines.as_ptr().add(at).cast::<f64>();
                (rows[0][l], rows[1][l]) = (_mm256_load_pd(row), _mm256_load_pd(row.add(HALF)));
            }
            let ([a, b, c, d], [e, f, g, h]) = (transpose(rows[0]), transpose(rows[1]));
            [Self(a), Self(b), Self(c), Self(d), Self(e), Self(f), Self(g), Self(h)]
        }
    }
    #[inline(always)]
    fn transpose(block: [Self; LANES]) -> [Avx2; LANES] {
        let [a, b, c, d, e, f, g, h] = block;
        // SAFETY: the invariant of this module.
        let (low, high) = unsafe { (transpose([a.0, b.0, c.0, d.0]), transpose([e.0, f.0, g.0, h.0])) };
        let mut rows = [Avx2::zero(); LANES];
        for l in 0..HALF {
            rows[Self::FIRST + l] = Avx2(Half(low[l]), Half(high[l]));
        }
        rows
    }
    #[inline(always)]
    fn less_mask(self, limit: Self) -> u8 {
        // SAFETY: the invariant of this module.
        let mask = unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, limit.0)) };
        (mask as u8) << Self::FIRST
    }
}

impl Part for Avx2 {
    type Whole = Self;
    const FIRST: usize = 0;
    const COUNT: usize = LANES;
    #[inline(always)]
    fn load(source: &[f64; LANES]) -> Self {
        Self(Part::load(source), Part::load(source))
    }
    #[inline(always)]
    fn store(self, target: &mut [f64; LANES]) {
        self.0.store(target);
        self.1.store(target);
    }
    #[inline(always)]
    unsafe fn load_records(
        lines: &[Line],
        stride: usize,
        line: usize,
        indices: &[u32; LANES],
    ) -> [Self; LANES] {
        // SAFETY: the caller's promise.
        unsafe {
            join(
                Part::load_records(lines, stride, line, indices),
                Part::load_records(lines, stride, line, indices),
            )
        }
    }
    #[inline(always)]
    fn less_mask(self, limit: Self) -> u8 {
        self.0.less_mask(limit.0) | self.1.less_mask(limit.1)
    }
    #[inline(always)]
    fn transpose(block: [Self; LANES]) -> [Self; LANES] {
        let r = block;
        // SAFETY: the invariant of this module.
        let [a, b, c, d] = unsafe {
            [
                transpose([r[0].0.0, r[1].0.0, r[2].0.0, r[3].0.0]),
                transpose([r[4].0.0, r[5].0.0, r[6].0.0, r[7].0.0]),
                transpose([r[0].1.0, r[1].1.0, r[2].1.0, r[3].1.0]),
                transpose([r[4].1.0, r[5].1.0, r[6].1.0, r[7].1.0]),
            ]
        };
        let mut rows = [Self::zero(); LANES];
        for l in 0..HALF {
            rows[l] = Self(Half(a[l]), Half(b[l]));
            rows[HALF + l] = Self(Half(c[l]), Half(d[l]));
        }
        rows
    }
}

impl Lanes for Avx2 {
    type First = Half<0>;
    type Second = Half<1>;
    const HALVES: bool = true;
    #[inline(always)]
    fn sums_and_maximum(self, other: Self) -> Self {
        let (sum, larger) = (self.1 + other.1, self.1.max(other.1));
        // SAFETY: the invariant of this module.
        Self(self.0 + other.0, Half(unsafe { _mm256_blend_pd::<0b1000>(sum.0, larger.0) }))
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

/// Eight columns from their halves.
#[inline(always)]
fn join(low: [Half<0>; LANES], high: [Half<1>; LANES]) -> [Avx2; LANES] {
    let mut joined = [Avx2(low[0], high[0]); LANES];
    for k in 1..LANES {
        joined[k] = Avx2(low[k], high[k]);
    }
    joined
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
