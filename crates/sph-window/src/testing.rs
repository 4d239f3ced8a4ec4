//! What the unit tests share.

use crate::feed::FeedSample;
use sph_core::dimension::{Components, Dimension};
use sph_core::domain::Domain;
use sph_core::particles::{Particle, Particles};

/// A square or cubic lattice of copper at rest: particles of a size [m], so many along each axis.
pub fn lattice<D: Dimension>(size: f64, counts: [usize; 3]) -> FeedSample<D> {
    let total: usize = counts[..D::COUNT].iter().product();
    let mut particles = Particles::default();
    for index in 0..total {
        let mut rest = index;
        let position = D::vector(|axis| {
            let place = (rest % counts[axis]) as f64 + 0.5;
            rest /= counts[axis];
            place * size
        });
        let mass = 8960.0 * size.powi(D::COUNT as i32);
        particles.push(Particle::at_rest(index as u64, position, mass, size, 8960.0));
    }
    let cell = Domain::new(
        D::vector(|_| 0.0),
        D::vector(|axis| counts[axis] as f64 * size),
        Components::from_fn(|_| true),
    );
    FeedSample::new(particles, cell).expect("a lattice is a good sample")
}
