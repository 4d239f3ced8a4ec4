//! Growth of voids in tension, and their recompression.
//!
//! Each point is taken for a hollow sphere of distension `α = V/V_s` (volume over volume of the solid) whose
//! matrix is perfectly plastic and viscous, `η`. Voids of distension `α0` are there from the
//! beginning; density and equation of state are those of the material *with* them, so that the matrix has the density
//! `ρ a` and the point the pressure
//!
//! ```text
//! P = P_s(ρ a, e)/a           a = α/α0: the distension that growth has added
//! ```
//!
//! Voids grow or close where the pressure is beyond the yield surface of the hollow sphere,
//!
//! ```text
//! dα/dt = 3/(4η) α(α - 1) (-P - T(α))     where -P > T(α)
//!        -3/(4η) α(α - 1) ( P - T(α))     where  P > T(α), down to α0
//! T(α)  = T ln(α/(α - 1)) / ln(α0/(α0 - 1))
//! ```
//!
//! T(α0) = T is the tensile strength at slow loading; the sphere's own theory has `T(α) = 2/3 Y
//! ln(α/(α-1))`, of which only the shape is kept, since the strength of a real metal is set by what is in
//! it. The factor `3/(4η) α(α-1)` is the exact one for incompressible radial flow: the power
//! `-P dV/dt` equals `∫ 2η d:d` over the matrix. Softening, measured from the first voids on so that an intact point has all
//! of its strength: the yield strength falls to `Y (1 - (φ - φ0)/(φ_c - φ0))`, `φ = 1 - 1/α`, `φ0 = 1 - 1/α0`.
//!
//! At `φ = φ_c` the voids meet and the point is torn: from then on it carries pressure, and shear while
//! it is under pressure, but never tension again. The gap must be closed, `ρ` back at its value without tension,
//! before there is pressure.
//!
//! A step is implicit in `α` (bisection), so a stiff matrix needs no shorter step.
//!
//! # Validity
//!
//! Ductile metals under short tensile pulses. Spherical voids of one size, no inertia of the matrix around them (pulses
//! longer than their radius over the shear speed), no nucleation, no heat. Torn points do not weld.
//!
//! # Source
//!
//! Yield surface of the hollow sphere: M. M. Carroll & A. C. Holt, J. Appl. Phys. 43 (1972) 1626. Growth in tension with
//! the matrix' viscosity, for spall: J. N. Johnson, J. Appl. Phys. 52 (1981) 2812 (its exponent of the distension and its
//! factor 1/α of the threshold differ).

use super::{Damage, TensileState};
use crate::eos::Parameter;
use crate::root::turning_point;
use serde::{Deserialize, Serialize};

/// Parameters of the growth of voids.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VoidGrowth {
    /// Mean tension `T` at which the first voids begin to grow [Pa].
    pub tensile_strength: f64,
    /// Distension `α0` of the voids that are there from the beginning, above 1 [-].
    pub initial_distension: f64,
    /// Viscosity `η` of the matrix [Pa s].
    pub viscosity: f64,
    /// Porosity `φ_c` at which voids meet, above `φ0` and below 1 [-].
    pub coalescence_porosity: f64,
}

impl VoidGrowth {
    /// Growth in a metal of tensile strength `tensile_strength` [Pa]: `α0 = 1.0003`, `η = 10` Pa s,
    /// the orders of magnitude of Johnson's copper, and `φ_c = 0.3`.
    pub fn of_strength(tensile_strength: f64) -> Self {
        Self { tensile_strength, initial_distension: 1.0003, viscosity: 10.0, coalescence_porosity: 0.3 }
    }

    /// Pressure [Pa] with the voids as they are.
    #[inline]
    pub fn pressure(&self, damage: Damage, density: f64, solid: impl Fn(f64) -> f64) -> f64 {
        if damage.failed {
            return torn_pressure(solid(density));
        }
        solid(density * damage.distension) / damage.distension
    }

