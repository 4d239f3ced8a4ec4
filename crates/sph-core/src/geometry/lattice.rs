//! Perfect lattices: square and hexagonal in the plane; cubic, face-centered cubic and hexagonal close-packed in space.
//!
//! All are scaled so that a particle of size D stands for the volume D^d. A box is filled with a whole number of unit
//! cells along each axis, stretched to fit, so that it can be periodic and has exactly its volume.

use serde::{Deserialize, Serialize};

use crate::dimension::Dimension;
use crate::error::CoreError;
use crate::geometry::Packing;
use crate::kernel::KernelFamily;

/// A perfect lattice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Lattice {
    /// In the plane: rows and columns a distance D apart.
    #[default]
    Square,
    /// In the plane: rows along x, every other one shifted by half of the distance D sqrt(2/√3) within a row.
    Hexagonal,
    /// In space: layers of the square lattice on top of each other.
    Cubic,
    /// In space: close-packed with edges of the unit cell along the axes.
    FaceCenteredCubic,
    /// In space: hexagonal layers normal to z, stacked ABAB.
    HexagonalClosePacked,
}

/// A unit cell with edges along the axes, for D = 1.
struct UnitCell {
    /// Lengths of the edges [D].
    edges: [f64; 3],
    /// Points in shares of the edges, symmetric about the middle.
    points: &'static [[f64; 3]],
}

impl Lattice {
    /// Every lattice, those of the plane first.
    pub const ALL: [Self; 5] =
        [Self::Square, Self::Hexagonal, Self::Cubic, Self::FaceCenteredCubic, Self::HexagonalClosePacked];

    /// Number of space dimensions that the lattice lives in.
    pub fn dimension_count(self) -> usize {
        match self {
            Self::Square | Self::Hexagonal => 2,
            Self::Cubic | Self::FaceCenteredCubic | Self::HexagonalClosePacked => 3,
        }
    }

