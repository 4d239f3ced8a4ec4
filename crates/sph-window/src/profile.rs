//! Moving means along x.
//!
//! Each particle is spread evenly over its own size along x. The running sums of mass, momentum, volume and stress over
//! all matter left of a node are then piecewise linear, and a mean over any length is a difference of two of them. The
//! nodes stand at most half a particle apart, and a whole number of them makes half a moving window, which is a whole
//! number of periods of the medium: a mean over it does not see the pores or the lattice go by.

use sph_core::dimension::Dimension;
use sph_core::particles::Particles;

/// Number of running sums.
const COLUMNS: usize = 4;

/// What lies between two places, per unit of x-projected cross-section where named so.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slab {
    /// Length of the slab [m].
    pub length: f64,
    /// Mass per area `∫ ρ dx` [kg/m²].
    pub mass: f64,
    /// Momentum along x per area `∫ ρ u_x dx` [Pa s].
    pub momentum: f64,
    /// Volume of the particles m/ρ per area `∫ dx` over the solid [m].
    pub volume: f64,
    /// Stress `∫ σ_xx dx` over the solid [Pa m].
    pub stress: f64,
}

impl Slab {
    /// Mass-weighted mean velocity along x [m/s].
    pub fn velocity(&self) -> f64 {
        self.momentum / self.mass
    }

    /// Packing density: mass per volume of space, pores included [kg/m³].
    pub fn packing_density(&self) -> f64 {
        self.mass / self.length
    }

    /// The particles' own density: mass per volume of the particles [kg/m³].
    pub fn own_density(&self) -> f64 {
        self.mass / self.volume
    }

    /// Mean stress `σ_xx` over space, zero in the pores [Pa].
    pub fn stress(&self) -> f64 {
        self.stress / self.length
    }
}

/// Moving means along x, from 0 to the length of the box, at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    spacing: f64,
    half_window: usize,
    length: f64,
    sums: Vec<[f64; COLUMNS]>,
}

impl Profile {
    /// The profile of particles with a stress `σ_xx` [Pa] in a box of a length [m] and a cross-section
    /// [m, m²], means taken over `window` [m], nodes at most `resolution` [m] apart.
    pub fn new<D: Dimension>(
        particles: &Particles<D>,
        stress: impl Fn(usize) -> f64,
        grid: Grid,
        cross_section: f64,
    ) -> Self {
        let half_window = (0.5 * grid.window / grid.resolution).ceil().max(1.0) as usize;
        let spacing = 0.5 * grid.window / half_window as f64;
        let nodes = (grid.length / spacing).floor() as usize + 1;
        let mut profile =
            Self { spacing, half_window, length: grid.length, sums: vec![[0.0; COLUMNS]; nodes] };
        for i in 0..particles.len() {
            let mass = particles.mass[i] / cross_section;
            let volume = mass / particles.density[i];
            let values = [mass, mass * particles.velocity[0][i], volume, volume * stress(i)];
            profile.deposit(particles.position[0][i], particles.size[i], values);
        }
        for node in 1..nodes {
            let before = profile.sums[node - 1];
            (0..COLUMNS).for_each(|c| profile.sums[node][c] += before[c]);
        }
        profile
    }

    /// Adds to each node what a particle adds to the running sum since the node before.
    fn deposit(&mut self, center: f64, width: f64, values: [f64; COLUMNS]) {
        let start = center - 0.5 * width;
        let first = (start / self.spacing).floor() + 1.0;
        let mut done = 0.0;
        for node in first.max(0.0) as usize..self.sums.len() {
            let part = ((node as f64 * self.spacing - start) / width).clamp(0.0, 1.0);
            (0..COLUMNS).for_each(|c| self.sums[node][c] += values[c] * (part - done));
            done = part;
            if part >= 1.0 {
                break;
            }
        }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.sums.len()
    }

    /// Never: a profile has two nodes at least.
    pub fn is_empty(&self) -> bool {
        self.sums.is_empty()
    }

    /// Distance between nodes [m].
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Place of a node [m].
    pub fn position(&self, node: usize) -> f64 {
        node as f64 * self.spacing
    }

    /// What the moving window around a node holds; at the ends of the box the part inside of it.
    pub fn around(&self, node: usize) -> Slab {
        let last = self.sums.len() - 1;
        let (low, high) = (node.saturating_sub(self.half_window), (node + self.half_window).min(last));
        self.difference(self.sums[low], self.sums[high], (high - low) as f64 * self.spacing)
    }

