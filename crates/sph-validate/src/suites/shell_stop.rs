//! The stop of a collapsing shell: what makes one, when it is one, how it is read from particles, and the mesh that is the
//! reference.

use sph_core::{Dim2, Particles};
use sph_materials::Material;

use crate::error::ValidateError;
use crate::reference::lagrangian::{Ends, Mesh, Pressure, Scheme, Solid, Symmetry, Viscosity, Zone};
use crate::reference::verney::Shell;
use crate::run::{Run, material};

const ZONES: usize = 400;

/// What makes a problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// The solid; it must have a yield strength.
    pub material: Material,
    /// Inner radius R0 [m].
    pub inner_radius: f64,
    /// Outer radius R1 [m].
    pub outer_radius: f64,
    /// Velocity U0 of the inner surface, inwards [m/s].
    pub velocity: f64,
}

/// When a stop is one.
#[derive(Clone, Copy, Debug)]
pub struct Times {
    /// The stop is not looked for before this time [s]: waves across the wall do not stop the shell.
    pub earliest: f64,
    /// How long both readings must have risen again [s].
    pub after: f64,
    /// A shell that still moves inwards now does not stop [s].
    pub latest: f64,
}

impl Setup {
    /// The published shell.
    ///
    /// # Errors
    /// If the library of materials does not have the shell's aluminum.
    pub fn published() -> Result<Self, ValidateError> {
        let material = material("aluminium-verney")?;
        Ok(Self { material, inner_radius: 0.08, outer_radius: 0.1, velocity: 208.55 })
    }

    /// The same shell of a rigid, perfectly plastic material.
    pub fn rigid_plastic(&self) -> Shell {
        Shell {
            inner_radius: self.inner_radius,
            outer_radius: self.outer_radius,
            density: self.material.reference_density,
            yield_strength: self.material.strength.yield_strength(),
        }
    }

    /// By the way to the rigid-plastic stop at the first speed, and by twice the time of a wave across the wall.
    pub fn times(&self) -> Times {
        let stop = self.rigid_plastic().stop_radius(self.velocity).unwrap_or(0.0);
        let way = (self.inner_radius - stop) / self.velocity;
        let sound = self.material.longitudinal_sound_speed(self.material.reference_density, 0.0);
        let crossing = (self.outer_radius - self.inner_radius) / sound;
        Times { earliest: 0.5 * way, after: 2.0 * crossing, latest: 8.0 * way + 20.0 * crossing }
    }

    /// Initial speed inwards [m/s] at radius `r` [m].
    pub fn speed(&self, r: f64) -> f64 {
        self.velocity * self.inner_radius / r
    }

    /// Thickness of the wall [m].
    pub fn wall(&self) -> f64 {
        self.outer_radius - self.inner_radius
    }
}

/// The least of a reading over time.
#[derive(Clone, Copy, Debug)]
pub struct Least {
    /// The least.
    pub value: f64,
    /// When it was [s].
    pub time: f64,
}

impl Least {
    const NONE: Self = Self { value: f64::INFINITY, time: 0.0 };

    /// Looks at a value at a time [s].
    pub fn see(&mut self, value: f64, time: f64) {
        if value < self.value {
            *self = Self { value, time };
        }
    }
}

/// Both readings of r² of the inner surface [m²], at their least.
pub struct Stop {
    /// From all of the material.
    pub all: Least,
    /// From its innermost layer.
    pub ring: Least,
}

impl Stop {
    /// Nothing read yet.
    pub const UNSEEN: Self = Self { all: Least::NONE, ring: Least::NONE };

    /// Whether both readings have risen for long enough.
    pub fn is_over(&self, time: f64, times: Times) -> bool {
        time > times.earliest && time > self.all.time.max(self.ring.time) + times.after
    }

    /// Inner radii [mm] from all of the material and from its innermost layer.
    pub fn radii(&self) -> [f64; 2] {
        [self.all, self.ring].map(|least| 1e3 * least.value.sqrt())
    }

