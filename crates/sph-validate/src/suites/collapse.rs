//! Pore collapse: a piston drives four cells of porous copper, at 100 and at 300 m/s.
//!
//! Cells of 20 µm with two pores of 4.06 µm radius, periodic in y, D = 20 µm / n; a slab of eight columns with imposed
//! velocity at the left, a free surface at the right. The run ends when the compaction wave has passed three cells.
//! Closing pores throw jets, and single particles become hot; a scheme that is about to break shows it there first.
//! Measured: the largest and the least specific internal energy of a free particle, in means of the particles that the
//! wave has passed (those faster than half of the piston).
//!
//! Source: medium of Rublev and Murzov (2024), section 4; the gates are this project's.

use sph_core::{Constraint, Dim2, Domain, Particles};
use sph_materials::Material;

use super::{About, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::Outcome;
use crate::run::{Run, material, particle_at};
use crate::watch::Watch;

/// Edge of a cell [m].
const CELL: f64 = 20e-6;
/// Radius of a pore [m].
const RADIUS: f64 = 4.06e-6;
const CELLS: u32 = 4;
/// Columns of the piston.
const PISTON: u32 = 8;
/// Velocities of the piston [m/s] by variant, and of the compaction wave that they drive, about.
const VARIANTS: [(&str, f64, f64); 2] = [("100", 100.0, 430.0), ("300", 300.0, 1100.0)];

/// Largest energy of a particle.
const LARGEST: Metric = Metric::value("largest_energy", "means");
/// Least energy of a particle, where it is negative.
const LEAST: Metric = Metric::value("least_energy", "means");

/// The suite.
pub struct Collapse;

impl Suite for Collapse {
    fn about(&self) -> About {
        About {
            name: "collapse",
            title: "Pore collapse",
            resolution: "particles along a cell",
            reference: ReferenceKind::Bounds,
            gates: include_str!("../../validation/collapse/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[10, 20],
            Tier::Full => &[10, 20, 40],
        };
        let of_variant = |(variant, _, _): &(&str, f64, f64)| {
            Case::grid_of("collapse", variant, &[SchemeName::TkcHancock], resolutions)
        };
        VARIANTS.iter().flat_map(of_variant).collect()
    }

    fn work(&self, case: &Case) -> f64 {
        let n = f64::from(case.n);
        let (_, _, wave) = variant(case).unwrap_or(VARIANTS[0]);
        let steps = duration(wave) * 4720.0 * n / CELL / case.scheme.courant();
        f64::from(CELLS) * n * n * 0.74 * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let copper = material("porous-copper")?;
        let (_, speed, wave) = variant(case)?;
        let domain = Domain::new([-1.0, 0.0].into(), [1.0, CELL].into(), [false, true]);
        let particles = particles(case.n, speed, &copper);
        let mut run = Run::new(case, watch, domain, copper, particles, case.scheme.settings())?;
        run.advance(duration(wave))?;
        let particles = run.simulation.particles();
        let free = || (0..particles.len()).filter(|&i| particles.constraint[i] == Constraint::Free);
        let energy = |i: usize| particles.specific_internal_energy[i];
        let passed: Vec<usize> = free().filter(|&i| particles.velocity[0][i] > 0.5 * speed).collect();
        let mean = passed.iter().map(|&i| energy(i)).sum::<f64>() / passed.len() as f64;
        let largest = free().map(energy).fold(0.0, f64::max) / mean;
        let least = free().map(energy).fold(0.0, f64::min) / mean;
        let measurements = vec![Measurement::error_of(LARGEST, largest), Measurement::error_of(LEAST, least)];
        Ok(run.outcome(measurements, Vec::new(), Vec::new()))
    }
}

fn variant(case: &Case) -> Result<(&'static str, f64, f64), ValidateError> {
    let known = VARIANTS.into_iter().find(|(name, _, _)| *name == case.variant);
    known.ok_or_else(|| ValidateError::Material(format!("no variant {} of pore collapse", case.variant)))
}

/// The wave has passed three cells [s].
fn duration(wave: f64) -> f64 {
    3.0 * CELL / wave
}

fn particles(n: u32, speed: f64, copper: &Material) -> Particles<Dim2> {
    let size = CELL / f64::from(n);
    let mut particles = Particles::default();
    for column in 0..PISTON + CELLS * n {
        for row in 0..n {
            let x = (f64::from(column) - f64::from(PISTON) + 0.5) * size;
            let y = (f64::from(row) + 0.5) * size;
            let in_pore = |center: f64| {
                let dx = x.rem_euclid(CELL) - center;
                let dy = y - center;
                x > 0.0 && dx * dx + dy * dy < RADIUS * RADIUS
            };
            if in_pore(0.25 * CELL) || in_pore(0.75 * CELL) {
                continue;
            }
            let mut particle =
                particle_at::<Dim2>(particles.len(), [x, y].into(), size, copper.reference_density);
            if column < PISTON {
                particle.constraint = Constraint::ImposedVelocity;
                particle.velocity.x = speed;
            }
            particles.push(particle);
        }
    }
    particles
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The area of two pores of 4.06 µm in a cell of 20 µm: m = 1.349, and a percent for the staircase.
    #[test]
    fn medium_has_its_porosity() {
        let copper = material("porous-copper").expect("in the library");
        let particles = particles(40, 100.0, &copper);
        let free = particles.constraint.iter().filter(|&&c| c == Constraint::Free).count();
        let porosity = f64::from(CELLS * 40 * 40) / free as f64;
        assert!((porosity / 1.349 - 1.0).abs() < 0.01, "{porosity}");
    }
}
