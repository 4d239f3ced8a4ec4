//! What every kernel must do, over [`KernelFamily::ALL`].

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::*;
use crate::dimension::{Dim2, Dim3};
use crate::lanes::{InstructionSet, LANES, LaneKernel, Lanes, dispatch_with};

/// Composite Simpson rule with 2000 intervals on each unit of q: the kernels are polynomials between whole numbers.
fn integral(support: f64, f: impl Fn(f64) -> f64) -> f64 {
    let intervals = 2000 * support as usize;
    let step = support / intervals as f64;
    let weight = |k: usize| match k {
        0 => 1.0,
        k if k == intervals => 1.0,
        k => 2.0 + 2.0 * (k % 2) as f64,
    };
    (0..=intervals).map(|k| weight(k) * f(k as f64 * step)).sum::<f64>() * step / 3.0
}

#[test]
fn the_integral_over_space_is_one() {
    for family in KernelFamily::ALL {
        let disc = integral(family.support(), |q| 2.0 * PI * q * family.value(q));
        let ball = integral(family.support(), |q| 4.0 * PI * q * q * family.value(q));
        assert!((family.normalization(2) * disc - 1.0).abs() < 1e-10, "{family:?} in 2-D: {disc}");
        assert!((family.normalization(3) * ball - 1.0).abs() < 1e-10, "{family:?} in 3-D: {ball}");
    }
}

#[test]
fn the_slope_is_the_derivative_of_the_value() {
    for family in KernelFamily::ALL {
        let size = family.value(0.0_f64);
        for k in 1..400 {
            let q = k as f64 * 0.0101;
            let e = 1e-5;
            let difference = (family.value(q + e) - family.value(q - e)) / (2.0 * e);
            let slope = -q * family.minus_slope_over_q(q);
            assert!((slope - difference).abs() < 1e-8 * size, "{family:?} at {q}: {slope} {difference}");
        }
    }
}

#[test]
fn the_slope_over_q_is_finite_and_continuous_at_the_origin() {
    for family in KernelFamily::ALL {
        let origin: f64 = family.minus_slope_over_q(0.0);
        let beside: f64 = family.minus_slope_over_q(1e-9);
        assert!(origin.is_finite() && origin > 0.0);
        assert!((origin - beside).abs() < 1e-7 * origin, "{family:?}: {origin} {beside}");
        // -(w')/q tends to -w''(0).
        let curvature = 2.0 * (family.value(0.0) - family.value(1e-4)) / 1e-8;
        assert!((origin - curvature).abs() < 1e-3 * origin, "{family:?}: {origin} {curvature}");
    }
}

#[test]
fn kernels_fall_from_the_center_to_exactly_zero_at_the_support() {
    for family in KernelFamily::ALL {
        let support = family.support();
        for q in [support, support * (1.0 + f64::EPSILON), 3.5, 10.0, 1e10] {
            assert_eq!(family.value(q), 0.0, "{family:?} at {q}");
            assert_eq!(family.minus_slope_over_q(q), 0.0, "{family:?} at {q}");
        }
        for k in 0..100 {
            let q = 0.0099 * k as f64 * support;
            assert!(family.value(q) > 0.0 && family.minus_slope_over_q(q) > 0.0, "{family:?} at {q}");
        }
    }
}

/// Values and slopes of eight numbers, as bits.
struct Bits<'a>(KernelFamily, [f64; LANES], &'a mut Vec<u64>);

impl LaneKernel for Bits<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let q = L::load(&self.1);
        for result in [self.0.value(q), self.0.minus_slope_over_q(q)] {
            self.2.extend(result.to_array().map(f64::to_bits));
        }
    }
}

#[test]
fn lanes_and_numbers_have_the_same_bits() {
    for family in KernelFamily::ALL {
        for k in 0..50 {
            let q: [f64; LANES] = std::array::from_fn(|l| 0.0083 * (LANES * k + l) as f64);
            let values = q.map(|q| family.value(q).to_bits());
            let slopes = q.map(|q| family.minus_slope_over_q(q).to_bits());
            for set in InstructionSet::available() {
                let mut bits = Vec::new();
                dispatch_with(set, Bits(family, q, &mut bits));
                assert_eq!(bits, [values, slopes].concat(), "{family:?} with {set:?}");
            }
        }
    }
}

#[test]
fn the_gradient_is_the_derivative_of_the_weight_with_respect_to_the_first_particle() {
    for family in KernelFamily::ALL {
        let (h, e) = (0.3, 1e-6);
        let r = DVec2::new(0.21, -0.17);
        // Moving r_i by e along x changes r_ji by -e.
        let weight = |x: f64| family.weight::<Dim2>((r - DVec2::new(x, 0.0)).length(), h);
        let difference = (weight(e) - weight(-e)) / (2.0 * e);
        let gradient = family.gradient::<Dim2>(r, h);
        assert!((gradient.x - difference).abs() < 1e-7 * gradient.length(), "{family:?}");

        let r = DVec3::new(0.11, -0.17, 0.2);
        let weight = |z: f64| family.weight::<Dim3>((r - DVec3::new(0.0, 0.0, z)).length(), h);
        let difference = (weight(e) - weight(-e)) / (2.0 * e);
        let gradient = family.gradient::<Dim3>(r, h);
        assert!((gradient.z - difference).abs() < 1e-7 * gradient.length(), "{family:?}");
    }
}
