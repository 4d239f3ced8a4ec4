//! Profiles averaged in the frame of the front.
//!
//! ξ = x - x_f is cut into bins. At each look every particle is spread evenly over its own size along x, and the bins
//! collect mass, momentum, volume, stress and energy, weighted by the time since the last look. A bin counts only while
//! it lies wholly within the free flow. Velocities are relative to the medium ahead at rest: u = u_x + u_b, with the
//! velocity u_b at which the medium enters.

use serde::{Deserialize, Serialize};
use sph_core::{Dim2, Particles};
use sph_window::Window;

/// Number of sums in a bin.
const SUMS: usize = 9;

/// Where the bins stand: `behind` of them at ξ < 0, `ahead` at ξ > 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ProfileGrid {
    /// Width of a bin [m].
    pub bin: f64,
    /// Bins behind the front.
    pub behind: usize,
    /// Bins ahead of the front.
    pub ahead: usize,
}

impl ProfileGrid {
    /// Bins of a width [m] for a front anywhere in a box of a length [m].
    pub fn new(bin: f64, length: f64) -> Self {
        let count = (length / bin).ceil() as usize;
        Self { bin, behind: count, ahead: count }
    }

    fn len(&self) -> usize {
        self.behind + self.ahead
    }

    /// Left end ξ of a bin [m].
    fn left(&self, bin: usize) -> f64 {
        (bin as f64 - self.behind as f64) * self.bin
    }
}

/// Sums over time and space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Sums {
    time: f64,
    values: [f64; SUMS],
}

/// A profile under way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct FrontProfile {
    grid: ProfileGrid,
    cross_section: f64,
    sums: Vec<Sums>,
    looks: usize,
}

/// Mean values of a bin, or of several.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bin {
    /// Middle ξ relative to the front [m].
    pub place: f64,
    /// Density of the packing: mass per volume of space [kg/m³].
    pub packing_density: f64,
    /// The particles' own density: mass per volume of the particles [kg/m³]; `NaN` in a void.
    pub own_density: f64,
    /// σ_xx over space, zero in the pores [Pa].
    pub stress: f64,
    /// P over space, zero in the pores [Pa].
    pub pressure: f64,
    /// u_x relative to the medium at rest ahead, weighted by mass [m/s].
    pub velocity: f64,
    /// Specific internal energy [J/kg].
    pub internal_energy: f64,
    /// Kinetic energy of the motion relative to the mean one [J/kg].
    pub fluctuation_energy: f64,
    /// Momentum flux of that motion along x, ρ⟨u'_x²⟩ [Pa].
    pub fluctuation_stress: f64,
    /// Energy flux of that motion along x: sound, and heat that jets carry,
    /// q = ρ⟨u'_x (e' + ½U'²)⟩ - ⟨σ'_xx u'_x + σ'_xy u'_y⟩ [W/m²]; negative where it leaves the front backwards.
    pub fluctuation_energy_flux: f64,
}

/// What acts in a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matter {
    /// Traction on a plane across x: σ_xx, σ_xy [Pa].
    pub stress: [f64; 2],
    /// P [Pa].
    pub pressure: f64,
}

/// One moment: where the front is, how the medium comes in, where the flow is free, and for how long it stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Place of the front [m].
    pub front: f64,
    /// Velocity u_b at which the medium comes in [m/s].
    pub inlet_velocity: f64,
    /// The free flow [m].
    pub flow: (f64, f64),
    /// Time since the last look [s].
    pub weight: f64,
}

impl FrontProfile {
    /// An empty profile of a box with a cross-section [m].
    pub fn new(grid: ProfileGrid, cross_section: f64) -> Self {
        Self { grid, cross_section, sums: vec![Sums::default(); grid.len()], looks: 0 }
    }

    /// Adds the window's present state, which stands for `weight` [s].
    pub fn observe(&mut self, window: &Window<Dim2>, front: f64, weight: f64) {
        let (simulation, regions) = (window.simulation(), window.regions());
        let flow = (regions.outlet_end, regions.inlet_start);
        let look = Look { front, inlet_velocity: window.inlet_velocity(), flow, weight };
        let matter = |i: usize| {
            let [stress_xx, _, _, stress_xy] = simulation.stress(i);
            Matter { stress: [stress_xx, stress_xy], pressure: simulation.pressure(i) }
        };
        self.add(simulation.particles(), matter, look);
    }

    /// Adds particles with what acts in them.
    pub fn add(&mut self, particles: &Particles<Dim2>, matter: impl Fn(usize) -> Matter, look: Look) {
        let inside = self.bins_within(look);
        if look.weight <= 0.0 || inside.is_empty() {
            return;
        }
        self.looks += 1;
        self.sums[inside.clone()].iter_mut().for_each(|s| s.time += look.weight);
        for i in 0..particles.len() {
            let (place, size) = (particles.position[0][i] - look.front, particles.size[i]);
            let (low, high) = (place - 0.5 * size, place + 0.5 * size);
            if high <= self.grid.left(inside.start) || low >= self.grid.left(inside.end) {
                continue;
            }
            let values = contents(particles, i, matter(i), look.inlet_velocity);
            self.deposit(low, high, &values, look.weight, &inside);
        }
    }

