//! The inlet: the medium enters with an imposed velocity `-u_b`.
//!
//! With [`InletKind::FixedVelocity`] `u_b = u_in`: the elastic precursor that runs ahead of the compaction wave
//! is reflected, as from a rigid wall that moves with the medium. With [`InletKind::ImpedanceMatched`] the medium ahead
//! of the front gets the velocity `-u_a`,
//!
//! ```text
//! u_a = u_in - δ,      δ = σ_b / Z,      Z = ρ00 c
//! ```
//!
//! with the compressive stress `σ_b` that arrives, averaged over the layer just inside of the inlet: the
//! relation of a simple wave towards +x, so that the precursor leaves. What is fed is still undisturbed, of density
//! `ρ00`, while the medium inside is compressed to `ρ00/(1 - δ/c)` by the wave: for the
//! same mass flux it must come in faster,
//!
//! ```text
//! u_b = u_a/(1 - δ/c)
//! ```
//!
//! The last step to `u_a` then compresses it at the edge of the inlet to just the stress of the precursor. Without
//! it the medium ahead would be slower by `u_b δ/c` than intended: 17 m/s in solid copper.
//!
//! `σ_b` is the mean of `-σ_xx` over space, pores included, over whole periods of the medium,
//! smoothed in time over the time that a wave needs for that layer. Its sign is kept: a tensile wave leaves likewise.
//! `wave_speed` c is that of the precursor; when it is not given, the longitudinal sound speed of the matter in the
//! layer stands for it, which is right for a medium without pores and too stiff for a porous one. There the precursor is
//! a ramp that spreads: in porous copper of m = 1.35 (pores of 4 µm, D = 1 µm) the ratio
//! `σ / (ρ00 δ)` falls from 2.8 km/s at its head to below 2 km/s near the front, so that no single
//! speed fits, and a part is reflected. What is reported (feed velocity, stress, profile) is what the window does, not what
//! a perfect match would do.

use crate::ledger::{Content, impose_velocity};
use crate::region::Regions;
use serde::{Deserialize, Serialize};
use sph_core::dimension::Dimension;
use sph_core::particles::{Constraint, Particles};

/// What is imposed where the medium enters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum InletKind {
    /// The velocity of the frame; reflects the precursor.
    #[default]
    FixedVelocity,
    /// The velocity behind a wave that leaves; lets the precursor out.
    ImpedanceMatched {
        /// Speed c of the precursor in the medium [m/s]; by default that of longitudinal sound in the matter.
        #[serde(default)]
        wave_speed: Option<f64>,
    },
}

/// State of the inlet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct InletState {
    /// Smoothed compressive stress `σ_b` that arrives [Pa].
    pub stress: f64,
    /// `δ = u_in - u_a` [m/s].
    pub deficit: f64,
    /// `δ/c = 1 - ρ00/ρ` of the medium ahead [-].
    pub compression: f64,
}

impl InletState {
    /// Takes a measured layer in, `elapsed` [s] after the last one.
    pub(crate) fn update(&mut self, layer: &Layer, elapsed: f64) {
        let weight = 1.0 - (-elapsed * layer.wave_speed / layer.length).exp();
        self.stress += weight * (-layer.stress - self.stress);
        self.deficit = self.stress / (layer.medium_density * layer.wave_speed);
        self.compression = self.deficit / layer.wave_speed;
    }

    /// Velocity `u_a` of the medium ahead of the front for a velocity `u_in` of the undisturbed one [m/s].
    pub fn ahead_velocity(&self, frame_velocity: f64) -> f64 {
        frame_velocity - self.deficit
    }

    /// Velocity `u_b` with which the medium is fed [m/s].
    pub fn feed_velocity(&self, frame_velocity: f64) -> f64 {
        self.ahead_velocity(frame_velocity) / (1.0 - self.compression)
    }
}

/// What the layer just inside of the inlet holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layer {
    /// Length along x [m].
    pub length: f64,
    /// Mean density of the undisturbed medium `ρ00` [kg/m³].
    pub medium_density: f64,
    /// Mean stress `σ_xx` over space [Pa].
    pub stress: f64,
    /// Speed of the wave that arrives [m/s].
    pub wave_speed: f64,
}

impl Layer {
    /// Measures the layer of a length [m] left of `end` [m]. `matter` gives the stress [Pa] and the longitudinal sound
    /// speed [m/s] of a particle.
    pub fn measure<D: Dimension>(
        particles: &Particles<D>,
        matter: impl Fn(usize) -> (f64, f64),
        place: LayerPlace,
        wave_speed: Option<f64>,
    ) -> Self {
        let LayerPlace { end, length, cross_section, medium_density } = place;
        let (mut mass, mut stress, mut speed) = (0.0, 0.0, 0.0);
        for i in 0..particles.len() {
            let (x, half) = (particles.position[0][i], 0.5 * particles.size[i]);
            let overlap = (x + half).min(end) - (x - half).max(end - length);
            if overlap > 0.0 {
                let part = particles.mass[i] * overlap / particles.size[i];
                let (sigma_xx, c_l) = matter(i);
                mass += part;
                stress += part / particles.density[i] * sigma_xx;
                speed += part * c_l;
            }
        }
        let wave_speed = wave_speed.unwrap_or(if mass > 0.0 { speed / mass } else { f64::INFINITY });
        Self { length, medium_density, stress: stress / (length * cross_section), wave_speed }
    }
}

