//! The endless medium: one period, repeated for ever along x.
//!
//! [`FeedSample`] is one period `P` of the medium at rest, sorted along x. Particle `k` of period `n`
//! stands at `x_kn = o_n + s_k`, `s_k ∈ [0, P)`, where the origin of the period moves with the inlet and
//! `o_{n+1} = o_n + P`. [`Feed`] holds the cursor `(n, k)` of the next particle and the origin of *its*
//! period only, a number of the size of the box: nothing grows with the number of periods, so that the medium stays
//! seamless for as long as it is fed. The cursor, the origin and the next identifier are the whole state
//! ([`FeedState`]); the initial filling of the box is the first use of the same cursor.
//!
//! Source: the cycled sample of Rublev & Murzov, arXiv 2410.14646, section 3.

use crate::error::WindowError;
use serde::{Deserialize, Serialize};
use sph_core::dimension::Dimension;
use sph_core::domain::Domain;
use sph_core::particles::{Constraint, Particle, Particles};

/// One period of the medium at rest, sorted along x.
#[derive(Clone, Debug)]
pub struct FeedSample<D: Dimension> {
    particles: Particles<D>,
    cell: Domain<D>,
}

impl<D: Dimension> FeedSample<D> {
    /// The sample that repeats with the periodic `cell`: all axes periodic, the period of x is that of the feed.
    ///
    /// # Errors
    ///
    /// [`WindowError::Sample`] when there are no particles, an axis has no period, or a particle stands outside.
    pub fn new(mut particles: Particles<D>, cell: Domain<D>) -> Result<Self, WindowError> {
        let bad = |text: String| Err(WindowError::Sample(text));
        if particles.is_empty() {
            return bad("it holds no particles".to_string());
        }
        for axis in 0..D::COUNT {
            let period = cell.period(axis);
            if !(period.is_finite() && period > 0.0) {
                return bad(format!("axis {axis} has no positive, finite period ({period} m)"));
            }
        }
        for i in 0..particles.len() {
            let x = particles.position[0][i];
            if !(x >= cell.lower[0] && x < cell.upper[0]) {
                let (id, lower, upper) = (particles.id[i], cell.lower[0], cell.upper[0]);
                return bad(format!("particle {id} at x = {x} m is outside of [{lower}, {upper}) m"));
            }
        }
        let mut order: Vec<u32> = (0..particles.len() as u32).collect();
        let x = &particles.position[0];
        order.sort_by(|&a, &b| x[a as usize].total_cmp(&x[b as usize]));
        particles.gather(&order);
        Ok(Self { particles, cell })
    }

    /// The particles of one period, sorted along x.
    pub fn particles(&self) -> &Particles<D> {
        &self.particles
    }

    /// The periodic cell.
    pub fn cell(&self) -> &Domain<D> {
        &self.cell
    }

    /// Period along x [m].
    pub fn period(&self) -> f64 {
        self.cell.period(0)
    }

    /// Area across x: height of the cell per unit depth in plane strain [m], or its area [m²].
    pub fn cross_section(&self) -> f64 {
        (1..D::COUNT).map(|axis| self.cell.period(axis)).product()
    }

    /// Mean density of the medium `ρ00`, pores included [kg/m³].
    pub fn mean_density(&self) -> f64 {
        self.particles.mass.iter().sum::<f64>() / (self.period() * self.cross_section())
    }

    /// Largest particle size D [m].
    pub fn particle_size(&self) -> f64 {
        self.particles.size.iter().copied().fold(0.0, f64::max)
    }

    /// The fewest whole periods that reach at least a length [m], as a length [m].
    pub fn whole_periods(&self, length: f64) -> f64 {
        self.period() * (length / self.period() * (1.0 - 1e-12)).ceil().max(1.0)
    }
}

/// Where the feed stands: all that a restart needs beside the sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FeedState {
    /// Period of the next particle, counted from the first one in the box.
    pub period: u64,
    /// Index of the next particle in the sorted sample.
    pub cursor: usize,
    /// Place of the start of that period in the box [m].
    pub origin: f64,
    /// Identifier of the next particle.
    pub next_id: u64,
}

/// The sample and the cursor of its endless continuation.
#[derive(Clone, Debug)]
pub struct Feed<D: Dimension> {
    sample: FeedSample<D>,
    state: FeedState,
}

impl<D: Dimension> Feed<D> {
    /// A feed whose first period starts at x = 0.
    pub fn new(sample: FeedSample<D>) -> Self {
        Self { sample, state: FeedState { period: 0, cursor: 0, origin: 0.0, next_id: 0 } }
    }

    /// A feed that goes on from a saved state.
    ///
    /// # Errors
    ///
    /// [`WindowError::State`] when the cursor does not fit the sample.
    pub fn restore(sample: FeedSample<D>, state: FeedState) -> Result<Self, WindowError> {
        let count = sample.particles.len();
        if state.cursor >= count || !state.origin.is_finite() {
            let (cursor, origin) = (state.cursor, state.origin);
            return Err(WindowError::State(format!(
                "feed at particle {cursor} of {count}, origin {origin} m: it was saved with another sample"
            )));
        }
        Ok(Self { sample, state })
    }

    /// The sample.
    pub fn sample(&self) -> &FeedSample<D> {
        &self.sample
    }

    /// The state.
    pub fn state(&self) -> FeedState {
        self.state
    }

    /// Moves the medium outside of the box by a displacement along x [m], negative towards the box.
    pub fn advance(&mut self, displacement: f64) {
        self.state.origin += displacement;
    }

