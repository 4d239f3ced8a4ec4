//! Time-centering at free surfaces: the half step of the velocity follows the true acceleration.
//!
//! The half step of U uses a difference gradient of σ, which is zero in a film two particles thick while the true
//! acceleration is not: a mode that would grow by sqrt(1 + (ωτ)²/2) a step. Once the forces are known,
//!
//! ```text
//! δ_i   = ½τ F_i/m_i - (half-step change of U_i)       where λ_min(L_i) < 0.75 and U is free, else 0
//! R_ab += Σ V_j ∂_aW (δ_j - δ_i)_b
//! P_i  += Σ F_ij·½(δ_i + δ_j)                          antisymmetric in i, j: energy stays exact
//! ```
//!
//! makes it neutral. Only pairs with such a particle on a side count. The first pass marks these particles, and the contact
//! pass keeps the forces of pairs with a mark: no contact is solved again.

use rayon::prelude::*;
use sph_core::dimension::Components;
use sph_core::lanes::{InstructionSet, LANES, LaneKernel, Lanes, Line, prefetch};
use sph_core::neighbors::{NeighborLists, TILE, TILE_BLOCKS};

use super::ahead::Ahead;
use super::gradient::CENTERING_EIGENVALUE;
use super::sums::{TilePairs, add_to_buffer, ask_ahead, collect};
use super::{Pass, load_line, own_indices};
use crate::dimension::{SolidDimension, dot};
use crate::record::{Centered, Row, Sides, Sums};

/// The pass over one tile.
pub(super) struct CenteringTile<'a, 'b, D: SolidDimension> {
    pub pass: &'a Pass<'b, D>,
    pub index: usize,
    pub pairs: &'a TilePairs,
    pub buffer: &'a mut [Line],
    /// Where the sums of the tile's particles go afterwards: asked for ahead.
    pub sums: &'a [Line],
}

/// Where the sums of the contact pass stand before time-centering, and what it reads of particles.
pub struct Deltas<'a, D: SolidDimension> {
    /// The lists.
    pub lists: &'a NeighborLists<D>,
    /// What the pairs of each tile left behind.
    pub pairs: &'a [TilePairs],
    /// Velocity at the start of the step [m/s].
    pub velocity: &'a D::AxisColumns,
    /// Mass [kg], per meter of depth in the plane.
    pub mass: &'a [f64],
    /// Half the time step [s].
    pub half_step: f64,
    /// Instructions to use.
    pub instructions: InstructionSet,
}

impl<D: SolidDimension> Deltas<'_, D> {
    /// If any pair is marked, collects the sums of the contact pass and writes δ into its records (`sides`). True if so.
    /// `rows` are those of the first pass.
    pub fn fill(&self, rows: &[Line], sums: &mut [Line], sides: &mut [Line]) -> bool {
        if !self.pairs.iter().any(TilePairs::has_marked) {
            return false;
        }
        let own = &mut sides[..self.lists.n_padded() * D::SIDES_LINES];
        let tiles = sums
            .par_chunks_mut(TILE * D::SUM_LINES)
            .zip(own.par_chunks_mut(TILE * D::SIDES_LINES))
            .zip(rows.par_chunks(TILE_BLOCKS * Row::count::<D>()))
            .enumerate();
        tiles.for_each(|(t, ((sums, sides), own_rows))| {
            collect::<D>(self.lists, self.pairs, self.instructions, t, sums);
            ask_ahead::<D>(self.lists, self.pairs, t, sums);
            for (b, own_rows) in own_rows.chunks_exact(Row::count::<D>()).enumerate() {
                self.ask_for_marked(t, b, rows, sums, sides);
                for l in 0..LANES {
                    if own_rows[Row::LEAST_EIGENVALUE].0[l] < CENTERING_EIGENVALUE {
                        let k = b * LANES + l;
                        let side = &mut sides[k * D::SIDES_LINES..(k + 1) * D::SIDES_LINES];
                        self.particle(t * TILE + k, &sums[k * D::SUM_LINES].0, side);
                    }
                }
            }
        });
        self.refresh_copies(sides);
        true
    }

    /// Asks for what block `b` of the tile after tile `t` needs, and for the eigenvalues of the tile after that: of records only
    /// those of particles with a mark, few of all.
    #[inline(always)]
    fn ask_for_marked(&self, t: usize, b: usize, rows: &[Line], sums: &[Line], sides: &[Line]) {
        let eigenvalue =
            |tiles: usize| ((t + tiles) * TILE_BLOCKS + b) * Row::count::<D>() + Row::LEAST_EIGENVALUE;
        prefetch(rows, eigenvalue(2), 1);
        let Some(next) = rows.get(eigenvalue(1)) else { return };
        for l in (0..LANES).filter(|l| next.0[*l] < CENTERING_EIGENVALUE) {
            let particle = (b + TILE_BLOCKS) * LANES + l;
            prefetch(sums, particle * D::SUM_LINES, 1);
            prefetch(sides, particle * D::SIDES_LINES, 1);
        }
    }

    /// δ of particle `i` in the place of its impedances, if it is marked; all of it is in the first line.
    #[inline]
    fn particle(&self, i: usize, sums: &[f64; LANES], side: &mut [Line]) {
        if side[0].0[Sides::volume::<D>()] < 0.0 {
            for a in 0..D::COUNT {
                let at = Sides::fields::<D>() + a;
                let half_step_change = side[at / LANES].0[at % LANES] - self.velocity[a][i];
                side[0].0[Centered::delta::<D>() + a] =
                    self.half_step * sums[Sums::FORCE + a] / self.mass[i] - half_step_change;
            }
        }
    }

    /// δ of the copies across periodic sides.
    fn refresh_copies(&self, sides: &mut [Line]) {
        let (own, copies) = sides.split_at_mut(self.lists.n_padded() * D::SIDES_LINES);
        let delta = Centered::delta::<D>()..Centered::delta::<D>() + D::COUNT;
        for (owner, copy) in self.lists.halo().owner.iter().zip(copies.chunks_exact_mut(D::SIDES_LINES)) {
            copy[0].0[delta.clone()].copy_from_slice(&own[*owner as usize * D::SIDES_LINES].0[delta.clone()]);
        }
    }
}

