//! From the state of particles to the records and rows that passes read.

use rayon::prelude::*;
use sph_core::dimension::Components;
use sph_core::lanes::{InstructionSet, LANES, LaneKernel, Lanes, Line, dispatch_with, prefetch};
use sph_core::neighbors::{TILE, TILE_BLOCKS};
use sph_core::particles::{Constraint, Particles};
use sph_materials::{Damage, Material};

use crate::dimension::SolidDimension;
use crate::matter::Matter;
use crate::pass::store_records;
use crate::record::{Prepared, Row, Sides, State};

/// Blocks by which records are asked for before they are written.
const AHEAD: usize = 8;

/// Pressure of particle `i` [Pa], with the failure rule.
#[inline]
pub fn pressure<D: SolidDimension>(particles: &Particles<D>, materials: &[Material], i: usize) -> f64 {
    let material = &materials[particles.material[i] as usize];
    let damage = Damage { failed: particles.failed[i], distension: particles.distension[i] };
    material.pressure_with(damage, particles.density[i], particles.specific_internal_energy[i])
}

/// Fills the records that the first pair loop of a scheme reads, and the rows that the material gives, tile by tile.
pub fn prepare<D: SolidDimension>(
    particles: &Particles<D>,
    matter: &Matter,
    instructions: InstructionSet,
    prepared: Prepared,
    records: &mut [Line],
    rows: &mut [Line],
) {
    let own = particles.len().div_ceil(LANES) * LANES * prepared.lines::<D>();
    let tiles = records[..own].par_chunks_mut(TILE * prepared.lines::<D>());
    tiles.zip(rows.par_chunks_mut(TILE_BLOCKS * Row::count::<D>())).enumerate().for_each(
        |(t, (records, rows))| {
            let first = t * TILE;
            D::prepare(PrepareTile { particles, matter, instructions, first, prepared, records, rows });
        },
    );
}

/// The preparation of the particles of one tile.
pub struct PrepareTile<'a, D: SolidDimension> {
    particles: &'a Particles<D>,
    matter: &'a Matter,
    instructions: InstructionSet,
    /// Index of the first particle.
    first: usize,
    prepared: Prepared,
    records: &'a mut [Line],
    rows: &'a mut [Line],
}

impl<D: SolidDimension> PrepareTile<'_, D> {
    /// Runs with the widest lanes of this machine.
    pub(crate) fn dispatch(self) {
        dispatch_with(self.instructions, self);
    }
}

impl<D: SolidDimension> LaneKernel for PrepareTile<'_, D> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { particles, matter, first, prepared, records, rows, .. } = self;
        let lines = prepared.lines::<D>();
        let blocks = records.chunks_exact_mut(LANES * lines).zip(rows.chunks_exact_mut(Row::count::<D>()));
        for (b, (records, rows)) in blocks.enumerate() {
            let i = first + b * LANES;
            prefetch(records, AHEAD * LANES * lines, LANES * lines);
            prefetch(rows, AHEAD * Row::count::<D>(), Row::count::<D>());
            let state = eight::<D, L>(particles, matter, i, rows);
            match prepared {
                Prepared::State => store_records(&state, records, lines),
                Prepared::ConstantSides => {
                    store_records(&constant_sides::<D, L>(&state, rows), records, lines)
                }
            }
            for lane in particles.len().saturating_sub(i)..LANES {
                fill::<D>(prepared, &mut records[lane * lines..][..lines], rows, lane);
            }
        }
    }
}

/// The sides of eight contacts: the state as it is. Neither slopes nor correction are read in a scheme without reconstruction.
#[inline(always)]
fn constant_sides<D: SolidDimension, L: Lanes>(
    state: &D::StateRecord<L>,
    rows: &[Line],
) -> D::SidesRecord<L> {
    let mut sides = D::SidesRecord::<L>::splat(L::zero());
    for k in 0..=State::volume::<D>() {
        sides[k] = state[k];
    }
    sides[Sides::longitudinal::<D>()] = L::load(&rows[Row::LONGITUDINAL].0);
    sides[Sides::transverse::<D>()] = L::load(&rows[Row::TRANSVERSE].0);
    for f in 0..D::COUNT + D::STRESS_COUNT {
        sides[Sides::fields::<D>() + f] = state[State::fields::<D>() + f];
    }
    sides
}

