//! Exact Riemann problem of an elastic-plastic solid in uniaxial strain.
//!
//! The solid has the logarithmic equation of state P = B ln(ρ/ρ0), a constant shear modulus G and von Mises yield at
//! |S_xx| = 2Y/3. With V = 1/ρ both branches are straight lines in ln V:
//!
//! ```text
//! dσ = (B + 4G/3) d ln V  (elastic),      dσ = B d ln V  (plastic)
//! ```
//!
//! A side of the contact carries an elastic wave and, when it reaches the yield surface, a slower plastic wave. On a
//! branch of modulus K the sound speed is c = sqrt(K V). Compression is a jump, Δu² = Δσ ΔV (paper eqs. (28), (29)).
//! Release is an isentropic fan: u - 2c is constant through one that runs to the left, u + 2c through one to the right, and
//! its tail is slower than its head, because c grows with V. The release *jump* of the paper (below eq. (33), and eq. (36))
//! violates the entropy condition, but is offered for comparison with its numbers.
//!
//! Stress is positive in tension. Validity: smooth equation of state without thermal pressure, plastic shock slower
//! than its precursor, bonded contact (tension at the contact is carried).
//!
//! Source: Rublev and Murzov (2024), section 2.1.1; Wilkins (1964) for the model.

mod curve;

use thiserror::Error;

use curve::{Curve, contact_stress};

/// What makes a Riemann problem impossible or leaves it outside of this solution.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RiemannError {
    /// A material parameter is not a finite, positive number.
    #[error("{name} must be finite and positive, but it is {value}")]
    Parameter {
        /// Which parameter.
        name: &'static str,
        /// Its value in SI units: [Pa] or [kg/m³].
        value: f64,
    },
    /// An initial deviator lies outside of the yield surface.
    #[error("the {side} state has |S_xx| = {deviator:.6e} Pa, beyond the yield limit 2Y/3 = {limit:.6e} Pa")]
    BeyondYield {
        /// Which side.
        side: Side,
        /// |S_xx| [Pa].
        deviator: f64,
        /// 2Y/3 [Pa].
        limit: f64,
    },
    /// The plastic shock overtakes the elastic precursor: a single shock, which is not of this wave pattern.
    #[error(
        "the plastic shock on the {side} runs at {plastic:.2} m/s and overtakes its precursor at {elastic:.2} m/s"
    )]
    Overdriven {
        /// Which side.
        side: Side,
        /// Speed of the plastic shock [m/s].
        plastic: f64,
        /// Speed of the elastic precursor [m/s].
        elastic: f64,
    },
    /// The bodies fly apart faster than any finite tension can hold.
    #[error("the sides recede at {speed:.1} m/s: no contact stress below {limit:.3e} Pa holds them (vacuum)")]
    Vacuum {
        /// Velocity of recession [m/s].
        speed: f64,
        /// Largest stress tried [Pa].
        limit: f64,
    },
    /// The bodies collide faster than this solution reaches.
    #[error("the sides close at {speed:.1} m/s: no contact stress above {limit:.3e} Pa stops them")]
    Collapse {
        /// Closing velocity [m/s].
        speed: f64,
        /// Largest compression tried [Pa].
        limit: f64,
    },
}

/// A side of the contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// x < 0.
    Left,
    /// x > 0.
    Right,
}

impl Side {
    /// +1 where waves run to +x.
    fn direction(self) -> f64 {
        match self {
            Side::Left => -1.0,
            Side::Right => 1.0,
        }
    }
}

impl std::fmt::Display for Side {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Side::Left => "left",
            Side::Right => "right",
        })
    }
}

/// How a release is treated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Release {
    /// Isentropic fans: the true solution.
    #[default]
    Fan,
    /// Rarefaction jumps, as the paper prints them.
    Jump,
}

/// The solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Reference density ρ0 [kg/m³].
    pub density: f64,
    /// Bulk modulus B [Pa].
    pub bulk_modulus: f64,
    /// Shear modulus G [Pa].
    pub shear_modulus: f64,
    /// Yield strength Y [Pa].
    pub yield_strength: f64,
}

impl Solid {
    /// dσ/d ln V on the elastic branch, B + 4G/3 [Pa].
    fn elastic_modulus(&self) -> f64 {
        self.bulk_modulus + 4.0 / 3.0 * self.shear_modulus
    }

    /// Largest |S_xx|, 2Y/3 [Pa].
    fn deviator_limit(&self) -> f64 {
        2.0 / 3.0 * self.yield_strength
    }

    /// State of stress σ_xx at the compressive yield limit: S_xx = -2Y/3, P = -σ_xx - 2Y/3 (paper eq. (25)).
    pub fn at_compressive_yield(&self, stress: f64) -> State {
        let deviator = -self.deviator_limit();
        let density = self.density * ((deviator - stress) / self.bulk_modulus).exp();
        State { density, deviator, velocity: 0.0, stress }
    }

    /// State of stress σ_xx at rest that uniaxial loading from the undisturbed solid leads to: elastic up to the yield
    /// limit, at it beyond.
    pub fn loaded(&self, stress: f64) -> State {
        let strain = stress / self.elastic_modulus();
        let elastic = 4.0 / 3.0 * self.shear_modulus * strain;
        let limit = self.deviator_limit();
        if elastic.abs() <= limit {
            let density = self.density * (-strain).exp();
            return State { density, deviator: elastic, velocity: 0.0, stress };
        }
        let deviator = limit.copysign(stress);
        let density = self.density * ((deviator - stress) / self.bulk_modulus).exp();
        State { density, deviator, velocity: 0.0, stress }
    }

    /// The undisturbed state at rest.
    pub fn at_rest(&self) -> State {
        State { density: self.density, deviator: 0.0, velocity: 0.0, stress: 0.0 }
    }

