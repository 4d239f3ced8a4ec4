//! Volume consistency: shut pores must fill space.
//!
//! The density of the continuity equation drifts from the particles' packing where plastic strain is large. At each rebuild of
//! the lists, and whenever particles have moved by a further fifteenth of D against each other, the volume sum with a wide
//! kernel is held against that of a perfect lattice,
//!
//! ```text
//! S_i  = V_i W(0; h_S) + Σ_j V_j W(r_ij; h_S),  h_S = width × D,   ΔS_i = S_i - S_lattice
//! ```
//!
//! with the kernel of [`sph_core::kernel::packing`] and S_lattice of the square lattice in the plane and of the cubic one in
//! space (on every lattice here, and on a square one pressed to 0.7 D along one axis at the same density, S is within 3.2e-4
//! of one). On a disordered packing the sums scatter by more than the tolerance; each particle may then be held against its
//! own first sum in place of S_lattice ([`PackingReference::Start`]). Until the next sum the density relaxes, besides the
//! flow's own rate, with
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
use sph_core::geometry::Lattice;
use sph_core::kernel::packing;
use sph_core::lanes::{InstructionSet, LANES, LaneKernel, Lanes, Line, dispatch_with};
use sph_core::memory::resize_scratch;
use sph_core::neighbors::cell_grid::{CellSortedPoints, Vicinity, Workspace};
use sph_core::neighbors::{Halo, TILE};
use sph_core::particles::{Constraint, Particles};

use crate::pass::Sizes;
use crate::scheme::{PackingReference, VolumeConsistency};

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
    let factor = packing::SUPPORT * settings.width;
    sum(particles, domain, (factor, largest), instructions, workspace);
    let (sums, place_of) = (&workspace.numbers[2], &workspace.records);
    let normalization = packing::normalization(D::COUNT) / settings.width.powi(D::COUNT as i32);
    let perfect = if D::COUNT == 2 { Lattice::Square } else { Lattice::Cubic };
    let lattice = normalization * perfect.sum(factor, |r2| packing::value(r2 / (factor * factor)));
    let from_start = settings.reference == PackingReference::Start;
    let columns = particles.packing_excess.par_iter_mut().zip(&mut particles.packing_reference);
    columns.zip(place_of).zip(&particles.size).with_min_len(TILE).for_each(
        |(((excess, reference), &place), size)| {
            let total = sums[place as usize];
            let near_imposed = total.is_sign_negative();
            let sum = normalization / size.powi(D::COUNT as i32) * total;
            if from_start && !near_imposed && *reference == 0.0 {
                *reference = sum;
            }
            let held_against = if from_start { *reference } else { lattice };
            *excess = if near_imposed { 0.0 } else { sum - held_against };
        },
    );
}

/// Fills a column of the sorted points with Σ V_j w(r) without normalization, with a minus sign where an imposed particle
/// is within the support, and tells the place of every particle among these points. The support is `factor` D.
fn sum<D: Dimension>(
    particles: &Particles<D>,
    domain: &Domain<D>,
    (factor, largest): (f64, f64),
    instructions: InstructionSet,
    workspace: &mut Workspace<D>,
) {
    // Particles may have left the box since their lists were built.
    let inside = |a: usize| particles.position[a].par_iter().map(|&x| domain.wrap(a, x)).collect();
    let own: D::AxisColumns = Components::from_fn(inside);
    let farthest = factor * largest;
    let halo = Halo::<D>::build(&own, domain, farthest);
    let Workspace { points, numbers: [volume, size, sums], records: place_of } = workspace;
    points.sort(&own, &halo, 0.5 * farthest, place_of);
    let n = particles.len();
    let owner = |i: u32| if (i as usize) < n { i as usize } else { halo.owner[i as usize - n] as usize };
    points.column(|i| particles.mass[owner(i)] / particles.density[owner(i)], 0.0, volume);
    let one_size = particles.size.par_iter().all(|size| *size == largest);
    if !one_size {
        points.column(|i| particles.size[owner(i)], largest, size);
    }
    let mut imposed = Vec::new();
    if particles.constraint.par_iter().any(|constraint| *constraint != Constraint::Free) {
        points.column(|i| particles.constraint[owner(i)] != Constraint::Free, false, &mut imposed);
    }
    resize_scratch(place_of, n, 0);
    for (p, &i) in points.index().iter().enumerate().filter(|(_, i)| (**i as usize) < n) {
        place_of[i as usize] = p as u32;
    }
    resize_scratch(sums, points.index().len(), 0.0);
    let sizes = if one_size { Sizes::Uniform(largest) } else { Sizes::Each(size) };
    let points = &*points;
    let sum = &VolumeSum { points, n_particles: n, volume, imposed: &imposed, sizes, factor, farthest };
    sums.par_chunks_mut(PART).enumerate().for_each_init(Candidates::default, |candidates, (part, sums)| {
        dispatch_with(instructions, VolumeSumPart { sum, first: part * PART, sums, candidates });
    });
}

