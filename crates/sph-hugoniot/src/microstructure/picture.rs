//! A picture of the sample: two by two periods, materials and voids in their colors, particles to scale.

use std::path::Path;

use sph_io::IoError;
use sph_io::field_image::{Cell, Field, FieldImage};

use super::Sample;
use crate::config::Case;
use crate::config::units::significant;

/// Microns in a meter.
const MICRO: f64 = 1e6;
/// Periods along each axis.
const PERIODS: usize = 2;

/// Draws the sample of a case into a PNG file.
///
/// # Errors
/// If it cannot be written.
pub fn write(case: &Case, sample: &Sample, path: &Path) -> Result<(), IoError> {
    draw(case, sample).write_png(path)
}

/// The picture of the sample of a case.
pub fn draw(case: &Case, sample: &Sample) -> FieldImage {
    let size = (sample.cell * MICRO, sample.height * MICRO);
    let title = case.name.clone();
    let label = format!(
        "2 × 2 cells of {} × {} µm, m = {:.4}, {} particles each",
        significant((size.0 * 1e3).round() / 1e3),
        significant((size.1 * 1e3).round() / 1e3),
        sample.porosity,
        sample.particles.len()
    );
    let (mut x, mut y, mut diameter, mut material) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for period in 0..PERIODS {
        for p in &sample.particles {
            x.push(p.position.x * MICRO + period as f64 * size.0);
            y.push(p.position.y * MICRO);
            diameter.push(p.size * MICRO);
            material.push(f64::from(p.material));
        }
    }
    let names = case.materials().iter().map(|m| m.name.clone()).collect::<Vec<_>>();
    let field = Field::categories(label, material, names);
    let mut image = FieldImage::new(title, (0.0, PERIODS as f64 * size.0), (0.0, size.1))
        .with_particles(x, y, diameter)
        .with_field(field)
        .with_periods(PERIODS);
    image.cell = Cell::Disc;
    // A picture about as high as wide is enough for a square cell.
    image.width = (800.0 * (size.0 / size.1).sqrt()).clamp(680.0, 1400.0);
    image
}
