//! Taylor's test: a bar strikes a rigid wall, against the experiments of Wilkins and Guinan.
//!
//! * `copper`: length 23.47 mm, diameter 7.62 mm, 210 m/s; Mie-Grüneisen copper of the porous medium, Y = 0.35 GPa.
//! * `aluminum`: 6061-T6, length 46.94 mm, diameter 7.62 mm, 275 m/s; ρ0 = 2703 kg/m³, c = 5350 m/s, s = 1.34, γ = 2,
//!   G = 27.6 GPa, Y = 0.42 GPa (the constant dynamic strength of Wilkins and Guinan).
//! * `copper-plane`: the copper bar as a plate in plane strain; no measurement, held against its finest run.
//!
//! The wall is the plane in which the bar meets its mirror image: rigid and free of friction by symmetry. Lattice of
//! cubes (squares), n particles along the radius, spacing such that the cross-section has the area of the bar; 70 µs
//! (aluminum 100 µs), θ = 0.7. Perfect plasticity, without failure.
//!
//! Measured: final length over the initial one, radius of the foot over the initial radius (of the first layer, from its
//! outermost particles).
//!
//! Reference: photographs of recovered bars; lengths and radii read from the published profiles, uncertain by about 1 %
//! of the length and 3 % of the radius. The strength is a constant here, while copper hardens: the test asks whether the
//! figures are near, it is not one of convergence.
//!
//! Source: M. L. Wilkins and M. W. Guinan, J. Appl. Phys. 44 (1973) 1200.

use sph_core::{Dim2, Dim3, Dimension, Domain, Particles};
use sph_io::plot::{Axis, Figure, Series};
use sph_materials::eos::MieGruneisen;
use sph_materials::{EquationOfState, Failure, Material, SoundSpeedModel, Strength};
use sph_riemann::SolidDimension;

