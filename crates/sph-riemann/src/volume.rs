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

use std::ops::Range;

use rayon::prelude::*;
use sph_core::dimension::{Components, Dimension};
use sph_core::domain::Domain;
use sph_core::geometry::{Lattice, lattice_volume_sum};
use sph_core::kernel::KernelFamily;
use sph_core::lanes::{InstructionSet, LANES, LaneKernel, Lanes, dispatch_with};
use sph_core::memory::resize_scratch;
use sph_core::neighbors::cell_grid::{CellSortedPoints, Vicinity, Workspace};
use sph_core::neighbors::{Halo, TILE};
use sph_core::particles::{Constraint, Particles};

use crate::scheme::{PackingReference, VolumeConsistency};

/// The kernel of the sum.
const KERNEL: KernelFamily = KernelFamily::WendlandC2;

/// Fills the column `packing_excess` with ΔS, zero near imposed particles.
pub fn measure<D: Dimension>(
    particles: &mut Particles<D>,
    domain: &Domain<D>,
    settings: &VolumeConsistency,
    instructions: InstructionSet,
    workspace: &mut Workspace<D>,
) {
    let largest = particles.size.iter().fold(0.0_f64, |a, &b| a.max(b));
    if particles.is_empty() || largest == 0.0 {
        return;
    }
    let reach = KERNEL.support() * settings.width * largest;
    sum(particles, domain, (settings.width, reach), instructions, workspace);
    let (sums, place_of) = (&workspace.numbers[2], &workspace.records);
    let perfect = if D::COUNT == 2 { Lattice::Square } else { Lattice::Cubic };
    let lattice = lattice_volume_sum(perfect, settings.width, KERNEL);
    let from_start = settings.reference == PackingReference::Start;
    let normalization = KERNEL.normalization(D::COUNT);
    let columns = particles.packing_excess.par_iter_mut().zip(&mut particles.packing_reference);
    columns.zip(place_of).zip(&particles.size).with_min_len(TILE).for_each(
        |(((excess, reference), &place), size)| {
            let total = sums[place as usize];
            let near_imposed = total.is_sign_negative();
            let sum = normalization / (settings.width * size).powi(D::COUNT as i32) * total;
            if from_start && !near_imposed && *reference == 0.0 {
                *reference = sum;
            }
            let held_against = if from_start { *reference } else { lattice };
            *excess = if near_imposed { 0.0 } else { sum - held_against };
        },
    );
}

/// Fills a column of the sorted points with Σ V_j w(r/h) without normalization, with a minus sign where an imposed particle
/// is within the support, and tells the place of every particle among these points.
fn sum<D: Dimension>(
    particles: &Particles<D>,
    domain: &Domain<D>,
    (width, reach): (f64, f64),
    instructions: InstructionSet,
    workspace: &mut Workspace<D>,
) {
    // Particles may have left the box since their lists were built.
    let inside = |a: usize| particles.position[a].par_iter().map(|&x| domain.wrap(a, x)).collect();
    let own: D::AxisColumns = Components::from_fn(inside);
    let halo = Halo::<D>::build(&own, domain, reach);
    let Workspace { points, numbers: [volume, smoothing, sums], records: place_of } = workspace;
    points.sort(&own, &halo, 0.5 * reach, place_of);
    let n = particles.len();
    let owner = |i: u32| if (i as usize) < n { i as usize } else { halo.owner[i as usize - n] as usize };
    points.column(|i| particles.mass[owner(i)] / particles.density[owner(i)], 0.0, volume);
    points.column(|i| width * particles.size[owner(i)], 1.0, smoothing);
    let mut imposed = Vec::new();
    points.column(|i| particles.constraint[owner(i)] != Constraint::Free, false, &mut imposed);
    resize_scratch(place_of, n, 0);
    for (p, &i) in points.index().iter().enumerate().filter(|(_, i)| (**i as usize) < n) {
        place_of[i as usize] = p as u32;
    }
    resize_scratch(sums, points.index().len(), 0.0);
    let sum = &VolumeSum { points: &*points, n_particles: n, volume, imposed: &imposed, smoothing };
    sums.par_chunks_mut(PART).enumerate().for_each_init(Vicinity::default, |vicinity, (part, sums)| {
        dispatch_with(instructions, VolumeSumPart { sum, first: part * PART, sums, vicinity });
    });
}

