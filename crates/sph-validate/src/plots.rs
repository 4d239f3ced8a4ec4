//! Plots of the suites: profile and convergence, the stop radius of the shell, fields of stress.

use std::path::{Path, PathBuf};

use sph_io::Color;
use sph_io::field_image::{Cell, ColorMap, Field, FieldImage};
use sph_io::plot::{Annotation, Axis, Figure, LegendPosition, Panel, Series};

use crate::case::{SchemeName, SuiteName};
use crate::error::ValidateError;
use crate::metric::Metric;
use crate::suites::{self, Outcome, riemann, sound_wave, verny};

/// Profiles are shown at this resolution, or the greatest below it: where the schemes can still be told apart.
const SHOWN_RESOLUTION: u32 = 400;

const BLACK: Color = Color::rgb(0, 0, 0);

/// Draws all plots of `outcomes` into `folder`; gives the PNG files with their suites.
pub fn write_plots(outcomes: &[&Outcome], folder: &Path) -> Result<Vec<(SuiteName, String)>, ValidateError> {
    let mut written = Vec::new();
    for suite in SuiteName::ALL {
        let of_suite: Vec<&Outcome> = outcomes.iter().copied().filter(|o| o.case.suite == suite).collect();
        if of_suite.is_empty() {
            continue;
        }
        for (name, figure) in figures(suite, &of_suite)? {
            write_figure(&figure, folder, &name)?;
            written.push((suite, format!("{name}.png")));
        }
        for name in write_fields(&of_suite, folder)? {
            written.push((suite, name));
        }
    }
    Ok(written)
}

fn figures(suite: SuiteName, outcomes: &[&Outcome]) -> Result<Vec<(String, Figure)>, ValidateError> {
    let named = |suffix: &str| format!("{suite}{suffix}");
    Ok(match suite {
        SuiteName::Riemann => vec![
            (named(""), riemann_profile(outcomes)?),
            (named("-convergence"), convergence(outcomes, Metric::StressL1, 1.0)),
        ],
        SuiteName::SoundWave => vec![
            (named(""), sound_wave_profile(outcomes)),
            (named("-convergence"), convergence(outcomes, Metric::VelocityL1, 2.0)),
        ],
        SuiteName::Verny => vec![(named(""), stop_radius(outcomes)?)],
    })
}

fn write_figure(figure: &Figure, folder: &Path, name: &str) -> Result<(), ValidateError> {
    for extension in ["svg", "png"] {
        let path = folder.join(format!("{name}.{extension}"));
        let result = if extension == "svg" { figure.write_svg(&path) } else { figure.write_png(&path) };
        result.map_err(|error| output_fault(path, error))?;
    }
    Ok(())
}

/// Pictures of the fields of the finest run of each scheme; those of the start are alike and drawn once.
fn write_fields(outcomes: &[&Outcome], folder: &Path) -> Result<Vec<String>, ValidateError> {
    let mut names = Vec::new();
    for scheme in SchemeName::ALL {
        let finest = outcomes.iter().filter(|o| o.case.scheme == scheme).max_by_key(|o| o.case.n);
        for field in finest.iter().flat_map(|outcome| &outcome.fields) {
            let suite = outcomes[0].case.suite;
            let name = match field.moment {
                "start" => format!("{suite}-start.png"),
                moment => format!("{suite}-{scheme}-{moment}.png"),
            };
            if names.contains(&name) {
                continue;
            }
            let path = folder.join(&name);
            image(field).write_png(&path).map_err(|error| output_fault(path, error))?;
            names.push(name);
        }
    }
    Ok(names)
}

/// One quadrant of the shell.
fn image(field: &suites::Field) -> FieldImage {
    let side = (0.0, 1.04e3 * verny::OUTER_RADIUS);
    let values = Field::new(field.label, field.values.clone(), ColorMap::Sequential)
        .with_range(field.range.0, field.range.1);
    let mut image = FieldImage::new(field.title.clone(), side, side)
        .with_particles(field.x.clone(), field.y.clone(), field.size.clone())
        .with_field(values);
    (image.x_label, image.y_label) = ("x [mm]".into(), "y [mm]".into());
    (image.cell, image.width) = (Cell::Disc, 800.0);
    image
}

fn output_fault(path: PathBuf, error: sph_io::IoError) -> ValidateError {
    ValidateError::Output { path, reason: error.to_string() }
}

fn line(style: fn(&str, &[f64], &[f64]) -> Series, label: &str, points: &[(f64, f64)]) -> Series {
    let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    style(label, &x, &y)
}

/// The outcomes whose profiles are shown, one a scheme.
fn shown<'a>(outcomes: &[&'a Outcome]) -> Vec<&'a Outcome> {
    let best = |scheme| {
        let of_scheme = outcomes.iter().copied().filter(move |o| o.case.scheme == scheme);
        of_scheme.filter(|o| o.case.n <= SHOWN_RESOLUTION).max_by_key(|o| o.case.n)
    };
    SchemeName::ALL.into_iter().filter_map(best).collect()
}

fn with_profiles(mut figure: Figure, outcomes: &[&Outcome]) -> Figure {
    for outcome in shown(outcomes) {
        let label = format!("{}, N = {}", outcome.case.scheme.title(), outcome.case.n);
        figure = figure.with(line(Series::line, &label, &outcome.curve));
    }
    figure
}

