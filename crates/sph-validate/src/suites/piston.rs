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
//! A user's piston ([`Setup`]) is the plane in which two equal blocks meet, in any solid with a yield strength.
//!
//! Source: Ya. B. Zel'dovich and Yu. P. Raizer, Physics of Shock Waves and High-Temperature Hydrodynamic Phenomena,
//! ch. XI; M. L. Wilkins, Meth. Comput. Phys. 3 (1964) 211.

use sph_core::{Constraint, Dim2, Particles};
use sph_io::plot::{Axis, Figure};
use sph_materials::Material;

use super::{About, Drawing, Picture, ReferenceKind, Suite, strip};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::gate::Significant;
use crate::metric::{Measurement, Metric, column_means, crossing, mean_absolute_difference};
use crate::outcome::{Curve, Outcome};
use crate::plots;
use crate::reference::staircase::Staircase;
use crate::run::{Run, material};
use crate::user::User;
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

/// What makes a problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// The solid, at rest ahead of the piston.
    pub material: Material,
    /// Velocity u_p of the piston [m/s].
    pub velocity: f64,
    /// Length of a block [m].
    pub length: f64,
    /// Time of the comparison [s].
    pub duration: f64,
    /// Two blocks that meet, or a block of imposed velocity and one at rest.
    pub mirrored: bool,
}

impl Setup {
    /// The two waves ahead of the piston.
    ///
    /// # Errors
    /// A material and velocity without plane waves: see [`sph_materials::hugoniot::piston`].
    pub fn waves(&self) -> Result<Staircase, ValidateError> {
        Ok(Staircase::new(&self.material, self.velocity)?)
    }

    /// Way of the fastest wave [m] through the solid until the end.
    ///
    /// # Errors
    /// As [`Setup::waves`].
    pub fn reach(&self) -> Result<f64, ValidateError> {
        Ok(self.waves()?.waves().first().map_or(0.0, |wave| wave.wave_speed) * self.duration)
    }
}

/// Variant, material of the library, u_p [m/s], time of the comparison [s], two blocks.
type Published = (&'static str, &'static str, f64, f64, bool);

const PUBLISHED: [Published; 3] = [
    ("copper", "porous-copper", 200.0, 7.5e-6, true),
    ("copper-block", "porous-copper", 200.0, 7.5e-6, false),
    ("aluminum", "aluminium-verney", 150.0, 6e-6, true),
];

/// The suite: pistons in copper and aluminum, or a user's.
pub struct Piston {
    /// What the user asks for.
    pub user: Option<User<Setup>>,
}

impl Piston {
    /// The problems of the project.
    pub const OWN: Self = Self { user: None };

    fn setup(&self, variant: &str) -> Result<Setup, ValidateError> {
        if let Some(user) = &self.user {
            return Ok(user.problem.clone());
        }
        let of_name = PUBLISHED.iter().find(|problem| problem.0 == variant);
        let &(_, name, velocity, duration, mirrored) = of_name.unwrap_or(&PUBLISHED[0]);
        Ok(Setup { material: material(name)?, velocity, length: LENGTH, duration, mirrored })
    }

    fn variants(&self) -> Vec<&str> {
        match &self.user {
            Some(user) => vec![&user.name],
            None => PUBLISHED.iter().map(|problem| problem.0).collect(),
        }
    }
}

impl Suite for Piston {
    fn about(&self) -> About {
        About {
            name: "piston",
            title: "Elastic-plastic piston",
            resolution: "particles along x",
            reference: ReferenceKind::Analytic,
            gates: match self.user {
                Some(_) => "",
                None => include_str!("../../validation/piston/gates.ron"),
            },
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        if let Some(user) = &self.user {
            return user.cases("piston");
        }
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[100, 200],
            Tier::Full => &[100, 200, 400],
        };
        let cases = |variant| Case::grid_of("piston", variant, &SchemeName::ALL, resolutions);
        self.variants().into_iter().flat_map(cases).collect()
    }

    fn work(&self, case: &Case) -> f64 {
        let Ok(setup) = self.setup(&case.variant) else { return 1.0 };
        let n = f64::from(case.n);
        let speed = setup.material.longitudinal_sound_speed(setup.material.reference_density, 0.0);
        let steps = setup.duration * 1.2 * speed * n / setup.length / case.scheme.courant();
        let blocks = if setup.mirrored { 2.0 } else { 1.0 };
        6.0 * blocks * n * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let setup = self.setup(&case.variant)?;
        let stairs = setup.waves()?;
        let size = setup.length / f64::from(case.n);
        let far = setup.length + LAYERS as f64 * size;
        let domain = strip::domain([-far, far], size, false);
        let mut settings = case.scheme.settings();
        settings.smoothing = SMOOTHING;
        let material = setup.material.clone();
        let mut run = Run::new(case, watch, domain, material, particles(case.n, &setup), settings)?;
        run.advance(setup.duration)?;
        Ok(measure(run, &setup, &stairs))
    }

