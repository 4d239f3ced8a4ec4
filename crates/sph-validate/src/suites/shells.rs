//! Shells that collapse to other radii, on another lattice, of another metal, and in space.
//!
//! R0 = 80 mm, R1 = 100 mm, n particles across the wall (D0 = 20 mm / n), both surfaces free, u = -U0 (R0/r)^(d-1), θ = 0.5, in the
//! plane 0.65 where the inner layers part by nearly 2 (`beryllium-40`).
//! U0 is the velocity that stops a rigid-plastic shell at the radius in the name of the variant:
//!
//! * `aluminum-60`, `aluminum-50`: Verney's aluminum, rings of particles;
//! * `aluminum-square`: the shell of the suite `verny` (U0 = 208.55 m/s) cut out of a square lattice;
//! * `beryllium-40`: beryllium, 40 mm, rings;
//! * `sphere-40`: a hollow sphere of beryllium in space, 40 mm, cut out of a cubic lattice.
//!
//! Beryllium: ρ0 = 1845 kg/m³, G = 151 GPa, Y = 0.33 GPa. Howell and Ball have Osborne's equation of state; here it is
//! linear with a thermal part, with the bulk modulus (118.9 GPa) and the thermal coefficient of Osborne's at rest.
//! The stop depends on it little: the shell is nearly incompressible.
//!
//! Measured: the inner radius at the stop from the mean of r^d over all of the material, and the time of the stop.
//!
//! Reference: the same shell on a Lagrangian mesh of 400 zones, read likewise.
//!
//! Source: B. P. Howell and G. J. Ball, J. Comput. Phys. 175 (2002) 128; J. R. Kamm, J. S. Brock et al., Enhanced
//! Verification Test Suite for Physics Simulation Codes, LA-14379, SAND2008-7813 (2009).

use sph_core::geometry::{Lattice, Packing, concentric_rings};
use sph_core::{CoreError, Dim2, Dim3, Dimension, Domain, Particle, Particles, Vector};
use sph_io::plot::{Axis, Figure, Series};
use sph_materials::eos::LinearGamma;
use sph_materials::{EquationOfState, Failure, Material, SoundSpeedModel, Strength};
use sph_riemann::SolidDimension;

use super::{About, Drawing, Picture, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::{Curve, Outcome};
use crate::plots;
use crate::reference::lagrangian::{Ends, Mesh, Scheme, Solid, Symmetry, Viscosity, Zone};
use crate::reference::verney::{Shell, Sphere};
use crate::run::{Run, material};
use crate::watch::Watch;

const INNER: f64 = 0.08;
const OUTER: f64 = 0.1;
/// Smoothing of a wall that thickens little.
const SMOOTHING: f64 = 0.5;
/// Smoothing of a wall whose inner layers part by nearly 2: at θ = 0.5 a kernel reaches 2 D, and the layers would lose each
/// other.
const WIDE_SMOOTHING: f64 = 0.65;
const ZONES: usize = 400;
/// How long the reading must have risen again [s].
const AFTER_STOP: f64 = 6e-6;
/// A shell that still moves inwards now does not stop [s].
const LATEST_STOP: f64 = 400e-6;

/// Inner radius at the stop.
const STOP_RADIUS: Metric = Metric::value("stop_radius", "mm");
/// The same, off the reference.
const STOP_RADIUS_ERROR: Metric = Metric::value("stop_radius_error", "%");
/// Time of the stop.
const STOP_TIME: Metric = Metric::value("stop_time", "us");

/// How the wall is filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Filling {
    Rings,
    Square,
    Cubic,
}

struct Problem {
    variant: &'static str,
    beryllium: bool,
    filling: Filling,
    /// Radius at which a rigid-plastic shell stops [m]; 0 for the shell of the suite `verny`.
    stop: f64,
}

const PROBLEMS: [Problem; 5] = [
    Problem { variant: "aluminum-60", beryllium: false, filling: Filling::Rings, stop: 0.06 },
    Problem { variant: "aluminum-50", beryllium: false, filling: Filling::Rings, stop: 0.05 },
    Problem { variant: "aluminum-square", beryllium: false, filling: Filling::Square, stop: 0.0 },
    Problem { variant: "beryllium-40", beryllium: true, filling: Filling::Rings, stop: 0.04 },
    Problem { variant: "sphere-40", beryllium: true, filling: Filling::Cubic, stop: 0.04 },
];