fn riemann_profile(outcomes: &[&Outcome]) -> Result<Figure, ValidateError> {
    let title = "Elastic-plastic Riemann problem, t = 2 µs";
    let figure = Figure::new(title, Axis::new("x [mm]").with_range(-15.0, 15.0), Axis::new("σ_{xx} [GPa]"));
    let exact = line(Series::dashed, "exact", &riemann::reference_curve()?).with_color(BLACK);
    Ok(with_profiles(figure, outcomes).with(exact))
}

fn sound_wave_profile(outcomes: &[&Outcome]) -> Figure {
    let title = "Longitudinal sound wave after 3 mm of travel";
    let figure = Figure::new(title, Axis::new("x [mm]").with_range(1.0, 5.0), Axis::new("U_x [m/s]"));
    let mesh = line(Series::dashed, "1-D Lagrangian mesh", &sound_wave::reference_curve());
    with_profiles(figure, outcomes).with(mesh.with_color(BLACK))
}

/// Places and errors of each scheme that was run, coarse to fine.
fn by_scheme(
    outcomes: &[&Outcome],
    point: impl Fn(&Outcome) -> (f64, f64),
) -> Vec<(SchemeName, Vec<(f64, f64)>)> {
    let points = |scheme| {
        let of_scheme = outcomes.iter().filter(|outcome| outcome.case.scheme == scheme);
        let mut points: Vec<(f64, f64)> = of_scheme.map(|outcome| point(outcome)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        (scheme, points)
    };
    SchemeName::ALL.into_iter().map(points).filter(|(_, points)| !points.is_empty()).collect()
}

/// Error over resolution, with the slope of an order to compare with.
fn convergence(outcomes: &[&Outcome], metric: Metric, order: f64) -> Figure {
    let error = |outcome: &Outcome| (f64::from(outcome.case.n), outcome.error(metric).unwrap_or(f64::NAN));
    let curves = by_scheme(outcomes, error);
    let points = || curves.iter().flat_map(|(_, points)| points.iter().copied());
    let mut resolutions: Vec<f64> = points().map(|(n, _)| n).collect();
    resolutions.sort_by(f64::total_cmp);
    resolutions.dedup();
    let [first, last] = [resolutions[0], resolutions[resolutions.len() - 1]];
    let extremes = |fold: fn(f64, f64) -> f64, start: f64| points().map(|(_, error)| error).fold(start, fold);
    let [least, greatest] = [extremes(f64::min, f64::INFINITY), extremes(f64::max, 0.0)];
    // The slope covers the last doubling and ends below the last point of the best curve: it hides nothing.
    let foot = 0.5 * least;
    let label = match metric {
        Metric::StressL1 => "L_1 error of σ_{xx} [GPa]",
        _ => "L_1 error of U_x [m/s]",
    };
    let y = Axis::log(label).with_range(0.6 * foot, 1.5 * greatest);
    let x = Axis::log("particles along x, N").with_ticks(&resolutions);
    let title = format!("{}: convergence", outcomes[0].case.suite.title());
    let mut figure = Figure::new(title, x, y);
    for (scheme, points) in &curves {
        figure = figure.with(line(Series::line_with_points, scheme.title(), points));
    }
    let start = (0.5 * last, foot * 2f64.powf(order));
    let slope = Annotation::Slope { start, to_x: last, order: -order, text: format!("order {order}") };
    if last > first { figure.with_annotation(slope) } else { figure }
}

/// The inner radius at the stop over the particle size: all schemes above, near the references below.
fn stop_radius(outcomes: &[&Outcome]) -> Result<Figure, ValidateError> {
    let [formula, by_square, _] = verny::references()?;
    let size = |outcome: &Outcome| 20.0 / f64::from(outcome.case.n);
    let radius = |outcome: &Outcome| (size(outcome), outcome.curve.first().map_or(f64::NAN, |point| point.1));
    let sizes = outcomes.iter().map(|outcome| size(outcome));
    let (least, greatest) = sizes.fold((f64::INFINITY, 0.0f64), |(a, b), d| (a.min(d), b.max(d)));
    // Flat series rather than annotations, so that they lie within the range of the plot.
    let flat = |style: fn(&str, &[f64], &[f64]) -> Series, label: &str, radius: f64| {
        let label = format!("{label}: {radius:.3} mm");
        style(&label, &[0.9 * least, 1.1 * greatest], &[radius, radius]).with_color(BLACK)
    };
    let panel = |y: Axis| {
        let mut panel = Panel::new(y);
        for (scheme, points) in by_scheme(outcomes, radius) {
            panel = panel.with(line(Series::line_with_points, scheme.title(), &points));
        }
        panel.with(flat(Series::dashed, "1-D mesh", by_square)).with(flat(
            Series::dotted,
            "rigid-plastic formula",
            formula,
        ))
    };
    let near = Axis::new("r'_0 [mm]").with_range(by_square - 0.08, formula + 0.05);
    let mut figure = Figure::stacked(
        "Verney's cylindrical shell: inner radius at the stop (mean of r²)",
        Axis::log("particle size D_0 [mm]").with_ticks(&[0.5, 1.0, 2.0, 4.0]),
    )
    .with_panel(panel(Axis::new("r'_0 [mm]")))
    .with_panel(panel(near).with_legend(LegendPosition::Hidden));
    figure.panel_height = 360.0;
    Ok(figure)
}
