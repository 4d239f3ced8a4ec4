//! The outlet: the piston that follows the shock, and the removal plane.
//!
//! A particle that enters outlet 1 takes the velocity `-u_out` along x and none across; its state goes on to
//! evolve. In outlet 2 the state is frozen too. Left of x = 0 it is removed. Constraints only grow on the way out, so
//! that an outlet at rest keeps its particles.

use crate::ledger::{Content, Ledger, impose_velocity};
use crate::region::{Region, Regions};
use sph_core::dimension::Dimension;
use sph_core::particles::{Constraint, Particles};

/// Imposes on the particles what their part of the outlet asks for; returns the momentum and energy put in.
pub(crate) fn impose<D: Dimension>(
    particles: &mut Particles<D>,
    regions: &Regions,
    outlet_velocity: f64,
) -> Content {
    let mut sum = Content::default();
    let velocity = D::vector(|axis| if axis == 0 { -outlet_velocity } else { 0.0 });
    for i in 0..particles.len() {
        let x = particles.position[0][i];
        if x >= regions.outlet_end {
            continue;
        }
        if particles.constraint[i] == Constraint::Free {
            sum += impose_velocity(particles, i, velocity);
            particles.constraint[i] = Constraint::ImposedVelocity;
        }
        if regions.region_of(x) != Region::OutletVelocity {
            particles.constraint[i] = Constraint::Frozen;
        }
    }
    sum
}

/// Removes what has passed the removal plane and books it.
pub(crate) fn remove<D: Dimension>(particles: &mut Particles<D>, ledger: &mut Ledger) {
    let mut left = false;
    for i in 0..particles.len() {
        if particles.position[0][i] < 0.0 {
            ledger.remove(Content::of_particle(&particles.get(i)));
            left = true;
        }
    }
    if left {
        let keep: Vec<bool> = particles.position[0].iter().map(|&x| x >= 0.0).collect();
        particles.retain(|i| keep[i]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::region::RegionWidths;
    use crate::testing::lattice;
    use sph_core::dimension::Dim3;

    #[test]
    fn matter_is_braked_frozen_and_removed_and_the_ledger_closes() {
        let mut particles = lattice::<Dim3>(1e-6, [60, 2, 2]).particles().clone();
        let regions = Regions::new(6e-5, &RegionWidths::default(), 1e-6);
        for i in 0..particles.len() {
            particles.velocity[0][i] = -480.0;
            particles.velocity[2][i] = 3.0 * (i % 5) as f64;
        }
        let mut ledger = Ledger::new(Content::of_particles(&particles));
        for _ in 0..8 {
            ledger.impose(impose(&mut particles, &regions, 500.0));
            remove(&mut particles, &mut ledger);
            let velocity = particles.velocity[0].clone();
            particles.position[0].iter_mut().zip(velocity).for_each(|(x, u)| *x += 2e-9 * u);
        }
        assert_eq!(ledger.particles_removed, 4 * 7);
        assert!(ledger.relative_residual(&Content::of_particles(&particles)) < 1e-14);
        for i in 0..particles.len() {
            let expected = match particles.position[0][i] + 1e-6 {
                x if x < regions.frozen_end => Constraint::Frozen,
                x if x < regions.outlet_end => Constraint::ImposedVelocity,
                _ => Constraint::Free,
            };
            assert_eq!(particles.constraint[i], expected, "x = {}", particles.position[0][i]);
            let imposed = expected != Constraint::Free;
            assert_eq!(
                imposed,
                particles.velocity_of(i) == Dim3::vector(|axis| if axis == 0 { -500.0 } else { 0.0 })
            );
        }
    }
}