    fn parameters(&self) -> String {
        self.user.as_ref().map_or(String::new(), |user| format!("{:?}", user.problem))
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let mut pictures = plots::convergences(&self.about(), outcomes);
        for variant in self.variants() {
            let of_problem = plots::of_variant(outcomes, variant);
            if !of_problem.is_empty() {
                let what = if self.user.is_some() { variant.to_owned() } else { format!("in {variant}") };
                pictures.push(profile_picture(variant, &what, &self.setup(variant)?, &of_problem)?);
            }
        }
        Ok(pictures)
    }
}

/// Two blocks that meet, or a piston and a block at rest; the far ends are frozen.
fn particles(n: u32, setup: &Setup) -> Particles<Dim2> {
    let (size, density) = (setup.length / f64::from(n), setup.material.reference_density);
    let first = if setup.mirrored { -i64::from(n) - LAYERS } else { -LAYERS };
    strip::particles(first..i64::from(n) + LAYERS, size, density, |x, particle| {
        let velocity = match (setup.mirrored, x < 0.0) {
            (true, left) => setup.velocity * if left { 1.0 } else { -1.0 },
            (false, piston) => setup.velocity * f64::from(piston),
        };
        particle.velocity = [velocity, 0.0].into();
        if x.abs() > setup.length {
            particle.constraint = Constraint::Frozen;
        } else if x < 0.0 && !setup.mirrored {
            particle.constraint = Constraint::ImposedVelocity;
        }
    })
}

/// Place relative to matter at rest ahead of a piston that starts at 0 [m], and -σ_xx there [Pa]; right block only.
fn stresses(run: &Run<'_, Dim2>, setup: &Setup) -> Vec<(f64, f64)> {
    let shift = if setup.mirrored { setup.velocity * setup.duration } else { 0.0 };
    let values = strip::values(run, |i| -run.simulation.stress(i)[0]).into_iter();
    values.filter(|(x, _)| *x > 0.0).map(|(x, stress)| (x + shift, stress)).collect()
}

fn measure(run: Run<'_, Dim2>, setup: &Setup, stairs: &Staircase) -> Outcome {
    let time = setup.duration;
    let stresses = stresses(&run, setup);
    let pairs = stresses.iter().map(|&(x, stress)| (1e-9 * stress, -1e-9 * stairs.sample(x / time).stress));
    let mut measurements = vec![Measurement::error_of(STRESS_L1, mean_absolute_difference(pairs))];
    let (from, to) = (setup.velocity * time, stairs.waves().last().map_or(0.0, |w| w.wave_speed) * time);
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

fn profile_picture(
    variant: &str,
    what: &str,
    setup: &Setup,
    outcomes: &[&Outcome],
) -> Result<Picture, ValidateError> {
    let exact: Vec<(f64, f64)> = setup
        .waves()?
        .profile(setup.duration, setup.length)
        .into_iter()
        .map(|(x, sample)| (1e3 * x, -1e-9 * sample.stress))
        .collect();
    let (velocity, microseconds) = (Significant(setup.velocity), Significant(1e6 * setup.duration));
    let title = format!("Piston {what}, u_p = {velocity:.3} m/s, t = {microseconds:.3} µs");
    let figure = Figure::new(title, Axis::new("x [mm]"), Axis::new("-σ_{xx} [GPa]"));
    Ok(Picture {
        name: format!("piston-{variant}"),
        caption: format!("stress ahead of the piston {what}: precursor and plastic shock, exact dashed"),
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
        let copper = Piston::OWN.setup("copper").expect("in the library");
        let mirrored = particles(100, &copper);
        assert_eq!(mirrored.len(), 6 * 210);
        assert_eq!(count(&mirrored, Constraint::Frozen), 60);
        assert!(momentum(&mirrored).abs() < 1e-9 * 8960.0 * size * size * 200.0);
        let block = particles(100, &Setup { mirrored: false, ..copper });
        assert_eq!(count(&block, Constraint::ImposedVelocity), 30);
        assert!((momentum(&block) / (30.0 * 8960.0 * size * size * 200.0) - 1.0).abs() < 1e-12);
    }

    /// All problems have two waves that are apart by many particles, and neither reaches the far end.
    #[test]
    fn problems_are_two_wave_problems() {
        for variant in Piston::OWN.variants() {
            let setup = Piston::OWN.setup(variant).expect("in the library");
            let stairs = setup.waves().expect("solvable");
            let [precursor, plastic] = stairs.waves() else { panic!("{variant}: {stairs:?}") };
            let way = setup.reach().expect("solvable");
            assert!(way < 0.9 * LENGTH, "{variant}: {way}");
            assert!(precursor.wave_speed > plastic.wave_speed);
            assert!(way - plastic.wave_speed * setup.duration > 0.05 * LENGTH, "{variant}");
        }
    }
}
