//! The legend, and the search for a place where it hides no data.

use super::layout::PanelPlan;
use super::{Figure, LegendPosition, Series, data};
use crate::Color;
use crate::draw::axes;
use crate::draw::canvas::{Anchor, Canvas, Place, Stroke};
use crate::draw::{NOTE_SIZE, Rect, text};

const ROW: f64 = 1.6 * NOTE_SIZE;
const SAMPLE: f64 = 34.0;
const PADDING: f64 = 9.0;
/// Distance from the frame.
const INSET: f64 = 13.0;
/// Distance at which samples of a curve are taken when a place is judged.
const SAMPLING: f64 = 4.0;

/// Size and place of a legend relative to its panel.
pub(super) struct Legend {
    size: (f64, f64),
    place: LegendPlace,
}

/// Fractions of the free width and height to the left of and above the legend, or beside the panel, or below its axis.
#[derive(Clone, Copy, PartialEq)]
enum LegendPlace {
    Inside(f64, f64),
    Outside,
    Below,
}

/// Part of a figure's width that a legend beside the panel may take; a wider one goes below.
const WIDEST: f64 = 0.35;

/// Places in order of preference.
const CANDIDATES: [(f64, f64); 8] =
    [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 0.0), (0.5, 1.0), (1.0, 0.5), (0.0, 0.5)];

/// Finds the legend of a panel a place; `widest` is the width [points] that it may take beside the panel.
pub(super) fn plan(panel: &PanelPlan<'_>, position: LegendPosition, widest: f64) -> Legend {
    let size = size(&panel.panel.series);
    let place = match position {
        LegendPosition::TopLeft => LegendPlace::Inside(0.0, 0.0),
        LegendPosition::TopRight => LegendPlace::Inside(1.0, 0.0),
        LegendPosition::BottomLeft => LegendPlace::Inside(0.0, 1.0),
        LegendPosition::BottomRight => LegendPlace::Inside(1.0, 1.0),
        LegendPosition::Auto => free_place(panel, size),
        LegendPosition::Outside | LegendPosition::Hidden => LegendPlace::Outside,
    };
    let place = if place == LegendPlace::Outside && size.0 > widest { LegendPlace::Below } else { place };
    Legend { size, place }
}

/// Width [points] that a legend may take beside the panel of a figure. Panels above each other share their axis at the
/// bottom: there is no room below but the last one's.
pub(super) fn widest(figure: &Figure) -> f64 {
    if figure.panels.len() == 1 { WIDEST * figure.width } else { f64::INFINITY }
}

fn size(series: &[Series]) -> (f64, f64) {
    let words = series.iter().map(|series| text::width(&series.label, NOTE_SIZE)).fold(0.0, f64::max);
    let n_rows = series.iter().filter(|series| !series.label.is_empty()).count();
    (words + SAMPLE + 3.0 * PADDING, n_rows as f64 * ROW + 1.2 * PADDING)
}

/// The first candidate that hides nothing.
fn free_place(panel: &PanelPlan<'_>, size: (f64, f64)) -> LegendPlace {
    let drawn = samples(panel);
    let is_free = |&&(left, above): &&(f64, f64)| {
        let area = inside(panel.area, size, left, above);
        let rim = Rect {
            left: area.left - 6.0,
            top: area.top - 6.0,
            right: area.right + 6.0,
            bottom: area.bottom + 6.0,
        };
        let fits = area.left >= panel.area.left && area.top >= panel.area.top;
        fits && !drawn.iter().any(|&point| rim.contains(point))
    };
    let found = CANDIDATES.iter().find(is_free);
    found.map_or(LegendPlace::Outside, |&(left, above)| LegendPlace::Inside(left, above))
}

