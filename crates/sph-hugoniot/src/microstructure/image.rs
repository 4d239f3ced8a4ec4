//! A microstructure from a picture: PNG → gray levels → fillings → signed distances.
//!
//! Each pixel's gray level (0 black to 255 white; colors by their luma 0.299 R + 0.587 G + 0.114 B, transparency
//! ignored) falls into one of the ranges of the case file and so gets a filling. For each filling the exact Euclidean distance to the
//! nearest pixel of it and of the others is computed (lower envelopes of parabolas; P. Felzenszwalb & D. Huttenlocher,
//! Theory of Computing 8 (2012) 415), less half a pixel, and interpolated linearly between the middles of pixels.
//!
//! A cell must be periodic. [`Edges::Mirror`] makes it so from any picture: the cell is the picture and its mirror images,
//! twice as long and twice as wide. [`Edges::Periodic`] takes the picture as it is, and it must then fit to itself across
//! its edges ([`GrayImage::seam`]).

use std::io::{BufRead, BufReader, Seek};
use std::path::Path;
use std::sync::Arc;

use glam::DVec2;
use serde::Serialize;

use super::layout::Fill;

/// Most pixels of a picture.
pub const MAX_PIXELS: u64 = 1 << 22;

/// Memory that the PNG decoder may take for itself: rows, palette, texts and profiles beside the pixels [bytes].
pub(crate) const MAX_DECODER_BYTES: usize = 64 << 20;

/// What happens at the edges of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Edges {
    /// The picture and its mirror images make the cell.
    Mirror,
    /// The picture is the cell.
    Periodic,
}

/// A gray picture.
#[derive(Clone, Debug, PartialEq)]
pub struct GrayImage {
    /// Pixels along a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Gray levels row by row from above, 0 to 255.
    pub levels: Vec<u8>,
}

impl GrayImage {
    /// Reads a PNG file; the error says what is wrong with it.
    ///
    /// # Errors
    /// If it is not there, is no PNG, or is too large.
    pub fn read(path: &Path) -> Result<Self, String> {
        let shown = path.display();
        let file = std::fs::File::open(path).map_err(|e| format!("{shown}: cannot be opened: {e}"))?;
        Self::decode(BufReader::new(file)).map_err(|reason| format!("{shown}: {reason}"))
    }

    /// Reads a picture in PNG format. Memory stays within `MAX_DECODER_BYTES` and eight bytes a pixel.
    ///
    /// # Errors
    /// If it is no PNG, is damaged, or is too large.
    pub fn decode(from: impl BufRead + Seek) -> Result<Self, String> {
        let mut decoder = png::Decoder::new_with_limits(from, png::Limits { bytes: MAX_DECODER_BYTES });
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().map_err(|e| format!("is no PNG picture: {e}"))?;
        let (width, height) = (reader.info().width, reader.info().height);
        if u64::from(width) * u64::from(height) > MAX_PIXELS {
            return Err(format!("{width} × {height} pixels are too many: at most {MAX_PIXELS}"));
        }
        // The decoder (png 0.18.1) would panic over such a palette.
        let palette = reader.info().palette.as_deref().unwrap_or_default().len();
        if palette % 3 != 0 {
            return Err(format!("is damaged: a palette of {palette} bytes is no list of colors"));
        }
        let size = reader.output_buffer_size().ok_or("is too large")?;
        let mut bytes = vec![0; size];
        let frame = reader.next_frame(&mut bytes).map_err(|e| format!("is damaged: {e}"))?;
        let channels = frame.color_type.samples();
        let levels = bytes[..frame.buffer_size()].chunks_exact(channels).map(gray).collect();
        Ok(Self { width: width as usize, height: height as usize, levels })
    }

    /// The part of a picture that begins at a pixel, from the upper left; `None` if it is not all inside.
    pub fn crop(&self, left: usize, top: usize, width: usize, height: usize) -> Option<Self> {
        let fits = |from: usize, count: usize, all: usize| {
            count > 0 && from.checked_add(count).is_some_and(|end| end <= all)
        };
        if !fits(left, width, self.width) || !fits(top, height, self.height) {
            return None;
        }
        let row = |r: usize| &self.levels[r * self.width + left..][..width];
        Some(Self { width, height, levels: (top..top + height).flat_map(row).copied().collect() })
    }

    /// The filling of each pixel; ranges of levels rise, each up to its number.
    fn fills(&self, ranges: &[(f64, Fill)]) -> Vec<Fill> {
        let of = |level: u8| ranges.iter().find(|range| f64::from(level) <= range.0).or(ranges.last());
        let table: Vec<Fill> = (0..=255).map(|level| of(level).map_or(Fill::Void, |range| range.1)).collect();
        self.levels.iter().map(|&level| table[usize::from(level)]).collect()
    }

