//! Between which u_p a compaction front separates from the elastic precursor.
//!
//! A front that is as fast as the precursor has overrun it: one wave is left, the state ahead of the front is the undisturbed
//! medium, and neither σ_HEL nor the jump Δσ that the product reports exist.
//!
//! The precursor cannot be faster than the longitudinal wave of the stiffest medium of its porosity, in plane strain across
//! parallel pores by the upper bound of Hashin and Hill,
//!
//! ```text
//! k* = (1 - φ) k G/(G + φ k),
//! G* = G + φ/[(1 - φ)(k + 2G)/(2G (k + G)) - 1/G],
//! c = √[(k* + G*)/ρ00]
//! ```
//!
//! with `k = K + G/3`, `φ = 1 - 1/m`. The front runs as the jump conditions of shut pores say, and where both
//! are equal lies the limit. It is an upper one: yielding around the pores makes a real precursor slower (2.6 to 2.8 km/s
//! in the shipped case, where the bound says 3.5 km/s). For a solid without pores it is exact (its own two waves).
//!
//! **Too slow.** A piston slower than the matter behind the precursor drives an elastic wave alone. The precursor carries no
//! more than the stress P_c that makes the walls of the pores yield throughout ([`crate::zone::crush_stress`]; 0.27 GPa in
//! the shipped case, where a run reads 0.21), in a solid that of its Hugoniot elastic limit, and is not faster than c: below
//!
//! ```text
//! u_e = σ_HEL/(ρ00 c)
//! ```
//!
//! (12 m/s in the shipped case) no front separates. What neither bound sees is told after the run ([`finding`]).
//!
//! Source of the bounds: Z. Hashin, J. Mech. Phys. Solids 13 (1965) 119; R. Hill, J. Mech. Phys. Solids 12 (1964) 199.

use sph_materials::hugoniot::overdriven_threshold;
use sph_materials::porous::{PorousMedium, Precursor, ShearBehind};
use sph_materials::{Material, Strength};

use crate::observe;
use crate::zone::crush_stress;

/// Porosity below which a medium counts as solid.
const SOLID: f64 = 1.0 + 1e-9;
/// Largest u_p that is looked at [m/s].
const LARGEST: f64 = 2e4;

/// Greatest speed of an elastic precursor in a medium of porosity m [m/s].
pub fn fastest_precursor(material: &Material, porosity: f64) -> f64 {
    let (rho, void) = (material.reference_density, 1.0 - 1.0 / porosity);
    let shear = material.strength.shear_modulus();
    let longitudinal = rho * material.longitudinal_sound_speed(rho, 0.0).powi(2);
    let k = longitudinal - shear;
    let bulk = (1.0 - void) * k * shear / (shear + void * k);
    let shape = (1.0 - void) * (k + 2.0 * shear) / (2.0 * shear * (k + shear)) - 1.0 / shear;
    let stiffness = bulk + shear + void / shape;
    (stiffness * porosity / rho).sqrt()
}

/// The u_p from which on no front separates from the precursor [m/s]; `None` where there is no precursor (no yield
/// strength) or no such limit.
pub fn limiting_particle_velocity(material: &Material, porosity: f64) -> Option<f64> {
    if !matches!(material.strength, Strength::PerfectPlastic { .. }) {
        return None;
    }
    if porosity <= SOLID {
        return overdriven_threshold(material).ok();
    }
    let medium = PorousMedium::with_porosity(material, porosity, Precursor::None).ok()?;
    let fastest = fastest_precursor(material, porosity);
    let is_overdriven =
        |u_p: f64| medium.shut_pores(u_p, ShearBehind::None).map(|jump| jump.shock_velocity() >= fastest);
    let (mut low, mut high) = (1.0, LARGEST);
    if is_overdriven(low).ok()? || !is_overdriven(high).ok()? {
        return None;
    }
    while high - low > 0.01 {
        let middle = 0.5 * (low + high);
        *(if is_overdriven(middle).ok()? { &mut high } else { &mut low }) = middle;
    }
    Some(low)
}

