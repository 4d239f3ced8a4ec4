//! Time-centring at free surfaces: the half step of the velocity follows the true acceleration.
//!
//! The half step of U uses a difference gradient of σ, which is zero in a film two particles thick while the true
//! acceleration is not: a mode that would grow by sqrt(1 + (ωτ)²/2) a step. Once the forces are known,
//!
//! ```text
//! δ_i   = ½τ f_i/ρ_i - (half-step change of U_i)       where λ_min(L_i) < 0.75 and U is free, else 0
//! R_ab += Σ V_j ∂_aW (δ_j - δ_i)_b
//! p_i  += Σ w t*·½(δ_i + δ_j)                          antisymmetric in i, j: energy stays exact
//! ```
//!
//! makes it neutral. Only pairs with δ ≠ 0 on a side count: a list of them is made in each step, tile by tile, and their
//! contacts are solved again.

use rayon::prelude::*;
use sph_core::dimension::Components;
use sph_core::lanes::{LANES, LaneKernel, Lanes};
use sph_core::neighbors::TILE;

use super::contact::Left;
use super::{Pass, Tile};
use crate::dimension::{SolidDimension, dot};
use crate::limiter::Limiter;
use crate::record::Row;

/// Pairs of a tile with δ ≠ 0 on a side, in blocks of eight particles as neighbour lists have them.
#[derive(Clone, Debug, Default)]
pub struct CenteredPairs {
    /// Particles of each block; the last one stands in for missing ones, without neighbours.
    members: Vec<[u32; LANES]>,
    /// First slot of each block, and the end of the last.
    start: Vec<u32>,
    slots: Vec<[u32; LANES]>,
    /// Particles with neighbours in the list, those with δ ≠ 0 first, and where their neighbours stand in `found`.
    own: Vec<(u32, u32, u32)>,
    others: Vec<(u32, u32, u32)>,
    found: Vec<u32>,
}

/// Finds the pairs with δ ≠ 0 on a side; `moved` tells it of each record. One entry of `pairs` a tile.
pub fn find_pairs<D: SolidDimension>(pass: &Pass<'_, D>, moved: &[bool], pairs: &mut [CenteredPairs]) {
    let n = pass.lists.n_particles;
    pairs.par_iter_mut().enumerate().for_each(|(t, pairs)| {
        pairs.collect(pass, moved, t * TILE..((t + 1) * TILE).min(n));
        pairs.pack();
    });
}

impl CenteredPairs {
    fn collect<D: SolidDimension>(
        &mut self,
        pass: &Pass<'_, D>,
        moved: &[bool],
        particles: std::ops::Range<usize>,
    ) {
        // Pairs beyond the support add exact zeros; where h is one number it is cheap to leave them out.
        let reach = pass.smoothing.uniform_reach().unwrap_or(f64::INFINITY);
        let place = |record: usize| &pass.records[record * D::SIDES_LINES].0;
        let within = |i: usize, j: usize| {
            let (here, there) = (place(i), place(j));
            (0..D::COUNT).map(|a| (there[a] - here[a]) * (there[a] - here[a])).sum::<f64>() < reach * reach
        };
        self.own.clear();
        self.others.clear();
        self.found.clear();
        for i in particles {
            let first = self.found.len() as u32;
            let all = moved[i];
            for slot in pass.lists.block(i / LANES) {
                let j = slot[i % LANES];
                if j as usize != i && (all || moved[j as usize]) && within(i, j as usize) {
                    self.found.push(j);
                }
            }
            let end = self.found.len() as u32;
            if end > first {
                if all { &mut self.own } else { &mut self.others }.push((i as u32, first, end));
            }
        }
    }

