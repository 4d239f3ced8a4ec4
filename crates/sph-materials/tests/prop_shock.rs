//! Every wave that comes out satisfies the three jump conditions and the equation of state.

use proptest::prelude::*;
use sph_materials::hugoniot::{PistonWaves, elastic_limit, overdriven_threshold, piston, principal};
use sph_materials::library;
use sph_materials::porous::{CompactionCurve, PorousMedium, Precursor, ShearBehind};
use sph_materials::{HugoniotError, Jump, Material, ShockState, Strength};

const GATE: f64 = 1e-10;

fn library_materials() -> impl Strategy<Value = Material> {
    prop::sample::select(library::names()).prop_map(|name| library::material(name).unwrap())
}

/// The three conservation laws, and the pressure behind as the equation of state gives it.
fn assert_exact(material: &Material, jump: &Jump) -> Result<(), TestCaseError> {
    prop_assert!(jump.residuals().worst() < GATE, "{:?}", jump.residuals());
    assert_on_equation_of_state(material, &jump.behind)
}

fn assert_on_equation_of_state(material: &Material, state: &ShockState) -> Result<(), TestCaseError> {
    let pressure = material.pressure(state.density, state.specific_internal_energy);
    let bulk_modulus = material.equation_of_state.reference_bulk_modulus(material.reference_density);
    let miss = (pressure - state.pressure).abs() / (bulk_modulus + state.pressure.abs());
    prop_assert!(miss < 1e-12, "{pressure} {}", state.pressure);
    Ok(())
}

proptest! {
    #[test]
    fn principal_hugoniot_of_every_equation_of_state(material in library_materials(), u_p in 1.0..5000.0_f64) {
        assert_exact(&material, &principal(&material, u_p).unwrap())?;
    }

    #[test]
    fn waves_ahead_of_a_piston(material in library_materials(), u_p in 1.0..5000.0_f64) {
        let waves = piston(&material, u_p).unwrap();
        if let PistonWaves::TwoWave { precursor, plastic } = waves {
            assert_exact(&material, &precursor)?;
            prop_assert_eq!(plastic.ahead, precursor.behind);
            prop_assert!(plastic.wave_speed < precursor.wave_speed);
        }
        assert_exact(&material, &waves.main_wave())?;
        let state = waves.final_state();
        prop_assert!((state.particle_velocity / u_p - 1.0).abs() < 1e-9);
        let s = -(state.longitudinal_stress + state.pressure);
        let limit = 2.0 / 3.0 * material.strength.yield_strength();
        prop_assert!(s >= 0.0 && s <= limit * (1.0 + 1e-6), "{s} {limit}");
    }

    #[test]
    fn a_solid_without_strength_agrees_with_the_closed_form(material in library_materials(), u_p in 10.0..2000.0_f64) {
        // the general adiabat, with a yield strength too small to matter, against the closed form
        let mut weak = material.clone();
        weak.strength = Strength::PerfectPlastic { shear_modulus: 1e9, yield_strength: 1.0 };
        let closed = principal(&material, u_p).unwrap();
        let general = piston(&weak, u_p).unwrap().main_wave();
        prop_assert!((general.wave_speed / closed.wave_speed - 1.0).abs() < 1e-6);
        prop_assert!((general.behind.density / closed.behind.density - 1.0).abs() < 1e-8);
        weak.strength = Strength::Fluid;
        prop_assert_eq!(piston(&weak, u_p).unwrap().main_wave(), closed);
    }

    #[test]
    fn compaction_waves(
        m in 1.02..2.1_f64, u_p in 50.0..1500.0_f64, stress in 0.0..0.3e9_f64, moving: bool,
    ) {
        let copper = library::material("porous-copper").unwrap();
        let precursor = if moving { Precursor::Moving { stress, speed: 2600.0 } } else { Precursor::Standing { stress } };
        let medium = PorousMedium::with_porosity(&copper, m, precursor).unwrap();
        // Velocity and stress of the incompressible solid: what a named impossible case must go with. All else must be a wave.
        let ahead = medium.state_ahead();
        let du = u_p - ahead.particle_velocity;
        let u_s = du / (1.0 - ahead.density / copper.reference_density);
        let may_overtake = moving && ahead.particle_velocity + u_s > 2500.0;
        let stress_behind = stress + ahead.density * u_s * du;
        let may_be_in_tension = stress_behind < 1.02 * 2.0 / 3.0 * copper.strength.yield_strength();
        if moving && stress > 0.0 {
            let rest = ShockState::at_rest(medium.initial_density());
            let wave = Jump { ahead: rest, behind: ahead, wave_speed: 2600.0 };
            prop_assert!(wave.residuals().worst() < GATE, "{:?}", wave.residuals());
        }
        for shear in [ShearBehind::None, ShearBehind::Yielded] {
            match medium.shut_pores(u_p, shear) {
                Ok(jump) => assert_exact(&copper, &jump)?,
                Err(HugoniotError::PrecursorOvertaken { wave_speed, .. }) => {
                    prop_assert!(may_overtake && wave_speed >= 2600.0);
                }
                Err(HugoniotError::MeanTension { pressure, .. }) => {
                    prop_assert!(shear == ShearBehind::Yielded && may_be_in_tension && pressure < 0.0);
                }
                Err(error) => prop_assert!(false, "{error}"),
            }
        }
        match medium.snow_plow(u_p) {
            Ok(jump) => {
                prop_assert!(jump.residuals().worst() < GATE);
                prop_assert_eq!(jump.behind.density, copper.reference_density);
            }
            Err(HugoniotError::PrecursorOvertaken { wave_speed, .. }) => {
                prop_assert!(may_overtake && wave_speed >= 2600.0);
            }
            Err(error) => prop_assert!(false, "{error}"),
        }
    }

    #[test]
    fn waves_along_a_measured_compaction_curve(u_p in 15.0..400.0_f64) {
        let copper = library::material("porous-copper").unwrap();
        let powder = CompactionCurve::pressed_copper_powder(&copper).unwrap();
        let wave = powder.wave(u_p).unwrap();
        prop_assert!(wave.residuals().worst() < GATE, "{:?}", wave.residuals());
        prop_assert!((wave.behind.particle_velocity / u_p - 1.0).abs() < 1e-8);
        // the solid between the pores is on its own equation of state
        let stress = -wave.behind.longitudinal_stress;
        let rho_s = wave.behind.density * powder.distension(stress);
        let pressure = copper.pressure(rho_s, wave.behind.specific_internal_energy);
        prop_assert!((pressure - stress).abs() < 1e-2 + 1e-6 * stress, "{pressure} {stress}");
    }
}

