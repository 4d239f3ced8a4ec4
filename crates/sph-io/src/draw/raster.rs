//! A picture of pixels: read from PNG, changed, written as PNG.

use crate::Color;
use std::io::Cursor;

/// Rows of red, green and blue, from above.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Raster {
    pub width: usize,
    pub height: usize,
    pub rgb: Vec<u8>,
}

impl Raster {
    /// Reads what the drawing back end wrote; transparency is dropped, the back end paints on opaque white.
    pub fn from_png(bytes: &[u8]) -> Result<Self, String> {
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().map_err(|e| e.to_string())?;
        let mut pixels = vec![0; reader.output_buffer_size().ok_or("the picture is too large")?];
        let info = reader.next_frame(&mut pixels).map_err(|e| e.to_string())?;
        let n_channels = info.color_type.samples();
        if info.bit_depth != png::BitDepth::Eight || n_channels < 3 {
            return Err(format!("unexpected pixels: {:?} {:?}", info.color_type, info.bit_depth));
        }
        let rgb = pixels.chunks_exact(n_channels).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        Ok(Self { width: info.width as usize, height: info.height as usize, rgb })
    }

    /// The picture as PNG.
    pub fn to_png(&self) -> Result<Vec<u8>, String> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(|e| e.to_string())?;
        writer.write_image_data(&self.rgb).map_err(|e| e.to_string())?;
        writer.finish().map_err(|e| e.to_string())?;
        Ok(bytes)
    }

    pub fn set(&mut self, column: usize, row: usize, color: Color) {
        let start = 3 * (row * self.width + column);
        self.rgb[start..start + 3].copy_from_slice(&[color.red, color.green, color.blue]);
    }

    /// Lays dark marks on white, turned to read upward, over this picture. The pixel at `pivot` in `marks` falls
    /// on the pixel `at` of this one.
    pub fn overlay_upward(&mut self, marks: &Self, pivot: (i64, i64), at: (i64, i64)) {
        for row in 0..marks.height {
            for column in 0..marks.width {
                let x = at.0 + row as i64 - pivot.1;
                let y = at.1 - (column as i64 - pivot.0);
                self.darken(x, y, &marks.rgb[3 * (row * marks.width + column)..][..3]);
            }
        }
    }

    /// Multiplies a pixel with another, white being one.
    fn darken(&mut self, x: i64, y: i64, other: &[u8]) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return };
        if x >= self.width || y >= self.height {
            return;
        }
        let start = 3 * (y * self.width + x);
        for (mine, &theirs) in self.rgb[start..start + 3].iter_mut().zip(other) {
            *mine = ((u16::from(*mine) * u16::from(theirs) + 127) / 255) as u8;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn png_round_trip() {
        let raster = Raster { width: 3, height: 2, rgb: (0..18).map(|k| k * 14).collect() };
        assert_eq!(Raster::from_png(&raster.to_png().unwrap()).unwrap(), raster);
    }

    #[test]
    fn an_upward_mark_turns_about_its_pivot() {
        let mut page = Raster { width: 5, height: 5, rgb: vec![255; 75] };
        // A mark three pixels long, reading from its left end.
        let marks = Raster { width: 3, height: 1, rgb: vec![0, 0, 0, 100, 100, 100, 200, 200, 200] };
        page.overlay_upward(&marks, (0, 0), (2, 4));
        let red = |column: usize, row: usize| page.rgb[3 * (row * 5 + column)];
        assert_eq!([red(2, 4), red(2, 3), red(2, 2), red(2, 1), red(1, 4)], [0, 100, 200, 255, 255]);
    }
}