/// Estimate of σ_HEL [Pa] and of the velocity u_e that the precursor gives to the matter [m/s]; `None` without yield strength.
pub fn elastic_limit(material: &Material, porosity: f64) -> Option<(f64, f64)> {
    let Strength::PerfectPlastic { yield_strength, .. } = material.strength else { return None };
    let (rho, shear) = (material.reference_density, material.strength.shear_modulus());
    let speed = fastest_precursor(material, porosity);
    let solid = 0.5 * yield_strength * rho * material.longitudinal_sound_speed(rho, 0.0).powi(2) / shear;
    let stress = if porosity <= SOLID { solid } else { crush_stress(material, porosity).min(solid) };
    Some((stress, stress * porosity / (rho * speed)))
}

/// What is wrong with a u_p [m/s], if it is too slow or too fast for the medium: the message and a hint. In a medium of
/// several solids it is, if it were in each of them alone; the words are those of the first.
pub fn refusal(materials: &[Material], porosity: f64, particle_velocity: f64) -> Option<(String, String)> {
    let of_each = materials.iter().map(|material| refusal_of_one(material, porosity, particle_velocity));
    of_each.collect::<Option<Vec<_>>>()?.into_iter().next()
}

fn refusal_of_one(material: &Material, porosity: f64, particle_velocity: f64) -> Option<(String, String)> {
    if let Some((stress, slowest)) =
        elastic_limit(material, porosity).filter(|limit| particle_velocity < limit.1)
    {
        return Some((
            format!(
                "u_p = {particle_velocity} m/s: no front separates: an elastic precursor of σ_HEL = {:.2} GPa alone gives the \
                 matter {slowest:.0} m/s",
                stress / 1e9
            ),
            format!("at least {:.0} m/s for this medium (m = {porosity:.3})", slowest.ceil()),
        ));
    }
    let limit = limiting_particle_velocity(material, porosity)?;
    (particle_velocity >= limit).then(|| {
        let fastest = if porosity <= SOLID { f64::NAN } else { fastest_precursor(material, porosity) };
        let speed = if fastest.is_finite() {
            format!(", which runs at {:.1} km/s at most", fastest / 1e3)
        } else {
            String::new()
        };
        (
            format!("u_p = {particle_velocity} m/s: the front overruns the elastic precursor{speed}"),
            format!("below {:.0} m/s for this medium (m = {porosity:.3})", limit.floor()),
        )
    })
}

/// A front faster than this part of the fastest precursor has no room to separate from it.
const CLOSE: f64 = 0.6;
/// Up to so many times u_e a front that is as fast as the precursor is the precursor.
const ELASTIC: f64 = 4.0;

