//! Particles, kernels, neighbors and corrected gradients of smoothed particle hydrodynamics, in two and three
//! dimensions.
//!
//! This crate knows space, particles and sums over neighbors. It does not know materials, Riemann problems or files.
//!
//! What a particle of a perfect lattice sees: Σ V W is one and the matrix L of the kernel gradient the identity, as well as
//! the kernel can do it.
//!
//! ```
//! use sph_core::correction::{Neighbor, gradient_matrix};
//! use sph_core::geometry::{Lattice, lattice_volume_sum};
//! use sph_core::{Dim2, Dimension, KernelFamily};
//!
//! let (kernel, width) = (KernelFamily::WendlandC2, 2.0); // smoothing length in spacings
//! let sum = lattice_volume_sum(Lattice::Square, width, kernel);
//! assert!((sum - 1.0012).abs() < 1e-4);
//!
//! let offsets = Lattice::Square.offsets_within(kernel.support() * width);
//! let neighbors = offsets.iter().map(|o| Neighbor::<Dim2>::new(kernel, Dim2::vector(|a| o[a]), width, 1.0));
//! let gradient = gradient_matrix(neighbors);
//! assert!((gradient[(0, 0)] - 1.0).abs() < 0.01 && gradient[(0, 1)].abs() < 1e-12);
//! ```

pub mod correction;
pub mod dimension;
pub mod domain;
pub mod error;
pub mod geometry;
pub mod gradient;
pub mod kernel;
pub mod lanes;
pub mod matrix;
pub mod memory;
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
