//! Closed faces: the area vectors of the pairs of a particle sum up to zero.
//!
//! The force between two particles is that of their contact's stress on a face of area vector
//! `A_ij = V_i w_ij ½(K_i + K_j) e_ij`, antisymmetric in i and j. On a lattice the faces of a particle close,
//! `Σ_j A_ij = 0`; on a disordered cloud they leave a gap, and a uniform stress accelerates the particle by stress times
//! gap: an error that does not fall with the resolution. The faces are closed by the least change that is antisymmetric,
//!
//! ```text
//! A'_ij = A_ij + V_i w_ij (λ_i - λ_j)            w_ij = 2 V_j |W'_ij| / h_ij
//! Σ_j w_ij (λ_i - λ_j) = -g_i                    g_i = Σ_j w_ij ½(K_i + K_j) e_ij: a Laplacian on the pairs
//! ```
//!
//! least in `Σ |A' - A|² / (V_i w_ij)`. At free surfaces the faces do not close, nor should they: λ = 0 where
//! λ_min(L) < 0.6, and within the support of such particles. The system is solved by a fixed number of Jacobi sweeps from
//! zero, so nothing is remembered and the bits are the same for any number of threads. The change of the faces then carries the mean stress and works with the mean velocity
//! of both sides,
//!
//! ```text
//! F_i += V_i Σ_j w_ij ½(σ_i + σ_j)·(λ_i - λ_j)   P_i += V_i Σ_j w_ij (½(σ_i + σ_j)·(λ_i - λ_j))·½(U_i + U_j)
//! ```
//!
//! antisymmetric again: momentum and total energy stay exact. On a lattice λ is zero up to rounding.
//!
//! A face record: position, volume, λ, 1/Σ_j w_ij and g; in place of the inverse sum -1 at a surface, and 0 near one.
//!
//! Source: this project. The exact closure of face areas is what finite-volume particle methods are built on: D. Hietel,
//! K. Steiner & J. Struckmeier, Math. Models Methods Appl. Sci. 10 (2000) 1363.

use rayon::prelude::*;
use sph_core::dimension::Components;
use sph_core::lanes::{LANES, LaneKernel, Lanes, Line};
use sph_core::neighbors::{TILE, TILE_BLOCKS};

use super::sums::add_to_buffer;
use super::{Pass, Tile, Work, load_line, own_indices, store_records};
use crate::dimension::{SolidDimension, dot, times};
use crate::record::{Row, Sides, Sums};

/// Below this eigenvalue of L a particle is at a free surface: 0.48-0.50 at a flat one; a lattice jittered by 0.2 D stays
/// above.
const SURFACE_EIGENVALUE: f64 = 0.6;
/// Share of the Jacobi correction that a sweep takes: damps the modes that would change sign.
const RELAXATION: f64 = 0.9;

/// Offsets in a face record.
pub(crate) struct Face;

impl Face {
    const fn volume<D: SolidDimension>() -> usize {
        D::COUNT
    }
    const fn shift<D: SolidDimension>() -> usize {
        D::COUNT + 1
    }
    const fn inverse_weight<D: SolidDimension>() -> usize {
        2 * D::COUNT + 1
    }
    const fn gap<D: SolidDimension>() -> usize {
        2 * D::COUNT + 2
    }
}

/// Which part of the closure a pass does.
#[derive(Clone, Copy)]
pub(super) enum Stage<'a> {
    /// Gaps from the records of the second pass; the first sweep with them. Writes face records.
    Gaps,
    /// One more sweep, from face records. Writes face records.
    Sweep,
    /// Forces and power, from the records of the second pass and these face records. Adds to sums.
    Forces(&'a [Line]),
}

impl<D: SolidDimension> Pass<'_, D> {
    /// Closes the faces with `sweeps` Jacobi sweeps and adds force and power to the sums. `faces` is scratch for two face
    /// records a particle and copy; `self` is the contact pass, `rows` those of the first pass.
    ///
    /// # Panics
    /// As [`Pass::gradients`].
    pub fn close_faces(&self, sweeps: u32, faces: &mut [Vec<Line>; 2], rows: &[Line], sums: &mut [Line]) {
        let (stride, padded) = (D::FACE_LINES, self.lists.n_padded());
        faces.iter_mut().for_each(|f| f.resize(self.lists.n_records() * stride, Line::default()));
        let [mut new, mut old] = faces.each_mut().map(Vec::as_mut_slice);
        self.run_closure(Stage::Gaps, rows, &mut new[..padded * stride]);
        self.lists.halo().refresh(new, stride, padded);
        for _ in 1..sweeps {
            std::mem::swap(&mut new, &mut old);
            Pass { records: old, ..*self }.run_closure(Stage::Sweep, rows, &mut new[..padded * stride]);
            self.lists.halo().refresh(new, stride, padded);
        }
        self.run_closure(Stage::Forces(new), rows, &mut sums[..padded * D::SUM_LINES]);
    }

    /// Runs a stage on each tile with its part of the output: face records, or sums.
    fn run_closure(&self, stage: Stage<'_>, rows: &[Line], output: &mut [Line]) {
        let (read, written) = match stage {
            Stage::Gaps => (D::SIDES_LINES, D::FACE_LINES),
            Stage::Sweep => (D::FACE_LINES, D::FACE_LINES),
            Stage::Forces(_) => (D::SIDES_LINES, D::SUM_LINES),
        };
        self.check_records(read);
        rows.par_chunks(TILE_BLOCKS * Row::count::<D>())
            .zip(output.par_chunks_mut(TILE * written))
            .enumerate()
            .for_each(|(index, (rows, output))| {
                D::run(self, Tile { index, work: Work::Closure { stage, rows, output } });
            });
    }
}