    fn check(&self) -> Result<(), RiemannError> {
        let named = [
            ("density", self.density),
            ("bulk modulus", self.bulk_modulus),
            ("shear modulus", self.shear_modulus),
            ("yield strength", self.yield_strength),
        ];
        match named.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
            Some((name, value)) => Err(RiemannError::Parameter { name, value }),
            None => Ok(()),
        }
    }
}

/// State of the solid in uniaxial strain. `stress` = `deviator` - B ln(`density`/ρ0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Mass density ρ [kg/m³].
    pub density: f64,
    /// Stress deviator S_xx [Pa].
    pub deviator: f64,
    /// Velocity u along x [m/s].
    pub velocity: f64,
    /// Stress σ_xx [Pa].
    pub stress: f64,
}

/// Branch of the stress-strain curve that a wave follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// Inside the yield surface.
    Elastic,
    /// On the yield surface.
    Plastic,
}

/// One wave of the solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// The side it runs into.
    pub side: Side,
    /// The branch it follows.
    pub branch: Branch,
    /// Speed of its head in the laboratory frame [m/s].
    pub head: f64,
    /// Speed of its tail [m/s]; equal to `head` for a jump.
    pub tail: f64,
    /// State ahead.
    pub ahead: State,
    /// State behind.
    pub behind: State,
}

impl Wave {
    /// Stress half-way through the wave [Pa].
    pub fn middle_stress(&self) -> f64 {
        0.5 * (self.ahead.stress + self.behind.stress)
    }
}

/// The solution of one problem: self-similar in x/t.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Stress at the contact [Pa].
    pub contact_stress: f64,
    /// Velocity of the contact [m/s].
    pub contact_velocity: f64,
    /// Waves into the left state, fastest first.
    pub left: Vec<Wave>,
    /// Waves into the right state, fastest first.
    pub right: Vec<Wave>,
    initial: [State; 2],
    solid: Solid,
}

/// Solves the Riemann problem of two states of one solid.
///
/// # Errors
/// Numbers that make no solid or state; no contact stress at which both sides move alike; waves of one side that would
/// overtake each other. The message names the condition.
pub fn solve(solid: Solid, left: State, right: State, release: Release) -> Result<Solution, RiemannError> {
    solid.check()?;
    let curves =
        [Curve::new(solid, left, Side::Left, release)?, Curve::new(solid, right, Side::Right, release)?];
    let contact_stress = contact_stress(&curves)?;
    let [left_waves, right_waves] = [curves[0].waves(contact_stress), curves[1].waves(contact_stress)];
    check_order(&left_waves)?;
    check_order(&right_waves)?;
    Ok(Solution {
        contact_stress,
        contact_velocity: curves[1].velocity(contact_stress),
        left: left_waves,
        right: right_waves,
        initial: [left, right],
        solid,
    })
}

impl Solution {
    /// The state on the ray x/t [m/s].
    pub fn sample(&self, ray: f64) -> State {
        let (side, waves, undisturbed) = if ray < self.contact_velocity {
            (Side::Left, &self.left, self.initial[0])
        } else {
            (Side::Right, &self.right, self.initial[1])
        };
        let s = side.direction();
        // Waves are fastest first: the last one whose head has passed the ray decides.
        match waves.iter().rev().find(|wave| s * ray < s * wave.head) {
            None => undisturbed,
            Some(wave) if s * ray <= s * wave.tail => wave.behind,
            Some(wave) => self.inside_fan(wave, ray),
        }
    }

    /// All waves from left to right.
    pub fn waves(&self) -> impl Iterator<Item = &Wave> {
        self.left.iter().chain(self.right.iter().rev())
    }

    /// The ray x/t [m/s] on which a wave has its middle stress.
    pub fn middle_ray(&self, wave: &Wave) -> f64 {
        if wave.head == wave.tail {
            return wave.head;
        }
        // c = sqrt(K V) and σ is linear in ln V: the middle stress lies at the geometric mean of the densities.
        let density = (wave.ahead.density * wave.behind.density).sqrt();
        let [c, c_head] = [density, wave.ahead.density].map(|rho| (self.modulus(wave.branch) / rho).sqrt());
        wave.ahead.velocity + wave.side.direction() * (2.0 * c_head - c)
    }

    fn modulus(&self, branch: Branch) -> f64 {
        match branch {
            Branch::Elastic => self.solid.elastic_modulus(),
            Branch::Plastic => self.solid.bulk_modulus,
        }
    }

    /// Inside a fan u = s(x/t) - c and u + 2c is that of the head (in the direction of the wave).
    fn inside_fan(&self, wave: &Wave, ray: f64) -> State {
        let s = wave.side.direction();
        let modulus = self.modulus(wave.branch);
        let head_speed = (modulus / wave.ahead.density).sqrt();
        let c = s * wave.ahead.velocity + 2.0 * head_speed - s * ray;
        let density = modulus / (c * c);
        let strain = (wave.ahead.density / density).ln();
        let deviator = match wave.branch {
            Branch::Elastic => wave.ahead.deviator + 4.0 / 3.0 * self.solid.shear_modulus * strain,
            Branch::Plastic => wave.ahead.deviator,
        };
        State { density, deviator, velocity: ray - s * c, stress: wave.ahead.stress + modulus * strain }
    }
}

/// A plastic wave must not overtake its elastic wave.
fn check_order(waves: &[Wave]) -> Result<(), RiemannError> {
    let &[elastic, plastic] = waves else { return Ok(()) };
    let side = plastic.side;
    let s = side.direction();
    if s * plastic.head < s * elastic.tail {
        return Ok(());
    }
    Err(RiemannError::Overdriven { side, plastic: plastic.head, elastic: elastic.head })
}

#[cfg(test)]
mod tests;
