//! Second pass: the contact of each pair.
//!
//! ```text
//! Φ_l, Φ_r  reconstructed from both sides                                       (paper eqs. (13)-(15))
//! U*, t*    from the acoustic contact along R, S, T with tractions σ ½(K_i + K_j) e_R
//! F_i      += w t*,            F_j    -= w t*         w = 2 V_i V_j |W'_ij| / h_ij      (paper eq. (10) times m)
//! P_i      += w t*·U*,         P_j    -= w t*·U*                                        (paper eq. (11) times m)
//! V_i R_ab += w e_a (U* - U_i)_b,   V_j R_ab -= w e_a (U* - U_j)_b                      (paper eqs. (9), (20), raw)
//! ```
//!
//! With the spectral cap the traction is completed to the adjoint of the velocity gradient,
//!
//! ```text
//! t* += (w_l σ_l - w_r σ_r)·½(K_i - K_j) e_R - (w_l c_i + w_r c_j) × e_R,   w_l = z_r/(z_l + z_r), w_r = z_l/(z_l + z_r)
//! ```
//!
//! so that each side exerts σ K e - c × e of its own, while U* keeps the mean correction. Each pair is solved once: what one
//! particle gains in momentum and energy the other loses, bit for bit, and the sums conserve both to round-off.

mod star;

use std::hint::black_box;

use sph_core::dimension::Components;
use sph_core::lanes::{LANES, LaneKernel, Lanes, Line, Part, prefetch};

use self::star::{Chosen, Pair};
use super::ahead::Ahead;
use super::sums::{TilePairs, add_to_buffer};
use super::{Pass, load_line, own_indices};
use crate::dimension::{SolidDimension, dot};
use crate::limiter::Limiter;
use crate::record::{Sides, Sums};

/// The pass over one tile. `RECONSTRUCT` is false for piecewise constant sides without correction.
pub(super) struct ContactTile<'a, 'b, D: SolidDimension, const RECONSTRUCT: bool> {
    pub pass: &'a Pass<'b, D>,
    pub index: usize,
    pub limiter: Limiter,
    pub pairs: &'a mut TilePairs,
    pub buffer: &'a mut [Line],
    /// Where the sums of the tile's particles go afterwards: asked for ahead.
    pub sums: &'a [Line],
}

/// What the contact of a pair gives.
struct PairContact<D: SolidDimension, L: Part> {
    /// w e_R [m^(d-1)].
    gradient: D::Axes<L>,
    /// w t* [N].
    force: D::Axes<L>,
    /// U* [m/s].
    velocity: D::Axes<L>,
    /// U_j [m/s], half a step later.
    right_velocity: D::Axes<L>,
    /// (U_j - U_i)² [m²/s²].
    relative_speed_squared: L,
    /// True if time-centering needs the force of one of the pairs.
    marked: bool,
}

impl<D: SolidDimension, const RECONSTRUCT: bool> LaneKernel for ContactTile<'_, '_, D, RECONSTRUCT> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        // Reconstruction has more numbers than sixteen registers hold eight at a time; without it eight are faster.
        if RECONSTRUCT && L::HALVES {
            self.parts::<L::First, L::Second>(true);
        } else {
            self.parts::<L, L>(false);
        }
    }
}

impl<D: SolidDimension, const RECONSTRUCT: bool> ContactTile<'_, '_, D, RECONSTRUCT> {
    /// The tile, of each slot first the part `P`, then the part `Q`, if there is one: sums have the same order either way.
    #[inline(always)]
    fn parts<P: Part, Q: Part>(self, has_second: bool) {
        let Self { pass, index, limiter, pairs, buffer, sums } = self;
        let lists = &pass.lists.tiles()[index];
        pairs.clear_forces(lists.n_slots_once());
        let limiter = Chosen { limiter, is_default: black_box(limiter == Limiter::VanLeer) };
        let ahead = Ahead::of(pass.lists, index);
        let mut first = 0;
        for b in 0..lists.n_blocks() {
            prefetch(sums, b * LANES * D::SUM_LINES, LANES * D::SUM_LINES);
            let lines = Left::<D, P, RECONSTRUCT>::LINES;
            ahead.records(b, pass.records, lines, lines);
            let (slots, targets) = lists.pairs(b);
            let indices = own_indices(index * sph_core::neighbors::TILE_BLOCKS + b);
            let mut one = BlockPart::<D, P, RECONSTRUCT>::load(pass, &indices);
            let mut two =
                if has_second { Some(BlockPart::<D, Q, RECONSTRUCT>::load(pass, &indices)) } else { None };
            for (slots, targets) in slots.chunks(u32::BITS as usize).zip(targets.chunks(u32::BITS as usize)) {
                let of_one = one.left.reaching(pass, slots);
                let of_two = if let Some(two) = &two { two.left.reaching(pass, slots) } else { 0 };
                let mut reaching = of_one | of_two;
                while reaching != 0 {
                    let k = reaching.trailing_zeros() as usize;
                    reaching &= reaching - 1;
                    let slot =
                        Slot { records: &slots[k], targets: targets[k].map(u32::from), place: first + k };
                    if two.is_none() || of_one >> k & 1 == 1 {
                        one.solve(pass, limiter, &slot, pairs, buffer);
                    }
                    if let Some(two) = &mut two
                        && of_two >> k & 1 == 1
                    {
                        two.solve(pass, limiter, &slot, pairs, buffer);
                    }
                }
                first += slots.len();
            }
            one.add(&own_indices(b), buffer);
            if let Some(two) = two {
                two.add(&own_indices(b), buffer);
            }
        }
    }
}

