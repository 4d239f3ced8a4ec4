//! Up to which u_p a compaction front separates from the elastic precursor.
//!
//! A front that is as fast as the precursor has overrun it: one wave is left, the state ahead of the front is the undisturbed
//! medium, and neither σ_HEL nor the jump Δσ that the product reports exist.
//!
//! The precursor cannot be faster than the longitudinal wave of the stiffest medium of its porosity, in plane strain across
//! parallel pores by the upper bound of Hashin and Hill,
//!
//! \\[ k^* = \frac{(1-\phi)\,k\,G}{G + \phi k}, \qquad
//!    G^* = G + \frac{\phi}{(1-\phi)\frac{k + 2G}{2G(k + G)} - \frac1G}, \qquad
//!    c = \sqrt{(k^* + G^*)/\rho_{00}} \\]
//!
//! with \\( k = K + G/3 \\), \\( \phi = 1 - 1/m \\). The front runs as the jump conditions of shut pores say, and where both
//! are equal lies the limit. It is an upper one: yielding around the pores makes a real precursor slower (2.6 to 2.8 km/s
//! in the shipped case, where the bound says 3.5 km/s). For a solid without pores it is exact (its own two waves).
//!
//! Source of the bounds: Z. Hashin, J. Mech. Phys. Solids 13 (1965) 119; R. Hill, J. Mech. Phys. Solids 12 (1964) 199.

use sph_materials::hugoniot::overdriven_threshold;
use sph_materials::porous::{PorousMedium, Precursor, ShearBehind};
use sph_materials::{Material, Strength};

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

/// What is wrong with a u_p [m/s], if it is too fast for the medium: the message and a hint.
pub fn refusal(material: &Material, porosity: f64, particle_velocity: f64) -> Option<(String, String)> {
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
        assert!(refusal(&copper(), 1.35, 300.0).is_none());
        let (message, hint) = refusal(&copper(), 1.35, 1500.0).unwrap();
        assert!(
            message.contains("overruns the elastic precursor, which runs at 3.5 km/s at most"),
            "{message}"
        );
        assert!(hint.starts_with("below "), "{hint}");
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
