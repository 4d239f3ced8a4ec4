//! One-dimensional Lagrangian solution of an elastic-plastic solid on a staggered mesh, planar, cylindrical and spherical.
//!
//! Nodes carry r and u, zones carry ρ, e and the deviator (S_rr, S_θθ, S_zz). One step of the scheme, leapfrog in its
//! synchronous form:
//!
//! ```text
//! u^(n+1/2) = u^n + ½ τ f^n/m,      r^(n+1) = r^n + τ u^(n+1/2),
//! u^(n+1)   = u^(n+1/2) + ½ τ f^(n+1)/m
//! ```
//!
//! The strain rates of a zone of volume A (per unit area; per unit depth and radian; per steradian) at the half step
//! are D_rr = Δu/Δr and k D_θθ = d ln A/dt - D_rr, with k = 0, 1, 2 hoop directions in the plane, around an axis and
//! around a point. Nodal forces follow from virtual work, δW = (σ_rr δD_rr + k σ_θθ δD_θθ) A, so that the scheme
//! conserves momentum (planar) and its energy error is that of the time step alone. dS/dt = 2G (D - tr D/3) with von
//! Mises return; de = σ : D dt/ρ with the mean stress of the step. Second order in smooth flow; shocks need the artificial
//! viscosity, which is zero by default.
//!
//! Validity: no rotation (one dimension), constant shear modulus, surfaces free of traction or fixed.
//!
//! Source: M. L. Wilkins, Meth. Comput. Phys. 3 (1964) 211; A. A. Samarskii and Yu. P. Popov, Difference methods for
//! gas dynamics (1992).

mod zone;

use sph_materials::Material;

use zone::{Rates, advanced, area, viscous_pressure};

/// Pressure P(ρ, e) [Pa] from density [kg/m³] and specific internal energy [J/kg].
pub type Pressure<'a> = &'a (dyn Fn(f64, f64) -> f64 + Sync);

/// What the solver needs of a material.
#[derive(Clone, Copy)]
pub struct Solid<'a> {
    /// Equation of state.
    pub pressure: Pressure<'a>,
    /// Shear modulus G [Pa].
    pub shear_modulus: f64,
    /// Yield strength Y [Pa]; infinite for an elastic solid.
    pub yield_strength: f64,
    /// Upper estimate of the longitudinal sound speed [m/s]: sets the time step.
    pub sound_speed: f64,
}

impl<'a> Solid<'a> {
    /// The strength of a material beside its equation of state; a twentieth above its sound speed at rest, for what
    /// compression adds.
    pub fn of(material: &Material, pressure: Pressure<'a>) -> Self {
        Self {
            pressure,
            shear_modulus: material.strength.shear_modulus(),
            yield_strength: material.strength.yield_strength(),
            sound_speed: 1.05 * material.longitudinal_sound_speed(material.reference_density, 0.0),
        }
    }
}

/// Shape of the space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// Planes perpendicular to the coordinate; uniaxial strain.
    Planar,
    /// Cylinders around the axis r = 0; plane strain along the axis.
    Cylindrical,
    /// Spheres around the point r = 0.
    Spherical,
}

impl Symmetry {
    /// Number of hoop directions.
    fn hoops(self) -> i32 {
        match self {
            Self::Planar => 0,
            Self::Cylindrical => 1,
            Self::Spherical => 2,
        }
    }
}

/// Condition at both ends of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// Free of traction.
    Free,
    /// At rest.
    Fixed,
    /// The last node is the first one, a period further on (planar only).
    Periodic,
}

/// Artificial viscosity of compressed zones, q = ρ (c_q Δu² + c_l c |Δu|), for problems with shocks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Viscosity {
    /// Quadratic coefficient c_q [-]; 2 is usual.
    pub quadratic: f64,
    /// Linear coefficient c_l [-]; 0.1 to 0.5 is usual.
    pub linear: f64,
}

/// Choices of the scheme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Shape of the space.
    pub symmetry: Symmetry,
    /// Condition at both ends.
    pub ends: Ends,
    /// Courant number [-], below 1.
    pub cfl: f64,
    /// Artificial viscosity.
    pub viscosity: Viscosity,
}

/// Initial state of a zone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zone {
    /// Density ρ [kg/m³].
    pub density: f64,
    /// Specific internal energy e [J/kg].
    pub energy: f64,
    /// Deviator (S_rr, S_θθ, S_zz) [Pa]; S_yy in place of S_θθ in the plane, S_φφ in place of S_zz around a point.
    pub deviator: [f64; 3],
}