/// Sorted points that one thread sums over in one go.
const PART: usize = 1024;

struct VolumeSum<'a, D: Dimension> {
    points: &'a CellSortedPoints<D>,
    n_particles: usize,
    /// Column of the sorted points.
    volume: &'a [f64],
    /// Column of the sorted points, empty where none is imposed.
    imposed: &'a [bool],
    /// Sizes of the sorted points.
    sizes: Sizes<'a>,
    /// Support over size [-].
    factor: f64,
    /// The longest support [m].
    farthest: f64,
}

/// What the points of one cell see: fetched once for all of them.
#[derive(Default)]
struct Candidates {
    vicinity: Vicinity,
    /// Eight by eight: coordinates along each axis, then volumes, zero behind the end of a run.
    eights: Vec<Line>,
    /// Which of each eight are imposed; empty where none is.
    imposed: Vec<u8>,
}

struct VolumeSumPart<'a, D: Dimension> {
    sum: &'a VolumeSum<'a, D>,
    /// The first of the points, and the sums of all of them.
    first: usize,
    sums: &'a mut [f64],
    candidates: &'a mut Candidates,
}

impl<D: Dimension> LaneKernel for VolumeSumPart<'_, D> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { sum, first, sums, candidates } = self;
        sum.points.cells_of(first..first + sums.len(), |cell, members| {
            if members.clone().all(|p| sum.is_copy(p)) {
                return;
            }
            sum.points.look_around_cell(cell, sum.farthest, &mut candidates.vicinity);
            sum.fetch::<L>(candidates);
            for p in members.filter(|p| !sum.is_copy(*p)) {
                let here: D::Axes<L> = Components::from_fn(|a| L::splat(sum.points.position[a][p]));
                sums[p - first] = sum.of_point::<L>(&here, sum.factor * sum.sizes.of(p), candidates);
            }
        });
    }
}

