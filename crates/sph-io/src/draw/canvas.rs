//! A drawing surface over the back end: strokes, markers, words, clipping; then SVG or PNG.

use super::Rect;
use super::raster::Raster;
use super::text::{self, Run};
use crate::Color;
use kuva::backend::raster::RasterBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::color::Color as BackColor;
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};

/// Pixels per point in PNG output: 192 dots an inch where a point is 1/96 inch.
pub(crate) const PIXELS_PER_POINT: f64 = 2.0;

/// The families asked for in SVG; the first is the font whose widths are used in the layout.
const FONT_FAMILY: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    pub color: Color,
    pub width: f64,
    pub dash: Dash,
}

impl Stroke {
    pub const fn solid(color: Color, width: f64) -> Self {
        Self { color, width, dash: Dash::Solid }
    }
}

/// The pattern of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Dash {
    Solid,
    /// Lengths of stroke and gap.
    Pattern(f64, f64),
}

/// Where words stand relative to the point given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// Place and size of a line of words; `x`, `y` is on the base line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub x: f64,
    pub y: f64,
    pub size: f64,
    pub anchor: Anchor,
    /// Whether the line reads from below to above.
    pub upward: bool,
    pub color: Color,
}

impl Place {
    pub const fn new(x: f64, y: f64, size: f64, anchor: Anchor) -> Self {
        Self { x, y, size, anchor, upward: false, color: Color::BLACK }
    }
}

/// The surface.
pub(crate) struct Canvas {
    scene: Scene,
    /// Words that read upward, drawn last.
    upward: Vec<(String, Place)>,
    n_clips: usize,
}

impl Canvas {
    pub fn new(width: f64, height: f64) -> Self {
        let mut scene = Scene::new(width.ceil(), height.ceil());
        scene.font_family = Some(FONT_FAMILY.to_owned());
        Self { scene, upward: Vec::new(), n_clips: 0 }
    }

    pub fn into_svg(mut self) -> String {
        for (markup, place) in std::mem::take(&mut self.upward) {
            self.words(&markup, place);
        }
        SvgBackend::new().render_scene(&self.scene)
    }

    /// The scene in pixels. Words that read upward are drawn level on a canvas of their own and turned: the back
    /// end's turned words come out heavier than its level ones.
    pub fn into_raster(self) -> Result<Raster, String> {
        let mut raster = self.pixels()?;
        for (markup, place) in &self.upward {
            let (half, height) = (text::width(markup, place.size).ceil() + 4.0, 3.0 * place.size);
            let mut level = Self::new(2.0 * half, height);
            let pivot = (half, 2.0 * place.size);
            level.words(markup, Place { x: pivot.0, y: pivot.1, upward: false, ..*place });
            raster.overlay_upward(&level.pixels()?, to_pixels(pivot), to_pixels((place.x, place.y)));
        }
        Ok(raster)
    }

    fn pixels(&self) -> Result<Raster, String> {
        Raster::from_png(&RasterBackend::new().with_scale(PIXELS_PER_POINT as f32).render_scene(&self.scene)?)
    }

    /// Draws `draw` within `area` only.
    pub fn clipped(&mut self, area: Rect, draw: impl FnOnce(&mut Self)) {
        self.n_clips += 1;
        let (id, width, height) = (format!("clip{}", self.n_clips), area.width(), area.height());
        let (x, y) = (area.left, area.top);
        // The back end of SVG writes only the reference: what it refers to must be put down here.
        self.scene.defs.push(format!(
            r#"<clipPath id="{id}"><rect x="{x}" y="{y}" width="{width}" height="{height}"/></clipPath>"#
        ));
        self.scene.add(Primitive::ClipStart { x, y, width, height, id });
        draw(self);
        self.scene.add(Primitive::ClipEnd);
    }

    pub fn line(&mut self, from: (f64, f64), to: (f64, f64), stroke: Stroke) {
        self.polyline(&[from, to], stroke);
    }

    /// A broken line through the points; dashes run on across its corners.
    pub fn polyline(&mut self, points: &[(f64, f64)], stroke: Stroke) {
        match stroke.dash {
            Dash::Solid => self.solid(points.to_vec(), stroke),
            Dash::Pattern(on, off) => {
                for dash in dashes(points, on, off) {
                    self.solid(dash, stroke);
                }
            }
        }
    }

    fn solid(&mut self, points: Vec<(f64, f64)>, stroke: Stroke) {
        if points.len() > 1 {
            self.scene.add(Primitive::PolyLine {
                points,
                stroke: back_color(stroke.color),
                stroke_width: stroke.width,
                stroke_dasharray: None,
            });
        }
    }

    /// A filled rectangle; `opacity` from 0 to 1.
    pub fn fill(&mut self, area: Rect, color: Color, opacity: f64) {
        self.scene.add(Primitive::Rect {
            x: area.left,
            y: area.top,
            width: area.width(),
            height: area.height(),
            fill: back_color(color),
            stroke: None,
            stroke_width: None,
            opacity: Some(opacity),
        });
    }

