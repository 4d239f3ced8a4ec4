//! The update of eight particles at a time.

use sph_core::dimension::Components;
use sph_core::lanes::{LANES, LaneKernel, Lanes, Line, dispatch_with, exp, prefetch};
use sph_core::particles::Constraint;

use super::{Context, Fixed, LARGEST_RELAXATION, TileColumns, TileReport};
use crate::dimension::{SolidDimension, dual, spin_matrix, times};
use crate::matter::{Eight, Numbers, Tension};
use crate::record::{Row, Sides, Sums};
use crate::scheme::SurfaceTreatment;

/// Blocks by which the state is asked for before it is used.
const AHEAD: usize = 8;

/// The update of the particles of one tile.
pub struct UpdateTile<'a, D: SolidDimension> {
    pub(super) columns: TileColumns<'a, D>,
    /// Index of the first particle.
    pub(super) first: usize,
    /// What the pairs of the tile's particles added up to.
    pub(super) sums: &'a [Line],
    pub(super) fixed: &'a Fixed<'a>,
    pub(super) context: &'a Context<'a>,
    pub(super) report: &'a mut TileReport,
}

impl<D: SolidDimension> UpdateTile<'_, D> {
    /// Runs with the widest lanes of this machine.
    pub(crate) fn dispatch(self) {
        dispatch_with(self.context.instructions, self);
    }

    /// Asks for what the update of the eight particles at place `k` reads; they may belong to a later tile.
    #[inline(always)]
    fn prefetch(&self, k: usize) {
        let (i, context, columns) = (self.first + k, &self.context, &self.columns);
        prefetch(context.rows, i / LANES * Row::count::<D>(), Row::count::<D>());
        if context.settings.scheme.reconstructs() {
            let of_correction = Sides::correction::<D>() / LANES;
            for l in 0..LANES {
                prefetch(context.sides, (i + l) * D::SIDES_LINES + of_correction, 1);
            }
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
        for k in (0..self.columns.density.len()).step_by(LANES) {
            self.prefetch(k + AHEAD * LANES);
            let block = Block::<D, L>::load(&self, k);
            let motion = self.advance_motion(&block);
            let flow = self.advance_density(&block, &motion);
            relaxation_work += flow.relaxation_work;
            self.advance_stress(&block, &motion, flow);
        }
        self.report.relaxation_work += relaxation_work.to_array().iter().sum::<f64>();
    }
}

/// What the passes found for eight particles.
struct Block<'a, D: SolidDimension, L: Lanes> {
    /// Place of the first in the tile.
    k: usize,
    /// Index of the first.
    i: usize,
    rows: &'a [Line],
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