/// The pass over one tile.
pub(super) struct ClosureTile<'a, 'b, D: SolidDimension> {
    pub pass: &'a Pass<'b, D>,
    pub index: usize,
    pub stage: Stage<'a>,
    pub rows: &'a [Line],
    pub output: &'a mut [Line],
}

impl<D: SolidDimension> LaneKernel for ClosureTile<'_, '_, D> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { pass, index, stage, rows, output } = self;
        let lists = &pass.lists.tiles()[index];
        let stride = LANES * if matches!(stage, Stage::Forces(_)) { D::SUM_LINES } else { D::FACE_LINES };
        let blocks = rows.chunks_exact(Row::count::<D>()).zip(output.chunks_exact_mut(stride));
        for (b, (rows, output)) in blocks.enumerate() {
            let own = own_indices(index * TILE_BLOCKS + b);
            let block = Block { pass, own: &own, slots: lists.block(b) };
            match stage {
                Stage::Gaps => block.gaps::<L>(rows, output),
                Stage::Sweep => block.sweep::<L>(output),
                Stage::Forces(of) => block.forces::<L>(of, output),
            }
        }
    }
}

/// Eight particles and their neighbors.
struct Block<'a, 'b, D: SolidDimension> {
    pass: &'a Pass<'b, D>,
    own: &'a [u32; LANES],
    slots: &'a [[u32; LANES]],
}

impl<D: SolidDimension> Block<'_, '_, D> {
    /// w, and the vector to the neighbor, of eight pairs.
    #[inline(always)]
    fn weight<L: Lanes>(
        &self,
        own: &impl Components<L>,
        other: &impl Components<L>,
        slot: &[u32; LANES],
    ) -> (L, D::Axes<L>) {
        let mut dx = D::Axes::<L>::splat(L::zero());
        for a in 0..D::COUNT {
            dx[a] = other[a] - own[a];
        }
        let smoothing = self.pass.smoothing;
        let scales = smoothing.scales(smoothing.own::<L>(self.own), slot);
        let r = dot::<D, L>(&dx, &dx).sqrt();
        // Marked records have a minus sign.
        let volume = other[Face::volume::<D>()].abs();
        let q = r * scales.inverse_h;
        ((volume + volume) * scales.slope * smoothing.minus_slope_over_q(q) * r, dx)
    }

    #[inline(always)]
    fn load_sides<L: Lanes>(&self, slot: &[u32; LANES]) -> D::SidesRecord<L> {
        let mut record = D::SidesRecord::<L>::splat(L::zero());
        // The correction is the last that is read.
        for line in 0..(Sides::slopes::<D>() - 1) / LANES + 1 {
            // SAFETY: entries of a list are below `n_records`, and the caller has checked the records.
            unsafe { load_line(&mut record, self.pass.records, D::SIDES_LINES, line, slot) };
        }
        record
    }

    /// K e for eight records.
    #[inline(always)]
    fn corrected<L: Lanes>(record: &D::SidesRecord<L>, e: &D::Axes<L>) -> D::Axes<L> {
        let mut k = D::Symmetric::<L>::splat(L::zero());
        for c in 0..D::STRESS_COUNT {
            k[c] = record[Sides::correction::<D>() + c];
        }
        times::<D, L>(&k, e)
    }

    #[inline(always)]
    fn gaps<L: Lanes>(&self, rows: &[Line], faces: &mut [Line]) {
        let own = self.load_sides::<L>(self.own);
        let mut gap = D::Axes::<L>::splat(L::zero());
        let mut sum = L::zero();
        for slot in self.slots {
            let other = self.load_sides::<L>(slot);
            let (w, dx) = self.weight::<L>(&own, &other, slot);
            // Twice w over r: e is not needed by itself.
            let (left, right) = (Self::corrected(&own, &dx), Self::corrected(&other, &dx));
            let r = dot::<D, L>(&dx, &dx).sqrt().max(L::splat(f64::MIN_POSITIVE));
            let half = L::splat(0.5) * w / r;
            for a in 0..D::COUNT {
                gap[a] = half.mul_add(left[a] + right[a], gap[a]);
            }
            sum += w;
        }
        let inverse = L::one() / sum.max(L::splat(f64::MIN_POSITIVE));
        let least = L::load(&rows[Row::LEAST_EIGENVALUE].0);
        let at_surface = L::splat(SURFACE_EIGENVALUE);
        let share = least.select_less(at_surface, L::zero(), L::splat(RELAXATION) * inverse);
        let mut face = D::FaceRecord::<L>::splat(L::zero());
        for k in 0..=Face::volume::<D>() {
            face[k] = own[k];
        }
        face[Face::volume::<D>()] = own[Sides::volume::<D>()].abs();
        for a in 0..D::COUNT {
            face[Face::gap::<D>() + a] = gap[a];
            face[Face::shift::<D>() + a] = -(share * gap[a]);
        }
        face[Face::inverse_weight::<D>()] = least.select_less(at_surface, -L::one(), inverse);
        store_records(&face, faces, D::FACE_LINES);
    }

