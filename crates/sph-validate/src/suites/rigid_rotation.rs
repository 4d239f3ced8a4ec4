//! A body under stress is turned as a whole: the stress must turn with it.
//!
//! A square body of 16 × 16 particles of elastic copper (no thermal pressure) with a uniform stress (S_xx = 1, S_yy = -0.6, S_xy = 0.5,
//! S_zz = -0.4 GPa) is turned once by n steps. The motion is imposed: before each step every particle stands exactly
//! where the turn has brought it. Schemes with explicit Euler steps get the velocity along the circle, the time-centered
//! one that along the chord of the step: with it the matter turns rigidly about the middle of the step. Nothing deforms, so that nothing but the rotation of the
//! stress by the scheme's own velocity gradient is left, at the edges and corners of the body too.
//!
//! Measured: the greatest distance over the particles of S from the initial S turned exactly, and of the density from
//! the initial one, in %.
//!
//! Reference: exact, S = R S0 Rᵀ. A gradient that is exact for a linear field leaves the error of the step's rotation,
//! second order. TKC-Hancock is of the first order here: it advances the sides of a contact by the acceleration of the
//! stress, which is none, while the imposed motion is accelerated. A free body has no such mismatch (suite
//! `spinning-disc`).

use std::f64::consts::TAU;

use glam::DVec2;
use sph_core::{Constraint, Dim2, Domain, Particles};
use sph_riemann::Settings;

use super::{About, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::Outcome;
use crate::run::{Run, material, particle_at};
use crate::watch::Watch;

const SIZE: f64 = 1e-3;
const EDGE: u32 = 16;
/// Time of a turn [s]: long enough that the Courant number never shortens a step.
const PERIOD: f64 = 40e-6;
/// S_xx, S_yy, S_zz, S_xy at the start [Pa].
const STRESS: [f64; 4] = [1e9, -0.6e9, -0.4e9, 0.5e9];

/// Greatest |S - R S0 Rᵀ| over |S0|.
const STRESS_ERROR: Metric = Metric::value("stress_error", "%");
/// Greatest |ρ - ρ0| over ρ0.
const DENSITY_ERROR: Metric = Metric::value("density_error", "%");

/// The suite.
pub struct RigidRotation;

impl Suite for RigidRotation {
    fn about(&self) -> About {
        About {
            name: "rigid-rotation",
            title: "Rigid rotation of a body under stress",
            resolution: "steps of a turn",
            reference: ReferenceKind::Analytic,
            gates: include_str!("../../validation/rigid-rotation/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[1000],
            Tier::Full => &[1000, 2000, 4000],
        };
        Case::grid("rigid-rotation", &SchemeName::ALL, resolutions)
    }

    fn work(&self, case: &Case) -> f64 {
        // Lists are made anew in each step.
        3.0 * f64::from(EDGE * EDGE * case.n) * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let copper = material("copper-sound-wave")?;
        let density = copper.reference_density;
        // Motion is imposed: a long step is inaccurate at most.
        let settings = Settings { courant: 0.9, ..case.scheme.settings() };
        let mut run = Run::new(case, watch, Domain::open(), copper, body(density), settings)?;
        let chord = case.scheme.scheme().is_time_centered().then_some(1.0 / f64::from(case.n));
        for step in 0..case.n {
            run.change(|particles| place(particles, f64::from(step) / f64::from(case.n), chord));
            run.step(PERIOD * f64::from(step + 1) / f64::from(case.n))?;
            run.tell(f64::from(step + 1) / f64::from(case.n));
        }
        let turns = run.simulation.time() / PERIOD;
        let reached = (turns * f64::from(case.n)).round();
        if reached != f64::from(case.n) {
            let reason = format!("the Courant number allowed only {turns:.3} of the turn");
            return Err(ValidateError::NotReached { case: case.to_string(), reason });
        }
        let particles = run.simulation.particles();
        let size = contraction(STRESS).sqrt();
        let stress = |i: usize| {
            let off: [f64; 4] = std::array::from_fn(|k| particles.deviator[k][i] - STRESS[k]);
            contraction(off).sqrt() / size
        };
        let density_error = |i: usize| (particles.density[i] / density - 1.0).abs();
        let greatest = |of: &dyn Fn(usize) -> f64| (0..particles.len()).map(of).fold(0.0, f64::max);
        let measurements = vec![
            Measurement::error_of(STRESS_ERROR, 100.0 * greatest(&stress)),
            Measurement::error_of(DENSITY_ERROR, 100.0 * greatest(&density_error)),
        ];
        Ok(run.outcome(measurements, Vec::new(), Vec::new()))
    }
}

/// S:S of components xx, yy, zz, xy.
fn contraction([xx, yy, zz, xy]: [f64; 4]) -> f64 {
    xx * xx + yy * yy + zz * zz + 2.0 * xy * xy
}

fn start(id: u64) -> DVec2 {
    let along = |k: u64| (k as f64 + 0.5 - 0.5 * f64::from(EDGE)) * SIZE;
    DVec2::new(along(id % u64::from(EDGE)), along(id / u64::from(EDGE)))
}

fn body(density: f64) -> Particles<Dim2> {
    let mut particles = Particles::default();
    for id in 0..u64::from(EDGE * EDGE) {
        let mut particle = particle_at::<Dim2>(id as usize, start(id), SIZE, density);
        (particle.deviator, particle.constraint) = (STRESS, Constraint::ImposedVelocity);
        particles.push(particle);
    }
    place(&mut particles, 0.0, None);
    particles
}

/// Puts every particle where it is after so many turns, with a velocity: that along its circle, or, over a step of so many
/// turns, that along the chord.
fn place(particles: &mut Particles<Dim2>, turns: f64, chord: Option<f64>) {
    let turn = DVec2::from_angle(TAU * turns);
    for i in 0..particles.len() {
        let position = turn.rotate(start(particles.id[i]));
        let velocity = match chord {
            None => position.perp() * (TAU / PERIOD),
            Some(step) => (DVec2::from_angle(TAU * step).rotate(position) - position) / (step * PERIOD),
        };
        for a in 0..2 {
            particles.position[a][i] = position[a];
            particles.velocity[a][i] = velocity[a];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stress_is_a_deviator_and_the_body_turns() {
        assert!((STRESS[0] + STRESS[1] + STRESS[2]).abs() < 1.0);
        let mut particles = body(8960.0);
        place(&mut particles, 0.25, None);
        let first = DVec2::new(particles.position[0][0], particles.position[1][0]);
        assert!((first - start(0).perp()).length() < 1e-15);
        let speed = particles.velocity_of(0).length();
        assert!((speed - TAU / PERIOD * first.length()).abs() < 1e-9 * speed);
    }
}
