//! Where everything stands: margins, panels, scales; then the drawing in order.

use super::legend::{self, Legend};
use super::{Axis, Figure, LegendPosition, Panel, data};
use crate::draw::axes::{self, AxisPlan};
use crate::draw::canvas::{Anchor, Canvas, Place};
use crate::draw::scale::{Scale, range_of};
use crate::draw::ticks::Ticks;
use crate::draw::{Rect, TITLE_SIZE};

/// Free rim of the figure.
const RIM: f64 = 14.0;
/// Distance between stacked panels.
const PANEL_GAP: f64 = 14.0;
/// Part of the data's extent that is left free at each end of a chosen range.
const MARGIN_X: f64 = 0.03;
const MARGIN_Y: f64 = 0.06;

/// A panel with its place and axes.
pub(super) struct PanelPlan<'a> {
    pub panel: &'a Panel,
    pub area: Rect,
    pub x: AxisPlan,
    pub y: AxisPlan,
}

impl PanelPlan<'_> {
    /// Where a point of the data stands on the canvas.
    pub fn place(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        Some((self.x.scale.place(x)?, self.y.scale.place(y)?))
    }
}

/// Draws the figure.
pub(super) fn draw(figure: &Figure) -> Canvas {
    let mut legend_room = 0.0;
    let mut plans = plan(figure, legend_room);
    let widest = legend::widest(figure);
    let legends: Vec<Option<Legend>> = plans
        .iter()
        .enumerate()
        .map(|(idx, plan)| Some(legend::plan(plan, wanted_legend(figure, idx)?, widest)))
        .collect();
    for legend in legends.iter().flatten().filter(|legend| legend.is_outside()) {
        legend_room = legend.width().max(legend_room);
    }
    if legend_room > 0.0 {
        plans = plan(figure, legend_room + RIM);
    }
    let bottom = plans.last().map_or(0.0, |plan| plan.area.bottom);
    let below = legends.last().and_then(|legend| legend.as_ref()).map_or(0.0, Legend::room_below);
    let mut canvas = Canvas::new(figure.width, bottom + axes::bottom_room() + below + RIM);
    let tick_width = plans.iter().map(|plan| plan.y.tick_width()).fold(0.0, f64::max);
    for (plan, legend) in plans.iter().zip(&legends) {
        draw_panel(&mut canvas, plan, legend.as_ref(), tick_width);
    }
    if let (Some(first), Some(last)) = (plans.first(), plans.last()) {
        axes::draw_x_words(&mut canvas, last.area, &last.x);
        let middle = 0.5 * (first.area.left + first.area.right);
        let place = Place::new(middle, RIM + 0.8 * TITLE_SIZE, TITLE_SIZE, Anchor::Middle);
        canvas.text(&figure.title, place);
    }
    canvas
}

fn draw_panel(canvas: &mut Canvas, plan: &PanelPlan<'_>, legend: Option<&Legend>, tick_width: f64) {
    axes::draw_grid(canvas, plan.area, &plan.x, &plan.y);
    canvas.clipped(plan.area, |canvas| {
        data::draw_annotations(canvas, plan);
        data::draw_all_series(canvas, plan);
    });
    axes::draw_frame(canvas, plan.area, &plan.x, &plan.y);
    axes::draw_y_words(canvas, plan.area, &plan.y, tick_width);
    if let Some(legend) = legend {
        legend.draw(canvas, plan);
    }
}

/// Places the panels; `legend_room` is kept free at the right.
fn plan(figure: &Figure, legend_room: f64) -> Vec<PanelPlan<'_>> {
    let y_axes: Vec<AxisPlan> =
        figure.panels.iter().map(|panel| y_axis(panel, figure.panel_height)).collect();
    let tick_width = y_axes.iter().map(AxisPlan::tick_width).fold(0.0, f64::max);
    let left = RIM + axes::left_room(tick_width);
    let right = (figure.width - 2.0 * RIM - legend_room).max(left + 50.0);
    let mut top = if figure.title.is_empty() { RIM } else { RIM + 1.8 * TITLE_SIZE };
    let x = x_axis(figure, (left, right));
    let mut plans = Vec::new();
    for (panel, mut y) in figure.panels.iter().zip(y_axes) {
        let area = Rect { left, top, right, bottom: top + figure.panel_height };
        y.scale.span = (area.bottom, area.top);
        plans.push(PanelPlan { panel, area, x: x.clone(), y });
        top = area.bottom + PANEL_GAP;
    }
    plans
}

fn x_axis(figure: &Figure, span: (f64, f64)) -> AxisPlan {
    let series = figure.panels.iter().flat_map(|panel| &panel.series);
    let only_lines = series
        .clone()
        .all(|s| matches!(s.style, super::Style::Line | super::Style::Dashed | super::Style::Band));
    // Profiles fill the width; markers must not touch the frame.
    let margin = if only_lines && !figure.x.log { 0.0 } else { MARGIN_X };
    let values = series.flat_map(|series| series.x.iter().copied());
    axis(&figure.x, range_of(values, figure.x.log, margin), span, 110.0)
}

fn y_axis(panel: &Panel, height: f64) -> AxisPlan {
    let values = panel.series.iter().flat_map(data::y_extent);
    axis(&panel.y, range_of(values, panel.y.log, MARGIN_Y), (height, 0.0), 60.0)
}

fn axis(axis: &Axis, data_range: (f64, f64), span: (f64, f64), points_per_tick: f64) -> AxisPlan {
    let range = axis.range.unwrap_or(data_range);
    let wanted = ((span.1 - span.0).abs() / points_per_tick).round() as usize;
    AxisPlan {
        label: axis.label.clone(),
        scale: Scale { range, span, log: axis.log },
        ticks: match &axis.ticks {
            Some(values) => Ticks::at(values),
            None => Ticks::new(range, axis.log, wanted),
        },
    }
}

/// The place asked for, with [`LegendPosition::Auto`] still to be resolved; `None` if nothing is to be shown.
pub(super) fn wanted_legend(figure: &Figure, idx: usize) -> Option<LegendPosition> {
    let panel = &figure.panels[idx];
    let is_empty = panel.series.iter().all(|series| series.label.is_empty());
    let labels = |panel: &Panel| -> Vec<String> { panel.series.iter().map(|s| s.label.clone()).collect() };
    let is_repeated =
        idx > 0 && panel.legend == LegendPosition::Auto && labels(panel) == labels(&figure.panels[0]);
    (panel.legend != LegendPosition::Hidden && !is_empty && !is_repeated).then_some(panel.legend)
}
