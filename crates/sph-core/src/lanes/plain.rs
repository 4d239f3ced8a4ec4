//! Eight lanes as an array: the reference, and what machines without AVX2 run.
//!
//! Operations are calls, not inlined: pair loops have hundreds of them, and eight copies of each would take minutes to
//! compile and gain little.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use super::{LANES, Lanes, Line, PLACES, Part, Real};

/// Eight numbers in an array.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Plain([f64; LANES]);

impl Plain {
    #[inline(always)]
    fn map2(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|l| f(self.0[l], other.0[l])))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait for Plain {
            type Output = Self;
            #[inline(never)]
            fn $method(self, other: Self) -> Self {
                self.map2(other, |a, b| $trait::$method(a, b))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Plain {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        Self(self.0.map(|a| -a))
    }
}

impl AddAssign for Plain {
    #[inline(never)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Real for Plain {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; LANES])
    }
    #[inline(never)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        Self(std::array::from_fn(|l| f64::mul_add(self.0[l], b.0[l], c.0[l])))
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }
    #[inline(never)]
    fn max(self, other: Self) -> Self {
        self.map2(other, Real::max)
    }
    #[inline(never)]
    fn min(self, other: Self) -> Self {
        self.map2(other, Real::min)
    }
    #[inline(never)]
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }
    #[inline(never)]
    fn select_less(self, limit: Self, yes: Self, no: Self) -> Self {
        Self(std::array::from_fn(|l| if self.0[l] < limit.0[l] { yes.0[l] } else { no.0[l] }))
    }
}

impl Part for Plain {
    type Whole = Self;
    const FIRST: usize = 0;
    const COUNT: usize = LANES;
    #[inline(always)]
    fn load(source: &[f64; LANES]) -> Self {
        Self(*source)
    }
    #[inline(always)]
    fn store(self, target: &mut [f64; LANES]) {
        *target = self.0;
    }
    #[inline(never)]
    unsafe fn load_records(
        lines: &[Line],
        stride: usize,
        line: usize,
        indices: &[u32; LANES],
    ) -> [Self; LANES] {
        let records: [&[f64; LANES]; LANES] =
            std::array::from_fn(|l| &lines[indices[l] as usize * stride + line].0);
        std::array::from_fn(|k| Self(std::array::from_fn(|l| records[l][k])))
    }
    #[inline(never)]
    fn less_mask(self, limit: Self) -> u8 {
        (0..LANES).fold(0, |mask, l| mask | ((self.0[l] < limit.0[l]) as u8) << l)
    }
    #[inline(never)]
    fn transpose(block: [Self; LANES]) -> [Self; LANES] {
        std::array::from_fn(|l| Self(std::array::from_fn(|k| block[k].0[l])))
    }
}

impl Lanes for Plain {
    type First = Self;
    type Second = Self;
    const HALVES: bool = false;
    #[inline(never)]
    fn sums_and_maximum(self, other: Self) -> Self {
        let mut result = self + other;
        result.0[LANES - 1] = Real::max(self.0[LANES - 1], other.0[LANES - 1]);
        result
    }
    #[inline(never)]
    fn pack(numbers: &[u32; LANES], mask: u8) -> [u32; LANES] {
        PLACES[mask as usize].map(|place| numbers[place as usize])
    }
}
