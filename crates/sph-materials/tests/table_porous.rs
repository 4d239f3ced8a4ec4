//! Shut-pore jump conditions of porous copper, snow-plow, and the measured curve of pressed copper powder.

use sph_materials::porous::{CompactionCurve, CrushCurve, PorousMedium, Precursor, ShearBehind};
use sph_materials::{HugoniotError, Material, library};

fn copper() -> Material {
    library::material("porous-copper").unwrap()
}

fn medium(porosity: f64, stress: f64) -> PorousMedium {
    PorousMedium::with_porosity(&copper(), porosity, Precursor::Standing { stress }).unwrap()
}

/// u_p and the two ends of u_s [m/s], computed independently with a root search over u_s.
const RANGES: [(f64, f64, f64); 4] =
    [(150.0, 571.3, 574.0), (200.0, 757.2, 760.6), (250.0, 939.5, 943.7), (300.0, 1117.7, 1122.5)];

/// Both ends of the table to its digit: m = 1.3514, standing precursor of 0.20 GPa, without and with 2Y/3 behind.
#[test]
fn shut_pores_reproduce_both_ends_of_the_range() {
    for (u_p, lower, upper) in RANGES {
        let range = medium(1.3514, 0.20e9).shock_velocity_range(u_p).unwrap();
        assert!((range.lower - lower).abs() < 0.051, "{u_p}: {} {lower}", range.lower);
        assert!((range.upper - upper).abs() < 0.051, "{u_p}: {} {upper}", range.upper);
    }
}

/// The nominal porosity of 1.35 without precursor and strength lies within the range, too.
#[test]
fn nominal_porosity_lies_within_the_range() {
    for (u_p, lower, upper) in RANGES {
        let u_s = medium(1.35, 0.0).shut_pores(u_p, ShearBehind::None).unwrap().shock_velocity();
        assert!(lower < u_s && u_s < upper, "{u_p}: {u_s}");
    }
}

/// What moves u_s, and by how much: the figures of the module's documentation, at u_p = 250 m/s.
#[test]
fn sensitivities_are_as_documented() {
    let u_s = |m: f64, stress: f64| {
        medium(m, stress).shut_pores(250.0, ShearBehind::None).unwrap().shock_velocity()
    };
    let base = u_s(1.351, 0.2e9);
    let by_porosity = 100.0 * (u_s(1.352, 0.2e9) / base - 1.0);
    assert!((by_porosity + 0.2).abs() < 0.02, "{by_porosity} %");
    let by_precursor = 100.0 * (base / u_s(1.351, 0.0) - 1.0);
    assert!((by_precursor + 0.15).abs() < 0.02, "{by_precursor} %");
    let moving = Precursor::Moving { stress: 0.22e9, speed: 2600.0 };
    let with_velocity = PorousMedium::with_porosity(&copper(), 1.3514, moving).unwrap();
    let wave = with_velocity.shut_pores(200.0, ShearBehind::None).unwrap();
    assert!((wave.wave_speed - 732.4).abs() < 0.1, "{}", wave.wave_speed);
}

#[test]
fn snow_plow_of_a_third_voids() {
    let wave = medium(1.5, 0.1e9).snow_plow(100.0).unwrap();
    assert!((wave.shock_velocity() - 300.0).abs() < 1e-9);
    assert!((-wave.behind.longitudinal_stress - (0.1e9 + 8960.0 / 1.5 * 300.0 * 100.0)).abs() < 1.0);
}

