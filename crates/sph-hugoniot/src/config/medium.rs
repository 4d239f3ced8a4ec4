//! The medium of a case: the periodic cell, what is where in it, and the particles.

use glam::DVec2;
use serde::Serialize;

use crate::microstructure::layout::{Base, Fill, Layout};
use crate::microstructure::pore_centers;
use crate::microstructure::shape::Shape;

/// Cell, layout and particles.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Medium {
    /// Length L of the periodic cell along x, the way of the wave [m].
    pub cell: f64,
    /// Height H of the cell [m].
    pub height: f64,
    /// Where the pores are.
    pub pores: Pores,
    /// Radius of pores on a lattice, as given or as the porosity asks for [m]; zero without.
    pub radius: f64,
    /// Porosity m = ρ0/ρ00 to reach [-]; 1 without voids.
    pub porosity: f64,
    /// Particle size D [m].
    pub particle_size: f64,
    /// How particles are packed.
    pub packing: Packing,
    /// What is where, pores included.
    pub layout: Layout,
}

impl Medium {
    /// Pores of one radius [m] on a lattice, in one material.
    pub fn with_lattice(
        cell: DVec2,
        pores: Pores,
        radius: f64,
        porosity: f64,
        particle_size: f64,
        packing: Packing,
    ) -> Self {
        let mut layout = Layout::solid();
        for center in pore_centers(pores, cell) {
            layout.paint(Shape::Circle { center, radius }, Fill::Void);
        }
        Self { cell: cell.x, height: cell.y, pores, radius, porosity, particle_size, packing, layout }
    }

    /// Length and height of the cell [m].
    pub fn cell_size(&self) -> DVec2 {
        DVec2::new(self.cell, self.height)
    }

    /// True if there are voids beside pores on a lattice.
    pub(crate) fn has_other_voids(&self) -> bool {
        let painted = self.layout.painted.iter().filter(|p| p.fill == Fill::Void).count();
        let base = match &self.layout.base {
            Base::Uniform(fill) => *fill == Fill::Void,
            Base::Image(image) => image.fills().contains(&Fill::Void),
        };
        base || painted > self.pores.count()
    }

    /// Indices of the materials that occur.
    pub fn materials(&self) -> Vec<u16> {
        let material = |fill: Fill| if let Fill::Material(k) = fill { Some(k) } else { None };
        self.layout.fills().into_iter().filter_map(material).collect()
    }
}

/// Where the pores are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Pores {
    /// No pores.
    None,
    /// One pore a cell.
    Square,
    /// Two pores a cell: one more in the middle of four.
    CenteredSquare,
    /// Two pores a cell that is √3 times as high as long: a hexagonal lattice.
    Hexagonal,
    /// Placed at random.
    Placed,
}

impl Pores {
    /// Pores of a cell that are on a lattice.
    pub fn count(self) -> usize {
        match self {
            Pores::None | Pores::Placed => 0,
            Pores::Square => 1,
            Pores::CenteredSquare | Pores::Hexagonal => 2,
        }
    }
}

/// How particles are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Packing {
    /// On a square lattice.
    Square,
    /// On a hexagonal lattice.
    Hexagonal,
    /// Pushed apart until they follow the boundaries.
    Relaxed,
}
