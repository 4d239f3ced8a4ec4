//! Published shock Hugoniot of the porous copper of the shipped case, to lay beside a computed one.
//!
//! ```text
//! u_s = 226.8 + 1.886 u_p      (u_p ≤ 130),      u_s = 14.58 + 3.573 u_p - 0.0003967 u_p²      (u_p > 130)
//! ```
//!
//! in m/s, for m = 1.35, two pores of 4.06 µm in a cell of 20 µm, up to about 600 m/s.
//!
//! Source: Rublev & Murzov, arXiv 2410.14646, section 4, figure 8.

use crate::config::case::{Case, Pores};

/// u_p up to which the first of the two fits holds [m/s].
pub const KINK: f64 = 130.0;
/// u_p up to which the second fit holds [m/s].
pub const LIMIT: f64 = 600.0;

/// The published shock velocity [m/s] at u_p [m/s].
pub fn published_fit(particle_velocity: f64) -> f64 {
    let u = particle_velocity;
    if u <= KINK { 226.8 + 1.886 * u } else { 14.58 + 3.573 * u - 0.0003967 * u * u }
}

/// True for the medium that the published fit belongs to.
pub fn is_published_medium(case: &Case) -> bool {
    let medium = &case.medium;
    case.single_material().is_some()
        && medium.pores == Pores::CenteredSquare
        && !medium.has_other_voids()
        && (medium.porosity - 1.35).abs() < 0.005
        && (medium.cell - 20e-6).abs() < 1e-9
        && (medium.height - 20e-6).abs() < 1e-9
        && case.material.name == "porous-copper"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fit_has_its_published_values() {
        for (u_p, u_s) in [(50.0, 321.1), (100.0, 415.4), (150.0, 541.6), (250.0, 883.0), (300.0, 1050.8)] {
            assert!((published_fit(u_p) - u_s).abs() < 0.06, "{u_p}: {}", published_fit(u_p));
        }
    }

    #[test]
    fn only_the_shipped_medium_is_compared() {
        let read = |text: &str| crate::config::parse(text, "case.ron").unwrap();
        let text = crate::template::text("porous-copper").unwrap();
        assert!(is_published_medium(&read(text)));
        assert!(!is_published_medium(&read(&text.replace("porosity: 1.35", "porosity: 1.37"))));
    }
}