use super::{About, Drawing, Picture, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::{Curve, Field, Outcome};
use crate::plots;
use crate::run::{Run, material, particle_at};
use crate::watch::Watch;

const RADIUS: f64 = 3.81e-3;
/// The foot stretches the lattice by 2.2 along the wall: at θ = 0.5 a kernel reaches 2 D, the columns of the foot lose each
/// other, and it runs apart without end (2.5 initial radii at n = 6). At 0.7 it reaches 2.8 D.
const SMOOTHING: f64 = 0.7;

/// Final length over the initial one.
const LENGTH: Metric = Metric::value("length_left", "-");
/// Radius of the foot over the initial radius.
const FOOT: Metric = Metric::value("foot_radius", "R_0");

struct Problem {
    variant: &'static str,
    length: f64,
    velocity: f64,
    time: f64,
    /// Measured: final length over the initial one, radius of the foot over the initial one.
    measured: Option<[f64; 2]>,
    /// Profile of the recovered bar [mm]: radius over the distance from the foot.
    profile: &'static [(f64, f64)],
}

const PROBLEMS: [Problem; 3] = [
    Problem {
        variant: "copper",
        length: 23.47e-3,
        velocity: 210.0,
        time: 70e-6,
        measured: Some([0.640, 2.177]),
        profile: &[
            (0.0, 8.294),
            (0.731, 7.368),
            (1.787, 5.735),
            (4.055, 5.020),
            (7.471, 4.525),
            (10.721, 3.948),
            (15.026, 3.81),
        ],
    },
    Problem {
        variant: "aluminum",
        length: 46.94e-3,
        velocity: 275.0,
        time: 100e-6,
        measured: Some([0.816, 1.562]),
        profile: &[
            (0.0, 5.951),
            (1.104, 5.295),
            (2.106, 4.795),
            (3.121, 4.401),
            (4.275, 4.309),
            (6.584, 4.204),
            (9.122, 4.099),
            (10.860, 3.955),
            (12.534, 3.902),
            (15.465, 3.810),
            (22.633, 3.560),
            (29.407, 3.652),
            (34.786, 3.849),
            (38.301, 3.810),
        ],
    },
    Problem { variant: "copper-plane", measured: None, profile: &[], ..COPPER_BAR },
];

const COPPER_BAR: Problem =
    Problem { variant: "", length: 23.47e-3, velocity: 210.0, time: 70e-6, measured: None, profile: &[] };

/// The suite.
pub struct TaylorBar;

impl Suite for TaylorBar {
    fn about(&self) -> About {
        About {
            name: "taylor-bar",
            title: "Taylor bar",
            resolution: "particles along the radius",
            reference: ReferenceKind::External,
            gates: include_str!("../../validation/taylor-bar/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let grid = |problem: &Problem| {
            let resolutions: &[u32] = match (tier, problem.variant) {
                (Tier::Quick, "copper-plane") => &[4],
                (Tier::Quick, _) => &[2, 4],
                (Tier::Full, "copper-plane") => &[4, 8, 16],
                (Tier::Full, _) => &[2, 4, 6],
            };
            let schemes = [SchemeName::Csph, SchemeName::TkcHancock];
            Case::grid_of("taylor-bar", problem.variant, &schemes, resolutions)
        };
        PROBLEMS.iter().flat_map(grid).collect()
    }

    fn work(&self, case: &Case) -> f64 {
        let (problem, n) = (Problem::of(case), f64::from(case.n));
        let size = RADIUS / n;
        let steps = problem.time * 5500.0 / size / case.scheme.courant();
        // A particle-step costs about five times as much in space.
        let section = if problem.is_plane() { 2.0 * n } else { 5.0 * std::f64::consts::PI * n * n };
        2.0 * problem.length / size * section * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let problem = Problem::of(case);
        if problem.is_plane() { run::<Dim2>(case, watch, problem) } else { run::<Dim3>(case, watch, problem) }
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let mut pictures = Vec::new();
        for problem in &PROBLEMS {
            let of = plots::of_variant(outcomes, problem.variant);
            if of.is_empty() {
                continue;
            }
            let title = format!("Taylor bar {}: outline after {:.0} µs", problem.variant, 1e6 * problem.time);
            let mut figure =
                Figure::new(title, Axis::new("distance from the wall [mm]"), Axis::new("radius [mm]"));
            for outcome in &of {
                let label = format!("{}, n = {}", outcome.case.scheme.title(), outcome.case.n);
                figure = figure.with(plots::line(Series::line, &label, outcome.curve("outline")));
            }
            if !problem.profile.is_empty() {
                let measured = plots::line(Series::line_with_points, "experiment", problem.profile);
                figure = figure.with(measured.with_color(plots::BLACK));
            }
            pictures.push(Picture {
                name: format!("taylor-bar-{}", problem.variant),
                caption: "outline of the bar at the end beside the recovered one".into(),
                drawing: Drawing::Plot(figure),
            });
        }
        let side = ((-1.0, 47.0), (-15.0, 15.0));
        pictures.extend(plots::fields("taylor-bar", outcomes, |f| plots::field_image(f, side.0, side.1)));
        Ok(pictures)
    }
}

impl Problem {
    fn of(case: &Case) -> &'static Self {
        PROBLEMS.iter().find(|problem| problem.variant == case.variant).unwrap_or(&PROBLEMS[0])
    }

    fn is_plane(&self) -> bool {
        self.measured.is_none()
    }

    fn material(&self) -> Result<Material, ValidateError> {
        if self.variant != "aluminum" {
            let sound_speed = SoundSpeedModel::Thermodynamic;
            return Ok(Material { failure: Failure::None, sound_speed, ..material("porous-copper")? });
        }
        Ok(Material {
            name: "6061-T6".into(),
            reference_density: 2703.0,
            equation_of_state: EquationOfState::MieGruneisen(MieGruneisen {
                bulk_sound_speed: 5350.0,
                hugoniot_slope: 1.34,
                gruneisen_coefficient: 2.0,
            }),
            strength: Strength::PerfectPlastic { shear_modulus: 27.6e9, yield_strength: 0.42e9 },
            failure: Failure::None,
            sound_speed: SoundSpeedModel::Thermodynamic,
        })
    }
}

fn run<D: SolidDimension>(
    case: &Case,
    watch: Watch<'_>,
    problem: &Problem,
) -> Result<Outcome, ValidateError> {
    let material = problem.material()?;
    let bar = Bar::new(case.n, D::COUNT, problem.length);
    let particles = bar.particles::<D>(material.reference_density, problem.velocity);
    let mut settings = case.scheme.settings();
    settings.smoothing = SMOOTHING;
    let mut run = Run::new(case, watch, Domain::open(), material, particles, settings)?;
    run.advance(problem.time)?;
    let particles = run.simulation.particles();
    let (length, foot) = (bar.length_left(particles), bar.foot(particles));
    let of = |metric, value, k: usize| match problem.measured {
        Some(measured) => Measurement::new(metric, value, measured[k]),
        None => Measurement::against_finest(metric, value),
    };
    let measurements = vec![of(LENGTH, length, 0), of(FOOT, foot, 1)];
    let curves = vec![Curve::new("outline", bar.outline(particles))];
    let field = field(&run, &bar);
    Ok(run.outcome(measurements, curves, vec![field]))
}

/// The lattice of the bar.
struct Bar {
    size: f64,
    /// Places across, in units of the size.
    section: Vec<[f64; 2]>,
    layers: u32,
}

impl Bar {
    fn new(n: u32, dimensions: usize, length: f64) -> Self {
        let half = i64::from(n);
        let middle = |k: i64| k as f64 + 0.5;
        let section: Vec<[f64; 2]> = if dimensions == 2 {
            (-half..half).map(|i| [middle(i), 0.0]).collect()
        } else {
            let sites = (-half..half).flat_map(|i| (-half..half).map(move |j| [middle(i), middle(j)]));
            sites.filter(|[x, y]| x.hypot(*y) < half as f64).collect()
        };
        // The cross-section has the area of the bar.
        let area = if dimensions == 2 { 2.0 * RADIUS } else { std::f64::consts::PI * RADIUS * RADIUS };
        let size = (area / section.len() as f64).powf(1.0 / (dimensions - 1) as f64);
        Self { size, section, layers: (length / size).round() as u32 }
    }

    /// Bar along +x and its mirror image, both towards x = 0. Identifiers of a layer are consecutive.
    fn particles<D: Dimension>(&self, density: f64, velocity: f64) -> Particles<D> {
        let mut particles = Particles::default();
        for side in [1.0, -1.0] {
            for layer in 0..self.layers {
                for place in &self.section {
                    let along = side * (f64::from(layer) + 0.5);
                    let position = D::vector(|a| self.size * if a == 0 { along } else { place[a - 1] });
                    let mut particle = particle_at::<D>(particles.len(), position, self.size, density);
                    particle.velocity = D::vector(|a| if a == 0 { -side * velocity } else { 0.0 });
                    particles.push(particle);
                }
            }
        }
        particles
    }

    fn layer(&self, id: u64) -> u32 {
        (id / self.section.len() as u64) as u32
    }

    /// Distance from the axis and place of the particles of a layer of the bar.
    fn places<D: Dimension>(&self, particles: &Particles<D>, layer: u32) -> Vec<(f64, f64, u64)> {
        let of_layer = (0..particles.len()).filter(|&i| self.layer(particles.id[i]) == layer);
        let across = |i: usize| (1..D::COUNT).map(|a| particles.position[a][i].powi(2)).sum::<f64>().sqrt();
        of_layer.map(|i| (particles.position[0][i], across(i), particles.id[i])).collect()
    }

    /// Greatest distance from the axis of a layer over that at the start.
    fn widening<D: Dimension>(&self, particles: &Particles<D>, layer: u32) -> f64 {
        let start = self.section.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max) * self.size;
        self.places(particles, layer).iter().map(|place| place.1).fold(0.0, f64::max) / start
    }

    /// Radius of the foot over the initial radius.
    fn foot<D: Dimension>(&self, particles: &Particles<D>) -> f64 {
        self.widening(particles, 0)
    }

    /// Mean place of the last layer, half a particle further out, over the initial length.
    fn length_left<D: Dimension>(&self, particles: &Particles<D>) -> f64 {
        let last = self.places(particles, self.layers - 1);
        let mean = last.iter().map(|place| place.0).sum::<f64>() / last.len() as f64;
        (mean + 0.5 * self.size) / (f64::from(self.layers) * self.size)
    }

    /// Radius over the distance from the wall [mm], layer by layer, scaled to the bar's own radius.
    fn outline<D: Dimension>(&self, particles: &Particles<D>) -> Vec<(f64, f64)> {
        let layer = |layer: u32| {
            let places = self.places(particles, layer);
            let outermost = places.iter().map(|place| place.1).fold(0.0, f64::max);
            let rim = places.iter().filter(|place| place.1 > 0.9 * outermost);
            let (count, sum) = rim.fold((0.0, 0.0), |(count, sum), place| (count + 1.0, sum + place.0));
            (1e3 * sum / count, 1e3 * RADIUS * self.widening(particles, layer))
        };
        (0..self.layers).map(layer).collect()
    }
}