    /// Name in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Square => "square",
            Self::Hexagonal => "hexagonal",
            Self::Cubic => "cubic",
            Self::FaceCenteredCubic => "face-centered cubic",
            Self::HexagonalClosePacked => "hexagonal close-packed",
        }
    }

    /// Distance between nearest points [D].
    pub fn nearest_distance(self) -> f64 {
        match self {
            Self::Square | Self::Cubic => 1.0,
            Self::Hexagonal => (2.0 / 3f64.sqrt()).sqrt(),
            Self::FaceCenteredCubic | Self::HexagonalClosePacked => 2f64.powf(1.0 / 6.0),
        }
    }

    /// Fills the box between two corners [m] with particles of about the size `size` [m].
    ///
    /// # Errors
    /// If the lattice is not of this dimension, or a length is not positive.
    pub fn fill_box<D: Dimension>(
        self,
        lower: D::Vector,
        upper: D::Vector,
        size: f64,
    ) -> Result<Packing<D>, CoreError> {
        self.check_dimension::<D>()?;
        positive("the particle size", size)?;
        for a in 0..D::COUNT {
            positive("the edge of a box", upper[a] - lower[a])?;
        }
        let cell = self.unit_cell();
        let mut count = [1; 3];
        let mut edge = [0.0; 3];
        for a in 0..D::COUNT {
            count[a] = ((upper[a] - lower[a]) / (cell.edges[a] * size)).round().max(1.0) as usize;
            edge[a] = (upper[a] - lower[a]) / count[a] as f64;
        }
        let volume = (0..D::COUNT).map(|a| edge[a]).product::<f64>() / cell.points.len() as f64;
        let mut packing = Packing::empty(size);
        for at in cells(count) {
            for point in cell.points {
                let place = |a: usize| lower[a] + (at[a] as f64 + point[a]) * edge[a];
                packing.push(D::vector(place), volume);
            }
        }
        Ok(packing)
    }

    fn check_dimension<D: Dimension>(self) -> Result<(), CoreError> {
        if self.dimension_count() == D::COUNT {
            return Ok(());
        }
        Err(CoreError::LatticeDimension { lattice: self.name(), dimension_count: D::COUNT })
    }

    fn unit_cell(self) -> UnitCell {
        const THIRD: f64 = 1.0 / 3.0;
        let a = self.nearest_distance();
        match self {
            Self::Square | Self::Cubic => UnitCell { edges: [1.0; 3], points: &[[0.5; 3]] },
            Self::Hexagonal => {
                UnitCell { edges: [a, a * 3f64.sqrt(), 0.0], points: &[[0.25, 0.25, 0.0], [0.75, 0.75, 0.0]] }
            }
            Self::FaceCenteredCubic => UnitCell {
                edges: [a * 2f64.sqrt(); 3],
                points: &[[0.25; 3], [0.75, 0.75, 0.25], [0.75, 0.25, 0.75], [0.25, 0.75, 0.75]],
            },
            // The second layer sits over the hollows of the first, a/√3 further along y.
            Self::HexagonalClosePacked => UnitCell {
                edges: [a, a * 3f64.sqrt(), a * (8.0 * THIRD).sqrt()],
                points: &[
                    [0.25, 1.0 / 12.0, 0.25],
                    [0.75, 7.0 / 12.0, 0.25],
                    [0.25, 5.0 / 12.0, 0.75],
                    [0.75, 11.0 / 12.0, 0.75],
                ],
            },
        }
    }

    /// Vectors from one point of the infinite lattice to all points less than `radius` away, itself included, for
    /// D = 1. All points see the same distances.
    pub fn offsets_within(self, radius: f64) -> Vec<[f64; 3]> {
        let cell = self.unit_cell();
        let axes = self.dimension_count();
        let reach: [usize; 3] =
            std::array::from_fn(|a| if a < axes { (radius / cell.edges[a]).ceil() as usize + 1 } else { 0 });
        let mut offsets = Vec::new();
        for at in cells(reach.map(|r| 2 * r + 1)) {
            for point in cell.points {
                let offset: [f64; 3] = std::array::from_fn(|a| {
                    let shares = (at[a] as f64 - reach[a] as f64) + point[a] - cell.points[0][a];
                    if a < axes { shares * cell.edges[a] } else { 0.0 }
                });
                if offset.iter().map(|x| x * x).sum::<f64>() < radius * radius {
                    offsets.push(offset);
                }
            }
        }
        offsets
    }

    /// Sum of `term`(r²) over the points less than `radius` [D] from one of them, itself included, r being their distance [D].
    pub fn sum(self, radius: f64, term: impl Fn(f64) -> f64 + Sync) -> f64 {
        let offsets = self.offsets_within(radius);
        crate::reduce::sum_of(offsets.len(), |k| term(offsets[k].iter().map(|x| x * x).sum()))
    }
}

/// Σ_j V_j W(r_ij; h), j = i included, over a perfect lattice, for a kernel with h = `width` D [-].
///
/// One for a kernel much wider than D; what a particle of a shut, undistorted medium sees.
pub fn lattice_volume_sum(lattice: Lattice, width: f64, kernel: KernelFamily) -> f64 {
    let sum = lattice.sum(kernel.support() * width, |r2| kernel.value(r2.sqrt() / width));
    kernel.normalization(lattice.dimension_count()) * width.powi(-(lattice.dimension_count() as i32)) * sum
}

/// Cell coordinates below `count`, the first axis slowest.
fn cells(count: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    let [nx, ny, nz] = count;
    (0..nx).flat_map(move |x| (0..ny).flat_map(move |y| (0..nz).map(move |z| [x, y, z])))
}

