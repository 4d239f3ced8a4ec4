//! Volume consistency: shut pores must fill space.
//!
//! The density of the continuity equation drifts from the particles' packing where plastic strain is large. At each rebuild of
//! the lists, and whenever particles have moved by a further third of the skin against each other, the volume sum with a wide kernel is
//! held against that of a perfect lattice,
//!
//! ```text
//! S_i  = V_i W(0; h_S) + Σ_j V_j W(r_ij; h_S),  h_S = width × D,   ΔS_i = S_i - S_lattice
//! ```
//!
//! with S_lattice of the square lattice in the plane and of the cubic one in space (other lattices of the same density
//! differ by 2.5e-4 at most). On a disordered packing the sums scatter by more than the tolerance; each particle may then
//! be held against its own first sum in place of S_lattice ([`PackingReference::Start`]). Until the next sum the density
//! relaxes, besides the flow's own rate, with
//!
//! ```text
//! d(ln ρ)/dt += κ (c/h)(ΔS - tol)                  where ΔS > tol
//!               κ (c/h)(ΔS + tol)(1 + ΔS/δ)        where -δ < ΔS < -tol and P > Y
//!               0                                  else
//! ```
//!
//! with c = c_l and h = 2θD; |Δ ln ρ| ≤ 1e-3 a step. Only ρ moves: momentum and total energy stay exact. Nothing is done
//! in a material without yield, nor within the support of the sum from an imposed particle, where space ends.
//!
//! Source: this project; see the guide on what the published curve misses. Valid for regular packings of one particle
//! size per neighborhood.

use rayon::prelude::*;
use sph_core::dimension::{Components, Dimension};
use sph_core::domain::Domain;
use sph_core::geometry::{Lattice, lattice_volume_sum};
use sph_core::kernel::KernelFamily;
use sph_core::lanes::{InstructionSet, LANES, LaneKernel, Lanes, dispatch_with};
use sph_core::neighbors::cell_grid::CellSortedPoints;
use sph_core::neighbors::{Halo, TILE};
use sph_core::particles::{Constraint, Particles};

use crate::scheme::{PackingReference, VolumeConsistency};

/// Fills the column `packing_excess` with ΔS, zero near imposed particles.
pub fn measure<D: Dimension>(
    particles: &mut Particles<D>,
    domain: &Domain<D>,
    settings: &VolumeConsistency,
    instructions: InstructionSet,
) {
    let largest = particles.size.iter().fold(0.0_f64, |a, &b| a.max(b));
    if particles.is_empty() || largest == 0.0 {
        return;
    }
    let kernel = KernelFamily::WendlandC2;
    let reach = kernel.support() * settings.width * largest;
    // Particles may have left the box since their lists were built.
    let inside = |a: usize| particles.position[a].iter().map(|&x| domain.wrap(a, x)).collect();
    let own: D::AxisColumns = Components::from_fn(inside);
    let halo = Halo::<D>::build(&own, domain, reach);
    let all: D::AxisColumns = Components::from_fn(|a| halo.extended_position(&own, a));
    let points = CellSortedPoints::<D>::new(&all, 0.5 * reach);
    let n = particles.len();
    let owner = |i: u32| if (i as usize) < n { i as usize } else { halo.owner[i as usize - n] as usize };
    let padded = |value: &dyn Fn(usize) -> f64, filling: f64| -> Vec<f64> {
        points.index.iter().map(|&i| value(owner(i))).chain([filling; LANES]).collect()
    };
    let volume = padded(&|i| particles.mass[i] / particles.density[i], 0.0);
    let imposed = padded(&|i| (particles.constraint[i] != Constraint::Free) as u8 as f64, 0.0);
    let position: D::AxisColumns =
        Components::from_fn(|a| points.position[a].iter().copied().chain([FAR; LANES]).collect());
    let perfect = if D::COUNT == 2 { Lattice::Square } else { Lattice::Cubic };
    let lattice = lattice_volume_sum(perfect, settings.width, kernel);
    let sum = &VolumeSum { points: &points, position: &position, volume: &volume, imposed: &imposed, kernel };
    let (own, size) = (&own, &particles.size);
    let (width, from_start) = (settings.width, settings.reference == PackingReference::Start);
    let columns = particles.packing_excess.par_chunks_mut(TILE);
    columns.zip(particles.packing_reference.par_chunks_mut(TILE)).enumerate().for_each(
        |(t, (excess, reference))| {
            let first = t * TILE;
            let tile =
                VolumeSumTile::<D> { sum, own, size, first, width, lattice, from_start, excess, reference };
            dispatch_with(instructions, tile);
        },
    );
}

