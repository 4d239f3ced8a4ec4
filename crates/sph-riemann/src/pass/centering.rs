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
//! makes it neutral. Only blocks that see a particle with δ ≠ 0 are visited; their contacts are solved again.

use sph_core::dimension::Components;
use sph_core::lanes::{LANES, LaneKernel, Lanes};

use super::contact::Left;
use super::{Pass, Tile, own_indices};
use crate::dimension::{SolidDimension, dot};
use crate::limiter::Limiter;
use crate::record::Row;

/// The pass over one tile.
pub(super) struct CenteringTile<'a, 'b, D: SolidDimension> {
    pub pass: &'a Pass<'b, D>,
    pub tile: Tile<'a>,
    pub limiter: Limiter,
    /// δ of each record, by axis [m/s].
    pub delta: &'a [Vec<f64>],
    /// Blocks that see a particle with δ ≠ 0.
    pub marked: &'a [bool],
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
    fn block<L: Lanes>(&mut self, block: usize, b: usize) {
        let lists = self.pass.tile_lists(self.tile.index);
        let slots = &lists.slots[lists.start[b] as usize..lists.start[b + 1] as usize];
        let left = Left::<D, L, true>::load(self.pass, block);
        let own = self.delta_of::<L>(&own_indices(block));
        let first = b * Row::count::<D>();
        let half = L::splat(0.5);
        let mut power = L::load(&self.tile.rows[first + Row::POWER].0);
        let mut gradient = D::Axes::<D::Axes<L>>::splat(own);
        for a in 0..D::COUNT {
            for b in 0..D::COUNT {
                let at = first + Row::velocity_gradient::<D>() + a * D::COUNT + b;
                gradient[a][b] = L::load(&self.tile.rows[at].0);
            }
        }
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
        power.store(&mut self.tile.rows[first + Row::POWER].0);
        for a in 0..D::COUNT {
            for b in 0..D::COUNT {
                let at = first + Row::velocity_gradient::<D>() + a * D::COUNT + b;
                gradient[a][b].store(&mut self.tile.rows[at].0);
            }
        }
    }
}

impl<D: SolidDimension> LaneKernel for CenteringTile<'_, '_, D> {
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let first_block = self.tile.index * sph_core::neighbors::TILE_BLOCKS;
        for b in 0..self.tile.rows.len() / Row::count::<D>() {
            if self.marked[first_block + b] {
                self.block::<L>(first_block + b, b);
            }
        }
    }
}