    /// The outline of a rectangle.
    pub fn outline(&mut self, area: Rect, stroke: Stroke) {
        let Rect { left, top, right, bottom } = area;
        self.polyline(&[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)], stroke);
    }

    pub fn disc(&mut self, (cx, cy): (f64, f64), radius: f64, color: Color) {
        self.scene.add(Primitive::Circle {
            cx,
            cy,
            r: radius,
            fill: back_color(color),
            fill_opacity: None,
            stroke: None,
            stroke_width: None,
        });
    }

    pub fn polygon(&mut self, points: &[(f64, f64)], color: Color) {
        self.shade(points, color, 1.0);
    }

    /// A filled polygon; `opacity` from 0 to 1.
    pub fn shade(&mut self, points: &[(f64, f64)], color: Color, opacity: f64) {
        let corners: Vec<String> = points.iter().map(|(x, y)| format!("{x:.2} {y:.2}")).collect();
        self.scene.add(Primitive::Path(Box::new(PathData {
            d: format!("M {} Z", corners.join(" L ")),
            fill: Some(back_color(color)),
            stroke: BackColor::None,
            stroke_width: 0.0,
            opacity: (opacity < 1.0).then_some(opacity),
            stroke_dasharray: None,
        })));
    }

    /// A line of words, with the marks of [`text`].
    pub fn text(&mut self, markup: &str, place: Place) {
        if place.upward {
            self.upward.push((markup.to_owned(), place));
        } else {
            self.words(markup, place);
        }
    }

    fn words(&mut self, markup: &str, place: Place) {
        let runs = text::runs(markup);
        if let [run] = runs.as_slice() {
            self.run(run, place);
            return;
        }
        let width = text::width(markup, place.size);
        let mut along = match place.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -width / 2.0,
            Anchor::End => -width,
        };
        for run in &runs {
            // A viewer of SVG drops the spaces that a text begins with.
            let words = run.text.trim_start_matches(' ');
            let spaces = run.text[..run.text.len() - words.len()].to_owned();
            along += Run { text: spaces, ..run.clone() }.width() * place.size;
            let run = &Run { text: words.to_owned(), ..run.clone() };
            let rise = run.rise * place.size;
            let (x, y) = if place.upward {
                (place.x - rise, place.y - along)
            } else {
                (place.x + along, place.y - rise)
            };
            self.run(run, Place { x, y, anchor: Anchor::Start, ..place });
            along += run.width() * place.size;
        }
    }

    fn run(&mut self, run: &Run, place: Place) {
        self.scene.add(Primitive::Text {
            x: place.x,
            y: place.y,
            content: run.text.replace('$', "\\$"),
            size: (run.size * place.size).round() as u32,
            anchor: match place.anchor {
                Anchor::Start => TextAnchor::Start,
                Anchor::Middle => TextAnchor::Middle,
                Anchor::End => TextAnchor::End,
            },
            rotate: place.upward.then_some(-90.0),
            bold: false,
            color: Some(back_color(place.color)),
        });
    }
}

fn to_pixels((x, y): (f64, f64)) -> (i64, i64) {
    ((x * PIXELS_PER_POINT).round() as i64, (y * PIXELS_PER_POINT).round() as i64)
}

fn back_color(color: Color) -> BackColor {
    BackColor::Rgb(color.red, color.green, color.blue)
}

/// Cuts a broken line into dashes. The back end's own begin anew at each point and vanish where points lie close.
fn dashes(points: &[(f64, f64)], on: f64, off: f64) -> Vec<Vec<(f64, f64)>> {
    let mut out: Vec<Vec<(f64, f64)>> = Vec::new();
    let (mut drawing, mut left) = (true, on);
    out.push(points.first().copied().into_iter().collect());
    for pair in points.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        let mut length = (to.0 - from.0).hypot(to.1 - from.1);
        while length > left {
            let t = left / length;
            from = (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
            length -= left;
            if drawing {
                push_to_last(&mut out, from);
            } else {
                out.push(vec![from]);
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
        left -= length;
        if drawing {
            push_to_last(&mut out, to);
        }
    }
    out
}

fn push_to_last(lines: &mut [Vec<(f64, f64)>], point: (f64, f64)) {
    if let Some(line) = lines.last_mut() {
        line.push(point);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Browsers do not clip by a path that is not there.
    #[test]
    fn clip_paths_are_defined_in_svg() {
        let mut canvas = Canvas::new(100.0, 50.0);
        let area = Rect { left: 10.0, top: 5.0, right: 90.0, bottom: 45.0 };
        canvas.clipped(area, |canvas| {
            canvas.line((0.0, 0.0), (100.0, 50.0), Stroke::solid(Color::rgb(0, 0, 0), 1.0))
        });
        let svg = canvas.into_svg();
        assert!(svg.contains("url(#clip1)"), "{svg}");
        let definition = r#"<clipPath id="clip1"><rect x="10" y="5" width="80" height="40"/></clipPath>"#;
        assert!(svg.contains(definition), "{svg}");
    }

    #[test]
    fn dashes_run_on_across_corners() {
        let line: Vec<(f64, f64)> = (0..=100).map(|k| (f64::from(k) * 0.3, 0.0)).collect();
        let dashes = dashes(&line, 6.0, 4.0);
        assert_eq!(dashes.len(), 3);
        for (k, dash) in dashes.iter().enumerate() {
            let (first, last) = (dash[0].0, dash[dash.len() - 1].0);
            assert!((first - 10.0 * k as f64).abs() < 1e-9 && (last - first - 6.0).abs() < 1e-9, "{dash:?}");
        }
    }
}
