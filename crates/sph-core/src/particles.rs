//! Particles as a structure of arrays.
//!
//! One column per field, in cell order (see [`crate::neighbors`]), with stable identifiers. All state that a restart
//! needs is here, in `f64` columns that [`Particles::columns`] lists by name: sorting, insertion, removal and
//! checkpoints work on that list, so a new field is added in one place.
//!
//! Units are SI; stress is positive in tension.

use rayon::prelude::*;

use crate::dimension::{Components, Dimension};

/// What is imposed on a particle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[repr(u8)]
pub enum Constraint {
    /// Nothing: the equations of motion hold.
    #[default]
    Free = 0,
    /// The velocity is imposed, the state (density, energy, stress) evolves.
    ImposedVelocity = 1,
    /// Velocity and state are imposed: the particle only translates.
    Frozen = 2,
}

/// Everything that one particle carries: what is inserted, removed and looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle<D: Dimension> {
    /// Stable identifier, unique in a run.
    pub id: u64,
    /// Index into the list of materials.
    pub material: u16,
    /// What is imposed.
    pub constraint: Constraint,
    /// True once the particle has failed in tension.
    pub failed: bool,
    /// Position [m].
    pub position: D::Vector,
    /// Velocity U [m/s].
    pub velocity: D::Vector,
    /// Mass per unit depth in plane strain [kg/m], mass in space [kg].
    pub mass: f64,
    /// Particle size D [m].
    pub size: f64,
    /// Mass density ρ [kg/m³].
    pub density: f64,
    /// Specific internal energy e [J/kg].
    pub specific_internal_energy: f64,
    /// Stress deviator S [Pa].
    pub deviator: D::Tensor<f64>,
    /// Accumulated equivalent plastic strain [-].
    pub plastic_strain: f64,
    /// Largest speed relative to a neighbor in the last step [m/s]: an input of the next time step.
    pub relative_speed: f64,
    /// Excess ΔS of the volume sum over that of a perfect lattice at the last rebuild of the neighbor lists [-].
    pub packing_excess: f64,
    /// Volume sum that it is held against, where that is its own [-]; 0 where it has not been measured.
    pub packing_reference: f64,
    /// Volume over the volume without the voids that tension has opened [-]; 1 where none has.
    pub distension: f64,
}

impl<D: Dimension> Particle<D> {
    /// A free, stress-free particle of size `size` [m], mass `mass` and density `density` [kg/m³] at rest at `position`.
    pub fn at_rest(id: u64, position: D::Vector, mass: f64, size: f64, density: f64) -> Self {
        Self {
            id,
            material: 0,
            constraint: Constraint::Free,
            failed: false,
            position,
            velocity: D::Vector::default(),
            mass,
            size,
            density,
            specific_internal_energy: 0.0,
            deviator: Components::from_fn(|_| 0.0),
            plastic_strain: 0.0,
            relative_speed: 0.0,
            packing_excess: 0.0,
            packing_reference: 0.0,
            distension: 1.0,
        }
    }
}

/// Particles as a structure of arrays. All columns have the same length.
#[derive(Clone, Debug, PartialEq)]
pub struct Particles<D: Dimension> {
    /// Stable identifier, unique in a run.
    pub id: Vec<u64>,
    /// Index into the list of materials.
    pub material: Vec<u16>,
    /// What is imposed.
    pub constraint: Vec<Constraint>,
    /// True once the particle has failed in tension.
    pub failed: Vec<bool>,
    /// Position [m].
    pub position: D::AxisColumns,
    /// Velocity U [m/s].
    pub velocity: D::AxisColumns,
    /// Mass per unit depth in plane strain [kg/m], mass in space [kg].
    pub mass: Vec<f64>,
    /// Particle size D [m].
    pub size: Vec<f64>,
    /// Mass density ρ, as the particle carries it [kg/m³].
    pub density: Vec<f64>,
    /// Specific internal energy e, thermal and elastic [J/kg].
    pub specific_internal_energy: Vec<f64>,
    /// Stress deviator S [Pa].
    pub deviator: D::TensorColumns,
    /// Accumulated equivalent plastic strain [-].
    pub plastic_strain: Vec<f64>,
    /// Largest speed relative to a neighbor in the last step [m/s]: an input of the next time step.
    pub relative_speed: Vec<f64>,
    /// Excess ΔS of the volume sum over that of a perfect lattice at the last rebuild of the neighbor lists [-].
    pub packing_excess: Vec<f64>,
    /// Volume sum that it is held against, where that is its own [-]; 0 where it has not been measured.
    pub packing_reference: Vec<f64>,
    /// Volume over the volume without the voids that tension has opened [-]; 1 where none has.
    pub distension: Vec<f64>,
}

