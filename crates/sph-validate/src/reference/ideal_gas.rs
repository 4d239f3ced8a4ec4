//! Exact Riemann problem of an ideal gas: a shock or a fan on either side of the contact.
//!
//! With A = 2/((γ+1)ρ), B = (γ-1)/(γ+1) P of the side ahead, the velocity that a wave to the pressure p gives:
//!
//! ```text
//! f(p) = (p - P) √[A/(p + B)]                           (p > P: shock)
//! f(p) = 2c/(γ - 1) [(p/P)^((γ - 1)/(2γ)) - 1]          (p ≤ P: fan)
//! ```
//!
//! and p of the contact from f_l(p) + f_r(p) + u_r - u_l = 0, by bisection. Fans are isentropic and self-similar.
//!
//! Validity: no vacuum (u_r - u_l below 2(c_l + c_r)/(γ-1)).
//!
//! Source: E. F. Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, ch. 4.

/// Uniform state of the gas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// ρ [kg/m³].
    pub density: f64,
    /// u [m/s].
    pub velocity: f64,
    /// P [Pa].
    pub pressure: f64,
}

/// The solution of one problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    gamma: f64,
    left: State,
    right: State,
    /// Pressure of the contact [Pa].
    pub pressure: f64,
    /// Velocity of the contact [m/s].
    pub velocity: f64,
}

impl Solution {
    /// The solution; `None` where a vacuum opens, or a state cannot be.
    pub fn new(gamma: f64, left: State, right: State) -> Option<Self> {
        let sound = |state: State| (gamma * state.pressure / state.density).sqrt();
        let opening = right.velocity - left.velocity;
        let limit = 2.0 * (sound(left) + sound(right)) / (gamma - 1.0);
        let good = |state: State| state.density > 0.0 && state.pressure > 0.0;
        if !(gamma > 1.0 && good(left) && good(right) && opening < limit) {
            return None;
        }
        let gap = |p: f64| gain(gamma, left, p) + gain(gamma, right, p) + opening;
        let (mut low, mut high) = (0.0, left.pressure.max(right.pressure));
        while gap(high) < 0.0 {
            high *= 2.0;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if gap(middle) < 0.0 { low = middle } else { high = middle }
        }
        let pressure = 0.5 * (low + high);
        let velocity = 0.5
            * (left.velocity + right.velocity + gain(gamma, right, pressure) - gain(gamma, left, pressure));
        Some(Self { gamma, left, right, pressure, velocity })
    }

    /// State on the ray x/t [m/s].
    pub fn sample(&self, ray: f64) -> State {
        if ray < self.velocity {
            return self.side(self.left, ray);
        }
        // The right side is the mirror image of a left one.
        let mirror = |state: State| State { velocity: -state.velocity, ..state };
        let reflected = Self { velocity: -self.velocity, ..*self };
        mirror(reflected.side(mirror(self.right), -ray))
    }

    /// State on a ray left of the contact, `ahead` being the undisturbed one.
    fn side(&self, ahead: State, ray: f64) -> State {
        let (gamma, ratio) = (self.gamma, self.pressure / ahead.pressure);
        let sound = (gamma * ahead.pressure / ahead.density).sqrt();
        let weak = (gamma - 1.0) / (gamma + 1.0);
        if ratio > 1.0 {
            let speed = ahead.velocity - sound * ((ratio + weak) / (1.0 + weak)).sqrt();
            let density = ahead.density * (ratio + weak) / (weak * ratio + 1.0);
            let behind = State { density, velocity: self.velocity, pressure: self.pressure };
            return if ray < speed { ahead } else { behind };
        }
        let tail_sound = sound * ratio.powf(0.5 * (gamma - 1.0) / gamma);
        if ray < ahead.velocity - sound {
            return ahead;
        }
        if ray > self.velocity - tail_sound {
            let density = ahead.density * ratio.powf(1.0 / gamma);
            return State { density, velocity: self.velocity, pressure: self.pressure };
        }
        let factor = 2.0 / (gamma + 1.0) + weak / sound * (ahead.velocity - ray);
        State {
            density: ahead.density * factor.powf(2.0 / (gamma - 1.0)),
            velocity: 2.0 / (gamma + 1.0) * (sound + 0.5 * (gamma - 1.0) * ahead.velocity + ray),
            pressure: ahead.pressure * factor.powf(2.0 * gamma / (gamma - 1.0)),
        }
    }
}

/// f(p) of one side.
fn gain(gamma: f64, ahead: State, p: f64) -> f64 {
    if p > ahead.pressure {
        let a = 2.0 / ((gamma + 1.0) * ahead.density);
        let b = (gamma - 1.0) / (gamma + 1.0) * ahead.pressure;
        (p - ahead.pressure) * (a / (p + b)).sqrt()
    } else {
        let sound = (gamma * ahead.pressure / ahead.density).sqrt();
        2.0 * sound / (gamma - 1.0) * ((p / ahead.pressure).powf(0.5 * (gamma - 1.0) / gamma) - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn state(density: f64, velocity: f64, pressure: f64) -> State {
        State { density, velocity, pressure }
    }

    /// Toro, table 4.3: Sod's problem and the strong left blast.
    #[test]
    fn contact_is_the_published_one() {
        let sod = Solution::new(1.4, state(1.0, 0.0, 1.0), state(0.125, 0.0, 0.1)).expect("solvable");
        assert!((sod.pressure - 0.30313).abs() < 1e-5 && (sod.velocity - 0.92745).abs() < 1e-5, "{sod:?}");
        assert!((sod.sample(0.5).density - 0.42632).abs() < 1e-5);
        assert!((sod.sample(1.5).density - 0.26557).abs() < 1e-5);
        let blast = Solution::new(1.4, state(1.0, 0.0, 1000.0), state(1.0, 0.0, 0.01)).expect("solvable");
        assert!((blast.pressure - 460.894).abs() < 1e-3 && (blast.velocity - 19.5975).abs() < 1e-4);
    }

    /// Jump conditions across the shock, constancy of the invariant in the fan, symmetry.
    #[test]
    fn waves_obey_their_laws() {
        let sod = Solution::new(1.4, state(1.0, 0.0, 1.0), state(0.125, 0.0, 0.1)).expect("solvable");
        let behind = sod.sample(1.7);
        let speed = behind.density * behind.velocity / (behind.density - 0.125);
        assert!((behind.pressure - 0.1 - 0.125 * speed * behind.velocity).abs() < 1e-12);
        assert_eq!(sod.sample(1.001 * speed), state(0.125, 0.0, 0.1));
        for ray in [-1.1, -0.6, -0.2] {
            let fan = sod.sample(ray);
            let sound = (1.4 * fan.pressure / fan.density).sqrt();
            assert!((fan.velocity + 5.0 * sound - 5.0 * 1.4f64.sqrt()).abs() < 1e-12);
            assert!((fan.velocity - sound - ray).abs() < 1e-12);
        }
        let mirrored = Solution::new(1.4, state(0.125, 0.0, 0.1), state(1.0, 0.0, 1.0)).expect("solvable");
        assert!((mirrored.sample(0.6).density - sod.sample(-0.6).density).abs() < 1e-12);
    }

    #[test]
    fn vacuum_has_no_solution() {
        assert_eq!(Solution::new(1.4, state(1.0, -10.0, 1.0), state(1.0, 10.0, 1.0)), None);
        assert_eq!(Solution::new(1.4, state(1.0, 0.0, 0.0), state(1.0, 0.0, 1.0)), None);
    }
}
