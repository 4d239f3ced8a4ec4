//! Figures: curves and points with error bars, one panel or several over a shared x axis, as SVG and as PNG.
//!
//! A [`Figure`] is a plain description. Ranges, ticks, colors (told apart by color-blind readers) and the place of
//! the legend (the corner that hides no data; beside the panel if there is none) are chosen when it is drawn, unless
//! they are given. Values that are not finite, or not positive on a logarithmic axis, are left out: a curve has a gap
//! there. Labels take subscripts and superscripts as `u_s`, `sigma_{xx}`, `10^{-3}`; a backslash takes the next
//! character as it stands.
//!
//! ```no_run
//! use sph_io::plot::{Axis, Figure, Series};
//! # fn main() -> Result<(), sph_io::IoError> {
//! let (u_p, u_s, error) = (vec![100.0, 200.0], vec![425.0, 757.0], vec![4.0, 3.0]);
//! let figure = Figure::new("Porous copper", Axis::new("u_p [m/s]"), Axis::new("u_s [m/s]"))
//!     .with(Series::points("computed", &u_p, &u_s).with_error(&error))
//!     .with(Series::line("published fit", &[100.0, 200.0], &[415.4, 713.3]));
//! figure.write_svg("u_s.svg")?;
//! figure.write_png("u_s.png")
//! # }
//! ```

mod data;
mod layout;
mod legend;

use crate::draw::compact::compact;
use crate::{Color, IoError, atomic};
use std::path::Path;

/// One axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it shows, with the unit in brackets.
    pub label: String,
    /// Whether it is logarithmic.
    pub log: bool,
    /// Least and greatest value shown; chosen from the data if absent.
    pub range: Option<(f64, f64)>,
    /// Values that carry numbers, such as the resolutions of a study; chosen if absent.
    pub ticks: Option<Vec<f64>>,
}

impl Axis {
    /// A linear axis with a range chosen from the data.
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), log: false, range: None, ticks: None }
    }

    /// A logarithmic axis with a range chosen from the data.
    pub fn log(label: impl Into<String>) -> Self {
        Self { log: true, ..Self::new(label) }
    }

    /// The axis with a fixed range.
    #[must_use]
    pub fn with_range(self, low: f64, high: f64) -> Self {
        Self { range: Some((low, high)), ..self }
    }

    /// The axis with numbers at these values only.
    #[must_use]
    pub fn with_ticks(self, values: &[f64]) -> Self {
        Self { ticks: Some(values.to_vec()), ..self }
    }
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// A solid line.
    Line,
    /// A dashed line.
    Dashed,
    /// A dotted line.
    Dotted,
    /// Markers; with error bars where the series has errors.
    Points,
    /// Markers joined by a line; with error bars where the series has errors.
    LineWithPoints,
    /// The area between y and the lower ends, in a light shade.
    Band,
}

/// One curve or set of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Words in the legend; no entry if empty.
    pub label: String,
    /// How it is drawn.
    pub style: Style,
    /// Abscissas.
    pub x: Vec<f64>,
    /// Ordinates.
    pub y: Vec<f64>,
    /// Half lengths of the error bars in y, if any.
    pub y_error: Option<Vec<f64>>,
    /// Half lengths of the error bars in x, if any.
    pub x_error: Option<Vec<f64>>,
    /// Lower ends of a [`Style::Band`].
    pub lower: Option<Vec<f64>>,
    /// Color; the next of [`Color::CYCLE`] if absent.
    pub color: Option<Color>,
}

impl Series {
    fn new(style: Style, label: &str, x: &[f64], y: &[f64]) -> Self {
        Self {
            label: label.to_owned(),
            style,
            x: x.to_vec(),
            y: y.to_vec(),
            y_error: None,
            x_error: None,
            lower: None,
            color: None,
        }
    }

    /// A solid line.
    #[must_use]
    pub fn line(label: &str, x: &[f64], y: &[f64]) -> Self {
        Self::new(Style::Line, label, x, y)
    }

    /// A dashed line.
    #[must_use]
    pub fn dashed(label: &str, x: &[f64], y: &[f64]) -> Self {
        Self::new(Style::Dashed, label, x, y)
    }

