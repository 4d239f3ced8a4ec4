//! Pictures for a page: half as many pixels a side, and one byte a pixel.
//!
//! The colors are those of cells of a cube of 16 × 16 × 16 colors, each the mean of what falls into it: half of them the most
//! frequent, the others those farthest from all before them, so that the rare end of a color map keeps its colors too. What
//! falls into another cell takes the nearest.

use super::raster::Raster;
use std::collections::HashMap;

/// Colors of the palette.
const COLORS: usize = 255;

impl Raster {
    /// Means over two by two pixels.
    pub fn halved(&self) -> Self {
        let (width, height) = (self.width / 2, self.height / 2);
        let mut rgb = Vec::with_capacity(3 * width * height);
        for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
            for channel in 0..3 {
                let at = |down: usize, right: usize| {
                    u16::from(self.rgb[3 * ((2 * row + down) * self.width + 2 * column + right) + channel])
                };
                rgb.push(((at(0, 0) + at(0, 1) + at(1, 0) + at(1, 1) + 2) / 4) as u8);
            }
        }
        Self { width, height, rgb }
    }

    /// The picture as PNG with a palette.
    pub fn to_palette_png(&self) -> Result<Vec<u8>, String> {
        let (palette, pixels) = self.in_palette();
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        encoder.set_filter(png::Filter::NoFilter);
        encoder.set_palette(palette);
        let mut writer = encoder.write_header().map_err(|e| e.to_string())?;
        writer.write_image_data(&pixels).map_err(|e| e.to_string())?;
        writer.finish().map_err(|e| e.to_string())?;
        Ok(bytes)
    }

    /// Red, green and blue of each color, and the color of each pixel.
    fn in_palette(&self) -> (Vec<u8>, Vec<u8>) {
        let mut cells: HashMap<[u8; 3], ([u64; 3], u64)> = HashMap::new();
        for pixel in self.rgb.chunks_exact(3) {
            let (sum, count) = cells.entry(cell(pixel)).or_default();
            (0..3).for_each(|k| sum[k] += u64::from(pixel[k]));
            *count += 1;
        }
        let mut frequent: Vec<_> = cells.iter().collect();
        // The cell decides between equals: the same picture gives the same bytes.
        frequent.sort_by(|a, b| b.1.1.cmp(&a.1.1).then(a.0.cmp(b.0)));
        let mean = |(sum, count): ([u64; 3], u64)| sum.map(|s| ((s + count / 2) / count) as u8);
        let colors: Vec<[u8; 3]> = frequent.iter().map(|(_, sums)| mean(**sums)).collect();
        let palette = chosen(&colors);
        let index: HashMap<[u8; 3], u8> =
            cells.iter().map(|(cell, sums)| (*cell, nearest(&palette, mean(*sums)))).collect();
        let pixels = self.rgb.chunks_exact(3).map(|pixel| index[&cell(pixel)]).collect();
        (palette.into_iter().flatten().collect(), pixels)
    }
}

fn cell(pixel: &[u8]) -> [u8; 3] {
    [pixel[0] >> 4, pixel[1] >> 4, pixel[2] >> 4]
}

/// The colors of a palette, of those in a picture with the most frequent first.
fn chosen(colors: &[[u8; 3]]) -> Vec<[u8; 3]> {
    let mut palette: Vec<[u8; 3]> = colors.iter().copied().take(COLORS / 2 + 1).collect();
    let to_palette = |color: &[u8; 3]| palette.iter().map(|p| distance(p, color)).min().unwrap_or(u32::MAX);
    let mut misses: Vec<u32> = colors.iter().map(to_palette).collect();
    while palette.len() < COLORS.min(colors.len()) {
        let Some(farthest) = (0..colors.len()).max_by_key(|&k| (misses[k], std::cmp::Reverse(k))) else {
            break;
        };
        let color = colors[farthest];
        palette.push(color);
        misses.iter_mut().zip(colors).for_each(|(miss, other)| *miss = (*miss).min(distance(&color, other)));
    }
    palette
}

fn nearest(palette: &[[u8; 3]], color: [u8; 3]) -> u8 {
    (0..palette.len()).min_by_key(|&k| distance(&palette[k], &color)).unwrap_or(0) as u8
}

fn distance(a: &[u8; 3], b: &[u8; 3]) -> u32 {
    (0..3).map(|k| u32::from(a[k].abs_diff(b[k])).pow(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp of 256 grays beside white.
    fn ramp() -> Raster {
        let gray = |k: usize| if k.is_multiple_of(2) { (k / 2 % 256) as u8 } else { 255 };
        let rgb = (0..512 * 8).flat_map(|k| [gray(k); 3]).collect();
        Raster { width: 512, height: 8, rgb }
    }

    #[test]
    fn a_palette_keeps_colors_within_half_a_cell() {
        let raster = ramp();
        let (palette, pixels) = raster.in_palette();
        assert!(palette.len() <= 3 * COLORS);
        for (pixel, index) in raster.rgb.chunks_exact(3).zip(&pixels) {
            let color = &palette[3 * usize::from(*index)..][..3];
            assert!((0..3).all(|k| color[k].abs_diff(pixel[k]) <= 15), "{pixel:?} {color:?}");
        }
        assert!(raster.to_palette_png().unwrap().len() < raster.to_png().unwrap().len());
    }

    #[test]
    fn a_rare_color_far_from_all_others_is_kept() {
        let mut rgb: Vec<u8> = (0..256_u32 * 64)
            .flat_map(|k| {
                let (k, shade) = (k % 4096, (k % 4096 / 64) as u8);
                [(k % 8) as u8 * 16, (k / 8 % 8) as u8 * 16, 128 + shade]
            })
            .collect();
        rgb[..3].copy_from_slice(&[250, 20, 10]);
        let raster = Raster { width: 256, height: 64, rgb };
        let (palette, pixels) = raster.in_palette();
        assert_eq!(palette.len(), 3 * COLORS, "more colors than places");
        assert_eq!(palette[3 * usize::from(pixels[0])..][..3], [250, 20, 10]);
    }

    #[test]
    fn half_a_picture_is_the_mean_of_four_pixels() {
        let half = ramp().halved();
        assert_eq!((half.width, half.height), (256, 4));
        assert_eq!(half.rgb[3 * 10], (10_u16 + 255).div_ceil(2) as u8);
    }
}