/// The mesh and its state at one time.
#[derive(Clone)]
pub struct Mesh<'a> {
    solid: Solid<'a>,
    scheme: Scheme,
    time: f64,
    radius: Vec<f64>,
    velocity: Vec<f64>,
    node_mass: Vec<f64>,
    force: Vec<f64>,
    zone_mass: Vec<f64>,
    zones: Vec<Zone>,
    viscous_pressure: Vec<f64>,
}

impl<'a> Mesh<'a> {
    /// A mesh of `zones` equal zones between two coordinates `ends` [m], with the state of each zone from its middle
    /// and the velocity [m/s] of each node from its place.
    pub fn new(
        solid: Solid<'a>,
        scheme: Scheme,
        ends: [f64; 2],
        zones: usize,
        state: impl Fn(f64) -> Zone,
        velocity: impl Fn(f64) -> f64,
    ) -> Self {
        let width = (ends[1] - ends[0]) / zones as f64;
        let radius: Vec<f64> = (0..=zones).map(|j| ends[0] + j as f64 * width).collect();
        let initial: Vec<Zone> = (0..zones).map(|k| state(radius[k] + 0.5 * width)).collect();
        let mut mesh = Self {
            solid,
            scheme,
            time: 0.0,
            velocity: radius.iter().map(|&r| velocity(r)).collect(),
            node_mass: vec![0.0; zones + 1],
            force: vec![0.0; zones + 1],
            zone_mass: vec![0.0; zones],
            viscous_pressure: vec![0.0; zones],
            zones: initial,
            radius,
        };
        mesh.lump_masses();
        mesh.hold_ends();
        mesh.compute_forces();
        mesh
    }

    /// Time [s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Coordinates of the nodes [m].
    pub fn radius(&self) -> &[f64] {
        &self.radius
    }

    /// Velocities of the nodes [m/s].
    pub fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    /// Middle of zone `k` [m].
    pub fn middle(&self, k: usize) -> f64 {
        0.5 * (self.radius[k] + self.radius[k + 1])
    }

    /// Stress σ_rr of zone `k`, without artificial viscosity [Pa].
    pub fn radial_stress(&self, k: usize) -> f64 {
        let zone = &self.zones[k];
        zone.deviator[0] - (self.solid.pressure)(zone.density, zone.energy)
    }

    /// Mass-weighted mean of r² over a cylindrical mesh [m²].
    pub fn mean_square_radius(&self) -> f64 {
        self.mean_power_of_radius(2)
    }

    /// Mass-weighted mean of r^d over the mesh [m^d], d = 2 around an axis and 3 around a point: (r1^d + r2^d)/2 of each
    /// zone is exact for uniform density.
    pub fn mean_power_of_radius(&self, d: i32) -> f64 {
        let power = |k: usize| 0.5 * (self.radius[k].powi(d) + self.radius[k + 1].powi(d));
        let sum: f64 = (0..self.zones.len()).map(|k| self.zone_mass[k] * power(k)).sum();
        sum / self.zone_mass.iter().sum::<f64>()
    }

    /// Kinetic and internal energy: per unit area in the plane [J/m²], per unit depth and radian around an axis [J/m], per
    /// steradian around a point [J].
    pub fn energy(&self) -> f64 {
        // The ends of a periodic mesh are one node: it counts once.
        let nodes = self.velocity.len() - usize::from(self.scheme.ends == Ends::Periodic);
        let pairs = self.node_mass.iter().zip(&self.velocity).take(nodes);
        let kinetic: f64 = pairs.map(|(m, u)| 0.5 * m * u * u).sum();
        let internal: f64 = self.zone_mass.iter().zip(&self.zones).map(|(m, zone)| m * zone.energy).sum();
        kinetic + internal
    }

    /// Velocity at `place` [m/s], linear between the nodes; zero outside of the body, repeated where it is periodic.
    pub fn velocity_at(&self, place: f64) -> f64 {
        interpolated(&self.radius, &self.velocity, self.scheme.ends == Ends::Periodic, place)
    }

    /// Advances to `end` [s].
    pub fn run_until(&mut self, end: f64) {
        while self.time < end {
            let remaining = end - self.time;
            // Equal last steps: a sliver of a step would only add round-off.
            let steps = (remaining / self.time_step()).ceil().max(1.0);
            self.step(remaining / steps);
            if steps <= 1.0 {
                self.time = end;
            }
        }
    }

    /// The longest stable step [s].
    pub fn time_step(&self) -> f64 {
        let narrowest = self.radius.windows(2).map(|r| r[1] - r[0]).fold(f64::INFINITY, f64::min);
        self.scheme.cfl * narrowest / self.solid.sound_speed
    }