/// Plastic strain in a plane through the axis.
fn field<D: SolidDimension>(run: &Run<'_, D>, bar: &Bar) -> Field {
    let particles = run.simulation.particles();
    let in_plane = |i: &usize| {
        let place = bar.section[(particles.id[*i] % bar.section.len() as u64) as usize];
        bar.layer(particles.id[*i]) < bar.layers && (D::COUNT == 2 || (place[1] - 0.5).abs() < 0.1)
    };
    let shown: Vec<usize> = (0..particles.len()).filter(in_plane).collect();
    let column = |of: &dyn Fn(usize) -> f64| shown.iter().map(|&i| of(i)).collect();
    Field {
        name: "end".into(),
        title: format!(
            "{} {}, n = {}, {:.0} µs",
            run.case.variant,
            run.case.scheme.title(),
            run.case.n,
            1e6 * run.simulation.time()
        ),
        label: "plastic strain [-]".into(),
        range: (0.0, 2.0),
        x: column(&|i| 1e3 * particles.position[0][i]),
        y: column(&|i| 1e3 * particles.position[1][i]),
        size: column(&|_| 1e3 * bar.size),
        values: column(&|i| particles.plastic_strain[i]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bar_has_its_mass_and_no_momentum() {
        let bar = Bar::new(4, 3, 23.47e-3);
        let particles = bar.particles::<Dim3>(8960.0, 210.0);
        let mass: f64 = particles.mass.iter().sum();
        let exact = 2.0 * 8960.0 * std::f64::consts::PI * RADIUS * RADIUS * 23.47e-3;
        assert!((mass / exact - 1.0).abs() < 0.02, "{mass} {exact}");
        let momentum: f64 = (0..particles.len()).map(|i| particles.mass[i] * particles.velocity[0][i]).sum();
        assert!(momentum.abs() < 1e-9 * mass * 210.0);
        assert!((bar.length_left(&particles) - 1.0).abs() < 1e-12);
        assert!((bar.foot(&particles) - 1.0).abs() < 1e-12);
    }

    /// Wilkins and Guinan: L/L0 = (1 - h) exp(-ρ U²/2Y) + h, h = 0.12, fits their bars; so the readings are theirs.
    #[test]
    fn lengths_read_from_the_profiles_follow_the_published_fit() {
        for problem in PROBLEMS.iter().filter(|problem| !problem.is_plane()) {
            let material = problem.material().expect("a material");
            let (density, yield_strength) = (material.reference_density, material.strength.yield_strength());
            let fit = 0.88 * (-density * problem.velocity.powi(2) / (2.0 * yield_strength)).exp() + 0.12;
            let [length, foot] = problem.measured.expect("an experiment");
            assert!((fit / length - 1.0).abs() < 0.04, "{}: {fit} {length}", problem.variant);
            let profile = problem.profile;
            assert!((profile[0].1 / 3.81 - foot).abs() < 2e-3);
            assert!((profile[profile.len() - 1].0 / (1e3 * problem.length) - length).abs() < 2e-3);
        }
    }
}
