//! Stopping and going on with the same bits.
//!
//! A restart needs the particles in their order, the clock, and the positions that the neighbor lists were built from:
//! built again from those, the lists are the same, slot by slot, and so is every sum.

use serde::{Deserialize, Serialize};
use sph_core::dimension::Components;
use sph_core::domain::Domain;
use sph_core::particles::Particles;
use sph_materials::Material;

use crate::dimension::SolidDimension;
use crate::error::SetupError;
use crate::interventions::Interventions;
use crate::scheme::Settings;
use crate::simulation::Simulation;

/// What a restart needs beside the particles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Clock {
    /// Time [s].
    pub time: f64,
    /// Number of steps.
    pub step_count: u64,
    /// Sum over the steps of the number of particles.
    pub particle_steps: u64,
    /// ∫ P |dV| of the density that volume consistency changed [J], per meter of depth in the plane.
    pub relaxation_work: f64,
    /// How often a bound acted.
    pub interventions: Interventions,
}

impl<D: SolidDimension> Simulation<D> {
    /// The clock, to be saved with [`Simulation::particles`] and [`Simulation::list_positions`].
    pub fn clock(&self) -> Clock {
        Clock {
            time: self.time(),
            step_count: self.step_count(),
            particle_steps: self.particle_steps(),
            relaxation_work: self.relaxation_work(),
            interventions: self.interventions(),
        }
    }

    /// Positions that the present neighbor lists were built from, by axis [m]; `None` if the next step will build
    /// new ones.
    pub fn list_positions(&self) -> Option<&[Vec<f64>]> {
        self.lists_hold().then(|| self.lists().reference())
    }

    /// A simulation that goes on where another was saved, with the same bits. `particles` must be in the order in which
    /// they were saved, with every column.
    ///
    /// # Errors
    /// As [`Simulation::new`]; list positions that do not fit the particles, or are not finite.
    pub fn restore(
        domain: Domain<D>,
        materials: Vec<Material>,
        particles: Particles<D>,
        settings: Settings,
        clock: Clock,
        list_positions: Option<&[Vec<f64>]>,
    ) -> Result<Self, SetupError> {
        let count = particles.len();
        let mut simulation = Self::new(domain, materials, particles, settings)?;
        simulation.set_clock(clock);
        if let Some(positions) = list_positions {
            let lengths: Vec<usize> = positions.iter().map(Vec::len).collect();
            if lengths != vec![count; D::COUNT] {
                return Err(SetupError::ListPositions { lengths, count });
            }
            for (axis, positions) in positions.iter().enumerate() {
                if let Some(particle) = positions.iter().position(|x| !x.is_finite()) {
                    return Err(SetupError::ListPosition { particle, axis, value: positions[particle] });
                }
            }
            let positions: D::AxisColumns = Components::from_fn(|a| positions[a].clone());
            simulation.find_neighbors(&positions);
            simulation.motion_share = simulation.lists.motion_share(&simulation.particles.position);
        }
        Ok(simulation)
    }
}
