//! Contact of two metals: a plate of one strikes a plate of the other, held against the exact impedance match.
//!
//! Along the Hugoniots P = ρ0 (c + s w) w of both metals, w the jump of velocity, the plates share pressure and velocity:
//! P_a(u0 - u*) = P_b(u*). Without strength that is exact for the state between the shocks, whatever the sizes and masses
//! of the particles. Left out are a few particle sizes beside the contact: there the start heats or cools the metals (wall
//! heating), which changes density and energy but neither pressure nor velocity.

use glam::DVec2;
use sph_core::{Dim2, Domain, Particle, Particles};
use sph_materials::eos::MieGruneisen;
use sph_materials::{EquationOfState, Failure, Material, SoundSpeedModel, Strength};
use sph_riemann::{Settings, Simulation};

const LENGTH: f64 = 100e-6;
const HEIGHT: f64 = 12e-6;

fn metal(name: &str, density: f64, c: f64, s: f64, gamma: f64) -> (Material, MieGruneisen) {
    let hugoniot = MieGruneisen { bulk_sound_speed: c, hugoniot_slope: s, gruneisen_coefficient: gamma };
    let material = Material {
        name: name.into(),
        reference_density: density,
        equation_of_state: EquationOfState::MieGruneisen(hugoniot),
        strength: Strength::Fluid,
        failure: Failure::None,
        sound_speed: SoundSpeedModel::Thermodynamic,
    };
    (material, hugoniot)
}

/// Copper; aluminum (alloy 2024, LASL Shock Hugoniot Data, 1980).
fn metals() -> [(Material, MieGruneisen); 2] {
    [metal("copper", 8960.0, 3930.0, 1.5, 1.7), metal("aluminum", 2785.0, 5328.0, 1.338, 2.0)]
}

/// Pressure [Pa] behind a shock that changes the velocity by w [m/s].
fn hugoniot_pressure((material, h): &(Material, MieGruneisen), w: f64) -> f64 {
    material.reference_density * (h.bulk_sound_speed + h.hugoniot_slope * w) * w
}

/// Pressure [Pa] and velocity [m/s] between the shocks.
fn impedance_match(a: &(Material, MieGruneisen), b: &(Material, MieGruneisen), speed: f64) -> (f64, f64) {
    let (mut low, mut high) = (0.0, speed);
    for _ in 0..200 {
        let u = 0.5 * (low + high);
        if hugoniot_pressure(b, u) < hugoniot_pressure(a, speed - u) { low = u } else { high = u }
    }
    (hugoniot_pressure(b, low), low)
}

/// Plate of `a` with `speed` on a plate of `b` at rest, particles of the two sizes [m].
fn plates(metals: &[(Material, MieGruneisen); 2], speed: f64, sizes: [f64; 2]) -> Simulation<Dim2> {
    let mut particles = Particles::<Dim2>::default();
    for (k, size) in sizes.into_iter().enumerate() {
        let (columns, rows) = ((LENGTH / size).round() as usize, (HEIGHT / size).round() as usize);
        for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
            let left = if k == 0 { -LENGTH } else { 0.0 };
            let place = DVec2::new(left + (i as f64 + 0.5) * size, (j as f64 + 0.5) * size);
            let density = metals[k].0.reference_density;
            let id = particles.len() as u64;
            let mut particle = Particle::<Dim2>::at_rest(id, place, density * size * size, size, density);
            particle.material = k as u16;
            particle.velocity.x = if k == 0 { speed } else { 0.0 };
            particles.push(particle);
        }
    }
    let domain = Domain::new(DVec2::new(-LENGTH, 0.0), DVec2::new(LENGTH, HEIGHT), [false, true]);
    let materials = metals.iter().map(|m| m.0.clone()).collect();
    Simulation::new(domain, materials, particles, Settings::default()).expect("a sound set-up")
}

/// Mean of |P/P* - 1| and |u/u* - 1| between the shocks, on both sides, 8 to 25 particle sizes from the contact.
fn errors(simulation: &Simulation<Dim2>, exact: (f64, f64), speed: f64) -> [(f64, f64); 2] {
    let p = simulation.particles();
    let contact = exact.1 * simulation.time();
    [0, 1].map(|k| {
        let near = |i: &usize| {
            let distance = (p.position[0][*i] - contact).abs();
            p.material[*i] == k && (8e-6..25e-6).contains(&distance)
        };
        let (mut count, mut sums) = (0.0, (0.0, 0.0));
        for i in (0..p.len()).filter(near) {
            count += 1.0;
            sums.0 += (simulation.pressure(i) / exact.0 - 1.0).abs();
            sums.1 += (p.velocity[0][i] - exact.1).abs() / speed;
        }
        assert!(count > 50.0, "material {k}");
        (sums.0 / count, sums.1 / count)
    })
}

#[test]
fn plates_of_two_metals_share_the_pressure_and_velocity_of_the_impedance_match() {
    let [copper, aluminum] = metals();
    for (metals, sizes) in [
        ([copper.clone(), aluminum.clone()], [1e-6, 1e-6]),
        ([copper.clone(), aluminum.clone()], [1e-6, 1.5e-6]),
        ([aluminum.clone(), copper.clone()], [1e-6, 1e-6]),
        ([aluminum, copper], [1e-6, 1.5e-6]),
    ] {
        let speed = 600.0;
        let exact = impedance_match(&metals[0], &metals[1], speed);
        let mut simulation = plates(&metals, speed, sizes);
        while simulation.time() < 9e-9 {
            simulation.step().expect("a sound step");
        }
        let found = errors(&simulation, exact, speed);
        println!(
            "{} on {}, sizes {sizes:?}: {exact:?}, (P, u) off by {found:?}",
            metals[0].0.name, metals[1].0.name
        );
        for (pressure, velocity) in found {
            assert!(pressure < PRESSURE && velocity < VELOCITY, "{found:?}");
        }
    }
}

/// Largest mean errors: of the pressure, relative, and of the velocity, relative to the impact's.
const PRESSURE: f64 = 0.001;
const VELOCITY: f64 = 0.0005;
