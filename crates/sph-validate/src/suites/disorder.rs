//! What disorder of the particles costs: the Riemann problem on jittered lattices, with faces open and closed.
//!
//! On a disordered cloud the area vectors of a particle's pairs do not sum up to zero, and a uniform stress accelerates
//! it: an error that does not fall with the resolution. Every free particle is moved by up to `jitter` particle sizes
//! along each axis, uniformly at random with a fixed seed; the problem is that of [`super::riemann`]. Variants:
//! `open-J` and `closed-J` with J the jitter, closed by [`sph_riemann::FaceClosure`]. The volume sums are held against
//! those of the start ([`sph_riemann::PackingReference::Start`]).

use sph_core::{Constraint, Dim2, Domain, Particles};
use sph_riemann::{FaceClosure, PackingReference, Settings, VolumeConsistency};

use super::riemann::{
    DURATION, FROZEN_LAYERS, LENGTH, Problem, ROWS, SMOOTHING, particles, stress_error, stresses,
};
use super::{About, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::outcome::Outcome;
use crate::run::{Run, material};
use crate::watch::Watch;

/// Name of a variant, largest displacement in particle sizes, faces closed or not.
const VARIANTS: [(&str, f64, bool); 7] = [
    ("closed-0", 0.0, true),
    ("open-0.05", 0.05, false),
    ("closed-0.05", 0.05, true),
    ("open-0.1", 0.1, false),
    ("closed-0.1", 0.1, true),
    ("open-0.2", 0.2, false),
    ("closed-0.2", 0.2, true),
];

/// The suite.
pub struct Disorder;

impl Suite for Disorder {
    fn about(&self) -> About {
        About {
            name: "disorder",
            title: "Riemann problem on disordered particles",
            resolution: "particles along x",
            reference: ReferenceKind::Analytic,
            gates: include_str!("../../validation/disorder/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[100, 200],
            Tier::Full => &[100, 200, 400],
        };
        let of_variant = |(variant, _, _): &(&str, f64, bool)| {
            Case::grid_of("disorder", variant, &[SchemeName::TkcHancock], resolutions)
        };
        VARIANTS.iter().flat_map(of_variant).collect()
    }

    fn work(&self, case: &Case) -> f64 {
        let n = f64::from(case.n);
        let steps = DURATION * 6400.0 * n / LENGTH / case.scheme.courant();
        let closed = case.variant.starts_with("closed");
        6.0 * n * steps * case.scheme.price() * if closed { 2.5 } else { 1.0 }
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let material = material("aluminium-riemann")?;
        let problem = Problem::published()?;
        let (_, jitter, closed) = VARIANTS
            .into_iter()
            .find(|(name, _, _)| *name == case.variant)
            .ok_or_else(|| ValidateError::Material(format!("no variant {} of disorder", case.variant)))?;
        let size = LENGTH / f64::from(case.n);
        let half = 0.5 * LENGTH + f64::from(FROZEN_LAYERS) * size;
        let domain = Domain::new([-half, 0.0].into(), [half, f64::from(ROWS) * size].into(), [false, true]);
        let mut particles = particles(case.n, &problem);
        shake(&mut particles, jitter * size);
        let mut run = Run::new(case, watch, domain, material, particles, settings(case.scheme, closed))?;
        run.advance(DURATION)?;
        let error = stress_error(&stresses(&run), &problem);
        Ok(run.outcome(vec![error], Vec::new(), Vec::new()))
    }
}

fn settings(scheme: SchemeName, closed: bool) -> Settings {
    let volume = VolumeConsistency { reference: PackingReference::Start, ..VolumeConsistency::default() };
    Settings {
        smoothing: SMOOTHING,
        face_closure: closed.then(FaceClosure::default),
        volume_consistency: Some(volume),
        ..scheme.settings()
    }
}

/// Moves each free particle by up to `amplitude` [m] along each axis.
pub(super) fn shake(particles: &mut Particles<Dim2>, amplitude: f64) {
    // Knuth's linear congruential generator; its upper bits.
    let mut state = 12345_u64;
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        2.0 * ((state >> 11) as f64 / (1_u64 << 53) as f64) - 1.0
    };
    for i in 0..particles.len() {
        for axis in 0..2 {
            let shift = amplitude * noise();
            if particles.constraint[i] == Constraint::Free {
                particles.position[axis][i] += shift;
            }
        }
    }
}
