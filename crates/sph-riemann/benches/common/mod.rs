//! Blocks of copper that benches advance.

use sph_core::{Components, Domain, Particle, Particles};
use sph_riemann::{Settings, Simulation, SolidDimension};

/// The allocator of the programs.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const SIZE: f64 = 1e-6;

/// A periodic lattice of `cells` particles along each axis in a smooth flow; with two pores in each square of 20, if
/// asked for.
pub fn lattice<D: SolidDimension>(cells: usize, porous: bool, settings: Settings) -> Simulation<D> {
    let copper = sph_materials::library::material("porous-copper").expect("a library material");
    let length = cells as f64 * SIZE;
    let mut particles = Particles::<D>::default();
    for cell in 0..cells.pow(D::COUNT as u32) {
        let index = |a: usize| cell / cells.pow(a as u32) % cells;
        let position = D::vector(|a| (index(a) as f64 + 0.5) * SIZE);
        let in_pore = |shift: f64| {
            let to_center = |a: usize| (position[a] / SIZE - shift).rem_euclid(20.0) - 10.0;
            to_center(0).hypot(to_center(1)) < 4.06
        };
        if porous && (in_pore(0.0) || in_pore(10.0)) {
            continue;
        }
        let mass = 8960.0 * SIZE.powi(D::COUNT as i32);
        let mut particle = Particle::at_rest(cell as u64, position, mass, SIZE, 8960.0);
        let wave = |a: usize| (2.0 * std::f64::consts::PI * position[a] / (40.0 * SIZE)).sin();
        particle.velocity = D::vector(|a| 60.0 * wave(a) - 400.0);
        particles.push(particle);
    }
    let domain = Domain::new(D::vector(|_| 0.0), D::vector(|_| length), Components::from_fn(|_| true));
    let mut simulation = Simulation::new(domain, vec![copper], particles, settings).expect("a sound set-up");
    advance(&mut simulation, 10);
    simulation
}

pub fn advance<D: SolidDimension>(simulation: &mut Simulation<D>, steps: u64) {
    for _ in 0..steps {
        simulation.step().expect("a sound step");
    }
}
