//! From the state of particles to the records and rows that passes read.

use rayon::prelude::*;
use sph_core::dimension::Components;
use sph_core::lanes::{LANES, Line};
use sph_core::neighbors::{TILE, TILE_BLOCKS};
use sph_core::particles::{Constraint, Particles};
use sph_materials::{Damage, Material};

use crate::dimension::SolidDimension;
use crate::record::{Row, Sides, State};

/// Pressure of particle `i` [Pa], with the failure rule.
#[inline]
pub fn pressure<D: SolidDimension>(particles: &Particles<D>, materials: &[Material], i: usize) -> f64 {
    let material = &materials[particles.material[i] as usize];
    let damage = Damage { failed: particles.failed[i], distension: particles.distension[i] };
    material.pressure_with(damage, particles.density[i], particles.specific_internal_energy[i])
}

/// Fills the records of the first pass and the rows that the material gives, tile by tile.
pub fn prepare<D: SolidDimension>(
    particles: &Particles<D>,
    materials: &[Material],
    state: &mut [Line],
    rows: &mut [Line],
) {
    let n = particles.len();
    let own = n.div_ceil(LANES) * LANES * D::STATE_LINES;
    let tiles = state[..own].par_chunks_mut(TILE * D::STATE_LINES);
    tiles.zip(rows.par_chunks_mut(TILE_BLOCKS * Row::count::<D>())).enumerate().for_each(
        |(t, (state, rows))| {
            for (k, record) in state.chunks_exact_mut(D::STATE_LINES).enumerate() {
                let rows = &mut rows[k / LANES * Row::count::<D>()..];
                if t * TILE + k < n {
                    particle(particles, materials, t * TILE + k, record, rows);
                } else {
                    fill(record, rows, k % LANES);
                }
            }
        },
    );
}

/// Lanes behind the last particle: no volume, nothing that could trap.
fn fill(record: &mut [Line], rows: &mut [Line], lane: usize) {
    record.iter_mut().for_each(|line| line.0 = [0.0; LANES]);
    for row in 0..Row::LEAST_EIGENVALUE {
        rows[row].0[lane] = 0.0;
    }
    rows[Row::LONGITUDINAL].0[lane] = 1.0;
    rows[Row::TRANSVERSE].0[lane] = 1.0;
}

#[inline]
fn particle<D: SolidDimension>(
    particles: &Particles<D>,
    materials: &[Material],
    i: usize,
    record: &mut [Line],
    rows: &mut [Line],
) {
    let material = &materials[particles.material[i] as usize];
    let (density, energy) = (particles.density[i], particles.specific_internal_energy[i]);
    let pressure = pressure(particles, materials, i);
    let mut put = |k: usize, value: f64| record[k / LANES].0[k % LANES] = value;
    for a in 0..D::COUNT {
        put(a, particles.position[a][i]);
        put(State::fields::<D>() + a, particles.velocity[a][i]);
    }
    put(State::volume::<D>(), particles.mass[i] / density);
    for k in 0..D::STRESS_COUNT {
        // In the plane the stored components are xx, yy, zz, xy: skip zz.
        let stored = if k < D::COUNT { k } else { k + 3 - D::COUNT };
        let stress = particles.deviator[stored][i] - if k < D::COUNT { pressure } else { 0.0 };
        put(State::fields::<D>() + D::COUNT + k, stress);
    }
    // Of the solid between voids.
    let bulk_speed = material.bulk_sound_speed(density * particles.distension[i], energy);
    let bulk_modulus = density * bulk_speed * bulk_speed;
    let shear = if particles.failed[i] { 0.0 } else { material.strength.shear_modulus() };
    let evolves = particles.constraint[i] != Constraint::Frozen;
    let mut row = |r: usize, value: f64| rows[r].0[i % LANES] = value;
    row(Row::INVERSE_DENSITY, 1.0 / density);
    row(Row::BULK_MODULUS, if evolves { bulk_modulus } else { 0.0 });
    row(Row::SHEAR_MODULUS, if evolves { shear } else { 0.0 });
    row(Row::YIELD_STRENGTH, material.strength.yield_strength());
    row(Row::PRESSURE, pressure);
    row(Row::FREE, if particles.constraint[i] == Constraint::Free { 1.0 } else { 0.0 });
    // ρ c_l = sqrt(ρ (K + 4 G/3)).
    let shear = material.strength.shear_modulus();
    row(Row::LONGITUDINAL, (density * (bulk_modulus + 4.0 / 3.0 * shear)).sqrt());
    row(Row::TRANSVERSE, (density * shear).sqrt());
}

/// Records of the second pass for a scheme without reconstruction: the state as it is, no correction.
pub fn piecewise_constant_sides<D: SolidDimension>(state: &[Line], rows: &[Line], sides: &mut [Line]) {
    let tiles = sides.par_chunks_mut(LANES * D::SIDES_LINES).enumerate();
    tiles.for_each(|(block, sides)| {
        let rows = &rows[block * Row::count::<D>()..];
        for (lane, side) in sides.chunks_exact_mut(D::SIDES_LINES).enumerate() {
            let from = (block * LANES + lane) * D::STATE_LINES;
            let get = |k: usize| state[from + k / LANES].0[k % LANES];
            let mut put = |k: usize, value: f64| side[k / LANES].0[k % LANES] = value;
            (0..=D::COUNT).for_each(|k| put(k, get(k)));
            put(Sides::longitudinal::<D>(), rows[Row::LONGITUDINAL].0[lane]);
            put(Sides::transverse::<D>(), rows[Row::TRANSVERSE].0[lane]);
            for f in 0..D::COUNT + D::STRESS_COUNT {
                put(Sides::fields::<D>() + f, get(State::fields::<D>() + f));
            }
            for k in 0..D::STRESS_COUNT {
                put(Sides::correction::<D>() + k, if k < D::COUNT { 1.0 } else { 0.0 });
            }
        }
    });
}

/// Stress of particle `i` [Pa]: all stored components, the out-of-plane one too.
pub fn stress<D: SolidDimension>(
    particles: &Particles<D>,
    materials: &[Material],
    i: usize,
) -> D::Tensor<f64> {
    let pressure = pressure(particles, materials, i);
    Components::from_fn(|k| {
        let (a, b) = D::TENSOR_AXES[k];
        particles.deviator[k][i] - if a == b { pressure } else { 0.0 }
    })
}
