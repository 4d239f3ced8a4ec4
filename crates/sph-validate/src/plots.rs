//! Parts of plots that suites share: profiles beside a reference, convergence, fields; and the files.

use std::path::{Path, PathBuf};

use sph_io::Color;
use sph_io::field_image::{Cell, ColorMap, FieldImage};
use sph_io::plot::{Annotation, Axis, Figure, Series};

use crate::case::SchemeName;
use crate::error::ValidateError;
use crate::metric::Metric;
use crate::outcome::{Field, Outcome};
use crate::report::error_of;
use crate::runner::Ended;
use crate::suites::{About, Drawing, Picture};

/// Profiles are shown at this resolution, or the greatest below it: where the schemes can still be told apart.
const SHOWN_RESOLUTION: u32 = 400;

/// Color of references.
pub const BLACK: Color = Color::rgb(0, 0, 0);

/// A picture that was written.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Written {
    /// Name of the suite.
    pub suite: String,
    /// File in the folder of the report, PNG.
    pub file: String,
    /// The same as SVG, for plots.
    pub vector: Option<String>,
    /// What it shows.
    pub caption: String,
}

/// Draws all pictures of the runs that have ended into `folder`.
///
/// # Errors
/// If a suite cannot draw its pictures or a file cannot be written.
pub fn write_pictures(ended: &[Ended<'_>], folder: &Path) -> Result<Vec<Written>, ValidateError> {
    let mut written = Vec::new();
    for suite in crate::runner::suites_of(ended) {
        let name = suite.about().name;
        let of_suite = ended.iter().filter(|ended| ended.job.case.suite == name);
        let outcomes: Vec<&Outcome> = of_suite.filter_map(|ended| ended.result.as_ref().ok()).collect();
        if outcomes.is_empty() {
            continue;
        }
        for picture in suite.pictures(&outcomes)? {
            written.push(write(name, &picture, folder)?);
        }
    }
    Ok(written)
}

fn write(suite: &str, picture: &Picture, folder: &Path) -> Result<Written, ValidateError> {
    let file = format!("{}.png", picture.name);
    let path = folder.join(&file);
    let vector = match &picture.drawing {
        Drawing::Plot(figure) => {
            figure.write_png(&path).map_err(|error| output_fault(path, error))?;
            let vector = format!("{}.svg", picture.name);
            let path = folder.join(&vector);
            figure.write_svg(&path).map_err(|error| output_fault(path, error))?;
            Some(vector)
        }
        Drawing::Field(image) => {
            image.write_png(&path).map_err(|error| output_fault(path, error))?;
            None
        }
    };
    Ok(Written { suite: suite.to_owned(), file, vector, caption: picture.caption.clone() })
}

fn output_fault(path: PathBuf, error: sph_io::IoError) -> ValidateError {
    ValidateError::Output { path, reason: error.to_string() }
}

/// A series of points.
pub fn line(style: fn(&str, &[f64], &[f64]) -> Series, label: &str, points: &[(f64, f64)]) -> Series {
    let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
    style(label, &x, &y)
}

/// The figure with the curve of that name of each variant and scheme, at a resolution where schemes can be told apart,
/// and the reference on top, dashed.
pub fn profiles(
    mut figure: Figure,
    outcomes: &[&Outcome],
    curve: &str,
    (label, reference): (&str, &[(f64, f64)]),
) -> Figure {
    for outcome in shown(outcomes) {
        let label = format!("{}, n = {}", kin_label(outcome, outcomes), outcome.case.n);
        figure = figure.with(line(Series::line, &label, outcome.curve(curve)));
    }
    figure.with(line(Series::dashed, label, reference).with_color(BLACK))
}

/// The outcomes whose profiles are shown, one of each kin.
fn shown<'a>(outcomes: &[&'a Outcome]) -> Vec<&'a Outcome> {
    let of_kin = kins(outcomes).into_iter();
    let best = |kin: Vec<&'a Outcome>| {
        let below = kin.iter().copied().filter(|o| o.case.n <= SHOWN_RESOLUTION).max_by_key(|o| o.case.n);
        below.or_else(|| kin.iter().copied().min_by_key(|o| o.case.n))
    };
    of_kin.filter_map(best).collect()
}

/// The outcomes of a variant.
pub fn of_variant<'a>(outcomes: &[&'a Outcome], variant: &str) -> Vec<&'a Outcome> {
    outcomes.iter().copied().filter(|outcome| outcome.case.variant == variant).collect()
}

/// The points of a curve of all runs of each scheme, as marks.
pub fn marks_by_scheme(mut figure: Figure, outcomes: &[&Outcome], curve: &str) -> Figure {
    for scheme in SchemeName::ALL {
        let of_scheme = outcomes.iter().filter(|outcome| outcome.case.scheme == scheme);
        let points: Vec<(f64, f64)> =
            of_scheme.flat_map(|outcome| outcome.curve(curve).iter().copied()).collect();
        if !points.is_empty() {
            figure = figure.with(line(Series::points, scheme.title(), &points));
        }
    }
    figure
}

/// Outcomes of the same variant and scheme together, in the order of their first ones, coarse to fine.
fn kins<'a>(outcomes: &[&'a Outcome]) -> Vec<Vec<&'a Outcome>> {
    let mut kins: Vec<Vec<&Outcome>> = Vec::new();
    for &outcome in outcomes {
        match kins.iter_mut().find(|kin| kin[0].case.is_kin_of(&outcome.case)) {
            Some(kin) => kin.push(outcome),
            None => kins.push(vec![outcome]),
        }
    }
    kins.iter_mut().for_each(|kin| kin.sort_by_key(|outcome| outcome.case.n));
    kins
}