    /// Blocks of eight from particles of like numbers of pairs.
    fn pack(&mut self) {
        self.members.clear();
        self.slots.clear();
        self.start.clear();
        self.start.push(0);
        let listed = || self.own.iter().chain(&self.others);
        let count = self.own.len() + self.others.len();
        for block in 0..count.div_ceil(LANES) {
            let mut eight = [(0, 0, 0); LANES];
            let mut of_block = listed().skip(block * LANES);
            let last = of_block.clone().take(LANES).last().copied().unwrap_or_default();
            eight.fill_with(|| of_block.next().copied().unwrap_or((last.0, 0, 0)));
            let longest = eight.iter().map(|(_, first, end)| end - first).max().unwrap_or(0);
            self.members.push(eight.map(|(i, _, _)| i));
            for k in 0..longest {
                self.slots.push(eight.map(|(i, first, end)| {
                    if first + k < end { self.found[(first + k) as usize] } else { i }
                }));
            }
            self.start.push(self.slots.len() as u32);
        }
    }
}

/// The pass over one tile.
pub(super) struct CenteringTile<'a, 'b, D: SolidDimension> {
    pub pass: &'a Pass<'b, D>,
    pub tile: Tile<'a>,
    pub limiter: Limiter,
    /// δ of each record, by axis [m/s].
    pub delta: &'a [Vec<f64>],
    pub pairs: &'a CenteredPairs,
}

/// Sums of a block.
struct Sums<D: SolidDimension, L: Lanes> {
    power: L,
    gradient: D::Axes<D::Axes<L>>,
}

impl<D: SolidDimension> CenteringTile<'_, '_, D> {
    #[inline(always)]
    fn delta_of<L: Lanes>(&self, indices: &[u32; LANES]) -> D::Axes<L> {
        let mut delta = D::Axes::<L>::splat(L::zero());
        for a in 0..D::COUNT {
            delta[a] = L::gather(&self.delta[a], indices);
        }
        delta
    }

    #[inline(always)]
    fn sums<L: Lanes>(&self, members: &[u32; LANES], slots: &[[u32; LANES]]) -> Sums<D, L> {
        let left = Left::<D, L, true>::load(self.pass, members);
        let own = self.delta_of::<L>(members);
        let half = L::splat(0.5);
        let mut power = L::zero();
        let mut gradient = D::Axes::<D::Axes<L>>::splat(D::Axes::<L>::splat(L::zero()));
        for slot in slots {
            let Some(pair) = left.contact(self.pass, self.limiter, slot) else { continue };
            let other = self.delta_of::<L>(slot);
            let (mut mean, mut change) = (own, own);
            for a in 0..D::COUNT {
                mean[a] = half * (own[a] + other[a]);
                // The gradient of a pair carries the factor 2 of U* - U_i.
                change[a] = half * (other[a] - own[a]);
            }
            power += dot::<D, L>(&pair.force, &mean);
            for a in 0..D::COUNT {
                for b in 0..D::COUNT {
                    gradient[a][b] = pair.gradient[a].mul_add(change[b], gradient[a][b]);
                }
            }
        }
        Sums { power, gradient }
    }

    /// Adds the sums to the rows of each particle once.
    #[inline(always)]
    fn add<L: Lanes>(&mut self, members: &[u32; LANES], sums: &Sums<D, L>) {
        let once = |l: usize| l == 0 || members[l] != members[l - 1];
        let mut into = |r: usize, sum: L| {
            let sum = sum.to_array();
            for l in (0..LANES).filter(|&l| once(l)) {
                let k = members[l] as usize - self.tile.index * TILE;
                self.tile.rows[k / LANES * Row::count::<D>() + r].0[k % LANES] += sum[l];
            }
        };
        into(Row::POWER, sums.power);
        for a in 0..D::COUNT {
            for b in 0..D::COUNT {
                into(Row::velocity_gradient::<D>() + a * D::COUNT + b, sums.gradient[a][b]);
            }
        }
    }
}

impl<D: SolidDimension> LaneKernel for CenteringTile<'_, '_, D> {
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let pairs = self.pairs;
        for (members, range) in pairs.members.iter().zip(pairs.start.windows(2)) {
            let sums = self.sums::<L>(members, &pairs.slots[range[0] as usize..range[1] as usize]);
            self.add(members, &sums);
        }
    }
}
