//! Positions of particles and the volume that each stands for.

use crate::dimension::{Components, Dimension};
use crate::geometry::Shape;

/// Points with the volume of each: what particles are made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Packing<D: Dimension> {
    /// Positions by axis [m].
    pub position: D::AxisColumns,
    /// Volume (area in the plane) that each point stands for [m^d]. Times the density it is the mass.
    pub volume: Vec<f64>,
    /// Particle size D [m].
    pub size: f64,
}

impl<D: Dimension> Packing<D> {
    /// No points yet, of particle size `size` [m].
    pub fn empty(size: f64) -> Self {
        Self { position: Components::from_fn(|_| Vec::new()), volume: Vec::new(), size }
    }

    /// Adds a point [m] that stands for `volume` [m^d].
    pub fn push(&mut self, point: D::Vector, volume: f64) {
        (0..D::COUNT).for_each(|a| self.position[a].push(point[a]));
        self.volume.push(volume);
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.volume.len()
    }

    /// True without points.
    pub fn is_empty(&self) -> bool {
        self.volume.is_empty()
    }

    /// Point `i` [m].
    pub fn point(&self, i: usize) -> D::Vector {
        D::vector(|a| self.position[a][i])
    }

    /// All points [m].
    pub fn points(&self) -> impl Iterator<Item = D::Vector> + '_ {
        (0..self.len()).map(|i| self.point(i))
    }

    /// Volume of all points [m^d].
    pub fn total_volume(&self) -> f64 {
        crate::reduce::sum(&self.volume)
    }

    /// The points for which `keep` holds, in their order.
    pub fn filtered(&self, keep: impl Fn(D::Vector) -> bool) -> Self {
        let mut kept = Self::empty(self.size);
        for i in (0..self.len()).filter(|&i| keep(self.point(i))) {
            kept.push(self.point(i), self.volume[i]);
        }
        kept
    }

    /// The points inside a shape.
    pub fn cut(&self, shape: &Shape<D>) -> Self {
        self.filtered(|point| shape.contains(point))
    }
}
