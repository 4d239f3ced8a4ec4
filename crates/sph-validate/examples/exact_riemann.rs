//! An exact elastic-plastic Riemann problem, without particles: compressed aluminum meets aluminum at rest.
//!
//! The numbers are those of Rublev & Murzov, arXiv 2410.14646, section 2.1.1: B = 73 GPa, G = 23 GPa, Y = 0.3 GPa, the left half
//! at -4 GPa on its yield surface.
//!
//! `cargo run -p sph-validate --example exact_riemann`

use sph_validate::reference::riemann::{Release, Solid, solve};

/// Solves the problem and prints its waves.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let solid = Solid { density: 2688.9, bulk_modulus: 73e9, shear_modulus: 23e9, yield_strength: 0.3e9 };
    let solution = solve(solid, solid.at_compressive_yield(-4e9), solid.at_rest(), Release::Fan)?;
    for (name, waves) in [("left", &solution.left), ("right", &solution.right)] {
        for wave in waves {
            println!(
                "{name}: {:.1} to {:.1} m/s, behind it {:.4} GPa and {:.2} m/s",
                wave.head,
                wave.tail,
                wave.behind.stress / 1e9,
                wave.behind.velocity
            );
        }
    }
    println!("contact: {:.6} GPa, {:.4} m/s", solution.contact_stress / 1e9, solution.contact_velocity);
    if (solution.contact_stress / -1.931995e9 - 1.0).abs() > 1e-6 {
        return Err("the contact is not where it was published".into());
    }
    Ok(())
}
