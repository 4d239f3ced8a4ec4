//! Samples of every medium: porosity, symmetry, the bits of the shipped one.

use super::*;
use crate::config::case::Pores;

fn medium(pores: Pores, size: f64, packing: Packing) -> Medium {
    let (radius, porosity) = if pores == Pores::None { (0.0, 1.0) } else { (4.06e-6, 1.35) };
    Medium::with_lattice(DVec2::splat(20e-6), pores, radius, porosity, size, packing)
}

#[test]
fn the_published_medium_has_296_of_400_particles() {
    let sample = build(&medium(Pores::CenteredSquare, 1e-6, Packing::Square), &[8960.0]);
    assert_eq!(sample.particles.len(), 296);
    assert!((sample.porosity - 400.0 / 296.0).abs() < 1e-15);
    assert!(sample.cut.0 < 4.06e-6 && 4.06e-6 < sample.cut.1, "{:?}", sample.cut);
    let mass: f64 = sample.particles.iter().map(|p| p.mass).sum();
    assert!((mass / (20e-6 * 20e-6) / sample.bulk_density() - 1.0).abs() < 1e-14);
}

#[test]
fn porosity_is_the_same_at_every_particle_size_and_packing() {
    for packing in [Packing::Square, Packing::Hexagonal] {
        for pores in [Pores::Square, Pores::CenteredSquare, Pores::Hexagonal] {
            for (size, tolerance) in [(2e-6, 0.02), (1e-6, 0.004), (0.5e-6, 0.004), (0.25e-6, 0.004)] {
                let m = build(&medium(pores, size, packing), &[8960.0]).porosity;
                assert!((m - 1.35).abs() < tolerance, "{packing:?} {pores:?} D = {size}: m = {m}");
            }
        }
    }
}

#[test]
fn pores_are_mirror_symmetric_and_alike() {
    for size in [2e-6, 1e-6, 0.5e-6] {
        let sample = build(&medium(Pores::CenteredSquare, size, Packing::Square), &[8960.0]);
        let key = |x: f64, y: f64| {
            let wrap = |v: f64| ((v.rem_euclid(20e-6) / size).floor()) as i64;
            (wrap(x), wrap(y))
        };
        let all: std::collections::HashSet<_> =
            sample.particles.iter().map(|p| key(p.position.x, p.position.y)).collect();
        for p in &sample.particles {
            let (x, y) = (p.position.x, p.position.y);
            assert!(all.contains(&key(10e-6 - x, y)), "mirror");
            assert!(all.contains(&key(y, x)), "turn by 90 degrees and mirror");
            assert!(all.contains(&key(x + 10e-6, y + 10e-6)), "second pore like the first");
        }
    }
}

#[test]
fn the_solid_is_full_and_sorted() {
    for packing in [Packing::Square, Packing::Hexagonal] {
        let sample = build(&medium(Pores::None, 1e-6, packing), &[8960.0]);
        assert_eq!(sample.porosity, 1.0);
        assert!(sample.particles.is_sorted_by(|a, b| a.position.x <= b.position.x));
        assert!(
            sample
                .particles
                .iter()
                .all(|p| (0.0..20e-6).contains(&p.position.x) && (0.0..20e-6).contains(&p.position.y))
        );
        let mass: f64 = sample.particles.iter().map(|p| p.mass).sum();
        assert!((mass / (8960.0 * 4e-10) - 1.0).abs() < 1e-13);
    }
}

/// A medium of the case files, read from its text.
fn read(materials: &str, medium: &str) -> Case {
    let text = format!("Case(name: \"test\", {materials}, medium: ({medium}), points: [\"100 m/s\"])");
    crate::config::parse(&text, "test.ron").unwrap_or_else(|error| panic!("{error}"))
}

const COPPER: &str = "material: Library(name: \"porous-copper\")";
const TWO: &str = "materials: [Library(name: \"porous-copper\"), Library(name: \"aluminium-riemann\", called: \"aluminum\")]";

#[test]
fn random_pores_meet_the_porosity_to_a_particle_at_every_size() {
    for size in ["2 um", "1 um", "0.5 um"] {
        let pores = "cell: (\"60 um\", \"40 um\"), porosity: 1.35, \
            pores: Random(radius: LogNormal(median: \"4.5 um\", deviation: 0.2), gap: \"4 um\", seed: 3)";
        let case = read(COPPER, &format!("{pores}, particle_size: \"{size}\""));
        let sample = sample(&case);
        let all = sample.porosity * sample.particles.len() as f64;
        assert!((all / 1.35 - sample.particles.len() as f64).abs() <= 0.5, "{size}: m = {}", sample.porosity);
    }
}

