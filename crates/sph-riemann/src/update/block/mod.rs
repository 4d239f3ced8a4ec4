//! The update of eight particles at a time.

mod stress;

use sph_core::dimension::Components;
use sph_core::lanes::{LANES, LaneKernel, Lanes, Line, dispatch_with, exp, prefetch};
use sph_core::particles::Constraint;

use super::{Context, Fixed, LARGEST_RELAXATION, TileColumns, Written};
use crate::dimension::{SolidDimension, dual, spin_matrix, times};
use crate::matter::{Eight, Numbers};
use crate::prepare::EightStates;
use crate::record::{Row, Sides, Sums};
use crate::scheme::SurfaceTreatment;
use crate::time_step::LeastSteps;

/// Blocks by which the state is asked for before it is used.
const AHEAD: usize = 8;

/// The update of the particles of one tile.
pub struct UpdateTile<'a, D: SolidDimension> {
    pub(super) columns: TileColumns<'a, D>,
    /// Index of the first particle.
    pub(super) first: usize,
    pub(super) fixed: &'a Fixed<'a>,
    pub(super) context: &'a Context<'a>,
    pub(super) written: Written<'a>,
}

impl<D: SolidDimension> UpdateTile<'_, D> {
    /// Runs with the widest lanes of this machine.
    pub(crate) fn dispatch(self) {
        dispatch_with(self.context.instructions, self);
    }

    /// Asks for what the update of the eight particles at place `k` reads; they may belong to a later tile.
    #[inline(always)]
    fn prefetch(&self, rows: &[Line], k: usize) {
        let (i, context, columns) = (self.first + k, &self.context, &self.columns);
        let block = k / LANES * Row::count::<D>();
        prefetch(rows, block, context.settings.scheme.prepared().rows::<D>());
        if context.settings.scheme.reconstructs() {
            let of_correction = Sides::correction::<D>() / LANES;
            for l in 0..LANES {
                prefetch(context.sides, (i + l) * D::SIDES_LINES + of_correction, 1);
            }
        }
        if let Some(records) = &self.written.records {
            prefetch(records, k * D::CONSTANT_SIDES_LINES, LANES * D::CONSTANT_SIDES_LINES);
        }
        for a in 0..D::COUNT {
            prefetch(columns.position[a], k, LANES);
            prefetch(columns.velocity[a], k, LANES);
        }
        for c in 0..D::TENSOR_COUNT {
            prefetch(columns.deviator[c], k, LANES);
        }
        for column in [&columns.density, &columns.energy, &columns.plastic_strain, &columns.relative_speed] {
            prefetch(column, k, LANES);
        }
        prefetch(columns.distension, k, LANES);
        for column in [self.fixed.mass, self.fixed.size, self.fixed.packing_excess] {
            prefetch(column, i, LANES);
        }
    }
}

impl<D: SolidDimension> LaneKernel for UpdateTile<'_, D> {
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let mut relaxation_work = L::zero();
        let mut least = LeastSteps::<L>::none();
        // What is read before it is written is not part of `self` for a while.
        let rows = std::mem::take(&mut self.written.rows);
        for k in (0..self.columns.density.len()).step_by(LANES) {
            self.prefetch(rows, k + AHEAD * LANES);
            let of_rows = k / LANES * Row::count::<D>();
            let block = Block::<D, L>::load(&self, &rows[of_rows..][..Row::count::<D>()], k);
            let motion = self.advance_motion(&block);
            let flow = self.advance_density(&block, &motion);
            relaxation_work += flow.relaxation_work;
            let deviator = self.advance_stress(&block, &motion, flow);
            let state = EightStates {
                position: motion.position,
                velocity: motion.velocity,
                deviator,
                density: flow.density,
                energy: flow.energy,
                mass: block.mass,
                size: L::load_from(self.fixed.size, block.i),
                relative_speed: motion.relative_speed,
                constraint: block.constraint,
            };
            let (i, numbers) = (block.i, block.numbers);
            let steps = self.leave_ready(i, &state, numbers, &mut rows[of_rows..][..Row::count::<D>()]);
            least.add(i, steps, state.constraint.len());
        }
        *self.written.least = least.of_tile();
        self.written.report.relaxation_work += relaxation_work.to_array().iter().sum::<f64>();
    }
}

