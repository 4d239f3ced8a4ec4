//! Lines, words, scales and ticks on a canvas that becomes SVG or PNG: what plots and field images share.
//!
//! The drawing back end (kuva) gives vector and raster output of the same scene with a font of its own; axes,
//! ticks and legends are made here, so that several panels align, both outputs agree, and no type of the back end
//! leaves the crate. Lengths are in points of the canvas, y downward.

pub(crate) mod axes;
pub(crate) mod canvas;
pub(crate) mod compact;
pub(crate) mod palette;
pub(crate) mod raster;
pub(crate) mod scale;
pub(crate) mod text;
pub(crate) mod ticks;

/// Font size of titles.
pub(crate) const TITLE_SIZE: f64 = 18.0;
/// Font size of axis labels.
pub(crate) const LABEL_SIZE: f64 = 17.0;
/// Font size of tick labels.
pub(crate) const TICK_SIZE: f64 = 15.0;
/// Font size in legends and annotations.
pub(crate) const NOTE_SIZE: f64 = 14.0;

/// An upright rectangle of the canvas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rect {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Rect {
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    pub fn height(&self) -> f64 {
        self.bottom - self.top
    }

    pub fn contains(&self, (x, y): (f64, f64)) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }
}
