//! Mass, momentum and energy through both ends of the window.
//!
//! ```text
//! C(t) = C(0) + C_fed     (what came in at the inlet)
//!             - C_out     (what went out at the removal plane)
//!             + C_imposed (what constraints put in)
//!             + C_boost   (what changes of the frame put in)
//! ```
//!
//! for each content `C`: mass, momentum and total energy (internal and kinetic). The particles' equations
//! conserve all three to round-off, so that the ledger closes to round-off too, in any frame. A boost by `w` adds
//! `M w` to the momentum and `P_x w + M w²/2` to the energy. Imposed velocities put in an impulse and work:
//! during a step (the solver reports them), when a particle enters a region, and when an imposed velocity is changed.

use serde::{Deserialize, Serialize};
use sph_core::dimension::{Dimension, Vector};
use sph_core::particles::{Particle, Particles};
use std::ops::AddAssign;

/// Mass, momentum and energy (per unit depth in plane strain).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Content {
    /// Mass [kg, kg/m].
    pub mass: f64,
    /// Momentum, zero along an axis that is not there [kg m/s, kg/s].
    pub momentum: [f64; 3],
    /// Internal and kinetic energy [J, J/m].
    pub energy: f64,
}

impl Content {
    /// Content of one particle.
    pub fn of_particle<D: Dimension>(particle: &Particle<D>) -> Self {
        let energy = particle.specific_internal_energy + 0.5 * particle.velocity.dot(particle.velocity);
        Self::new::<D>(particle.mass, particle.velocity * particle.mass, particle.mass * energy)
    }

    /// Content from a mass, a momentum and an energy.
    pub fn new<D: Dimension>(mass: f64, momentum: D::Vector, energy: f64) -> Self {
        let mut content = Self { mass, momentum: [0.0; 3], energy };
        (0..D::COUNT).for_each(|axis| content.momentum[axis] = momentum[axis]);
        content
    }

    /// Content of all particles, added in their order.
    pub fn of_particles<D: Dimension>(particles: &Particles<D>) -> Self {
        let mut sum = Self::default();
        (0..particles.len()).for_each(|i| sum += Self::of_particle(&particles.get(i)));
        sum
    }

    fn apply(&mut self, other: &Self, mut operation: impl FnMut(&mut f64, f64)) {
        operation(&mut self.mass, other.mass);
        (0..3).for_each(|axis| operation(&mut self.momentum[axis], other.momentum[axis]));
        operation(&mut self.energy, other.energy);
    }
}

impl AddAssign for Content {
    fn add_assign(&mut self, other: Self) {
        self.apply(&other, |a, b| *a += b);
    }
}

/// Sets a particle's velocity and returns the momentum and energy that this put in.
pub(crate) fn impose_velocity<D: Dimension>(
    particles: &mut Particles<D>,
    i: usize,
    velocity: D::Vector,
) -> Content {
    let (before, mass) = (particles.velocity_of(i), particles.mass[i]);
    (0..D::COUNT).for_each(|axis| particles.velocity[axis][i] = velocity[axis]);
    let change = velocity - before;
    Content::new::<D>(0.0, change * mass, 0.5 * mass * change.dot(velocity + before))
}

/// What has come in and gone out since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Content at the start.
    pub start: Content,
    /// Through the inlet.
    pub fed: Content,
    /// Through the removal plane.
    pub removed: Content,
    /// Impulse and work of imposed velocities (its mass stays zero).
    pub imposed: Content,
    /// Change of momentum and energy with the frame (its mass stays zero).
    pub boosted: Content,
    /// Particles that came in.
    pub particles_fed: u64,
    /// Particles that went out.
    pub particles_removed: u64,
    throughput: Content,
}

impl Ledger {
    /// A ledger that starts with a content.
    pub fn new(start: Content) -> Self {
        let mut ledger = Self { start, ..Self::default() };
        ledger.count(&start);
        ledger
    }

    /// Books a particle that came in.
    pub fn feed(&mut self, content: Content) {
        self.fed += content;
        self.particles_fed += 1;
        self.count(&content);
    }

    /// Books a particle that went out.
    pub fn remove(&mut self, content: Content) {
        self.removed += content;
        self.particles_removed += 1;
        self.count(&content);
    }

    /// Books impulse and work of imposed velocities.
    pub fn impose(&mut self, content: Content) {
        self.imposed += content;
        self.count(&content);
    }

    /// Books a boost by a velocity along x [m/s] of what was in the box before it.
    pub fn boost(&mut self, velocity: f64, before: &Content) {
        let mut content = Content::default();
        content.momentum[0] = before.mass * velocity;
        content.energy = velocity * before.momentum[0] + 0.5 * before.mass * velocity * velocity;
        self.boosted += content;
        self.count(&content);
        self.count(before);
    }

