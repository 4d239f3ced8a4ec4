//! The particles at one moment, as the field images need them.

use serde::{Deserialize, Serialize};
use sph_core::Dim2;
use sph_window::Window;

/// Squares are drawn larger than √(m/ρ) by this factor: sheared lattices then show no seams, and pores hardly shrink.
const OVERLAP: f64 = 1.2;

/// Edge [m] of the square that a particle of this mass [kg/m] and density [kg/m³] is drawn in.
pub fn drawn_size(mass: f64, density: f64) -> f64 {
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
        }
    }
}
