//! Longitudinal sound wave in copper: a Gaussian pulse of velocity splits in two.
//!
//! U_x(0) = 5 exp(-2 x²) m/s (x in mm), ±5 mm, periodic in x and y, six rows of equally spaced particles
//! (D = 10 mm / N), θ = 0.6, 3 mm of travel at the longitudinal sound speed of the undisturbed solid.
//!
//! Reference: the same problem on a Lagrangian mesh of 20,000 zones ([`crate::reference::lagrangian`]). d'Alembert's
//! solution differs from it by 8e-4 m/s: the wave is not quite linear.
//!
//! Measured: the mean over the particles of |U_x - reference|; the centroid and the peak of the pulse that runs to
//! the right.
//!
//! A user's wave ([`Setup`]) is of the same kind in any solid: amplitude, width, period and travel are the user's, the mesh
//! has the material's own equation of state, and the schemes have the program's defaults.
//!
//! Source: Rublev and Murzov (2024), section 2.1.2.

use std::sync::OnceLock;

use sph_core::{Dim2, Domain, Particles};
use sph_io::plot::{Axis, Figure};
use sph_materials::Material;
use sph_riemann::{Limiter, Settings};

use super::{About, Drawing, Picture, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::gate::Significant;
use crate::metric::{Measurement, Metric, centroid, column_means, mean_absolute_difference};
use crate::outcome::{Curve, Outcome};
use crate::plots;
use crate::reference::lagrangian::{
    Ends, Mesh, Pressure, Scheme, Solid, Symmetry, Viscosity, Zone, interpolated,
};
use crate::run::{Run, material, particle_at};
use crate::user::User;
use crate::watch::Watch;

const SMOOTHING: f64 = 0.6;
const ROWS: u32 = 6;
const ZONES: usize = 20_000;
/// Longitudinal sound speed of the undisturbed copper [m/s].
const SOUND_SPEED: f64 = 5099.30;

/// Mean over the particles of |U_x - reference|.
const VELOCITY_L1: Metric = Metric::norm("velocity_l1", "m/s");
/// Shift of the centroid of the pulse that runs to the right.
const PULSE_SHIFT: Metric = Metric::value("pulse_shift", "mm");
/// Greatest U_x of that pulse.
const PULSE_PEAK: Metric = Metric::value("pulse_peak", "m/s");
/// U_x [m/s] over x [mm].
const PROFILE: &str = "profile";

/// What makes a problem: U_x(0) = amplitude exp(-2 x²/width²), which splits in two halves.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// The solid, without stress at the start.
    pub material: Material,
    /// Greatest velocity at the start [m/s].
    pub amplitude: f64,
    /// Width of the pulse [m].
    pub width: f64,
    /// Period along x [m].
    pub length: f64,
    /// Way of the pulses until the comparison [m].
    pub travel: f64,
}

impl Setup {
    fn published() -> Result<Self, ValidateError> {
        let material = material("copper-sound-wave")?;
        Ok(Self { material, amplitude: 5.0, width: 1e-3, length: 0.01, travel: 3e-3 })
    }

    /// U_x at the start [m/s] at `x` [m].
    fn initial_velocity(&self, x: f64) -> f64 {
        self.amplitude * (-2.0 * (x / self.width).powi(2)).exp()
    }

    /// Place within the period, around the middle [m].
    fn wrapped(&self, x: f64) -> f64 {
        (x + 0.5 * self.length).rem_euclid(self.length) - 0.5 * self.length
    }
}

/// The suite: the published wave, or a user's.
pub struct SoundWave {
    /// What the user asks for.
    user: Option<User<Setup>>,
    /// Computed once: a second or two.
    reference: OnceLock<Reference>,
}

/// The published wave.
pub static PUBLISHED: SoundWave = SoundWave::new(None);

impl SoundWave {
    /// The published wave, or a user's.
    pub const fn new(user: Option<User<Setup>>) -> Self {
        Self { user, reference: OnceLock::new() }
    }

    fn setup(&self) -> Result<Setup, ValidateError> {
        match &self.user {
            Some(user) => Ok(user.problem.clone()),
            None => Setup::published(),
        }
    }

    /// Sound speed that the time of the comparison is reckoned with [m/s].
    fn sound_speed(&self, setup: &Setup) -> f64 {
        match self.user {
            Some(_) => setup.material.longitudinal_sound_speed(setup.material.reference_density, 0.0),
            None => SOUND_SPEED,
        }
    }

    /// Time of the comparison [s].
    fn duration(&self, setup: &Setup) -> f64 {
        setup.travel / self.sound_speed(setup)
    }

    fn reference(&self, setup: &Setup) -> &Reference {
        self.reference.get_or_init(|| match self.user {
            Some(_) => Reference::of(setup, self.duration(setup)),
            None => Reference::published(setup, self.duration(setup)),
        })
    }