/// Refuses a length that is not positive and finite.
pub(super) fn positive(what: &'static str, value: f64) -> Result<(), CoreError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(CoreError::NotPositive { what, value }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dimension::{Dim2, Dim3};
    use glam::{DVec2, DVec3};

    #[test]
    fn sums_over_lattices_have_the_known_values() {
        let sum = |lattice, width| lattice_volume_sum(lattice, width, KernelFamily::WendlandC2);
        assert!((sum(Lattice::Square, 2.0) - 1.0012).abs() < 5e-5, "{}", sum(Lattice::Square, 2.0));
        assert!((sum(Lattice::Square, 1.5) - 1.0051).abs() < 5e-5, "{}", sum(Lattice::Square, 1.5));
        // The narrower kernel tells the two lattices apart a little more: 8e-5 at 2 D, 2.46e-4 at 1.5 D.
        for (width, bound) in [(2.0, 2e-4), (1.5, 2.5e-4)] {
            let difference = sum(Lattice::Hexagonal, width) - sum(Lattice::Square, width);
            assert!(difference.abs() < bound, "{width}: {difference}");
        }
    }

    #[test]
    fn sums_tend_to_one_for_every_lattice_and_kernel() {
        for lattice in Lattice::ALL {
            for kernel in KernelFamily::ALL {
                let (narrow, wide) = (1.5, 3.0);
                let error = |width| (lattice_volume_sum(lattice, width, kernel) - 1.0).abs();
                assert!(error(narrow) < 0.02, "{lattice:?} {kernel:?}: {}", error(narrow));
                assert!(error(wide) < 1e-3, "{lattice:?} {kernel:?}: {}", error(wide));
            }
        }
    }

    #[test]
    fn every_point_has_the_neighbors_of_its_lattice() {
        let expected = [4, 6, 6, 12, 12];
        for (lattice, number) in Lattice::ALL.into_iter().zip(expected) {
            let near = lattice.offsets_within(lattice.nearest_distance() * 1.01);
            assert_eq!(near.len(), number + 1, "{lattice:?}");
            assert_eq!(lattice.offsets_within(lattice.nearest_distance() * 0.99), [[0.0; 3]], "{lattice:?}");
        }
    }

    #[test]
    fn a_filled_box_has_its_volume_and_every_point_inside() {
        let (lower, upper) = (DVec2::new(-1.0, 2.0), DVec2::new(2.0, 3.1));
        for lattice in [Lattice::Square, Lattice::Hexagonal] {
            let packing = lattice.fill_box::<Dim2>(lower, upper, 0.1).unwrap();
            assert!((packing.total_volume() - 3.3).abs() < 1e-13);
            assert!((packing.len() as f64 * 0.01 / 3.3 - 1.0).abs() < 0.06);
            assert!(packing.points().all(|p| p.cmpgt(lower).all() && p.cmplt(upper).all()));
        }
        let square = Lattice::Square.fill_box::<Dim2>(lower, upper, 0.1).unwrap();
        assert_eq!(square.len(), 330);
        assert!((square.point(0) - DVec2::new(-0.95, 2.05)).length() < 1e-15);
        for lattice in [Lattice::Cubic, Lattice::FaceCenteredCubic, Lattice::HexagonalClosePacked] {
            let packing = lattice.fill_box::<Dim3>(DVec3::ZERO, DVec3::new(1.0, 2.0, 1.5), 0.1).unwrap();
            assert!((packing.total_volume() - 3.0).abs() < 1e-13);
            assert!(packing.points().all(|p| p.cmpgt(DVec3::ZERO).all()));
        }
    }

    #[test]
    fn a_filled_periodic_box_is_the_infinite_lattice() {
        // Whole cells: no stretch, so distances across the sides are those within.
        let lattice = Lattice::HexagonalClosePacked;
        let edges = DVec3::from(lattice.unit_cell().edges) * 3.0;
        let packing = lattice.fill_box::<Dim3>(DVec3::ZERO, edges, 1.0).unwrap();
        let domain = crate::domain::Domain::<Dim3>::new(DVec3::ZERO, edges, [true; 3]);
        let reach = 1.01 * lattice.nearest_distance();
        let size = vec![1.0; packing.len()];
        let pairs = crate::neighbors::brute_force::pairs(&packing.position, &size, &domain, |_, _| reach);
        assert_eq!(pairs.len(), 12 * packing.len());
    }

    #[test]
    fn a_lattice_of_the_wrong_dimension_or_a_box_without_extent_is_refused() {
        let error = Lattice::Cubic.fill_box::<Dim2>(DVec2::ZERO, DVec2::ONE, 0.1).unwrap_err();
        assert_eq!(error.to_string(), "no cubic lattice in 2 dimensions");
        for (upper, size) in [(DVec2::ONE, 0.0), (DVec2::ONE, f64::NAN), (DVec2::new(1.0, -1.0), 0.1)] {
            let error = Lattice::Square.fill_box::<Dim2>(DVec2::ZERO, upper, size).unwrap_err();
            assert!(matches!(error, CoreError::NotPositive { .. }));
        }
    }
}
