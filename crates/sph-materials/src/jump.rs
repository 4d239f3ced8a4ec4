//! Two states of matter and the wave between them: the Rankine-Hugoniot conditions.
//!
//! With `Σ = -σ_xx` and, in the frame of the matter ahead, `u_s = D - u_a` and
//! `Δu = u_b - u_a`:
//!
//! ```text
//! ρ_a u_s = ρ_b (u_s - Δu),      Σ_b - Σ_a = ρ_a u_s Δu,
//! ρ_a u_s (e_b - e_a + ½ Δu²) = Σ_b Δu
//! ```
//!
//! Mass and momentum are paper eqs. (28), (29).

/// A uniform state of matter in a plane wave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShockState {
    /// Mass density [kg/m³].
    pub density: f64,
    /// Velocity along the wave [m/s], positive in the direction of the wave.
    pub particle_velocity: f64,
    /// Longitudinal stress `σ_xx` [Pa], positive in tension.
    pub longitudinal_stress: f64,
    /// Mean pressure [Pa], positive in compression; in a medium with open pores `-σ_xx` stands here.
    pub pressure: f64,
    /// Specific internal energy [J/kg].
    pub specific_internal_energy: f64,
}

impl ShockState {
    /// Matter at rest, without stress and energy.
    pub fn at_rest(density: f64) -> Self {
        Self {
            density,
            particle_velocity: 0.0,
            longitudinal_stress: 0.0,
            pressure: 0.0,
            specific_internal_energy: 0.0,
        }
    }
}

/// A steady wave with the states ahead of it and behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// State that the wave runs into.
    pub ahead: ShockState,
    /// State that the wave leaves.
    pub behind: ShockState,
    /// Speed `D` of the wave [m/s] in the frame in which the velocities of both states are given.
    pub wave_speed: f64,
}

/// By how much a jump misses each conservation law, relative to the flux of the conserved quantity.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct JumpResiduals {
    /// Of mass [1].
    pub mass: f64,
    /// Of momentum [1].
    pub momentum: f64,
    /// Of energy [1].
    pub energy: f64,
}

impl JumpResiduals {
    /// Largest magnitude of the three; not a number where one of them is not.
    pub fn worst(&self) -> f64 {
        let larger = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
        [self.mass, self.momentum, self.energy].into_iter().map(f64::abs).fold(0.0, larger)
    }
}

impl Jump {
    /// Speed of the wave relative to the matter ahead, `u_s` [m/s].
    pub fn shock_velocity(&self) -> f64 {
        self.wave_speed - self.ahead.particle_velocity
    }

    /// Velocity that the wave gives to the matter, `Δu` [m/s].
    pub fn velocity_jump(&self) -> f64 {
        self.behind.particle_velocity - self.ahead.particle_velocity
    }

    /// Residuals of the three conservation laws.
    pub fn residuals(&self) -> JumpResiduals {
        let (ahead, behind) = (&self.ahead, &self.behind);
        let mass_flux = ahead.density * self.shock_velocity();
        let du = self.velocity_jump();
        let (sigma_a, sigma_b) = (-ahead.longitudinal_stress, -behind.longitudinal_stress);
        let gain = behind.specific_internal_energy - ahead.specific_internal_energy + 0.5 * du * du;
        JumpResiduals {
            mass: behind.density * (self.wave_speed - behind.particle_velocity) / mass_flux - 1.0,
            momentum: (sigma_b - sigma_a - mass_flux * du) / sigma_b,
            energy: (mass_flux * gain - sigma_b * du) / (sigma_b * du),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::JumpResiduals;

    #[test]
    fn the_worst_residual_hides_none_that_is_not_a_number() {
        let residuals = JumpResiduals { mass: 1e-3, momentum: -2e-3, energy: 0.0 };
        assert_eq!(residuals.worst(), 2e-3);
        for unknown in [
            JumpResiduals { mass: f64::NAN, ..residuals },
            JumpResiduals { momentum: f64::NAN, ..residuals },
            JumpResiduals { energy: f64::NAN, ..residuals },
        ] {
            assert!(unknown.worst().is_nan(), "{unknown:?}");
        }
    }
}
