//! Shapes as sets of points: a few simple ones and what unions, intersections and complements make of them.
//!
//! The same names serve both dimensions: a ball is a disc in the plane, an annulus is a spherical shell in space, an
//! ellipse an ellipsoid. The simple shapes contain their boundary. Where particles stand exactly on a boundary, rounding
//! decides: place boundaries between particles.

use crate::dimension::{Dimension, Vector};
use crate::domain::Domain;

/// A set of points.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape<D: Dimension> {
    /// Points on the side of a plane that `normal` (of any length) points away from.
    HalfSpace {
        /// A point of the plane [m].
        point: D::Vector,
        /// Outward normal, of any length [-].
        normal: D::Vector,
    },
    /// A box along the axes.
    Box {
        /// Lower corner [m].
        lower: D::Vector,
        /// Upper corner [m].
        upper: D::Vector,
    },
    /// A disc or a ball.
    Ball {
        /// Center [m].
        center: D::Vector,
        /// Radius [m].
        radius: f64,
    },
    /// A ring or a spherical shell.
    Annulus {
        /// Center [m].
        center: D::Vector,
        /// Inner radius [m].
        inner_radius: f64,
        /// Outer radius [m].
        outer_radius: f64,
    },
    /// An ellipse or an ellipsoid with its axes along the coordinate axes.
    Ellipse {
        /// Center [m].
        center: D::Vector,
        /// Half of the length along each axis [m].
        semi_axes: D::Vector,
    },
    /// Points of any of the shapes; nothing if there are none.
    Union(Vec<Self>),
    /// Points of all the shapes; everything if there are none.
    Intersection(Vec<Self>),
    /// Points that are not of the shape.
    Complement(Box<Self>),
}

impl<D: Dimension> Shape<D> {
    /// True if the point [m] belongs to the shape.
    pub fn contains(&self, point: D::Vector) -> bool {
        self.contains_any(&[point])
    }

    /// True if the point [m] belongs to the shape or to one of its images across the periodic sides of the box.
    ///
    /// A shape may hang over a periodic side by up to one period. The complement is that of all images: the matrix
    /// around a periodic array of pores.
    pub fn contains_in(&self, point: D::Vector, domain: &Domain<D>) -> bool {
        let mut images = vec![D::vector(|a| domain.wrap(a, point[a]))];
        for axis in (0..D::COUNT).filter(|&a| domain.periodic[a]) {
            for image in 0..images.len() {
                for turn in [-1.0, 1.0] {
                    let mut moved = images[image];
                    moved[axis] += turn * domain.period(axis);
                    images.push(moved);
                }
            }
        }
        self.contains_any(&images)
    }

    /// This shape without the other.
    pub fn without(self, other: Self) -> Self {
        Self::Intersection(vec![self, other.complement()])
    }

    /// All points that are not of this shape.
    pub fn complement(self) -> Self {
        Self::Complement(Box::new(self))
    }

    /// True if one of the images of a point belongs to the shape. Sets of simple shapes are taken of the shapes with
    /// all their images, so that a complement excludes every image.
    fn contains_any(&self, images: &[D::Vector]) -> bool {
        match self {
            Self::Union(shapes) => shapes.iter().any(|shape| shape.contains_any(images)),
            Self::Intersection(shapes) => shapes.iter().all(|shape| shape.contains_any(images)),
            Self::Complement(shape) => !shape.contains_any(images),
            simple => images.iter().any(|&image| simple.contains_one(image)),
        }
    }

