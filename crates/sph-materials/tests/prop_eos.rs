//! Every equation of state over wide ranges: exact derivatives, continuity, and the return to the yield surface.

use proptest::prelude::*;
use sph_materials::eos::{EquationOfState, IdealGas, Linear, LinearGamma, Logarithmic, MieGruneisen};
use sph_materials::strength::{Strength, von_mises_stress};

/// One of each model, with parameters from soft to hard.
fn equations_of_state() -> impl Strategy<Value = EquationOfState> {
    let speed = 500.0..9000.0_f64;
    prop_oneof![
        (speed.clone(), 0.0..2.0_f64, 0.0..3.0_f64).prop_map(|(c, s, g)| {
            EquationOfState::MieGruneisen(MieGruneisen {
                bulk_sound_speed: c,
                hugoniot_slope: s,
                gruneisen_coefficient: g,
            })
        }),
        (1e9..500e9_f64).prop_map(|b| EquationOfState::Logarithmic(Logarithmic { bulk_modulus: b })),
        speed.clone().prop_map(|c| EquationOfState::Linear(Linear { bulk_sound_speed: c })),
        (1.01..4.0_f64).prop_map(|g| EquationOfState::IdealGas(IdealGas { gamma: g })),
        (speed, 1.0..4.0_f64)
            .prop_map(|(c, g)| EquationOfState::LinearGamma(LinearGamma { bulk_sound_speed: c, gamma: g })),
    ]
}

/// Density ratio, expansion and compression, kept off the singular density and off x = 1 by more than a difference step.
fn ratios() -> impl Strategy<Value = f64> {
    prop_oneof![0.3..0.999_f64, 1.001..1.4_f64]
}

proptest! {
    #[test]
    fn sound_speed_is_the_derivative_of_pressure(
        eos in equations_of_state(), rho0 in 500.0..20_000.0_f64, ratio in ratios(), e in -1e6..1e7_f64,
    ) {
        let rho = ratio * rho0;
        let (d_rho, d_e) = (1e-5 * rho, 1e3);
        let dp_drho = (eos.pressure(rho0, rho + d_rho, e) - eos.pressure(rho0, rho - d_rho, e)) / (2.0 * d_rho);
        let dp_de = (eos.pressure(rho0, rho, e + d_e) - eos.pressure(rho0, rho, e - d_e)) / (2.0 * d_e);
        let difference = dp_drho + eos.pressure(rho0, rho, e) / (rho * rho) * dp_de;
        let exact = eos.thermodynamic_sound_speed_squared(rho0, rho, e);
        // the terms cancel in expansion: compare with the sum of their magnitudes
        let scale = dp_drho.abs() + (eos.pressure(rho0, rho, e) / (rho * rho) * dp_de).abs()
            + eos.quasi_acoustic_sound_speed_squared(rho0, rho);
        prop_assert!((exact - difference).abs() <= 1e-7 * scale, "{exact} {difference}");
        let slope = eos.pressure_energy_slope(rho);
        prop_assert!((dp_de - slope).abs() <= 1e-6 * (slope.abs() + scale / 1e6), "{dp_de} {slope}");
    }

    #[test]
    fn pressure_is_continuous_and_smooth_at_the_reference_density(
        eos in equations_of_state(), rho0 in 500.0..20_000.0_f64, e in -1e6..1e7_f64,
    ) {
        let tiny = 1e-9;
        let at = |ratio: f64| eos.pressure(rho0, ratio * rho0, e);
        let bulk_modulus = eos.reference_bulk_modulus(rho0);
        let scale = bulk_modulus + at(1.0).abs();
        prop_assert!((at(1.0 + tiny) - at(1.0)).abs() <= 1e-8 * scale);
        prop_assert!((at(1.0) - at(1.0 - tiny)).abs() <= 1e-8 * scale);
        let c_squared = |ratio: f64| eos.thermodynamic_sound_speed_squared(rho0, ratio * rho0, e);
        let jump = (c_squared(1.0 + tiny) - c_squared(1.0 - tiny)).abs();
        prop_assert!(jump <= 1e-6 * (scale / rho0 + c_squared(1.0).abs()), "{jump}");
    }

    #[test]
    fn reference_state_is_free_of_pressure_and_both_sound_speeds_agree_there(
        eos in equations_of_state(), rho0 in 500.0..20_000.0_f64,
    ) {
        prop_assert_eq!(eos.pressure(rho0, rho0, 0.0), 0.0);
        let exact = eos.thermodynamic_sound_speed_squared(rho0, rho0, 0.0);
        let quasi_acoustic = eos.quasi_acoustic_sound_speed_squared(rho0, rho0);
        if eos.reference_bulk_modulus(rho0) == 0.0 {
            // A gas without energy has no sound, by either measure.
            prop_assert_eq!((exact, quasi_acoustic), (0.0, 0.0));
        } else {
            prop_assert!((exact / quasi_acoustic - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn the_return_lands_on_the_yield_surface(
        s in prop::array::uniform5(-1e10..1e10_f64), yield_strength in 1e6..5e9_f64,
    ) {
        let [xx, yy, xy, yz, zx] = s;
        let contraction = |f: f64| {
            let zz = -(xx + yy);
            f * f * (xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx))
        };
        let solid = Strength::PerfectPlastic { shear_modulus: 40e9, yield_strength };
        let factor = solid.return_factor(contraction(1.0));
        let returned = von_mises_stress(contraction(factor));
        if von_mises_stress(contraction(1.0)) <= yield_strength {
            prop_assert_eq!(factor, 1.0);
        } else {
            prop_assert!((returned / yield_strength - 1.0).abs() < 1e-14, "{returned}");
        }
    }
}