/// Where a [`Layer`] is, and in which medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LayerPlace {
    /// Right end [m].
    pub end: f64,
    /// Length along x [m].
    pub length: f64,
    /// Area across x [m, m²].
    pub cross_section: f64,
    /// Mean density of the undisturbed medium [kg/m³].
    pub medium_density: f64,
}

/// Frees the particles that have left the inlet region.
pub(crate) fn release<D: Dimension>(particles: &mut Particles<D>, regions: &Regions) {
    for i in 0..particles.len() {
        let x = particles.position[0][i];
        if particles.constraint[i] == Constraint::ImposedVelocity
            && x < regions.inlet_start
            && x > regions.middle()
        {
            particles.constraint[i] = Constraint::Free;
        }
    }
}

/// Gives the particles of the inlet the velocity `-u_b` [m/s]; returns the momentum and energy put in.
pub(crate) fn impose<D: Dimension>(
    particles: &mut Particles<D>,
    regions: &Regions,
    inlet_velocity: f64,
) -> Content {
    let mut sum = Content::default();
    let velocity = D::vector(|axis| if axis == 0 { -inlet_velocity } else { 0.0 });
    for i in 0..particles.len() {
        let imposed = particles.constraint[i] == Constraint::ImposedVelocity;
        if imposed && particles.position[0][i] > regions.middle() && particles.velocity_of(i) != velocity {
            sum += impose_velocity(particles, i, velocity);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::region::RegionWidths;
    use crate::testing::lattice;
    use sph_core::dimension::Dim2;

    fn measured(wave_speed: Option<f64>) -> Layer {
        let sample = lattice::<Dim2>(1e-6, [40, 3, 1]);
        let place = LayerPlace { end: 3.02e-5, length: 8e-6, cross_section: 3e-6, medium_density: 8960.0 };
        Layer::measure(sample.particles(), |_| (-0.8e9, 4674.0), place, wave_speed)
    }

    #[test]
    fn the_layer_is_measured_over_space() {
        let layer = measured(None);
        assert!((layer.stress / -0.8e9 - 1.0).abs() < 1e-12, "{layer:?}");
        assert!((layer.wave_speed - 4674.0).abs() < 1e-9);
        assert_eq!(measured(Some(2600.0)).wave_speed, 2600.0);
    }

    #[test]
    fn the_deficit_is_that_of_a_simple_wave() {
        let mut inlet = InletState::default();
        for _ in 0..200 {
            inlet.update(&measured(None), 1e-10);
        }
        let exact = 0.8e9 / (8960.0 * 4674.0);
        assert!((inlet.deficit / exact - 1.0).abs() < 1e-4, "{} {exact}", inlet.deficit);
        let (ahead, feed) = (inlet.ahead_velocity(900.0), inlet.feed_velocity(900.0));
        let compressed = 1.0 / (1.0 - exact / 4674.0);
        assert!((ahead - (900.0 - exact)).abs() < 0.01 && (feed / ahead / compressed - 1.0).abs() < 1e-6);
    }

    #[test]
    fn released_particles_are_free_and_imposed_ones_booked() {
        let mut particles = lattice::<Dim2>(1e-6, [40, 2, 1]).particles().clone();
        let regions = Regions::new(4e-5, &RegionWidths::default(), 1e-6);
        particles.constraint.fill(Constraint::ImposedVelocity);
        release(&mut particles, &regions);
        let of =
            |x: f64| (0..particles.len()).find(|&i| (particles.position[0][i] - x).abs() < 1e-9).unwrap();
        assert_eq!(particles.constraint[of(35.5e-6)], Constraint::Free);
        assert_eq!(particles.constraint[of(36.5e-6)], Constraint::ImposedVelocity);
        assert_eq!(
            particles.constraint[of(3.5e-6)],
            Constraint::ImposedVelocity,
            "the outlet is not touched"
        );
        let sum = impose(&mut particles, &regions, 700.0);
        let mass = 8.0 * 8960.0 * 1e-12;
        assert!((sum.momentum[0] / (-700.0 * mass) - 1.0).abs() < 1e-12);
        assert!((sum.energy / (245_000.0 * mass) - 1.0).abs() < 1e-12);
        assert_eq!(impose(&mut particles, &regions, 700.0), Content::default(), "nothing is imposed twice");
    }
}
