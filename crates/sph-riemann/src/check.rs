//! What a simulation checks before it begins: settings, materials, periods, particles; and particles again where they were
//! changed from outside.

use sph_core::dimension::Components;
use sph_core::domain::Domain;
use sph_core::particles::Particles;
use sph_materials::Material;

use crate::dimension::SolidDimension;
use crate::error::SetupError;
use crate::scheme::Settings;

/// Fails with the first thing that cannot be.
pub(crate) fn check<D: SolidDimension>(
    domain: &Domain<D>,
    materials: &[Material],
    particles: &Particles<D>,
    settings: &Settings,
) -> Result<(), SetupError> {
    let faults = settings.faults();
    if !faults.is_empty() {
        return Err(SetupError::Settings(faults));
    }
    for material in materials {
        material.validate().map_err(|faults| SetupError::Material {
            name: material.name.clone(),
            faults: faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "),
        })?;
    }
    for axis in (0..D::COUNT).filter(|&a| domain.periodic[a]) {
        let period = domain.period(axis);
        if !(period > 0.0 && period.is_finite()) {
            return Err(SetupError::Period { axis, period });
        }
    }
    check_particles(particles, materials.len())
}

/// Fails with the first particle that cannot be, among those of `count` materials.
pub(crate) fn check_particles<D: SolidDimension>(
    particles: &Particles<D>,
    count: usize,
) -> Result<(), SetupError> {
    (0..particles.len()).try_for_each(|i| check_particle(particles, i, count))
}

fn check_particle<D: SolidDimension>(
    particles: &Particles<D>,
    i: usize,
    count: usize,
) -> Result<(), SetupError> {
    let particle = particles.id[i];
    let material = particles.material[i];
    if material as usize >= count {
        return Err(SetupError::NoSuchMaterial { particle, material, count });
    }
    let fault = |field, value, unit| Err(SetupError::Particle { particle, field, value, unit });
    for (field, value, unit) in [
        ("mass", particles.mass[i], "kg"),
        ("size", particles.size[i], "m"),
        ("density", particles.density[i], "kg/m3"),
    ] {
        if !(value > 0.0 && value.is_finite()) {
            return fault(field, value, unit);
        }
    }
    let energy = particles.specific_internal_energy[i];
    if !energy.is_finite() {
        return fault("specific internal energy", energy, "J/kg");
    }
    let coordinates: D::Axes<f64> =
        Components::from_fn(|a| particles.position[a][i] + particles.velocity[a][i]);
    match (0..D::COUNT).find(|&a| !coordinates[a].is_finite()) {
        Some(a) => fault("position or velocity", coordinates[a], "m or m/s"),
        None => Ok(()),
    }
}