    fn count(&mut self, content: &Content) {
        self.throughput.apply(content, |a, b| *a += b.abs());
    }

    /// What the box should hold.
    pub fn expected(&self) -> Content {
        let mut sum = self.start;
        sum += self.fed;
        sum.apply(&self.removed, |a, b| *a -= b);
        sum += self.imposed;
        sum += self.boosted;
        sum
    }

    /// What the box holds less what it should hold.
    pub fn residual(&self, now: &Content) -> Content {
        let mut difference = *now;
        difference.apply(&self.expected(), |a, b| *a -= b);
        difference
    }

    /// Largest residual as a part of all that was ever booked of the same content [-]: round-off when the ledger closes.
    /// Not a number where one of them is not.
    pub fn relative_residual(&self, now: &Content) -> f64 {
        self.relative_residuals(now).into_iter().fold(0.0, larger)
    }

    /// Residuals of mass, momentum and energy, each as a part of all that was ever booked of it [-].
    pub fn relative_residuals(&self, now: &Content) -> [f64; 3] {
        let (residual, scale) = (self.residual(now), self.throughput);
        let momentum = residual.momentum.iter().fold(0.0, |m: f64, p| larger(m, p.abs()));
        let momentum_scale = scale.momentum.iter().fold(0.0, |m: f64, &p| m.max(p));
        // A content that was never there (momentum of a medium at rest) has no scale, and no residual either.
        let part = |value: f64, scale: f64| if value == 0.0 { 0.0 } else { value.abs() / scale };
        [part(residual.mass, scale.mass), part(momentum, momentum_scale), part(residual.energy, scale.energy)]
    }
}

/// The larger of two magnitudes; not a number where one is not (`f64::max` would hide it).
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::lattice;
    use sph_core::dimension::{Dim2, Dim3};

    fn boosts_and_imposed_velocities_close<D: Dimension>() {
        let mut particles = lattice::<D>(1e-6, [6, 4, 3]).particles().clone();
        for i in 0..particles.len() {
            particles.velocity[0][i] = -300.0 + 1.7 * i as f64;
            particles.velocity[1][i] = 0.3 * i as f64;
            particles.specific_internal_energy[i] = 100.0 * i as f64;
        }
        let mut ledger = Ledger::new(Content::of_particles(&particles));
        for w in [-512.3, 87.1, 3000.0] {
            ledger.boost(w, &Content::of_particles(&particles));
            particles.velocity[0].iter_mut().for_each(|u| *u += w);
            for i in 0..5 {
                let velocity = D::vector(|axis| if axis == 0 { -w } else { 0.0 });
                ledger.impose(impose_velocity(&mut particles, i, velocity));
            }
        }
        let last = particles.len() - 1;
        ledger.remove(Content::of_particle(&particles.get(last)));
        particles.retain(|i| i != last);
        let extra = particles.get(3);
        ledger.feed(Content::of_particle(&extra));
        particles.push(extra);
        let now = Content::of_particles(&particles);
        assert!(ledger.relative_residual(&now) < 1e-14, "{:?}", ledger.residual(&now));
        particles.specific_internal_energy[2] += 1.0;
        assert!(ledger.relative_residual(&Content::of_particles(&particles)) > 1e-9, "a gap is seen");
        assert_eq!((ledger.particles_fed, ledger.particles_removed), (1, 1));
    }

    #[test]
    fn boosts_and_imposed_velocities_close_in_both_dimensions() {
        boosts_and_imposed_velocities_close::<Dim2>();
        boosts_and_imposed_velocities_close::<Dim3>();
    }

    #[test]
    fn nothing_at_rest_has_no_residual() {
        let particles = lattice::<Dim2>(1e-6, [2, 2, 1]).particles().clone();
        let now = Content::of_particles(&particles);
        assert_eq!(Ledger::new(now).relative_residual(&now), 0.0);
    }

    #[test]
    fn what_is_not_a_number_is_no_closed_book() {
        let mut particles = lattice::<Dim2>(1e-6, [2, 2, 1]).particles().clone();
        particles.velocity[0][0] = 100.0;
        let ledger = Ledger::new(Content::of_particles(&particles));
        particles.velocity[1][0] = f64::NAN;
        assert!(ledger.relative_residual(&Content::of_particles(&particles)).is_nan());
        particles.velocity[1][0] = 0.0;
        particles.specific_internal_energy[0] = f64::NAN;
        assert!(ledger.relative_residual(&Content::of_particles(&particles)).is_nan());
    }
}