/// The suite.
pub struct Shells;

impl Suite for Shells {
    fn about(&self) -> About {
        About {
            name: "shells",
            title: "Collapsing shells: other radii, lattice, metal; sphere",
            resolution: "particles across the wall (D0 = 20 mm / n)",
            reference: ReferenceKind::External,
            gates: include_str!("../../validation/shells/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let grid = |problem: &Problem| {
            let resolutions: &[u32] = match (tier, problem.filling) {
                (Tier::Quick, Filling::Cubic) => &[],
                (Tier::Quick, _) => &[5],
                (Tier::Full, Filling::Cubic) => &[3, 4, 5],
                (Tier::Full, _) => &[5, 10, 20],
            };
            // Printed, the second scheme costs eight times the third; here it shows what `verny` shows.
            let schemes: &[SchemeName] = match problem.filling {
                Filling::Square => &SchemeName::ALL,
                _ => &[SchemeName::Csph, SchemeName::TkcHancock],
            };
            Case::grid_of("shells", problem.variant, schemes, resolutions)
        };
        PROBLEMS.iter().flat_map(grid).collect()
    }

    fn work(&self, case: &Case) -> f64 {
        let (problem, n) = (Problem::of(case), f64::from(case.n));
        let speed = if problem.beryllium { 13_200.0 } else { 6_400.0 };
        let steps = 180e-6 * speed * n / (OUTER - INNER) / case.scheme.courant();
        let particles = match problem.filling {
            // A particle-step costs about five times as much in space.
            Filling::Cubic => 5.0 * 255.0 * n * n * n,
            _ => 9.0 * std::f64::consts::PI * n * n,
        };
        particles * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let problem = Problem::of(case);
        let size = (OUTER - INNER) / f64::from(case.n);
        let packing =
            |error: CoreError| ValidateError::Packing { case: case.to_string(), reason: error.to_string() };
        match problem.filling {
            Filling::Rings => {
                let rings = concentric_rings(Default::default(), INNER, OUTER, size).map_err(packing)?;
                run::<Dim2>(case, watch, problem, rings)
            }
            Filling::Square => {
                run::<Dim2>(case, watch, problem, cut(Lattice::Square, size).map_err(packing)?)
            }
            Filling::Cubic => run::<Dim3>(case, watch, problem, cut(Lattice::Cubic, size).map_err(packing)?),
        }
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let mut pictures = Vec::new();
        for problem in &PROBLEMS {
            let of = plots::of_variant(outcomes, problem.variant);
            if of.is_empty() {
                continue;
            }
            let title = format!("Shell {}: inner radius", problem.variant);
            let figure = Figure::new(title, Axis::new("t [µs]"), Axis::new("r_0 [mm]"));
            let mesh = of[0].curve("reference");
            pictures.push(Picture {
                name: format!("shells-{}", problem.variant),
                caption: "inner radius over time, from the mean of r^d over all of the material".into(),
                drawing: Drawing::Plot(plots::profiles(figure, &of, "radius", ("1-D mesh", mesh))),
            });
        }
        pictures.push(errors_picture(outcomes));
        Ok(pictures)
    }
}

/// Distance from the reference over the particle size, all variants of the default scheme.
fn errors_picture(outcomes: &[&Outcome]) -> Picture {
    let hancock: Vec<&Outcome> =
        outcomes.iter().copied().filter(|o| o.case.scheme == SchemeName::TkcHancock).collect();
    let error = |o: &Outcome| o.figure("stop_radius_error").map_or(f64::NAN, |figure| figure.value);
    let title = "TKC-Hancock: inner radius at the stop, off the 1-D mesh";
    let mut figure = Figure::new(title, Axis::new("particles across the wall"), Axis::new("error [%]"));
    for (label, points) in plots::by_kin(&hancock, |o| (f64::from(o.case.n), error(o))) {
        figure = figure.with(plots::line(Series::line_with_points, &label, &points));
    }
    Picture {
        name: "shells".into(),
        caption: "error of the inner radius at the stop over the particles across the wall".into(),
        drawing: Drawing::Plot(figure),
    }
}

impl Problem {
    fn of(case: &Case) -> &'static Self {
        PROBLEMS.iter().find(|problem| problem.variant == case.variant).unwrap_or(&PROBLEMS[0])
    }

