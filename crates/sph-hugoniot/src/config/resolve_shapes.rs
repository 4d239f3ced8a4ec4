//! The shapes of a case: circles, ellipses, rectangles and polygons, each checked against the cell.

use glam::DVec2;

use super::fault::Span;
use super::field::Field;
use super::resolve::{Resolver, span_of};
use super::resolve_layout::MOST;
use super::resolve_medium::Draft;
use super::schema::*;
use super::units::{LengthKind, show};
use crate::microstructure::layout::{Fill, Layout};
use crate::microstructure::shape::Shape;

impl Resolver<'_> {
    fn place(&self, field: &Field<PointSchema>, name: &str, group: &Span) -> Option<DVec2> {
        let PointSchema(x, y) = field.required(name, group, self.faults)?;
        Some(DVec2::new(x.si, y.si))
    }
}

impl Draft<'_> {
    /// Shapes in their order; returns them.
    pub(super) fn paint_shapes(&self, r: &Resolver<'_>, layout: &mut Layout) -> Vec<Shape> {
        let Field::Good(list, span) = &self.m.shapes else { return Vec::new() };
        if list.len() > MOST {
            r.refuse(span.clone(), format!("{} shapes are listed", list.len()), &format!("at most {MOST}"));
            return Vec::new();
        }
        let mut standing = Vec::new();
        for field in list {
            let Some(schema) = field.get() else { continue };
            let span = span_of(field);
            let read = self.shape(r, schema, &span);
            if let Some((shape, fill)) = read.filter(|(shape, _)| self.is_in_cell(r, shape, &span)) {
                standing.push(shape.clone());
                layout.paint(shape, fill);
            }
        }
        standing
    }

    fn shape(&self, r: &Resolver<'_>, schema: &ShapeSchema, span: &Span) -> Option<(Shape, Fill)> {
        let fill = |of: &Field<FillSchema>| r.fill(of, Fill::Void, self.around);
        let most = self.cell.max_element();
        match schema {
            ShapeSchema::Circle(c) => {
                let center = r.place(&c.center, "center", span);
                let radius = r.needed(&c.radius, "radius", span, 0.25 * self.size, most);
                Some((Shape::Circle { center: center?, radius: radius? }, fill(&c.of)?))
            }
            ShapeSchema::Ellipse(e) => {
                let center = r.place(&e.center, "center", span);
                let axes = r.place(&e.semi_axes, "semi_axes", span);
                let angle = r.number(&e.angle, 0.0, -360.0, 360.0)?.to_radians();
                let axes = self.positive(r, axes?, &e.semi_axes, "half axes")?;
                Some((Shape::ellipse(center?, axes, angle), fill(&e.of)?))
            }
            ShapeSchema::Rectangle(b) => {
                let (lower, upper) = (r.place(&b.lower, "lower", span), r.place(&b.upper, "upper", span));
                let (lower, upper) = (lower?, upper?);
                self.positive(r, upper - lower, &b.upper, "edges")?;
                Some((Shape::Rectangle { lower, upper }, fill(&b.of)?))
            }
            ShapeSchema::Polygon(p) => {
                let list = p.corners.required("corners", span, r.faults)?;
                let corners: Vec<DVec2> =
                    list.iter().filter_map(|f| f.get()).map(|c| DVec2::new(c.0.si, c.1.si)).collect();
                let shape = self.polygon(r, corners, &span_of(&p.corners))?;
                Some((shape, fill(&p.of)?))
            }
        }
    }

    fn positive<T>(&self, r: &Resolver<'_>, lengths: DVec2, field: &Field<T>, what: &str) -> Option<DVec2> {
        if lengths.min_element() >= 0.25 * self.size {
            return Some(lengths);
        }
        let (x, y) = (show::<LengthKind>(lengths.x), show::<LengthKind>(lengths.y));
        let least = show::<LengthKind>(0.25 * self.size);
        r.refuse(span_of(field), format!("its {what} are {x} and {y}"), &format!("at least D/4 = {least}"));
        None
    }

    /// A polygon has an area, and its edges do not cross.
    fn polygon(&self, r: &Resolver<'_>, corners: Vec<DVec2>, span: &Span) -> Option<Shape> {
        if !(3..=MOST).contains(&corners.len()) {
            r.refuse(
                span.clone(),
                format!("a polygon of {} corners", corners.len()),
                &format!("from 3 to {MOST}"),
            );
            return None;
        }
        let n = corners.len();
        let edge = |k: usize| (corners[k], corners[(k + 1) % n]);
        for a in 0..n {
            for b in a + 2..n {
                if (b + 1) % n != a && cross(edge(a), edge(b)) {
                    let message = format!("the edges from corner {} and from corner {} cross", a + 1, b + 1);
                    r.refuse(
                        span.clone(),
                        message,
                        "list corners in the order in which the outline meets them",
                    );
                    return None;
                }
            }
        }
        let shape = Shape::Polygon { corners };
        if shape.area(0.0) < 0.05 * self.size * self.size {
            r.refuse(
                span.clone(),
                "the polygon has next to no area".into(),
                "corners in order, two lengths each",
            );
            return None;
        }
        Some(shape)
    }

    /// A shape begins in the cell and is no longer than it; what hangs over a side comes in at the other.
    fn is_in_cell(&self, r: &Resolver<'_>, shape: &Shape, span: &Span) -> bool {
        let (middle, half) = shape.bounds();
        let (lower, upper) = (middle - half, middle + half);
        let size = |v: DVec2| format!("{} × {}", show::<LengthKind>(v.x), show::<LengthKind>(v.y));
        let slack = 1e-9 * self.cell;
        if (2.0 * half).cmpgt(self.cell + slack).any() {
            let message = format!("it is {} large, the cell {}", size(2.0 * half), size(self.cell));
            r.refuse(span.clone(), message, "a shape no larger than the cell");
            return false;
        }
        if upper.cmple(DVec2::ZERO).any() || lower.cmpge(self.cell).any() {
            let at = |v: DVec2| format!("({}, {})", show::<LengthKind>(v.x), show::<LengthKind>(v.y));
            let message = format!("it reaches from {} to {}, outside of the cell", at(lower), at(upper));
            r.refuse(span.clone(), message, &format!("the cell reaches from (0, 0) to {}", at(self.cell)));
            return false;
        }
        true
    }
}

/// True if two edges cross.
fn cross((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> bool {
    let side = |p: DVec2, q: DVec2, x: DVec2| (q - p).perp_dot(x - p).signum();
    side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
}