    /// What lies between two places [m].
    pub fn between(&self, from: f64, to: f64) -> Slab {
        self.difference(self.sum_at(from), self.sum_at(to), to - from)
    }

    fn difference(&self, low: [f64; COLUMNS], high: [f64; COLUMNS], length: f64) -> Slab {
        let [mass, momentum, volume, stress] = std::array::from_fn(|c| high[c] - low[c]);
        Slab { length, mass, momentum, volume, stress }
    }

    /// Running sums at a place, linear between the nodes.
    fn sum_at(&self, x: f64) -> [f64; COLUMNS] {
        let place = (x / self.spacing).clamp(0.0, (self.sums.len() - 1) as f64);
        let node = (place.floor() as usize).min(self.sums.len() - 2);
        let part = place - node as f64;
        std::array::from_fn(|c| (1.0 - part) * self.sums[node][c] + part * self.sums[node + 1][c])
    }

    /// Rightmost place [m] where the moving mean of `u_x`, coming from the right, rises through a level [m/s];
    /// `None` when it stays on one side. Empty windows count as below the level.
    pub fn rightmost_crossing(&self, level: f64) -> Option<f64> {
        let velocity = |node: usize| {
            let slab = self.around(node);
            if slab.mass > 0.0 { slab.velocity() } else { f64::NEG_INFINITY }
        };
        let mut right = velocity(self.sums.len() - 1);
        if right >= level {
            return None;
        }
        for node in (0..self.sums.len() - 1).rev() {
            let left = velocity(node);
            if left >= level {
                let part = if right.is_finite() { (left - level) / (left - right) } else { 0.0 };
                return Some((node as f64 + part) * self.spacing);
            }
            right = left;
        }
        None
    }
}

/// Where the nodes of a profile stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Length of the box [m].
    pub length: f64,
    /// Length of the moving window [m].
    pub window: f64,
    /// Largest distance between nodes [m].
    pub resolution: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feed::Feed;
    use crate::testing::lattice;
    use sph_core::dimension::{Dim2, Dim3};
    use sph_core::particles::Constraint;

    fn step_of_velocity<D: Dimension>(shift: f64) -> (Profile, f64) {
        let size = 1e-6;
        let sample = lattice::<D>(size, [10, 3, 3]);
        let cross_section = sample.cross_section();
        let mut feed = Feed::new(sample);
        feed.advance(-shift);
        let mut particles = Particles::default();
        feed.next_layer(1e-4, -500.0, Constraint::Free).for_each(|p| particles.push(p));
        // Material coordinate of the step: it moves with the particles.
        let front = 4e-5 - shift;
        for i in 0..particles.len() {
            if particles.position[0][i] < front {
                particles.velocity[0][i] = -300.0;
            }
        }
        let grid = Grid { length: 9e-5, window: 1e-5, resolution: 0.5e-6 };
        (Profile::new(&particles, |_| -2e8, grid, cross_section), front)
    }

    #[test]
    fn the_crossing_follows_the_matter_and_not_the_nodes() {
        for shift in [0.0, 0.13e-6, 0.77e-6, 1.9e-6] {
            let (profile, front) = step_of_velocity::<Dim2>(shift);
            let found = profile.rightmost_crossing(-400.0).unwrap();
            assert!((found - front).abs() < 1e-11, "{found} {front}");
            let (profile, front) = step_of_velocity::<Dim3>(shift);
            assert!((profile.rightmost_crossing(-400.0).unwrap() - front).abs() < 1e-11);
            assert_eq!(profile.rightmost_crossing(-299.0), None);
            assert_eq!(profile.rightmost_crossing(-501.0), None);
        }
    }

    #[test]
    fn means_are_those_of_the_lattice() {
        let (profile, _) = step_of_velocity::<Dim3>(0.3e-6);
        for slab in [profile.between(2.03e-5, 5.77e-5), profile.around(60), profile.around(profile.len() - 3)]
        {
            assert!((slab.packing_density() / 8960.0 - 1.0).abs() < 1e-12);
            assert!((slab.own_density() / 8960.0 - 1.0).abs() < 1e-12);
            assert!((slab.stress() / -2e8 - 1.0).abs() < 1e-12);
        }
        assert!((profile.between(6e-5, 8e-5).velocity() + 500.0).abs() < 1e-9);
        assert!(profile.spacing() <= 0.5e-6 && profile.position(2) == 2.0 * profile.spacing());
    }
}