    /// Voids and pressure at the end of a step of `time_step` [s].
    pub fn advance(
        &self,
        damage: Damage,
        density: f64,
        time_step: f64,
        solid: impl Fn(f64) -> f64,
    ) -> TensileState {
        if damage.failed {
            let pressure = torn_pressure(solid(density));
            return TensileState { damage, pressure, strength_left: if pressure > 0.0 { 1.0 } else { 0.0 } };
        }
        let point = Point { model: self, density, time_step, solid: &solid };
        let alpha = point.grown(self.initial_distension * damage.distension);
        let porosity = 1.0 - 1.0 / alpha;
        if porosity >= self.coalescence_porosity {
            let damage = Damage { failed: true, ..Damage::NONE };
            return TensileState { damage, pressure: torn_pressure(solid(density)), strength_left: 0.0 };
        }
        let damage = Damage { failed: false, distension: alpha / self.initial_distension };
        // Measured from the first voids on, so that an intact point has all of its strength.
        let first = 1.0 - 1.0 / self.initial_distension;
        let strength_left = 1.0 - (porosity - first) / (self.coalescence_porosity - first);
        TensileState { damage, pressure: point.pressure(alpha), strength_left }
    }

    /// Numbers of the model, for the check of a material.
    pub(crate) fn parameters(&self) -> Vec<Parameter> {
        let first = 1.0 - 1.0 / self.initial_distension;
        vec![
            Parameter::above("tensile_strength", self.tensile_strength, "Pa", 0.0),
            Parameter::above("initial_distension", self.initial_distension, "1", 1.0),
            Parameter::above("viscosity", self.viscosity, "Pa s", 0.0),
            // Voids that have met from the beginning are none, and no growth makes matter of voids alone.
            Parameter::above("coalescence_porosity", self.coalescence_porosity, "1", first).and_below(1.0),
        ]
    }
}

/// A torn point carries no tension. (Not a number stays one: the step finds it.)
#[inline]
fn torn_pressure(pressure: f64) -> f64 {
    if pressure < 0.0 { 0.0 } else { pressure }
}

/// One point in one step.
struct Point<'a, F> {
    model: &'a VoidGrowth,
    density: f64,
    time_step: f64,
    solid: &'a F,
}