/// Eight pairs of a block.
struct Slot<'a> {
    /// Records of the right particles.
    records: &'a [u32; LANES],
    /// Places of the right particles in the buffer.
    targets: [u32; LANES],
    /// Place of the slot among all of the tile.
    place: usize,
}

/// The left particles of a block, or half of them, and what they have gained.
struct BlockPart<D: SolidDimension, L: Part, const RECONSTRUCT: bool> {
    left: Left<D, L, RECONSTRUCT>,
    own: D::SumsRecord<L>,
}

impl<D: SolidDimension, L: Part, const RECONSTRUCT: bool> BlockPart<D, L, RECONSTRUCT> {
    #[inline(always)]
    fn load(pass: &Pass<'_, D>, indices: &[u32; LANES]) -> Self {
        Self { left: Left::load(pass, indices), own: D::SumsRecord::<L>::splat(L::zero()) }
    }

    /// Solves the contacts of a slot and adds what both sides gain.
    #[inline(always)]
    fn solve(
        &mut self,
        pass: &Pass<'_, D>,
        limiter: Chosen,
        slot: &Slot<'_>,
        pairs: &mut TilePairs,
        buffer: &mut [Line],
    ) {
        let pair = self.left.contact(pass, limiter, slot.records);
        if pair.marked {
            let forces = pairs.mark(slot.place, D::COUNT);
            for a in 0..D::COUNT {
                pair.force[a].store(&mut forces[a].0);
            }
        }
        let other = self.left.share(&pair, &mut self.own);
        // SAFETY: the buffer has the size that the lists ask for, `Pass::run_with_buffers` sees to it.
        unsafe { add_to_buffer::<D, L>(&other, buffer, &slot.targets) };
    }

    /// Adds what the left particles have gained.
    #[inline(always)]
    fn add(&self, places: &[u32; LANES], buffer: &mut [Line]) {
        // SAFETY: as in `solve`; places of own particles come first.
        unsafe { add_to_buffer::<D, L>(&self.own, buffer, places) };
    }
}

/// The left sides of eight pairs.
struct Left<D: SolidDimension, L: Part, const RECONSTRUCT: bool> {
    record: D::SidesRecord<L>,
    size: L,
    twice_volume: L,
    marked: bool,
}

impl<D: SolidDimension, L: Part, const RECONSTRUCT: bool> Left<D, L, RECONSTRUCT> {
    /// Lines of a record.
    const LINES: usize = if RECONSTRUCT { D::SIDES_LINES } else { D::CONSTANT_SIDES_LINES };

    #[inline(always)]
    fn load(pass: &Pass<'_, D>, indices: &[u32; LANES]) -> Self {
        let mut record = D::SidesRecord::<L>::splat(L::zero());
        for line in 0..Self::LINES {
            // SAFETY: indices of particles are below `n_padded`, and records reach to `n_records`.
            unsafe { load_line(&mut record, pass.records, Self::LINES, line, indices) };
        }
        let volume = record[Sides::volume::<D>()];
        let twice_volume = (volume + volume).abs();
        let marked = volume.any_less(L::zero());
        Self { record, size: pass.smoothing.own(indices), twice_volume, marked }
    }

