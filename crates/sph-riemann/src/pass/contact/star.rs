//! Velocity and traction at the contacts of eight pairs, or of half of them.

use sph_core::dimension::Components;
use sph_core::lanes::Part;

use super::super::Pass;
use crate::dimension::{SolidDimension, cross, dot, times};
use crate::limiter::{Limiter, SlopeLimiter, VanLeer, with_limiter};
use crate::record::Sides;
use crate::scheme::SurfaceTreatment;

/// Sum of transverse impedances of two fluids [kg/(m² s)]: small against any other, not so small that its inverse would
/// not be finite.
const NO_IMPEDANCE: f64 = 1e-30;

/// Added to gradients so that none is exactly zero: small against any that a field can show.
const LEAST_GRADIENT: f64 = 1e-100;

/// The limiter of the pass. The compiler must not know that `is_default` says van Leer: there is then a branch for it, and
/// not a jump through a table for every slot.
#[derive(Clone, Copy)]
pub(super) struct Chosen {
    pub limiter: Limiter,
    pub is_default: bool,
}

/// Both sides of eight contacts.
pub(super) struct Pair<'a, D: SolidDimension, L: Part> {
    pub left: &'a D::SidesRecord<L>,
    pub right: &'a D::SidesRecord<L>,
    pub dx: &'a D::Axes<L>,
    pub e: &'a D::Axes<L>,
}

impl<D: SolidDimension, L: Part> Pair<'_, D, L> {
    /// Velocity and traction at the contact.
    #[inline(always)]
    pub fn star<const RECONSTRUCT: bool>(
        &self,
        pass: &Pass<'_, D>,
        limiter: Chosen,
    ) -> (D::Axes<L>, D::Axes<L>) {
        let (phi_l, phi_r) = self.reconstruct::<RECONSTRUCT>(limiter);
        let mut du = D::Axes::<L>::splat(L::zero());
        for a in 0..D::COUNT {
            du[a] = phi_r[a] - phi_l[a];
        }
        let (mut stress_l, mut stress_r) =
            (D::Symmetric::<L>::splat(L::zero()), D::Symmetric::<L>::splat(L::zero()));
        let mut jump = stress_l;
        for k in 0..D::STRESS_COUNT {
            stress_l[k] = phi_l[D::COUNT + k];
            stress_r[k] = phi_r[D::COUNT + k];
            jump[k] = stress_r[k] - stress_l[k];
        }
        let (mut mean_e, mut half_difference_e) = (*self.e, *self.e);
        if RECONSTRUCT {
            let mut half_e = *self.e;
            for a in 0..D::COUNT {
                half_e[a] = L::splat(0.5) * self.e[a];
            }
            let (left_e, right_e) =
                (Self::corrected(self.left, &half_e), Self::corrected(self.right, &half_e));
            for a in 0..D::COUNT {
                mean_e[a] = left_e[a] + right_e[a];
                half_difference_e[a] = left_e[a] - right_e[a];
            }
        }
        let impedances = Impedances::<L>::of::<D>(self.left, self.right);
        let change = impedances.change::<D>(&times::<D, L>(&jump, &mean_e), &du, self.e);
        let mut velocity = du;
        for a in 0..D::COUNT {
            velocity[a] = phi_l[a] + change.velocity[a];
        }
        let mut traction = impedances.traction::<D>(&times::<D, L>(&stress_l, &mean_e), &change, self.e);
        if RECONSTRUCT && matches!(pass.surface, SurfaceTreatment::SpectralCap { .. }) {
            let weights = impedances.weights();
            let adjoint = self.adjoint(&stress_l, &stress_r, &half_difference_e, weights);
            for a in 0..D::COUNT {
                traction[a] += adjoint[a];
            }
        }
        (velocity, traction)
    }

    /// K e.
    #[inline(always)]
    fn corrected(record: &D::SidesRecord<L>, e: &D::Axes<L>) -> D::Axes<L> {
        let mut k = D::Symmetric::<L>::splat(L::zero());
        for c in 0..D::STRESS_COUNT {
            k[c] = record[Sides::correction::<D>() + c];
        }
        times::<D, L>(&k, e)
    }

    /// (w_l σ_l - w_r σ_r)·½(K_l - K_r) e - (w_l c_l + w_r c_r) × e: what makes the traction the adjoint of the velocity
    /// gradient, each side with its own correction.
    #[inline(always)]
    fn adjoint(
        &self,
        stress_l: &D::Symmetric<L>,
        stress_r: &D::Symmetric<L>,
        half_difference_e: &D::Axes<L>,
        [w_l, w_r]: [L; 2],
    ) -> D::Axes<L> {
        // w_l + w_r = 1.
        let mut weighted = *stress_l;
        for k in 0..D::STRESS_COUNT {
            weighted[k] = w_l.mul_add(stress_l[k] + stress_r[k], -stress_r[k]);
        }
        let mut torque = D::Spin::<L>::splat(L::zero());
        for c in 0..D::SPIN_COUNT {
            let at = Sides::torque::<D>() + c;
            torque[c] = w_l.mul_add(self.left[at], w_r * self.right[at]);
        }
        let turn = cross::<D, L>(&torque, self.e);
        let mut adjoint = times::<D, L>(&weighted, half_difference_e);
        for a in 0..D::COUNT {
            adjoint[a] = adjoint[a] - turn[a];
        }
        adjoint
    }

    /// Φ_l and Φ_r.
    #[inline(always)]
    fn reconstruct<const RECONSTRUCT: bool>(&self, limiter: Chosen) -> (D::Fields<L>, D::Fields<L>) {
        let mut phi_l = D::Fields::<L>::splat(L::zero());
        let mut phi_r = phi_l;
        for f in 0..D::COUNT + D::STRESS_COUNT {
            phi_l[f] = self.left[Sides::fields::<D>() + f];
            phi_r[f] = self.right[Sides::fields::<D>() + f];
        }
        if RECONSTRUCT {
            if limiter.is_default {
                self.limited::<VanLeer>(&mut phi_l, &mut phi_r);
            } else {
                with_limiter!(limiter.limiter, M => self.limited::<M>(&mut phi_l, &mut phi_r));
            }
        }
        (phi_l, phi_r)
    }

    #[inline(always)]
    fn limited<M: SlopeLimiter>(&self, phi_l: &mut D::Fields<L>, phi_r: &mut D::Fields<L>) {
        let mut dx = *self.dx;
        for a in 0..D::COUNT {
            dx[a] = L::splat(M::GRADIENT_MULTIPLE) * dx[a];
        }
        for f in 0..D::COUNT + D::STRESS_COUNT {
            let first = Sides::slopes::<D>() + f * D::COUNT;
            let mut along_l = L::splat(LEAST_GRADIENT);
            let mut along_r = along_l;
            for a in 0..D::COUNT {
                along_l = self.left[first + a].mul_add(dx[a], along_l);
                along_r = self.right[first + a].mul_add(dx[a], along_r);
            }
            (phi_l[f], phi_r[f]) = M::sides(phi_l[f], phi_r[f], along_l, along_r);
        }
    }
}