impl<D: Dimension> Default for Particles<D> {
    fn default() -> Self {
        Self {
            id: Vec::new(),
            material: Vec::new(),
            constraint: Vec::new(),
            failed: Vec::new(),
            position: Components::from_fn(|_| Vec::new()),
            velocity: Components::from_fn(|_| Vec::new()),
            mass: Vec::new(),
            size: Vec::new(),
            density: Vec::new(),
            specific_internal_energy: Vec::new(),
            deviator: Components::from_fn(|_| Vec::new()),
            plastic_strain: Vec::new(),
            relative_speed: Vec::new(),
            packing_excess: Vec::new(),
            packing_reference: Vec::new(),
            distension: Vec::new(),
        }
    }
}

impl<D: Dimension> Particles<D> {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// True without particles.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }

    /// Adds one particle behind the others.
    pub fn push(&mut self, p: Particle<D>) {
        self.id.push(p.id);
        self.material.push(p.material);
        self.constraint.push(p.constraint);
        self.failed.push(p.failed);
        for a in 0..D::COUNT {
            self.position[a].push(p.position[a]);
            self.velocity[a].push(p.velocity[a]);
        }
        self.mass.push(p.mass);
        self.size.push(p.size);
        self.density.push(p.density);
        self.specific_internal_energy.push(p.specific_internal_energy);
        for k in 0..D::TENSOR_COUNT {
            self.deviator[k].push(p.deviator[k]);
        }
        self.plastic_strain.push(p.plastic_strain);
        self.relative_speed.push(p.relative_speed);
        self.packing_excess.push(p.packing_excess);
        self.packing_reference.push(p.packing_reference);
        self.distension.push(p.distension);
    }

    /// A copy of particle `i`.
    pub fn get(&self, i: usize) -> Particle<D> {
        Particle {
            id: self.id[i],
            material: self.material[i],
            constraint: self.constraint[i],
            failed: self.failed[i],
            position: self.position_of(i),
            velocity: self.velocity_of(i),
            mass: self.mass[i],
            size: self.size[i],
            density: self.density[i],
            specific_internal_energy: self.specific_internal_energy[i],
            deviator: Components::from_fn(|k| self.deviator[k][i]),
            plastic_strain: self.plastic_strain[i],
            relative_speed: self.relative_speed[i],
            packing_excess: self.packing_excess[i],
            packing_reference: self.packing_reference[i],
            distension: self.distension[i],
        }
    }

    /// Position of particle `i` [m].
    #[inline]
    pub fn position_of(&self, i: usize) -> D::Vector {
        D::vector(|a| self.position[a][i])
    }

    /// Velocity of particle `i` [m/s].
    #[inline]
    pub fn velocity_of(&self, i: usize) -> D::Vector {
        D::vector(|a| self.velocity[a][i])
    }

