//! Samples at random: porosity as near as whole shells allow, mass exact, the pores of a cell alike.

use glam::DVec2;
use proptest::prelude::*;
use sph_hugoniot::config::case::{Medium, Packing, Pores};
use sph_hugoniot::microstructure::build;

fn medium() -> impl Strategy<Value = Medium> {
    let pores = prop_oneof![Just(Pores::Square), Just(Pores::CenteredSquare)];
    let packing = prop_oneof![Just(Packing::Square), Just(Packing::Hexagonal)];
    // Pores of the centered lattice touch at m = 4.66, of the square one at the same.
    (pores, packing, 1.02..2.5f64, 4..40usize).prop_map(|(pores, packing, porosity, half)| {
        let cell = 20e-6;
        let solid = 1.0 - 1.0 / porosity;
        let radius = cell * (solid / (pores.count() as f64 * std::f64::consts::PI)).sqrt();
        Medium::with_lattice(DVec2::splat(cell), pores, radius, porosity, cell / (2 * half) as f64, packing)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn porosity_is_met_within_a_shell(medium in medium()) {
        let sample = build(&medium, &[8960.0]);
        let lattice = sample.particles.len() as f64 * sample.porosity;
        let wanted = lattice / medium.porosity;
        // A shell of a pore has at most 16 points here; half of it is missed at worst.
        let allowed = 8.0 * medium.pores.count() as f64;
        prop_assert!((sample.particles.len() as f64 - wanted).abs() <= allowed, "{} of {wanted}", sample.particles.len());
    }

    #[test]
    fn mass_and_order_are_exact(medium in medium()) {
        let sample = build(&medium, &[8960.0]);
        let mass: f64 = sample.particles.iter().map(|p| p.mass).sum();
        prop_assert!((mass / (medium.cell * medium.cell) / sample.bulk_density() - 1.0).abs() < 1e-12);
        prop_assert!(sample.particles.is_sorted_by(|a, b| a.position.x <= b.position.x));
        prop_assert!(sample.particles.iter().enumerate().all(|(k, p)| p.id == k as u64));
    }

    #[test]
    fn the_two_pores_of_a_cell_are_alike(medium in medium()) {
        prop_assume!(medium.pores == Pores::CenteredSquare && medium.packing == Packing::Square);
        let sample = build(&medium, &[8960.0]);
        let lower = sample.particles.iter().filter(|p| p.position.x < 0.5 * medium.cell).count();
        prop_assert_eq!(2 * lower, sample.particles.len());
    }
}
