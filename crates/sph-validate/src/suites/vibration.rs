//! Elastic bodies that vibrate freely: a ring that breathes, a plate that bends. Period against theory.
//!
//! * `ring`: aluminum, radii 80 and 100 mm, elastic, n concentric rings of particles; u = -U0 R0/r, U0 = 5 m/s.
//! * `plate`: beryllium, 60 × 10 mm, elastic, n particles across the thickness on a square lattice; u_y in the shape of
//!   the first bending mode of a thin plate, 11 m/s at the ends: the oscillating plate of the literature at a small
//!   amplitude.
//!
//! Open domain, θ = 0.5, one and a half periods. Signal: Σ m r·u of the ring, Σ m u_y φ(x) of the plate; its zeros are
//! half a period apart.
//!
//! Measured: the period, twice the time between its first and its second zero, also in % off the reference; the amplitude
//! left, that of the second extreme over the start.
//!
//! Reference: ring: the same ring on a Lagrangian mesh of 400 zones, read likewise. Plate: Timoshenko's beam in plane
//! strain ([`crate::reference::beam`]), good to some 0.2 %.
//!
//! Source: ring: A. E. H. Love, Mathematical Theory of Elasticity; plate: S. Sambasivan, M. Shashkov, D. E. Burton, Int. J.
//! Numer. Meth. Fluids 72 (2013) 770 (beryllium plate).

use std::f64::consts::TAU;

use sph_core::geometry::{Lattice, concentric_rings};
use sph_core::{CoreError, Dim2, Domain, Particle, Particles};
use sph_io::plot::{Axis, Figure};
use sph_materials::eos::Linear;
use sph_materials::{EquationOfState, Failure, Material, SoundSpeedModel, Strength};

