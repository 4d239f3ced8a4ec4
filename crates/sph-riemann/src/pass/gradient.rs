//! First pass: L, corrected gradients and the half step.
//!
//! ```text
//! L_i       = Σ V_j ∇_iW_ij ⊗ (r_j - r_i)                                            (paper eq. (12))
//! ∇Φ_i      = K_i Σ V_j ∇_iW_ij (Φ_j - Φ_i)                     K = L⁻¹, capped or by rule at surfaces
//! R_ab      = Σ V_j ∂_aW (U_b,j - U_b,i),  Ω = (tr L I - L)⁻¹ ε_eab R_ab,  W_ab = ε_bca Ω_c
//! ∇U_i      = W + K (R - L W)                                   with the spectral cap: exact in rotation
//! Φ_i^(1/2) = Φ_i + ½τ dΦ_i/dt                                  from these gradients, return mapping included
//! c_i       = (tr L I - L)⁻¹ ε_bcd (K L σ)_db                   torque of the capped part of the stress
//! ```
//!
//! Reads the records of the first pass, writes those of the second and the rows L and λ_min.

use sph_core::dimension::Components;
use sph_core::lanes::{LANES, LaneKernel, Lanes, Line, prefetch};

use super::ahead::Ahead;
use super::{Pass, load_line, own_indices, store_records};
use crate::dimension::{SolidDimension, dual, spin_matrix, symmetric, times};
use crate::record::{Row, Sides, State};
use crate::scheme::SurfaceTreatment;

/// The pass over one tile.
pub(super) struct GradientTile<'a, 'b, D: SolidDimension> {
    pub pass: &'a Pass<'b, D>,
    pub index: usize,
    pub flags: Option<&'a [f64]>,
    /// Records of the second pass of the tile's particles, to be written.
    pub sides: &'a mut [Line],
    /// Rows of the tile's blocks.
    pub rows: &'a mut [Line],
}

/// Below this eigenvalue of L the half step is centered on the true acceleration.
pub(super) const CENTERING_EIGENVALUE: f64 = 0.75;

/// Blocks by which records are asked for before they are written.
const AHEAD: usize = 8;

/// Sums over the neighbors of eight particles.
struct Sums<D: SolidDimension, L: Lanes> {
    /// L.
    matrix: D::Symmetric<L>,
    /// Raw gradients of the fields.
    raw: D::Fields<D::Axes<L>>,
}

impl<D: SolidDimension> LaneKernel for GradientTile<'_, '_, D> {
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { pass, index, flags, sides, rows } = self;
        let lists = &pass.lists.tiles()[index];
        let first_block = index * sph_core::neighbors::TILE_BLOCKS;
        let ahead = Ahead::of(pass.lists, index);
        let rows_of = rows.chunks_exact_mut(Row::count::<D>());
        let sides_of = sides.chunks_exact_mut(LANES * D::SIDES_LINES);
        for (b, (rows, sides)) in rows_of.zip(sides_of).enumerate() {
            prefetch(rows, AHEAD * Row::count::<D>(), Row::count::<D>());
            prefetch(sides, AHEAD * LANES * D::SIDES_LINES, LANES * D::SIDES_LINES);
            ahead.records(b, pass.records, D::STATE_LINES, D::STATE_LINES);
            let indices = own_indices(first_block + b);
            let slots = lists.block(b);
            let own = load_state::<D, L>(pass, &indices);
            let sums = sum_over_neighbors::<D, L>(pass, &indices, &own, slots);
            let rule = flags.map(|flags| L::gather(flags, &indices));
            let record = finish::<D, L>(pass, &own, sums, rule, rows);
            store_records(&record, sides, D::SIDES_LINES);
        }
    }
}

#[inline(always)]
fn load_state<D: SolidDimension, L: Lanes>(pass: &Pass<'_, D>, indices: &[u32; LANES]) -> D::StateRecord<L> {
    let mut record = D::StateRecord::<L>::splat(L::zero());
    for line in 0..D::STATE_LINES {
        // SAFETY: the particles of a block and the entries of a list are below `n_records`, the length of the records.
        unsafe { load_line(&mut record, pass.records, D::STATE_LINES, line, indices) };
    }
    record
}

