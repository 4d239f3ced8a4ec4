//! Particles, kernels, neighbors and corrected gradients of smoothed particle hydrodynamics, in two and three
//! dimensions.
//!
//! This crate knows space, particles and sums over neighbors. It does not know materials, Riemann problems or files.

pub mod correction;
pub mod dimension;
pub mod domain;
pub mod error;
pub mod geometry;
pub mod gradient;
pub mod kernel;
pub mod lanes;
pub mod matrix;
pub mod neighbors;
pub mod particles;
pub mod reduce;
pub mod tiles;

pub use dimension::{Components, Dim2, Dim3, Dimension, Vector};
pub use domain::Domain;
pub use error::CoreError;
pub use kernel::KernelFamily;
pub use matrix::SquareMatrix;
pub use particles::{Constraint, Particle, Particles};
