//! A piston pushes into a solid: elastic precursor and plastic shock, in copper and in aluminum.
//!
//! Copper: Mie-Grüneisen, u_p = 200 m/s, 7.5 µs. Aluminum: linear with a thermal part, u_p = 150 m/s, 6 µs. D = 50 mm / n,
//! θ = 0.5. The piston is the plane in which two equal blocks of 50 mm meet, each with u_p: exact by symmetry, in every
//! scheme. The variant `copper-block` has a block of five columns of imposed velocity in place of the second one, as the
//! outlet of a moving window is: what such a piston costs. The far ends are five frozen columns.
//!
//! Measured: the mean over the particles of |σ_xx - exact|; where both waves are (each crosses the mean of the stresses
//! before and behind it); the stress between piston and plastic wave, in the middle half of it.
//!
//! Reference: exact, the jump conditions of both waves ([`crate::reference::staircase`]).
//!
//! Source: Ya. B. Zel'dovich and Yu. P. Raizer, Physics of Shock Waves and High-Temperature Hydrodynamic Phenomena,
//! ch. XI; M. L. Wilkins, Meth. Comput. Phys. 3 (1964) 211.

use sph_core::{Constraint, Dim2, Particles};
use sph_io::plot::{Axis, Figure};
use sph_materials::Material;

use super::{About, Drawing, Picture, ReferenceKind, Suite, strip};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric, column_means, crossing, mean_absolute_difference};
use crate::outcome::{Curve, Outcome};
use crate::plots;
use crate::reference::staircase::Staircase;
use crate::run::{Run, material};
use crate::watch::Watch;

const LENGTH: f64 = 0.05;
const LAYERS: i64 = 5;
const SMOOTHING: f64 = 0.5;

/// Mean of |σ_xx - exact|.
const STRESS_L1: Metric = Metric::norm("stress_l1", "GPa");
/// Shift of the elastic precursor.
const PRECURSOR_SHIFT: Metric = Metric::value("precursor_shift", "mm");
/// Shift of the plastic shock.
const PLASTIC_SHIFT: Metric = Metric::value("plastic_shift", "mm");
/// -σ_xx behind the plastic shock.
const PLATEAU_STRESS: Metric = Metric::value("plateau_stress", "GPa");

/// One of the problems of the suite.
struct Problem {
    variant: &'static str,
    material: &'static str,
    /// u_p [m/s].
    velocity: f64,
    /// Time of the comparison [s].
    duration: f64,
    /// Two blocks that meet, or a block of imposed velocity.
    mirrored: bool,
}

const COPPER: Problem = Problem {
    variant: "copper",
    material: "porous-copper",
    velocity: 200.0,
    duration: 7.5e-6,
    mirrored: true,
};

const PROBLEMS: [Problem; 3] = [
    COPPER,
    Problem { variant: "copper-block", mirrored: false, ..COPPER },
    Problem { variant: "aluminum", material: "aluminium-verney", velocity: 150.0, duration: 6e-6, ..COPPER },
];

impl Problem {
    fn of(case: &Case) -> &'static Self {
        PROBLEMS.iter().find(|problem| problem.variant == case.variant).unwrap_or(&PROBLEMS[0])
    }

    fn exact(&self) -> Result<(Material, Staircase), ValidateError> {
        let material = material(self.material)?;
        let stairs = Staircase::new(&material, self.velocity)?;
        Ok((material, stairs))
    }
}

/// The suite.
pub struct Piston;