#[inline(always)]
fn sum_over_neighbors<D: SolidDimension, L: Lanes>(
    pass: &Pass<'_, D>,
    indices: &[u32; LANES],
    own: &D::StateRecord<L>,
    slots: &[[u32; LANES]],
) -> Sums<D, L> {
    let smoothing = pass.smoothing;
    let own_size = smoothing.own::<L>(indices);
    let mut matrix = D::Symmetric::<L>::splat(L::zero());
    let mut raw = D::Fields::<D::Axes<L>>::splat(D::Axes::<L>::splat(L::zero()));
    for slot in slots {
        let other = load_state::<D, L>(pass, slot);
        let mut dx = D::Axes::<L>::splat(L::zero());
        for a in 0..D::COUNT {
            dx[a] = other[a] - own[a];
        }
        let distance_squared = crate::dimension::dot::<D, L>(&dx, &dx);
        if !distance_squared.any_less(smoothing.reach_squared(own_size, slot)) {
            continue; // Pairs of the skin add exact zeros.
        }
        let scales = smoothing.scales(own_size, slot);
        let q = distance_squared.sqrt() * scales.inverse_h;
        let weight = other[State::volume::<D>()] * scales.slope * smoothing.minus_slope_over_q(q);
        let mut gradient = dx;
        for a in 0..D::COUNT {
            gradient[a] = weight * dx[a];
        }
        for a in 0..D::COUNT {
            for b in a..D::COUNT {
                let at = symmetric(D::COUNT, a, b);
                matrix[at] = gradient[a].mul_add(dx[b], matrix[at]);
            }
        }
        for f in 0..D::COUNT + D::STRESS_COUNT {
            let at = State::fields::<D>() + f;
            let difference = other[at] - own[at];
            for a in 0..D::COUNT {
                raw[f][a] = gradient[a].mul_add(difference, raw[f][a]);
            }
        }
    }
    Sums { matrix, raw }
}

/// Corrected gradients, half step, and what the second pass reads.
#[inline(always)]
fn finish<D: SolidDimension, L: Lanes>(
    pass: &Pass<'_, D>,
    own: &D::StateRecord<L>,
    sums: Sums<D, L>,
    rule: Option<L>,
    rows: &mut [Line],
) -> D::SidesRecord<L> {
    let cap = if let SurfaceTreatment::SpectralCap { cap } = pass.surface { cap } else { 1e9 };
    let (mut correction, least) = D::capped_inverse(sums.matrix, cap);
    if let Some(flag) = rule {
        for a in 0..D::COUNT {
            for b in a..D::COUNT {
                let at = symmetric(D::COUNT, a, b);
                let identity = L::splat(if a == b { 1.0 } else { 0.0 });
                correction[at] = flag.select_less(L::splat(0.5), correction[at], identity);
            }
        }
    }
    let capped = matches!(pass.surface, SurfaceTreatment::SpectralCap { .. });
    let mut slopes = sums.raw;
    for f in 0..D::COUNT + D::STRESS_COUNT {
        slopes[f] = times::<D, L>(&correction, &sums.raw[f]);
    }
    if capped {
        rotation_exact::<D, L>(&sums, &correction, &mut slopes);
    }
    let half = half_step::<D, L>(pass.half_step, own, &slopes, rows);
    let torque = if capped {
        torque::<D, L>(&sums.matrix, &correction, &half)
    } else {
        D::Spin::<L>::splat(L::zero())
    };
    let mut record = D::SidesRecord::<L>::splat(L::zero());
    // Position and volume half a step later: forces that do not see the turn of the pairs would spin a disc up.
    let step = L::splat(pass.half_step);
    let mut expansion = slopes[0][0];
    for a in 1..D::COUNT {
        expansion += slopes[a][a];
    }
    let growth = step.mul_add(expansion, L::one());
    for a in 0..D::COUNT {
        record[a] = step.mul_add(own[State::fields::<D>() + a], own[a]);
    }
    let volume = growth * own[State::volume::<D>()];
    record[Sides::volume::<D>()] = volume;
    if capped && pass.half_step != 0.0 {
        let marked = L::splat(0.5).select_less(L::load(&rows[Row::FREE].0), -volume, volume);
        record[Sides::volume::<D>()] = least.select_less(L::splat(CENTERING_EIGENVALUE), marked, volume);
    }
    (growth * L::load(&rows[Row::INVERSE_DENSITY].0)).store(&mut rows[Row::INVERSE_DENSITY].0);
    record[Sides::longitudinal::<D>()] = L::load(&rows[Row::LONGITUDINAL].0);
    record[Sides::transverse::<D>()] = L::load(&rows[Row::TRANSVERSE].0);
    // From here on these rows hold what the pass has found.
    least.store(&mut rows[Row::LEAST_EIGENVALUE].0);
    for k in 0..D::STRESS_COUNT {
        sums.matrix[k].store(&mut rows[Row::gradient_matrix::<D>() + k].0);
    }
    for c in 0..D::SPIN_COUNT {
        record[Sides::torque::<D>() + c] = torque[c];
    }
    for f in 0..D::COUNT + D::STRESS_COUNT {
        record[Sides::fields::<D>() + f] = half[f];
        for a in 0..D::COUNT {
            record[Sides::slopes::<D>() + f * D::COUNT + a] = slopes[f][a];
        }
    }
    for k in 0..D::STRESS_COUNT {
        record[Sides::correction::<D>() + k] = correction[k];
    }
    record
}

