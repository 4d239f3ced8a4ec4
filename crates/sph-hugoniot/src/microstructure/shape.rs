//! Shapes in a periodic cell, as signed distances: negative inside, zero on the boundary, positive outside [m].
//!
//! A shape stands for itself and all its periodic images. Distances of circles, ellipses and layers are exact; where
//! images of a rectangle or polygon overlap one another, the sign is right and the inside distance a lower bound.
//! Nothing here depends on the platform's mathematics library: the same numbers on every machine.
//!
//! Ellipse: the nearest point x of x²/a² + y²/b² = 1 to p has x_k = a_k² p_k/(t + a_k²) with the largest root t of
//! (a p_x/(t + a²))² + (b p_y/(t + b²))² = 1 (D. Eberly, Distance from a Point to an Ellipse, 2013).

use glam::DVec2;
use serde::Serialize;

/// A closed shape in the plane.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Shape {
    /// A disc.
    Circle {
        /// Center [m].
        center: DVec2,
        /// Radius [m].
        radius: f64,
    },
    /// An ellipse.
    Ellipse {
        /// Center [m].
        center: DVec2,
        /// Half of the length along its own axes [m].
        semi_axes: DVec2,
        /// Direction of its first axis, a unit vector [-].
        direction: DVec2,
    },
    /// A rectangle along the axes.
    Rectangle {
        /// Lower left corner [m].
        lower: DVec2,
        /// Upper right corner [m].
        upper: DVec2,
    },
    /// A polygon without crossings.
    Polygon {
        /// Corners in order [m].
        corners: Vec<DVec2>,
    },
    /// All that lies between two places along x, through the whole width of the cell.
    Layer {
        /// Left end [m].
        from: f64,
        /// Right end [m].
        to: f64,
    },
}

impl Shape {
    /// An ellipse, or a circle where both axes are equal. The angle of the first axis is in radians.
    pub fn ellipse(center: DVec2, semi_axes: DVec2, angle: f64) -> Self {
        if semi_axes.x == semi_axes.y {
            return Self::Circle { center, radius: semi_axes.x };
        }
        Self::Ellipse { center, semi_axes, direction: DVec2::new(libm::cos(angle), libm::sin(angle)) }
    }

    /// Middle and half extents of a box around the shape [m]; a layer has no extent across.
    pub fn bounds(&self) -> (DVec2, DVec2) {
        match self {
            Self::Circle { center, radius } => (*center, DVec2::splat(*radius)),
            Self::Ellipse { center, semi_axes, direction } => {
                let (a, b) = (semi_axes.x * *direction, semi_axes.y * direction.perp());
                (*center, DVec2::new(length(DVec2::new(a.x, b.x)), length(DVec2::new(a.y, b.y))))
            }
            Self::Rectangle { lower, upper } => (0.5 * (*lower + *upper), 0.5 * (*upper - *lower)),
            Self::Polygon { corners } => {
                let lower = corners.iter().copied().fold(DVec2::INFINITY, DVec2::min);
                let upper = corners.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
                (0.5 * (lower + upper), 0.5 * (upper - lower))
            }
            Self::Layer { from, to } => {
                (DVec2::new(0.5 * (from + to), 0.0), DVec2::new(0.5 * (to - from), 0.0))
            }
        }
    }

    /// Area [m²]; that of a layer for a cell of this height [m].
    pub fn area(&self, height: f64) -> f64 {
        match self {
            Self::Circle { radius, .. } => std::f64::consts::PI * radius * radius,
            Self::Ellipse { semi_axes, .. } => std::f64::consts::PI * semi_axes.x * semi_axes.y,
            Self::Rectangle { lower, upper } => (upper.x - lower.x) * (upper.y - lower.y),
            Self::Polygon { corners } => 0.5 * edges(corners).map(|(a, b)| a.perp_dot(b)).sum::<f64>().abs(),
            Self::Layer { from, to } => (to - from) * height,
        }
    }

