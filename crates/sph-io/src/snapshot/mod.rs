//! Particles for ParaView: one `.vtp` file a moment and a `.pvd` file that strings them into a series.
//!
//! The format is VTK's XML poly data (VTK file formats, Kitware): a piece with one vertex cell a particle, its time
//! as the field `TimeValue`, arrays appended as raw little-endian bytes in blocks compressed with zlib. Vectors have
//! three components in two dimensions too, and symmetric tensors six with names (XX YY ZZ XY YZ XZ), as ParaView
//! wants them for glyphs, magnitudes and tensor filters.

mod series;
mod vtp;

pub use series::SnapshotSeries;

use crate::{IoError, atomic};
use std::path::Path;

/// How many bytes a real number takes in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// Four: seven digits, enough to look at.
    #[default]
    Single,
    /// Eight: every bit, to compute with.
    Double,
}

/// The values of one array, one a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ArrayData<'a> {
    /// A number.
    Scalar(&'a [f64]),
    /// Components x, y, z.
    Vector(&'a [[f64; 3]]),
    /// Components xx, yy, zz, xy, yz, xz.
    SymmetricTensor(&'a [[f64; 6]]),
    /// A whole number, such as an id or a flag.
    Integer(&'a [i64]),
}

impl ArrayData<'_> {
    /// Number of particles.
    #[must_use]
    pub const fn len(&self) -> usize {
        match self {
            Self::Scalar(values) => values.len(),
            Self::Vector(values) => values.len(),
            Self::SymmetricTensor(values) => values.len(),
            Self::Integer(values) => values.len(),
        }
    }

    /// Whether there is no particle.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Particles at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot<'a> {
    /// Time `[s]`, or in whatever unit the series counts.
    pub time: f64,
    /// Places; z is 0 in two dimensions.
    pub points: &'a [[f64; 3]],
    /// Names (with units, if wanted) and values.
    pub arrays: Vec<(String, ArrayData<'a>)>,
    /// Bytes a real number; the time has eight always.
    pub precision: Precision,
}

impl<'a> Snapshot<'a> {
    /// Particles without properties, to be written in single precision.
    #[must_use]
    pub const fn new(time: f64, points: &'a [[f64; 3]]) -> Self {
        Self { time, points, arrays: Vec::new(), precision: Precision::Single }
    }

    /// The snapshot with one more array.
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, data: ArrayData<'a>) -> Self {
        self.arrays.push((name.into(), data));
        self
    }

    /// The snapshot with one more scalar.
    #[must_use]
    pub fn with_scalar(self, name: impl Into<String>, values: &'a [f64]) -> Self {
        self.with(name, ArrayData::Scalar(values))
    }

    /// The snapshot with one more vector.
    #[must_use]
    pub fn with_vector(self, name: impl Into<String>, values: &'a [[f64; 3]]) -> Self {
        self.with(name, ArrayData::Vector(values))
    }

    /// The snapshot with one more symmetric tensor (xx, yy, zz, xy, yz, xz).
    #[must_use]
    pub fn with_symmetric_tensor(self, name: impl Into<String>, values: &'a [[f64; 6]]) -> Self {
        self.with(name, ArrayData::SymmetricTensor(values))
    }

    /// The snapshot with one more array of whole numbers.
    #[must_use]
    pub fn with_integer(self, name: impl Into<String>, values: &'a [i64]) -> Self {
        self.with(name, ArrayData::Integer(values))
    }

    /// The snapshot in another precision.
    #[must_use]
    pub fn with_precision(self, precision: Precision) -> Self {
        Self { precision, ..self }
    }

    /// Writes the snapshot as `.vtp`, atomically.
    ///
    /// # Errors
    /// [`IoError::Invalid`] for an array of another length than the points or a name given twice,
    /// [`IoError::File`] from the system.
    pub fn write_vtp(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        let path = path.as_ref();
        self.check().map_err(|reason| IoError::invalid(path, reason))?;
        atomic::write_atomic_with(path, |file| vtp::write(self, file))
    }

    fn check(&self) -> Result<(), String> {
        let n = self.points.len();
        for (k, (name, data)) in self.arrays.iter().enumerate() {
            if data.len() != n {
                return Err(format!("array `{name}` has {} values for {n} particles", data.len()));
            }
            if self.arrays[..k].iter().any(|(earlier, _)| earlier == name) {
                return Err(format!("two arrays are named `{name}`"));
            }
        }
        Ok(())
    }
}