    /// How badly a picture fits to itself across its vertical (`true`) or horizontal edges.
    pub fn seam(&self, ranges: &[(f64, Fill)], vertical: bool) -> Seam {
        let fills = self.fills(ranges);
        let (lines, along) = if vertical { (self.width, self.height) } else { (self.height, self.width) };
        let at = |line: usize, k: usize| {
            if vertical { fills[k * self.width + line] } else { fills[line * self.width + k] }
        };
        let differ = |a: usize, b: usize| (0..along).filter(|&k| at(a, k) != at(b, k)).collect::<Vec<_>>();
        let across = differ(lines - 1, 0);
        let usual = (1..lines).map(|line| differ(line - 1, line).len()).max().unwrap_or(0);
        Seam {
            share: across.len() as f64 / along as f64,
            usual: usual as f64 / along as f64,
            span: across.first().copied().zip(across.last().copied()),
        }
    }
}

/// How a picture fits to itself across an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seam {
    /// Part of the edge whose pixels have another filling than their neighbors across it [-].
    pub share: f64,
    /// Largest such part between two lines of pixels inside [-].
    pub usual: f64,
    /// First and last place along the edge where they differ [pixels].
    pub span: Option<(usize, usize)>,
}

impl Seam {
    /// True where the edge is no worse than one and a half times what is found inside, and a little.
    pub fn is_periodic(&self) -> bool {
        self.share <= 1.5 * self.usual + 0.01
    }
}

fn gray(pixel: &[u8]) -> u8 {
    match *pixel {
        [red, green, blue, ..] => {
            ((299 * u32::from(red) + 587 * u32::from(green) + 114 * u32::from(blue) + 500) / 1000) as u8
        }
        [level, ..] => level,
        [] => 0,
    }
}

/// A picture as the base of a layout.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ImageLayout {
    /// The file, as the case names it.
    pub file: String,
    /// Pixels along x and y.
    pub pixels: (usize, usize),
    /// Edge of a pixel [m].
    pub pixel_size: f64,
    /// What is at its edges.
    pub edges: Edges,
    /// Fillings by gray level: each from the one before up to this level.
    pub ranges: Vec<(f64, Fill)>,
    /// FNV-1a of the gray levels: another picture is another case.
    pub checksum: String,
    /// Signed distances by filling [pixels].
    #[serde(skip)]
    distances: Arc<Vec<(Fill, Vec<f32>)>>,
}

impl ImageLayout {
    /// Reads fillings and distances from a picture.
    pub fn new(
        file: String,
        image: &GrayImage,
        ranges: Vec<(f64, Fill)>,
        pixel_size: f64,
        edges: Edges,
    ) -> Self {
        let fills = image.fills(&ranges);
        let mut kinds: Vec<Fill> = Vec::new();
        for fill in &fills {
            if !kinds.contains(fill) {
                kinds.push(*fill);
            }
        }
        let pixels = (image.width, image.height);
        let distances =
            kinds.iter().map(|&kind| (kind, signed_distances(&fills, kind, pixels, edges))).collect();
        let checksum = image.levels.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, &level| {
            (hash ^ u64::from(level)).wrapping_mul(0x0100_0000_01b3)
        });
        let checksum = format!("{checksum:016x}");
        Self { file, pixels, pixel_size, edges, ranges, checksum, distances: Arc::new(distances) }
    }

    /// The periodic cell [m].
    pub fn cell(&self) -> DVec2 {
        let copies = if self.edges == Edges::Mirror { 2.0 } else { 1.0 };
        DVec2::new(self.pixels.0 as f64, self.pixels.1 as f64) * (copies * self.pixel_size)
    }

    /// Fillings that occur.
    pub fn fills(&self) -> Vec<Fill> {
        self.distances.iter().map(|d| d.0).collect()
    }

    /// Signed distance to a filling at a point [m], negative inside.
    pub fn level(&self, fill: Fill, point: DVec2) -> f64 {
        let Some((_, distances)) = self.distances.iter().find(|d| d.0 == fill) else { return f64::INFINITY };
        if self.distances.len() == 1 {
            return f64::NEG_INFINITY;
        }
        let (width, height) = self.pixels;
        // Rows are counted from above.
        let u = point.x / self.pixel_size - 0.5;
        let v = (self.cell().y - point.y) / self.pixel_size - 0.5;
        let (column, row) = (u.floor(), v.floor());
        let (a, b) = (u - column, v - row);
        let at = |i: f64, k: f64| f64::from(distances[self.index(k, height) * width + self.index(i, width)]);
        let upper = at(column, row) * (1.0 - a) + at(column + 1.0, row) * a;
        let lower = at(column, row + 1.0) * (1.0 - a) + at(column + 1.0, row + 1.0) * a;
        (upper * (1.0 - b) + lower * b) * self.pixel_size
    }

    /// The pixel that stands at a place of the endless picture.
    fn index(&self, place: f64, count: usize) -> usize {
        match self.edges {
            Edges::Periodic => place.rem_euclid(count as f64) as usize,
            Edges::Mirror => {
                let k = place.rem_euclid(2.0 * count as f64) as usize;
                k.min(2 * count - 1 - k)
            }
        }
    }
}