    /// λ ← λ + ω (Σ w (λ_j - λ_i) - g)/Σ w.
    #[inline(always)]
    fn sweep<L: Lanes>(&self, faces: &mut [Line]) {
        let mut own = D::FaceRecord::<L>::splat(L::zero());
        for line in 0..D::FACE_LINES {
            // SAFETY: particles have records.
            unsafe { load_line(&mut own, self.pass.records, D::FACE_LINES, line, self.own) };
        }
        let mut sum = D::Axes::<L>::splat(L::zero());
        let state = Face::inverse_weight::<D>();
        let mut nearest = L::zero();
        for slot in self.slots {
            let mut other = D::FaceRecord::<L>::splat(L::zero());
            // SAFETY: entries of a list are below `n_records`, and the caller has checked the records.
            unsafe { load_line(&mut other, self.pass.records, D::FACE_LINES, 0, slot) };
            let (w, _) = self.weight::<L>(&own, &other, slot);
            for a in 0..D::COUNT {
                let k = Face::shift::<D>() + a;
                sum[a] = w.mul_add(other[k] - own[k], sum[a]);
            }
            // Pairs of the skin have no weight and tell nothing.
            nearest = L::zero().select_less(w, nearest.min(other[state]), nearest);
        }
        // A surface in reach: λ = 0 from now on; at the surface itself it has been so.
        own[state] = nearest.select_less(L::zero(), own[state].min(L::zero()), own[state]);
        let share = L::splat(RELAXATION) * own[state];
        for a in 0..D::COUNT {
            let k = Face::shift::<D>() + a;
            let next = share.mul_add(sum[a] - own[Face::gap::<D>() + a], own[k]);
            own[k] = L::zero().select_less(own[state], next, L::zero());
        }
        store_records(&own, faces, D::FACE_LINES);
    }

    #[inline(always)]
    fn forces<L: Lanes>(&self, faces: &[Line], sums: &mut [Line]) {
        let own = self.load_sides::<L>(self.own);
        let shift = self.load_shift::<L>(faces, self.own);
        let mut force = D::Axes::<L>::splat(L::zero());
        let mut power = L::zero();
        let (half, first) = (L::splat(0.5), Sides::fields::<D>());
        for slot in self.slots {
            let other = self.load_sides::<L>(slot);
            let other_shift = self.load_shift::<L>(faces, slot);
            let (w, _) = self.weight::<L>(&own, &other, slot);
            let mut stress = D::Symmetric::<L>::splat(L::zero());
            for k in 0..D::STRESS_COUNT {
                stress[k] = half * (own[first + D::COUNT + k] + other[first + D::COUNT + k]);
            }
            let (mut area, mut velocity) = (shift, shift);
            for a in 0..D::COUNT {
                area[a] = w * (shift[a] - other_shift[a]);
                velocity[a] = half * (own[first + a] + other[first + a]);
            }
            let of_pair = times::<D, L>(&stress, &area);
            power += dot::<D, L>(&of_pair, &velocity);
            for a in 0..D::COUNT {
                force[a] += of_pair[a];
            }
        }
        let volume = own[Sides::volume::<D>()].abs();
        let mut record = D::SumsRecord::<L>::splat(L::zero());
        record[Sums::power::<D>()] = volume * power;
        for a in 0..D::COUNT {
            record[Sums::FORCE + a] = volume * force[a];
        }
        // SAFETY: `sums` are those of the block.
        unsafe { add_to_buffer::<D, L>(&record, sums, &own_indices(0)) };
    }

    #[inline(always)]
    fn load_shift<L: Lanes>(&self, faces: &[Line], slot: &[u32; LANES]) -> D::Axes<L> {
        let mut face = D::FaceRecord::<L>::splat(L::zero());
        // SAFETY: entries of a list are below `n_records`, and `close_faces` made a face record for each.
        unsafe { load_line(&mut face, faces, D::FACE_LINES, 0, slot) };
        let mut shift = D::Axes::<L>::splat(L::zero());
        for a in 0..D::COUNT {
            shift[a] = face[Face::shift::<D>() + a];
        }
        shift
    }
}