/// What the passes found for eight particles.
struct Block<'a, 'r, D: SolidDimension, L: Lanes> {
    /// Place of the first in the tile.
    k: usize,
    /// Index of the first.
    i: usize,
    rows: &'r [Line],
    sums: D::SumsRecord<L>,
    /// K, for schemes that correct.
    correction: D::Symmetric<L>,
    numbers: Numbers<L>,
    mass: L,
    constraint: &'a [Constraint],
    /// Bit l: there is a particle l, and its state evolves.
    evolves: u8,
    /// 1 where the velocity is free, and where the state evolves.
    free_lanes: L,
    evolves_lanes: L,
}

/// How eight particles move.
struct Motion<D: SolidDimension, L: Lanes> {
    /// Change of kinetic energy by the forces [J/kg].
    kinetic: L,
    /// Change of total energy by the forces [J/kg].
    energy_change: L,
    /// ∂U_b/∂x_a at [a][b].
    gradient: D::Axes<D::Axes<L>>,
    /// At the end of the step.
    position: D::Axes<L>,
    velocity: D::Axes<L>,
    /// Largest speed relative to a neighbor [m/s].
    relative_speed: L,
}

/// Density and energy at the end of the step.
#[derive(Clone, Copy)]
struct Flow<L> {
    density: L,
    energy: L,
    /// Work of the volume consistency [J], per meter of depth in the plane.
    relaxation_work: L,
}

/// Which eight particles a block holds, for what is looked at one by one.
#[derive(Clone, Copy)]
struct Place<'a> {
    /// Place of the first in the tile.
    k: usize,
    /// Index of the first.
    i: usize,
    constraint: &'a [Constraint],
    /// Bit l: there is a particle l, and its state evolves.
    evolves: u8,
}

/// Line `line` of eight records of `stride` lines from record `first` on, as numbers of a record.
#[inline(always)]
fn load_own<L: Lanes, R: Components<L>>(
    record: &mut R,
    lines: &[Line],
    stride: usize,
    line: usize,
    first: usize,
) {
    let mut numbers = [L::zero(); LANES];
    for l in 0..LANES {
        numbers[l] = L::load(&lines[(first + l) * stride + line].0);
    }
    let numbers = L::transpose(numbers);
    for k in 0..LANES {
        record[line * LANES + k] = numbers[k];
    }
}

impl<'a, 'r, D: SolidDimension, L: Lanes> Block<'a, 'r, D, L> {
    #[inline(always)]
    fn load(tile: &UpdateTile<'a, D>, rows: &'r [Line], k: usize) -> Self {
        let (i, context) = (tile.first + k, &tile.context);
        let valid = (tile.columns.density.len() - k).min(LANES);
        let constraint = &tile.fixed.constraint[i..i + valid];
        let mut sums = D::SumsRecord::<L>::splat(L::zero());
        for line in 0..D::SUM_LINES {
            load_own::<L, _>(&mut sums, tile.written.sums, D::SUM_LINES, line, k);
        }
        let mut correction = D::Symmetric::<L>::splat(L::zero());
        if tile.context.settings.scheme.reconstructs() {
            let mut sides = D::SidesRecord::<L>::splat(L::zero());
            let first = Sides::correction::<D>();
            for line in first / LANES..=(first + D::STRESS_COUNT - 1) / LANES {
                load_own::<L, _>(&mut sides, context.sides, D::SIDES_LINES, line, i);
            }
            for c in 0..D::STRESS_COUNT {
                correction[c] = sides[first + c];
            }
        }
        let material = &tile.fixed.material[i..i + valid];
        let mut evolves = u8::MAX >> (LANES - valid);
        let (mut free_lanes, mut evolves_lanes) = (L::one(), L::one());
        if constraint.iter().any(|&c| c != Constraint::Free) {
            let (mut free, mut evolving) = ([1.0; LANES], [1.0; LANES]);
            for l in 0..valid {
                free[l] = f64::from(constraint[l] == Constraint::Free);
                if constraint[l] == Constraint::Frozen {
                    evolving[l] = 0.0;
                    evolves &= !(1 << l);
                }
            }
            (free_lanes, evolves_lanes) = (L::load(&free), L::load(&evolving));
        }
        Self {
            k,
            i,
            rows,
            sums,
            correction,
            numbers: tile.context.matter.numbers::<L>(material),
            mass: L::load_from(tile.fixed.mass, i),
            constraint,
            evolves,
            free_lanes,
            evolves_lanes,
        }
    }

