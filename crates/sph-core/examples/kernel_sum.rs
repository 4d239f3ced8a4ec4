//! What a particle of a perfect lattice sees: Σ V W, which should be one, and its gradient matrix, which should be the
//! identity. `cargo run --example kernel_sum -p sph-core`.

use sph_core::correction::{Neighbor, gradient_matrix};
use sph_core::geometry::{Lattice, lattice_volume_sum};
use sph_core::{Dim2, Dim3, Dimension, KernelFamily};

/// Prints the table.
pub fn main() {
    println!("h = width D. sum: sum of V W over the lattice. slope: L_xx of the gradient matrix.");
    println!(
        "{:<24}{:<13}{:>6}{:>12}{:>10}{:>10}",
        "lattice", "kernel", "width", "neighbors", "sum", "slope"
    );
    for lattice in Lattice::ALL {
        for kernel in KernelFamily::ALL {
            for width in [1.0, 1.2, 1.5, 2.0] {
                let slope = match lattice.dimension_count() {
                    2 => slope::<Dim2>(lattice, kernel, width),
                    _ => slope::<Dim3>(lattice, kernel, width),
                };
                let sum = lattice_volume_sum(lattice, width, kernel);
                let neighbors = lattice.offsets_within(kernel.support() * width).len() - 1;
                let (lattice, kernel) = (lattice.name(), format!("{kernel:?}"));
                println!("{lattice:<24}{kernel:<13}{width:>6}{neighbors:>12}{sum:>10.4}{slope:>10.4}");
            }
        }
    }
}

/// L_xx of a particle of the lattice, D = 1.
fn slope<D: Dimension>(lattice: Lattice, kernel: KernelFamily, width: f64) -> f64 {
    let offsets = lattice.offsets_within(kernel.support() * width);
    let neighbors = offsets.iter().map(|o| Neighbor::<D>::new(kernel, D::vector(|a| o[a]), width, 1.0));
    gradient_matrix(neighbors)[(0, 0)]
}
