//! Series and annotations within a panel.

use super::layout::PanelPlan;
use super::{Annotation, Series, Style};
use crate::Color;
use crate::draw::canvas::{Anchor, Canvas, Dash, Place, Stroke};
use crate::draw::{NOTE_SIZE, text};

const LINE_WIDTH: f64 = 2.0;
const ERROR_WIDTH: f64 = 1.5;
const ERROR_CAP: f64 = 4.5;
const MARKER_RADIUS: f64 = 4.8;
pub(super) const BAND_OPACITY: f64 = 0.22;
const NOTE_STROKE: Stroke = Stroke { color: Color::GRAY, width: 1.2, dash: Dash::Pattern(5.0, 4.0) };
/// Points of a curve closer than this are drawn as one.
const RESOLUTION: f64 = 0.15;

impl Series {
    pub(super) fn color_at(&self, idx: usize) -> Color {
        self.color.unwrap_or(Color::cycle(idx))
    }

    pub(super) fn stroke(&self, idx: usize) -> Option<Stroke> {
        let dash = match self.style {
            Style::Points | Style::Band => return None,
            Style::Line | Style::LineWithPoints => Dash::Solid,
            Style::Dashed => Dash::Pattern(9.0, 5.5),
            Style::Dotted => Dash::Pattern(1.5, 4.5),
        };
        Some(Stroke { color: self.color_at(idx), width: LINE_WIDTH, dash })
    }

    pub(super) const fn has_markers(&self) -> bool {
        matches!(self.style, Style::Points | Style::LineWithPoints)
    }
}

/// The ordinates that a chosen range must show, error bars included.
pub(super) fn y_extent(series: &Series) -> impl Iterator<Item = f64> {
    let errors = series.y_error.iter().flatten().copied().map(finite_or_zero);
    let bars = series.y.iter().zip(errors).flat_map(|(&y, error)| [y - error, y + error]);
    series.y.iter().copied().chain(bars).chain(series.lower.iter().flatten().copied())
}

fn finite_or_zero(value: f64) -> f64 {
    if value.is_finite() { value.abs() } else { 0.0 }
}

/// Bands first, then curves, so that none hides a marker.
pub(super) fn draw_all_series(canvas: &mut Canvas, plan: &PanelPlan<'_>) {
    for (idx, series) in plan.panel.series.iter().enumerate() {
        draw_band(canvas, plan, series, series.color_at(idx));
    }
    for (idx, series) in plan.panel.series.iter().enumerate() {
        if let Some(stroke) = series.stroke(idx) {
            pieces(plan, series).iter().for_each(|piece| canvas.polyline(piece, stroke));
        }
    }
    for (idx, series) in plan.panel.series.iter().enumerate().filter(|(_, series)| series.has_markers()) {
        draw_error_bars(canvas, plan, idx, series);
        for (&x, &y) in series.x.iter().zip(&series.y) {
            if let Some(center) = plan.place(x, y) {
                draw_marker(canvas, idx, center, series.color_at(idx));
            }
        }
    }
}

/// The shade of a band; places that cannot be drawn are left out.
fn draw_band(canvas: &mut Canvas, plan: &PanelPlan<'_>, series: &Series, color: Color) {
    let Some(lower) = &series.lower else { return };
    let edge = |y: &[f64]| -> Vec<(f64, f64)> {
        let places = series.x.iter().zip(y).zip(series.y.iter().zip(lower));
        let whole = places.filter(|(_, (high, low))| high.is_finite() && low.is_finite());
        whole.filter_map(|((&x, &y), _)| plan.place(x, y)).collect()
    };
    let mut outline = edge(&series.y);
    outline.extend(edge(lower).into_iter().rev());
    if outline.len() > 3 {
        canvas.shade(&outline, color, BAND_OPACITY);
    }
}

/// The curve on the canvas, cut where a value is missing and thinned where points coincide.
pub(super) fn pieces(plan: &PanelPlan<'_>, series: &Series) -> Vec<Vec<(f64, f64)>> {
    let mut pieces = vec![Vec::new()];
    for (&x, &y) in series.x.iter().zip(&series.y) {
        let last = pieces.len() - 1;
        match plan.place(x, y) {
            Some(point) if pieces[last].last().is_none_or(|&before| distance(before, point) > RESOLUTION) => {
                pieces[last].push(point);
            }
            Some(_) => {}
            None => pieces.push(Vec::new()),
        }
    }
    pieces
}

fn distance(a: (f64, f64), b: (f64, f64)) -> f64 {
    (a.0 - b.0).hypot(a.1 - b.1)
}

fn draw_error_bars(canvas: &mut Canvas, plan: &PanelPlan<'_>, idx: usize, series: &Series) {
    let stroke = Stroke::solid(series.color_at(idx), ERROR_WIDTH);
    for ((&x, &y), &error) in series.x.iter().zip(&series.y).zip(series.x_error.iter().flatten()) {
        let error = finite_or_zero(error);
        let ends = (plan.place(x - error, y), plan.place(x + error, y));
        let (Some((left, at)), Some((right, _))) = ends else { continue };
        if error > 0.0 {
            canvas.line((left, at), (right, at), stroke);
            for end in [left, right] {
                canvas.line((end, at - ERROR_CAP), (end, at + ERROR_CAP), stroke);
            }
        }
    }
    let Some(errors) = &series.y_error else { return };
    for ((&x, &y), &error) in series.x.iter().zip(&series.y).zip(errors) {
        let error = finite_or_zero(error);
        let Some((center, high)) = plan.place(x, y + error).filter(|_| error > 0.0) else { continue };
        // On a logarithmic axis a bar may reach below every positive value: it then runs out of the panel.
        let low = plan.y.scale.place(y - error).unwrap_or(plan.area.bottom + ERROR_CAP);
        canvas.line((center, low), (center, high), stroke);
        for end in [low, high] {
            canvas.line((center - ERROR_CAP, end), (center + ERROR_CAP, end), stroke);
        }
    }
}

