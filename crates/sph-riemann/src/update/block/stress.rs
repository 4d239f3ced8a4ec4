//! Stress and failure of eight particles at a time.

use sph_core::dimension::Components;
use sph_core::lanes::{LANES, Lanes};

use super::{Block, Flow, Motion, Place, UpdateTile};
use crate::dimension::SolidDimension;
use crate::matter::{Eight, Numbers, Tension};

impl<D: SolidDimension> UpdateTile<'_, D> {
    /// Deviator, plastic strain, failure; returns the deviator.
    #[inline(always)]
    pub(super) fn advance_stress<L: Lanes>(
        &mut self,
        block: &Block<'_, '_, D, L>,
        motion: &Motion<D, L>,
        flow: Flow<L>,
    ) -> D::Tensor<L> {
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
        if broken != 0 && self.written.report.broken.is_none() {
            self.written.report.broken = Some(block.i as u32 + broken.trailing_zeros());
        }
        deviator
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
            self.written.report.interventions.failures += u64::from(failed && !self.columns.failed[at]);
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
