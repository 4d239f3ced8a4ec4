//! Where strips, color bars and words stand.

use super::color_map;
use super::paint::{self, PixelArea};
use super::{Field, FieldImage};
use crate::draw::axes::{self, AxisPlan};
use crate::draw::canvas::{Anchor, Canvas, PIXELS_PER_POINT, Place};
use crate::draw::raster::Raster;
use crate::draw::scale::Scale;
use crate::draw::ticks::Ticks;
use crate::draw::{LABEL_SIZE, Rect, TICK_SIZE, TITLE_SIZE, text};

const RIM: f64 = 14.0;
const BAR_GAP: f64 = 16.0;
const BAR_WIDTH: f64 = 18.0;
/// Room above each field for its label.
const FIELD_HEAD: f64 = 30.0;
/// Room below a strip for its numbers.
const STRIP_FOOT: f64 = 30.0;
const MAX_HEIGHT: f64 = 12_000.0;

/// One strip of one field.
struct Strip {
    area: Rect,
    x: AxisPlan,
    y: AxisPlan,
}

/// One field: its strips and its bar.
struct Block<'a> {
    field: &'a Field,
    strips: Vec<Strip>,
    bar: Rect,
    bar_axis: AxisPlan,
}

/// Draws the picture.
pub(super) fn draw(image: &FieldImage) -> Result<Raster, String> {
    let blocks = plan(image);
    let bottom = blocks.last().map_or(0.0, |block| block.bar.bottom) + axes::bottom_room() + RIM;
    if bottom > MAX_HEIGHT {
        return Err(format!("the picture would be {bottom:.0} points, which is too high; use more strips"));
    }
    let mut canvas = Canvas::new(image.width, bottom);
    let place = Place::new(0.5 * image.width, RIM + 0.8 * TITLE_SIZE, TITLE_SIZE, Anchor::Middle);
    canvas.text(&image.title, place);
    for (idx, block) in blocks.iter().enumerate() {
        draw_block(&mut canvas, block, idx + 1 == blocks.len());
    }
    let mut raster = canvas.into_raster()?;
    paint_blocks(image, &blocks, &mut raster);
    Ok(raster)
}

fn draw_block(canvas: &mut Canvas, block: &Block<'_>, is_last: bool) {
    let Some((first, last)) = block.strips.first().zip(block.strips.last()) else { return };
    let place = Place::new(first.area.left, first.area.top - 9.0, LABEL_SIZE, Anchor::Start);
    canvas.text(&block.field.label, place);
    for strip in &block.strips {
        axes::draw_outer_frame(canvas, strip.area, &strip.x, &strip.y);
        axes::draw_y_numbers(canvas, strip.area, &strip.y);
        if is_last || block.strips.len() > 1 {
            axes::draw_x_numbers(canvas, strip.area, &strip.x);
        }
    }
    let whole = Rect { bottom: last.area.bottom, ..first.area };
    axes::draw_y_label(canvas, whole, &first.y, first.y.tick_width());
    if is_last {
        axes::draw_x_words(canvas, last.area, &last.x);
    }
    draw_bar(canvas, block);
}

fn draw_bar(canvas: &mut Canvas, block: &Block<'_>) {
    for (value, word) in &block.bar_axis.ticks.major {
        if let Some(y) = block.bar_axis.scale.place(*value) {
            axes::draw_tick_right(canvas, block.bar.right, y);
            let y = y + 0.36 * TICK_SIZE;
            canvas.text(word, Place::new(block.bar.right + 9.0, y, TICK_SIZE, Anchor::Start));
        }
    }
    if let Some(exponent) = block.bar_axis.ticks.exponent {
        let words = format!("×10^{{{exponent}}}").replace('-', "−");
        canvas.text(&words, Place::new(block.bar.left, block.bar.top - 9.0, TICK_SIZE, Anchor::Start));
    }
    axes::draw_outline(canvas, block.bar);
}

