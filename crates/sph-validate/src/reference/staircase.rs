//! Steady plane waves ahead of a piston as a staircase of uniform states: exact profiles of stress and velocity.
//!
//! The speeds and states of the waves are those of [`sph_materials::hugoniot`], which knows no particles: jump conditions
//! at each wave, elastic precursor and plastic shock, or one overdriven shock. Here they become σ(x, t) and u(x, t) of a
//! piston that starts at x = 0, t = 0 and pushes towards +x.

use sph_materials::hugoniot::{PistonWaves, piston};
use sph_materials::{HugoniotError, Jump, Material};

/// Waves ahead of a piston, the fastest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Staircase {
    waves: Vec<Jump>,
    piston_velocity: f64,
}

/// Stress and velocity at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// σ_xx [Pa], positive in tension.
    pub stress: f64,
    /// u [m/s].
    pub velocity: f64,
}

impl Staircase {
    /// The waves ahead of a piston of a velocity [m/s] in a solid at rest.
    ///
    /// # Errors
    ///
    /// Those of [`piston`]: it does not push, or is too fast for the equation of state.
    pub fn new(material: &Material, piston_velocity: f64) -> Result<Self, HugoniotError> {
        let waves = match piston(material, piston_velocity)? {
            PistonWaves::Fluid { shock } | PistonWaves::Overdriven { shock } => vec![shock],
            PistonWaves::Elastic { wave } => vec![wave],
            PistonWaves::TwoWave { precursor, plastic } => vec![precursor, plastic],
        };
        Ok(Self { waves, piston_velocity })
    }

    /// The waves, the fastest first.
    pub fn waves(&self) -> &[Jump] {
        &self.waves
    }

    /// State at the piston.
    pub fn last(&self) -> Sample {
        self.waves.last().map_or(Sample { stress: 0.0, velocity: 0.0 }, behind)
    }

    /// State on the ray x/t [m/s]; at the piston behind it.
    pub fn sample(&self, ray: f64) -> Sample {
        let passed = self.waves.iter().rev().find(|wave| ray < wave.wave_speed);
        passed.map_or(Sample { stress: 0.0, velocity: 0.0 }, behind)
    }

    /// Points of the profile at a time [s]: place [m] and state, each step as two points; from the piston to `end` [m].
    pub fn profile(&self, time: f64, end: f64) -> Vec<(f64, Sample)> {
        let mut points = vec![(self.piston_velocity * time, self.last())];
        for wave in self.waves.iter().rev() {
            let place = wave.wave_speed * time;
            points.push((place, behind(wave)));
            points.push((place, self.sample(wave.wave_speed)));
        }
        points.push((end, Sample { stress: 0.0, velocity: 0.0 }));
        points
    }
}

fn behind(wave: &Jump) -> Sample {
    Sample { stress: wave.behind.longitudinal_stress, velocity: wave.behind.particle_velocity }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::mean_absolute_difference;
    use crate::reference::lagrangian::{Ends, Mesh, Scheme, Solid, Symmetry, Viscosity, Zone};
    use sph_materials::{Strength, library};

    #[test]
    fn steps_stand_where_the_waves_are() {
        let copper = library::material("porous-copper").expect("in the library");
        let stairs = Staircase::new(&copper, 200.0).expect("two waves");
        let [precursor, plastic] = stairs.waves() else { panic!("{stairs:?}") };
        assert!(precursor.wave_speed > plastic.wave_speed);
        assert_eq!(stairs.sample(1.001 * precursor.wave_speed).stress, 0.0);
        let between = 0.5 * (precursor.wave_speed + plastic.wave_speed);
        assert_eq!(stairs.sample(between).velocity, precursor.behind.particle_velocity);
        assert_eq!(stairs.sample(0.0), stairs.last());
        assert!((stairs.last().velocity - 200.0).abs() < 1e-6);
        let places: Vec<f64> = stairs.profile(1e-6, 1e-2).iter().map(|point| point.0).collect();
        assert!(places.is_sorted() && places.len() == 6, "{places:?}");
    }

    /// Two solvers that share nothing: jump conditions, and the mesh on which copper runs into a wall.
    #[test]
    fn mesh_reproduces_the_staircase() {
        let mut copper = library::material("porous-copper").expect("in the library");
        let Strength::PerfectPlastic { shear_modulus, yield_strength } = copper.strength else {
            panic!("{copper:?}")
        };
        copper.failure = sph_materials::Failure::None;
        let (stairs, time, speed) = (Staircase::new(&copper, 200.0).expect("two waves"), 2e-6, 200.0);
        let pressure = |density: f64, energy: f64| copper.pressure(density, energy);
        let solid = Solid { pressure: &pressure, shear_modulus, yield_strength, sound_speed: 5200.0 };
        let viscosity = Viscosity { quadratic: 2.0, linear: 0.2 };
        let scheme = Scheme { symmetry: Symmetry::Planar, ends: Ends::Fixed, cfl: 0.5, viscosity };
        let rest = Zone { density: 8960.0, energy: 0.0, deviator: [0.0; 3] };
        let errors = [500, 1000, 2000].map(|zones| {
            let mut mesh = Mesh::new(solid, scheme, [0.0, 0.02], zones, |_| rest, |_| -speed);
            mesh.run_until(time);
            // In the frame of the wall the copper ahead moves; what the far end sends in stays beyond x = 9.6 mm.
            let near = (0..zones).filter(|&k| mesh.middle(k) < 9.5e-3 - speed * time);
            let exact = |k: usize| stairs.sample(mesh.middle(k) / time + speed).stress;
            mean_absolute_difference(near.map(|k| (1e-9 * mesh.radial_stress(k), 1e-9 * exact(k))))
        });
        println!("copper into a wall at 200 m/s, L1 of stress [GPa]: {errors:?}");
        assert!(
            errors[2] < 0.03 && errors[1] < 0.75 * errors[0] && errors[2] < 0.75 * errors[1],
            "{errors:?}"
        );
    }
}