    /// Length of the medium that has come in since the start [m].
    pub fn fed_length(&self) -> f64 {
        self.state.period as f64 * self.sample.period() - self.state.origin
    }

    /// Place of the next particle [m].
    fn next_place(&self) -> f64 {
        let offset = self.sample.particles.position[0][self.state.cursor] - self.sample.cell.lower[0];
        self.state.origin + offset
    }

    /// The particles whose place has come left of `edge` [m], with their places in the box and an inlet's velocity
    /// [m/s] and constraint. They leave the feed.
    pub fn next_layer(
        &mut self,
        edge: f64,
        velocity: f64,
        constraint: Constraint,
    ) -> impl Iterator<Item = Particle<D>> {
        std::iter::from_fn(move || (self.next_place() < edge).then(|| self.take(velocity, constraint)))
    }

    fn take(&mut self, velocity: f64, constraint: Constraint) -> Particle<D> {
        let mut particle = self.sample.particles.get(self.state.cursor);
        particle.position[0] = self.next_place();
        particle.velocity = D::vector(|axis| if axis == 0 { velocity } else { 0.0 });
        particle.constraint = constraint;
        particle.id = self.state.next_id;
        self.state.next_id += 1;
        self.state.cursor += 1;
        if self.state.cursor == self.sample.particles.len() {
            self.state.cursor = 0;
            self.state.period += 1;
            self.state.origin += self.sample.period();
        }
        particle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::lattice;
    use sph_core::dimension::{Dim2, Dim3};

    /// Sum of the terms of an exact displacement, with the rounding error of each addition kept.
    fn add_exactly(sum: &mut (f64, f64), term: f64) {
        let total = sum.0 + term;
        let part = total - sum.0;
        sum.1 += (sum.0 - (total - part)) + (term - part);
        sum.0 = total;
    }

    fn medium_is_seamless_over_many_periods<D: Dimension>(sample: FeedSample<D>, steps: usize) {
        let (period, count) = (sample.period(), sample.particles().len());
        let offsets: Vec<f64> = sample.particles().position[0].clone();
        let edge = 2.7 * period;
        let mut feed = Feed::new(sample);
        let (mut displacement, mut taken) = ((0.0, 0.0), 0_usize);
        for step in 0..steps {
            for particle in feed.next_layer(edge, -800.0, Constraint::ImposedVelocity) {
                let (n, k) = (taken / count, taken % count);
                // In parts of a period: n - (whole part) is exact, whatever n.
                let moved = (displacement.0 + displacement.1) / period;
                let exact = (n as f64 - moved) + offsets[k] / period;
                let place = particle.position[0] / period;
                assert!((place - exact).abs() < 1e-12, "{place} {exact} after {n} periods");
                assert_eq!(particle.id, taken as u64, "identifiers go on");
                taken += 1;
            }
            let move_left = -period * (0.137 + 0.011 * ((step % 17) as f64));
            feed.advance(move_left);
            add_exactly(&mut displacement, -move_left);
        }
        assert!(taken / count > 500, "{taken} particles");
        let length = displacement.0 + displacement.1;
        assert!((feed.fed_length() - length).abs() < 1e-12 * length);
    }

    #[test]
    fn the_continuation_is_exact_over_many_periods_in_both_dimensions() {
        medium_is_seamless_over_many_periods(lattice::<Dim2>(1e-6, [7, 3, 3]), 4_000);
        medium_is_seamless_over_many_periods(lattice::<Dim3>(1.3e-6, [5, 2, 2]), 4_000);
    }

    #[test]
    fn a_restored_feed_goes_on_with_the_same_bits() {
        let mut straight = Feed::new(lattice::<Dim2>(1e-6, [7, 3, 3]));
        straight.advance(-3.3e-6);
        let _ = straight.next_layer(1e-5, -1.0, Constraint::Free).count();
        let mut resumed = Feed::restore(straight.sample().clone(), straight.state()).unwrap();
        for feed in [&mut straight, &mut resumed] {
            feed.advance(-5.7e-6);
        }
        let a: Vec<_> = straight.next_layer(2e-5, -1.0, Constraint::Free).collect();
        let b: Vec<_> = resumed.next_layer(2e-5, -1.0, Constraint::Free).collect();
        assert!(!a.is_empty() && a == b);
        assert!(
            Feed::restore(lattice::<Dim2>(1e-6, [1, 1, 1]), FeedState { cursor: 5, ..straight.state() })
                .is_err()
        );
    }

    #[test]
    fn a_sample_says_what_is_wrong_with_it() {
        let sample = lattice::<Dim2>(1e-6, [4, 2, 1]);
        assert!((sample.mean_density() - 8960.0).abs() < 1e-9);
        assert_eq!(sample.whole_periods(9e-6), 3.0 * sample.period());
        assert_eq!(sample.whole_periods(sample.period()), sample.period());
        let mut particles = sample.particles().clone();
        particles.position[0][1] = 9.0;
        let error = FeedSample::new(particles, *sample.cell()).unwrap_err().to_string();
        assert!(error.contains("x = 9 m is outside"), "{error}");
        let error = FeedSample::new(sample.particles().clone(), Domain::open()).unwrap_err().to_string();
        assert!(error.contains("axis 0 has no positive"), "{error}");
        assert!(FeedSample::new(Particles::<Dim2>::default(), *sample.cell()).is_err());
    }
}
