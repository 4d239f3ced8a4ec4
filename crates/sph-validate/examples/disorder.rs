//! What disorder of the particles costs in the elastic-plastic Riemann problem: the mean error of σ_xx on jittered
//! lattices, with faces open and closed.
//!
//! `cargo run --release -p sph-validate --example disorder [N] [sweeps ...]`

use sph_validate::disorder::{Disorder, run};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<u32> = std::env::args().skip(1).map(|a| a.parse()).collect::<Result<_, _>>()?;
    let n = arguments.first().copied().unwrap_or(200);
    let sweeps = if arguments.len() > 1 { arguments[1..].to_vec() } else { vec![10] };
    for volume_consistency in [true, false] {
        println!("volume consistency {volume_consistency}, N = {n}: mean |σ_xx - exact|, GPa");
        println!(
            "{:>10} {:>10} {}",
            "jitter [D]",
            "open",
            sweeps.iter().map(|s| format!("{s:>10}")).collect::<String>()
        );
        for jitter in [0.0, 0.05, 0.1, 0.2] {
            let error =
                |sweeps: Option<u32>| run(Disorder { n, jitter, sweeps, seed: 1, volume_consistency });
            let mut line = format!("{jitter:>10} {:>10.4}", 1e-9 * error(None)?);
            for &s in &sweeps {
                line += &format!("{:>10.4}", 1e-9 * error(Some(s))?);
            }
            println!("{line}");
        }
    }
    Ok(())
}
