//! Solid copper in the moving window: a steady shock in a box through which the medium streams, with an exact answer.
//!
//! A period of 10 × 4 particles (D = 1 µm), a box of n particle sizes, u_p from 50 m/s (two waves) to 800 m/s (overdriven).
//! In the two-wave cases the inlet is impedance-matched: the precursor leaves through it, and the window sees the plastic
//! shock in the medium behind the precursor.
//!
//! Measured: the shock velocity from the front and from the balance of mass behind it, in % off the exact one; the stress
//! behind the shock; the density of the packing beside the particles' own; stress ahead of the shock (the precursor).
//!
//! Reference: exact, jump conditions of both waves ([`sph_materials::hugoniot`]). The window counts lengths of the
//! undisturbed medium: the shock velocity is the mass flux through the front over its density.
//!
//! A user's window ([`Setup`]) holds any solid at any u_p beyond the elastic limit; the answer has no length, so that the
//! size of a particle is 1 µm there, too.

use std::time::Instant;

use sph_core::{Components, Dim2, Domain, Particle, Particles};
use sph_io::plot::{Axis, Figure, Series};
use sph_materials::hugoniot::{PistonWaves, piston};
use sph_materials::{Jump, Material};
use sph_window::{FeedSample, InletKind, PlateauMargins, Window, WindowSettings};

use super::window::{Averages, advance, outcome};
use super::{About, Drawing, Picture, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::{Curve, Outcome};
use crate::plots;
use crate::run::material;
use crate::user::User;
use crate::watch::Watch;

const SIZE: f64 = 1e-6;
/// Length of the medium that is fed [D].
pub(crate) const FED: u32 = 2500;

/// Shock velocity from the front, off the exact one.
const FRONT: Metric = Metric::value("front_velocity_error", "%");
/// Shock velocity from the balance of mass, off the exact one.
const BALANCE: Metric = Metric::value("mass_balance_error", "%");
/// -σ_xx behind the shock, off the exact one.
const STRESS: Metric = Metric::value("stress_error", "%");
/// Density of the packing over the particles' own, less one.
const PACKING: Metric = Metric::value("packing_excess", "%");
/// Shock velocity from the front.
const VELOCITY: Metric = Metric::value("shock_velocity", "m/s");
/// -σ_xx ahead of the shock.
const AHEAD: Metric = Metric::value("stress_ahead", "GPa");

/// Variants: u_p [m/s]; the last is overdriven.
const VARIANTS: [(&str, f64); 5] =
    [("50", 50.0), ("100", 100.0), ("200", 200.0), ("400", 400.0), ("800-overdriven", 800.0)];

/// What makes a problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// The solid.
    pub material: Material,
    /// u_p [m/s].
    pub velocity: f64,
    /// Length of the medium that is fed, in particle sizes.
    pub fed: u32,
}

/// The suite: copper, or a user's solid.
pub struct WindowSolid {
    /// What the user asks for.
    pub user: Option<User<Setup>>,
}

impl WindowSolid {
    /// The problems of the project.
    pub const OWN: Self = Self { user: None };

    fn setup(&self, case: &Case) -> Result<Setup, ValidateError> {
        match &self.user {
            Some(user) => Ok(user.problem.clone()),
            None => Ok(Setup { material: material("porous-copper")?, velocity: velocity_of(case), fed: FED }),
        }
    }

    fn picture(&self, outcomes: &[&Outcome]) -> Result<Picture, ValidateError> {
        let Setup { material, velocity, .. } = self.setup(&outcomes[0].case)?;
        let rest = material.reference_density;
        // Around what the user asks for; the range of the project's own problems.
        let ends = if self.user.is_some() { [0.5 * velocity, 1.5 * velocity] } else { [20.0, 850.0] };
        let velocities = (0..=80).map(|k| ends[0] + (ends[1] - ends[0]) * f64::from(k) / 80.0);
        let point = |u_p: f64| Some((u_p, Exact::new(&material, u_p).ok()?.velocity(rest)));
        let exact: Vec<(f64, f64)> = velocities.filter_map(point).collect();
        let title = match &self.user {
            Some(user) => format!("Moving window, {}: shock velocity", user.name),
            None => "Solid copper in the moving window: shock velocity".into(),
        };
        let figure = Figure::new(title, Axis::new("u_p [m/s]"), Axis::new("u_s [m/s]"));
        let figure = plots::marks_by_scheme(figure, outcomes, "velocity")
            .with(plots::line(Series::dashed, "exact", &exact).with_color(plots::BLACK));
        Ok(Picture {
            name: "window-solid".into(),
            caption:
                "velocity of the shock that the window follows, relative to the medium behind the precursor, \
                      from the front"
                    .into(),
            drawing: Drawing::Plot(figure),
        })
    }
}

impl Suite for WindowSolid {
    fn about(&self) -> About {
        About {
            name: "window-solid",
            title: match self.user {
                Some(_) => "Solid in the moving window",
                None => "Solid copper in the moving window",
            },
            resolution: "length of the box in particle sizes",
            reference: ReferenceKind::Analytic,
            gates: match self.user {
                Some(_) => "",
                None => include_str!("../../validation/window-solid/gates.ron"),
            },
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        if let Some(user) = &self.user {
            return user.cases("window-solid");
        }
        let variants = match tier {
            Tier::Quick => &VARIANTS[2..3],
            Tier::Full => &VARIANTS[..],
        };
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[120],
            Tier::Full => &[120, 180, 240],
        };
        let grid = |&(name, _): &(&'static str, f64)| {
            // Printed, the second scheme costs four times the third.
            let schemes: &[SchemeName] =
                if name == "200" { &SchemeName::ALL } else { &[SchemeName::Csph, SchemeName::TkcHancock] };
            Case::grid_of("window-solid", name, schemes, resolutions)
        };
        variants.iter().flat_map(grid).collect()
    }

