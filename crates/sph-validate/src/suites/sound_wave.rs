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
//! Source: Rublev and Murzov (2024), section 2.1.2.

use std::sync::OnceLock;

use sph_core::{Dim2, Domain, Particles};

use super::{Outcome, Progress, Run, material, particle_at};
use crate::case::Case;
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric, centroid, column_means, mean_absolute_difference};
use crate::reference::lagrangian::{Ends, Mesh, Scheme, Solid, Symmetry, Viscosity, Zone};

/// Period along x [m].
pub const LENGTH: f64 = 0.01;
const TRAVEL: f64 = 3e-3;
const AMPLITUDE: f64 = 5.0;
const SMOOTHING: f64 = 0.6;
const ROWS: u32 = 6;
const ZONES: usize = 20_000;
/// Longitudinal sound speed of the undisturbed copper [m/s].
const SOUND_SPEED: f64 = 5099.30;

/// Time of the comparison [s].
pub fn duration() -> f64 {
    TRAVEL / SOUND_SPEED
}

/// U_x at the start [m/s] at `x` [m].
fn initial_velocity(x: f64) -> f64 {
    AMPLITUDE * (-2.0 * (1e3 * x).powi(2)).exp()
}

/// The wave on the mesh at the end: velocities [m/s] over x [m], period [`LENGTH`].
struct Reference {
    mesh: Mesh<'static>,
}

impl Reference {
    /// Computed once a process: a second or two.
    fn get() -> &'static Self {
        static REFERENCE: OnceLock<Reference> = OnceLock::new();
        REFERENCE.get_or_init(Self::compute)
    }

    /// The numbers of the material are written out here, so that a fault of the library shows as an error.
    fn compute() -> Self {
        const DENSITY: f64 = 8960.0;
        let bulk_modulus = DENSITY * 4148.0 * 4148.0;
        let solid = Solid {
            pressure: &|density, _| 4148.0 * 4148.0 * (density - DENSITY),
            shear_modulus: 1.5 * bulk_modulus * (1.0 - 2.0 * 0.33) / (1.0 + 0.33),
            yield_strength: f64::INFINITY,
            sound_speed: 1.002 * SOUND_SPEED,
        };
        let scheme = Scheme {
            symmetry: Symmetry::Planar,
            ends: Ends::Periodic,
            cfl: 0.9,
            viscosity: Viscosity::default(),
        };
        let rest = Zone { density: DENSITY, energy: 0.0, deviator: [0.0; 3] };
        let ends = [-0.5 * LENGTH, 0.5 * LENGTH];
        let mut mesh = Mesh::new(solid, scheme, ends, ZONES, |_| rest, initial_velocity);
        mesh.run_until(duration());
        Self { mesh }
    }

    /// Places and velocities of the nodes right of the middle: the pulse that runs to the right.
    fn right_pulse(&self) -> impl Iterator<Item = (f64, f64)> {
        let nodes = self.mesh.radius().iter().zip(self.mesh.velocity());
        nodes.map(|(&x, &u)| (x, u)).filter(|&(x, _)| x > 0.0)
    }
}

/// Runs one resolution.
pub fn run(case: Case, progress: Progress<'_>) -> Result<Outcome, ValidateError> {
    let reference = Reference::get();
    let material = material("copper-sound-wave")?;
    let size = LENGTH / f64::from(case.n);
    let corner = [0.5 * LENGTH, 0.5 * f64::from(ROWS) * size];
    let domain = Domain::new([-corner[0], -corner[1]].into(), corner.into(), [true, true]);
    let particles = particles(case.n, material.reference_density);
    let mut run = Run::new(case, domain, material, particles, SMOOTHING)?;
    run.advance(duration(), progress)?;
    let velocities = velocities(&run);
    let pairs = velocities.iter().map(|&(x, u)| (u, reference.mesh.velocity_at(x)));
    let mut measurements = vec![Measurement::error_of(Metric::VelocityL1, mean_absolute_difference(pairs))];
    let profile = column_means(velocities, ROWS as usize);
    measurements.extend(pulse(&profile, reference));
    measurements.push(run.energy_drift());
    let curve = profile.iter().map(|&(x, u)| (1e3 * x, u)).collect();
    Ok(Outcome { case, measurements, curve, fields: Vec::new(), cost: run.cost() })
}

/// The reference of the plot: x [mm], U_x [m/s].
pub fn reference_curve() -> Vec<(f64, f64)> {
    let mesh = &Reference::get().mesh;
    let places = (0..=2000).map(|k| LENGTH * (f64::from(k) / 2000.0 - 0.5));
    places.map(|x| (1e3 * x, mesh.velocity_at(x))).collect()
}

fn particles(n: u32, density: f64) -> Particles<Dim2> {
    let size = LENGTH / f64::from(n);
    let mut particles = Particles::default();
    for column in 0..n {
        let x = (f64::from(column) + 0.5) * size - 0.5 * LENGTH;
        for row in 0..ROWS {
            let y = (f64::from(row) + 0.5 - 0.5 * f64::from(ROWS)) * size;
            let mut particle = particle_at(particles.len(), [x, y], size, density);
            particle.velocity = [initial_velocity(x), 0.0].into();
            particles.push(particle);
        }
    }
    particles
}

/// Place x [m], within the period, and velocity U_x [m/s] of the particles.
fn velocities(run: &Run) -> Vec<(f64, f64)> {
    let particles = run.simulation.particles();
    let wrapped = |x: f64| (x + 0.5 * LENGTH).rem_euclid(LENGTH) - 0.5 * LENGTH;
    (0..particles.len()).map(|i| (wrapped(particles.position[0][i]), particles.velocity[0][i])).collect()
}

/// Centroid and peak of the pulse that runs to the right, beside those of the reference.
fn pulse(profile: &[(f64, f64)], reference: &Reference) -> [Measurement; 2] {
    let right = || profile.iter().copied().filter(|&(x, _)| x > 0.0);
    let peak =
        |points: &mut dyn Iterator<Item = (f64, f64)>| points.map(|p| p.1).fold(f64::NEG_INFINITY, f64::max);
    let shift = centroid(right()) - centroid(reference.right_pulse());
    [
        Measurement::error_of(Metric::PulseShift, 1e3 * shift),
        Measurement {
            metric: Metric::PulsePeak,
            value: peak(&mut right()),
            reference: peak(&mut reference.right_pulse()),
        },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pulse_starts_in_the_middle_with_its_amplitude() {
        let particles = particles(200, 8960.0);
        assert_eq!(particles.len(), 6 * 200);
        let mass: f64 = particles.mass.iter().sum();
        assert!((mass / (8960.0 * LENGTH * 6.0 * LENGTH / 200.0) - 1.0).abs() < 1e-12);
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
        let reference = Reference::get();
        assert!((centroid(reference.right_pulse()) - TRAVEL).abs() < 2e-6);
    }
}
