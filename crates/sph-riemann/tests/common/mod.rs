//! Blocks of copper that tests set in motion.

use sph_core::lanes::InstructionSet;
use sph_core::{Components, Dimension, Domain, Particle, Particles, Vector};
use sph_riemann::{Settings, Simulation, SolidDimension};

/// Particle size of the blocks [m].
pub const SIZE: f64 = 1e-6;

/// A periodic block of `cells` particles along each axis with a round pore in the middle, jittered by `jitter` particle
/// sizes, in a smooth motion of amplitude `speed` [m/s] with a total momentum that is not zero.
#[allow(dead_code)] // Each test file compiles this module for itself.
pub fn porous_block<D: SolidDimension>(cells: usize, jitter: f64, speed: f64) -> (Domain<D>, Particles<D>) {
    let length = cells as f64 * SIZE;
    let domain = Domain::new(D::vector(|_| 0.0), D::vector(|_| length), Components::from_fn(|_| true));
    let mut particles = Particles::default();
    let mut random = 12345_u64;
    let mut noise = || {
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (random >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    for cell in 0..cells.pow(D::COUNT as u32) {
        let index = |a: usize| cell / cells.pow(a as u32) % cells;
        let position = D::vector(|a| (index(a) as f64 + 0.5 + jitter * noise()) * SIZE);
        let from_center = position - D::vector(|_| 0.5 * length);
        if from_center.length() < 0.2 * length {
            continue;
        }
        let mass = 8960.0 * SIZE.powi(D::COUNT as i32);
        let mut particle = Particle::at_rest(cell as u64, position, mass, SIZE, 8960.0);
        let phase = |a: usize| 2.0 * std::f64::consts::PI * position[a] / length;
        particle.velocity = D::vector(|a| speed * (0.3 + phase((a + 1) % D::COUNT).sin() + phase(a).cos()));
        particles.push(particle);
    }
    (domain, particles)
}

/// The block as a simulation.
#[allow(dead_code)] // As above.
pub fn simulation<D: SolidDimension>(cells: usize, jitter: f64, settings: Settings) -> Simulation<D> {
    let copper = sph_materials::library::material("porous-copper").expect("a library material");
    let (domain, particles) = porous_block::<D>(cells, jitter, 100.0);
    Simulation::new(domain, vec![copper], particles, settings).expect("a sound set-up")
}

/// Takes steps.
#[allow(dead_code)] // As above.
pub fn advance<D: SolidDimension>(simulation: &mut Simulation<D>, steps: usize) {
    for _ in 0..steps {
        simulation.step().expect("a sound step");
    }
}

/// Every number of every particle, by id.
#[allow(dead_code)] // Each test file compiles this module for itself.
pub fn bits<D: Dimension>(particles: &Particles<D>) -> Vec<(u64, Vec<u64>)> {
    let columns = particles.columns();
    let of = |i: usize| columns.iter().map(|(_, column)| column[i].to_bits()).collect();
    let mut list: Vec<(u64, Vec<u64>)> = (0..particles.len()).map(|i| (particles.id[i], of(i))).collect();
    list.sort();
    list
}

/// The same block with each set of instructions of this machine.
#[allow(dead_code)]
pub fn with_every_set<D: SolidDimension>(build: impl Fn() -> Simulation<D>) -> Vec<Simulation<D>> {
    InstructionSet::available().into_iter().map(|set| build().with_instructions(set)).collect()
}