/// Lanes behind the last particle: no volume, nothing that could trap.
#[cold]
fn fill<D: SolidDimension>(prepared: Prepared, record: &mut [Line], rows: &mut [Line], lane: usize) {
    record.iter_mut().for_each(|line| line.0 = [0.0; LANES]);
    if prepared == Prepared::ConstantSides {
        for k in [Sides::longitudinal::<D>(), Sides::transverse::<D>()] {
            record[k / LANES].0[k % LANES] = 1.0;
        }
    }
    for row in 0..Row::COUNT_BEFORE {
        rows[row].0[lane] = 0.0;
    }
    rows[Row::LONGITUDINAL].0[lane] = 1.0;
    rows[Row::TRANSVERSE].0[lane] = 1.0;
}

/// The rows of eight particles from number `i` on, and their state.
#[inline(always)]
fn eight<D: SolidDimension, L: Lanes>(
    particles: &Particles<D>,
    matter: &Matter,
    i: usize,
    rows: &mut [Line],
) -> D::StateRecord<L> {
    let end = (i + LANES).min(particles.len());
    let constraint = &particles.constraint[i..end];
    let eight = matter.eight::<L>(
        &particles.material[i..end],
        &particles.failed[i..end],
        &particles.distension[i..end],
    );
    let density = L::load_from(&particles.density, i);
    let energy = L::load_from(&particles.specific_internal_energy, i);
    let (pressure, modulus) = matter.pressure_and_bulk_modulus(&eight, density, energy);
    let inverse_density = L::one() / density;
    let mut numbers = D::StateRecord::<L>::splat(L::zero());
    for a in 0..D::COUNT {
        numbers[a] = L::load_from(&particles.position[a], i);
        numbers[State::fields::<D>() + a] = L::load_from(&particles.velocity[a], i);
    }
    numbers[State::volume::<D>()] = L::load_from(&particles.mass, i) * inverse_density;
    for k in 0..D::STRESS_COUNT {
        // In the plane the stored components are xx, yy, zz, xy: skip zz.
        let stored = if k < D::COUNT { k } else { k + 3 - D::COUNT };
        let deviator = L::load_from(&particles.deviator[stored], i);
        numbers[State::fields::<D>() + D::COUNT + k] =
            if k < D::COUNT { deviator - pressure } else { deviator };
    }
    let (zero, half, shear) = (L::zero(), L::splat(0.5), eight.numbers.shear_modulus);
    let (mut free, mut evolves) = (L::one(), L::one());
    if constraint.iter().any(|&c| c != Constraint::Free) {
        free = lanes_where(constraint, |c| c == Constraint::Free);
        evolves = lanes_where(constraint, |c| c != Constraint::Frozen);
    }
    let resists = half.select_less(eight.failed_lanes(), zero, shear);
    inverse_density.store(&mut rows[Row::INVERSE_DENSITY].0);
    half.select_less(evolves, modulus, zero).store(&mut rows[Row::BULK_MODULUS].0);
    half.select_less(evolves, resists, zero).store(&mut rows[Row::SHEAR_MODULUS].0);
    eight.numbers.yield_strength.store(&mut rows[Row::YIELD_STRENGTH].0);
    pressure.store(&mut rows[Row::PRESSURE].0);
    free.store(&mut rows[Row::FREE].0);
    // ρ c_l = sqrt(ρ (K + 4 G/3)).
    let stiffness = L::splat(4.0 / 3.0).mul_add(shear, modulus);
    (density * stiffness).sqrt().store(&mut rows[Row::LONGITUDINAL].0);
    (density * shear).sqrt().store(&mut rows[Row::TRANSVERSE].0);
    numbers
}

/// 1 where a constraint is wanted, else 0.
#[inline(always)]
fn lanes_where<L: Lanes>(constraint: &[Constraint], wanted: impl Fn(Constraint) -> bool) -> L {
    let mut lanes = [1.0; LANES];
    for l in 0..constraint.len() {
        lanes[l] = f64::from(wanted(constraint[l]));
    }
    L::load(&lanes)
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
