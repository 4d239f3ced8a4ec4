//! The particles at one moment, as the field images need them.

use serde::{Deserialize, Serialize};
use sph_core::neighbors::kd_tree::KdTree;
use sph_core::{Dim2, Domain, Particles};
use sph_window::Window;

/// Distance up to which a neighbor counts for the slip [D].
const REACH: f64 = 1.2;
/// Squares are drawn larger than √(m/ρ) by this factor: sheared lattices then show no seams, and pores hardly shrink.
const OVERLAP: f64 = 1.2;

/// Edge [m] of the square that a particle of this mass [kg/m] and density [kg/m³] is drawn in.
pub(crate) fn drawn_size(mass: f64, density: f64) -> f64 {
    OVERLAP * (mass / density).sqrt()
}

/// Places and fields of all particles at one moment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fields {
    /// Time [s].
    pub time: f64,
    /// Length of the box and height of the cell [m].
    pub extent: (f64, f64),
    /// x [m].
    pub x: Vec<f64>,
    /// y within the cell [m].
    pub y: Vec<f64>,
    /// Edge of the square that a particle is drawn in [m].
    pub size: Vec<f64>,
    /// The particles' own density [kg/m³].
    pub density: Vec<f64>,
    /// σ_xx [Pa].
    pub stress: Vec<f64>,
    /// u_x relative to the undisturbed medium [m/s].
    pub velocity: Vec<f64>,
    /// Equivalent plastic strain [-].
    pub plastic_strain: Vec<f64>,
    /// Largest slip past a neighbor: the part of the difference of velocities that is across the line to it [m/s].
    pub slip: Vec<f64>,
}

impl Fields {
    /// The window's present state.
    pub fn of(window: &Window<Dim2>) -> Self {
        let (simulation, cell) = (window.simulation(), window.sample().cell());
        let particles = simulation.particles();
        let (height, lower) = (cell.period(1), cell.lower.y);
        Self {
            time: window.time(),
            extent: (window.regions().length, height),
            x: particles.position[0].clone(),
            y: particles.position[1].iter().map(|y| (y - lower).rem_euclid(height)).collect(),
            size: particles
                .mass
                .iter()
                .zip(&particles.density)
                .map(|(m, rho)| drawn_size(*m, *rho))
                .collect(),
            density: particles.density.clone(),
            stress: (0..particles.len()).map(|i| simulation.stress(i)[0]).collect(),
            velocity: particles.velocity[0].iter().map(|u| u + window.inlet_velocity()).collect(),
            plastic_strain: particles.plastic_strain.clone(),
            slip: slip(particles, simulation.domain()),
        }
    }
}

/// For each particle the largest jump of the tangential velocity to a neighbor within [`REACH`] of its size [m/s]: where
/// matter slides along a band one particle wide, that is the velocity with which it does.
fn slip(particles: &Particles<Dim2>, domain: &Domain<Dim2>) -> Vec<f64> {
    let Ok(tree) = KdTree::<Dim2>::new(&particles.position, domain) else {
        return vec![f64::NAN; particles.len()];
    };
    let height = domain.period(1);
    let jump = |i: usize, j: usize| {
        let mut line = particles.position_of(j) - particles.position_of(i);
        line.y -= height * (line.y / height).round();
        let difference = particles.velocity_of(j) - particles.velocity_of(i);
        difference.perp_dot(line.normalize()).abs()
    };
    let largest = |i: usize| {
        let near = tree.within(particles.position_of(i), REACH * particles.size[i]);
        near.iter().map(|n| n.0 as usize).filter(|&j| j != i).map(|j| jump(i, j)).fold(0.0, f64::max)
    };
    (0..particles.len()).map(largest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use sph_core::Particle;

    #[test]
    fn a_slipping_line_is_found_and_a_pressed_one_is_not() {
        let mut particles = Particles::<Dim2>::default();
        for index in 0..100 {
            let position = DVec2::new((index % 10) as f64 + 0.5, (index / 10) as f64 + 0.5);
            let mut p = Particle::<Dim2>::at_rest(index, position, 1.0, 1.0, 1.0);
            // Matter right of x = 5 slides up with 30 m/s and comes nearer with 7 m/s.
            p.velocity = if position.x > 5.0 { DVec2::new(-7.0, 30.0) } else { DVec2::ZERO };
            particles.push(p);
        }
        let domain = Domain::new(DVec2::ZERO, DVec2::splat(10.0), [false, true]);
        for (i, slip) in slip(&particles, &domain).into_iter().enumerate() {
            let expected = if (particles.position[0][i] - 5.0).abs() < 0.6 { 30.0 } else { 0.0 };
            assert!((slip - expected).abs() < 1e-12, "{i}: {slip}");
        }
    }
}