/// Sorted points that one thread sums over in one go.
const PART: usize = 1024;
/// Points that sums are taken of together, at most.
const GROUP: usize = 8;

struct VolumeSum<'a, D: Dimension> {
    points: &'a CellSortedPoints<D>,
    n_particles: usize,
    /// Columns of the sorted points.
    volume: &'a [f64],
    imposed: &'a [bool],
    smoothing: &'a [f64],
}

struct VolumeSumPart<'a, D: Dimension> {
    sum: &'a VolumeSum<'a, D>,
    /// The first of the points, and the sums of all of them.
    first: usize,
    sums: &'a mut [f64],
    vicinity: &'a mut Vicinity,
}

impl<D: Dimension> LaneKernel for VolumeSumPart<'_, D> {
    /// Points that see the same candidates follow each other: those are fetched once for all of them.
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { sum, first: start, sums, vicinity } = self;
        let (mut first, end_of_part) = (start, start + sums.len());
        while first < end_of_part {
            if sum.is_copy(first) {
                first += 1;
                continue;
            }
            sum.points.look_around(sum.point(first), sum.reach(first), vicinity);
            let mut end = first + 1;
            while end < end_of_part.min(first + GROUP)
                && !sum.is_copy(end)
                && sum.points.is_known(sum.point(end), sum.reach(end), vicinity)
            {
                end += 1;
            }
            sum.group::<L>(first..end, vicinity, &mut sums[first - start..end - start]);
            first = end;
        }
    }
}

impl<D: Dimension> VolumeSum<'_, D> {
    #[inline(always)]
    fn point(&self, p: usize) -> D::Vector {
        D::vector(|a| self.points.position[a][p])
    }

    #[inline(always)]
    fn reach(&self, p: usize) -> f64 {
        KERNEL.support() * self.smoothing[p]
    }

    #[inline(always)]
    fn is_copy(&self, p: usize) -> bool {
        self.points.index()[p] as usize >= self.n_particles
    }

    /// The sums of some points that see the same candidates.
    #[inline(always)]
    fn group<L: Lanes>(&self, group: Range<usize>, vicinity: &Vicinity, sums: &mut [f64]) {
        let lane = L::load(&std::array::from_fn(|l| l as f64));
        let (mut totals, mut near_imposed) = ([L::zero(); GROUP], [false; GROUP]);
        let mut inverse = [0.0; GROUP];
        group.clone().zip(&mut inverse).for_each(|(p, inverse)| *inverse = 1.0 / self.smoothing[p]);
        let mut reach2 = [0.0; GROUP];
        group.clone().zip(&mut reach2).for_each(|(p, r)| *r = self.reach(p) * self.reach(p) * (1.0 + 1e-12));
        for &(first, count) in &vicinity.eights {
            let eight = first as usize..first as usize + LANES;
            let load = |column: &[f64]| {
                L::load(column[eight.clone()].try_into().expect("columns are filled up to whole lanes"))
            };
            let volume = lane.select_less(L::splat(count as f64), load(self.volume), L::zero());
            let at: D::Axes<L> = Components::from_fn(|a| load(&self.points.position[a]));
            let imposed = self.imposed[eight.start..].first_chunk() != Some(&[false; LANES]);
            for (k, p) in group.clone().enumerate() {
                let mut r2 = L::zero();
                for a in 0..D::COUNT {
                    let d = at[a] - L::splat(self.points.position[a][p]);
                    r2 = d.mul_add(d, r2);
                }
                if r2.less_mask(L::splat(reach2[k])) == 0 {
                    continue;
                }
                let q = r2.sqrt() * L::splat(inverse[k]);
                totals[k] = volume.mul_add(KERNEL.value(q), totals[k]);
                if imposed {
                    near_imposed[k] |= self.sees_imposed(q, eight.start);
                }
            }
        }
        for (k, sum) in sums.iter_mut().enumerate() {
            let total: f64 = totals[k].to_array().iter().sum();
            *sum = if near_imposed[k] { -total } else { total };
        }
    }

    /// Whether an imposed one is among eight points at distances `q` (in smoothing lengths) and within the support.
    #[inline(always)]
    fn sees_imposed<L: Lanes>(&self, q: L, first: usize) -> bool {
        let within = q.less_mask(L::splat(KERNEL.support()));
        (0..LANES).any(|l| within >> l & 1 == 1 && self.imposed[first + l])
    }
}