    /// Adds what the pair gives to the left particle, and returns what it gives to the right one.
    #[inline(always)]
    fn share(&self, pair: &PairContact<D, L>, own: &mut D::SumsRecord<L>) -> D::SumsRecord<L> {
        let mut other = D::SumsRecord::<L>::splat(L::zero());
        for b in 0..D::COUNT {
            own[Sums::FORCE + b] += pair.force[b];
            other[Sums::FORCE + b] = -pair.force[b];
            let left_change = pair.velocity[b] - self.record[Sides::fields::<D>() + b];
            let right_change = pair.right_velocity[b] - pair.velocity[b];
            for a in 0..D::COUNT {
                let at = Sums::gradient::<D>() + a * D::COUNT + b;
                own[at] = pair.gradient[a].mul_add(left_change, own[at]);
                other[at] = pair.gradient[a] * right_change;
            }
        }
        let power = dot::<D, L>(&pair.force, &pair.velocity);
        own[Sums::power::<D>()] += power;
        other[Sums::power::<D>()] = -power;
        let fastest = Sums::relative_speed_squared::<D>();
        own[fastest] = pair.relative_speed_squared.max(own[fastest]);
        other[fastest] = pair.relative_speed_squared;
        other
    }

    /// Bit k is set where slot k has a pair within the support of the kernel, or at its very edge. That is told of all slots
    /// before their contacts: no root or division waits for a branch that was not foreseen.
    #[inline(always)]
    fn reaching(&self, pass: &Pass<'_, D>, slots: &[[u32; LANES]]) -> u32 {
        let mut reaching = 0;
        for (k, slot) in slots.iter().enumerate() {
            // SAFETY: entries of a list are below `n_records`, the length of the records.
            let right = unsafe { L::load_records(pass.records, Self::LINES, 0, slot) };
            let dx = self.distance(&right);
            let reach_squared = pass.smoothing.reach_squared(self.size, slot);
            reaching |= u32::from(dot::<D, L>(&dx, &dx).any_less(reach_squared)) << k;
        }
        reaching
    }

    /// r_j - r_i [m] from the first line of the right records.
    #[inline(always)]
    fn distance(&self, right: &[L; LANES]) -> D::Axes<L> {
        let mut dx = D::Axes::<L>::splat(L::zero());
        for a in 0..D::COUNT {
            dx[a] = right[a] - self.record[a];
        }
        dx
    }

    /// All lines of the right records but the first.
    #[inline(always)]
    fn load_rest(&self, pass: &Pass<'_, D>, slot: &[u32; LANES], right: &mut D::SidesRecord<L>) {
        for line in 1..Self::LINES {
            // SAFETY: entries of a list are below `n_records`, the length of the records.
            unsafe { load_line(right, pass.records, Self::LINES, line, slot) };
        }
    }

    /// The contacts of eight pairs.
    #[inline(always)]
    fn contact(&self, pass: &Pass<'_, D>, limiter: Chosen, slot: &[u32; LANES]) -> PairContact<D, L> {
        let left = &self.record;
        let mut right = D::SidesRecord::<L>::splat(L::zero());
        // SAFETY: entries of a list are below `n_records`, the length of the records.
        let first_line = unsafe { L::load_records(pass.records, Self::LINES, 0, slot) };
        for k in 0..LANES {
            right[k] = first_line[k];
        }
        let dx = self.distance(&first_line);
        let r = dot::<D, L>(&dx, &dx).sqrt();
        // Sixteen registers do not hold the other lines beside the geometry: the compiler would load them only to put them on
        // the stack. Where there are more, their shuffles fill the time of the root.
        let late = L::COUNT < LANES;
        if !late {
            self.load_rest(pass, slot, &mut right);
        }
        // A particle stands in for missing neighbors of its own: e = 0 there, and all is zero.
        let inverse_r = L::one() / r.max(L::splat(f64::MIN_POSITIVE));
        let scales = pass.smoothing.scales(self.size, slot);
        let slope = scales.slope * pass.smoothing.minus_slope_over_q(r * scales.inverse_h);
        let volume = right[Sides::volume::<D>()];
        let weight_over_r = self.twice_volume * volume.abs() * slope;
        let weight = weight_over_r * r;
        if late {
            self.load_rest(pass, slot, &mut right);
        }
        let (mut e, mut gradient, mut du, mut right_velocity) = (dx, dx, dx, dx);
        for a in 0..D::COUNT {
            e[a] = dx[a] * inverse_r;
            gradient[a] = weight_over_r * dx[a];
            right_velocity[a] = right[Sides::fields::<D>() + a];
            du[a] = right_velocity[a] - left[Sides::fields::<D>() + a];
        }
        let (velocity, mut force) =
            Pair { left, right: &right, dx: &dx, e: &e }.star::<RECONSTRUCT>(pass, limiter);
        for a in 0..D::COUNT {
            force[a] = weight * force[a];
        }
        // Pairs of the skin do not count: when lists are rebuilt must not matter.
        let relative_speed_squared = L::zero().select_less(weight_over_r, dot::<D, L>(&du, &du), L::zero());
        let marked = self.marked || volume.any_less(L::zero());
        PairContact { gradient, force, velocity, right_velocity, relative_speed_squared, marked }
    }
}
