//! Spherical pores in three dimensions from Rust: samples on lattices and at random, then one shock in a window.
//!
//! Expected: porosity 1.35 to a particle in every sample; at u_p = 300 m/s pores shut, and u_s within two percent of
//! what the jump conditions leave for shut pores.
//!
//! `cargo run --release -p sph-hugoniot --example spheres -- FOLDER` writes pictures and .vtp files into the folder, and takes
//! one to two minutes of one core.

use std::path::Path;

use glam::DVec3;
use sph_core::Dim3;
use sph_hugoniot::microstructure::placement::Sizes;
use sph_hugoniot::microstructure::spheres::{Arrangement, RandomSpheres, SphereMedium, SphereSample};
use sph_materials::Material;
use sph_materials::porous::{PorousMedium, Precursor, ShearBehind};
use sph_riemann::{Scheme, Settings};
use sph_window::{FrameTracking, Search, Window, WindowSettings};

/// Micron [m].
const MICRON: f64 = 1e-6;
/// Velocity of the piston [m/s].
const PARTICLE_VELOCITY: f64 = 300.0;

fn medium(edge: f64, arrangement: Arrangement) -> SphereMedium {
    SphereMedium { cell: DVec3::splat(edge), arrangement, porosity: 1.35, particle_size: MICRON }
}

fn media() -> [(&'static str, SphereMedium); 3] {
    let random = RandomSpheres {
        sizes: Sizes::LogNormal { median: 3.0 * MICRON, deviation: 0.2 },
        gap: MICRON,
        seed: 1,
    };
    [
        ("simple-cubic", medium(10.0 * MICRON, Arrangement::SimpleCubic)),
        ("body-centered", medium(12.0 * MICRON, Arrangement::BodyCentered)),
        ("random", medium(24.0 * MICRON, Arrangement::Random(random))),
    ]
}

/// Runs the shock until so many cells were fed; returns u_s and what shut pores leave [m/s].
fn shock(
    sample: &SphereSample,
    copper: &Material,
    cells: f64,
) -> Result<(f64, f64), Box<dyn std::error::Error>> {
    let search = Search::FrameTracking(FrameTracking { interval: 10.0, ..FrameTracking::default() });
    let settings = WindowSettings { search, ..WindowSettings::new(12.0 * sample.cell.x, PARTICLE_VELOCITY) };
    let solver = Settings::for_scheme(Scheme::TkcHancock);
    let mut window = Window::<Dim3>::new(sample.feed()?, vec![copper.clone()], solver, settings)?;
    while window.fed_cells() < cells {
        window.step()?;
    }
    let shock = window.shock_velocity().ok_or("no block of the medium was swept")?;
    println!("{} steps of {} particles", window.steps(), window.simulation().particles().len());
    println!("u_s = {:.1} ± {:.1} m/s after {cells} cells", shock.velocity, shock.standard_error);
    println!("the ledger closes to {:.1e}", window.ledger_residual());
    let ahead = window.ahead().ok_or("the front stands at the inlet")?;
    let stress = -window.profile().between(ahead.0, ahead.1).stress();
    let standing = Precursor::Standing { stress };
    let shut = PorousMedium::new(copper, sample.bulk_density(), standing)?;
    let shut = shut.shut_pores(PARTICLE_VELOCITY, ShearBehind::None)?.shock_velocity();
    println!("-σ_xx ahead {:.3} GPa; shut pores leave u_s = {shut:.1} m/s", stress / 1e9);
    Ok((shock.velocity, shut))
}

/// Builds the samples, writes them if a folder is named, runs the shock.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let copper = sph_materials::library::material("porous-copper")?;
    let folder = std::env::args().nth(1);
    for (name, medium) in media() {
        let sample = medium.build(copper.reference_density)?;
        let gap = sample.smallest_gap() / MICRON;
        println!(
            "{name}: {} pores, {} particles, m = {:.4}, smallest gap {gap:.2} µm",
            sample.spheres.len(),
            sample.particles.len(),
            sample.porosity
        );
        if let Some(folder) = &folder {
            std::fs::create_dir_all(folder)?;
            sample.write_slices(name, &Path::new(folder).join(format!("{name}.png")))?;
            sample.write_vtp(&Path::new(folder).join(format!("{name}.vtp")))?;
        }
    }
    let sample = media()[0].1.build(copper.reference_density)?;
    let (found, shut) = shock(&sample, &copper, 30.0)?;
    if (found / shut - 1.0).abs() > 0.02 {
        return Err("u_s is not what shut pores leave".into());
    }
    Ok(())
}