use super::{About, Drawing, Picture, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::{Curve, Outcome};
use crate::plots;
use crate::reference::beam::FreePlate;
use crate::reference::lagrangian::{Ends, Mesh, Scheme, Solid, Symmetry, Viscosity, Zone};
use crate::run::Run;
use crate::watch::Watch;

const RADII: [f64; 2] = [0.08, 0.1];
const RING_VELOCITY: f64 = 5.0;
const PLATE_VELOCITY: f64 = 11.0;
const LENGTH: f64 = 0.06;
const THICKNESS: f64 = 0.01;
const ZONES: usize = 400;

/// Period.
const PERIOD: Metric = Metric::value("period", "us");
/// The same, off the reference.
const PERIOD_ERROR: Metric = Metric::value("period_error", "%");
/// Amplitude after half a period over that at the start.
const KEPT: Metric = Metric::value("amplitude_kept", "-");

/// Signal over time [s], 1 at the start.
type Signal = Vec<(f64, f64)>;

/// The suite.
pub struct Vibration;

impl Suite for Vibration {
    fn about(&self) -> About {
        About {
            name: "vibration",
            title: "Vibrating elastic ring and plate",
            resolution: "particles across the thickness",
            reference: ReferenceKind::External,
            gates: include_str!("../../validation/vibration/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[5],
            Tier::Full => &[5, 10, 20],
        };
        let grid = |variant: &'static str| Case::grid_of("vibration", variant, &SchemeName::ALL, resolutions);
        ["ring", "plate"].into_iter().flat_map(grid).collect()
    }

    fn work(&self, case: &Case) -> f64 {
        let n = f64::from(case.n);
        let (particles, steps) = if case.variant == "plate" {
            (6.0 * n * n, 1.3 * 30e-6 * 13_200.0 * n / THICKNESS)
        } else {
            (28.0 * n * n, 1.3 * 105e-6 * 6400.0 * n / 0.02)
        };
        particles * steps / case.scheme.courant() * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let packing =
            |error: CoreError| ValidateError::Packing { case: case.to_string(), reason: error.to_string() };
        if case.variant == "plate" {
            let plate = plate();
            let particles = bent(case.n, &plate).map_err(packing)?;
            let period = TAU / plate.frequency();
            let signal = |particles: &Particles<Dim2>| bending(particles, &plate);
            let cosine =
                |k: u32| (0.7 * period * f64::from(k) / 200.0, (0.7 * TAU * f64::from(k) / 200.0).cos());
            let exact = Exact { period, kept: 1.0, signal: (0..=200).map(cosine).collect() };
            run(case, watch, beryllium(), particles, &exact, signal)
        } else {
            let particles = breathing(case.n).map_err(packing)?;
            let exact = Exact::of(ring_on_mesh());
            run(case, watch, aluminum(), particles, &exact, radial)
        }
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let mut pictures = Vec::new();
        for (variant, label) in [("ring", "1-D mesh"), ("plate", "Timoshenko's period")] {
            let of = plots::of_variant(outcomes, variant);
            let Some(first) = of.first() else { continue };
            let figure = Figure::new(
                format!("Vibrating {variant}"),
                Axis::new("t [µs]"),
                Axis::new("velocity of the mode [-]"),
            );
            let reference = first.curve("reference");
            pictures.push(Picture {
                name: format!("vibration-{variant}"),
                caption: format!("velocity of the mode of the {variant} over time, 1 at the start"),
                drawing: Drawing::Plot(plots::profiles(figure, &of, "signal", (label, reference))),
            });
        }
        Ok(pictures)
    }
}

/// What the vibration should be.
struct Exact {
    period: f64,
    kept: f64,
    signal: Signal,
}

impl Exact {
    fn of(signal: Signal) -> Self {
        let [first, second] = zeros(&signal);
        Self { period: 2.0 * (second - first), kept: kept(&signal), signal }
    }
}

fn run(
    case: &Case,
    watch: Watch<'_>,
    material: Material,
    particles: Particles<Dim2>,
    exact: &Exact,
    read: impl Fn(&Particles<Dim2>) -> f64,
) -> Result<Outcome, ValidateError> {
    let start = read(&particles);
    let mut run = Run::new(case, watch, Domain::open(), material, particles, case.scheme.settings())?;
    let mut signal: Signal = vec![(0.0, 1.0)];
    let end = exact.signal.last().map_or(0.0, |point| point.0).max(0.9 * exact.period);
    while run.simulation.time() < end * (1.0 - 1e-12) {
        run.step(end)?;
        let time = run.simulation.time();
        signal.push((time, read(run.simulation.particles()) / start));
        run.tell(time / end);
    }
    let [first, second] = zeros(&signal);
    let period = 2.0 * (second - first);
    let measurements = vec![
        Measurement::new(PERIOD, 1e6 * period, 1e6 * exact.period),
        Measurement::error_of(PERIOD_ERROR, 100.0 * (period / exact.period - 1.0)),
        Measurement::new(KEPT, kept(&signal), exact.kept),
    ];
    let shown = |signal: &Signal| signal.iter().map(|&(t, s)| (1e6 * t, s)).collect();
    let curves = vec![Curve::new("signal", shown(&signal)), Curve::new("reference", shown(&exact.signal))];
    Ok(run.outcome(measurements, curves, Vec::new()))
}

/// First two times at which a signal passes zero; not a number where it does not.
fn zeros(signal: &[(f64, f64)]) -> [f64; 2] {
    let pass = |pair: &[(f64, f64)]| {
        let [(t0, s0), (t1, s1)] = [pair[0], pair[1]];
        (s0 * s1 < 0.0).then(|| t0 + s0 / (s0 - s1) * (t1 - t0))
    };
    let mut passes = signal.windows(2).filter_map(pass);
    [(); 2].map(|()| passes.next().unwrap_or(f64::NAN))
}

/// Greatest excursion to the other side: the first swing back.
fn kept(signal: &[(f64, f64)]) -> f64 {
    -signal.iter().map(|point| point.1).fold(f64::INFINITY, f64::min)
}

/// Σ m r·u.
fn radial(particles: &Particles<Dim2>) -> f64 {
    let of = |i: usize| particles.mass[i] * particles.position_of(i).dot(particles.velocity_of(i));
    (0..particles.len()).map(of).sum()
}

/// Σ m u_y φ(x).
fn bending(particles: &Particles<Dim2>, plate: &FreePlate) -> f64 {
    let shape = |i: usize| plate.shape(particles.position[0][i] + 0.5 * LENGTH);
    (0..particles.len()).map(|i| particles.mass[i] * particles.velocity[1][i] * shape(i)).sum()
}

fn elastic(name: &str, density: f64, bulk_modulus: f64, shear_modulus: f64) -> Material {
    Material {
        name: name.into(),
        reference_density: density,
        equation_of_state: EquationOfState::Linear(Linear {
            bulk_sound_speed: (bulk_modulus / density).sqrt(),
        }),
        strength: Strength::Elastic { shear_modulus },
        failure: Failure::None,
        sound_speed: SoundSpeedModel::Thermodynamic,
    }
}

fn aluminum() -> Material {
    elastic("elastic aluminum", 2785.0, 2785.0 * 5328.0 * 5328.0, 27.6e9)
}

fn beryllium() -> Material {
    elastic("elastic beryllium", 1845.0, 118.896e9, 151e9)
}

fn plate() -> FreePlate {
    FreePlate {
        length: LENGTH,
        thickness: THICKNESS,
        density: 1845.0,
        bulk_modulus: 118.896e9,
        shear_modulus: 151e9,
    }
}

/// The ring at the start.
fn breathing(n: u32) -> Result<Particles<Dim2>, CoreError> {
    let density = aluminum().reference_density;
    let size = (RADII[1] - RADII[0]) / f64::from(n);
    let packing = concentric_rings(Default::default(), RADII[0], RADII[1], size)?;
    let mut particles = Particles::default();
    for (point, volume) in packing.points().zip(&packing.volume) {
        let mut particle = Particle::at_rest(particles.len() as u64, point, density * volume, size, density);
        let radius = point.length();
        particle.velocity = point * (-RING_VELOCITY * RADII[0] / (radius * radius));
        particles.push(particle);
    }
    Ok(particles)
}

/// The plate at the start, about the origin.
fn bent(n: u32, plate: &FreePlate) -> Result<Particles<Dim2>, CoreError> {
    let size = THICKNESS / f64::from(n);
    let corner = [0.5 * LENGTH, 0.5 * THICKNESS];
    let packing = Lattice::Square.fill_box::<Dim2>(corner.map(|c| -c).into(), corner.into(), size)?;
    let mut particles = Particles::default();
    for (point, volume) in packing.points().zip(&packing.volume) {
        let id = particles.len() as u64;
        let mut particle = Particle::at_rest(id, point, plate.density * volume, size, plate.density);
        let velocity = 0.5 * PLATE_VELOCITY * plate.shape(point.x + 0.5 * LENGTH);
        particle.velocity = [0.0, velocity].into();
        particles.push(particle);
    }
    Ok(particles)
}

/// The ring on the mesh: Σ m r u over the nodes, from the zones' middles, until nine tenths of its period.
fn ring_on_mesh() -> Signal {
    let material = aluminum();
    let pressure = |density: f64, energy: f64| material.pressure(density, energy);
    let solid = Solid {
        pressure: &pressure,
        shear_modulus: 27.6e9,
        yield_strength: f64::INFINITY,
        sound_speed: 6600.0,
    };
    let scheme = Scheme {
        symmetry: Symmetry::Cylindrical,
        ends: Ends::Free,
        cfl: 0.7,
        viscosity: Viscosity::default(),
    };
    let rest = Zone { density: material.reference_density, energy: 0.0, deviator: [0.0; 3] };
    let inwards = |r: f64| -RING_VELOCITY * RADII[0] / r;
    let mut mesh = Mesh::new(solid, scheme, RADII, ZONES, |_| rest, inwards);
    // Mass of a zone is r_mid Δr ρ; of all of them equal parts of the signal.
    let read = |mesh: &Mesh<'_>| -> f64 {
        let (r, u) = (mesh.radius(), mesh.velocity());
        (0..ZONES).map(|k| mesh.middle(k) * 0.5 * (r[k] * u[k] + r[k + 1] * u[k + 1])).sum()
    };
    let start = read(&mesh);
    let mut signal = vec![(0.0, 1.0)];
    while mesh.time() < 1.1e-4 {
        mesh.step(mesh.time_step());
        signal.push((mesh.time(), read(&mesh) / start));
    }
    signal
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A thin ring in plane strain has ω = sqrt(E/(ρ(1 - ν²)))/R; the thick one is within a percent of its mean radius'.
    #[test]
    fn ring_on_the_mesh_has_about_the_period_of_a_thin_one() {
        let exact = Exact::of(ring_on_mesh());
        let (k, g): (f64, f64) = (2785.0 * 5328.0 * 5328.0, 27.6e9);
        let young = 9.0 * k * g / (3.0 * k + g);
        let poisson = (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g));
        let thin = TAU * 0.09 / (young / (2785.0 * (1.0 - poisson * poisson))).sqrt();
        println!("ring: {:.3} µs, thin {:.3} µs, kept {:.4}", 1e6 * exact.period, 1e6 * thin, exact.kept);
        assert!((exact.period / thin - 1.0).abs() < 0.02, "{} {thin}", exact.period);
    }

    #[test]
    fn plate_starts_without_momentum_and_spin() {
        let plate = plate();
        let particles = bent(10, &plate).expect("a plate");
        assert_eq!(particles.len(), 600);
        let momentum: f64 = (0..600).map(|i| particles.mass[i] * particles.velocity[1][i]).sum();
        let spin: f64 =
            (0..600).map(|i| particles.mass[i] * particles.velocity[1][i] * particles.position[0][i]).sum();
        assert!(momentum.abs() < 2e-3 * 1845.0 * LENGTH * THICKNESS * PLATE_VELOCITY, "{momentum}");
        assert!(spin.abs() < 1e-6 * momentum.abs().max(1e-9), "{spin}");
    }

    #[test]
    fn zeros_and_swing_of_a_cosine() {
        let signal: Signal = (0..200).map(|k| 0.05 * f64::from(k)).map(|t| (t, t.cos())).collect();
        let [first, second] = zeros(&signal);
        assert!((first - 0.25 * TAU).abs() < 1e-3 && (second - 0.75 * TAU).abs() < 1e-3);
        assert!((kept(&signal) - 1.0).abs() < 1e-3);
        assert!(zeros(&signal[..10])[0].is_nan());
    }
}
