//! Any bytes as a picture of a microstructure: gray levels, or a reason; what was read gives fillings and distances.
//!
//! The decoder leaves checksums out of account when it is fuzzed, so that changed chunks come through.

#![no_main]

use std::io::Cursor;

use libfuzzer_sys::fuzz_target;
use sph_hugoniot::microstructure::image::{Edges, GrayImage, ImageLayout, MAX_PIXELS};
use sph_hugoniot::microstructure::layout::Fill;

/// Distances take time in proportion to the pixels: those of larger pictures tell nothing new.
const PIXELS_WITH_DISTANCES: usize = 1 << 14;

fuzz_target!(|bytes: &[u8]| {
    let Ok(image) = GrayImage::decode(Cursor::new(bytes)) else { return };
    let pixels = image.width * image.height;
    assert!(pixels > 0 && pixels as u64 <= MAX_PIXELS && image.levels.len() == pixels, "{pixels} pixels");
    if pixels > PIXELS_WITH_DISTANCES {
        return;
    }
    let ranges = vec![(100.0, Fill::Void), (255.0, Fill::Material(0))];
    for vertical in [true, false] {
        let _ = image.seam(&ranges, vertical).is_periodic();
    }
    for edges in [Edges::Mirror, Edges::Periodic] {
        let layout = ImageLayout::new("a.png".into(), &image, ranges.clone(), 1e-6, edges);
        let middle = layout.cell() * 0.37;
        let filled = layout.fills();
        assert!(filled.iter().all(|&fill| !layout.level(fill, middle).is_nan()));
    }
});