impl<F: Fn(f64) -> f64> Point<'_, F> {
    fn pressure(&self, alpha: f64) -> f64 {
        let added = alpha / self.model.initial_distension;
        (self.solid)(self.density * added) / added
    }

    /// T(α) [Pa].
    fn threshold(&self, alpha: f64) -> f64 {
        let shape = |alpha: f64| (alpha / (alpha - 1.0)).ln();
        self.model.tensile_strength * shape(alpha) / shape(self.model.initial_distension)
    }

    /// Rate dα/dt [1/s].
    fn rate(&self, alpha: f64) -> f64 {
        let (pressure, threshold) = (self.pressure(alpha), self.threshold(alpha));
        let beyond = if -pressure > threshold {
            -pressure - threshold
        } else if pressure > threshold {
            threshold - pressure
        } else {
            0.0
        };
        0.75 / self.model.viscosity * alpha * (alpha - 1.0) * beyond
    }

    /// α at the end of the step, implicit: α - α_old = τ dα/dt(α).
    fn grown(&self, old: f64) -> f64 {
        let least = self.model.initial_distension;
        let rate = self.rate(old);
        let excess = |alpha: f64| alpha - old - self.time_step * self.rate(alpha);
        if rate > 0.0 {
            // Growth takes the tension away, so there is an end of it.
            let mut span = old - 1.0;
            while excess(old + span) < 0.0 && span < 1e3 {
                span *= 2.0;
            }
            turning_point(old, old + span, |alpha| excess(alpha) >= 0.0)
        } else if rate < 0.0 && excess(least) < 0.0 {
            turning_point(least, old, |alpha| excess(alpha) >= 0.0)
        } else if rate < 0.0 {
            least
        } else {
            old
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Failure, MaterialError, library};

    const STRENGTH: f64 = 0.35e9;

    /// Stretches copper slowly or fast and returns the greatest tension, the end of the tension and the last state.
    fn stretch(strain_rate: f64, strain: f64) -> (f64, TensileState) {
        let copper = library::material("porous-copper").unwrap();
        let failure = Failure::VoidGrowth(VoidGrowth::of_strength(STRENGTH));
        let steps = 4000;
        let step = strain / strain_rate / f64::from(steps);
        let mut state = failure.advance(Damage::NONE, 8960.0, step, |rho| copper.pressure(rho, 0.0));
        let mut tension = 0.0_f64;
        for k in 1..=steps {
            let density = 8960.0 * (-strain * f64::from(k) / f64::from(steps)).exp();
            state = failure.advance(state.damage, density, step, |rho| copper.pressure(rho, 0.0));
            tension = tension.max(-state.pressure);
        }
        (tension, state)
    }

    #[test]
    fn voids_hold_the_strength_when_slow_and_more_when_fast() {
        let (slow, _) = stretch(1e2, 0.01);
        assert!((slow / STRENGTH - 1.0).abs() < 0.02, "{slow:e} Pa");
        let (fast, _) = stretch(1e6, 0.02);
        assert!(fast > 2.0 * STRENGTH, "{fast:e} Pa");
    }

    #[test]
    fn voids_take_up_the_strain_and_tear() {
        let (_, opened) = stretch(1e4, 0.05);
        let a = opened.damage.distension;
        assert!(!opened.damage.failed && (a - 0.05_f64.exp()).abs() < 0.003, "a = {a}");
        assert!(opened.strength_left > 0.8 && opened.strength_left < 0.87, "{}", opened.strength_left);
        let (_, torn) = stretch(1e4, 0.5);
        assert!(torn.damage.failed && torn.pressure == 0.0 && torn.strength_left == 0.0);
    }

    #[test]
    fn the_check_knows_both_bounds_of_the_porosity_at_which_voids_meet() {
        let mut copper = library::material("porous-copper").unwrap();
        let mut faults = |coalescence_porosity: f64| {
            let model = VoidGrowth { coalescence_porosity, ..VoidGrowth::of_strength(STRENGTH) };
            copper.failure = Failure::VoidGrowth(model);
            copper.validate().err().unwrap_or_default()
        };
        assert_eq!((faults(3.001e-4), faults(0.999)), (vec![], vec![]));
        // First voids: φ0 = 1 - 1/1.0003 = 2.9991e-4.
        let [MaterialError::NotAbove { least, .. }] = faults(2.999e-4)[..] else { panic!() };
        assert!((least - 2.9991e-4).abs() < 1e-9, "{least}");
        for value in [1.0, 30.0] {
            let [MaterialError::NotBelow { value: found, bound: 1.0, .. }] = faults(value)[..] else {
                panic!()
            };
            assert_eq!(found, value);
        }
    }

    /// φ half way from φ0 to φ_c: half of the strength.
    #[test]
    fn strength_falls_from_the_first_voids_to_the_porosity_at_which_they_meet() {
        let model = VoidGrowth { initial_distension: 1.25, ..VoidGrowth::of_strength(STRENGTH) };
        // φ0 = 0.2, φ_c = 0.3, φ = 0.25: α = 4/3. No pressure, so nothing moves.
        let damage = Damage { failed: false, distension: 4.0 / 3.0 / 1.25 };
        let state = model.advance(damage, 8000.0, 1e-9, |_| 0.0);
        assert!((state.strength_left - 0.5).abs() < 1e-12, "{}", state.strength_left);
    }

    #[test]
    fn compression_closes_what_tension_opened() {
        let copper = library::material("porous-copper").unwrap();
        let model = VoidGrowth::of_strength(STRENGTH);
        let mut damage = Damage { failed: false, distension: 1.05 };
        let pressure = |rho: f64| copper.pressure(rho, 0.0);
        let mut last = 0.0;
        for k in 0..4000 {
            let density = 8960.0 * (0.96 + 0.06 * f64::from(k) / 4000.0);
            let state = model.advance(damage, density, 1e-8, pressure);
            assert!(state.damage.distension <= damage.distension, "voids grew under pressure");
            damage = state.damage;
            last = state.pressure;
        }
        assert_eq!(damage, Damage::NONE);
        assert_eq!(last, pressure(8960.0 * (0.96 + 0.06 * 3999.0 / 4000.0)));
    }

    #[test]
    fn torn_point_carries_pressure_but_no_tension() {
        let model = VoidGrowth::of_strength(STRENGTH);
        let torn = Damage { failed: true, ..Damage::NONE };
        assert_eq!(model.advance(torn, 1.0, 1e-9, |_| -1.0).pressure, 0.0);
        let pressed = model.advance(torn, 1.0, 1e-9, |_| 1.0);
        assert_eq!((pressed.pressure, pressed.strength_left, pressed.damage.failed), (1.0, 1.0, true));
        assert!(model.pressure(torn, 1.0, |_| f64::NAN).is_nan());
    }

    /// Where nothing has opened, the pressure is the solid's, bit by bit.
    #[test]
    fn intact_point_has_the_pressure_of_the_solid() {
        let model = VoidGrowth::of_strength(STRENGTH);
        for pressure in [-0.3e9, 0.0, 7e9] {
            let state = model.advance(Damage::NONE, 8960.0, 1e-9, |_| pressure);
            assert_eq!((state.pressure, state.damage, state.strength_left), (pressure, Damage::NONE, 1.0));
        }
    }
}
