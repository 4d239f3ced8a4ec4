//! Media at random: whatever the seed, the sizes and the porosity, shapes keep their gaps across the sides of the cell and the
//! porosity is met to a particle; or the case is refused with a named reason.

use glam::DVec2;
use proptest::prelude::*;
use sph_hugoniot::config;
use sph_hugoniot::config::case::Case;
use sph_hugoniot::microstructure::sample;
use sph_hugoniot::microstructure::shape::Shape;

/// Micron [m].
const MICRON: f64 = 1e-6;
/// What a refusal of shapes at random may say.
const REASONS: [&str; 5] = [
    "found a place: the cell is full at",
    "takes",
    "does not fit into the cell",
    "would be needed",
    "is out of range",
];

/// What is asked for; lengths in microns.
#[derive(Clone, Debug)]
struct Wanted {
    sizes: String,
    cell: (u32, u32),
    gap: f64,
    aspect: f64,
    angle: &'static str,
    seed: u64,
    porosity: f64,
    particle_size: f64,
}

impl Wanted {
    fn read(&self, porosity: &str) -> Result<Case, config::CaseError> {
        let Self { sizes, cell, gap, aspect, angle, seed, particle_size, .. } = self;
        let text = format!(
            "Case(name: \"random\", material: Library(name: \"porous-copper\"), points: [\"200 m/s\"], window: (length: Cells(12)), \
             medium: (cell: (\"{} um\", \"{} um\"), particle_size: \"{particle_size} um\", {porosity} \
             pores: Random(radius: {sizes}, gap: \"{gap} um\", aspect: {aspect}, angle: {angle}, seed: {seed})))",
            cell.0, cell.1
        );
        config::parse(&text, "random.ron")
    }
}

fn sizes() -> impl Strategy<Value = String> {
    let radius = 2.0..6.0f64;
    prop_oneof![
        radius.clone().prop_map(|r| format!("Constant(\"{r} um\")")),
        (radius.clone(), 0.0..0.4f64)
            .prop_map(|(r, part)| format!("Normal(mean: \"{r} um\", deviation: \"{} um\")", part * r)),
        (radius, 0.0..0.5f64)
            .prop_map(|(r, deviation)| format!("LogNormal(median: \"{r} um\", deviation: {deviation})")),
    ]
}

fn wanted() -> impl Strategy<Value = Wanted> {
    let cell = (10..25u32, 10..25u32).prop_map(|(x, y)| (2 * x, 2 * y));
    let shape = (prop_oneof![Just(1.0), 0.3..1.0f64], prop_oneof![Just("Random"), Just("Degrees(30)")]);
    let size = prop_oneof![Just(0.5), Just(1.0), Just(2.0)];
    (sizes(), cell, 2.0..5.0f64, shape, any::<u64>(), 1.02..2.2f64, size).prop_map(
        |(sizes, cell, gap, (aspect, angle), seed, porosity, particle_size)| {
            // RON reads whole numbers up to 2^63 here.
            Wanted { sizes, cell, gap, aspect, angle, seed: seed >> 1, porosity, particle_size }
        },
    )
}

/// Center, half axes and direction of a circle or an ellipse.
fn axes(shape: &Shape) -> (DVec2, DVec2, DVec2) {
    match *shape {
        Shape::Circle { center, radius } => (center, DVec2::splat(radius), DVec2::X),
        Shape::Ellipse { center, semi_axes, direction } => (center, semi_axes, direction),
        ref other => panic!("{other:?}"),
    }
}

/// Points of the outline, by its equation alone.
fn outline(shape: &Shape) -> impl Iterator<Item = DVec2> + '_ {
    let (center, semi_axes, direction) = axes(shape);
    (0..48).map(move |k| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 48.0).sin_cos();
        center + direction * (semi_axes.x * cos) + direction.perp() * (semi_axes.y * sin)
    })
}

