//! A synthetic micrograph: dark, irregular pores in bright metal, uneven light and grain noise, as PNG.
//!
//! `cargo run --release -p sph-hugoniot --example micrograph -- cases/micrograph.png`

use std::io::BufWriter;

/// Pixels along x and y.
const SIZE: (usize, usize) = (160, 110);
/// Pores: center and radius [pixels], and two angles that make them irregular.
const PORES: [[f64; 5]; 8] = [
    [25.0, 22.0, 14.0, 0.3, 2.0],
    [72.0, 45.0, 16.0, 1.2, 0.5],
    [106.0, 20.0, 12.0, 2.1, 1.0],
    [30.0, 62.0, 11.0, 0.9, 2.6],
    [110.0, 62.0, 9.0, 1.7, 0.2],
    [147.0, 40.0, 13.0, 0.1, 1.4],
    [58.0, 97.0, 12.0, 2.5, 0.8],
    [120.0, 98.0, 12.0, 1.1, 2.2],
];

/// Numbers in [0, 1) that are the same everywhere (a linear congruence of Knuth's).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// How far a point lies outside of the nearest pore [pixels]; negative inside.
fn outside(x: f64, y: f64) -> f64 {
    let distance = |[cx, cy, radius, a, b]: &[f64; 5]| {
        let (dx, dy) = (x - cx, y - cy);
        let angle = dy.atan2(dx);
        dx.hypot(dy) - radius * (1.0 + 0.1 * (2.0 * angle + a).cos() + 0.05 * (3.0 * angle + b).cos())
    };
    PORES.iter().map(distance).fold(f64::INFINITY, f64::min)
}

/// Gray levels row by row: soft edges, uneven light, noise.
pub fn levels() -> Vec<u8> {
    let mut random = Random(11);
    let mut gray = Vec::with_capacity(SIZE.0 * SIZE.1);
    for row in 0..SIZE.1 {
        for column in 0..SIZE.0 {
            let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
            let metal = 1.0 / (1.0 + (-2.0 * outside(x, y)).exp());
            let light = 1.0 + 0.08 * (x / SIZE.0 as f64 - 0.5);
            let level = (35.0 + 165.0 * metal) * light + 20.0 * (random.next() - 0.5);
            gray.push(level.clamp(0.0, 255.0) as u8);
        }
    }
    gray
}

/// Writes the picture.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("usage: micrograph FILE.png")?;
    let file = BufWriter::new(std::fs::File::create(path)?);
    let mut encoder = png::Encoder::new(file, SIZE.0 as u32, SIZE.1 as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(&levels())?;
    Ok(())
}
