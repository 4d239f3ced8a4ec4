//! A plane longitudinal wave obliquely to the lattice, and on jittered clouds.
//!
//! Elastic copper, G = 59.1159 GPa, c_l = 5099.30 m/s. A traveling sine wave of 0.05 m/s in a periodic square box of n × n
//! particles goes two periods; θ = 0.6. Directions: along a row (`0-deg`: one wavelength in the box), `45-deg` (one
//! along each edge), `27-deg` (two along x, one along y). Jitter: each particle displaced at the start by a random
//! vector within ± j D along each axis, j = 0.05 to 0.2, mass unchanged, the wave along a row. `closed-…`: the same with the
//! default scheme and closed faces, the program's cure of disorder.
//!
//! Measured: the mean over the particles of |u - exact|, in % of the amplitude, at their places.
//!
//! Reference: exact, d'Alembert's solution. At 0.05 m/s the neglected steepening is 0.02 % of the amplitude.

use std::f64::consts::TAU;

use glam::DVec2;
use sph_core::{Dim2, Domain, Particles};
use sph_io::plot::{Axis, Figure, Series};
use sph_materials::Material;
use sph_riemann::{FaceClosure, PackingReference, VolumeConsistency};

use super::{About, Drawing, Picture, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::{Curve, Outcome};
use crate::plots;
use crate::run::{Run, material, particle_at};
use crate::watch::Watch;

/// Edge of the box [m].
const LENGTH: f64 = 0.01;
const AMPLITUDE: f64 = 0.05;
const PERIODS: f64 = 2.0;
const SMOOTHING: f64 = 0.6;

/// Mean of |u - exact| over the amplitude.
const VELOCITY_L1: Metric = Metric::norm("velocity_l1", "% of u_0");

/// A direction (wavelengths along x and y) and a jitter [D].
struct Problem {
    variant: &'static str,
    waves: [f64; 2],
    jitter: f64,
    /// Whether the faces between particles are closed.
    closed: bool,
}

const fn problem(variant: &'static str, waves: [f64; 2], jitter: f64) -> Problem {
    Problem { variant, waves, jitter, closed: false }
}

const PROBLEMS: [Problem; 9] = [
    problem("0-deg", [1.0, 0.0], 0.0),
    problem("27-deg", [2.0, 1.0], 0.0),
    problem("45-deg", [1.0, 1.0], 0.0),
    problem("jitter-0.05", [1.0, 0.0], 0.05),
    problem("jitter-0.10", [1.0, 0.0], 0.10),
    problem("jitter-0.15", [1.0, 0.0], 0.15),
    problem("jitter-0.20", [1.0, 0.0], 0.20),
    Problem { closed: true, ..problem("closed-0.10", [1.0, 0.0], 0.10) },
    Problem { closed: true, ..problem("closed-0.20", [1.0, 0.0], 0.20) },
];

/// The suite.
pub struct Acoustic;

impl Suite for Acoustic {
    fn about(&self) -> About {
        About {
            name: "acoustic",
            title: "Plane waves: oblique, and on jittered clouds",
            resolution: "particles along an edge of the box",
            reference: ReferenceKind::Analytic,
            gates: include_str!("../../validation/acoustic/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let (problems, resolutions): (Vec<&Problem>, &[u32]) = match tier {
            Tier::Quick => (PROBLEMS[..7].iter().step_by(2).collect(), &[24]),
            Tier::Full => (PROBLEMS.iter().collect(), &[24, 48, 96]),
        };
        let grid = |problem: &Problem| {
            let schemes = if problem.closed { &[SchemeName::TkcHancock] } else { &SchemeName::ALL[..] };
            Case::grid_of("acoustic", problem.variant, schemes, resolutions)
        };
        problems.into_iter().flat_map(grid).collect()
    }

    fn work(&self, case: &Case) -> f64 {
        let n = f64::from(case.n);
        let problem = Problem::of(case);
        let price = case.scheme.price() * if problem.closed { 2.5 } else { 1.0 };
        n * n * PERIODS * n / problem.count() / case.scheme.courant() * price
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let problem = Problem::of(case);
        let copper = material("copper-sound-wave")?;
        let wave = Wave::new(problem, &copper);
        let domain = Domain::new([0.0; 2].into(), [LENGTH; 2].into(), [true; 2]);
        let mut settings = case.scheme.settings();
        settings.smoothing = SMOOTHING;
        settings.face_closure = problem.closed.then(FaceClosure::default);
        if problem.closed {
            // Sums of a cloud scatter: each particle is held against its own first one.
            let reference = PackingReference::Start;
            settings.volume_consistency =
                Some(VolumeConsistency { reference, ..VolumeConsistency::default() });
        }
        let particles = particles(case.n, problem, &wave, &copper);
        let mut run = Run::new(case, watch, domain, copper, particles, settings)?;
        let time = PERIODS * wave.period();
        run.advance(time)?;
        let particles = run.simulation.particles();
        let error =
            |i: usize| (particles.velocity_of(i) - wave.velocity(particles.position_of(i), time)).length();
        let mean = (0..particles.len()).map(error).sum::<f64>() / particles.len() as f64;
        let percent = 100.0 * mean / AMPLITUDE;
        let curves = vec![Curve::new("jitter", vec![(problem.jitter, percent)])];
        Ok(run.outcome(vec![Measurement::error_of(VELOCITY_L1, percent)], curves, Vec::new()))
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let about = self.about();
        let (oblique, jittered): (Vec<&Outcome>, Vec<&Outcome>) =
            outcomes.iter().partition(|outcome| Problem::of(&outcome.case).jitter == 0.0);
        let mut pictures = Vec::new();
        if !oblique.is_empty() {
            pictures.push(Picture {
                name: "acoustic-directions".into(),
                caption: "error of a wave along three directions of the lattice over the resolution".into(),
                drawing: Drawing::Plot(plots::convergence(&about, &oblique, &VELOCITY_L1)),
            });
        }
        if !jittered.is_empty() {
            pictures.push(jitter_picture(outcomes));
        }
        Ok(pictures)
    }
}

/// Error over jitter, each scheme at its finest resolution.
fn jitter_picture(outcomes: &[&Outcome]) -> Picture {
    let along_row = || {
        let is_along = |o: &&&Outcome| Problem::of(&o.case).waves == PROBLEMS[0].waves;
        outcomes.iter().filter(is_along)
    };
    let finest = along_row().map(|o| o.case.n).max().unwrap_or(0);
    let title = format!("Wave on a jittered cloud, {finest} particles a wavelength");
    let y = Axis::log("mean |u - exact| [% of u_0]");
    let mut figure = Figure::new(title, Axis::new("jitter [D]"), y);
    let kinds =
        SchemeName::ALL.map(|scheme| (scheme, false)).into_iter().chain([(SchemeName::TkcHancock, true)]);
    for (scheme, closed) in kinds {
        let is_of_kind = |o: &&&Outcome| {
            let problem = Problem::of(&o.case);
            // Without jitter the faces are closed anyway.
            o.case.scheme == scheme
                && o.case.n == finest
                && (problem.closed == closed || problem.jitter == 0.0)
        };
        let of_kind = along_row().filter(is_of_kind);
        let points: Vec<(f64, f64)> = of_kind.filter_map(|o| o.curve("jitter").first().copied()).collect();
        if !points.is_empty() {
            let label = format!("{}{}", scheme.title(), if closed { ", closed faces" } else { "" });
            figure = figure.with(plots::line(Series::line_with_points, &label, &points));
        }
    }
    Picture {
        name: "acoustic-jitter".into(),
        caption: "error of a wave over the jitter of the particles".into(),
        drawing: Drawing::Plot(figure),
    }
}

impl Problem {
    fn of(case: &Case) -> &'static Self {
        PROBLEMS.iter().find(|problem| problem.variant == case.variant).unwrap_or(&PROBLEMS[0])
    }

    /// Wavelengths in an edge of the box, along the wave.
    fn count(&self) -> f64 {
        self.waves[0].hypot(self.waves[1])
    }
}

/// u = u_0 k̂ sin(k·x - ωt).
struct Wave {
    vector: DVec2,
    speed: f64,
}

impl Wave {
    fn new(problem: &Problem, copper: &Material) -> Self {
        let speed = copper.longitudinal_sound_speed(copper.reference_density, 0.0);
        Self { vector: DVec2::from(problem.waves) * (TAU / LENGTH), speed }
    }

    fn direction(&self) -> DVec2 {
        self.vector.normalize()
    }

    fn period(&self) -> f64 {
        TAU / (self.vector.length() * self.speed)
    }

    fn velocity(&self, place: DVec2, time: f64) -> DVec2 {
        let phase = self.vector.dot(place) - self.vector.length() * self.speed * time;
        self.direction() * (AMPLITUDE * phase.sin())
    }
}

/// The lattice or cloud with the wave in it: velocity, and the strain -u/c that goes with it.
fn particles(n: u32, problem: &Problem, wave: &Wave, copper: &Material) -> Particles<Dim2> {
    let size = LENGTH / f64::from(n);
    let (density, shear) = (copper.reference_density, copper.strength.shear_modulus());
    let direction = wave.direction();
    let mut noise = noise(20_240);
    let mut particles = Particles::default();
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let site = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5);
        let shift = DVec2::new(noise(), noise()) * (2.0 * problem.jitter);
        let position = (site + shift) * size;
        let mut particle = particle_at::<Dim2>(particles.len(), position, size, density);
        particle.velocity = wave.velocity(position, 0.0);
        let strain = -particle.velocity.dot(direction) / wave.speed;
        particle.density = density * (-strain).exp();
        let along = |a: f64, b: f64| 2.0 * shear * strain * a * b;
        let third = 2.0 * shear * strain / 3.0;
        let (x, y) = (direction.x, direction.y);
        particle.deviator = [along(x, x) - third, along(y, y) - third, -third, along(x, y)];
        particles.push(particle);
    }
    particles
}

