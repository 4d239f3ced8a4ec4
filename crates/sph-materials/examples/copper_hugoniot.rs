//! What must happen when a piston pushes into copper: solid, porous with shut pores, and pressed powder.
//!
//! ```text
//! cargo run -p sph-materials --example copper_hugoniot
//! ```

use sph_materials::hugoniot::{PistonWaves, elastic_limit, overdriven_threshold, piston};
use sph_materials::porous::{CompactionCurve, PorousMedium, Precursor};
use sph_materials::{Material, library};
use std::error::Error;

const PISTON_VELOCITIES: [f64; 10] = [5.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0, 600.0, 1000.0, 2000.0];

fn main() -> Result<(), Box<dyn Error>> {
    let copper = library::material("porous-copper")?;
    solid(&copper)?;
    porous(&copper)?;
    Ok(())
}

fn solid(copper: &Material) -> Result<(), Box<dyn Error>> {
    let limit = elastic_limit(copper)?;
    println!("Solid copper");
    println!("  elastic limit: -sigma_xx = {:.4} GPa", -limit.behind.longitudinal_stress / 1e9);
    println!("  behind the precursor: u = {:.2} m/s", limit.behind.particle_velocity);
    println!("  precursor speed: {:.1} m/s", limit.wave_speed);
    println!("  overdriven from u_p = {:.1} m/s on\n", overdriven_threshold(copper)?);
    println!(
        "{:>10} {:>12} {:>12} {:>16} {:>14}",
        "u_p [m/s]", "waves", "D [m/s]", "-sigma_xx [GPa]", "rho [kg/m3]"
    );
    for u_p in PISTON_VELOCITIES {
        let waves = piston(copper, u_p)?;
        let structure = match waves {
            PistonWaves::Fluid { .. } => "shock",
            PistonWaves::Elastic { .. } => "elastic",
            PistonWaves::TwoWave { .. } => "two waves",
            PistonWaves::Overdriven { .. } => "overdriven",
        };
        let (state, speed) = (waves.final_state(), waves.main_wave().wave_speed);
        let stress = -state.longitudinal_stress / 1e9;
        println!("{u_p:>10.0} {structure:>12} {speed:>12.1} {stress:>16.4} {:>14.2}", state.density);
    }
    Ok(())
}

fn porous(copper: &Material) -> Result<(), Box<dyn Error>> {
    let medium = PorousMedium::with_porosity(copper, 1.35, Precursor::Standing { stress: 0.22e9 })?;
    let powder = CompactionCurve::pressed_copper_powder(copper)?;
    println!(
        "\nPorous copper: u_s [m/s] of m = 1.35, pores shut, behind 0.22 GPa; of pressed powder, m = 1.4 (Boade 1970)\n"
    );
    println!(
        "{:>10} {:>14} {:>14} {:>12} {:>14}",
        "u_p [m/s]", "no deviator", "yielded", "snow-plow", "powder"
    );
    for u_p in PISTON_VELOCITIES.into_iter().filter(|u_p| (50.0..=600.0).contains(u_p)) {
        let snow_plow = medium.snow_plow(u_p)?.shock_velocity();
        let powder =
            powder.wave(u_p).map_or_else(|_| "-".to_owned(), |wave| format!("{:.1}", wave.wave_speed));
        let range = medium.shock_velocity_range(u_p)?;
        println!("{u_p:>10.0} {:>14.1} {:>14.1} {snow_plow:>12.1} {powder:>14}", range.lower, range.upper);
    }
    println!(
        "\nBelow about 150 m/s the pores stay open in part, and the true u_s is higher than the shut-pore values."
    );
    Ok(())
}
