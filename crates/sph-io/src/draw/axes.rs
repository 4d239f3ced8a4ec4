//! The frame of a panel with its ticks and words.

use super::canvas::{Anchor, Canvas, Place, Stroke};
use super::scale::Scale;
use super::ticks::Ticks;
use super::{LABEL_SIZE, Rect, TICK_SIZE, text};
use crate::Color;

const FRAME: Stroke = Stroke::solid(Color::rgb(40, 40, 40), 1.2);
const GRID: Stroke = Stroke::solid(Color::rgb(232, 232, 232), 1.0);
const MAJOR_LENGTH: f64 = 6.0;
const MINOR_LENGTH: f64 = 3.0;
/// Distance of words from ticks and from one another.
const GAP: f64 = 7.0;

/// One axis of a panel, ready to be drawn.
#[derive(Debug, Clone)]
pub(crate) struct AxisPlan {
    pub label: String,
    pub scale: Scale,
    pub ticks: Ticks,
}

impl AxisPlan {
    /// Width of the widest tick label.
    pub fn tick_width(&self) -> f64 {
        self.ticks.major.iter().map(|(_, word)| text::width(word, TICK_SIZE)).fold(0.0, f64::max)
    }

    /// The label with the common power of ten of the ticks.
    fn full_label(&self) -> String {
        match self.ticks.exponent {
            Some(exponent) => format!("{}  (×10^{{{exponent}}})", self.label).replace("{-", "{−"),
            None => self.label.clone(),
        }
    }
}

/// Room to the left of a panel whose widest tick label has that width.
pub(crate) fn left_room(tick_width: f64) -> f64 {
    tick_width + 2.5 * GAP + LABEL_SIZE
}

/// Room below a panel with words at its x axis.
pub(crate) fn bottom_room() -> f64 {
    TICK_SIZE + LABEL_SIZE + 2.0 * GAP
}

/// Pale lines at the major ticks, to be drawn before the data.
pub(crate) fn draw_grid(canvas: &mut Canvas, area: Rect, x: &AxisPlan, y: &AxisPlan) {
    for place in x.ticks.major.iter().filter_map(|(value, _)| x.scale.place(*value)) {
        canvas.line((place, area.top), (place, area.bottom), GRID);
    }
    for place in y.ticks.major.iter().filter_map(|(value, _)| y.scale.place(*value)) {
        canvas.line((area.left, place), (area.right, place), GRID);
    }
}

/// The frame and its ticks (inward, on all four sides), to be drawn after the data.
pub(crate) fn draw_frame(canvas: &mut Canvas, area: Rect, x: &AxisPlan, y: &AxisPlan) {
    for (place, length) in tick_places(x) {
        canvas.line((place, area.bottom), (place, area.bottom - length), FRAME);
        canvas.line((place, area.top), (place, area.top + length), FRAME);
    }
    for (place, length) in tick_places(y) {
        canvas.line((area.left, place), (area.left + length, place), FRAME);
        canvas.line((area.right, place), (area.right - length, place), FRAME);
    }
    canvas.outline(area, FRAME);
}

fn tick_places(axis: &AxisPlan) -> impl Iterator<Item = (f64, f64)> {
    let minor = axis.ticks.minor.iter().map(|value| (*value, MINOR_LENGTH));
    let major = axis.ticks.major.iter().map(|(value, _)| (*value, MAJOR_LENGTH));
    minor.chain(major).filter_map(|(value, length)| Some((axis.scale.place(value)?, length)))
}

/// The numbers below the x axis, and its label.
pub(crate) fn draw_x_words(canvas: &mut Canvas, area: Rect, axis: &AxisPlan) {
    draw_x_numbers(canvas, area, axis);
    let middle = 0.5 * (area.left + area.right);
    let y = area.bottom + 2.0 * GAP + 0.8 * TICK_SIZE + LABEL_SIZE + 1.0;
    canvas.text(&axis.full_label(), Place::new(middle, y, LABEL_SIZE, Anchor::Middle));
}

/// The numbers below the x axis.
pub(crate) fn draw_x_numbers(canvas: &mut Canvas, area: Rect, axis: &AxisPlan) {
    let y = area.bottom + GAP + 0.8 * TICK_SIZE;
    for (value, word) in &axis.ticks.major {
        if let Some(x) = axis.scale.place(*value) {
            canvas.text(word, Place::new(x, y, TICK_SIZE, Anchor::Middle));
        }
    }
}

/// The numbers left of the y axis, and its label at a distance of `tick_width` (that of the widest panel in a stack).
pub(crate) fn draw_y_words(canvas: &mut Canvas, area: Rect, axis: &AxisPlan, tick_width: f64) {
    draw_y_numbers(canvas, area, axis);
    draw_y_label(canvas, area, axis, tick_width);
}

/// The numbers left of the y axis.
pub(crate) fn draw_y_numbers(canvas: &mut Canvas, area: Rect, axis: &AxisPlan) {
    for (value, word) in &axis.ticks.major {
        if let Some(y) = axis.scale.place(*value) {
            let place = Place::new(area.left - GAP, y + 0.36 * TICK_SIZE, TICK_SIZE, Anchor::End);
            canvas.text(word, place);
        }
    }
}

/// The label of the y axis, at the middle of `area`.
pub(crate) fn draw_y_label(canvas: &mut Canvas, area: Rect, axis: &AxisPlan, tick_width: f64) {
    let x = area.left - tick_width - 2.2 * GAP - 2.0;
    let middle = 0.5 * (area.top + area.bottom);
    let place = Place { upward: true, ..Place::new(x, middle, LABEL_SIZE, Anchor::Middle) };
    canvas.text(&axis.full_label(), place);
}

/// The frame with ticks outward at its left and lower side, for panels whose inside is painted over.
pub(crate) fn draw_outer_frame(canvas: &mut Canvas, area: Rect, x: &AxisPlan, y: &AxisPlan) {
    for (place, length) in tick_places(x) {
        canvas.line((place, area.bottom), (place, area.bottom + 0.8 * length), FRAME);
    }
    for (place, length) in tick_places(y) {
        canvas.line((area.left, place), (area.left - 0.8 * length, place), FRAME);
    }
    canvas.outline(area, FRAME);
}

/// A tick outward at the right side of a color bar.
pub(crate) fn draw_tick_right(canvas: &mut Canvas, right: f64, y: f64) {
    canvas.line((right, y), (right + 0.8 * MAJOR_LENGTH, y), FRAME);
}

/// A frame without ticks.
pub(crate) fn draw_outline(canvas: &mut Canvas, area: Rect) {
    canvas.outline(area, FRAME);
}
