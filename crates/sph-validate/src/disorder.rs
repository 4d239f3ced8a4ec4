//! What disorder of the particles costs: the Riemann problem on jittered lattices.
//!
//! On a disordered cloud the area vectors of a particle's pairs do not sum up to zero, and a uniform stress accelerates
//! it: an error that does not fall with the resolution (see the guide on disorder). Every free particle is moved by up to
//! `jitter` particle sizes along each axis, uniformly at random; the rest is [`crate::suites::riemann`].

use sph_core::{Constraint, Dim2, Domain, Particles};
use sph_riemann::{FaceClosure, Scheme, Settings};

use crate::case::{Case, SchemeName};
use crate::error::ValidateError;
use crate::run::{Run, material};
use crate::suites::riemann::{DURATION, FROZEN_LAYERS, LENGTH, Problem, ROWS, SMOOTHING, particles};
use crate::watch::Watch;

/// One run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disorder {
    /// Particles along x.
    pub n: u32,
    /// Largest displacement along each axis, in particle sizes [-].
    pub jitter: f64,
    /// Sweeps of the closure of faces; `None` leaves them open.
    pub sweeps: Option<u32>,
    /// Keeps the density at that of the packing, or not.
    pub volume_consistency: bool,
    /// Start of the random numbers.
    pub seed: u64,
}

/// Mean over the particles of |σ_xx - exact| at the end of the Riemann problem [Pa].
///
/// # Errors
/// A run that breaks down.
pub fn run(disorder: Disorder) -> Result<f64, ValidateError> {
    let material = material("aluminium-riemann")?;
    let problem = Problem::new(&material)?;
    let case = Case::new("riemann", SchemeName::TkcHancock, disorder.n);
    let size = LENGTH / f64::from(disorder.n);
    let half = 0.5 * LENGTH + f64::from(FROZEN_LAYERS) * size;
    let domain = Domain::new([-half, 0.0].into(), [half, f64::from(ROWS) * size].into(), [false, true]);
    let mut particles = particles(disorder.n, &problem);
    shake(&mut particles, disorder.jitter * size, disorder.seed);
    let usual = Settings::for_scheme(Scheme::TkcHancock);
    let settings = Settings {
        smoothing: SMOOTHING,
        face_closure: disorder.sweeps.map(|sweeps| FaceClosure { sweeps }),
        volume_consistency: usual.volume_consistency.filter(|_| disorder.volume_consistency),
        ..usual
    };
    let mut run = Run::new(&case, Watch::silent(), domain, material, particles, settings)?;
    run.advance(DURATION)?;
    let simulation = &run.simulation;
    let particles = simulation.particles();
    let free: Vec<usize> =
        (0..particles.len()).filter(|&i| particles.constraint[i] == Constraint::Free).collect();
    let error = |i: usize| {
        let exact = problem.solution.sample(particles.position[0][i] / DURATION).stress;
        (simulation.stress(i)[0] - exact).abs()
    };
    Ok(free.iter().map(|&i| error(i)).sum::<f64>() / free.len() as f64)
}

/// Moves each free particle by up to `amplitude` [m] along each axis.
fn shake(particles: &mut Particles<Dim2>, amplitude: f64, seed: u64) {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(12345);
    let mut noise = || {
        // Knuth's linear congruential generator; its upper bits.
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
