//! What one side of the contact can reach by its waves, and the stress at which both sides meet.
//!
//! Units are SI, stress is positive in tension. The laws of the waves are those of the module above; whether they can follow
//! each other is not looked at here.

use super::{Branch, Release, RiemannError, Side, Solid, State, Wave};

/// The states that waves running into one side can reach, as a function of the stress behind them.
pub(super) struct Curve {
    solid: Solid,
    ahead: State,
    side: Side,
    release: Release,
}

impl Curve {
    pub(super) fn new(
        solid: Solid,
        ahead: State,
        side: Side,
        release: Release,
    ) -> Result<Self, RiemannError> {
        let (deviator, limit) = (ahead.deviator.abs(), solid.deviator_limit());
        if !(ahead.density.is_finite() && ahead.density > 0.0) {
            return Err(RiemannError::Parameter { name: "density of a side", value: ahead.density });
        }
        if deviator.is_nan() || deviator > limit * (1.0 + 1e-12) {
            return Err(RiemannError::BeyondYield { side, deviator, limit });
        }
        Ok(Self { solid, ahead, side, release })
    }

    /// The waves that take the side to `stress`, fastest first.
    pub(super) fn waves(&self, stress: f64) -> Vec<Wave> {
        let sense = (stress - self.ahead.stress).signum();
        let limit = sense * self.solid.deviator_limit();
        let elastic_strain = (limit - self.ahead.deviator) / (4.0 / 3.0 * self.solid.shear_modulus);
        let yield_stress = self.ahead.stress + self.solid.elastic_modulus() * elastic_strain;
        let stops_inside = sense * (yield_stress - stress) >= 0.0;
        let mut waves = Vec::new();
        let elastic_end = if stops_inside { stress } else { yield_stress };
        let behind = self.push(&mut waves, self.ahead, elastic_end, Branch::Elastic);
        if !stops_inside {
            self.push(&mut waves, behind, stress, Branch::Plastic);
        }
        waves
    }

    /// Adds the wave from `ahead` to `stress` where it has an amplitude; returns the state behind it.
    fn push(&self, waves: &mut Vec<Wave>, ahead: State, stress: f64, branch: Branch) -> State {
        // A state that lies on the yield surface to round-off has no elastic wave.
        if (stress - ahead.stress).abs() <= 1e-12 * self.solid.yield_strength {
            return ahead;
        }
        let wave = self.wave(ahead, stress, branch);
        waves.push(wave);
        wave.behind
    }

    fn wave(&self, ahead: State, stress: f64, branch: Branch) -> Wave {
        let s = self.side.direction();
        let (modulus, deviator_slope) = match branch {
            Branch::Elastic => (self.solid.elastic_modulus(), 4.0 / 3.0 * self.solid.shear_modulus),
            Branch::Plastic => (self.solid.bulk_modulus, 0.0),
        };
        let strain = (stress - ahead.stress) / modulus;
        let [v_ahead, v_behind] = [1.0 / ahead.density, strain.exp() / ahead.density];
        let [c_ahead, c_behind] = [(modulus * v_ahead).sqrt(), (modulus * v_behind).sqrt()];
        let is_fan = strain > 0.0 && self.release == Release::Fan;
        let gain = if is_fan {
            -2.0 * (c_behind - c_ahead)
        } else {
            -strain.signum() * ((stress - ahead.stress) * (v_behind - v_ahead)).sqrt()
        };
        let velocity = ahead.velocity + s * gain;
        let deviator = ahead.deviator + deviator_slope * strain;
        let jump = ahead.velocity + s * gain / (1.0 - v_behind / v_ahead);
        let (head, tail) =
            if is_fan { (ahead.velocity + s * c_ahead, velocity + s * c_behind) } else { (jump, jump) };
        let behind = State { density: 1.0 / v_behind, deviator, velocity, stress };
        Wave { side: self.side, branch, head, tail, ahead, behind }
    }

    /// Velocity behind the waves [m/s].
    pub(super) fn velocity(&self, stress: f64) -> f64 {
        self.waves(stress).last().map_or(self.ahead.velocity, |wave| wave.behind.velocity)
    }
}

/// The stress at which both sides move alike: bisection on a monotone difference of velocities.
pub(super) fn contact_stress(curves: &[Curve; 2]) -> Result<f64, RiemannError> {
    let separation = |stress: f64| curves[1].velocity(stress) - curves[0].velocity(stress);
    let modulus = curves[0].solid.elastic_modulus();
    // One decade of density either way is far beyond any solid.
    let (mut low, mut high) = (-2.3 * modulus, 2.3 * modulus);
    let speed = (curves[0].ahead.velocity - curves[1].ahead.velocity).abs();
    // A low (compressive) stress drives the sides apart, a high (tensile) one together.
    if separation(high) > 0.0 {
        return Err(RiemannError::Vacuum { speed, limit: high });
    }
    if separation(low) < 0.0 {
        return Err(RiemannError::Collapse { speed, limit: low });
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if separation(middle) > 0.0 { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}
