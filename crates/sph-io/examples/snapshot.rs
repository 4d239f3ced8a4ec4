//! Writes a short series for ParaView into a folder: `cargo run -p sph-io --example snapshot -- FOLDER`, then open
//! `FOLDER/ring.pvd`. A ring of particles turns and is stretched; the numbers are invented.

use sph_io::snapshot::{Snapshot, SnapshotSeries};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: snapshot FOLDER")?;
    std::fs::create_dir_all(&folder)?;
    let mut series = SnapshotSeries::new(folder, "ring");
    for frame in 0..5 {
        let time = 1.0e-7 * f64::from(frame);
        let angles: Vec<f64> = (0..20_000).map(|k| 1.0e6 * time + f64::from(k) * 0.01).collect();
        let place = |k: usize, angle: f64| {
            let radius = 1.0e-3 * (1.0 + 2.0e-5 * k as f64);
            [radius * angle.cos(), radius * angle.sin(), 0.0]
        };
        let points: Vec<[f64; 3]> = angles.iter().enumerate().map(|(k, &angle)| place(k, angle)).collect();
        let velocity: Vec<[f64; 3]> = points.iter().map(|[x, y, _]| [-1.0e6 * y, 1.0e6 * x, 0.0]).collect();
        let density: Vec<f64> = angles.iter().map(|angle| 8930.0 + 10.0 * angle.sin()).collect();
        let stress: Vec<[f64; 6]> = density.iter().map(|&rho| [rho, 2.0, 3.0, 4.0, 5.0, 6.0]).collect();
        let ids: Vec<i64> = (0..20_000).collect();
        let snapshot = Snapshot::new(time, &points)
            .with_scalar("density [kg/m3]", &density)
            .with_vector("velocity [m/s]", &velocity)
            .with_symmetric_tensor("stress [Pa]", &stress)
            .with_integer("id", &ids);
        println!("{}", series.add(&snapshot)?.display());
    }
    Ok(())
}
