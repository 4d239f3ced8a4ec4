//! The exponential function in lanes.

use super::{LANES, Lanes};

/// Beyond this absolute value lanes are computed one by one.
const SMALL: f64 = 0.25;

/// exp(x) to within a unit in the last place or so: a Taylor polynomial where |x| < 1/4, which the strain of a step is,
/// else `f64::exp` lane by lane. Which of the two a lane takes depends on its own x alone.
#[inline(always)]
pub fn exp<L: Lanes>(x: L) -> L {
    // 1/n! from n = 11 down to 0: the first term left out is below 2e-16.
    const COEFFICIENTS: [f64; 11] = [
        1.0 / 3_628_800.0,
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        0.5,
        1.0,
        1.0,
    ];
    let mut sum = L::splat(1.0 / 39_916_800.0);
    for c in COEFFICIENTS {
        sum = sum.mul_add(x, L::splat(c));
    }
    let small = x.abs().less_mask(L::splat(SMALL));
    if small == u8::MAX { sum } else { one_by_one(x, sum, small) }
}

#[cold]
#[inline(never)]
fn large(x: &[f64; LANES], sum: &mut [f64; LANES], small: u8) {
    for l in (0..LANES).filter(|l| small >> l & 1 == 0) {
        sum[l] = x[l].exp();
    }
}

#[inline(always)]
fn one_by_one<L: Lanes>(x: L, sum: L, small: u8) -> L {
    let mut sum = sum.to_array();
    large(&x.to_array(), &mut sum, small);
    L::load(&sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{InstructionSet, LaneKernel, dispatch_with};

    struct Exp<'a>(&'a [[f64; LANES]], &'a mut Vec<f64>);

    impl LaneKernel for Exp<'_> {
        #[inline(always)]
        fn run<L: Lanes>(self) {
            self.0.iter().for_each(|x| self.1.extend(exp(L::load(x)).to_array()));
        }
    }

    #[test]
    fn it_is_the_exponential_function_on_every_set_of_instructions() {
        let at = |k: usize| if k.is_multiple_of(50) { k as f64 - 500.0 } else { (k as f64 - 500.0) * 5e-4 };
        let points: Vec<[f64; LANES]> =
            (0..125).map(|b| std::array::from_fn(|l| at(LANES * b + l))).collect();
        for set in InstructionSet::available() {
            let mut values = Vec::new();
            dispatch_with(set, Exp(&points, &mut values));
            for (x, value) in points.iter().flatten().zip(&values) {
                let error = (value / x.exp() - 1.0).abs();
                assert!(error < 3.0 * f64::EPSILON, "exp({x}) = {value}, {set:?}");
            }
        }
        let mut unknown = Vec::new();
        dispatch_with(InstructionSet::Plain, Exp(&[[f64::NAN; LANES]], &mut unknown));
        assert!(unknown.iter().all(|x| x.is_nan()));
    }
}
