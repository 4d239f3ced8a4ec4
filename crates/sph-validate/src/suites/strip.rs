//! Strips of particles: rows of equally spaced particles along x, periodic across. For plane waves along x.

use std::ops::Range;

use sph_core::{Constraint, Dim2, Domain, Particle, Particles};

use crate::run::{Run, particle_at};

/// Rows of a strip: more than the kernels reach across, so that a particle does not see its own image.
pub const ROWS: u32 = 6;

/// Columns `columns` of a strip, column k at x = (k + ½) D; `change` makes each particle what it shall be.
pub fn particles(
    columns: Range<i64>,
    size: f64,
    density: f64,
    mut change: impl FnMut(f64, &mut Particle<Dim2>),
) -> Particles<Dim2> {
    let mut particles = Particles::default();
    for column in columns {
        let x = (column as f64 + 0.5) * size;
        for row in 0..ROWS {
            let position = [x, (f64::from(row) + 0.5) * size].into();
            let mut particle = particle_at(particles.len(), position, size, density);
            change(x, &mut particle);
            particles.push(particle);
        }
    }
    particles
}

/// The domain of a strip between two ends [m], which bind nothing; `periodic`: along x too.
pub fn domain(ends: [f64; 2], size: f64, periodic: bool) -> Domain<Dim2> {
    Domain::new([ends[0], 0.0].into(), [ends[1], f64::from(ROWS) * size].into(), [periodic, true])
}

/// Place x [m] and a value of the free particles.
pub fn values(run: &Run<'_, Dim2>, value: impl Fn(usize) -> f64) -> Vec<(f64, f64)> {
    let particles = run.simulation.particles();
    let free = (0..particles.len()).filter(|&i| particles.constraint[i] == Constraint::Free);
    free.map(|i| (particles.position[0][i], value(i))).collect()
}

/// Mean of the values between two places [m]; not a number where there are none.
pub fn mean_between(values: &[(f64, f64)], from: f64, to: f64) -> f64 {
    let inside = values.iter().filter(|(x, _)| (from..to).contains(x));
    let (count, sum) = inside.fold((0usize, 0.0), |(count, sum), (_, value)| (count + 1, sum + value));
    sum / count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_lie_around_the_middle_of_their_cells() {
        let strip = particles(-2..3, 0.5, 2.0, |x, particle| {
            particle.constraint = if x < 0.0 { Constraint::Frozen } else { Constraint::Free };
        });
        assert_eq!(strip.len(), 5 * ROWS as usize);
        assert_eq!(strip.position[0][0], -0.75);
        assert_eq!(strip.constraint.iter().filter(|&&c| c == Constraint::Frozen).count(), 12);
        let mass: f64 = strip.mass.iter().sum();
        assert!((mass - 2.0 * 2.5 * 3.0).abs() < 1e-12);
        assert!(domain([-1.0, 1.5], 0.5, false).periodic[1]);
    }

    #[test]
    fn mean_of_nothing_is_not_a_number() {
        let values = [(0.0, 1.0), (1.0, 3.0), (2.0, 9.0)];
        assert_eq!(mean_between(&values, 0.0, 2.0), 2.0);
        assert!(mean_between(&values, 5.0, 6.0).is_nan());
    }
}