    /// Courant number: TKC-Hancock has 0.5 here, where its published figures have 0.4; what 0.4 gives is in the README.
    /// A user's problem has the program's default.
    fn courant(&self, scheme: SchemeName) -> f64 {
        if self.user.is_none() && scheme == SchemeName::TkcHancock { 0.5 } else { scheme.courant() }
    }

    fn settings(&self, scheme: SchemeName) -> Settings {
        let mut settings = scheme.settings();
        (settings.smoothing, settings.courant) = (SMOOTHING, self.courant(scheme));
        if self.user.is_none() && scheme == SchemeName::TkcHancock {
            // The published figures were measured with this limiter.
            settings.limiter = Limiter::MonotonizedCentral;
        }
        settings
    }
}

impl Suite for SoundWave {
    fn about(&self) -> About {
        About {
            name: "sound-wave",
            title: "Longitudinal sound wave",
            resolution: "particles along x",
            reference: ReferenceKind::External,
            gates: match self.user {
                Some(_) => "",
                None => include_str!("../../validation/sound-wave/gates.ron"),
            },
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        if let Some(user) = &self.user {
            return user.cases("sound-wave");
        }
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[100, 200, 400],
            Tier::Full => &[100, 200, 400, 800, 1600],
        };
        Case::grid("sound-wave", &SchemeName::ALL, resolutions)
    }

    fn work(&self, case: &Case) -> f64 {
        let Ok(setup) = self.setup() else { return 1.0 };
        let n = f64::from(case.n);
        let steps = setup.travel * n / setup.length / self.courant(case.scheme);
        6.0 * n * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let setup = self.setup()?;
        let reference = self.reference(&setup);
        let size = setup.length / f64::from(case.n);
        let corner = [0.5 * setup.length, 0.5 * f64::from(ROWS) * size];
        let domain = Domain::new([-corner[0], -corner[1]].into(), corner.into(), [true, true]);
        let particles = particles(case.n, &setup);
        let settings = self.settings(case.scheme);
        let mut run = Run::new(case, watch, domain, setup.material.clone(), particles, settings)?;
        run.advance(self.duration(&setup))?;
        Ok(measure(run, &setup, reference))
    }

    fn parameters(&self) -> String {
        self.user.as_ref().map_or(String::new(), |user| format!("{:?}", user.problem))
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let setup = self.setup()?;
        let profile = Picture {
            name: "sound-wave".into(),
            caption: format!(
                "U_x over x after {:.3} mm of travel, the schemes and the mesh",
                Significant(1e3 * setup.travel)
            ),
            drawing: Drawing::Plot(profile_plot(outcomes, &setup, self.reference(&setup))),
        };
        let mut pictures = vec![profile];
        pictures.extend(plots::convergences(&self.about(), outcomes));
        Ok(pictures)
    }
}

/// The wave on the mesh at the end: velocities [m/s] over x [m], periodic.
struct Reference {
    places: Vec<f64>,
    velocities: Vec<f64>,
}

impl Reference {
    /// The numbers of the material are written out here, so that a fault of the library shows as an error.
    fn published(setup: &Setup, duration: f64) -> Self {
        const DENSITY: f64 = 8960.0;
        let bulk_modulus = DENSITY * 4148.0 * 4148.0;
        let solid = Solid {
            pressure: &|density, _| 4148.0 * 4148.0 * (density - DENSITY),
            shear_modulus: 1.5 * bulk_modulus * (1.0 - 2.0 * 0.33) / (1.0 + 0.33),
            yield_strength: f64::INFINITY,
            sound_speed: 1.002 * SOUND_SPEED,
        };
        Self::compute(setup, solid, DENSITY, duration)
    }

    /// The mesh with the equation of state of the user's material.
    fn of(setup: &Setup, duration: f64) -> Self {
        let material = &setup.material;
        let pressure: Pressure<'_> = &|density, energy| material.pressure(density, energy);
        let solid = Solid::of(material, pressure);
        Self::compute(setup, solid, material.reference_density, duration)
    }

    fn compute(setup: &Setup, solid: Solid<'_>, density: f64, duration: f64) -> Self {
        let scheme = Scheme {
            symmetry: Symmetry::Planar,
            ends: Ends::Periodic,
            cfl: 0.9,
            viscosity: Viscosity::default(),
        };
        let rest = Zone { density, energy: 0.0, deviator: [0.0; 3] };
        let ends = [-0.5 * setup.length, 0.5 * setup.length];
        let mut mesh = Mesh::new(solid, scheme, ends, ZONES, |_| rest, |x| setup.initial_velocity(x));
        mesh.run_until(duration);
        Self { places: mesh.radius().to_vec(), velocities: mesh.velocity().to_vec() }
    }

    fn velocity_at(&self, x: f64) -> f64 {
        interpolated(&self.places, &self.velocities, true, x)
    }

