//! Exact values of elastic-plastic waves, and the cases that cannot be.

use sph_materials::hugoniot::{PistonWaves, elastic_limit, overdriven_threshold, piston, principal};
use sph_materials::{EquationOfState, HugoniotError, Strength, eos, library};

/// Asserts that a value has the digits of a table entry.
#[track_caller]
fn assert_rounds_to(value: f64, table: f64, half_digit: f64) {
    assert!((value - table).abs() <= half_digit, "{value} is not {table}");
}

/// Elastic precursor of the aluminum of the Riemann problem.
#[test]
fn precursor_of_aluminum() {
    let wave = elastic_limit(&library::material("aluminium-riemann").unwrap()).unwrap();
    assert_rounds_to(wave.behind.longitudinal_stress / 1e9, -0.676_087, 5e-7);
    assert_rounds_to(wave.behind.particle_velocity, 40.4285, 5e-5);
    assert_rounds_to(wave.wave_speed, 6219.28, 5e-3);
}

/// The contact of the Riemann problem moves like a piston: 129.3953 m/s.
#[test]
fn plastic_wave_of_aluminum() {
    let aluminum = library::material("aluminium-riemann").unwrap();
    let PistonWaves::TwoWave { plastic, .. } = piston(&aluminum, 129.3953).unwrap() else { panic!() };
    assert_rounds_to(plastic.behind.longitudinal_stress / 1e9, -1.931_996, 2e-6);
    assert_rounds_to(plastic.wave_speed, 5256.26, 5e-3);
}

/// Hand-computed states of the closed forms.
#[test]
fn principal_hugoniots() {
    let copper = library::material("porous-copper").unwrap();
    assert_rounds_to(principal(&copper, 1000.0).unwrap().wave_speed, 5430.0, 1e-9);
    // u_s (u_s - u_p) = c0^2
    let linear = library::material("copper-sound-wave").unwrap();
    let u_s = principal(&linear, 500.0).unwrap().wave_speed;
    assert_rounds_to(u_s * (u_s - 500.0) / (4148.0 * 4148.0), 1.0, 1e-14);
    // u_s (u_s - (Gamma + 1) u_p / 2) = c0^2
    let shell = library::material("aluminium-verney").unwrap();
    let u_s = principal(&shell, 500.0).unwrap().wave_speed;
    assert_rounds_to(u_s * (u_s - 750.0) / (5328.0 * 5328.0), 1.0, 1e-14);
}

#[test]
fn a_piston_must_push() {
    let copper = library::material("porous-copper").unwrap();
    for value in [0.0, -10.0, f64::INFINITY] {
        assert_eq!(piston(&copper, value), Err(HugoniotError::PistonVelocity { value }));
    }
    assert!(piston(&copper, f64::NAN).unwrap_err().to_string().contains("must be positive and finite"));
}

#[test]
fn only_a_yielding_solid_has_an_elastic_limit() {
    let mut copper = library::material("porous-copper").unwrap();
    let lost_in_round_off = Strength::PerfectPlastic { shear_modulus: 43e9, yield_strength: 1e-9 };
    for strength in [Strength::Fluid, Strength::Elastic { shear_modulus: 43e9 }, lost_in_round_off] {
        copper.strength = strength;
        let error = HugoniotError::NoElasticLimit { material: "porous-copper".into() };
        assert_eq!(elastic_limit(&copper), Err(error.clone()));
        assert_eq!(overdriven_threshold(&copper), Err(error));
    }
}

/// With strength, one shock compresses Mie-Grüneisen copper by less than 1 + 2 / 1.7, from the precursor's density on.
#[test]
fn a_piston_beyond_the_limit_of_compression_is_named() {
    let copper = library::material("porous-copper").unwrap();
    let error = piston(&copper, 60_000.0).unwrap_err();
    let HugoniotError::BeyondCompressionLimit { density_limit, .. } = error else { panic!("{error}") };
    let precursor = elastic_limit(&copper).unwrap().behind;
    assert_rounds_to(density_limit / precursor.density, 1.0 + 2.0 / 1.7, 1e-12);
}

/// Y = 2 G yields at e ρ0 = 2.72 ρ0, beyond the 1 + 2/1.7 = 2.18 ρ0 that one shock can compress to.
#[test]
fn an_elastic_limit_that_no_shock_reaches_is_named() {
    let mut copper = library::material("porous-copper").unwrap();
    copper.strength = Strength::PerfectPlastic { shear_modulus: 10e9, yield_strength: 20e9 };
    let density = 8960.0 * 1.0_f64.exp();
    let error = HugoniotError::ElasticLimitTooDense { material: "porous-copper".into(), density };
    assert_eq!(elastic_limit(&copper), Err(error.clone()));
    assert_eq!(overdriven_threshold(&copper), Err(error.clone()));
    assert_eq!(piston(&copper, 100.0), Err(error.clone()));
    assert!(!error.to_string().contains("0 m/s"), "{error}");
}

/// A Hugoniot of slope 1/2 ends where the shock is as slow as its piston, at 3930/(1 - 1/2) = 7860 m/s.
#[test]
fn a_shock_that_does_not_outrun_its_piston_is_named() {
    let mut copper = library::material("porous-copper").unwrap();
    let EquationOfState::MieGruneisen(model) = &mut copper.equation_of_state else { panic!() };
    model.hugoniot_slope = 0.5;
    copper.strength = Strength::Fluid;
    // u_s = 7855 m/s, ρ = ρ0 u_s/(u_s - u_p)
    let last = principal(&copper, 7850.0).unwrap();
    assert_rounds_to(last.behind.density / (8960.0 * 7855.0 / 5.0), 1.0, 1e-12);
    for piston_velocity in [7860.0, 9000.0, 1e200] {
        let density_limit = f64::INFINITY;
        let error = HugoniotError::BeyondCompressionLimit { piston_velocity, density_limit };
        assert_eq!(principal(&copper, piston_velocity), Err(error.clone()));
        assert_eq!(piston(&copper, piston_velocity), Err(error));
    }
    // The others lose u_s - u_p to rounding, or the pressure overflows.
    for name in ["copper-sound-wave", "aluminium-riemann", "aluminium-verney"] {
        let error = principal(&library::material(name).unwrap(), 1e200).unwrap_err();
        assert!(matches!(error, HugoniotError::BeyondCompressionLimit { .. }), "{name}: {error}");
    }
}

/// So strong a solid that the plastic wave is the faster one from the start.
#[test]
fn a_precursor_that_is_overtaken_from_the_start_is_named() {
    let mut copper = library::material("porous-copper").unwrap();
    copper.strength = Strength::PerfectPlastic { shear_modulus: 10e9, yield_strength: 9e9 };
    let error = overdriven_threshold(&copper).unwrap_err();
    assert!(matches!(error, HugoniotError::PrecursorTooSlow { .. }), "{error}");
    let u_ec = elastic_limit(&copper).unwrap().behind.particle_velocity;
    assert!(matches!(piston(&copper, 1.01 * u_ec).unwrap(), PistonWaves::Overdriven { .. }));
}

/// A nearly constant sound speed behind a stiff precursor: the plastic wave never catches it before the model ends.
#[test]
fn a_precursor_that_is_never_overtaken_is_named() {
    let mut solid = library::material("aluminium-riemann").unwrap();
    solid.equation_of_state = EquationOfState::Logarithmic(eos::Logarithmic { bulk_modulus: 1e6 });
    let error = overdriven_threshold(&solid).unwrap_err();
    assert!(matches!(error, HugoniotError::NeverOverdriven { .. }), "{error}");
}