/// Where the filling of whole lanes stands [m]: beyond every support, and finite when squared.
const FAR: f64 = 1e100;

struct VolumeSum<'a, D: Dimension> {
    points: &'a CellSortedPoints<D>,
    position: &'a D::AxisColumns,
    volume: &'a [f64],
    imposed: &'a [f64],
    kernel: KernelFamily,
}

struct VolumeSumTile<'a, D: Dimension> {
    sum: &'a VolumeSum<'a, D>,
    own: &'a D::AxisColumns,
    size: &'a [f64],
    first: usize,
    width: f64,
    lattice: f64,
    from_start: bool,
    excess: &'a mut [f64],
    reference: &'a mut [f64],
}

impl<D: Dimension> LaneKernel for VolumeSumTile<'_, D> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        for (k, excess) in self.excess.iter_mut().enumerate() {
            let i = self.first + k;
            let h = self.width * self.size[i];
            let point = D::vector(|a| self.own[a][i]);
            let normalization = self.sum.kernel.normalization(D::COUNT) / h.powi(D::COUNT as i32);
            let (total, imposed) = self.sum.around::<L>(point, h);
            let sum = normalization * total;
            let unseen = self.from_start && imposed == 0.0 && self.reference[k] == 0.0;
            if unseen {
                self.reference[k] = sum;
            }
            let reference = if self.from_start { self.reference[k] } else { self.lattice };
            *excess = if imposed > 0.0 { 0.0 } else { sum - reference };
        }
    }
}

impl<D: Dimension> VolumeSum<'_, D> {
    /// Σ V_j w(r/h) without normalization, and whether an imposed particle is within the support.
    #[inline(always)]
    fn around<L: Lanes>(&self, point: D::Vector, h: f64) -> (f64, f64) {
        let reach = self.kernel.support() * h;
        let inverse_h = L::splat(1.0 / h);
        let support = L::splat(self.kernel.support());
        // A little more than the support, so that rounding leaves nobody out.
        let reach_squared = L::splat(reach * reach * (1.0 + 1e-12));
        let lane = L::load(&std::array::from_fn(|l| l as f64));
        let (mut total, mut imposed) = (L::zero(), L::zero());
        self.points.runs_near(point, reach, |first, end| {
            for p in (first..end).step_by(LANES) {
                let load =
                    |column: &[f64]| L::load(column[p..p + LANES].try_into().expect("padded to whole lanes"));
                let mut r2 = L::zero();
                for a in 0..D::COUNT {
                    let d = load(&self.position[a]) - L::splat(point[a]);
                    r2 = d.mul_add(d, r2);
                }
                if r2.less_mask(reach_squared) == 0 {
                    continue; // All are beyond the support: zeros would be added.
                }
                let q = r2.sqrt() * inverse_h;
                let inside = lane.select_less(L::splat((end - p) as f64), load(self.volume), L::zero());
                total = inside.mul_add(self.kernel.value(q), total);
                let seen = q.select_less(support, load(self.imposed), L::zero());
                imposed = imposed.max(seen);
            }
        });
        let total: f64 = total.to_array().iter().sum();
        (total, imposed.to_array().iter().fold(0.0, |a, &b| a.max(b)))
    }
}