    /// Least width of the shape [m].
    pub fn width(&self) -> f64 {
        match self {
            Self::Circle { radius, .. } => 2.0 * radius,
            Self::Ellipse { semi_axes, .. } => 2.0 * semi_axes.min_element(),
            Self::Rectangle { lower, upper } => (*upper - *lower).min_element(),
            Self::Polygon { .. } => 2.0 * self.bounds().1.min_element(),
            Self::Layer { from, to } => to - from,
        }
    }

    /// No point of the shape or its images is nearer than this [m]: the distance to the boxes around them.
    pub(crate) fn least_distance(&self, point: DVec2, cell: DVec2) -> f64 {
        let (middle, half) = self.bounds();
        let offset = point - middle;
        let nearest = (offset - cell * (offset / cell).round()).abs();
        match self {
            Self::Layer { .. } => (nearest.x - half.x).max(0.0),
            _ => length((nearest - half).max(DVec2::ZERO)),
        }
    }

    /// Signed distance of a point [m] to the shape and its images in a cell of this size [m].
    pub fn distance(&self, point: DVec2, cell: DVec2) -> f64 {
        let (middle, half) = self.bounds();
        let offset = point - middle;
        let nearest = offset - cell * (offset / cell).round();
        if let Self::Layer { .. } = self {
            return nearest.x.abs() - half.x;
        }
        let mut best = f64::INFINITY;
        for image in IMAGES {
            let from_middle = nearest + DVec2::new(image.0, image.1) * cell;
            // No point of the shape is nearer than its box.
            let outside = (from_middle.abs() - half).max(DVec2::ZERO);
            if length(outside) < best || outside == DVec2::ZERO {
                best = best.min(self.distance_one(middle + from_middle));
            }
        }
        best
    }

    /// Signed distance to the shape alone, without images.
    fn distance_one(&self, point: DVec2) -> f64 {
        match self {
            Self::Circle { center, radius } => length(point - *center) - radius,
            Self::Ellipse { center, semi_axes, direction } => {
                let offset = point - *center;
                let own = DVec2::new(offset.dot(*direction), offset.dot(direction.perp()));
                ellipse_distance(own.abs(), *semi_axes)
            }
            Self::Rectangle { lower, upper } => {
                let q = (point - 0.5 * (*lower + *upper)).abs() - 0.5 * (*upper - *lower);
                length(q.max(DVec2::ZERO)) + q.max_element().min(0.0)
            }
            Self::Polygon { corners } => polygon_distance(point, corners),
            Self::Layer { from, to } => (point.x - 0.5 * (from + to)).abs() - 0.5 * (to - from),
        }
    }

    /// Points on the boundary of the shape [m], close enough together to tell gaps from others; none of a layer.
    pub(crate) fn outline(&self) -> Vec<DVec2> {
        let round = |center: DVec2, a: DVec2, b: DVec2| {
            let turn = |k: i32| std::f64::consts::TAU * f64::from(k) / 96.0;
            (0..96).map(|k| center + a * libm::cos(turn(k)) + b * libm::sin(turn(k))).collect()
        };
        match self {
            Self::Circle { center, radius } => round(*center, DVec2::X * *radius, DVec2::Y * *radius),
            Self::Ellipse { center, semi_axes, direction } => {
                round(*center, *direction * semi_axes.x, direction.perp() * semi_axes.y)
            }
            Self::Rectangle { lower, upper } => {
                let corners = [*lower, DVec2::new(upper.x, lower.y), *upper, DVec2::new(lower.x, upper.y)];
                along_edges(&corners)
            }
            Self::Polygon { corners } => along_edges(corners),
            Self::Layer { .. } => Vec::new(),
        }
    }

