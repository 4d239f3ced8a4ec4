//! A free elastic disc spins: angular momentum and place after one turn.
//!
//! Copper of the sound-wave problem, elastic; a disc of n particles' radius cut from a square lattice (its middle
//! between particles), its rim moving with 2 % of 5000 m/s, one turn, open domain, θ = 0.5.
//!
//! Measured: the share of the angular momentum that is left, and the mean distance of the particles from where a rigid
//! turn puts them, in % of the radius. The disc stretches a little (2e-4 of the radius) and rings.
//!
//! Reference: exact, the laws of motion of a rigid body. The scheme exchanges forces that are not along the line between
//! two particles: nothing in it guarantees this law.

use std::f64::consts::TAU;

use glam::DVec2;
use sph_core::{Dim2, Domain, Particles};
use sph_materials::Failure;

use super::{About, Picture, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::{Field, Outcome};
use crate::plots;
use crate::run::{Run, material, particle_at};
use crate::watch::Watch;

const RADIUS: f64 = 12e-3;
/// Velocity of the rim [m/s].
const RIM: f64 = 100.0;
/// Time of a turn [s].
const PERIOD: f64 = TAU * RADIUS / RIM;

/// Share of the angular momentum that is left.
const KEPT: Metric = Metric::value("angular_momentum_kept", "-");
/// Mean distance from the rigid turn.
const PLACE: Metric = Metric::value("place_error", "% of R");

/// The suite.
pub struct SpinningDisc;

impl Suite for SpinningDisc {
    fn about(&self) -> About {
        About {
            name: "spinning-disc",
            title: "Spinning elastic disc",
            resolution: "particles along the radius",
            reference: ReferenceKind::Analytic,
            gates: include_str!("../../validation/spinning-disc/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        // Printed, the second scheme costs four times the third.
        let resolutions: [&[u32]; 2] = match tier {
            Tier::Quick => [&[6], &[6]],
            Tier::Full => [&[6, 9, 12], &[6, 12, 24]],
        };
        let mut cases = Case::grid("spinning-disc", &[SchemeName::TkcMuscl], resolutions[0]);
        cases.extend(Case::grid(
            "spinning-disc",
            &[SchemeName::Csph, SchemeName::TkcHancock],
            resolutions[1],
        ));
        cases
    }

    fn work(&self, case: &Case) -> f64 {
        let n = f64::from(case.n);
        let steps = PERIOD * 5200.0 * n / RADIUS / case.scheme.courant();
        0.5 * TAU * n * n * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let mut copper = material("copper-sound-wave")?;
        copper.failure = Failure::None;
        let particles = disc(case.n, copper.reference_density);
        let start: Vec<DVec2> = (0..particles.len()).map(|i| particles.position_of(i)).collect();
        let before = angular_momentum(&particles);
        let mut run = Run::new(case, watch, Domain::open(), copper, particles, case.scheme.settings())?;
        run.advance(PERIOD)?;
        let particles = run.simulation.particles();
        // After a whole turn each particle should be where it was.
        let distance = |i: usize| (particles.position_of(i) - start[particles.id[i] as usize]).length();
        let mean = (0..particles.len()).map(distance).sum::<f64>() / particles.len() as f64;
        let measurements = vec![
            Measurement::new(KEPT, angular_momentum(particles) / before, 1.0),
            Measurement::error_of(PLACE, 100.0 * mean / RADIUS),
        ];
        let field = field(&run);
        Ok(run.outcome(measurements, Vec::new(), vec![field]))
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let side = (-1.5e3 * RADIUS, 1.5e3 * RADIUS);
        Ok(plots::fields("spinning-disc", outcomes, |field| plots::field_image(field, side, side)))
    }
}

/// The disc, spinning against the clock.
fn disc(n: u32, density: f64) -> Particles<Dim2> {
    let size = RADIUS / f64::from(n);
    let mut particles = Particles::default();
    let half = i64::from(n);
    for (i, j) in (-half..half).flat_map(|i| (-half..half).map(move |j| (i, j))) {
        let position = DVec2::new(i as f64 + 0.5, j as f64 + 0.5) * size;
        if position.length() < RADIUS {
            let mut particle = particle_at::<Dim2>(particles.len(), position, size, density);
            particle.velocity = position.perp() * (RIM / RADIUS);
            particles.push(particle);
        }
    }
    particles
}

fn angular_momentum(particles: &Particles<Dim2>) -> f64 {
    let of = |i: usize| particles.mass[i] * particles.position_of(i).perp_dot(particles.velocity_of(i));
    (0..particles.len()).map(of).sum()
}

/// The disc after the turn; its speed over what its place should have.
fn field(run: &Run<'_, Dim2>) -> Field {
    let particles = run.simulation.particles();
    let millimeters = |column: &[f64]| column.iter().map(|x| 1e3 * x).collect();
    let extent = |i: usize| 1e3 * (particles.mass[i] / particles.density[i]).sqrt();
    Field {
        name: "end".into(),
        title: format!(
            "{}, {} particles along the radius, after one turn",
            run.case.scheme.title(),
            run.case.n
        ),
        label: "speed [m/s]".into(),
        range: (0.0, RIM),
        x: millimeters(&particles.position[0]),
        y: millimeters(&particles.position[1]),
        size: (0..particles.len()).map(extent).collect(),
        values: (0..particles.len()).map(|i| particles.velocity_of(i).length()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn disc_turns_as_a_rigid_body() {
        let particles = disc(24, 8960.0);
        let mass: f64 = particles.mass.iter().sum();
        assert!((mass / (8960.0 * 0.5 * TAU * RADIUS * RADIUS) - 1.0).abs() < 0.01);
        // ½ m R² ω.
        let exact = 0.5 * mass * RADIUS * RIM;
        assert!((angular_momentum(&particles) / exact - 1.0).abs() < 0.01);
    }
}
