//! One column: numbers to compressed bytes and back.

use super::{Column, ColumnData};
use bytemuck::Pod;
use std::io::Read;

#[cfg(target_endian = "big")]
compile_error!(
    "checkpoints are little-endian; on this machine the bytes of each number must be turned first"
);

/// zstd's level: its default; shuffled floating-point columns gain little from more.
const LEVEL: i32 = 3;
/// Memory taken before the first byte was unpacked; more is taken as data arrive.
const FIRST_ALLOCATION: usize = 1 << 20;

impl ColumnData<'_> {
    /// The numbers' bytes, shuffled.
    pub(super) fn shuffled(&self) -> Vec<u8> {
        match self {
            Self::F64(values) => shuffle(bytemuck::cast_slice(values), 8),
            Self::U64(values) => shuffle(bytemuck::cast_slice(values), 8),
            Self::U32(values) => shuffle(bytemuck::cast_slice(values), 4),
            Self::U8(values) => values.to_vec(),
        }
    }
}

pub(super) fn compress(bytes: &[u8]) -> Result<Vec<u8>, String> {
    zstd::encode_all(bytes, LEVEL).map_err(|e| format!("zstd: {e}"))
}

/// Unpacks exactly `length` bytes; takes no more memory than about twice what comes out, however large `length` is.
pub(super) fn decompress(bytes: &[u8], length: u64) -> Result<Vec<u8>, String> {
    let decoder = zstd::Decoder::with_buffer(bytes).map_err(|e| format!("zstd: {e}"))?;
    let first = usize::try_from(length).map_err(|e| e.to_string())?.min(FIRST_ALLOCATION);
    let mut out = Vec::with_capacity(first);
    decoder.take(length.saturating_add(1)).read_to_end(&mut out).map_err(|e| format!("zstd: {e}"))?;
    if out.len() as u64 == length {
        Ok(out)
    } else {
        Err(format!("unpacks to {} bytes, not {length}", out.len()))
    }
}

/// The first byte of each number, then the second of each, and so on.
fn shuffle(bytes: &[u8], width: usize) -> Vec<u8> {
    let n = bytes.len() / width;
    let mut out = vec![0; bytes.len()];
    for (k, plane) in out.chunks_exact_mut(n.max(1)).enumerate() {
        for (idx, byte) in plane.iter_mut().enumerate() {
            *byte = bytes[idx * width + k];
        }
    }
    out
}

/// The numbers from shuffled bytes, whose count is a multiple of the numbers' width.
fn unshuffle<T: Pod>(bytes: &[u8]) -> Vec<T> {
    let width = size_of::<T>();
    let n = bytes.len() / width;
    let mut values = vec![T::zeroed(); n];
    let out: &mut [u8] = bytemuck::cast_slice_mut(&mut values);
    for (k, plane) in bytes.chunks_exact(n.max(1)).enumerate() {
        for (idx, &byte) in plane.iter().enumerate() {
            out[idx * width + k] = byte;
        }
    }
    values
}

/// The kinds of columns, as written in the directory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(super) enum Kind {
    F64,
    U64,
    U32,
    U8,
}

impl Kind {
    pub(super) const fn of(data: &ColumnData<'_>) -> Self {
        match data {
            ColumnData::F64(_) => Self::F64,
            ColumnData::U64(_) => Self::U64,
            ColumnData::U32(_) => Self::U32,
            ColumnData::U8(_) => Self::U8,
        }
    }

    /// Bytes of one number.
    pub(super) const fn width(self) -> u64 {
        match self {
            Self::F64 | Self::U64 => 8,
            Self::U32 => 4,
            Self::U8 => 1,
        }
    }

    pub(super) fn column(self, shuffled: Vec<u8>) -> Column {
        match self {
            Self::F64 => Column::F64(unshuffle(&shuffled)),
            Self::U64 => Column::U64(unshuffle(&shuffled)),
            Self::U32 => Column::U32(unshuffle(&shuffled)),
            Self::U8 => Column::U8(shuffled),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shuffling_puts_like_bytes_together() {
        let values = [0x0403_0201_u32, 0x1413_1211];
        let shuffled = ColumnData::U32(&values).shuffled();
        assert_eq!(shuffled, [0x01, 0x11, 0x02, 0x12, 0x03, 0x13, 0x04, 0x14]);
        assert_eq!(unshuffle::<u32>(&shuffled), values);
        assert!(unshuffle::<f64>(&[]).is_empty());
    }

    #[test]
    fn unpacking_stops_at_the_length_that_was_told() {
        let packed = compress(&vec![0; 1 << 24]).unwrap();
        assert!(packed.len() < 10_000);
        assert!(decompress(&packed, 100).unwrap_err().contains("101 bytes, not 100"));
        assert!(decompress(&packed, u64::from(u32::MAX)).unwrap_err().contains("16777216 bytes"));
        assert_eq!(decompress(&packed, 1 << 24).unwrap().len(), 1 << 24);
    }
}
