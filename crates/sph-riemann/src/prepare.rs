//! From the state of particles to the records and rows that passes read.

use rayon::prelude::*;
use sph_core::dimension::Components;
use sph_core::lanes::{InstructionSet, LANES, LaneKernel, Lanes, Line, dispatch_with, prefetch};
use sph_core::neighbors::{TILE, TILE_BLOCKS};
use sph_core::particles::{Constraint, Particles};
use sph_materials::{Damage, Material};

use crate::dimension::SolidDimension;
use crate::matter::{Eight, Matter};
use crate::pass::store_records;
use crate::record::{Prepared, Row, Sides, State};
use crate::time_step::{LeastStep, LeastSteps};

/// Blocks by which records are asked for before they are written.
const AHEAD: usize = 8;

/// Pressure of particle `i` [Pa], with the failure rule.
#[inline]
pub fn pressure<D: SolidDimension>(particles: &Particles<D>, materials: &[Material], i: usize) -> f64 {
    let material = &materials[particles.material[i] as usize];
    let damage = Damage { failed: particles.failed[i], distension: particles.distension[i] };
    material.pressure_with(damage, particles.density[i], particles.specific_internal_energy[i])
}

/// Fills the records that the first pair loop of a scheme reads, and the rows that the material gives, tile by tile: for
/// particles that the update of a step has not left ready ([`crate::update`]). `least` has the least step of each tile.
pub fn prepare<D: SolidDimension>(
    particles: &Particles<D>,
    matter: &Matter,
    instructions: InstructionSet,
    prepared: Prepared,
    records: &mut [Line],
    rows: &mut [Line],
    least: &mut [LeastStep],
) {
    let own = particles.len().div_ceil(LANES) * LANES * prepared.lines::<D>();
    let tiles = records[..own].par_chunks_mut(TILE * prepared.lines::<D>());
    let tiles = tiles.zip(rows.par_chunks_mut(TILE_BLOCKS * Row::count::<D>())).zip(least);
    tiles.enumerate().for_each(|(t, ((records, rows), least))| {
        let first = t * TILE;
        D::prepare(PrepareTile { particles, matter, instructions, first, prepared, records, rows, least });
    });
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
    least: &'a mut LeastStep,
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
        let mut least = LeastSteps::<L>::none();
        let blocks = records.chunks_exact_mut(LANES * lines).zip(rows.chunks_exact_mut(Row::count::<D>()));
        for (b, (records, rows)) in blocks.enumerate() {
            prefetch(records, AHEAD * LANES * lines, LANES * lines);
            prefetch(rows, AHEAD * Row::count::<D>(), prepared.rows::<D>());
            let (i, end) = (first + b * LANES, (first + (b + 1) * LANES).min(particles.len()));
            let eight = matter.eight::<L>(
                &particles.material[i..end],
                &particles.failed[i..end],
                &particles.distension[i..end],
            );
            let state = EightStates::<D, L>::load(particles, i);
            least.add(i, state.write(matter, &eight, prepared, records, rows), end - i);
        }
        *self.least = least.of_tile();
    }
}

/// The state of eight particles, or as many as there are.
pub(crate) struct EightStates<'a, D: SolidDimension, L: Lanes> {
    pub position: D::Axes<L>,
    pub velocity: D::Axes<L>,
    pub deviator: D::Tensor<L>,
    pub density: L,
    pub energy: L,
    pub mass: L,
    pub size: L,
    /// Largest speed relative to a neighbor in the last step [m/s].
    pub relative_speed: L,
    pub constraint: &'a [Constraint],
}

impl<'a, D: SolidDimension, L: Lanes> EightStates<'a, D, L> {
    #[inline(always)]
    fn load(particles: &'a Particles<D>, i: usize) -> Self {
        let mut state = Self {
            position: D::Axes::<L>::splat(L::zero()),
            velocity: D::Axes::<L>::splat(L::zero()),
            deviator: D::Tensor::<L>::splat(L::zero()),
            density: L::load_from(&particles.density, i),
            energy: L::load_from(&particles.specific_internal_energy, i),
            mass: L::load_from(&particles.mass, i),
            size: L::load_from(&particles.size, i),
            relative_speed: L::load_from(&particles.relative_speed, i),
            constraint: &particles.constraint[i..(i + LANES).min(particles.len())],
        };
        for a in 0..D::COUNT {
            state.position[a] = L::load_from(&particles.position[a], i);
            state.velocity[a] = L::load_from(&particles.velocity[a], i);
        }
        for c in 0..D::TENSOR_COUNT {
            state.deviator[c] = L::load_from(&particles.deviator[c], i);
        }
        state
    }

