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
    check_columns(particles)?;
    (0..particles.len()).try_for_each(|i| check_particle(particles, i, count))
}

/// All columns must hold one value for each particle.
fn check_columns<D: SolidDimension>(particles: &Particles<D>) -> Result<(), SetupError> {
    let count = particles.len();
    let others = [
        ("material", particles.material.len()),
        ("constraint", particles.constraint.len()),
        ("failed", particles.failed.len()),
    ];
    let others = others.map(|(name, length)| (name.to_owned(), length));
    let numbers = particles.columns().into_iter().map(|(name, column)| (name, column.len()));
    match others.into_iter().chain(numbers).find(|(_, length)| *length != count) {
        Some((name, length)) => Err(SetupError::Column { name, length, count }),
        None => Ok(()),
    }
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
    for (field, value, unit) in [
        ("plastic strain", particles.plastic_strain[i], "1"),
        ("relative speed", particles.relative_speed[i], "m/s"),
        ("packing excess", particles.packing_excess[i], "1"),
        ("packing reference", particles.packing_reference[i], "1"),
    ] {
        if !value.is_finite() {
            return fault(field, value, unit);
        }
    }
    let distension = particles.distension[i];
    if !(distension >= 1.0 && distension.is_finite()) {
        return fault("distension", distension, "1");
    }
    let deviator = (0..D::TENSOR_AXES.len()).map(|k| particles.deviator[k][i]);
    if let Some(stress) = deviator.into_iter().find(|stress| !stress.is_finite()) {
        return fault("deviator", stress, "Pa");
    }
    let coordinates: D::Axes<f64> =
        Components::from_fn(|a| particles.position[a][i] + particles.velocity[a][i]);
    match (0..D::COUNT).find(|&a| !coordinates[a].is_finite()) {
        Some(a) => fault("position or velocity", coordinates[a], "m or m/s"),
        None => Ok(()),
    }
}