/// True if a point lies in a shape grown by `gap` along its axes, which holds all points nearer than the gap on the axes and
/// no point farther than the gap.
fn is_near(point: DVec2, shape: &Shape, gap: f64) -> bool {
    let (center, semi_axes, direction) = axes(shape);
    let offset = point - center;
    let own = DVec2::new(offset.dot(direction), offset.dot(direction.perp()));
    (own / (semi_axes + gap)).length() < 1.0
}

fn gaps_are_kept(shapes: &[Shape], cell: DVec2, gap: f64) -> Result<(), TestCaseError> {
    for (k, a) in shapes.iter().enumerate() {
        for (i, b) in shapes.iter().enumerate() {
            for image in (-1..=1).flat_map(|x| (-1..=1).map(move |y| DVec2::new(f64::from(x), f64::from(y))))
            {
                if k == i && image == DVec2::ZERO {
                    continue;
                }
                let near = outline(a).find(|p| is_near(*p + image * cell, b, 0.98 * gap));
                prop_assert!(near.is_none(), "{a:?} and {b:?}, image {image}");
            }
        }
    }
    Ok(())
}

/// A refusal is one fault, one of those that are known, with a hint.
fn is_a_named_reason(error: &config::CaseError) -> Result<(), TestCaseError> {
    let (fault, shown) = (&error.faults[0], error.render(false));
    prop_assert!(error.faults.len() == 1, "{shown}");
    prop_assert!(REASONS.iter().any(|r| fault.message.contains(r)) && fault.hint.is_some(), "{shown}");
    Ok(())
}

fn pores(case: &Case) -> Vec<Shape> {
    case.medium.layout.painted.iter().map(|p| p.shape.clone()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn pores_keep_their_gaps_and_the_porosity_is_met_or_the_reason_is_named(wanted in wanted()) {
        let case = match wanted.read(&format!("porosity: {},", wanted.porosity)) {
            Ok(case) => case,
            Err(error) => return is_a_named_reason(&error),
        };
        let cell = case.medium.cell_size();
        gaps_are_kept(&pores(&case), cell, wanted.gap * MICRON)?;
        let sample = sample(&case);
        let all = (cell.x * cell.y / (wanted.particle_size * MICRON).powi(2)).round();
        prop_assert_eq!((all / sample.porosity).round(), sample.particles.len() as f64);
        let missed = sample.particles.len() as f64 - all / wanted.porosity;
        prop_assert!(missed.abs() <= 1.0, "{missed} particles of {all}");
        prop_assert!(sample.particles.iter().all(|p| p.position.cmpge(DVec2::ZERO).all() && p.position.cmplt(cell).all()));
    }

    #[test]
    fn listed_radii_are_all_there(radii in prop::collection::vec(1.0..4.0f64, 1..8), wanted in wanted()) {
        let list: Vec<String> = radii.iter().map(|r| format!("\"{r} um\"")).collect();
        let wanted = Wanted { sizes: format!("Listed([{}])", list.join(", ")), ..wanted };
        let case = match wanted.read("") {
            Ok(case) => case,
            Err(error) => return is_a_named_reason(&error),
        };
        let shapes = pores(&case);
        let area = |r: f64| std::f64::consts::PI * r * r;
        let mut found: Vec<f64> = shapes.iter().map(|s| s.area(0.0) / (MICRON * MICRON)).collect();
        let mut expected: Vec<f64> = radii.iter().map(|&r| area(r)).collect();
        found.sort_by(f64::total_cmp);
        expected.sort_by(f64::total_cmp);
        prop_assert_eq!(found.len(), expected.len());
        prop_assert!(found.iter().zip(&expected).all(|(a, b)| (a / b - 1.0).abs() < 1e-9), "{found:?} {expected:?}");
        let cell = case.medium.cell_size();
        gaps_are_kept(&shapes, cell, wanted.gap * MICRON)?;
        // The porosity follows from the areas, measured on a grid.
        let share = expected.iter().sum::<f64>() * MICRON * MICRON / (cell.x * cell.y);
        prop_assert!((case.medium.porosity * (1.0 - share) - 1.0).abs() < 2e-3, "{} {share}", case.medium.porosity);
    }
}