    /// True if the gap to another shape and its images is no narrower than this [m].
    pub(crate) fn keeps_gap(&self, other: &Self, gap: f64, cell: DVec2) -> bool {
        if matches!(self, Self::Circle { .. }) || matches!(other, Self::Circle { .. }) {
            return self.gap(other, cell) >= gap;
        }
        // As in `gap`, but the first point that is too near decides.
        let clear = |a: &Self, b: &Self| a.outline().iter().all(|&p| b.distance(p, cell) >= gap);
        clear(self, other) && clear(other, self)
    }

    /// Width of the gap to another shape and its images [m]; negative where they overlap.
    pub fn gap(&self, other: &Self, cell: DVec2) -> f64 {
        match (self, other) {
            (Self::Circle { center, radius }, _) => other.distance(*center, cell) - radius,
            (_, Self::Circle { center, radius }) => self.distance(*center, cell) - radius,
            _ => {
                let from = |a: &Self, b: &Self| {
                    a.outline().iter().map(|&p| b.distance(p, cell)).fold(f64::INFINITY, f64::min)
                };
                from(self, other).min(from(other, self))
            }
        }
    }
}

/// The cell itself and its neighbors.
const IMAGES: [(f64, f64); 9] = [
    (0.0, 0.0),
    (1.0, 0.0),
    (-1.0, 0.0),
    (0.0, 1.0),
    (0.0, -1.0),
    (1.0, 1.0),
    (1.0, -1.0),
    (-1.0, 1.0),
    (-1.0, -1.0),
];

/// Length by operations that are rounded alike everywhere.
fn length(v: DVec2) -> f64 {
    (v.x * v.x + v.y * v.y).sqrt()
}

fn edges(corners: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> {
    (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]))
}

fn along_edges(corners: &[DVec2]) -> Vec<DVec2> {
    edges(corners).flat_map(|(a, b)| (0..24).map(move |k| a + (b - a) * (f64::from(k) / 24.0))).collect()
}

/// Distance of a point of the first quadrant to an ellipse along the axes.
fn ellipse_distance(point: DVec2, semi_axes: DVec2) -> f64 {
    let (e, y) = if semi_axes.x < semi_axes.y {
        (DVec2::new(semi_axes.y, semi_axes.x), DVec2::new(point.y, point.x))
    } else {
        (semi_axes, point)
    };
    let scaled = y / e;
    let inside = scaled.dot(scaled) < 1.0;
    let foot = if y.y > 0.0 {
        let ratio = (e.x / e.y) * (e.x / e.y);
        let t = ellipse_root(ratio, scaled);
        DVec2::new(ratio * y.x / (t + ratio), y.y / (t + 1.0))
    } else {
        // On the long axis: near the middle the nearest point is off the axis.
        let part = (e.x * y.x / (e.x * e.x - e.y * e.y)).min(1.0);
        DVec2::new(e.x * part, e.y * (1.0 - part * part).sqrt())
    };
    if inside { -length(foot - y) } else { length(foot - y) }
}

/// Root of (r z_x/(t + r))² + (z_y/(t + 1))² = 1 beyond the poles. The left side falls and is convex there, so that
/// Newton's steps from the left rise to the root and never pass it.
fn ellipse_root(ratio: f64, z: DVec2) -> f64 {
    let n = ratio * z.x;
    let mut t = z.y - 1.0;
    for _ in 0..200 {
        let (a, b) = (n / (t + ratio), z.y / (t + 1.0));
        let slope = 2.0 * (a * a / (t + ratio) + b * b / (t + 1.0));
        let next = t + (a * a + b * b - 1.0) / slope;
        if next <= t || next.is_nan() {
            break;
        }
        t = next;
    }
    t
}