    #[inline(always)]
    fn place(&self) -> Place<'a> {
        Place { k: self.k, i: self.i, constraint: self.constraint, evolves: self.evolves }
    }

    #[inline(always)]
    fn row(&self, r: usize) -> L {
        L::load(&self.rows[r].0)
    }

    /// `new` where the state evolves, else `old`.
    #[inline(always)]
    fn evolved(&self, new: L, old: L) -> L {
        L::splat(0.5).select_less(self.evolves_lanes, new, old)
    }

    /// ∂U_b/∂x_a at [a][b], from the raw sum of the contact pass.
    #[inline(always)]
    fn velocity_gradient(&self, corrects: bool, capped: bool) -> D::Axes<D::Axes<L>> {
        let zero = D::Axes::<L>::splat(L::zero());
        let inverse_volume = L::one() / (self.mass * self.row(Row::INVERSE_DENSITY));
        let mut raw = D::Axes::<D::Axes<L>>::splat(zero);
        for a in 0..D::COUNT {
            for b in 0..D::COUNT {
                raw[a][b] = self.sums[Sums::gradient::<D>() + a * D::COUNT + b] * inverse_volume;
            }
        }
        if !corrects {
            return raw; // No correction: the raw sum is the gradient.
        }
        let mut matrix = self.correction;
        for c in 0..D::STRESS_COUNT {
            matrix[c] = self.row(Row::gradient_matrix::<D>() + c);
        }
        let spin =
            if capped { D::spin_solve(matrix, dual::<D, L>(&raw)) } else { D::Spin::<L>::splat(L::zero()) };
        let mut gradient = raw;
        for b in 0..D::COUNT {
            let mut turn = zero;
            for a in 0..D::COUNT {
                turn[a] = spin_matrix::<D, L>(&spin, a, b);
            }
            let mut rest = times::<D, L>(&matrix, &turn);
            for a in 0..D::COUNT {
                rest[a] = raw[a][b] - rest[a];
            }
            let corrected = times::<D, L>(&self.correction, &rest);
            for a in 0..D::COUNT {
                gradient[a][b] = turn[a] + corrected[a];
            }
        }
        gradient
    }
}