#[test]
fn impossible_media_and_pistons_are_named() {
    let solid = copper();
    let new = |m, precursor| PorousMedium::with_porosity(&solid, m, precursor);
    assert!(matches!(new(1.0, Precursor::None), Err(HugoniotError::NotPorous { .. })));
    assert!(matches!(new(2.2, Precursor::None), Err(HugoniotError::AnomalousCompaction { .. })));
    let slow = Precursor::Moving { stress: 0.2e9, speed: 100.0 };
    assert!(matches!(new(1.35, slow), Err(HugoniotError::NotAbove { field: "speed", .. })));
    let negative = Precursor::Standing { stress: -1.0 };
    assert!(matches!(new(1.35, negative), Err(HugoniotError::BadNumber { field: "stress", .. })));

    // At its bound a number is refused, and the message says so: m = 1.4, so 8960/1.4 = 6400 kg/m³ and 6.4e7 Pa give 100 m/s.
    let at_bound = Precursor::Moving { stress: 6.4e7, speed: 100.0 };
    let Err(HugoniotError::NotAbove { value, least, .. }) = new(1.4, at_bound) else { panic!() };
    assert!((value / least - 1.0).abs() < 1e-14, "{value} {least}");
    let end = CompactionCurve::new(&solid, 6400.0, (1e8, 1900.0), 1e-9, 1e8).unwrap_err();
    let text = "greatest_stress = 100000000 Pa must be finite and greater than 100000000";
    assert_eq!(end.to_string(), text);

    let moving = new(1.35, Precursor::Moving { stress: 0.22e9, speed: 2600.0 }).unwrap();
    let shut = |u_p| moving.shut_pores(u_p, ShearBehind::None);
    assert!(matches!(shut(10.0), Err(HugoniotError::BelowPrecursor { .. })));
    assert!(matches!(shut(1200.0), Err(HugoniotError::PrecursorOvertaken { .. })));
    assert!(matches!(shut(-1.0), Err(HugoniotError::PistonVelocity { .. })));
    let weak = new(1.35, Precursor::None).unwrap().shut_pores(50.0, ShearBehind::Yielded);
    assert!(matches!(weak, Err(HugoniotError::MeanTension { .. })), "{weak:?}");
}

/// α falls from α1 to 1 as printed, and the state behind the precursor follows from its stress and speed.
#[test]
fn pressed_copper_powder() {
    let powder = CompactionCurve::pressed_copper_powder(&copper()).unwrap();
    let precursor = powder.precursor_state();
    assert!((precursor.particle_velocity - 1.4e8 / (6400.0 * 1900.0)).abs() < 1e-12);
    let alpha_1 = powder.precursor_distension();
    assert!((alpha_1 - 1.3929).abs() < 1e-3, "{alpha_1}");
    let alpha = powder.distension(10e8);
    assert!((alpha - 1.0 - (alpha_1 - 1.0) * (-0.254_f64 * 8.6).exp()).abs() < 1e-14);
    assert!(matches!(powder.wave_of_stress(1.0e8), Err(HugoniotError::OutsideCurve { .. })));
    assert!(matches!(powder.wave_of_stress(36e8), Err(HugoniotError::OutsideCurve { .. })));
    assert!(matches!(powder.wave(5.0), Err(HugoniotError::BelowPrecursor { .. })));
    assert!(matches!(powder.wave(2000.0), Err(HugoniotError::BeyondCurve { .. })));
}

/// At the upper end of its data the powder is compact: the shut-pore condition gives the same wave.
#[test]
fn powder_at_high_stress_agrees_with_shut_pores() {
    let powder = CompactionCurve::pressed_copper_powder(&copper()).unwrap();
    let precursor = Precursor::Moving { stress: 1.4e8, speed: 1900.0 };
    let shut = PorousMedium::new(&copper(), 6400.0, precursor).unwrap();
    let wave = powder.wave_of_stress(34e8).unwrap();
    let same = shut.shut_pores(wave.behind.particle_velocity, ShearBehind::None).unwrap();
    assert!(
        (wave.wave_speed / same.wave_speed - 1.0).abs() < 1e-3,
        "{} {}",
        wave.wave_speed,
        same.wave_speed
    );
}