/// Signed distances to the pixels of a kind, in pixels.
///
/// Mirror images of a pixel are never nearer than itself, so a mirrored picture needs no images.
fn signed_distances(fills: &[Fill], kind: Fill, (width, height): (usize, usize), edges: Edges) -> Vec<f32> {
    let periodic = edges == Edges::Periodic;
    let squares = |inside: bool| -> Vec<f64> {
        let mut field: Vec<f64> =
            fills.iter().map(|&fill| if (fill == kind) == inside { 0.0 } else { f64::INFINITY }).collect();
        for row in field.chunks_exact_mut(width) {
            let line = transform(row, periodic);
            row.copy_from_slice(&line);
        }
        for column in 0..width {
            let line: Vec<f64> = (0..height).map(|row| field[row * width + column]).collect();
            for (row, value) in transform(&line, periodic).into_iter().enumerate() {
                field[row * width + column] = value;
            }
        }
        field
    };
    let (to_inside, to_outside) = (squares(true), squares(false));
    let signed = |(inside, outside): (&f64, &f64)| {
        if *inside == 0.0 { 0.5 - outside.sqrt() } else { inside.sqrt() - 0.5 }
    };
    to_inside.iter().zip(&to_outside).map(|pair| signed(pair) as f32).collect()
}

/// min_j (i - j)² + f_j for each i; over the endless repetition of f if `periodic`.
fn transform(f: &[f64], periodic: bool) -> Vec<f64> {
    let n = f.len() as i64;
    let range = if periodic { -n..2 * n } else { 0..n };
    let value = |j: i64| f[j.rem_euclid(n) as usize];
    // Parabolas of the lower envelope, and where each begins.
    let mut envelope: Vec<(i64, f64)> = Vec::new();
    for j in range.filter(|&j| value(j).is_finite()) {
        let meets =
            |k: i64| ((value(j) + (j * j) as f64) - (value(k) + (k * k) as f64)) / (2 * (j - k)) as f64;
        while envelope.last().is_some_and(|&(k, from)| meets(k) <= from) {
            envelope.pop();
        }
        let from = envelope.last().map_or(f64::NEG_INFINITY, |&(k, _)| meets(k));
        envelope.push((j, from));
    }
    let mut at = 0;
    (0..n)
        .map(|i| {
            while at + 1 < envelope.len() && envelope[at + 1].1 < i as f64 {
                at += 1;
            }
            envelope.get(at).map_or(f64::INFINITY, |&(j, _)| ((i - j) * (i - j)) as f64 + value(j))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A dark disc at the given place of a bright picture.
    fn disc(center: (f64, f64), radius: f64, (width, height): (usize, usize)) -> GrayImage {
        let level = |k: usize| {
            let (x, y) = ((k % width) as f64 + 0.5 - center.0, (k / width) as f64 + 0.5 - center.1);
            if x.hypot(y) < radius { 20 } else { 200 }
        };
        GrayImage { width, height, levels: (0..width * height).map(level).collect() }
    }

    const RANGES: [(f64, Fill); 2] = [(100.0, Fill::Void), (255.0, Fill::Material(0))];

    #[test]
    fn a_disc_of_pixels_has_the_distances_of_a_disc() {
        let image = disc((40.0, 30.0), 15.0, (80, 60));
        let layout = ImageLayout::new("a.png".into(), &image, RANGES.to_vec(), 0.5, Edges::Periodic);
        assert_eq!(layout.cell(), DVec2::new(40.0, 30.0));
        for (x, y) in [(24.0, 17.0), (27.0, 15.0), (20.0, 24.0), (30.0, 15.0), (13.0, 10.0)] {
            let point = DVec2::new(x, y);
            let expected = (point - DVec2::new(20.0, 15.0)).length() - 7.5;
            let found = layout.level(Fill::Void, point);
            assert!((found - expected).abs() < 0.4, "{point}: {found} {expected}");
            assert!((layout.level(Fill::Material(0), point) + found).abs() < 1e-6);
        }
        assert_eq!(layout.level(Fill::Material(1), DVec2::ZERO), f64::INFINITY);
    }

    #[test]
    fn distances_are_those_of_every_pair_of_pixels() {
        let image = disc((3.0, 9.0), 4.0, (13, 11));
        let fills = image.fills(&RANGES);
        for edges in [Edges::Periodic, Edges::Mirror] {
            let fast = signed_distances(&fills, Fill::Void, (13, 11), edges);
            for i in 0..13 * 11_usize {
                let inside = fills[i] == Fill::Void;
                let wrap =
                    |d: usize, n: usize| if edges == Edges::Periodic { d.min(n - d) } else { d } as f64;
                let apart =
                    |j: usize| wrap((i % 13).abs_diff(j % 13), 13).hypot(wrap((i / 13).abs_diff(j / 13), 11));
                let others = (0..13 * 11).filter(|&j| (fills[j] == Fill::Void) != inside);
                let nearest = others.map(apart).fold(f64::INFINITY, f64::min) - 0.5;
                let slow = if inside { -nearest } else { nearest };
                assert!((f64::from(fast[i]) - slow).abs() < 1e-5, "{edges:?} {i}: {} {slow}", fast[i]);
            }
        }
    }

    #[test]
    fn a_mirrored_picture_is_symmetric_and_fits_to_itself() {
        let image = disc((10.0, 12.0), 8.0, (40, 30));
        let layout = ImageLayout::new("a.png".into(), &image, RANGES.to_vec(), 1.0, Edges::Mirror);
        assert_eq!(layout.cell(), DVec2::new(80.0, 60.0));
        let level = |x: f64, y: f64| layout.level(Fill::Void, DVec2::new(x, y));
        for (x, y) in [(0.3, 12.2), (7.9, 40.0), (33.0, 59.9)] {
            assert!((level(x, y) - level(80.0 - x, y)).abs() < 1e-6);
            assert!((level(x, y) - level(x, 60.0 - y)).abs() < 1e-6);
            assert!((level(x, y) - level(x + 80.0, y - 60.0)).abs() < 1e-6);
        }
        // Rows are counted from above: the disc stands 12 pixels below the upper edge of the cell.
        assert!(level(10.0, 60.0 - 12.0) < -7.0 && level(30.0, 30.5) > 0.0);
    }

    #[test]
    fn edges_that_do_not_fit_are_measured() {
        let good = disc((20.0, 15.0), 8.0, (40, 30));
        assert!(good.seam(&RANGES, true).is_periodic() && good.seam(&RANGES, false).is_periodic());
        let cut = disc((0.0, 15.0), 8.0, (40, 30));
        let seam = cut.seam(&RANGES, true);
        assert!(!seam.is_periodic() && cut.seam(&RANGES, false).is_periodic());
        assert_eq!(seam.span, Some((7, 22)));
        assert!((seam.share - 16.0 / 30.0).abs() < 1e-12);
    }

    #[test]
    fn a_part_of_a_picture_is_cut_out() {
        let image = disc((20.0, 15.0), 8.0, (40, 30));
        let part = image.crop(12, 7, 16, 16).unwrap();
        assert_eq!(part, disc((8.0, 8.0), 8.0, (16, 16)));
        assert!(image.crop(30, 0, 11, 5).is_none() && image.crop(0, 0, 0, 5).is_none());
        assert!(image.crop(usize::MAX, 0, 2, 5).is_none());
    }

    #[test]
    fn a_palette_with_a_part_of_a_color_is_refused() {
        let chunk = |name: &[u8; 4], data: &[u8]| {
            let mut crc = flate2::Crc::new();
            crc.update(&[name.as_slice(), data].concat());
            let length = (data.len() as u32).to_be_bytes();
            [&length, name.as_slice(), data, &crc.sum().to_be_bytes()].concat()
        };
        let head = [0, 0, 0, 8, 0, 0, 0, 8, 1, 3, 0, 0, 0];
        let parts = [chunk(b"IHDR", &head), chunk(b"PLTE", &[9; 7]), chunk(b"IDAT", &[0x78, 0x9c])];
        let file = [b"\x89PNG\r\n\x1a\n".as_slice(), &parts.concat()].concat();
        let refusal = GrayImage::decode(std::io::Cursor::new(file)).unwrap_err();
        assert!(refusal.contains("a palette of 7 bytes"), "{refusal}");
    }

    #[test]
    fn what_is_wrong_with_a_file_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        assert!(GrayImage::read(&path).unwrap_err().contains("cannot be opened"));
        std::fs::write(&path, "no picture").unwrap();
        assert!(GrayImage::read(&path).unwrap_err().contains("is no PNG picture"));
    }
}