    /// Places and velocities of the nodes right of the middle: the pulse that runs to the right.
    fn right_pulse(&self) -> impl Iterator<Item = (f64, f64)> {
        let nodes = self.places.iter().zip(&self.velocities);
        nodes.map(|(&x, &u)| (x, u)).filter(|&(x, _)| x > 0.0)
    }
}

fn measure(run: Run<'_, Dim2>, setup: &Setup, reference: &Reference) -> Outcome {
    let velocities = velocities(&run, setup);
    let pairs = velocities.iter().map(|&(x, u)| (u, reference.velocity_at(x)));
    let mut measurements = vec![Measurement::error_of(VELOCITY_L1, mean_absolute_difference(pairs))];
    let profile = column_means(velocities, ROWS as usize);
    measurements.extend(pulse(&profile, reference));
    let curve = profile.iter().map(|&(x, u)| (1e3 * x, u)).collect();
    run.outcome(measurements, vec![Curve::new(PROFILE, curve)], Vec::new())
}

/// Two widths around the pulse that runs to the right.
fn profile_plot(outcomes: &[&Outcome], setup: &Setup, reference: &Reference) -> Figure {
    let title = format!("Longitudinal sound wave after {:.3} mm of travel", Significant(1e3 * setup.travel));
    let ends = [-2.0, 2.0].map(|widths| 1e3 * (setup.travel + widths * setup.width));
    let figure = Figure::new(title, Axis::new("x [mm]").with_range(ends[0], ends[1]), Axis::new("U_x [m/s]"));
    let places = (0..=2000).map(|k| setup.length * (f64::from(k) / 2000.0 - 0.5));
    let curve: Vec<(f64, f64)> = places.map(|x| (1e3 * x, reference.velocity_at(x))).collect();
    plots::profiles(figure, outcomes, PROFILE, ("1-D Lagrangian mesh", &curve))
}

fn particles(n: u32, setup: &Setup) -> Particles<Dim2> {
    let (size, density) = (setup.length / f64::from(n), setup.material.reference_density);
    let mut particles = Particles::default();
    for column in 0..n {
        let x = (f64::from(column) + 0.5) * size - 0.5 * setup.length;
        for row in 0..ROWS {
            let y = (f64::from(row) + 0.5 - 0.5 * f64::from(ROWS)) * size;
            let mut particle = particle_at(particles.len(), [x, y].into(), size, density);
            particle.velocity = [setup.initial_velocity(x), 0.0].into();
            particles.push(particle);
        }
    }
    particles
}

/// Place x [m], within the period, and velocity U_x [m/s] of the particles.
fn velocities(run: &Run<'_, Dim2>, setup: &Setup) -> Vec<(f64, f64)> {
    let particles = run.simulation.particles();
    (0..particles.len())
        .map(|i| (setup.wrapped(particles.position[0][i]), particles.velocity[0][i]))
        .collect()
}

/// Centroid and peak of the pulse that runs to the right, beside those of the reference.
fn pulse(profile: &[(f64, f64)], reference: &Reference) -> [Measurement; 2] {
    let right = || profile.iter().copied().filter(|&(x, _)| x > 0.0);
    let peak =
        |points: &mut dyn Iterator<Item = (f64, f64)>| points.map(|p| p.1).fold(f64::NEG_INFINITY, f64::max);
    let shift = centroid(right()) - centroid(reference.right_pulse());
    [
        Measurement::error_of(PULSE_SHIFT, 1e3 * shift),
        Measurement::new(PULSE_PEAK, peak(&mut right()), peak(&mut reference.right_pulse())),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pulse_starts_in_the_middle_with_its_amplitude() {
        let setup = Setup::published().expect("in the library");
        let particles = particles(200, &setup);
        assert_eq!(particles.len(), 6 * 200);
        let mass: f64 = particles.mass.iter().sum();
        assert!((mass / (8960.0 * 0.01 * 6.0 * 0.01 / 200.0) - 1.0).abs() < 1e-12);
        let fastest = particles.velocity[0].iter().copied().fold(0.0, f64::max);
        assert!((4.99..=5.0).contains(&fastest), "{fastest}");
        let center =
            centroid((0..particles.len()).map(|i| (particles.position[0][i], particles.velocity[0][i])));
        assert!(center.abs() < 1e-12, "{center}");
    }

    /// The mesh has the sound speed of the material that the particles have.
    #[test]
    fn reference_and_library_agree_on_the_sound_speed() {
        let copper = material("copper-sound-wave").expect("in the library");
        let speed = copper.longitudinal_sound_speed(copper.reference_density, 0.0);
        assert!((speed - SOUND_SPEED).abs() < 0.005, "{speed}");
        let setup = Setup::published().expect("in the library");
        let center = centroid(PUBLISHED.reference(&setup).right_pulse());
        assert!((center - 3e-3).abs() < 2e-6, "{center}");
        // The same mesh with the equation of state of the library.
        let own = centroid(Reference::of(&setup, PUBLISHED.duration(&setup)).right_pulse());
        assert!((own - center).abs() < 1e-9, "{own} {center}");
    }
}