/// Replaces the gradients of the velocity by those that are exact in a rigid turn, whatever the cap cut off.
#[inline(always)]
fn rotation_exact<D: SolidDimension, L: Lanes>(
    sums: &Sums<D, L>,
    correction: &D::Symmetric<L>,
    slopes: &mut D::Fields<D::Axes<L>>,
) {
    let mut raw = D::Axes::<D::Axes<L>>::splat(D::Axes::<L>::splat(L::zero()));
    for a in 0..D::COUNT {
        for b in 0..D::COUNT {
            raw[a][b] = sums.raw[b][a];
        }
    }
    let spin = D::spin_solve(sums.matrix, dual::<D, L>(&raw));
    for b in 0..D::COUNT {
        let mut turn = D::Axes::<L>::splat(L::zero());
        for a in 0..D::COUNT {
            turn[a] = spin_matrix::<D, L>(&spin, a, b);
        }
        let mut rest = times::<D, L>(&sums.matrix, &turn);
        for a in 0..D::COUNT {
            rest[a] = sums.raw[b][a] - rest[a];
        }
        let corrected = times::<D, L>(correction, &rest);
        for a in 0..D::COUNT {
            slopes[b][a] = turn[a] + corrected[a];
        }
    }
}

/// Velocity and stress half a step later, from the particle's own gradients.
#[inline(always)]
fn half_step<D: SolidDimension, L: Lanes>(
    half_step: f64,
    own: &D::StateRecord<L>,
    slopes: &D::Fields<D::Axes<L>>,
    rows: &[Line],
) -> D::Fields<L> {
    let first = State::fields::<D>();
    let mut half = D::Fields::<L>::splat(L::zero());
    for f in 0..D::COUNT + D::STRESS_COUNT {
        half[f] = own[first + f];
    }
    if half_step == 0.0 {
        return half;
    }
    let step = L::splat(half_step);
    let push = L::load(&rows[Row::FREE].0) * L::load(&rows[Row::INVERSE_DENSITY].0) * step;
    for b in 0..D::COUNT {
        let mut divergence = slopes[D::COUNT + symmetric(D::COUNT, 0, b)][0];
        for a in 1..D::COUNT {
            divergence += slopes[D::COUNT + symmetric(D::COUNT, a, b)][a];
        }
        half[b] = push.mul_add(divergence, half[b]);
    }
    let shear = L::load(&rows[Row::SHEAR_MODULUS].0) * step;
    let pressure = L::load(&rows[Row::PRESSURE].0);
    let mut deviator = D::Symmetric::<L>::splat(L::zero());
    for k in 0..D::STRESS_COUNT {
        let stress = half[D::COUNT + k];
        deviator[k] = if k < D::COUNT { stress + pressure } else { stress };
    }
    let mut expansion = slopes[0][0];
    for a in 1..D::COUNT {
        expansion += slopes[a][a];
    }
    // Rotation acts where there is a deviator that evolves.
    let turning = L::zero().select_less(shear, step, L::zero());
    let trial = elastic_trial::<D, L>(&deviator, slopes, expansion, shear, turning);
    let factor = return_factor::<D, L>(&trial, L::load(&rows[Row::YIELD_STRENGTH].0));
    let advanced_pressure = pressure - L::load(&rows[Row::BULK_MODULUS].0) * step * expansion;
    for k in 0..D::STRESS_COUNT {
        let returned = trial[k] * factor;
        half[D::COUNT + k] = if k < D::COUNT { returned - advanced_pressure } else { returned };
    }
    half
}