    /// Writes the rows and the records of the particles; returns D/(c_l + |U_rel|) [s].
    #[inline(always)]
    pub fn write(
        &self,
        matter: &Matter,
        eight: &Eight<'_, L>,
        prepared: Prepared,
        records: &mut [Line],
        rows: &mut [Line],
    ) -> L {
        let (pressure, modulus) = matter.pressure_and_bulk_modulus(eight, self.density, self.energy);
        let inverse_density = L::one() / self.density;
        let speed = self.write_rows(eight, inverse_density, (pressure, modulus), rows);
        if prepared == Prepared::State {
            self.write_rows_of_pass(eight, (pressure, modulus), rows);
        }
        let numbers = self.numbers(inverse_density, pressure);
        let lines = prepared.lines::<D>();
        match prepared {
            Prepared::State => store_records(&numbers, records, lines),
            Prepared::ConstantSides => store_records(&constant_sides::<D, L>(&numbers, rows), records, lines),
        }
        for lane in self.constraint.len()..LANES {
            fill::<D>(prepared, &mut records[lane * lines..][..lines], rows, lane);
        }
        self.size / (speed + self.relative_speed)
    }

    /// Numbers of the records of the first pass.
    #[inline(always)]
    fn numbers(&self, inverse_density: L, pressure: L) -> D::StateRecord<L> {
        let mut numbers = D::StateRecord::<L>::splat(L::zero());
        for a in 0..D::COUNT {
            numbers[a] = self.position[a];
            numbers[State::fields::<D>() + a] = self.velocity[a];
        }
        numbers[State::volume::<D>()] = self.mass * inverse_density;
        for k in 0..D::STRESS_COUNT {
            // In the plane the stored components are xx, yy, zz, xy: skip zz.
            let stored = if k < D::COUNT { k } else { k + 3 - D::COUNT };
            let deviator = self.deviator[stored];
            numbers[State::fields::<D>() + D::COUNT + k] =
                if k < D::COUNT { deviator - pressure } else { deviator };
        }
        numbers
    }

    /// Rows that only the first pass reads.
    #[inline(always)]
    fn write_rows_of_pass(&self, eight: &Eight<'_, L>, (pressure, modulus): (L, L), rows: &mut [Line]) {
        let (zero, half, shear) = (L::zero(), L::splat(0.5), eight.numbers.shear_modulus);
        let (mut free, mut evolves) = (L::one(), L::one());
        if self.constraint.iter().any(|&c| c != Constraint::Free) {
            free = lanes_where(self.constraint, |c| c == Constraint::Free);
            evolves = lanes_where(self.constraint, |c| c != Constraint::Frozen);
        }
        let failed = eight.failed_lanes();
        let resists = half.select_less(failed, zero, shear);
        // What has failed and is not pressed together opens or shuts without a change of pressure, which is zero.
        let open = zero.select_less(pressure, zero, failed);
        let stiff = half.select_less(open, zero, modulus);
        half.select_less(evolves, stiff, zero).store(&mut rows[Row::BULK_MODULUS].0);
        half.select_less(evolves, resists, zero).store(&mut rows[Row::SHEAR_MODULUS].0);
        eight.numbers.yield_strength.store(&mut rows[Row::YIELD_STRENGTH].0);
        free.store(&mut rows[Row::FREE].0);
    }

    /// Returns the longitudinal sound speed [m/s].
    #[inline(always)]
    fn write_rows(
        &self,
        eight: &Eight<'_, L>,
        inverse_density: L,
        (pressure, modulus): (L, L),
        rows: &mut [Line],
    ) -> L {
        let shear = eight.numbers.shear_modulus;
        inverse_density.store(&mut rows[Row::INVERSE_DENSITY].0);
        pressure.store(&mut rows[Row::PRESSURE].0);
        // ρ c_l = sqrt(ρ (K + 4 G/3)).
        let stiffness = L::splat(4.0 / 3.0).mul_add(shear, modulus);
        let impedance = (self.density * stiffness).sqrt();
        impedance.store(&mut rows[Row::LONGITUDINAL].0);
        (self.density * shear).sqrt().store(&mut rows[Row::TRANSVERSE].0);
        impedance * inverse_density
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