    /// Bins that lie wholly within the free flow.
    fn bins_within(&self, look: Look) -> std::ops::Range<usize> {
        let bin_of = |x: f64| (x - look.front) / self.grid.bin + self.grid.behind as f64;
        let first = bin_of(look.flow.0).ceil().max(0.0) as usize;
        let end = bin_of(look.flow.1).floor().clamp(0.0, self.grid.len() as f64) as usize;
        first..end.max(first)
    }

    fn deposit(
        &mut self,
        low: f64,
        high: f64,
        values: &[f64; SUMS],
        weight: f64,
        inside: &std::ops::Range<usize>,
    ) {
        let bin_of = |xi: f64| (xi / self.grid.bin).floor() + self.grid.behind as f64;
        let first = bin_of(low).max(inside.start as f64) as usize;
        let last = (bin_of(high).max(0.0) as usize).min(inside.end - 1);
        for bin in first..=last {
            let left = self.grid.left(bin);
            let part = ((left + self.grid.bin).min(high) - left.max(low)) / (high - low);
            if part > 0.0 {
                let sums = &mut self.sums[bin].values;
                (0..SUMS).for_each(|k| sums[k] += weight * part * values[k]);
            }
        }
    }

    /// Adds another profile on the same grid.
    pub fn merge(&mut self, other: &Self) {
        self.looks += other.looks;
        for (mine, theirs) in self.sums.iter_mut().zip(&other.sums) {
            mine.time += theirs.time;
            (0..SUMS).for_each(|k| mine.values[k] += theirs.values[k]);
        }
    }

    /// Number of looks.
    pub fn looks(&self) -> usize {
        self.looks
    }

    /// Bins that were within the free flow for nine tenths of the time: (first, behind the last).
    pub fn covered(&self) -> (usize, usize) {
        let longest = self.sums.iter().map(|s| s.time).fold(0.0, f64::max);
        let good = |s: &Sums| longest > 0.0 && s.time >= 0.9 * longest;
        let first = self.sums.iter().position(good).unwrap_or(0);
        let end = self.sums.iter().rposition(good).map_or(first, |last| last + 1);
        (first, end)
    }

    /// Range of ξ that is covered [m].
    pub fn range(&self) -> (f64, f64) {
        let (first, end) = self.covered();
        (self.grid.left(first), self.grid.left(end))
    }

    /// Mean values of each covered bin, from behind to ahead.
    pub fn bins(&self) -> Vec<Bin> {
        let (first, end) = self.covered();
        (first..end).map(|bin| self.mean(bin, bin + 1)).collect()
    }

    /// Mean values between two places ξ [m], over whole bins; `None` without a bin.
    pub fn between(&self, from: f64, to: f64) -> Option<Bin> {
        let (first, end) = self.covered();
        let index = |xi: f64| xi / self.grid.bin + self.grid.behind as f64;
        let low = ((index(from) - 1e-9).ceil().max(0.0) as usize).max(first);
        let high = ((index(to) + 1e-9).floor().max(0.0) as usize).min(end);
        (high > low).then(|| self.mean(low, high))
    }

    fn mean(&self, low: usize, high: usize) -> Bin {
        let mut sum = Sums::default();
        for s in &self.sums[low..high] {
            sum.time += s.time;
            (0..SUMS).for_each(|k| sum.values[k] += s.values[k]);
        }
        let [mass, momentum, volume, stress, pressure, internal, kinetic, flux, energy_flux] = sum.values;
        let space = sum.time * self.grid.bin * self.cross_section;
        let velocity = momentum / mass;
        let fluctuation_flux = (flux - momentum * velocity).max(0.0);
        // What the mean motion carries and works; the rest of the flux belongs to the motion about the mean.
        let of_means = velocity * (internal + kinetic - stress + fluctuation_flux);
        Bin {
            place: 0.5 * (self.grid.left(low) + self.grid.left(high)),
            packing_density: mass / space,
            own_density: mass / volume,
            stress: stress / space,
            pressure: pressure / space,
            velocity,
            internal_energy: internal / mass,
            fluctuation_energy: (kinetic / mass - 0.5 * velocity * velocity).max(0.0),
            fluctuation_stress: fluctuation_flux / space,
            fluctuation_energy_flux: (energy_flux - of_means) / space,
        }
    }
}