fn paint_blocks(image: &FieldImage, blocks: &[Block<'_>], raster: &mut Raster) {
    let Some(first) = blocks.first() else { return };
    for k in 0..image.n_strips {
        // The same particles lie under the samples of every field: only the shift down the page differs.
        let strip = &first.strips[k];
        let owners = paint::owners(image, pixels(strip.area), strip.x.scale.range, strip.y.scale.range);
        for block in blocks {
            let area = pixels(block.strips[k].area);
            owners.paint(
                raster,
                (area.left, area.top),
                &block.field.values,
                block.field.map,
                block.bar_axis.scale.range,
            );
        }
    }
    for block in blocks {
        paint::paint_bar(raster, pixels(block.bar), block.field.map);
    }
}

/// The pixels within a frame; places are whole points, so every strip has as many as its like.
fn pixels(area: Rect) -> PixelArea {
    let pixel = |place: f64| (place * PIXELS_PER_POINT).round() as usize;
    let (left, top) = (pixel(area.left) + 1, pixel(area.top) + 1);
    PixelArea { left, top, width: pixel(area.right) - 1 - left, height: pixel(area.bottom) - 1 - top }
}

fn plan(image: &FieldImage) -> Vec<Block<'_>> {
    let (y_low, y_high) = image.y_range;
    let y_range = (y_low, y_low + image.n_periods as f64 * (y_high - y_low));
    let bar_words = image.fields.iter().map(bar_words).fold(0.0, f64::max);
    let number_width = Ticks::new(y_range, false, 3)
        .major
        .iter()
        .map(|(_, word)| text::width(word, TICK_SIZE))
        .fold(0.0, f64::max);
    let left = (RIM + axes::left_room(number_width + 8.0)).ceil();
    let right = (image.width - RIM - bar_words - 9.0 - BAR_WIDTH - BAR_GAP).floor().max(left + 50.0);
    let strip_length = (image.x_range.1 - image.x_range.0) / image.n_strips as f64;
    let strip_height = ((right - left) * (y_range.1 - y_range.0) / strip_length).round().max(8.0);
    let mut top = if image.title.is_empty() { RIM } else { (RIM + 1.5 * TITLE_SIZE).ceil() };
    let mut blocks = Vec::new();
    for field in &image.fields {
        top += FIELD_HEAD;
        let strips = strips(image, Rect { left, top, right, bottom: top + strip_height }, y_range);
        let bottom = strips.last().map_or(top, |strip| strip.area.bottom);
        let bar = Rect { left: right + BAR_GAP, top, right: right + BAR_GAP + BAR_WIDTH, bottom };
        let mut bar_axis = axis("", color_map::range(field), (bar.bottom, bar.top), 45.0);
        if !field.names.is_empty() {
            bar_axis.ticks = named(field);
        }
        blocks.push(Block { field, strips, bar, bar_axis });
        top = bottom + if image.n_strips > 1 { STRIP_FOOT } else { 4.0 };
    }
    blocks
}

/// The strips of one field, below one another; `first` is the uppermost.
fn strips(image: &FieldImage, first: Rect, y_range: (f64, f64)) -> Vec<Strip> {
    let length = (image.x_range.1 - image.x_range.0) / image.n_strips as f64;
    (0..image.n_strips)
        .map(|k| {
            let drop = k as f64 * (first.height() + STRIP_FOOT);
            let area = Rect { top: first.top + drop, bottom: first.bottom + drop, ..first };
            let x_low = image.x_range.0 + k as f64 * length;
            let x = axis(&image.x_label, (x_low, x_low + length), (area.left, area.right), 110.0);
            let y = axis(&image.y_label, y_range, (area.bottom, area.top), 45.0);
            Strip { area, x, y }
        })
        .collect()
}

fn axis(label: &str, range: (f64, f64), span: (f64, f64), points_per_tick: f64) -> AxisPlan {
    let wanted = ((span.1 - span.0).abs() / points_per_tick).round() as usize;
    let scale = Scale { range, span, log: false };
    AxisPlan { label: label.to_owned(), scale, ticks: Ticks::new(range, false, wanted.min(12)) }
}

/// Names in the place of numbers.
fn named(field: &Field) -> Ticks {
    let major = field.names.iter().enumerate().map(|(k, name)| (k as f64, name.clone())).collect();
    Ticks { major, minor: Vec::new(), exponent: None }
}

/// Width of the numbers beside a field's bar, whatever its height turns out to be.
fn bar_words(field: &Field) -> f64 {
    let ticks =
        if field.names.is_empty() { Ticks::new(color_map::range(field), false, 12) } else { named(field) };
    let exponent = if ticks.exponent.is_some() { 30.0 } else { 0.0 };
    ticks.major.iter().map(|(_, word)| text::width(word, TICK_SIZE)).fold(exponent, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field_image::ColorMap;

    #[test]
    fn strips_of_all_fields_have_the_same_pixels() {
        let field = || Field::new("f", [], ColorMap::Sequential);
        let image = FieldImage::new("title", (0.0, 560.3), (0.0, 20.1))
            .with_strips(3)
            .with_field(field())
            .with_field(field());
        let blocks = plan(&image);
        let areas: Vec<PixelArea> =
            blocks.iter().flat_map(|block| &block.strips).map(|strip| pixels(strip.area)).collect();
        assert_eq!(areas.len(), 6);
        assert!(areas.iter().all(|area| (area.width, area.height) == (areas[0].width, areas[0].height)));
    }
}