fn polygon_distance(point: DVec2, corners: &[DVec2]) -> f64 {
    let (mut nearest, mut inside) = (f64::INFINITY, false);
    for (a, b) in edges(corners) {
        let (edge, to) = (b - a, point - a);
        let part = (to.dot(edge) / edge.dot(edge)).clamp(0.0, 1.0);
        nearest = nearest.min(length(to - edge * part));
        if (a.y > point.y) != (b.y > point.y) && point.x < a.x + edge.x * (point.y - a.y) / edge.y {
            inside = !inside;
        }
    }
    if inside { -nearest } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELL: DVec2 = DVec2::new(10.0, 8.0);

    fn shapes() -> Vec<Shape> {
        vec![
            Shape::Circle { center: DVec2::new(9.5, 0.5), radius: 2.0 },
            Shape::ellipse(DVec2::new(5.0, 4.0), DVec2::new(3.0, 1.0), 0.7),
            Shape::ellipse(DVec2::new(5.0, 4.0), DVec2::new(0.5, 2.5), 0.0),
            Shape::Rectangle { lower: DVec2::new(-1.0, 2.0), upper: DVec2::new(3.0, 5.0) },
            Shape::Polygon {
                corners: vec![DVec2::new(2.0, 1.0), DVec2::new(6.0, 2.0), DVec2::new(3.0, 6.0)],
            },
            Shape::Layer { from: 8.0, to: 11.0 },
        ]
    }

    #[test]
    fn areas_agree_with_the_sign_of_the_distance() {
        let n = 400;
        for shape in shapes() {
            let at = |k: usize| (DVec2::new((k % n) as f64, (k / n) as f64) + 0.5) / n as f64 * CELL;
            let inside = (0..n * n).filter(|&k| shape.distance(at(k), CELL) < 0.0).count();
            let area = inside as f64 / (n * n) as f64 * 80.0;
            assert!((area / shape.area(8.0) - 1.0).abs() < 5e-3, "{shape:?}: {area} {}", shape.area(8.0));
        }
    }

    #[test]
    fn distances_are_those_to_the_nearest_point_of_the_outline() {
        for shape in shapes().into_iter().filter(|s| !s.outline().is_empty()) {
            for k in 0..200 {
                let point = DVec2::new(f64::from(k % 20) * 0.5 + 0.1, f64::from(k / 20) * 0.8 + 0.1);
                let d = shape.distance(point, CELL);
                let images = |p: DVec2| IMAGES.map(|i| p + DVec2::new(i.0, i.1) * CELL);
                let nearest = shape
                    .outline()
                    .into_iter()
                    .flat_map(images)
                    .map(|p| (p - point).length())
                    .fold(f64::INFINITY, f64::min);
                // Points of the outline stand up to 0.2 apart.
                assert!(
                    d.abs() <= nearest + 1e-9 && (d.abs() > nearest - 0.1),
                    "{shape:?} {point}: {d} {nearest}"
                );
            }
        }
    }

    #[test]
    fn gaps_reach_across_the_sides_of_the_cell() {
        let circle = |x: f64, radius: f64| Shape::Circle { center: DVec2::new(x, 4.0), radius };
        assert!((circle(1.0, 0.5).gap(&circle(9.0, 0.5), CELL) - 1.0).abs() < 1e-12);
        let flat = |x: f64| Shape::ellipse(DVec2::new(x, 4.0), DVec2::new(1.0, 0.5), 0.0);
        assert!((flat(2.0).gap(&flat(6.0), CELL) - 2.0).abs() < 1e-3);
        assert!(flat(2.0).gap(&flat(3.5), CELL) < 0.0, "overlap");
        assert!((circle(1.0, 0.5).gap(&flat(4.0), CELL) - 1.5).abs() < 1e-12);
    }

    #[test]
    fn an_ellipse_on_its_axes_has_the_distances_of_its_ends() {
        let ellipse = Shape::ellipse(DVec2::new(5.0, 4.0), DVec2::new(3.0, 1.0), 0.0);
        for (x, y, d) in [(9.0, 4.0, 1.0), (5.0, 6.0, 1.0), (5.0, 4.0, -1.0), (7.9, 4.0, -0.1)] {
            assert!((ellipse.distance(DVec2::new(x, y), DVec2::splat(100.0)) - d).abs() < 1e-12, "{x} {y}");
        }
    }
}