impl Suite for Piston {
    fn about(&self) -> About {
        About {
            name: "piston",
            title: "Elastic-plastic piston",
            resolution: "particles along x",
            reference: ReferenceKind::Analytic,
            gates: include_str!("../../validation/piston/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[100, 200],
            Tier::Full => &[100, 200, 400],
        };
        let cases = |problem: &Problem| {
            let grid = Case::grid("piston", &SchemeName::ALL, resolutions).into_iter();
            grid.map(|case| case.of_variant(problem.variant)).collect::<Vec<_>>()
        };
        PROBLEMS.iter().flat_map(cases).collect()
    }

    fn work(&self, case: &Case) -> f64 {
        let n = f64::from(case.n);
        let steps = Problem::of(case).duration * 6000.0 * n / LENGTH / case.scheme.courant();
        let blocks = if Problem::of(case).mirrored { 2.0 } else { 1.0 };
        6.0 * blocks * n * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let problem = Problem::of(case);
        let (material, stairs) = problem.exact()?;
        let size = LENGTH / f64::from(case.n);
        let particles = particles(case.n, problem, material.reference_density);
        let far = LENGTH + LAYERS as f64 * size;
        let domain = strip::domain([-far, far], size, false);
        let mut settings = case.scheme.settings();
        settings.smoothing = SMOOTHING;
        let mut run = Run::new(case, watch, domain, material, particles, settings)?;
        run.advance(problem.duration)?;
        Ok(measure(run, problem, &stairs))
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let mut pictures = plots::convergences(&self.about(), outcomes);
        for problem in &PROBLEMS {
            let of_problem = outcomes.iter().copied().filter(|o| o.case.variant == problem.variant);
            let of_problem: Vec<&Outcome> = of_problem.collect();
            if !of_problem.is_empty() {
                pictures.push(profile_picture(problem, &of_problem)?);
            }
        }
        Ok(pictures)
    }
}

/// Two blocks that meet, or a piston and a block at rest; the far ends are frozen.
fn particles(n: u32, problem: &Problem, density: f64) -> Particles<Dim2> {
    let size = LENGTH / f64::from(n);
    let first = if problem.mirrored { -i64::from(n) - LAYERS } else { -LAYERS };
    strip::particles(first..i64::from(n) + LAYERS, size, density, |x, particle| {
        let velocity = match (problem.mirrored, x < 0.0) {
            (true, left) => problem.velocity * if left { 1.0 } else { -1.0 },
            (false, piston) => problem.velocity * f64::from(piston),
        };
        particle.velocity = [velocity, 0.0].into();
        if x.abs() > LENGTH {
            particle.constraint = Constraint::Frozen;
        } else if x < 0.0 && !problem.mirrored {
            particle.constraint = Constraint::ImposedVelocity;
        }
    })
}

/// Place relative to matter at rest ahead of a piston that starts at 0 [m], and -σ_xx there [Pa]; right block only.
fn stresses(run: &Run<'_, Dim2>, problem: &Problem) -> Vec<(f64, f64)> {
    let shift = if problem.mirrored { problem.velocity * problem.duration } else { 0.0 };
    let values = strip::values(run, |i| -run.simulation.stress(i)[0]).into_iter();
    values.filter(|(x, _)| *x > 0.0).map(|(x, stress)| (x + shift, stress)).collect()
}

fn measure(run: Run<'_, Dim2>, problem: &Problem, stairs: &Staircase) -> Outcome {
    let time = problem.duration;
    let stresses = stresses(&run, problem);
    let pairs = stresses.iter().map(|&(x, stress)| (1e-9 * stress, -1e-9 * stairs.sample(x / time).stress));
    let mut measurements = vec![Measurement::error_of(STRESS_L1, mean_absolute_difference(pairs))];
    let (from, to) = (problem.velocity * time, stairs.waves().last().map_or(0.0, |w| w.wave_speed) * time);
    let plateau = strip::mean_between(&stresses, from + 0.25 * (to - from), from + 0.75 * (to - from));
    let profile = column_means(stresses, strip::ROWS as usize);
    for (metric, wave) in [PRECURSOR_SHIFT, PLASTIC_SHIFT].into_iter().zip(stairs.waves()) {
        let level = -0.5 * (wave.ahead.longitudinal_stress + wave.behind.longitudinal_stress);
        let exact = wave.wave_speed * time;
        let found = crossing(&profile, level, exact).unwrap_or(f64::NAN);
        measurements.push(Measurement::error_of(metric, 1e3 * (found - exact)));
    }
    measurements.push(Measurement::new(PLATEAU_STRESS, 1e-9 * plateau, -1e-9 * stairs.last().stress));
    let curve = profile.iter().map(|&(x, stress)| (1e3 * x, 1e-9 * stress)).collect();
    run.outcome(measurements, vec![Curve::new("stress", curve)], Vec::new())
}

fn profile_picture(problem: &Problem, outcomes: &[&Outcome]) -> Result<Picture, ValidateError> {
    let (_, stairs) = problem.exact()?;
    let exact: Vec<(f64, f64)> = stairs
        .profile(problem.duration, LENGTH)
        .into_iter()
        .map(|(x, sample)| (1e3 * x, -1e-9 * sample.stress))
        .collect();
    let (variant, microseconds) = (problem.variant, 1e6 * problem.duration);
    let title = format!("Piston in {variant}, u_p = {} m/s, t = {microseconds} µs", problem.velocity);
    let figure = Figure::new(title, Axis::new("x [mm]"), Axis::new("-σ_{xx} [GPa]"));
    Ok(Picture {
        name: format!("piston-{variant}"),
        caption: format!("stress ahead of a piston in {variant}: precursor and plastic shock, exact dashed"),
        drawing: Drawing::Plot(plots::profiles(figure, outcomes, "stress", ("exact", &exact))),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_meet_or_a_piston_pushes() {
        let count = |particles: &Particles<Dim2>, constraint| {
            particles.constraint.iter().filter(|&&c| c == constraint).count()
        };
        let momentum = |particles: &Particles<Dim2>| -> f64 {
            (0..particles.len()).map(|i| particles.mass[i] * particles.velocity[0][i]).sum()
        };
        let size = LENGTH / 100.0;
        let mirrored = particles(100, &COPPER, 8960.0);
        assert_eq!(mirrored.len(), 6 * 210);
        assert_eq!(count(&mirrored, Constraint::Frozen), 60);
        assert!(momentum(&mirrored).abs() < 1e-9 * 8960.0 * size * size * 200.0);
        let block = particles(100, &Problem { mirrored: false, ..COPPER }, 8960.0);
        assert_eq!(count(&block, Constraint::ImposedVelocity), 30);
        assert!((momentum(&block) / (30.0 * 8960.0 * size * size * 200.0) - 1.0).abs() < 1e-12);
    }

    /// All problems have two waves that are apart by many particles, and neither reaches the far end.
    #[test]
    fn problems_are_two_wave_problems() {
        for problem in &PROBLEMS {
            let (_, stairs) = problem.exact().expect("solvable");
            let [precursor, plastic] = stairs.waves() else { panic!("{}: {stairs:?}", problem.variant) };
            let way = precursor.wave_speed * problem.duration;
            assert!(way < 0.9 * LENGTH, "{}: {way}", problem.variant);
            assert!(way - plastic.wave_speed * problem.duration > 0.05 * LENGTH, "{}", problem.variant);
        }
    }
}