/// Impedances of both sides, along R and across.
struct Impedances<L> {
    left: [L; 2],
    right: [L; 2],
    inverse_sum: [L; 2],
    /// Sum of the transverse ones, where two fluids meet in one of the lanes.
    of_fluids: Option<L>,
}

/// What the contact changes of the left side.
struct Change<D: SolidDimension, L: Part> {
    /// A along R [m/s].
    along: L,
    /// A [m/s].
    velocity: D::Axes<L>,
    /// Part of the change of the traction that is not z A [Pa]: between fluids.
    traction: Option<D::Axes<L>>,
}

impl<L: Part> Impedances<L> {
    #[inline(always)]
    fn of<D: SolidDimension>(left: &D::SidesRecord<L>, right: &D::SidesRecord<L>) -> Self {
        let (l, t) = (Sides::longitudinal::<D>(), Sides::transverse::<D>());
        let (left, right) = ([left[l], left[t]], [right[l], right[t]]);
        let across = left[1] + right[1];
        let least = L::splat(NO_IMPEDANCE);
        let of_fluids = across.any_less(least).then_some(across);
        let sum = [left[0] + right[0], across.max(least)];
        // One division for both.
        let inverse = L::one() / (sum[0] * sum[1]);
        Self { left, right, inverse_sum: [sum[1] * inverse, sum[0] * inverse], of_fluids }
    }

    /// Weights of the left and the right traction in t*: z_r and z_l over their sum.
    #[inline(always)]
    fn weights(&self) -> [L; 2] {
        [self.right[0] * self.inverse_sum[0], self.left[0] * self.inverse_sum[0]]
    }

    /// A = (Δt + z_r ΔU)/(z_l + z_r), with the transverse impedances, and what the longitudinal ones change along R.
    #[inline(always)]
    fn change<D: SolidDimension>(&self, dt: &D::Axes<L>, du: &D::Axes<L>, e: &D::Axes<L>) -> Change<D, L> {
        let (dt_r, du_r) = (dot::<D, L>(dt, e), dot::<D, L>(du, e));
        let along = self.right[0].mul_add(du_r, dt_r) * self.inverse_sum[0];
        let as_transverse = self.right[1].mul_add(du_r, dt_r) * self.inverse_sum[1];
        let rest = along - as_transverse;
        let mut velocity = *du;
        for a in 0..D::COUNT {
            let push = self.right[1].mul_add(du[a], dt[a]);
            velocity[a] = push.mul_add(self.inverse_sum[1], rest * e[a]);
        }
        let mut change = Change::<D, L> { along, velocity, traction: None };
        if let Some(across) = self.of_fluids {
            // No wave runs across R: both sides meet half-way, in velocity and in traction.
            let (half, least, mut traction) = (L::splat(0.5), L::splat(NO_IMPEDANCE), *dt);
            for a in 0..D::COUNT {
                let slip = half.mul_add(du[a] - du_r * e[a], along * e[a]);
                change.velocity[a] = across.select_less(least, slip, change.velocity[a]);
                traction[a] = across.select_less(least, half * (dt[a] - dt_r * e[a]), L::zero());
            }
            change.traction = Some(traction);
        }
        change
    }

    /// t* = t_l + z_l A, direction by direction.
    #[inline(always)]
    fn traction<D: SolidDimension>(
        &self,
        left: &D::Axes<L>,
        change: &Change<D, L>,
        e: &D::Axes<L>,
    ) -> D::Axes<L> {
        let extra = (self.left[0] - self.left[1]) * change.along;
        let mut traction = *left;
        for a in 0..D::COUNT {
            traction[a] = self.left[1].mul_add(change.velocity[a], extra.mul_add(e[a], left[a]));
        }
        if let Some(between_fluids) = &change.traction {
            for a in 0..D::COUNT {
                traction[a] += between_fluids[a];
            }
        }
        traction
    }
}