#[test]
fn materials_keep_their_densities_and_their_parts_of_the_cell() {
    let medium = "cell: \"40 um\", particle_size: \"1 um\", pores: Square(radius: \"6 um\"), \
        inclusions: [(of: Material(\"aluminum\"), places: Random(radius: Constant(\"4 um\"), count: 4, gap: \"2 um\"))]";
    let medium = medium.replace("pores: Square(radius: \"6 um\")", "pores: None");
    let case = read(TWO, &medium);
    let sample = sample(&case);
    assert_eq!(sample.counts.iter().sum::<usize>(), 1600);
    let wanted = 4.0 * std::f64::consts::PI * 16.0;
    assert!((sample.counts[1] as f64 - wanted).abs() < 1.5, "{} {wanted}", sample.counts[1]);
    for p in &sample.particles {
        let density = case.materials()[usize::from(p.material)].reference_density;
        assert!(p.density == density && (p.mass / (density * 1e-12) - 1.0).abs() < 1e-12);
    }
    let mass: f64 = sample.particles.iter().map(|p| p.mass).sum();
    assert!((sample.bulk_density() * 1600e-12 / mass - 1.0).abs() < 1e-12);
}

#[test]
fn layers_are_whole_columns_and_shapes_cut_through_them() {
    let medium = "cell: (\"30 um\", \"20 um\"), particle_size: \"1 um\", \
        layers: [(thickness: \"10 um\", of: Material(\"aluminum\")), (thickness: \"20 um\", of: Material(\"porous-copper\"))], \
        shapes: [Rectangle(lower: (\"5 um\", \"5 um\"), upper: (\"15 um\", \"10 um\"))]";
    let sample = sample(&read(TWO, medium));
    assert_eq!(sample.counts, [400 - 25, 200 - 25]);
    assert!(sample.particles.iter().all(|p| (p.position.x < 10e-6) == (p.material == 1)));
    assert!((sample.porosity - 600.0 / 550.0).abs() < 1e-12);
}

#[test]
fn a_relaxed_packing_keeps_mass_and_follows_the_pores() {
    let medium = "cell: \"20 um\", pores: CenteredSquare(), porosity: 1.35, particle_size: \"0.5 um\", packing: Relaxed";
    let case = read(COPPER, medium);
    let sample = sample(&case);
    assert_eq!(sample.particles.len(), 1184);
    let uniformity = sample.uniformity.unwrap();
    assert!(uniformity.relaxed < 0.3 * uniformity.jittered && uniformity.relaxed < 0.01, "{uniformity:?}");
    assert!(uniformity.surface.1 < 0.5 * uniformity.surface.0, "{uniformity:?}");
    let cell = case.medium.cell_size();
    assert!(sample.particles.iter().all(|p| case.medium.layout.level(Fill::Void, p.position, cell) > 0.0));
    let nearest = sample.particles.iter().enumerate().map(|(k, a)| {
        let others = sample.particles.iter().enumerate().filter(|(i, _)| *i != k);
        others.map(|(_, b)| (a.position - b.position).length()).fold(f64::INFINITY, f64::min)
    });
    assert!(nearest.fold(f64::INFINITY, f64::min) > 0.7 * 0.5e-6);
}

#[test]
fn pores_that_overlap_are_one_void_and_that_is_told() {
    let circles = "cell: \"20 um\", particle_size: \"1 um\", shapes: [\
        Circle(center: (\"8 um\", \"10 um\"), radius: \"4 um\"), Circle(center: (\"13 um\", \"10 um\"), radius: \"4 um\")]";
    let told = |medium: &str| {
        let case = read(COPPER, medium);
        let features = measure::features(&case.medium);
        (features, measure::warnings(&case.medium, &sample(&case), &features))
    };
    let (features, warnings) = told(circles);
    assert_eq!(features.pores, 1);
    // From the right end of one to the left end of its image: 20 - 13 µm.
    assert!((features.smallest_gap.unwrap() - 7.0).abs() < 0.3, "{features:?}");
    assert!(
        warnings.len() == 1 && warnings[0].contains("overlap") && warnings[0].contains("(13 um, 10 um)"),
        "{warnings:?}"
    );
    let (features, warnings) = told(&circles.replace("13 um", "17 um"));
    assert!(features.pores == 2 && warnings.iter().all(|w| !w.contains("overlap")), "{warnings:?}");
}