    /// By how much the layers at the inner surface part; in the plane, where what is lost around is gained across.
    fn smoothing(&self) -> f64 {
        let stretch = if self.stop > 0.0 { INNER / self.stop } else { 1.2 };
        if self.dimensions() == 2 && stretch > 1.8 { WIDE_SMOOTHING } else { SMOOTHING }
    }

    /// 2 around an axis, 3 around a point.
    fn dimensions(&self) -> i32 {
        if self.filling == Filling::Cubic { 3 } else { 2 }
    }

    fn material(&self) -> Result<Material, ValidateError> {
        if self.beryllium { Ok(beryllium()) } else { material("aluminium-verney") }
    }

    /// U0 [m/s].
    fn velocity(&self, material: &Material) -> f64 {
        let (density, yield_strength) = (material.reference_density, material.strength.yield_strength());
        match self.dimensions() {
            _ if self.stop == 0.0 => 208.55,
            3 => Sphere { inner_radius: INNER, outer_radius: OUTER, density, yield_strength }
                .velocity(self.stop),
            _ => Shell { inner_radius: INNER, outer_radius: OUTER, density, yield_strength }
                .velocity(self.stop),
        }
    }
}

/// Beryllium with the numbers of Howell and Ball, but for the equation of state.
fn beryllium() -> Material {
    Material {
        name: "beryllium".into(),
        reference_density: 1845.0,
        // Osborne: K = a1/E0 = 0.951168/0.8 Mbar, dP/dE = b0/E0 = 0.926914/0.8 at rest.
        equation_of_state: EquationOfState::LinearGamma(LinearGamma {
            bulk_sound_speed: (0.951168e11 / 0.8 / 1845.0_f64).sqrt(),
            gamma: 1.0 + 0.926914 / 0.8,
        }),
        strength: Strength::PerfectPlastic { shear_modulus: 151e9, yield_strength: 0.33e9 },
        failure: Failure::None,
        sound_speed: SoundSpeedModel::Thermodynamic,
    }
}

/// The wall cut out of a lattice about the middle.
fn cut<D: Dimension>(lattice: Lattice, size: f64) -> Result<Packing<D>, CoreError> {
    let half = (OUTER / size).ceil() * size;
    let block = lattice.fill_box::<D>(D::vector(|_| -half), D::vector(|_| half), size)?;
    Ok(block.filtered(|point| (INNER..OUTER).contains(&point.length())))
}

/// Reads the inner radius: R0^d and the change of the mean of r^d, which in an incompressible shell is the same
/// everywhere.
struct Reading {
    d: i32,
    start: f64,
    least: (f64, f64),
    history: Vec<(f64, f64)>,
}

impl Reading {
    fn new(d: i32, start: f64) -> Self {
        Self { d, start, least: (0.0, INNER), history: vec![(0.0, 1e3 * INNER)] }
    }

    fn see(&mut self, time: f64, mean: f64) {
        let radius = (INNER.powi(self.d) + mean - self.start).max(0.0).powf(1.0 / f64::from(self.d));
        if radius < self.least.1 {
            self.least = (time, radius);
        }
        self.history.push((1e6 * time, 1e3 * radius));
    }

    fn is_over(&self, time: f64) -> bool {
        time > self.least.0 + AFTER_STOP && self.least.1 < 0.97 * INNER
    }
}

/// The shell on the mesh.
fn reference(problem: &Problem, material: &Material) -> Reading {
    let pressure = |density: f64, energy: f64| material.pressure(density, energy);
    let solid = Solid::of(material, &pressure);
    let d = problem.dimensions();
    let symmetry = if d == 3 { Symmetry::Spherical } else { Symmetry::Cylindrical };
    let scheme = Scheme { symmetry, ends: Ends::Free, cfl: 0.7, viscosity: Viscosity::default() };
    let rest = Zone { density: material.reference_density, energy: 0.0, deviator: [0.0; 3] };
    let velocity = problem.velocity(material);
    let inwards = |r: f64| -velocity * (INNER / r).powi(d - 1);
    let mut mesh = Mesh::new(solid, scheme, [INNER, OUTER], ZONES, |_| rest, inwards);
    let mut reading = Reading::new(d, mesh.mean_power_of_radius(d));
    while !reading.is_over(mesh.time()) && mesh.time() < LATEST_STOP {
        mesh.step(mesh.time_step());
        reading.see(mesh.time(), mesh.mean_power_of_radius(d));
    }
    // One point in fifty draws the curve.
    reading.history = reading.history.into_iter().step_by(50).collect();
    reading
}