impl<D: SolidDimension> UpdateTile<'_, D> {
    /// Position and velocity; what forces do to imposed ones is reported.
    #[inline(always)]
    fn advance_motion<L: Lanes>(&mut self, block: &Block<'_, '_, D, L>) -> Motion<D, L> {
        let (k, tau, half) = (block.k, L::splat(self.context.time_step), L::splat(0.5));
        let centered = self.context.settings.scheme.is_time_centered();
        let relative_speed = block.sums[Sums::relative_speed_squared::<D>()].sqrt();
        relative_speed.store_to(self.columns.relative_speed, k);
        let step_over_mass = tau / block.mass;
        let energy_change = block.sums[Sums::power::<D>()] * step_over_mass;
        let mut changes = D::Axes::<L>::splat(L::zero());
        let (mut position, mut velocity) = (changes, changes);
        let mut kinetic = L::zero();
        for a in 0..D::COUNT {
            let u = L::load_from(self.columns.velocity[a], k);
            changes[a] = block.sums[Sums::FORCE + a] * step_over_mass;
            let mean = half.mul_add(changes[a], u);
            kinetic = changes[a].mul_add(mean, kinetic);
            let speed = half.select_less(block.free_lanes, if centered { mean } else { u }, u);
            let x = L::load_from(self.columns.position[a], k);
            position[a] = tau.mul_add(speed, x);
            position[a].store_to(self.columns.position[a], k);
            velocity[a] = half.select_less(block.free_lanes, u + changes[a], u);
            velocity[a].store_to(self.columns.velocity[a], k);
        }
        if block.constraint.iter().any(|&c| c != Constraint::Free) {
            let mut change = [[0.0; LANES]; 3];
            for a in 0..D::COUNT {
                change[a] = changes[a].to_array();
            }
            let gains = [block.mass, kinetic, energy_change].map(L::to_array);
            self.report_imposed(block.constraint, &change, &gains);
        }
        let corrects = self.context.settings.scheme.reconstructs();
        let capped = matches!(self.context.settings.surface, SurfaceTreatment::SpectralCap { .. });
        let gradient = block.velocity_gradient(corrects, capped);
        Motion { kinetic, energy_change, gradient, position, velocity, relative_speed }
    }

    /// Momentum and energy that imposed velocities put in.
    #[inline(never)]
    fn report_imposed(
        &mut self,
        constraint: &[Constraint],
        changes: &[[f64; LANES]; 3],
        [mass, kinetic, energy]: &[[f64; LANES]; 3],
    ) {
        for (l, &constraint) in constraint.iter().enumerate() {
            if constraint == Constraint::Free {
                continue;
            }
            for a in 0..D::COUNT {
                self.written.report.input.impulse[a] -= mass[l] * changes[a][l];
            }
            let kept = if constraint == Constraint::Frozen { energy[l] } else { kinetic[l] };
            self.written.report.input.work -= mass[l] * kept;
        }
    }

    /// Density and energy, volume consistency included.
    #[inline(always)]
    fn advance_density<L: Lanes>(&mut self, block: &Block<'_, '_, D, L>, motion: &Motion<D, L>) -> Flow<L> {
        let (k, tau) = (block.k, L::splat(self.context.time_step));
        let mut divergence = motion.gradient[0][0];
        for a in 1..D::COUNT {
            divergence += motion.gradient[a][a];
        }
        let relaxation = self.relaxation_rate(block);
        let old = L::load_from(self.columns.density, k);
        let density = block.evolved(old * exp(tau * (relaxation - divergence)), old);
        density.store_to(self.columns.density, k);
        let old = L::load_from(self.columns.energy, k);
        let energy = block.evolved(old + (motion.energy_change - motion.kinetic), old);
        energy.store_to(self.columns.energy, k);

        let largest = L::splat(LARGEST_RELAXATION / self.context.time_step);
        let acted = &mut self.written.report.interventions;
        let bounded = !relaxation.abs().less_mask(largest) & block.evolves;
        acted.relaxation_bounded += u64::from(bounded.count_ones());
        let least = block.row(Row::LEAST_EIGENVALUE);
        let capped = least.less_mask(L::splat(self.context.least_eigenvalue)) & block.evolves;
        acted.inverse_capped += u64::from(capped.count_ones());
        let volume = block.mass * block.row(Row::INVERSE_DENSITY);
        // Lanes behind the last particle have no volume.
        let work = block.row(Row::PRESSURE) * volume * relaxation.abs() * tau;
        Flow { density, energy, relaxation_work: block.evolved(work, L::zero()) }
    }

    /// r = d(ln ρ)/dt of the volume consistency [1/s]; see [`crate::volume`].
    #[inline(always)]
    fn relaxation_rate<L: Lanes>(&self, block: &Block<'_, '_, D, L>) -> L {
        let settings = self.context.settings;
        let Some(v) = settings.volume_consistency else { return L::zero() };
        let excess = L::load_from(self.fixed.packing_excess, block.i);
        let (zero, one, tolerance) = (L::zero(), L::one(), L::splat(v.tolerance));
        let yield_strength = block.numbers.yield_strength;
        let too_tight = tolerance.select_less(excess, excess - tolerance, zero);
        let loose = (excess + tolerance) * (one + excess / L::splat(v.void_deficit));
        let loose = yield_strength.select_less(block.row(Row::PRESSURE), loose, zero);
        let loose = L::splat(-v.void_deficit).select_less(excess, loose, zero);
        let share = excess.select_less(-tolerance, loose, too_tight);
        // Only in a free particle of a material that yields.
        let share = zero.select_less(yield_strength, share, zero);
        let share = yield_strength.select_less(L::splat(f64::INFINITY), share, zero);
        let share = L::splat(0.5).select_less(block.free_lanes, share, zero);
        let sound_speed = block.row(Row::LONGITUDINAL) * block.row(Row::INVERSE_DENSITY);
        let h = L::splat(2.0 * settings.smoothing) * L::load_from(self.fixed.size, block.i);
        let largest = L::splat(LARGEST_RELAXATION / self.context.time_step);
        (L::splat(v.rate) * sound_speed / h * share).max(-largest).min(largest)
    }

    /// Records, rows and steps of eight particles from index `i` on for the next step: returns D/(c_l + |U_rel|) [s].
    #[inline(always)]
    fn leave_ready<L: Lanes>(
        &mut self,
        i: usize,
        state: &EightStates<'_, D, L>,
        numbers: Numbers<L>,
        rows: &mut [Line],
    ) -> L {
        let (k, count) = (i - self.first, state.constraint.len());
        let (failed, distension) =
            (&self.columns.failed[k..k + count], &self.columns.distension[k..k + count]);
        let material = &self.fixed.material[i..i + count];
        let eight = Eight { material, failed, distension, numbers };
        let prepared = self.context.settings.scheme.prepared();
        let lines = prepared.lines::<D>();
        let written = &mut self.written;
        let records = written.records.as_deref_mut().unwrap_or(&mut *written.sums);
        state.write(self.context.matter, &eight, prepared, &mut records[k * lines..][..LANES * lines], rows)
    }
}