/// Once a crush curve has ended the pores are shut, and the jump conditions of shut pores hold to the last digits.
#[test]
fn a_crush_curve_ends_at_the_jump_conditions_of_shut_pores() {
    let curve = CrushCurve::quadratic(0.15e9, 0.8e9, 1.3514).unwrap();
    let crushed = CompactionCurve::crush(medium(1.3514, 0.20e9), curve, 5e9).unwrap();
    for (u_p, lower, _) in RANGES.into_iter().skip(1) {
        let wave = crushed.wave(u_p).unwrap();
        assert!((wave.shock_velocity() - lower).abs() < 0.051, "{u_p}: {} {lower}", wave.shock_velocity());
    }
    // Below, the medium behind is lighter: mass conservation puts u_s above the shut-pore curve.
    let (open, shut) =
        (crushed.wave(75.0).unwrap(), medium(1.3514, 0.20e9).shut_pores(75.0, ShearBehind::None));
    assert!(open.shock_velocity() > 1.05 * shut.unwrap().shock_velocity(), "{open:?}");
    assert!(open.residuals().worst() < 1e-9, "{:?}", open.residuals());
    let alpha = curve.distension(-open.behind.longitudinal_stress);
    assert!(alpha > 1.01, "{alpha}");
    let back =
        medium(1.3514, 0.20e9).distension_behind(-open.behind.longitudinal_stress, open.behind.density);
    let back = back.unwrap();
    assert!((back / alpha - 1.0).abs() < 1e-12, "{back} {alpha}");
}

/// A state behind the wave that cannot be is an error, not a search without end.
#[test]
fn an_impossible_state_behind_the_wave_is_named() {
    let medium = medium(1.3514, 0.20e9);
    for stress in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = medium.distension_behind(stress, 8000.0).unwrap_err();
        assert!(matches!(error, HugoniotError::NotFinite { field: "stress", .. }), "{error}");
    }
    for density in [f64::NAN, f64::INFINITY, 0.0, -8000.0] {
        let error = medium.distension_behind(1e9, density).unwrap_err();
        assert!(matches!(error, HugoniotError::NotAbove { field: "density", .. }), "{error}");
    }
    // Expansion by the wave leaves so little energy that no density comes to the stress; and half of ρ0 bears no such tension.
    for (stress, density) in [(1e12, 1000.0), (1e12, 6630.0), (-5e11, 8000.0)] {
        let error = medium.distension_behind(stress, density).unwrap_err();
        assert_eq!(error, HugoniotError::NoSolidDensity { pressure: stress });
    }
}

/// A curve that begins with more voids than the medium has would let the wave expand it: an error, no numbers.
#[test]
fn a_crush_curve_that_expands_the_medium_is_refused() {
    let curve = CrushCurve::quadratic(0.15e9, 0.8e9, 2.0).unwrap();
    let crushed = CompactionCurve::crush(medium(1.3514, 0.20e9), curve, 5e9).unwrap();
    let error = crushed.wave_of_stress(0.21e9).unwrap_err();
    assert!(matches!(error, HugoniotError::NotCompacted { .. }), "{error}");
    assert!(error.to_string().contains("behind the precursor"), "{error}");
    // Where the curve has fallen below the medium's distension there is a wave again, and a piston finds it.
    let wave = crushed.wave(200.0).unwrap();
    assert!(wave.residuals().worst() < 1e-9, "{:?}", wave.residuals());
}

/// Behind a precursor that leaves the medium as dense as its solid nothing is left to plow.
#[test]
fn the_snow_plow_needs_pores() {
    let squeezed = Precursor::Moving { stress: 2.3e9, speed: 1080.0 };
    let medium = PorousMedium::with_porosity(&copper(), 1.3514, squeezed).unwrap();
    assert!(medium.state_ahead().density > copper().reference_density, "{:?}", medium.state_ahead());
    let error = medium.snow_plow(600.0).unwrap_err();
    assert!(matches!(error, HugoniotError::NotPorous { .. }), "{error}");
}
