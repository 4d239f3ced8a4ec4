//! Halo particles: copies of particles across periodic boundaries.
//!
//! Pair loops know nothing of periodicity. Every image of a particle that lies within `reach` of the box stands behind
//! the particles in the arrays that pair loops read; it is refreshed from its owner at one call. This is also where
//! particles of neighboring processes would enter.

use rayon::prelude::*;

use crate::dimension::Dimension;
use crate::domain::Domain;
use crate::lanes::{Line, prefetch};

/// Particles or copies that one thread looks at in one go.
const PART: usize = 1024;
/// Copies by which an owner is asked for before it is read.
const AHEAD: usize = 16;

/// Copies of particles, with the shift of each.
#[derive(Clone, Debug, Default)]
pub struct Halo<D: Dimension> {
    /// Index of the particle that each copy shows.
    pub owner: Vec<u32>,
    /// Shift of each copy [m].
    pub shift: Vec<D::Vector>,
}

impl<D: Dimension> Halo<D> {
    /// All images within `reach` [m] of the box, of particles at `position` (inside the box on periodic axes).
    pub fn build(position: &D::AxisColumns, domain: &Domain<D>, reach: f64) -> Self {
        let mut halo = Self::default();
        for axis in (0..D::COUNT).filter(|&a| domain.periodic[a]) {
            halo.add_images_along(axis, position, domain, reach);
        }
        halo
    }

    /// Images along one axis of all particles and of the images along the axes before: corners come by themselves.
    fn add_images_along(&mut self, axis: usize, position: &D::AxisColumns, domain: &Domain<D>, reach: f64) {
        let period = domain.period(axis);
        let (lower, upper) = (domain.lower[axis] - reach, domain.upper[axis] + reach);
        let n = position[axis].len();
        // A short period shows a particle more than once.
        let turns = (reach / period).ceil() as i64 + 1;
        let of_source = |source: usize| match source.checked_sub(n) {
            None => (source as u32, D::Vector::default()),
            Some(copy) => (self.owner[copy], self.shift[copy]),
        };
        let images = |part: usize| {
            let mut images = Vec::new();
            for source in part * PART..((part + 1) * PART).min(n + self.owner.len()) {
                let (owner, shift) = of_source(source);
                let x = position[axis][owner as usize];
                if x - period <= lower && x + period >= upper {
                    continue; // Too far from both sides: most are.
                }
                for turn in (-turns..=turns).filter(|&turn| turn != 0) {
                    let image = x + turn as f64 * period;
                    if image > lower && image < upper {
                        let mut shift = shift;
                        shift[axis] = turn as f64 * period;
                        images.push((owner, shift));
                    }
                }
            }
            images
        };
        let parts = (n + self.owner.len()).div_ceil(PART);
        let images: Vec<Vec<(u32, D::Vector)>> = (0..parts).into_par_iter().map(images).collect();
        for (owner, shift) in images.into_iter().flatten() {
            self.owner.push(owner);
            self.shift.push(shift);
        }
    }

    /// Number of copies.
    pub fn len(&self) -> usize {
        self.owner.len()
    }

    /// True without copies.
    pub fn is_empty(&self) -> bool {
        self.owner.is_empty()
    }

    /// Copies the records of the owners behind the first `first` records of `lines`, `stride` lines each, and shifts
    /// their positions, which are the first numbers of a record.
    pub fn refresh(&self, lines: &mut [Line], stride: usize, first: usize) {
        let (owned, copies) = lines.split_at_mut(first * stride);
        let parts = copies.par_chunks_mut(stride * PART).enumerate();
        parts.for_each(|(part, copies)| {
            for (k, copy) in copies.chunks_exact_mut(stride).enumerate() {
                let k = part * PART + k;
                if let Some(owner) = self.owner.get(k + AHEAD) {
                    prefetch(owned, *owner as usize * stride, stride);
                }
                let at = self.owner[k] as usize * stride;
                copy.copy_from_slice(&owned[at..at + stride]);
                for a in 0..D::COUNT {
                    copy[0].0[a] += self.shift[k][a];
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::Dim2;
    use glam::DVec2;

    #[test]
    fn a_corner_particle_has_an_image_across_each_side_and_across_the_corner() {
        let domain = Domain::<Dim2>::new(DVec2::ZERO, DVec2::ONE, [true, true]);
        let halo = Halo::<Dim2>::build(&[vec![0.05], vec![0.05]], &domain, 0.1);
        let mut shifts: Vec<[i64; 2]> = halo.shift.iter().map(|s| [s.x as i64, s.y as i64]).collect();
        shifts.sort();
        assert_eq!(shifts, [[0, 1], [1, 0], [1, 1]]);
    }

    #[test]
    fn a_period_shorter_than_the_reach_shows_a_particle_many_times() {
        let domain = Domain::<Dim2>::new(DVec2::ZERO, DVec2::ONE, [false, true]);
        let halo = Halo::<Dim2>::build(&[vec![0.5], vec![0.5]], &domain, 2.2);
        assert_eq!(halo.len(), 4, "at -1.5, -0.5, 1.5, 2.5");
    }
}