fn run<D: SolidDimension>(
    case: &Case,
    watch: Watch<'_>,
    problem: &Problem,
    packing: Packing<D>,
) -> Result<Outcome, ValidateError> {
    let material = problem.material()?;
    let exact = reference(problem, &material);
    let particles = particles(&packing, material.reference_density, problem.velocity(&material));
    let d = problem.dimensions();
    let mut reading = Reading::new(d, mean_power(&particles, d));
    let mut settings = case.scheme.settings();
    settings.smoothing = problem.smoothing();
    let mut run = Run::new(case, watch, Domain::open(), material, particles, settings)?;
    while !reading.is_over(run.simulation.time()) {
        if run.simulation.time() >= LATEST_STOP {
            let reason = format!("the shell has not stopped after {:.1} us", 1e6 * LATEST_STOP);
            return Err(ValidateError::NotReached { case: case.to_string(), reason });
        }
        run.step(LATEST_STOP)?;
        let time = run.simulation.time();
        reading.see(time, mean_power(run.simulation.particles(), d));
        run.tell(time / (1.05 * exact.least.0 + AFTER_STOP));
    }
    let (radius, exact_radius) = (reading.least.1, exact.least.1);
    let measurements = vec![
        Measurement::new(STOP_RADIUS, 1e3 * radius, 1e3 * exact_radius),
        Measurement::error_of(STOP_RADIUS_ERROR, 100.0 * (radius / exact_radius - 1.0)),
        Measurement::new(STOP_TIME, 1e6 * reading.least.0, 1e6 * exact.least.0),
    ];
    let curves = vec![Curve::new("radius", reading.history), Curve::new("reference", exact.history)];
    Ok(run.outcome(measurements, curves, Vec::new()))
}

fn particles<D: Dimension>(packing: &Packing<D>, density: f64, velocity: f64) -> Particles<D> {
    let mut particles = Particles::default();
    for (point, volume) in packing.points().zip(&packing.volume) {
        let id = particles.len() as u64;
        let mut particle = Particle::at_rest(id, point, density * volume, packing.size, density);
        let radius = point.length();
        particle.velocity = point * (-velocity * (INNER / radius).powi(D::COUNT as i32 - 1) / radius);
        particles.push(particle);
    }
    particles
}

/// Mass-weighted mean of r^d [m^d].
fn mean_power<D: Dimension>(particles: &Particles<D>, d: i32) -> f64 {
    let (mass, sum) = (0..particles.len()).fold((0.0, 0.0), |(mass, sum), i| {
        let m = particles.mass[i];
        (mass + m, sum + m * particles.position_of(i).length().powi(d))
    });
    sum / mass
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The stop lies near that of the rigid-plastic shell: a little further in, since the real one is compressible.
    #[test]
    fn meshes_stop_near_the_rigid_plastic_radius() {
        for problem in &PROBLEMS {
            let material = problem.material().expect("a material");
            let stop = reference(problem, &material).least;
            let formula = if problem.stop == 0.0 { 0.066716 } else { problem.stop };
            println!("{}: {:.4} mm after {:.2} us", problem.variant, 1e3 * stop.1, 1e6 * stop.0);
            assert!((stop.1 / formula - 1.0).abs() < 0.02, "{}: {} m", problem.variant, stop.1);
        }
    }

    #[test]
    fn lattices_have_about_the_mass_of_the_wall() {
        let square = cut::<Dim2>(Lattice::Square, 2e-3).expect("a lattice").total_volume();
        assert!((square / (std::f64::consts::PI * (OUTER.powi(2) - INNER.powi(2))) - 1.0).abs() < 0.01);
        let cubic = cut::<Dim3>(Lattice::Cubic, 5e-3).expect("a lattice").total_volume();
        let wall = 4.0 / 3.0 * std::f64::consts::PI * (OUTER.powi(3) - INNER.powi(3));
        assert!((cubic / wall - 1.0).abs() < 0.03, "{cubic} {wall}");
    }
}