impl<D: Dimension> VolumeSum<'_, D> {
    #[inline(always)]
    fn is_copy(&self, p: usize) -> bool {
        self.points.index()[p] as usize >= self.n_particles
    }

    /// Brings what the vicinity names side by side.
    #[inline(always)]
    fn fetch<L: Lanes>(&self, candidates: &mut Candidates) {
        let Candidates { vicinity, eights, imposed } = candidates;
        let lane = L::load(&std::array::from_fn(|l| l as f64));
        eights.resize(vicinity.eights.len() * (D::COUNT + 1), Line::default());
        imposed.clear();
        for (lines, &(first, count)) in eights.chunks_exact_mut(D::COUNT + 1).zip(&vicinity.eights) {
            let first = first as usize;
            let load = |column: &[f64]| {
                L::load(
                    column[first..first + LANES].try_into().expect("columns are filled up to whole lanes"),
                )
            };
            for a in 0..D::COUNT {
                load(&self.points.position[a]).store(&mut lines[a].0);
            }
            let volume = lane.select_less(L::splat(count as f64), load(self.volume), L::zero());
            volume.store(&mut lines[D::COUNT].0);
            if !self.imposed.is_empty() {
                let of_lane = |l: usize| u8::from((l as u32) < count && self.imposed[first + l]) << l;
                imposed.push((0..LANES).map(of_lane).sum());
            }
        }
    }

    /// The sum of a point over what it sees.
    #[inline(always)]
    fn of_point<L: Lanes>(&self, here: &D::Axes<L>, reach: f64, candidates: &Candidates) -> f64 {
        let inverse = L::splat(1.0 / (reach * reach));
        let (mut total, mut sees_imposed) = (L::zero(), false);
        let eights = candidates.eights.chunks_exact(D::COUNT + 1);
        for (k, lines) in eights.enumerate() {
            let mut r2 = L::zero();
            for a in 0..D::COUNT {
                let d = L::load(&lines[a].0) - here[a];
                r2 = d.mul_add(d, r2);
            }
            let share = r2 * inverse;
            total = L::load(&lines[D::COUNT].0).mul_add(packing::value(share), total);
            if let Some(imposed) = candidates.imposed.get(k) {
                sees_imposed |= share.less_mask(L::one()) & imposed != 0;
            }
        }
        let t = total.to_array();
        let total = ((t[0] + t[4]) + (t[2] + t[6])) + ((t[1] + t[5]) + (t[3] + t[7]));
        if sees_imposed { -total } else { total }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sph_core::particles::Particle;
    use sph_core::{Dim2, Dim3};

    /// A jittered lattice with particles of sizes D and `size` D, one of them imposed if asked for; periodic along x.
    fn cloud<D: Dimension>(count: usize, size: f64, imposed: bool) -> (Particles<D>, Domain<D>) {
        let mut particles = Particles::<D>::default();
        for cell in 0..count.pow(D::COUNT as u32) {
            let jitter = |a: usize| ((cell * 7919 + a * 104_729) % 1009) as f64 / 1009.0 - 0.5;
            let position = D::vector(|a| (cell / count.pow(a as u32) % count) as f64 + 0.5 + 0.3 * jitter(a));
            let size = if cell % 3 == 0 { size } else { 1.0 };
            let mut particle = Particle::at_rest(cell as u64, position, 1.0 + 0.1 * jitter(5), size, 1.1);
            particle.constraint =
                if imposed && cell == 3 { Constraint::ImposedVelocity } else { Constraint::Free };
            particles.push(particle);
        }
        let domain =
            Domain::new(D::vector(|_| 0.0), D::vector(|_| count as f64), Components::from_fn(|a| a == 0));
        (particles, domain)
    }

    /// ΔS of particle `i`, pair by pair over all images along x.
    fn excess<D: Dimension>(particles: &Particles<D>, domain: &Domain<D>, width: f64, i: usize) -> f64 {
        let h = width * particles.size[i];
        let sum_of = |scale: f64, terms: &mut dyn Iterator<Item = (f64, f64)>| {
            let terms = terms.map(|(volume, r2)| volume * packing::value(r2 / (2.0 * scale).powi(2)));
            packing::normalization(D::COUNT) / scale.powi(D::COUNT as i32) * terms.sum::<f64>()
        };
        let (mut terms, mut near_imposed) = (Vec::new(), false);
        for j in 0..particles.len() {
            for turn in [-1.0, 0.0, 1.0] {
                let along = |a: usize| {
                    let image = if a == 0 { turn * domain.period(0) } else { 0.0 };
                    particles.position[a][j] + image - particles.position[a][i]
                };
                let r2 = (0..D::COUNT).map(|a| along(a) * along(a)).sum::<f64>();
                near_imposed |= r2 < 4.0 * h * h && particles.constraint[j] != Constraint::Free;
                terms.push((particles.mass[j] / particles.density[j], r2));
            }
        }
        let perfect = if D::COUNT == 2 { Lattice::Square } else { Lattice::Cubic };
        let offsets = perfect.offsets_within(2.0 * width);
        let mut lattice = offsets.iter().map(|o| (1.0, o.iter().map(|x| x * x).sum()));
        let difference = sum_of(h, &mut terms.into_iter()) - sum_of(width, &mut lattice);
        if near_imposed { 0.0 } else { difference }
    }

    fn sums_are_those_of_all_pairs<D: Dimension>(count: usize, size: f64, imposed: bool) {
        let settings = VolumeConsistency::default();
        let mut first: Option<Vec<f64>> = None;
        for set in InstructionSet::available() {
            let (mut particles, domain) = cloud::<D>(count, size, imposed);
            measure(&mut particles, &domain, &settings, set, &mut Workspace::default());
            for i in 0..particles.len() {
                let expected = excess(&particles, &domain, settings.width, i);
                let found = particles.packing_excess[i];
                assert!((found - expected).abs() < 1e-13, "{set:?}, particle {i}: {found}, {expected}");
            }
            assert_eq!(particles.packing_excess.contains(&0.0), imposed);
            let first = first.get_or_insert_with(|| particles.packing_excess.clone());
            assert_eq!(&particles.packing_excess, first, "{set:?}");
        }
    }

    #[test]
    fn sums_of_one_size_are_those_of_all_pairs() {
        sums_are_those_of_all_pairs::<Dim2>(17, 1.0, false);
        sums_are_those_of_all_pairs::<Dim3>(9, 1.0, false);
    }

    #[test]
    fn sums_of_two_sizes_and_beside_an_imposed_particle_are_those_of_all_pairs() {
        sums_are_those_of_all_pairs::<Dim2>(17, 0.7, true);
        sums_are_those_of_all_pairs::<Dim3>(10, 0.8, true);
    }
}