/// Numbers in ± ½ from a seed: the same in each run.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        // Knuth's linear congruential generator; the high bits are good.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_fit_the_box_and_are_in_balance() {
        let copper = material("copper-sound-wave").expect("in the library");
        for problem in &PROBLEMS {
            let wave = Wave::new(problem, &copper);
            let place = DVec2::new(0.3 * LENGTH, 0.1 * LENGTH);
            for edge in [DVec2::X, DVec2::Y] {
                let there = wave.velocity(place + edge * LENGTH, 0.0);
                assert!((there - wave.velocity(place, 0.0)).length() < 1e-12, "{}", problem.variant);
            }
            let later = wave.velocity(place, wave.period());
            assert!((later - wave.velocity(place, 0.0)).length() < 1e-12);
            let particles = particles(12, problem, &wave, &copper);
            // Traction along the wave: σ = -ρ c u.
            let d = wave.direction();
            for i in 0..particles.len() {
                let s: [f64; 4] = std::array::from_fn(|k| particles.deviator[k][i]);
                let along = s[0] * d.x * d.x + s[1] * d.y * d.y + 2.0 * s[3] * d.x * d.y;
                let stress = along - copper.pressure(particles.density[i], 0.0);
                let exact = -8960.0 * wave.speed * particles.velocity_of(i).dot(d);
                assert!((stress - exact).abs() < 1e-4 * 8960.0 * wave.speed * AMPLITUDE);
            }
        }
    }
}