impl<D: SolidDimension> LaneKernel for CenteringTile<'_, '_, D> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { pass, index, pairs, buffer, sums } = self;
        let lists = &pass.lists.tiles()[index];
        let mut marked = pairs.marked.iter();
        let mut forces = pairs.forces.chunks_exact(D::COUNT);
        let ahead = Ahead::of(pass.lists, index);
        for b in 0..lists.n_blocks() {
            prefetch(sums, b * LANES * D::SUM_LINES, LANES * D::SUM_LINES);
            ahead.records(b, pass.records, D::SIDES_LINES, 1);
            let (slots, targets) = lists.pairs(b);
            let marks = &marked.as_slice()[..slots.len()];
            marked = marked.as_slice()[slots.len()..].iter();
            if !marks.contains(&true) {
                continue;
            }
            let left = Left::<D, L>::load(pass, &own_indices(index * TILE_BLOCKS + b));
            let mut own = D::SumsRecord::<L>::splat(L::zero());
            for k in 0..slots.len() {
                let (true, Some(force)) = (marks[k], if marks[k] { forces.next() } else { None }) else {
                    continue;
                };
                let other = left.pair(pass, &slots[k], force, &mut own);
                // SAFETY: the buffer has the size that the lists ask for, `Pass::run_with_buffers` sees to it.
                unsafe { add_to_buffer::<D, L>(&other, buffer, &targets[k].map(u32::from)) };
            }
            // SAFETY: as above; places of own particles come first.
            unsafe { add_to_buffer::<D, L>(&own, buffer, &own_indices(b)) };
        }
    }
}

/// The left particles of eight pairs.
struct Left<D: SolidDimension, L: Lanes> {
    record: D::StateRecord<L>,
    size: L,
}

impl<D: SolidDimension, L: Lanes> Left<D, L> {
    #[inline(always)]
    fn load(pass: &Pass<'_, D>, indices: &[u32; LANES]) -> Self {
        let mut record = D::StateRecord::<L>::splat(L::zero());
        // SAFETY: indices of particles are below `n_padded`, and records reach to `n_records`.
        unsafe { load_line(&mut record, pass.records, D::SIDES_LINES, 0, indices) };
        Self { record, size: pass.smoothing.own(indices) }
    }

    /// δ of eight particles: zero where there is no mark.
    #[inline(always)]
    fn delta(record: &D::StateRecord<L>, a: usize) -> L {
        let delta = record[Centered::delta::<D>() + a];
        record[Sides::volume::<D>()].select_less(L::zero(), delta, L::zero())
    }

    /// Adds what the pair gives to the left particle, and returns what it gives to the right one.
    #[inline(always)]
    fn pair(
        &self,
        pass: &Pass<'_, D>,
        slot: &[u32; LANES],
        force: &[Line],
        own: &mut D::SumsRecord<L>,
    ) -> D::SumsRecord<L> {
        let left = &self.record;
        let mut right = D::StateRecord::<L>::splat(L::zero());
        // SAFETY: entries of a list are below `n_records`, the length of the records.
        unsafe { load_line(&mut right, pass.records, D::SIDES_LINES, 0, slot) };
        let mut dx = D::Axes::<L>::splat(L::zero());
        let (mut mean, mut change, mut contact) = (dx, dx, dx);
        for a in 0..D::COUNT {
            let (here, there) = (Self::delta(left, a), Self::delta(&right, a));
            dx[a] = right[a] - left[a];
            mean[a] = L::splat(0.5) * (here + there);
            change[a] = there - here;
            contact[a] = L::load(&force[a].0);
        }
        let scales = pass.smoothing.scales(self.size, slot);
        let q = dot::<D, L>(&dx, &dx).sqrt() * scales.inverse_h;
        let volumes = (left[Sides::volume::<D>()] * right[Sides::volume::<D>()]).abs();
        let weight = volumes * (scales.slope * pass.smoothing.minus_slope_over_q(q));
        let power = dot::<D, L>(&contact, &mean);
        let mut other = D::SumsRecord::<L>::splat(L::zero());
        own[Sums::power::<D>()] += power;
        other[Sums::power::<D>()] = -power;
        for a in 0..D::COUNT {
            let gradient = weight * dx[a];
            for b in 0..D::COUNT {
                // The same for both: dx and the change both turn around.
                let product = gradient * change[b];
                own[Sums::gradient::<D>() + a * D::COUNT + b] += product;
                other[Sums::gradient::<D>() + a * D::COUNT + b] = product;
            }
        }
        other
    }
}