impl<'a, D: SolidDimension, L: Lanes> Block<'a, D, L> {
    #[inline(always)]
    fn load(tile: &UpdateTile<'a, D>, k: usize) -> Self {
        let (i, context) = (tile.first + k, &tile.context);
        let valid = (tile.columns.density.len() - k).min(LANES);
        let constraint = &tile.fixed.constraint[i..i + valid];
        let mut sums = D::SumsRecord::<L>::splat(L::zero());
        for line in 0..D::SUM_LINES {
            load_own::<L, _>(&mut sums, tile.sums, D::SUM_LINES, line, k);
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
        let count = Row::count::<D>();
        Self {
            k,
            i,
            rows: &context.rows[i / LANES * count..][..count],
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
    fn advance_motion<L: Lanes>(&mut self, block: &Block<'_, D, L>) -> Motion<D, L> {
        let (k, tau, half) = (block.k, L::splat(self.context.time_step), L::splat(0.5));
        let centered = self.context.settings.scheme.is_time_centered();
        block.sums[Sums::relative_speed_squared::<D>()].sqrt().store_to(self.columns.relative_speed, k);
        let step_over_mass = tau / block.mass;
        let energy_change = block.sums[Sums::power::<D>()] * step_over_mass;
        let mut changes = D::Axes::<L>::splat(L::zero());
        let mut kinetic = L::zero();
        for a in 0..D::COUNT {
            let u = L::load_from(self.columns.velocity[a], k);
            changes[a] = block.sums[Sums::FORCE + a] * step_over_mass;
            let mean = half.mul_add(changes[a], u);
            kinetic = changes[a].mul_add(mean, kinetic);
            let speed = half.select_less(block.free_lanes, if centered { mean } else { u }, u);
            let x = L::load_from(self.columns.position[a], k);
            tau.mul_add(speed, x).store_to(self.columns.position[a], k);
            half.select_less(block.free_lanes, u + changes[a], u).store_to(self.columns.velocity[a], k);
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
        Motion { kinetic, energy_change, gradient: block.velocity_gradient(corrects, capped) }
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
                self.report.input.impulse[a] -= mass[l] * changes[a][l];
            }
            let kept = if constraint == Constraint::Frozen { energy[l] } else { kinetic[l] };
            self.report.input.work -= mass[l] * kept;
        }
    }

    /// Density and energy, volume consistency included.
    #[inline(always)]
    fn advance_density<L: Lanes>(&mut self, block: &Block<'_, D, L>, motion: &Motion<D, L>) -> Flow<L> {
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
        let acted = &mut self.report.interventions;
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
    fn relaxation_rate<L: Lanes>(&self, block: &Block<'_, D, L>) -> L {
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

    /// Deviator, plastic strain, failure.
    #[inline(always)]
    fn advance_stress<L: Lanes>(&mut self, block: &Block<'_, D, L>, motion: &Motion<D, L>, flow: Flow<L>) {
        let (k, matter) = (block.k, self.context.matter);
        let end = k + block.constraint.len();
        let material = &self.fixed.material[block.i..block.i + block.constraint.len()];
        let (failed, distension) = (&self.columns.failed[k..end], &self.columns.distension[k..end]);
        let eight = Eight { material, failed, distension, numbers: block.numbers };
        let mut deviator = D::Tensor::<L>::splat(L::zero());
        for c in 0..D::TENSOR_COUNT {
            deviator[c] = L::load_from(self.columns.deviator[c], k);
        }
        let old = deviator;
        let strain = self.elastic_plastic(&eight.numbers, &mut deviator, motion);
        let strain = block.evolved(strain, L::zero());
        (L::load_from(self.columns.plastic_strain, k) + strain).store_to(self.columns.plastic_strain, k);
        let time_step = self.context.time_step;
        let tension = matter.advance_tension(&eight, flow.density, flow.energy, time_step);
        if tension.failed & block.evolves != 0
            || tension.detail.is_some()
            || self.columns.failed[k..end].contains(&true)
        {
            let mut s = [[0.0; LANES]; 6];
            for c in 0..D::TENSOR_COUNT {
                s[c] = deviator[c].to_array();
            }
            // A copy, so that the hot path keeps its own in registers.
            let left = L::load(&self.fail(block.place(), &{ tension }, &s));
            for c in 0..D::TENSOR_COUNT {
                deviator[c] = deviator[c] * left;
            }
        }
        for c in 0..D::TENSOR_COUNT {
            deviator[c] = block.evolved(deviator[c], old[c]);
            deviator[c].store_to(self.columns.deviator[c], k);
        }
        // One sum finds what is not finite anywhere.
        let all = flow.density + flow.energy + motion.kinetic + deviator[0] + deviator[D::TENSOR_COUNT - 1];
        let sound =
            all.abs().less_mask(L::splat(f64::INFINITY)) & L::zero().less_mask(flow.density) & tension.finite;
        let broken = !sound & block.evolves;
        if broken != 0 && self.report.broken.is_none() {
            self.report.broken = Some(block.i as u32 + broken.trailing_zeros());
        }
    }

    /// Elastic trial, rotation, return to the yield surface; returns the equivalent plastic strain (σ_vM - Y)/(3 G).
    #[inline(always)]
    fn elastic_plastic<L: Lanes>(
        &self,
        numbers: &Numbers<L>,
        deviator: &mut D::Tensor<L>,
        motion: &Motion<D, L>,
    ) -> L {
        let (zero, one) = (L::zero(), L::one());
        let shear = numbers.shear_modulus;
        let twice_strain_to_stress = shear * L::splat(self.context.time_step);
        let mut g = [[zero; 3]; 3];
        let mut third = zero;
        for a in 0..D::COUNT {
            for b in 0..D::COUNT {
                g[a][b] = motion.gradient[a][b];
            }
            third += g[a][a];
        }
        let two_thirds = L::splat(2.0 / 3.0) * third;
        let mut s = [[zero; 3]; 3];
        for c in 0..D::TENSOR_COUNT {
            let (a, b) = D::TENSOR_AXES[c];
            let twice = g[a][b] + g[b][a];
            let rate = if a == b { twice - two_thirds } else { twice };
            s[a][b] = twice_strain_to_stress.mul_add(rate, deviator[c]);
            s[b][a] = s[a][b];
        }
        turn::<D, L>(&mut s, &g, self.context.time_step);
        let mut invariant = zero;
        for c in 0..D::TENSOR_COUNT {
            let (a, b) = D::TENSOR_AXES[c];
            let twice = if a == b { s[a][b] } else { s[a][b] + s[a][b] };
            invariant = twice.mul_add(s[a][b], invariant);
        }
        let square = L::splat(1.5) * invariant;
        let von_mises = square.sqrt();
        let yield_strength = numbers.yield_strength;
        let factor = (yield_strength * yield_strength).select_less(square, yield_strength / von_mises, one);
        for c in 0..D::TENSOR_COUNT {
            let (a, b) = D::TENSOR_AXES[c];
            // A fluid keeps what it has.
            deviator[c] = zero.select_less(shear, s[a][b] * factor, deviator[c]);
        }
        let strain = von_mises * (one - factor) / (L::splat(3.0) * shear);
        let strain = factor.select_less(one, strain, zero);
        zero.select_less(shear, strain, zero)
    }

    /// What failure changes: the memory of it; and the share of the deviator that is left, for each lane.
    #[inline(never)]
    fn fail(&mut self, block: Place<'_>, tension: &Tension, s: &[[f64; LANES]; 6]) -> [f64; LANES] {
        let mut left = [1.0; LANES];
        for l in (0..block.constraint.len()).filter(|l| block.evolves >> l & 1 == 1) {
            let at = block.k + l;
            let failed = tension.failed >> l & 1 == 1;
            self.report.interventions.failures += u64::from(failed && !self.columns.failed[at]);
            self.columns.failed[at] = failed;
            let strength_left = match &tension.detail {
                Some([distension, strength_left]) => {
                    self.columns.distension[at] = distension[l];
                    strength_left[l]
                }
                None => f64::from(!failed),
            };
            if strength_left < 1.0 {
                let of_particle: [f64; 6] = std::array::from_fn(|c| s[c][l]);
                left[l] = self.softening(block.i + l, &of_particle, strength_left);
            }
        }
        left
    }

    /// Factor that brings a deviator [Pa] back to what is left of the yield surface after failure.
    #[cold]
    fn softening(&self, i: usize, deviator: &[f64; 6], strength_left: f64) -> f64 {
        if strength_left == 0.0 {
            return 0.0;
        }
        let twice = |c: usize| if D::TENSOR_AXES[c].0 == D::TENSOR_AXES[c].1 { 1.0 } else { 2.0 };
        let invariant: f64 = (0..D::TENSOR_COUNT).map(|c| twice(c) * deviator[c] * deviator[c]).sum();
        // Yield at the share f of Y: at S:S/f² of the whole surface.
        let material = &self.context.matter.materials()[self.fixed.material[i] as usize];
        material.strength.return_factor(invariant / (strength_left * strength_left))
    }
}

/// S ← Q S Qᵀ with the Cayley rotation Q = I + 2/(1 + t²)(T + T²), T = ½τ W, W_kl = ½(∂U_k/∂x_l - ∂U_l/∂x_k).
#[inline(always)]
fn turn<D: SolidDimension, L: Lanes>(s: &mut [[L; 3]; 3], gradient: &[[L; 3]; 3], time_step: f64) {
    // gradient[a][b] = ∂U_b/∂x_a; half the angle about the axis that leads a to b.
    let quarter_step = L::splat(0.25 * time_step);
    let (one, two, half) = (L::one(), L::splat(2.0), L::splat(0.5));
    if D::COUNT == 2 {
        let t = quarter_step * (gradient[0][1] - gradient[1][0]);
        let inverse = one / t.mul_add(t, one);
        let (cos, sin) = ((one - t * t) * inverse, two * t * inverse);
        let (cos2, sin2) = (cos.mul_add(cos, -(sin * sin)), two * cos * sin);
        let (mean, difference) = (half * (s[0][0] + s[1][1]), half * (s[0][0] - s[1][1]));
        let turned = difference.mul_add(cos2, -(s[0][1] * sin2));
        s[0][1] = difference.mul_add(sin2, s[0][1] * cos2);
        s[1][0] = s[0][1];
        s[0][0] = mean + turned;
        s[1][1] = mean - turned;
        return;
    }
    let mut t = [L::zero(); 3];
    for c in 0..3 {
        let (a, b) = ((c + 1) % 3, (c + 2) % 3);
        t[c] = quarter_step * (gradient[a][b] - gradient[b][a]);
    }
    let square = t[0].mul_add(t[0], t[1].mul_add(t[1], t[2] * t[2]));
    let scale = two / (one + square);
    let zero = L::zero();
    let cross = [[zero, -t[2], t[1]], [t[2], zero, -t[0]], [-t[1], t[0], zero]];
    let mut q = cross;
    for a in 0..3 {
        for b in 0..3 {
            let off = t[a].mul_add(t[b], cross[a][b]);
            q[a][b] = if a == b { scale.mul_add(off - square, one) } else { scale * off };
        }
    }
    let mut half_way = q;
    for a in 0..3 {
        for b in 0..3 {
            half_way[a][b] = q[a][0].mul_add(s[0][b], q[a][1].mul_add(s[1][b], q[a][2] * s[2][b]));
        }
    }
    for a in 0..3 {
        for b in a..3 {
            s[a][b] =
                half_way[a][0].mul_add(q[b][0], half_way[a][1].mul_add(q[b][1], half_way[a][2] * q[b][2]));
            s[b][a] = s[a][b];
        }
    }
}