/// What a run says about the separation, if it failed: both waves are one. In a medium of several solids the strongest sets
/// σ_HEL, beyond which all of it yields, and the stiffest what the front is compared with where no precursor was read.
pub fn finding(
    materials: &[Material],
    porosity: f64,
    particle_velocity: f64,
    shock_velocity: f64,
    precursor: Option<&observe::Precursor>,
) -> Option<String> {
    let limits = materials.iter().filter_map(|material| elastic_limit(material, porosity));
    let (stress, slowest) = limits.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let fastest = materials.iter().map(|m| fastest_precursor(m, porosity)).fold(0.0, f64::max);
    let speed = precursor.map_or(CLOSE * fastest, |p| p.foot_speed);
    if shock_velocity.is_nan() || shock_velocity < speed {
        return None;
    }
    let words =
        format!("the front runs with {shock_velocity:.0} m/s, the elastic precursor with {speed:.0} m/s");
    Some(if particle_velocity < ELASTIC * slowest {
        format!(
            "elastic: {words}: no compaction front has separated from it; hint: u_p well above {slowest:.0} m/s, where \
             σ_HEL = {:.2} GPa is reached",
            stress / 1e9
        )
    } else {
        format!(
            "overdriven: {words}: one wave is left, and σ_HEL and the stress jump mean nothing; hint: a smaller u_p"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn copper() -> Material {
        sph_materials::library::material("porous-copper").unwrap()
    }

    #[test]
    fn the_limit_of_porous_copper_lies_where_the_fast_front_catches_up() {
        let speed = fastest_precursor(&copper(), 1.35);
        assert!((speed / 3506.0 - 1.0).abs() < 0.01, "{speed}");
        let solid = copper().longitudinal_sound_speed(8960.0, 0.0);
        assert!((fastest_precursor(&copper(), 1.0 + 1e-12) / solid - 1.0).abs() < 1e-6);
        let limit = limiting_particle_velocity(&copper(), 1.35).unwrap();
        println!("limit {limit} m/s");
        assert!((950.0..1150.0).contains(&limit), "{limit}");
        assert!(refusal(&[copper()], 1.35, 300.0).is_none());
        let (message, hint) = refusal(&[copper()], 1.35, 1500.0).unwrap();
        assert!(
            message.contains("overruns the elastic precursor, which runs at 3.5 km/s at most"),
            "{message}"
        );
        assert!(hint.starts_with("below "), "{hint}");
    }

    #[test]
    fn below_the_elastic_limit_there_is_no_front() {
        let (stress, slowest) = elastic_limit(&copper(), 1.35).unwrap();
        assert!((stress / 0.2728e9 - 1.0).abs() < 1e-3 && (slowest - 11.7).abs() < 0.1, "{stress} {slowest}");
        let (message, hint) = refusal(&[copper()], 1.35, 8.0).unwrap();
        assert!(message.contains("no front separates") && message.contains("0.27 GPa"), "{message}");
        assert_eq!(hint, "at least 12 m/s for this medium (m = 1.350)");
        // σ_HEL = Y (K + 4G/3)/(2G) = 0.796 GPa of the solid, over ρ0 c_l.
        let (stress, slowest) = elastic_limit(&copper(), 1.0).unwrap();
        assert!((stress / 0.7964e9 - 1.0).abs() < 1e-3 && (slowest - 19.0).abs() < 0.1, "{stress} {slowest}");
    }

    #[test]
    fn a_run_without_two_waves_says_which_one_is_left() {
        let say = |u_p: f64, u_s: f64| finding(&[copper()], 1.35, u_p, u_s, None);
        assert_eq!(say(300.0, 1119.0), None);
        assert_eq!(say(50.0, f64::NAN), None);
        assert!(say(15.0, 2700.0).unwrap().starts_with("elastic: the front runs with 2700 m/s"));
        assert!(say(850.0, 3060.0).unwrap().starts_with("overdriven: "));
    }

    #[test]
    fn in_a_medium_of_several_solids_all_must_refuse() {
        let mut soft = copper();
        soft.strength = Strength::PerfectPlastic { shear_modulus: 43e9, yield_strength: 0.05e9 };
        let mut fluid = copper();
        fluid.strength = Strength::Fluid;
        let says = |materials: &[Material], u_p| refusal(materials, 1.35, u_p).map(|(message, _)| message);
        assert!(says(&[copper(), soft.clone()], 8.0).is_none(), "pores in the softer one shut");
        assert!(says(&[copper(), soft.clone()], 1.0).unwrap().contains("0.27 GPa"), "the words of the first");
        assert!(says(&[copper(), fluid], 8.0).is_none());
        for materials in [[copper(), soft.clone()], [soft, copper()]] {
            let slow = finding(&materials, 1.35, 15.0, 2700.0, None).unwrap();
            assert!(
                slow.starts_with("elastic: ") && slow.contains("0.27 GPa"),
                "copper alone holds the wave: {slow}"
            );
        }
    }

    #[test]
    fn a_solid_has_its_own_limit_and_a_fluid_none() {
        let limit = limiting_particle_velocity(&copper(), 1.0).unwrap();
        assert_eq!(limit, overdriven_threshold(&copper()).unwrap());
        let mut fluid = copper();
        fluid.strength = Strength::Fluid;
        assert_eq!(limiting_particle_velocity(&fluid, 1.35), None);
    }
}