    /// A dotted line.
    #[must_use]
    pub fn dotted(label: &str, x: &[f64], y: &[f64]) -> Self {
        Self::new(Style::Dotted, label, x, y)
    }

    /// Markers.
    #[must_use]
    pub fn points(label: &str, x: &[f64], y: &[f64]) -> Self {
        Self::new(Style::Points, label, x, y)
    }

    /// Markers joined by a line.
    #[must_use]
    pub fn line_with_points(label: &str, x: &[f64], y: &[f64]) -> Self {
        Self::new(Style::LineWithPoints, label, x, y)
    }

    /// A shaded area between two curves.
    #[must_use]
    pub fn band(label: &str, x: &[f64], low: &[f64], high: &[f64]) -> Self {
        Self { lower: Some(low.to_vec()), ..Self::new(Style::Band, label, x, high) }
    }

    /// The series with error bars of these half lengths.
    #[must_use]
    pub fn with_error(self, y_error: &[f64]) -> Self {
        Self { y_error: Some(y_error.to_vec()), ..self }
    }

    /// The series with error bars along x of these half lengths.
    #[must_use]
    pub fn with_x_error(self, x_error: &[f64]) -> Self {
        Self { x_error: Some(x_error.to_vec()), ..self }
    }

    /// The series in a given color.
    #[must_use]
    pub const fn with_color(mut self, color: Color) -> Self {
        self.color = Some(color);
        self
    }
}

/// Words and lines beside the data. They do not widen the ranges chosen from the data.
#[derive(Debug, Clone, PartialEq)]
pub enum Annotation {
    /// Words that begin at a point.
    Text {
        /// Abscissa of their left end.
        x: f64,
        /// Ordinate of their base line.
        y: f64,
        /// The words.
        text: String,
    },
    /// A thin line across the panel at one ordinate, with words above its right end.
    Horizontal {
        /// Ordinate.
        y: f64,
        /// The words.
        text: String,
    },
    /// A thin line across the panel at one abscissa, with words along its upper end.
    Vertical {
        /// Abscissa.
        x: f64,
        /// The words.
        text: String,
    },
    /// A thin dashed line `y = y_0 (x / x_0)^order` from `x_0` to `x_1`, with words at its end: a slope to compare
    /// with on logarithmic axes.
    Slope {
        /// The end that is given.
        start: (f64, f64),
        /// Abscissa of the other end.
        to_x: f64,
        /// Exponent; negative where y falls.
        order: f64,
        /// The words.
        text: String,
    },
}

/// Where the legend stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LegendPosition {
    /// The place inside that hides no data, or beside the panel if there is none. In a stack, a panel whose entries
    /// are those of the first panel goes without.
    #[default]
    Auto,
    /// Inside, upper left.
    TopLeft,
    /// Inside, upper right.
    TopRight,
    /// Inside, lower left.
    BottomLeft,
    /// Inside, lower right.
    BottomRight,
    /// Beside the panel, at its right.
    Outside,
    /// No legend.
    Hidden,
}

/// One set of axes; in a stack its x axis is the figure's.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The y axis.
    pub y: Axis,
    /// The data; the first is drawn first.
    pub series: Vec<Series>,
    /// Words and lines beside the data.
    pub annotations: Vec<Annotation>,
    /// Where the legend stands.
    pub legend: LegendPosition,
}

impl Panel {
    /// An empty panel.
    #[must_use]
    pub const fn new(y: Axis) -> Self {
        Self { y, series: Vec::new(), annotations: Vec::new(), legend: LegendPosition::Auto }
    }

    /// The panel with one more series.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// The panel with one more annotation.
    #[must_use]
    pub fn with_annotation(mut self, annotation: Annotation) -> Self {
        self.annotations.push(annotation);
        self
    }

    /// The panel with its legend elsewhere, or without.
    #[must_use]
    pub const fn with_legend(mut self, legend: LegendPosition) -> Self {
        self.legend = legend;
        self
    }
}

