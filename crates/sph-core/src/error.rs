//! What can be wrong with what this crate is given.

use thiserror::Error;

/// What can be wrong with what this crate is given.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CoreError {
    /// A position is infinite or not a number.
    #[error("point {index} has a coordinate that is not finite (axis {axis}: {value} m)")]
    PositionNotFinite {
        /// Index of the point.
        index: usize,
        /// Axis of the coordinate.
        axis: usize,
        /// The coordinate [m].
        value: f64,
    },
    /// A kd-tree could not be built.
    #[error("the kd-tree could not be built: {0}")]
    KdTree(String),
    /// A lattice does not exist in this number of dimensions.
    #[error("no {lattice} lattice in {dimension_count} dimensions")]
    LatticeDimension {
        /// Name of the lattice.
        lattice: &'static str,
        /// Number of space dimensions.
        dimension_count: usize,
    },
    /// A length that must be positive and finite is not.
    #[error("{what} must be positive and finite ({value} m)")]
    NotPositive {
        /// What the length is.
        what: &'static str,
        /// Its value [m].
        value: f64,
    },
}