    /// A simple shape and one point.
    fn contains_one(&self, point: D::Vector) -> bool {
        match self {
            Self::HalfSpace { point: origin, normal } => (point - *origin).dot(*normal) <= 0.0,
            Self::Box { lower, upper } => (0..D::COUNT).all(|a| (lower[a]..=upper[a]).contains(&point[a])),
            Self::Ball { center, radius } => (point - *center).length() <= *radius,
            Self::Annulus { center, inner_radius, outer_radius } => {
                (*inner_radius..=*outer_radius).contains(&(point - *center).length())
            }
            Self::Ellipse { center, semi_axes } => {
                let scaled = D::vector(|a| (point[a] - center[a]) / semi_axes[a]);
                scaled.length() <= 1.0
            }
            Self::Union(_) | Self::Intersection(_) | Self::Complement(_) => self.contains_any(&[point]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::{Dim2, Dim3};
    use glam::{DVec2, DVec3};
    use std::f64::consts::PI;

    /// Share of a fine grid over [-1, 1]^2 that is in the shape, times 4.
    fn area(shape: &Shape<Dim2>) -> f64 {
        let n = 400;
        let at = |k: usize| (k as f64 + 0.5) * 2.0 / n as f64 - 1.0;
        let inside = |k: &usize| shape.contains(DVec2::new(at(k / n), at(k % n)));
        4.0 * (0..n * n).filter(inside).count() as f64 / (n * n) as f64
    }

    #[test]
    fn areas_are_those_of_the_formulas() {
        let ball = |radius: f64| Shape::<Dim2>::Ball { center: DVec2::ZERO, radius };
        let ellipse = Shape::Ellipse { center: DVec2::ZERO, semi_axes: DVec2::new(0.9, 0.3) };
        let annulus = Shape::Annulus { center: DVec2::ZERO, inner_radius: 0.4, outer_radius: 0.8 };
        let half = Shape::HalfSpace { point: DVec2::new(0.5, 0.5), normal: DVec2::new(2.0, 2.0) };
        let rectangle = Shape::Box { lower: DVec2::new(-0.5, -0.25), upper: DVec2::new(0.5, 0.25) };
        let cases = [
            (ball(0.7), PI * 0.49),
            (ellipse, PI * 0.27),
            (annulus.clone(), PI * 0.48),
            (half, 3.5),
            (rectangle.clone(), 0.5),
            (Shape::Union(vec![annulus.clone(), ball(0.4)]), PI * 0.64),
            (Shape::Intersection(vec![annulus, ball(0.6)]), PI * 0.2),
            (ball(0.8).without(rectangle), PI * 0.64 - 0.5),
            (ball(0.5).complement(), 4.0 - PI * 0.25),
            (Shape::Union(vec![]), 0.0),
            (Shape::Intersection(vec![]), 4.0),
        ];
        for (shape, expected) in cases {
            assert!((area(&shape) - expected).abs() < 0.01, "{shape:?}: {} {expected}", area(&shape));
        }
    }

    #[test]
    fn a_pore_at_the_corner_of_a_periodic_cell_takes_a_bite_from_each_corner() {
        let domain = Domain::<Dim2>::new(DVec2::splat(-1.0), DVec2::splat(1.0), [true, true]);
        let solid = Shape::Ball { center: DVec2::splat(-1.0), radius: 0.5 }.complement();
        let corners = [(0.9, 0.9), (-0.9, 0.9), (0.9, -0.9), (-0.9, -0.9), (2.9, 0.9)];
        assert!(corners.iter().all(|&(x, y)| !solid.contains_in(DVec2::new(x, y), &domain)));
        assert!(solid.contains_in(DVec2::ZERO, &domain));
        assert!(solid.contains(DVec2::splat(0.9)), "without the box there is one pore");
        let open = Domain::new(domain.lower, domain.upper, [true, false]);
        assert!(!solid.contains_in(DVec2::new(0.9, -0.9), &open));
        assert!(solid.contains_in(DVec2::new(0.9, 0.9), &open), "no image across an open side");
    }

    #[test]
    fn shapes_in_space() {
        let shell = Shape::<Dim3>::Annulus { center: DVec3::ONE, inner_radius: 1.0, outer_radius: 2.0 };
        assert!(shell.contains(DVec3::new(1.0, 1.0, 2.5)));
        assert!(!shell.contains(DVec3::new(1.0, 1.5, 1.0)));
        let ellipsoid = Shape::<Dim3>::Ellipse { center: DVec3::ZERO, semi_axes: DVec3::new(1.0, 2.0, 3.0) };
        assert!(
            ellipsoid.contains(DVec3::new(0.0, 0.0, 3.0)) && !ellipsoid.contains(DVec3::new(0.0, 2.5, 0.0))
        );
    }
}
