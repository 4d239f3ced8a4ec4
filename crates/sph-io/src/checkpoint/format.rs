//! The layout of the file, and the checks on the way back.

use super::codec::{self, Kind};
use super::{Column, ColumnData, FORMAT_VERSION, MAX_COLUMN_BYTES};
use crate::IoError;
use serde::{Deserialize, Serialize};
use std::path::Path;

const MAGIC: &[u8; 8] = b"sph-ckpt";
/// Length of the file and checksum.
const TRAILER: usize = 12;

/// What the directory says of a column.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Entry {
    name: String,
    kind: Kind,
    n_values: u64,
    compressed_length: u64,
    crc: u32,
}

/// A fault found in a file.
pub(super) enum Fault {
    Damaged(String),
    Version(u32),
}

impl Fault {
    pub(super) fn at(self, path: &Path) -> IoError {
        match self {
            Self::Damaged(what) => IoError::damaged(path, what),
            Self::Version(found) => {
                IoError::Version { path: path.to_path_buf(), found, expected: FORMAT_VERSION }
            }
        }
    }
}

fn damaged<T>(what: impl Into<String>) -> Result<T, Fault> {
    Err(Fault::Damaged(what.into()))
}

/// The parts of the file, to be written one behind the other.
pub(super) fn encode<H: Serialize>(
    header: &H,
    columns: &[(&str, ColumnData<'_>)],
) -> Result<Vec<Vec<u8>>, String> {
    let header = postcard::to_stdvec(header).map_err(|e| format!("the header cannot be written: {e}"))?;
    let (entries, packed) = pack(columns)?;
    let directory = postcard::to_stdvec(&entries).map_err(|e| format!("the directory: {e}"))?;
    let mut front = MAGIC.to_vec();
    front.extend(FORMAT_VERSION.to_le_bytes());
    push_block(&mut front, &header)?;
    push_block(&mut front, &directory)?;
    let mut parts = vec![front];
    parts.extend(packed);
    let length = parts.iter().map(Vec::len).sum::<usize>() + TRAILER;
    let mut crc = crc32fast::Hasher::new();
    parts.push((length as u64).to_le_bytes().to_vec());
    parts.iter().for_each(|part| crc.update(part));
    parts.push(crc.finalize().to_le_bytes().to_vec());
    Ok(parts)
}

fn push_block(out: &mut Vec<u8>, block: &[u8]) -> Result<(), String> {
    let length = u32::try_from(block.len()).map_err(|_| "header or directory of more than 4 GiB")?;
    out.extend(length.to_le_bytes());
    out.extend(crc32fast::hash(block).to_le_bytes());
    out.extend(block);
    Ok(())
}

fn pack(columns: &[(&str, ColumnData<'_>)]) -> Result<(Vec<Entry>, Vec<Vec<u8>>), String> {
    let (mut entries, mut packed) = (Vec::<Entry>::new(), Vec::new());
    for (name, data) in columns {
        let shuffled = data.shuffled();
        let kind = Kind::of(data);
        if shuffled.len() as u64 > MAX_COLUMN_BYTES {
            return Err(format!("column `{name}` is larger than {MAX_COLUMN_BYTES} bytes"));
        }
        if entries.iter().any(|entry| entry.name == *name) {
            return Err(format!("two columns are named `{name}`"));
        }
        let compressed = codec::compress(&shuffled)?;
        entries.push(Entry {
            name: (*name).to_owned(),
            kind,
            n_values: shuffled.len() as u64 / kind.width(),
            compressed_length: compressed.len() as u64,
            crc: crc32fast::hash(&shuffled),
        });
        packed.push(compressed);
    }
    Ok((entries, packed))
}

/// The header's bytes, and the columns with their names.
type Content<'a> = (&'a [u8], Vec<(String, Column)>);

/// Header and columns of a file, all checked.
pub(super) fn decode(bytes: &[u8]) -> Result<Content<'_>, Fault> {
    let mut reader = Reader { rest: bytes, size: bytes.len() };
    if reader.take(MAGIC.len(), "the first word")? != MAGIC {
        return damaged("it does not begin as a checkpoint does");
    }
    let version = reader.u32("the version")?;
    if version != FORMAT_VERSION {
        return Err(Fault::Version(version));
    }
    let header = reader.block("the header")?;
    let directory = reader.block("the directory")?;
    let entries: Vec<Entry> = postcard::from_bytes(directory)
        .map_err(|e| Fault::Damaged(format!("the directory cannot be read: {e}")))?;
    let columns = entries.into_iter().map(|entry| reader.column(entry)).collect::<Result<_, _>>()?;
    check_trailer(bytes, reader.rest)?;
    Ok((header, columns))
}

fn check_trailer(bytes: &[u8], rest: &[u8]) -> Result<(), Fault> {
    if rest.len() != TRAILER {
        return damaged(format!("{} bytes follow the last column, and {TRAILER} should", rest.len()));
    }
    let (length, crc) = rest.split_at(8);
    if length != (bytes.len() as u64).to_le_bytes() {
        return damaged("the length noted at its end is not its length");
    }
    if crc != crc32fast::hash(&bytes[..bytes.len() - crc.len()]).to_le_bytes() {
        return damaged("the checksum of the whole file is wrong, though each column's is right");
    }
    Ok(())
}

/// What is still to be read.
struct Reader<'a> {
    rest: &'a [u8],
    size: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, n: usize, what: &str) -> Result<&'a [u8], Fault> {
        match self.rest.split_at_checked(n) {
            Some((taken, rest)) => {
                self.rest = rest;
                Ok(taken)
            }
            None => damaged(format!("it ends after {} bytes, within {what}", self.size)),
        }
    }

    fn u32(&mut self, what: &str) -> Result<u32, Fault> {
        let bytes = self.take(4, what)?;
        Ok(bytes.iter().rev().fold(0, |number, &byte| number << 8 | u32::from(byte)))
    }

    /// A stretch of bytes behind its length and checksum.
    fn block(&mut self, what: &str) -> Result<&'a [u8], Fault> {
        let length = self.u32(what)? as usize;
        let crc = self.u32(what)?;
        let block = self.take(length, what)?;
        if crc32fast::hash(block) == crc {
            Ok(block)
        } else {
            damaged(format!("the checksum of {what} is wrong"))
        }
    }

    fn column(&mut self, entry: Entry) -> Result<(String, Column), Fault> {
        let what = format!("column `{}`", entry.name);
        let length = entry.n_values.checked_mul(entry.kind.width()).filter(|&n| n <= MAX_COLUMN_BYTES);
        let Some(length) = length else {
            return damaged(format!("{what} claims {} values, more than is ever written", entry.n_values));
        };
        let compressed_length = usize::try_from(entry.compressed_length).unwrap_or(usize::MAX);
        let packed = self.take(compressed_length, &what)?;
        let shuffled =
            codec::decompress(packed, length).map_err(|e| Fault::Damaged(format!("{what}: {e}")))?;
        if crc32fast::hash(&shuffled) != entry.crc {
            return damaged(format!("the checksum of {what} is wrong"));
        }
        Ok((entry.name, entry.kind.column(shuffled)))
    }
}