/// Scheme, variant, or both: what tells a kin from the others.
fn kin_label(outcome: &Outcome, outcomes: &[&Outcome]) -> String {
    let case = &outcome.case;
    let one_scheme = outcomes.iter().all(|other| other.case.scheme == case.scheme);
    match (case.variant.as_str(), one_scheme) {
        ("", _) => case.scheme.title().to_owned(),
        (variant, true) => variant.to_owned(),
        (variant, false) => format!("{variant}, {}", case.scheme.title()),
    }
}

/// Points of each kin with its label, in rising order of the first coordinate.
pub fn by_kin(
    outcomes: &[&Outcome],
    point: impl Fn(&Outcome) -> (f64, f64),
) -> Vec<(String, Vec<(f64, f64)>)> {
    let points = |kin: Vec<&Outcome>| {
        let mut points: Vec<(f64, f64)> = kin.iter().map(|outcome| point(outcome)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        (kin_label(kin[0], outcomes), points)
    };
    kins(outcomes).into_iter().map(points).collect()
}

/// One plot of convergence for each figure that has an order.
pub fn convergences(about: &About, outcomes: &[&Outcome]) -> Vec<Picture> {
    let mut metrics: Vec<Metric> = Vec::new();
    for figure in outcomes.iter().flat_map(|outcome| &outcome.measurements) {
        if figure.metric.has_order() && !metrics.contains(&figure.metric) {
            metrics.push(figure.metric.clone());
        }
    }
    let is_only = metrics.len() == 1;
    let picture = |metric: Metric| {
        let which = if is_only { String::new() } else { format!("-{}", metric.name.replace('_', "-")) };
        Picture {
            name: format!("{}-convergence{which}", about.name),
            caption: format!("{} over {}", metric.title(), about.resolution),
            drawing: Drawing::Plot(convergence(about, outcomes, &metric)),
        }
    };
    metrics.into_iter().map(picture).collect()
}

/// Error over resolution, with the slopes of the first and the second order to compare with.
pub fn convergence(about: &About, outcomes: &[&Outcome], metric: &Metric) -> Figure {
    let error = |outcome: &Outcome| (f64::from(outcome.case.n), error_of(outcome, metric, outcomes));
    let is_error = |point: &(f64, f64)| point.1 > 0.0 && point.1.is_finite();
    let curves = by_kin(outcomes, error).into_iter();
    let curves: Vec<(String, Vec<(f64, f64)>)> =
        curves.map(|(label, points)| (label, points.into_iter().filter(is_error).collect())).collect();
    let points = || curves.iter().flat_map(|(_, points)| points.iter().copied());
    let mut resolutions: Vec<f64> = points().map(|(n, _)| n).collect();
    resolutions.sort_by(f64::total_cmp);
    resolutions.dedup();
    let extremes = |fold: fn(f64, f64) -> f64, start: f64| points().map(|(_, error)| error).fold(start, fold);
    let [least, greatest] = [extremes(f64::min, f64::INFINITY), extremes(f64::max, 0.0)];
    // The slopes part from one point over the last doubling, below all points: they hide nothing.
    let top = 0.8 * least;
    let y = Axis::log(format!("{} [{}]", metric.title(), metric.unit)).with_range(0.12 * top, 1.5 * greatest);
    let x = Axis::log(about.resolution).with_ticks(&resolutions);
    let mut figure = Figure::new(format!("{}: convergence", about.title), x, y);
    for (label, points) in curves.iter().filter(|(_, points)| !points.is_empty()) {
        figure = figure.with(line(Series::line_with_points, label, points));
    }
    let [Some(first), Some(last)] = [resolutions.first(), resolutions.last()].map(Option::<&f64>::copied)
    else {
        return figure;
    };
    let slope = |order: f64| Annotation::Slope {
        start: (0.5 * last, top),
        to_x: last,
        order: -order,
        text: format!("order {order}"),
    };
    if last > first { figure.with_annotation(slope(1.0)).with_annotation(slope(2.0)) } else { figure }
}

/// Pictures of the fields of the finest run of each kin; those named `start` are alike and drawn once a variant.
pub fn fields(suite: &str, outcomes: &[&Outcome], image: impl Fn(&Field) -> FieldImage) -> Vec<Picture> {
    let mut pictures: Vec<Picture> = Vec::new();
    for outcome in kins(outcomes).into_iter().filter_map(|kin| kin.last().copied()) {
        let variant = match outcome.case.variant.as_str() {
            "" => String::new(),
            variant => format!("-{variant}"),
        };
        for field in &outcome.fields {
            let name = match field.name.as_str() {
                "start" => format!("{suite}{variant}-start"),
                moment => format!("{suite}{variant}-{}-{moment}", outcome.case.scheme),
            };
            if pictures.iter().all(|picture| picture.name != name) {
                let caption = format!("{}: {}", field.title, field.label);
                pictures.push(Picture { name, caption, drawing: Drawing::Field(image(field)) });
            }
        }
    }
    pictures
}

/// A field over the particles in a frame [mm], as discs.
pub fn field_image(field: &Field, x_range: (f64, f64), y_range: (f64, f64)) -> FieldImage {
    let values =
        sph_io::field_image::Field::new(field.label.clone(), field.values.clone(), ColorMap::Sequential)
            .with_range(field.range.0, field.range.1);
    let mut image = FieldImage::new(field.title.clone(), x_range, y_range)
        .with_particles(field.x.clone(), field.y.clone(), field.size.clone())
        .with_field(values);
    (image.x_label, image.y_label) = ("x [mm]".into(), "y [mm]".into());
    (image.cell, image.width) = (Cell::Disc, 800.0);
    image
}