    /// The `f64` columns with their names, in a fixed order: what a checkpoint stores.
    pub fn columns(&self) -> Vec<(String, &Vec<f64>)> {
        let axis = ["x", "y", "z"];
        let mut list = Vec::new();
        for a in 0..D::COUNT {
            list.push((format!("position_{}", axis[a]), &self.position[a]));
        }
        for a in 0..D::COUNT {
            list.push((format!("velocity_{}", axis[a]), &self.velocity[a]));
        }
        list.push(("mass".to_string(), &self.mass));
        list.push(("size".to_string(), &self.size));
        list.push(("density".to_string(), &self.density));
        list.push(("specific_internal_energy".to_string(), &self.specific_internal_energy));
        for (k, &(a, b)) in D::TENSOR_AXES.iter().enumerate() {
            list.push((format!("deviator_{}{}", axis[a], axis[b]), &self.deviator[k]));
        }
        list.push(("plastic_strain".to_string(), &self.plastic_strain));
        list.push(("relative_speed".to_string(), &self.relative_speed));
        list.push(("packing_excess".to_string(), &self.packing_excess));
        list.push(("packing_reference".to_string(), &self.packing_reference));
        list.push(("distension".to_string(), &self.distension));
        list
    }

    /// The `f64` columns for writing, in the order of [`Particles::columns`].
    pub fn columns_mut(&mut self) -> Vec<&mut Vec<f64>> {
        let mut list: Vec<&mut Vec<f64>> = Vec::new();
        list.extend(self.position.as_mut());
        list.extend(self.velocity.as_mut());
        list.extend([&mut self.mass, &mut self.size, &mut self.density, &mut self.specific_internal_energy]);
        list.extend(self.deviator.as_mut());
        list.extend([&mut self.plastic_strain, &mut self.relative_speed, &mut self.packing_excess]);
        list.extend([&mut self.packing_reference, &mut self.distension]);
        list
    }

    /// Keeps the particles for which `keep(index)` holds, in their order.
    pub fn retain(&mut self, mut keep: impl FnMut(usize) -> bool) {
        let order: Vec<u32> = (0..self.len() as u32).filter(|&i| keep(i as usize)).collect();
        self.gather(&order);
    }

    /// Replaces the particles by those of `order`, in that order (a permutation, or a selection).
    pub fn gather(&mut self, order: &[u32]) {
        fn pick<T: Copy>(column: &mut Vec<T>, order: &[u32], spare: &mut Vec<T>) {
            spare.clear();
            spare.extend(order.iter().map(|&i| column[i as usize]));
            std::mem::swap(column, spare);
        }
        pick(&mut self.id, order, &mut Vec::new());
        pick(&mut self.material, order, &mut Vec::new());
        pick(&mut self.constraint, order, &mut Vec::new());
        pick(&mut self.failed, order, &mut Vec::new());
        // Each column takes the memory of the one before.
        let columns = self.columns_mut().into_par_iter();
        columns.for_each_init(Vec::new, |spare, column| pick(column, order, spare));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::{Dim2, Dim3};

    fn particle<D: Dimension>(id: u64) -> Particle<D> {
        let x = id as f64;
        Particle {
            id,
            material: 0,
            constraint: Constraint::Free,
            failed: false,
            position: D::vector(|a| x + a as f64),
            velocity: D::vector(|a| -x - a as f64),
            mass: x,
            size: 1.0,
            density: 2.0,
            specific_internal_energy: 3.0,
            deviator: Components::from_fn(|k| x * k as f64),
            plastic_strain: 0.0,
            relative_speed: x,
            packing_excess: -x,
            packing_reference: 2.0 * x,
            distension: 1.0 + x,
        }
    }

    fn selection_keeps_every_field<D: Dimension<Tensor<f64>: PartialEq>>() {
        let mut particles = Particles::<D>::default();
        (0..10).for_each(|id| particles.push(particle(id)));
        particles.retain(|i| i % 3 == 0);
        particles.gather(&[3, 0, 2, 1]);
        for (i, id) in [9, 0, 6, 3].into_iter().enumerate() {
            assert_eq!(particles.get(i), particle(id));
        }
        assert_eq!(particles.columns().len(), particles.columns_mut().len());
        assert!(particles.columns().iter().all(|(_, c)| c.len() == 4));
    }

    #[test]
    fn selection_keeps_every_field_in_both_dimensions() {
        selection_keeps_every_field::<Dim2>();
        selection_keeps_every_field::<Dim3>();
    }
}
