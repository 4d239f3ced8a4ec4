//! Checkpoints: the whole state of a run, bit for bit, in a file that notices every damage.
//!
//! A checkpoint holds a header, any structure that serde can write, and named columns of numbers. Each column is
//! shuffled (all first bytes of its numbers, then all second bytes, …, so that alike bytes stand together), compressed
//! with zstd and guarded by a checksum of its own, so that a fault can be named; a checksum over the whole file guards
//! the rest. Everything is little-endian:
//!
//! | bytes | content |
//! |---|---|
//! | 8 | the word `sph-ckpt` |
//! | 4 | [`FORMAT_VERSION`] |
//! | 4 + 4 + n | length and CRC-32 of the header, header (postcard) |
//! | 4 + 4 + n | length and CRC-32 of the directory, directory (postcard): name, kind, number of values, compressed length and CRC-32 (before compression) of each column |
//! | … | the columns' compressed bytes, one behind the other |
//! | 8 + 4 | length of the whole file, CRC-32 of all before this number |
//!
//! No length in a file is believed before it was held against the file's size and [`MAX_COLUMN_BYTES`], and memory is
//! taken only as data arrive: a damaged or hostile file gives an error, not an exhausted machine. NaN payloads and
//! the sign of zero survive.

mod codec;
mod format;
mod store;

pub use store::{CheckpointStore, Loaded};

use crate::{IoError, atomic};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};

/// Version of the layout above. A file of another version is refused.
pub const FORMAT_VERSION: u32 = 1;

/// Largest column that is written or read, before compression: 64 GiB, or eight thousand million numbers.
pub const MAX_COLUMN_BYTES: u64 = 1 << 36;

/// Numbers to be written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ColumnData<'a> {
    /// Real numbers.
    F64(&'a [f64]),
    /// Large whole numbers, such as ids.
    U64(&'a [u64]),
    /// Whole numbers.
    U32(&'a [u32]),
    /// Flags, or bytes of the caller's own making.
    U8(&'a [u8]),
}

/// Numbers that were read.
#[derive(Debug, Clone, PartialEq)]
pub enum Column {
    /// Real numbers.
    F64(Vec<f64>),
    /// Large whole numbers.
    U64(Vec<u64>),
    /// Whole numbers.
    U32(Vec<u32>),
    /// Flags or bytes.
    U8(Vec<u8>),
}

impl Column {
    const fn kind(&self) -> &'static str {
        match self {
            Self::F64(_) => "f64",
            Self::U64(_) => "u64",
            Self::U32(_) => "u32",
            Self::U8(_) => "u8",
        }
    }
}

/// A checkpoint that was read and found whole.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint<H> {
    /// File that it was read from.
    pub path: PathBuf,
    /// The caller's header.
    pub header: H,
    columns: Vec<(String, Column)>,
}

/// Writes a checkpoint, atomically.
///
/// # Errors
/// [`IoError::Invalid`] for a header that postcard cannot write, a column larger than [`MAX_COLUMN_BYTES`] or a name
/// given twice; [`IoError::File`] from the system.
pub fn write<H: Serialize>(
    path: impl AsRef<Path>,
    header: &H,
    columns: &[(&str, ColumnData<'_>)],
) -> Result<(), IoError> {
    let path = path.as_ref();
    let parts = format::encode(header, columns).map_err(|reason| IoError::invalid(path, reason))?;
    atomic::write_atomic_with(path, |file| parts.iter().try_for_each(|part| file.write_all(part)))
}

/// Reads a checkpoint and checks every byte of it.
///
/// # Errors
/// [`IoError::Damaged`] with the damaged part, [`IoError::Version`], [`IoError::Mismatch`] for a whole file whose
/// header is of another kind than `H`, [`IoError::File`] from the system.
pub fn read<H: DeserializeOwned>(path: impl AsRef<Path>) -> Result<Checkpoint<H>, IoError> {
    let path = path.as_ref();
    let bytes = std::fs::read(path).map_err(IoError::file(path, "read"))?;
    read_bytes(&bytes, path)
}

/// As [`read`], of bytes that are in memory; `path` is what errors name.
///
/// # Errors
/// As [`read`].
pub fn read_bytes<H: DeserializeOwned>(bytes: &[u8], path: &Path) -> Result<Checkpoint<H>, IoError> {
    let (header, columns) = format::decode(bytes).map_err(|fault| fault.at(path))?;
    let header = postcard::take_from_bytes(header).ok().filter(|(_, rest)| rest.is_empty());
    let Some((header, _)) = header else {
        return Err(IoError::mismatch(path, "the header is whole, and of another program or version of it"));
    };
    Ok(Checkpoint { path: path.to_path_buf(), header, columns })
}

impl<H> Checkpoint<H> {
    /// Names of the columns that were not yet taken, in the order in which they were written.
    pub fn column_names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|(name, _)| name.as_str())
    }

    /// Takes a column of any kind out.
    ///
    /// # Errors
    /// [`IoError::Mismatch`] if there is none of that name.
    pub fn take(&mut self, name: &str) -> Result<Column, IoError> {
        let found = self.columns.iter().position(|(column, _)| column == name);
        match found {
            Some(idx) => Ok(self.columns.remove(idx).1),
            None => Err(IoError::mismatch(&self.path, format!("there is no column `{name}`"))),
        }
    }

    /// Takes a column of real numbers out.
    ///
    /// # Errors
    /// [`IoError::Mismatch`] if there is none of that name or it is of another kind.
    pub fn take_f64(&mut self, name: &str) -> Result<Vec<f64>, IoError> {
        match self.take(name)? {
            Column::F64(values) => Ok(values),
            other => Err(self.wrong_kind(name, &other, "f64")),
        }
    }

    /// Takes a column of large whole numbers out.
    ///
    /// # Errors
    /// As [`Checkpoint::take_f64`].
    pub fn take_u64(&mut self, name: &str) -> Result<Vec<u64>, IoError> {
        match self.take(name)? {
            Column::U64(values) => Ok(values),
            other => Err(self.wrong_kind(name, &other, "u64")),
        }
    }

    /// Takes a column of whole numbers out.
    ///
    /// # Errors
    /// As [`Checkpoint::take_f64`].
    pub fn take_u32(&mut self, name: &str) -> Result<Vec<u32>, IoError> {
        match self.take(name)? {
            Column::U32(values) => Ok(values),
            other => Err(self.wrong_kind(name, &other, "u32")),
        }
    }

    /// Takes a column of bytes out.
    ///
    /// # Errors
    /// As [`Checkpoint::take_f64`].
    pub fn take_u8(&mut self, name: &str) -> Result<Vec<u8>, IoError> {
        match self.take(name)? {
            Column::U8(values) => Ok(values),
            other => Err(self.wrong_kind(name, &other, "u8")),
        }
    }

    fn wrong_kind(&self, name: &str, column: &Column, wanted: &str) -> IoError {
        let what = format!("column `{name}` holds {}, and {wanted} is wanted", column.kind());
        IoError::mismatch(&self.path, what)
    }
}
