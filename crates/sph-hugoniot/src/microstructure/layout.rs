//! What is where in the cell: a base, and shapes painted over it one after another.
//!
//! For each filling (void, or a material) the layout is a level set φ: negative inside, positive outside. Painting a
//! shape of signed distance s gives φ ← min(φ, s) for its own filling and φ ← max(φ, -s) for every other. The sign is
//! exact; |φ| is a distance near smooth boundaries. Moving a boundary by c is the level φ = c: that is how the porosity
//! is met exactly.

use glam::DVec2;
use serde::Serialize;

use super::image::ImageLayout;
use super::shape::Shape;

/// What fills a part of the cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Fill {
    /// Nothing.
    Void,
    /// The material with this index in the list of the case.
    Material(u16),
}

/// A shape and what fills it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Painted {
    /// Where.
    pub shape: Shape,
    /// What.
    pub fill: Fill,
}

/// What is there before anything is painted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Base {
    /// The same everywhere.
    Uniform(Fill),
    /// What a picture shows.
    Image(ImageLayout),
}

/// What is where in the cell.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Layout {
    /// Below all.
    pub base: Base,
    /// From below to above.
    pub painted: Vec<Painted>,
}

/// Points along each edge of the grid that areas are measured on, at most and at least.
const GRID: (f64, f64) = (600.0, 64.0);

impl Layout {
    /// The first material everywhere.
    pub fn solid() -> Self {
        Self { base: Base::Uniform(Fill::Material(0)), painted: Vec::new() }
    }

    /// Paints a shape over what is there.
    pub fn paint(&mut self, shape: Shape, fill: Fill) {
        self.painted.push(Painted { shape, fill });
    }

    /// The level set φ of a filling at a point [m]: negative where it is, in a periodic cell of this size [m].
    pub fn level(&self, fill: Fill, point: DVec2, cell: DVec2) -> f64 {
        let mut level = match &self.base {
            Base::Uniform(base) if *base == fill => f64::NEG_INFINITY,
            Base::Uniform(_) => f64::INFINITY,
            Base::Image(image) => image.level(fill, point),
        };
        for painted in &self.painted {
            // What is too far to change the level is most of the shapes, and of the work.
            let least = painted.shape.least_distance(point, cell);
            if least > 0.0 && if painted.fill == fill { least >= level } else { -least <= level } {
                continue;
            }
            let distance = painted.shape.distance(point, cell);
            level = if painted.fill == fill { level.min(distance) } else { level.max(-distance) };
        }
        level
    }

    /// All fillings that occur.
    pub fn fills(&self) -> Vec<Fill> {
        let mut fills = match &self.base {
            Base::Uniform(fill) => vec![*fill],
            Base::Image(image) => image.fills(),
        };
        for painted in &self.painted {
            if !fills.contains(&painted.fill) {
                fills.push(painted.fill);
            }
        }
        fills
    }

    /// True if there is a void or a second material.
    pub fn has(&self, fill: Fill) -> bool {
        self.fills().contains(&fill)
    }

    /// Levels of a filling on a regular grid over the cell, and the distance of its points [m].
    pub fn grid(&self, fill: Fill, cell: DVec2) -> (Vec<f64>, f64) {
        let step = cell.max_element() / GRID.0;
        let count = |edge: f64| (edge / step).ceil().max(GRID.1) as usize;
        let (columns, rows) = (count(cell.x), count(cell.y));
        let (dx, dy) = (cell.x / columns as f64, cell.y / rows as f64);
        let at = |k: usize| DVec2::new(((k % columns) as f64 + 0.5) * dx, ((k / columns) as f64 + 0.5) * dy);
        ((0..columns * rows).map(|k| self.level(fill, at(k), cell)).collect(), (dx * dy).sqrt())
    }

    /// Part of the cell's area that a filling takes [-]; boundaries count by the part of a grid cell that they cut off.
    pub fn share(&self, fill: Fill, cell: DVec2) -> f64 {
        let (levels, step) = self.grid(fill, cell);
        let inside: f64 = levels.iter().map(|level| (0.5 - level / step).clamp(0.0, 1.0)).sum();
        inside / levels.len() as f64
    }

    /// How far the boundary of the voids must move outward for them to take this part of the area [m]; infinite where
    /// there is none to move.
    pub fn offset_for(&self, share: f64, cell: DVec2) -> f64 {
        let (mut levels, _) = self.grid(Fill::Void, cell);
        levels.sort_by(f64::total_cmp);
        let last = levels.len() - 1;
        levels[((share * levels.len() as f64) as usize).min(last)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELL: DVec2 = DVec2::new(4.0, 2.0);

    fn circle(x: f64, radius: f64) -> Shape {
        Shape::Circle { center: DVec2::new(x, 1.0), radius }
    }

    #[test]
    fn later_shapes_paint_over_earlier_ones() {
        let mut layout = Layout::solid();
        layout.paint(circle(1.0, 0.8), Fill::Void);
        layout.paint(circle(1.0, 0.4), Fill::Material(1));
        layout.paint(Shape::Layer { from: 3.0, to: 4.0 }, Fill::Material(1));
        let pi = std::f64::consts::PI;
        let shares = [
            (Fill::Void, pi * (0.64 - 0.16) / 8.0),
            (Fill::Material(1), (pi * 0.16 + 2.0) / 8.0),
            (Fill::Material(0), (6.0 - pi * 0.64) / 8.0),
            (Fill::Material(2), 0.0),
        ];
        for (fill, share) in shares {
            assert!(
                (layout.share(fill, CELL) - share).abs() < 2e-4,
                "{fill:?}: {} {share}",
                layout.share(fill, CELL)
            );
        }
        assert_eq!(layout.fills().len(), 3);
        assert!(layout.has(Fill::Void) && !layout.has(Fill::Material(2)));
    }

    #[test]
    fn the_boundary_moves_until_the_void_is_as_large_as_asked() {
        let mut layout = Layout::solid();
        layout.paint(circle(2.0, 0.5), Fill::Void);
        let wanted = std::f64::consts::PI * 0.36 / 8.0;
        assert!((layout.offset_for(wanted, CELL) - 0.1).abs() < 0.005);
        assert_eq!(Layout::solid().offset_for(0.1, CELL), f64::INFINITY);
    }
}