/// Markers differ in shape as well as in color.
pub(super) fn draw_marker(canvas: &mut Canvas, idx: usize, (x, y): (f64, f64), color: Color) {
    let r = MARKER_RADIUS;
    let square = [(-r, -r), (r, -r), (r, r), (-r, r)].map(|(dx, dy)| (x + 0.88 * dx, y + 0.88 * dy));
    let diamond = [(0.0, -r), (r, 0.0), (0.0, r), (-r, 0.0)].map(|(dx, dy)| (x + 1.25 * dx, y + 1.25 * dy));
    let triangle = [(0.0, -r), (r, 0.75 * r), (-r, 0.75 * r)].map(|(dx, dy)| (x + 1.2 * dx, y + 1.2 * dy));
    match idx % 4 {
        0 => canvas.disc((x, y), r, color),
        1 => canvas.polygon(&square, color),
        2 => canvas.polygon(&triangle, color),
        _ => canvas.polygon(&diamond, color),
    }
}

pub(super) fn draw_annotations(canvas: &mut Canvas, plan: &PanelPlan<'_>) {
    for annotation in &plan.panel.annotations {
        match annotation {
            Annotation::Text { x, y, text } => draw_note(canvas, plan.place(*x, *y), text, Anchor::Start),
            Annotation::Horizontal { y, text } => draw_horizontal(canvas, plan, *y, text),
            Annotation::Vertical { x, text } => draw_vertical(canvas, plan, *x, text),
            Annotation::Slope { start, to_x, order, text } => {
                let end = (*to_x, start.1 * (to_x / start.0).powf(*order));
                draw_slope(canvas, plan, *start, end, text);
            }
        }
    }
}

fn draw_note(canvas: &mut Canvas, place: Option<(f64, f64)>, words: &str, anchor: Anchor) {
    let Some((x, y)) = place else { return };
    canvas.text(words, Place { color: Color::rgb(70, 70, 70), ..Place::new(x, y, NOTE_SIZE, anchor) });
}

fn draw_horizontal(canvas: &mut Canvas, plan: &PanelPlan<'_>, y: f64, words: &str) {
    let Some(y) = plan.y.scale.place(y) else { return };
    canvas.line((plan.area.left, y), (plan.area.right, y), NOTE_STROKE);
    draw_note(canvas, Some((plan.area.right - 10.0, y - 6.0)), words, Anchor::End);
}

fn draw_vertical(canvas: &mut Canvas, plan: &PanelPlan<'_>, x: f64, words: &str) {
    let Some(x) = plan.x.scale.place(x) else { return };
    canvas.line((x, plan.area.top), (x, plan.area.bottom), NOTE_STROKE);
    let y = plan.area.top + 10.0 + text::width(words, NOTE_SIZE);
    let place = Place::new(x - 6.0, y, NOTE_SIZE, Anchor::Start);
    canvas.text(words, Place { upward: true, color: Color::rgb(70, 70, 70), ..place });
}

fn draw_slope(canvas: &mut Canvas, plan: &PanelPlan<'_>, start: (f64, f64), end: (f64, f64), words: &str) {
    let (Some(from), Some(to)) = (plan.place(start.0, start.1), plan.place(end.0, end.1)) else { return };
    canvas.line(from, to, NOTE_STROKE);
    let (place, anchor) = slope_words(plan, to, words);
    draw_note(canvas, Some(place), words, anchor);
}

/// Where the words of a slope stand: behind its end, below it where there is no room behind.
fn slope_words(plan: &PanelPlan<'_>, to: (f64, f64), words: &str) -> ((f64, f64), Anchor) {
    if to.0 > plan.area.right - text::width(words, NOTE_SIZE) - 10.0 {
        ((to.0 - 4.0, to.1 + NOTE_SIZE + 4.0), Anchor::End)
    } else {
        ((to.0 + 7.0, to.1 + 0.36 * NOTE_SIZE), Anchor::Start)
    }
}

/// Lines on the canvas that slopes and notes take up: a legend must hide none of them.
pub(super) fn annotated(plan: &PanelPlan<'_>) -> Vec<[(f64, f64); 2]> {
    let words = |(x, y): (f64, f64), anchor: Anchor, text: &str| {
        let (width, middle) = (text::width(text, NOTE_SIZE), y - 0.36 * NOTE_SIZE);
        let left = if anchor == Anchor::End { x - width } else { x };
        [(left, middle), (left + width, middle)]
    };
    let mut lines = Vec::new();
    for annotation in &plan.panel.annotations {
        match annotation {
            Annotation::Text { x, y, text } => {
                lines.extend(plan.place(*x, *y).map(|place| words(place, Anchor::Start, text)));
            }
            Annotation::Slope { start, to_x, order, text } => {
                let end = plan.place(*to_x, start.1 * (to_x / start.0).powf(*order));
                let Some((from, to)) = plan.place(start.0, start.1).zip(end) else { continue };
                let (place, anchor) = slope_words(plan, to, text);
                lines.extend([[from, to], words(place, anchor, text)]);
            }
            // They cross the panel; no place would be left.
            Annotation::Horizontal { .. } | Annotation::Vertical { .. } => {}
        }
    }
    lines
}
