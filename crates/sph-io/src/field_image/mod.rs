//! Pictures of fields that particles carry: each particle's cell is painted in the color of its value.
//!
//! Several fields stand above one another over the same particles, each with its color bar. A window that is long
//! and thin is made readable by cutting it into strips that stand below one another ([`FieldImage::n_strips`]) and by
//! repeating its period in y ([`FieldImage::n_periods`]). Both axes have the same scale. What no cell covers is
//! light gray. Where cells overlap, a pixel belongs to the particle that it is nearest to, relative to its size.
//!
//! Particles whose value is not finite are painted magenta.

mod color_map;
mod layout;
mod paint;

pub use color_map::ColorMap;

use crate::{IoError, atomic};
use std::path::Path;

/// The shape of a particle's cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cell {
    /// An upright square; `size` is its edge.
    #[default]
    Square,
    /// A disc; `size` is its diameter.
    Disc,
}

/// One field.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// What it is, with the unit in brackets; the marks of [`crate::plot`] apply.
    pub label: String,
    /// One value a particle, in the label's unit.
    pub values: Vec<f64>,
    /// Colors.
    pub map: ColorMap,
    /// Values at the ends of the color bar; if absent, all values but the outermost 0.2 % at each end lie between
    /// them, and a diverging map is centered at zero. Values outside have the color of the end.
    pub range: Option<(f64, f64)>,
    /// Names of the values 0, 1, …, shown beside the bar in place of numbers; none for other fields.
    pub names: Vec<String>,
}

impl Field {
    /// A field with a range chosen from its values.
    pub fn new(label: impl Into<String>, values: impl Into<Vec<f64>>, map: ColorMap) -> Self {
        Self { label: label.into(), values: values.into(), map, range: None, names: Vec::new() }
    }

    /// Kinds of things: values are whole numbers, each with its color and name.
    pub fn categories(label: impl Into<String>, values: impl Into<Vec<f64>>, names: Vec<String>) -> Self {
        let map = ColorMap::Categories(names.len());
        Self { names, ..Self::new(label, values, map) }
    }

    /// The field with a fixed range, so that pictures of several times can be compared.
    #[must_use]
    pub const fn with_range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }
}

/// A picture of one or more fields over the same particles. Lengths are in the unit that the axis labels name.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldImage {
    /// Words above the picture; no room is taken if empty.
    pub title: String,
    /// Label of the x axis, with the unit in brackets.
    pub x_label: String,
    /// Label of the y axis, with the unit in brackets.
    pub y_label: String,
    /// Places of the particles along x.
    pub x: Vec<f64>,
    /// Places of the particles along y.
    pub y: Vec<f64>,
    /// Extent of each particle's cell.
    pub size: Vec<f64>,
    /// Shape of the cells.
    pub cell: Cell,
    /// Part of the x axis to be shown.
    pub x_range: (f64, f64),
    /// Part of the y axis to be shown; one period of it if it is to be repeated.
    pub y_range: (f64, f64),
    /// Number of strips into which the picture is cut along x.
    pub n_strips: usize,
    /// Number of times that the range in y is shown.
    pub n_periods: usize,
    /// The fields from above to below.
    pub fields: Vec<Field>,
    /// Width of the whole picture in points (1/96 inch); there are two pixels a point.
    pub width: f64,
}

impl FieldImage {
    /// A picture without fields, with axes in micrometers, that shows the given part of the plane.
    pub fn new(title: impl Into<String>, x_range: (f64, f64), y_range: (f64, f64)) -> Self {
        Self {
            title: title.into(),
            x_label: "x [µm]".into(),
            y_label: "y [µm]".into(),
            x: Vec::new(),
            y: Vec::new(),
            size: Vec::new(),
            cell: Cell::Square,
            x_range,
            y_range,
            n_strips: 1,
            n_periods: 1,
            fields: Vec::new(),
            width: 1200.0,
        }
    }