/// Mass, momentum, volume, stress and pressure times volume, internal and kinetic energy, momentum times velocity, energy
/// flux times volume.
fn contents(particles: &Particles<Dim2>, i: usize, matter: Matter, inlet_velocity: f64) -> [f64; SUMS] {
    let mass = particles.mass[i];
    let volume = mass / particles.density[i];
    let (u, v) = (particles.velocity[0][i] + inlet_velocity, particles.velocity[1][i]);
    let internal = mass * particles.specific_internal_energy[i];
    let kinetic = 0.5 * mass * (u * u + v * v);
    let [stress, shear] = matter.stress;
    let energy_flux = (internal + kinetic) * u - volume * (stress * u + shear * v);
    [
        mass,
        mass * u,
        volume,
        volume * stress,
        volume * matter.pressure,
        internal,
        kinetic,
        mass * u * u,
        energy_flux,
    ]
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use glam::DVec2;
    use sph_core::Particle;

    /// Matter of density `behind` with velocity `piston` left of the front, `ahead` at rest right of it, in a frame
    /// that moves with `inlet`.
    pub fn step(front: f64, densities: (f64, f64), piston: f64, inlet: f64) -> Particles<Dim2> {
        let mut particles = Particles::default();
        for column in 0..200 {
            for row in 0..4 {
                let position = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                let is_behind = position.x < front;
                let density = if is_behind { densities.0 } else { densities.1 };
                let mut p =
                    Particle::<Dim2>::at_rest((4 * column + row) as u64, position, density, 1.0, density);
                p.velocity.x = if is_behind { piston } else { 0.0 } - inlet;
                p.specific_internal_energy = if is_behind { 0.5 * piston * piston } else { 0.0 };
                particles.push(p);
            }
        }
        particles
    }

    pub fn profile_of_step() -> FrontProfile {
        let mut profile = FrontProfile::new(ProfileGrid::new(2.0, 200.0), 4.0);
        for (front, inlet) in [(100.0, 900.0), (103.0, 880.0), (98.0, 910.0)] {
            let particles = step(front, (9000.0, 6600.0), 250.0, inlet);
            let look = Look { front, inlet_velocity: inlet, flow: (8.0, 196.0), weight: 1.0 };
            let behind = |i: usize| particles.position[0][i] < front;
            let matter = |i: usize| {
                let (stress, pressure) = if behind(i) { (-1.8e9, 1.7e9) } else { (-0.2e9, 0.1e9) };
                Matter { stress: [stress, 0.0], pressure }
            };
            profile.add(&particles, matter, look);
        }
        profile
    }

    #[test]
    fn a_moving_step_is_sharp_in_the_frame_of_the_front() {
        let profile = profile_of_step();
        assert_eq!(profile.looks(), 3);
        for bin in profile.bins() {
            let (density, velocity, stress) =
                if bin.place < 0.0 { (9000.0, 250.0, -1.8e9) } else { (6600.0, 0.0, -0.2e9) };
            assert!((bin.packing_density / density - 1.0).abs() < 1e-12, "{bin:?}");
            assert!((bin.own_density / density - 1.0).abs() < 1e-12);
            assert!((bin.velocity - velocity).abs() < 1e-9 && (bin.stress / stress - 1.0).abs() < 1e-12);
            assert!(bin.fluctuation_energy < 1e-9 * 31_250.0);
        }
        let (low, high) = profile.range();
        assert!((low - -90.0).abs() < 3.0 && (high - 93.0).abs() < 3.0, "{low} {high}");
    }

    #[test]
    fn a_sound_wave_in_the_means_shows_the_flux_that_it_carries() {
        // Layers with u' = ±w and σ' = ±Z w, a wave towards -x: the flux is -Z w² of sound, and of shear ∓ likewise.
        let (w, impedance) = (2.0, 4.0e7);
        let mut particles = step(0.0, (9000.0, 9000.0), 0.0, 900.0);
        particles.specific_internal_energy.iter_mut().for_each(|e| *e = 5.0e4);
        let sign = |i: usize| if (i / 4).is_multiple_of(2) { 1.0 } else { -1.0 };
        for i in 0..particles.len() {
            particles.velocity[0][i] += 300.0 + w * sign(i);
            particles.velocity[1][i] += w * sign(i);
        }
        let matter = |i: usize| Matter {
            stress: [-2.0e9 + impedance * w * sign(i), 0.5 * impedance * w * sign(i)],
            pressure: 2.0e9,
        };
        let mut profile = FrontProfile::new(ProfileGrid::new(2.0, 200.0), 4.0);
        profile.add(
            &particles,
            matter,
            Look { front: 100.0, inlet_velocity: 900.0, flow: (8.0, 196.0), weight: 1.0 },
        );
        let bin = profile.between(-50.0, 50.0).unwrap();
        // ½U'² and ρ⟨u'²⟩ change sign with u' or are carried by the mean: only the work of the waves is left.
        let exact = -1.5 * impedance * w * w;
        assert!((bin.fluctuation_energy_flux / exact - 1.0).abs() < 1e-6, "{bin:?} {exact}");
        assert!((bin.fluctuation_energy / (w * w) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn means_of_a_range_weigh_by_mass() {
        let profile = profile_of_step();
        let all = profile.between(-20.0, 20.0).unwrap();
        assert!((all.packing_density - 7800.0).abs() < 1e-8);
        assert!((all.velocity - 250.0 * 9000.0 / 15600.0).abs() < 1e-9);
        assert_eq!(profile.between(500.0, 600.0), None);
        let mut double = profile.clone();
        double.merge(&profile);
        assert_eq!(double.looks(), 6);
        assert!((double.between(-20.0, 20.0).unwrap().velocity - all.velocity).abs() < 1e-9);
    }
}
