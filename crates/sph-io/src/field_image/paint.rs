//! Pixels: whose cell covers each, and what color that makes.

use super::color_map::ColorMap;
use super::{Cell, FieldImage};
use crate::Color;
use crate::draw::raster::Raster;

/// Samples along each edge of a pixel; their colors are averaged.
const N_SAMPLES: usize = 2;
/// Marks a sample that no cell covers.
const NOBODY: u32 = u32::MAX;
/// Color of particles whose value is not finite.
const NOT_FINITE: Color = Color::rgb(255, 0, 255);
/// Cells reach a little over their edge, so that rounding leaves no seam between neighbors.
const OVERLAP: f64 = 1.0 + 1e-3;

/// A rectangle of whole pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PixelArea {
    pub left: usize,
    pub top: usize,
    pub width: usize,
    pub height: usize,
}

/// For each sample of a pixel area, the particle that covers it.
pub(super) struct Owners {
    area: PixelArea,
    n_columns: usize,
    owner: Vec<u32>,
}

/// Samples per unit of length, and the place of the upper left corner.
struct Mapping {
    per_unit: (f64, f64),
    corner: (f64, f64),
}

/// Finds who covers the samples of an area that shows `x_range` by `y_range`.
pub(super) fn owners(
    image: &FieldImage,
    area: PixelArea,
    x_range: (f64, f64),
    y_range: (f64, f64),
) -> Owners {
    let (n_columns, n_rows) = (area.width * N_SAMPLES, area.height * N_SAMPLES);
    let mapping = Mapping {
        per_unit: (n_columns as f64 / (x_range.1 - x_range.0), n_rows as f64 / (y_range.1 - y_range.0)),
        corner: (x_range.0, y_range.1),
    };
    let mut owners = Owners { area, n_columns, owner: vec![NOBODY; n_columns * n_rows] };
    let mut nearest = vec![OVERLAP as f32; n_columns * n_rows];
    let period = image.y_range.1 - image.y_range.0;
    let n_images = if image.n_periods > 1 { image.n_periods as i64 } else { 0 };
    let images = if n_images > 0 { -1..=n_images } else { 0..=0 };
    for shift in images.map(|k| k as f64 * period) {
        for idx in 0..image.x.len() {
            let center = (image.x[idx], image.y[idx] + shift);
            owners.claim(&mut nearest, &mapping, idx, center, 0.5 * image.size[idx], image.cell);
        }
    }
    owners
}

impl Owners {
    /// Gives a particle the samples that lie nearer to it than to any earlier one.
    fn claim(
        &mut self,
        nearest: &mut [f32],
        mapping: &Mapping,
        idx: usize,
        center: (f64, f64),
        half: f64,
        cell: Cell,
    ) {
        let (u, v) = (
            (center.0 - mapping.corner.0) * mapping.per_unit.0,
            (mapping.corner.1 - center.1) * mapping.per_unit.1,
        );
        let (du, dv) = (half * mapping.per_unit.0, half * mapping.per_unit.1);
        let n_rows = self.owner.len() / self.n_columns.max(1);
        for row in covered(v, dv, n_rows) {
            for column in covered(u, du, self.n_columns) {
                let (a, b) = ((column as f64 + 0.5 - u) / du, (row as f64 + 0.5 - v) / dv);
                let distance = match cell {
                    Cell::Square => a.abs().max(b.abs()),
                    Cell::Disc => a.hypot(b),
                } as f32;
                let sample = row * self.n_columns + column;
                if distance < nearest[sample] {
                    nearest[sample] = distance;
                    self.owner[sample] = idx as u32;
                }
            }
        }
    }

    /// Paints the colors of one field, with the upper left corner at the pixel `corner`.
    pub fn paint(
        &self,
        raster: &mut Raster,
        corner: (usize, usize),
        values: &[f64],
        map: ColorMap,
        (low, high): (f64, f64),
    ) {
        // Once a particle, not once a sample: a color map is a costly function.
        let color = |value: &f64| match value.is_finite() {
            false => NOT_FINITE,
            true => map.color((value - low) / (high - low)),
        };
        let colors: Vec<Color> = values.iter().map(color).collect();
        let color_of = |owner: u32| colors.get(owner as usize).copied().unwrap_or(map.void());
        for row in 0..self.area.height {
            for column in 0..self.area.width {
                let samples = self.samples(column, row).map(color_of);
                raster.set(corner.0 + column, corner.1 + row, mean(samples));
            }
        }
    }