    /// Advances by `tau` [s].
    pub fn step(&mut self, tau: f64) {
        self.kick(0.5 * tau);
        for (k, zone) in self.zones.iter_mut().enumerate() {
            let (r, u) = (&self.radius[k..k + 2], &self.velocity[k..k + 2]);
            let half = Rates::at_half_step(self.scheme.symmetry, r, u, tau);
            self.viscous_pressure[k] = viscous_pressure(&self.scheme, &self.solid, zone.density, u);
            *zone = advanced(zone, &self.solid, &half, self.viscous_pressure[k], tau);
        }
        for (r, u) in self.radius.iter_mut().zip(&self.velocity) {
            *r += tau * u;
        }
        for (k, zone) in self.zones.iter_mut().enumerate() {
            zone.density = self.zone_mass[k] / area(self.scheme.symmetry, &self.radius[k..k + 2]);
        }
        self.compute_forces();
        self.kick(0.5 * tau);
        self.time += tau;
    }

    fn kick(&mut self, tau: f64) {
        for ((u, f), m) in self.velocity.iter_mut().zip(&self.force).zip(&self.node_mass) {
            *u += tau * f / m;
        }
        self.hold_ends();
    }

    fn hold_ends(&mut self) {
        let last = self.velocity.len() - 1;
        match self.scheme.ends {
            Ends::Free => {}
            Ends::Fixed => (self.velocity[0], self.velocity[last]) = (0.0, 0.0),
            // Equal but for round-off of the initial velocities.
            Ends::Periodic => self.velocity[last] = self.velocity[0],
        }
    }

    /// Forces by virtual work.
    fn compute_forces(&mut self) {
        self.force.fill(0.0);
        for (k, zone) in self.zones.iter().enumerate() {
            let mean = -(self.solid.pressure)(zone.density, zone.energy) - self.viscous_pressure[k];
            let (radial, hoop) = (mean + zone.deviator[0], mean + zone.deviator[1]);
            let (r, hoops) = (&self.radius[k..k + 2], self.scheme.symmetry.hoops());
            // Of k σ_θθ D_θθ A = σ_θθ (dA/dt - A D_rr); dA/dt = r2^k u2 - r1^k u1.
            let lever = area(self.scheme.symmetry, r) / (r[1] - r[0]);
            self.force[k] += radial * lever + hoop * (r[0].powi(hoops) - lever);
            self.force[k + 1] -= radial * lever + hoop * (r[1].powi(hoops) - lever);
        }
        self.join_ends(|mesh| &mut mesh.force);
    }

    /// Gives both ends of a periodic mesh the sum of both: they are one node.
    fn join_ends(&mut self, column: impl Fn(&mut Self) -> &mut Vec<f64>) {
        if self.scheme.ends == Ends::Periodic {
            let column = column(self);
            let last = column.len() - 1;
            let sum = column[0] + column[last];
            (column[0], column[last]) = (sum, sum);
        }
    }

    /// Row sums of the linear finite element's mass matrix: second order up to the surface.
    fn lump_masses(&mut self) {
        for k in 0..self.zones.len() {
            let r = &self.radius[k..k + 2];
            let density = self.zones[k].density;
            let weights = match self.scheme.symmetry {
                Symmetry::Planar => [0.5, 0.5],
                Symmetry::Cylindrical => [(2.0 * r[0] + r[1]) / 6.0, (r[0] + 2.0 * r[1]) / 6.0],
                Symmetry::Spherical => {
                    let (first, both, last) = (r[0] * r[0], 2.0 * r[0] * r[1], r[1] * r[1]);
                    [(3.0 * first + both + last) / 12.0, (first + both + 3.0 * last) / 12.0]
                }
            };
            self.zone_mass[k] = density * area(self.scheme.symmetry, r);
            self.node_mass[k] += density * weights[0] * (r[1] - r[0]);
            self.node_mass[k + 1] += density * weights[1] * (r[1] - r[0]);
        }
        self.join_ends(|mesh| &mut mesh.node_mass);
    }
}

/// A column over the nodes at `place` [m], linear between them; zero outside of them, repeated where it is periodic.
pub(crate) fn interpolated(nodes: &[f64], column: &[f64], is_periodic: bool, place: f64) -> f64 {
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    let place = if is_periodic { first + (place - first).rem_euclid(last - first) } else { place };
    let j = nodes.partition_point(|&r| r <= place);
    if j == 0 || j == nodes.len() {
        return 0.0;
    }
    let weight = (place - nodes[j - 1]) / (nodes[j] - nodes[j - 1]);
    column[j - 1] + weight * (column[j] - column[j - 1])
}

#[cfg(test)]
mod tests;