    /// The numbers of the material are written out here, so that a fault of the library shows as an error.
    pub fn published(setup: &Setup, times: Times) -> Self {
        const DENSITY: f64 = 2785.0;
        let solid = Solid {
            pressure: &|density, energy| 5328.0 * 5328.0 * (density - DENSITY) + density * energy,
            shear_modulus: 27.6e9,
            yield_strength: 0.3e9,
            sound_speed: 6600.0,
        };
        Self::compute(setup, solid, DENSITY, times)
    }

    /// The mesh with the equation of state of the user's material.
    pub fn of(setup: &Setup, times: Times) -> Self {
        let material = &setup.material;
        let pressure: Pressure<'_> = &|density, energy| material.pressure(density, energy);
        let solid = Solid::of(material, pressure);
        Self::compute(setup, solid, material.reference_density, times)
    }

    fn compute(setup: &Setup, solid: Solid<'_>, density: f64, times: Times) -> Self {
        let scheme = Scheme {
            symmetry: Symmetry::Cylindrical,
            ends: Ends::Free,
            cfl: 0.7,
            viscosity: Viscosity::default(),
        };
        let rest = Zone { density, energy: 0.0, deviator: [0.0; 3] };
        let ends = [setup.inner_radius, setup.outer_radius];
        let mut mesh = Mesh::new(solid, scheme, ends, ZONES, |_| rest, |r| -setup.speed(r));
        let start = mesh.mean_square_radius();
        let mut stop = Self::UNSEEN;
        while !stop.is_over(mesh.time(), times) && mesh.time() < times.latest {
            mesh.step(mesh.time_step());
            stop.all.see(setup.inner_radius.powi(2) + mesh.mean_square_radius() - start, mesh.time());
            stop.ring.see(mesh.radius()[0].powi(2), mesh.time());
        }
        stop
    }
}

/// Reads r² of the inner surface from the particles: R0² and the change of the mean r², of all and of the innermost
/// ring. In an incompressible shell r² changes alike everywhere.
pub struct Reader {
    /// R0² [m²].
    inner_square: f64,
    /// The innermost ring has the first identifiers: how many.
    pub innermost: u64,
    /// Mean r² of all and of the innermost ring at the start [m²].
    start: [f64; 2],
}

impl Reader {
    pub fn new(particles: &Particles<Dim2>, inner_radius: f64) -> Self {
        let limit = square_radius(particles, 0) * (1.0 + 1e-9);
        let is_innermost = |i: &usize| square_radius(particles, *i) < limit;
        let innermost = (0..particles.len()).filter(is_innermost).count() as u64;
        let mut reader = Self { inner_square: inner_radius.powi(2), innermost, start: [0.0; 2] };
        reader.start = reader.means(particles);
        reader
    }

    /// Mean r² of all of the material and of its innermost ring [m²].
    pub fn means(&self, particles: &Particles<Dim2>) -> [f64; 2] {
        let (mut mass, mut all, mut ring) = (0.0, 0.0, 0.0);
        for i in 0..particles.len() {
            let square = square_radius(particles, i);
            mass += particles.mass[i];
            all += particles.mass[i] * square;
            if particles.id[i] < self.innermost {
                ring += square;
            }
        }
        [all / mass, ring / self.innermost as f64]
    }

    pub fn read(&self, run: &Run<'_, Dim2>, stop: &mut Stop) {
        let [all, ring] = self.means(run.simulation.particles());
        let time = run.simulation.time();
        stop.all.see(self.inner_square + all - self.start[0], time);
        stop.ring.see(self.inner_square + ring - self.start[1], time);
    }
}

pub fn square_radius(particles: &Particles<Dim2>, i: usize) -> f64 {
    particles.position[0][i].powi(2) + particles.position[1][i].powi(2)
}