/// S + 2 (G ½τ) (D - tr D I/3) + ½τ (W S - S W), with `shear` = G ½τ and `turning` = ½τ.
#[inline(always)]
fn elastic_trial<D: SolidDimension, L: Lanes>(
    deviator: &D::Symmetric<L>,
    slopes: &D::Fields<D::Axes<L>>,
    expansion: L,
    shear: L,
    turning: L,
) -> D::Symmetric<L> {
    let two_thirds = L::splat(2.0 / 3.0) * expansion;
    let half = L::splat(0.5);
    let mut trial = *deviator;
    for a in 0..D::COUNT {
        for b in a..D::COUNT {
            let rate = slopes[b][a] + slopes[a][b];
            let stretch = if a == b { rate - two_thirds } else { rate };
            // W_kl = ½(∂U_k/∂x_l - ∂U_l/∂x_k), and slopes[k][l] = ∂U_k/∂x_l.
            let mut turn = L::zero();
            for c in 0..D::COUNT {
                if c != a {
                    let w = half * (slopes[a][c] - slopes[c][a]);
                    turn = w.mul_add(deviator[symmetric(D::COUNT, c, b)], turn);
                }
                if c != b {
                    let w = half * (slopes[b][c] - slopes[c][b]);
                    turn = w.mul_add(deviator[symmetric(D::COUNT, a, c)], turn);
                }
            }
            let k = symmetric(D::COUNT, a, b);
            trial[k] = shear.mul_add(stretch, turning.mul_add(turn, deviator[k]));
        }
    }
    trial
}

/// min(1, Y/σ_vM), σ_vM = sqrt(3/2 S:S), the out-of-plane component from the trace.
#[inline(always)]
fn return_factor<D: SolidDimension, L: Lanes>(deviator: &D::Symmetric<L>, yield_strength: L) -> L {
    let mut trace = L::zero();
    let mut squares = L::zero();
    for a in 0..D::COUNT {
        trace += deviator[a];
        squares = deviator[a].mul_add(deviator[a], squares);
    }
    if D::COUNT == 2 {
        squares = trace.mul_add(trace, squares);
    }
    for k in D::COUNT..D::STRESS_COUNT {
        squares = (deviator[k] + deviator[k]).mul_add(deviator[k], squares);
    }
    let von_mises = (L::splat(1.5) * squares).sqrt();
    (yield_strength / von_mises.max(L::splat(f64::MIN_POSITIVE))).min(L::one())
}

/// c = (tr L I - L)⁻¹ τ with τ_c = ε_bcd (K L σ)_db.
#[inline(always)]
fn torque<D: SolidDimension, L: Lanes>(
    matrix: &D::Symmetric<L>,
    correction: &D::Symmetric<L>,
    half: &D::Fields<L>,
) -> D::Spin<L> {
    // Rows of K L σ.
    let mut product = D::Axes::<D::Axes<L>>::splat(D::Axes::<L>::splat(L::zero()));
    for b in 0..D::COUNT {
        let mut column = D::Axes::<L>::splat(L::zero());
        for a in 0..D::COUNT {
            column[a] = half[D::COUNT + symmetric(D::COUNT, a, b)];
        }
        let column = times::<D, L>(correction, &times::<D, L>(matrix, &column));
        for d in 0..D::COUNT {
            product[d][b] = column[d];
        }
    }
    // ε_bcd X_db is the dual of X.
    D::spin_solve(*matrix, dual::<D, L>(&product))
}
