//! Shapes to cut particles with, and regular packings to cut from.

pub mod lattice;
pub mod packing;
pub mod rings;
pub mod shapes;

pub use lattice::{Lattice, lattice_volume_sum};
pub use packing::Packing;
pub use rings::concentric_rings;
pub use shapes::Shape;