/// Places on the canvas where something of the data, a slope or a note is drawn.
fn samples(panel: &PanelPlan<'_>) -> Vec<(f64, f64)> {
    let mut out = Vec::new();
    for [from, to] in data::annotated(panel) {
        between(from, to, panel.area, &mut out);
    }
    for series in &panel.panel.series {
        for piece in data::pieces(panel, series) {
            let is_line = !matches!(series.style, super::Style::Points);
            out.extend(&piece);
            if is_line {
                piece.windows(2).for_each(|pair| between(pair[0], pair[1], panel.area, &mut out));
            }
        }
        let errors = series.y_error.iter().flatten();
        for ((&x, &y), &error) in series.x.iter().zip(&series.y).zip(errors) {
            if let (Some(low), Some(high)) = (panel.place(x, y - error), panel.place(x, y + error)) {
                between(low, high, panel.area, &mut out);
            }
        }
    }
    out
}

/// Adds places along a straight line, as far as it lies near the panel.
fn between(from: (f64, f64), to: (f64, f64), area: Rect, out: &mut Vec<(f64, f64)>) {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let longest = 4.0 * (area.width() + area.height());
    let n = (dx.hypot(dy).min(longest) / SAMPLING).ceil();
    let fractions = (0..=n as usize).map(|k| k as f64 / n.max(1.0));
    out.extend(fractions.map(|t| (from.0 + t * dx, from.1 + t * dy)));
}

fn inside(panel: Rect, (width, height): (f64, f64), left: f64, above: f64) -> Rect {
    let x = panel.left + INSET + left * (panel.width() - 2.0 * INSET - width);
    let y = panel.top + INSET + above * (panel.height() - 2.0 * INSET - height);
    Rect { left: x, top: y, right: x + width, bottom: y + height }
}

impl Legend {
    pub fn is_outside(&self) -> bool {
        self.place == LegendPlace::Outside
    }

    pub fn width(&self) -> f64 {
        self.size.0
    }

    /// Room that it takes below the axis [points].
    pub fn room_below(&self) -> f64 {
        if self.place == LegendPlace::Below { self.size.1 + INSET } else { 0.0 }
    }

    fn area(&self, panel: Rect) -> Rect {
        match self.place {
            LegendPlace::Inside(left, above) => inside(panel, self.size, left, above),
            LegendPlace::Outside => {
                let left = panel.right + INSET;
                Rect { left, top: panel.top, right: left + self.size.0, bottom: panel.top + self.size.1 }
            }
            LegendPlace::Below => {
                let (left, top) = (panel.left, panel.bottom + axes::bottom_room() + INSET);
                Rect { left, top, right: left + self.size.0, bottom: top + self.size.1 }
            }
        }
    }

    pub fn draw(&self, canvas: &mut Canvas, panel: &PanelPlan<'_>) {
        let area = self.area(panel.area);
        canvas.fill(area, Color::WHITE, 0.85);
        canvas.outline(area, Stroke::solid(Color::rgb(200, 200, 200), 1.0));
        let mut y = area.top + 0.6 * PADDING + 0.5 * ROW;
        for (idx, series) in panel.panel.series.iter().enumerate().filter(|(_, s)| !s.label.is_empty()) {
            let x = area.left + PADDING;
            if series.lower.is_some() {
                let (left, right) = (x, x + SAMPLE);
                let corners = [(left, y - 6.0), (right, y - 6.0), (right, y + 6.0), (left, y + 6.0)];
                canvas.shade(&corners, series.color_at(idx), data::BAND_OPACITY);
            }
            if let Some(stroke) = series.stroke(idx) {
                canvas.line((x, y), (x + SAMPLE, y), stroke);
            }
            if series.has_markers() {
                data::draw_marker(canvas, idx, (x + 0.5 * SAMPLE, y), series.color_at(idx));
            }
            let place = Place::new(x + SAMPLE + PADDING, y + 0.36 * NOTE_SIZE, NOTE_SIZE, Anchor::Start);
            canvas.text(&series.label, place);
            y += ROW;
        }
    }
}
