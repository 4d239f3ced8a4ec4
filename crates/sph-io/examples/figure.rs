//! Makes sample figures in a folder: `cargo run -p sph-io --example figure -- FOLDER`.
//!
//! A u_s-u_p plot with error bars, a convergence plot with slopes, a stack of profiles and a field image. The numbers
//! are invented.

use sph_io::IoError;
use sph_io::field_image::{ColorMap, Field, FieldImage};
use sph_io::plot::{Annotation, Axis, Figure, Panel, Series};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: figure FOLDER")?;
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    for (name, figure) in [("hugoniot", hugoniot()), ("convergence", convergence()), ("profile", profile())] {
        write_both(&figure, folder, name)?;
    }
    field_image().write_png(folder.join("field.png"))?;
    Ok(())
}

fn write_both(figure: &Figure, folder: &Path, name: &str) -> Result<(), IoError> {
    figure.write_svg(folder.join(format!("{name}.svg")))?;
    figure.write_png(folder.join(format!("{name}.png")))
}

fn curve(x: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
    x.iter().map(|&x| f(x)).collect()
}

fn hugoniot() -> Figure {
    let u_p = [50.0, 75.0, 100.0, 130.0, 150.0, 200.0, 250.0, 300.0];
    let u_s = [318.0, 371.0, 428.0, 512.0, 571.0, 757.0, 939.0, 1117.0];
    let error = [22.0, 14.0, 9.0, 8.0, 6.0, 12.0, 9.0, 15.0];
    let dense: Vec<f64> = (20..=160).map(|k| 2.0 * f64::from(k)).collect();
    Figure::new("Porous copper, m = 1.35", Axis::new("u_p [m/s]"), Axis::new("u_s [m/s]"))
        .with(Series::points("this run, standard error", &u_p, &u_s).with_error(&error))
        .with(Series::line("published fit", &dense, &curve(&dense, |u| 238.0 + 1.5 * u + 0.004 * u * u)))
        .with(Series::dashed("exact, pores shut", &dense, &curve(&dense, |u| 3.74 * u + 5.0)))
        .with(Series::dotted("experiment, fit", &dense, &curve(&dense, |u| 190.0 + 2.4 * u)))
}

fn convergence() -> Figure {
    let n = [100.0, 200.0, 400.0, 800.0, 1600.0];
    let slope =
        |y, order, text: &str| Annotation::Slope { start: (150.0, y), to_x: 900.0, order, text: text.into() };
    Figure::new("Sound wave", Axis::log("N").with_ticks(&n), Axis::log("L_1 error of U_x [m/s]"))
        .with(Series::line_with_points("CSPH", &n, &[0.21, 0.143, 0.115, 0.109, 0.108]))
        .with(Series::line_with_points("TKC as printed", &n, &[0.0301, 0.0177, 8.89e-3, 4.49e-3, 2.3e-3]))
        .with(Series::line_with_points("TKC Hancock", &n, &[0.0163, 3.48e-3, 7.9e-4, 2.1e-4, 8.0e-5]))
        .with_annotation(slope(0.05, -1.0, "N^{−1}"))
        .with_annotation(slope(0.003, -2.0, "N^{−2}"))
}

fn profile() -> Figure {
    let x: Vec<f64> = (0..=600).map(|k| 0.5 * f64::from(k) - 150.0).collect();
    let front = |x: f64| 0.5 * (1.0 - (x / 6.0).tanh());
    let precursor = |x: f64| 0.5 * (1.0 - ((x - 90.0) / 3.0).tanh());
    let panel = |label: &str, computed: Vec<f64>, exact: Vec<f64>| {
        Panel::new(Axis::new(label))
            .with(Series::line("average", &x, &computed))
            .with(Series::dashed("exact", &x, &exact))
    };
    let wave = |x: f64, behind: f64, between: f64| between * precursor(x) + (behind - between) * front(x);
    let step = |x: f64, behind: f64, between: f64| {
        if x < 0.0 {
            behind
        } else if x < 90.0 {
            between
        } else {
            0.0
        }
    };
    Figure::stacked("u_p = 250 m/s", Axis::new("x [µm]"))
        .with_panel(panel(
            "ρ [g/cm^3]",
            curve(&x, |x| 6.6 + wave(x, 2.42, 0.05) + 0.02 * (0.4 * x).sin()),
            curve(&x, |x| 6.6 + step(x, 2.42, 0.05)),
        ))
        .with_panel(panel(
            "−σ_xx [GPa]",
            curve(&x, |x| wave(x, 1.55, 0.22)),
            curve(&x, |x| step(x, 1.55, 0.22)),
        ))
        .with_panel(panel(
            "u_x [m/s]",
            curve(&x, |x| wave(x, 250.0, 13.0)),
            curve(&x, |x| step(x, 250.0, 13.0)),
        ))
}

/// A window of 560 by 20 µm with round pores that close behind a front.
fn field_image() -> FieldImage {
    let (length, height, spacing) = (560.0, 20.0, 0.8);
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for column in 0..700 {
        for row in 0..25 {
            let place = ((f64::from(column) + 0.5) * spacing, (f64::from(row) + 0.5) * spacing);
            let is_ahead = place.0 > 0.5 * length;
            let to_pore = |cx: f64, cy: f64| (place.0 % 20.0 - cx).hypot(place.1 - cy);
            if !(is_ahead && to_pore(5.0, 5.0).min(to_pore(15.0, 15.0)) < 4.06) {
                x.push(place.0);
                y.push(place.1);
            }
        }
    }
    let wave = |x: f64| 0.5 * (1.0 - ((x - 0.5 * length) / 5.0).tanh());
    let ripple = |x: f64, y: f64| (0.9 * x).sin() * (0.7 * y).cos();
    let density: Vec<f64> =
        x.iter().zip(&y).map(|(&x, &y)| 8.93 + wave(x) * (0.1 + 0.03 * ripple(x, y))).collect();
    let velocity: Vec<f64> =
        x.iter().zip(&y).map(|(&x, &y)| 250.0 * wave(x) + 20.0 * wave(x) * ripple(y, x)).collect();
    let stress: Vec<f64> =
        x.iter().zip(&y).map(|(&x, &y)| -1.5 * wave(x) + 0.3 * ripple(x, y) - 0.1).collect();
    let n = x.len();
    FieldImage::new("u_p = 250 m/s, 0.66 µs", (0.0, length), (0.0, height))
        .with_particles(x, y, vec![spacing; n])
        .with_field(Field::new("ρ [g/cm^3]", density, ColorMap::Sequential))
        .with_field(Field::new("u_x [m/s]", velocity, ColorMap::Heat))
        .with_field(Field::new("σ_xx [GPa]", stress, ColorMap::Diverging))
        .with_strips(2)
        .with_periods(2)
}