    fn samples(&self, column: usize, row: usize) -> impl Iterator<Item = u32> {
        (0..N_SAMPLES * N_SAMPLES).map(move |k| {
            let (sub_row, sub_column) = (row * N_SAMPLES + k / N_SAMPLES, column * N_SAMPLES + k % N_SAMPLES);
            self.owner[sub_row * self.n_columns + sub_column]
        })
    }
}

/// The samples whose middle may lie within `half` of `center`; none for a size or place that is not finite.
fn covered(center: f64, half: f64, n: usize) -> std::ops::Range<usize> {
    if !(half > 0.0 && half.is_finite() && center.is_finite()) {
        return 0..0;
    }
    let limit = |place: f64| place.clamp(0.0, n as f64) as usize;
    limit((center - half * OVERLAP - 0.5).floor())..limit((center + half * OVERLAP + 0.5).ceil())
}

fn mean(colors: impl Iterator<Item = Color>) -> Color {
    let mut sum = [0u32; 3];
    for color in colors {
        sum[0] += u32::from(color.red);
        sum[1] += u32::from(color.green);
        sum[2] += u32::from(color.blue);
    }
    let n = (N_SAMPLES * N_SAMPLES) as u32;
    let [red, green, blue] = sum.map(|channel| ((channel + n / 2) / n) as u8);
    Color::rgb(red, green, blue)
}

/// Paints a color bar, greatest value above.
pub(super) fn paint_bar(raster: &mut Raster, area: PixelArea, map: ColorMap) {
    for row in 0..area.height {
        let color = map.color(1.0 - (row as f64 + 0.5) / area.height as f64);
        (0..area.width).for_each(|column| raster.set(area.left + column, area.top + row, color));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field_image::Field;

    /// A lattice of `n` by `n` unit squares with the value of its row.
    fn lattice(n: usize) -> FieldImage {
        let places: Vec<(f64, f64)> =
            (0..n * n).map(|k| ((k % n) as f64 + 0.5, (k / n) as f64 + 0.5)).collect();
        let (x, y): (Vec<f64>, Vec<f64>) = places.into_iter().unzip();
        let values = y.clone();
        FieldImage::new("", (0.0, n as f64), (0.0, n as f64))
            .with_particles(x, y, vec![1.0; n * n])
            .with_field(Field::new("row", values, ColorMap::Sequential))
    }

    const AREA: PixelArea = PixelArea { left: 0, top: 0, width: 31, height: 31 };

    #[test]
    fn a_full_lattice_leaves_no_seam_and_lies_the_right_way_up() {
        let image = lattice(7);
        let owners = owners(&image, AREA, image.x_range, image.y_range);
        assert!(owners.owner.iter().all(|&owner| owner != NOBODY));
        // Above left: last row, first column.
        assert_eq!(owners.owner[0], 42);
        assert_eq!(owners.owner[owners.owner.len() - 1], 6);
    }

    #[test]
    fn periods_repeat_and_gaps_stay_void() {
        let mut image = lattice(4).with_periods(3);
        image.y_range = (0.0, 5.0); // one row of void in each period
        let owners = owners(&image, AREA, image.x_range, (0.0, 15.0));
        let of_row = |y: f64| owners.owner[((15.0 - y) / 15.0 * 62.0) as usize * 62];
        for period in [0.0, 5.0, 10.0] {
            let rows = [0.5, 1.5, 2.5, 3.5, 4.5].map(|y| of_row(y + period));
            assert_eq!(rows, [0, 4, 8, 12, NOBODY]);
        }
    }

    #[test]
    fn colors_are_those_of_the_map() {
        let image = lattice(4);
        let mut raster = Raster { width: 31, height: 31, rgb: vec![0; 31 * 31 * 3] };
        let owners = owners(&image, AREA, image.x_range, image.y_range);
        owners.paint(&mut raster, (0, 0), &image.fields[0].values, ColorMap::Sequential, (0.5, 3.5));
        let first = ColorMap::Sequential.color(1.0);
        assert_eq!(raster.rgb[..3], [first.red, first.green, first.blue]);
        owners.paint(&mut raster, (0, 0), &[f64::NAN; 16], ColorMap::Sequential, (0.5, 3.5));
        assert_eq!(raster.rgb[..3], [255, 0, 255]);
    }

    #[test]
    fn odd_sizes_and_places_paint_nothing() {
        let mut image = lattice(2);
        image.size = vec![f64::NAN, -1.0, 0.0, f64::INFINITY];
        assert!(owners(&image, AREA, image.x_range, image.y_range).owner.iter().all(|&o| o == NOBODY));
    }
}
