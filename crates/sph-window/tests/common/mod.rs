//! Solid copper for the tests: a strip, one period of which is a few particles long.
#![allow(dead_code)]

use sph_core::dimension::{Components, Dimension};
use sph_core::domain::Domain;
use sph_core::particles::{Particle, Particles};
use sph_materials::{Material, library};
use sph_riemann::{Scheme, Settings, SolidDimension};
use sph_window::{FeedSample, Window, WindowSettings};

/// Particle size [m].
pub const SIZE: f64 = 1e-6;

pub fn copper() -> Material {
    library::material("porous-copper").expect("the library has it")
}

/// One period of solid copper: so many particles along each axis.
pub fn solid<D: Dimension>(counts: [usize; 3]) -> FeedSample<D> {
    medium(counts, |_| true)
}

/// One period of a lattice of copper particles, those for which `keep` (of the place in particle sizes) holds.
pub fn medium<D: Dimension>(counts: [usize; 3], keep: impl Fn([f64; 3]) -> bool) -> FeedSample<D> {
    let density = copper().reference_density;
    let total: usize = counts[..D::COUNT].iter().product();
    let mut particles = Particles::default();
    for index in 0..total {
        let (mut rest, mut place) = (index, [0.0; 3]);
        for axis in 0..D::COUNT {
            place[axis] = (rest % counts[axis]) as f64 + 0.5;
            rest /= counts[axis];
        }
        if keep(place) {
            let position = D::vector(|axis| place[axis] * SIZE);
            let mass = density * SIZE.powi(D::COUNT as i32);
            particles.push(Particle::at_rest(index as u64, position, mass, SIZE, density));
        }
    }
    let upper = D::vector(|axis| counts[axis] as f64 * SIZE);
    let cell = Domain::new(D::vector(|_| 0.0), upper, Components::from_fn(|_| true));
    FeedSample::new(particles, cell).expect("a good sample")
}

pub fn solver() -> Settings {
    Settings::for_scheme(Scheme::TkcHancock)
}

pub fn window<D: SolidDimension>(sample: FeedSample<D>, settings: WindowSettings) -> Window<D> {
    Window::new(sample, vec![copper()], solver(), settings).expect("a good window")
}