    /// The picture with these particles: places and extent of their cells.
    #[must_use]
    pub fn with_particles(
        self,
        x: impl Into<Vec<f64>>,
        y: impl Into<Vec<f64>>,
        size: impl Into<Vec<f64>>,
    ) -> Self {
        Self { x: x.into(), y: y.into(), size: size.into(), ..self }
    }

    /// The picture with one more field below.
    #[must_use]
    pub fn with_field(mut self, field: Field) -> Self {
        self.fields.push(field);
        self
    }

    /// The picture cut into strips along x.
    #[must_use]
    pub fn with_strips(self, n_strips: usize) -> Self {
        Self { n_strips, ..self }
    }

    /// The picture with its range in y repeated; particles just outside the range are taken as images of those
    /// within.
    #[must_use]
    pub fn with_periods(self, n_periods: usize) -> Self {
        Self { n_periods, ..self }
    }

    /// Writes the picture as PNG, atomically.
    ///
    /// # Errors
    /// [`IoError::Invalid`] for columns of unequal length, an empty range or a picture too high to be drawn,
    /// [`IoError::File`] from the system.
    pub fn write_png(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        let path = path.as_ref();
        let png = self.to_png().map_err(|reason| IoError::invalid(path, reason))?;
        atomic::write_atomic(path, &png)
    }

    /// The picture as PNG; the reason if it cannot be drawn.
    pub(crate) fn to_png(&self) -> Result<Vec<u8>, String> {
        self.check()?;
        layout::draw(self)?.to_png()
    }

    /// The picture as a PNG for a page: half the pixels a side and a palette; the reason if it cannot be drawn.
    pub(crate) fn to_small_png(&self) -> Result<Vec<u8>, String> {
        self.check()?;
        layout::draw(self)?.halved().to_palette_png()
    }

    fn check(&self) -> Result<(), String> {
        let n = self.x.len();
        let lengths =
            [("y", self.y.len()), ("size", self.size.len())].map(|(name, length)| (name.to_owned(), length));
        let fields = self.fields.iter().map(|field| (field.label.clone(), field.values.len()));
        if let Some((name, length)) = lengths.into_iter().chain(fields).find(|(_, length)| *length != n) {
            return Err(format!("`{name}` has {length} values for {n} particles"));
        }
        let ranges = self.fields.iter().filter_map(|field| field.range).chain([self.x_range, self.y_range]);
        if let Some((low, high)) = ranges.into_iter().find(|range| !is_usable(*range)) {
            return Err(format!("there is no range from {low} to {high}"));
        }
        if self.n_strips == 0 || self.n_periods == 0 || !(300.0..=10_000.0).contains(&self.width) {
            return Err(
                "strips, periods and width must be positive, the width 300 to 10,000 points".to_owned()
            );
        }
        Ok(())
    }
}

fn is_usable((low, high): (f64, f64)) -> bool {
    low < high && low.abs().max(high.abs()) <= 1e300
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_column_is_named() {
        let image = FieldImage::new("", (0.0, 1.0), (0.0, 1.0))
            .with_particles([0.5], [0.5], [0.1])
            .with_field(Field::new("rho", [1.0, 2.0], ColorMap::Sequential));
        let folder = tempfile::tempdir().unwrap();
        let error = image.write_png(folder.path().join("a.png")).unwrap_err().to_string();
        assert!(error.contains("`rho` has 2 values for 1 particles"), "{error}");
    }

    #[test]
    fn an_empty_range_and_a_tower_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        assert!(FieldImage::new("", (1.0, 1.0), (0.0, 1.0)).write_png(&path).is_err());
        let tower = FieldImage::new("", (0.0, 1.0), (0.0, 1e6)).with_field(Field::new(
            "rho",
            [],
            ColorMap::Sequential,
        ));
        assert!(tower.write_png(&path).unwrap_err().to_string().contains("too high"));
    }
}