/// A figure: one panel, or several above one another over a shared x axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Words above the panels; no room is taken if empty.
    pub title: String,
    /// The x axis.
    pub x: Axis,
    /// The panels from above to below.
    pub panels: Vec<Panel>,
    /// Width of the whole figure in points (1/96 inch); the PNG has two pixels a point.
    pub width: f64,
    /// Height of each panel in points.
    pub panel_height: f64,
}

impl Figure {
    /// A figure with one empty panel.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self { title: title.into(), x, panels: vec![Panel::new(y)], width: 900.0, panel_height: 520.0 }
    }

    /// A figure to be filled with panels that share the x axis.
    pub fn stacked(title: impl Into<String>, x: Axis) -> Self {
        Self { title: title.into(), x, panels: Vec::new(), width: 900.0, panel_height: 240.0 }
    }

    /// The figure with one more panel below.
    #[must_use]
    pub fn with_panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// The figure with one more series in its last panel.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.last_panel().series.push(series);
        self
    }

    /// The figure with one more annotation in its last panel.
    #[must_use]
    pub fn with_annotation(mut self, annotation: Annotation) -> Self {
        self.last_panel().annotations.push(annotation);
        self
    }

    /// The figure with the legend of its last panel elsewhere, or without.
    #[must_use]
    pub fn with_legend(mut self, legend: LegendPosition) -> Self {
        self.last_panel().legend = legend;
        self
    }

    fn last_panel(&mut self) -> &mut Panel {
        if self.panels.is_empty() {
            self.panels.push(Panel::new(Axis::new("")));
        }
        let last = self.panels.len() - 1;
        &mut self.panels[last]
    }

    /// Writes the figure as SVG, atomically.
    ///
    /// # Errors
    /// [`IoError::Invalid`] for columns of unequal length or an unusable range, [`IoError::File`] from the system.
    pub fn write_svg(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        let path = path.as_ref();
        let svg = self.to_svg().map_err(|reason| IoError::invalid(path, reason))?;
        atomic::write_atomic(path, svg.as_bytes())
    }

    /// The figure as SVG; the reason if it cannot be drawn.
    pub(crate) fn to_svg(&self) -> Result<String, String> {
        self.check()?;
        Ok(compact(&layout::draw(self).into_svg()))
    }

    /// Writes the figure as PNG, atomically.
    ///
    /// # Errors
    /// As [`Figure::write_svg`].
    pub fn write_png(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        let path = path.as_ref();
        self.check().map_err(|reason| IoError::invalid(path, reason))?;
        let png = layout::draw(self).into_raster().and_then(|raster| raster.to_png());
        let png = png.map_err(|reason| IoError::invalid(path, reason))?;
        atomic::write_atomic(path, &png)
    }

    fn check(&self) -> Result<(), String> {
        if !(100.0..=20_000.0).contains(&self.width) || !(50.0..=20_000.0).contains(&self.panel_height) {
            return Err(format!("a size of {} by {} points cannot be drawn", self.width, self.panel_height));
        }
        check_axis(&self.x)?;
        for panel in &self.panels {
            check_axis(&panel.y)?;
            panel.series.iter().try_for_each(check_series)?;
        }
        Ok(())
    }
}

fn check_axis(axis: &Axis) -> Result<(), String> {
    let Some((low, high)) = axis.range else { return Ok(()) };
    let usable = low < high && low.abs().max(high.abs()) <= 1e300 && (!axis.log || low >= 1e-300);
    if usable { Ok(()) } else { Err(format!("axis `{}` has no range from {low} to {high}", axis.label)) }
}

fn check_series(series: &Series) -> Result<(), String> {
    let (n_x, n_y) = (series.x.len(), series.y.len());
    let n_error = series.y_error.as_ref().map_or(n_x, Vec::len);
    let others = [&series.x_error, &series.lower];
    if n_x == n_y && n_x == n_error && others.iter().all(|v| v.as_ref().is_none_or(|v| v.len() == n_x)) {
        return Ok(());
    }
    Err(format!("series `{}` has {n_x} x, {n_y} y and {n_error} errors", series.label))
}