/// Where two waves become one, both descriptions give the same state.
#[test]
fn two_waves_merge_continuously_at_the_threshold() {
    for name in ["porous-copper", "aluminium-riemann", "aluminium-verney"] {
        let material = library::material(name).unwrap();
        let threshold = overdriven_threshold(&material).unwrap();
        let below = piston(&material, threshold * (1.0 - 1e-9)).unwrap();
        let above = piston(&material, threshold * (1.0 + 1e-9)).unwrap();
        assert!(matches!(below, PistonWaves::TwoWave { .. }), "{name} {below:?}");
        assert!(matches!(above, PistonWaves::Overdriven { .. }), "{name} {above:?}");
        let (low, high) = (below.final_state(), above.final_state());
        assert!((low.longitudinal_stress / high.longitudinal_stress - 1.0).abs() < 1e-7, "{name}");
        assert!((low.density / high.density - 1.0).abs() < 1e-7, "{name}");
    }
}

/// At the elastic limit the elastic wave turns into a precursor with an infinitely weak plastic wave.
#[test]
fn elastic_and_two_wave_structures_meet_at_the_elastic_limit() {
    let copper = library::material("porous-copper").unwrap();
    let u_ec = elastic_limit(&copper).unwrap().behind.particle_velocity;
    let below = piston(&copper, u_ec * (1.0 - 1e-9)).unwrap();
    let above = piston(&copper, u_ec * (1.0 + 1e-9)).unwrap();
    assert!(matches!(below, PistonWaves::Elastic { .. }) && matches!(above, PistonWaves::TwoWave { .. }));
    let ratio = below.final_state().longitudinal_stress / above.final_state().longitudinal_stress;
    assert!((ratio - 1.0).abs() < 1e-8, "{ratio}");
}