    fn work(&self, case: &Case) -> f64 {
        let fed = self.user.as_ref().map_or(FED, |user| user.problem.fed);
        let steps = f64::from(fed) * 4800.0 / 4200.0 / case.scheme.courant();
        4.0 * f64::from(case.n) * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let started = Instant::now();
        let Setup { material, velocity, fed } = self.setup(case)?;
        let exact = Exact::new(&material, velocity)?;
        let settings = WindowSettings {
            inlet: exact.inlet(),
            plateau: PlateauMargins { front: 20.0, outlet: 8.0 },
            ..WindowSettings::new(f64::from(case.n) * SIZE, velocity)
        };
        let fault = |source| ValidateError::Window { case: case.to_string(), source: Box::new(source) };
        let sample = sample(material.reference_density).map_err(fault)?;
        let mut window =
            Window::new(sample, vec![material.clone()], case.scheme.settings(), settings).map_err(fault)?;
        let means = advance(case, &mut window, watch, f64::from(fed) * SIZE)?;
        let measurements = exact.measure(&window, &means, material.reference_density);
        let curves = vec![Curve::new("velocity", vec![(velocity, means.front_velocity(&window))])];
        Ok(outcome(case, &window, measurements, curves, Vec::new(), started))
    }

    fn parameters(&self) -> String {
        self.user.as_ref().map_or(String::new(), |user| format!("{:?}", user.problem))
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        Ok(vec![self.picture(outcomes)?])
    }
}

fn velocity_of(case: &Case) -> f64 {
    VARIANTS.iter().find(|(name, _)| *name == case.variant).map_or(VARIANTS[0].1, |(_, velocity)| *velocity)
}

/// The wave that the window follows, and the one that runs ahead of it.
struct Exact {
    precursor: Option<Jump>,
    shock: Jump,
}

impl Exact {
    fn new(copper: &Material, velocity: f64) -> Result<Self, ValidateError> {
        Ok(match piston(copper, velocity)? {
            PistonWaves::TwoWave { precursor, plastic } => {
                Self { precursor: Some(precursor), shock: plastic }
            }
            PistonWaves::Elastic { wave: shock }
            | PistonWaves::Fluid { shock }
            | PistonWaves::Overdriven { shock } => Self { precursor: None, shock },
        })
    }

    fn inlet(&self) -> InletKind {
        match self.precursor {
            Some(_) => InletKind::ImpedanceMatched { wave_speed: None },
            None => InletKind::FixedVelocity,
        }
    }

    /// Mass flux through the shock over the density of the undisturbed medium [m/s].
    fn velocity(&self, undisturbed: f64) -> f64 {
        self.shock.shock_velocity() * self.shock.ahead.density / undisturbed
    }

    fn measure(&self, window: &Window<Dim2>, means: &Averages, undisturbed: f64) -> Vec<Measurement> {
        let exact = self.velocity(undisturbed);
        let percent = |value: f64, exact: f64| 100.0 * (value / exact - 1.0);
        let front = means.front_velocity(window);
        let stress = self.shock.behind.longitudinal_stress;
        vec![
            Measurement::error_of(FRONT, percent(front, exact)),
            Measurement::error_of(BALANCE, percent(means.balance_velocity(window), exact)),
            Measurement::error_of(STRESS, percent(means.stress, stress)),
            Measurement::error_of(PACKING, 100.0 * (means.packing_density / means.own_density - 1.0)),
            Measurement::new(VELOCITY, front, exact),
            Measurement::new(AHEAD, -1e-9 * means.stress_ahead, -1e-9 * self.shock.ahead.longitudinal_stress),
        ]
    }
}

/// One period: 10 × 4 particles.
fn sample(density: f64) -> Result<FeedSample<Dim2>, sph_window::WindowError> {
    let mut particles = Particles::default();
    for (i, j) in (0..10).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let position = [(f64::from(i) + 0.5) * SIZE, (f64::from(j) + 0.5) * SIZE].into();
        let id = particles.len() as u64;
        particles.push(Particle::at_rest(id, position, density * SIZE * SIZE, SIZE, density));
    }
    let upper = [10.0 * SIZE, 4.0 * SIZE].into();
    FeedSample::new(particles, Domain::new([0.0, 0.0].into(), upper, Components::from_fn(|_| true)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variants_have_the_structure_that_they_say() {
        let copper = material("porous-copper").expect("in the library");
        for (name, velocity) in VARIANTS {
            let exact = Exact::new(&copper, velocity).expect("solvable");
            assert_eq!(exact.precursor.is_none(), name.ends_with("overdriven"), "{name}");
        }
    }

    #[test]
    fn sample_is_solid() {
        let sample = sample(8960.0).expect("good");
        assert!((sample.mean_density() - 8960.0).abs() < 1e-6);
        assert!((sample.period() - 1e-5).abs() < 1e-12);
    }
}
