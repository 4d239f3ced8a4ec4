//! The bytes of a `.vtp` file: a head in XML that says where each array begins in the blob that follows it.
//!
//! An array in the blob is a header of little-endian u64, `n_blocks, block_size, size of the last block if it is
//! partial else 0, compressed size of each block`, and then the compressed blocks. All blocks but the last have
//! `block_size` bytes before compression.

use super::{ArrayData, Precision, Snapshot};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::{self, Write};

/// Bytes of a block before compression.
const BLOCK_SIZE: usize = 1 << 18;
/// zlib's level: beyond 4 the files hardly shrink and the time doubles.
const LEVEL: u32 = 4;
/// The order of components that VTK knows for symmetric tensors.
const TENSOR_COMPONENTS: [&str; 6] = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"];

/// The blob, and the head's lines that point into it.
#[derive(Default)]
struct Blob {
    bytes: Vec<u8>,
}

pub(super) fn write(snapshot: &Snapshot<'_>, out: &mut dyn Write) -> io::Result<()> {
    let n = snapshot.points.len();
    let mut blob = Blob::default();
    let points = blob.real_array("Points", 3, "", snapshot.points.as_flattened(), snapshot.precision)?;
    let mut arrays = String::new();
    for (name, data) in &snapshot.arrays {
        arrays += &blob.array(name, *data, snapshot.precision)?;
    }
    let connectivity = blob.integer_array("connectivity", 0..n as i64)?;
    let offsets = blob.integer_array("offsets", 1..n as i64 + 1)?;
    write!(
        out,
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
         compressor=\"vtkZLibDataCompressor\">\n\
         <PolyData>\n\
         <FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">\
         {time:e}</DataArray>\n</FieldData>\n\
         <Piece NumberOfPoints=\"{n}\" NumberOfVerts=\"{n}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
         NumberOfPolys=\"0\">\n\
         <PointData>\n{arrays}</PointData>\n<Points>\n{points}</Points>\n\
         <Verts>\n{connectivity}{offsets}</Verts>\n\
         </Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_",
        time = snapshot.time,
    )?;
    out.write_all(&blob.bytes)?;
    out.write_all(b"\n</AppendedData>\n</VTKFile>\n")
}

impl Blob {
    /// Appends an array and returns its line for the head.
    fn array(&mut self, name: &str, data: ArrayData<'_>, precision: Precision) -> io::Result<String> {
        match data {
            ArrayData::Scalar(values) => self.real_array(name, 1, "", values, precision),
            ArrayData::Vector(values) => self.real_array(name, 3, "", values.as_flattened(), precision),
            ArrayData::SymmetricTensor(values) => {
                let names = TENSOR_COMPONENTS.iter().enumerate();
                let names: String = names.map(|(k, name)| format!(" ComponentName{k}=\"{name}\"")).collect();
                self.real_array(name, 6, &names, values.as_flattened(), precision)
            }
            ArrayData::Integer(values) => self.integer_array(name, values.iter().copied()),
        }
    }

    fn real_array(
        &mut self,
        name: &str,
        n_components: usize,
        attributes: &str,
        values: &[f64],
        precision: Precision,
    ) -> io::Result<String> {
        let (kind, bytes) = match precision {
            Precision::Double => ("Float64", bytes_of(values.iter().map(|value| value.to_le_bytes()))),
            Precision::Single => {
                ("Float32", bytes_of(values.iter().map(|&value| (value as f32).to_le_bytes())))
            }
        };
        self.append(&bytes, &format!("{kind}\" Name=\"{}", escaped(name)), n_components, attributes)
    }

    fn integer_array(&mut self, name: &str, values: impl Iterator<Item = i64>) -> io::Result<String> {
        let bytes = bytes_of(values.map(i64::to_le_bytes));
        self.append(&bytes, &format!("Int64\" Name=\"{}", escaped(name)), 1, "")
    }

    fn append(
        &mut self,
        bytes: &[u8],
        type_and_name: &str,
        n_components: usize,
        attributes: &str,
    ) -> io::Result<String> {
        let offset = self.bytes.len();
        let blocks = bytes.chunks(BLOCK_SIZE).map(compressed).collect::<io::Result<Vec<_>>>()?;
        let header = [blocks.len(), BLOCK_SIZE, bytes.len() % BLOCK_SIZE];
        for number in header.into_iter().chain(blocks.iter().map(Vec::len)) {
            self.bytes.extend((number as u64).to_le_bytes());
        }
        blocks.iter().for_each(|block| self.bytes.extend(block));
        Ok(format!(
            "<DataArray type=\"{type_and_name}\" NumberOfComponents=\"{n_components}\"{attributes} \
             format=\"appended\" offset=\"{offset}\"/>\n"
        ))
    }
}

fn bytes_of<const N: usize>(values: impl Iterator<Item = [u8; N]>) -> Vec<u8> {
    values.flatten().collect()
}

fn compressed(block: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(LEVEL));
    encoder.write_all(block)?;
    encoder.finish()
}

/// A name as an XML attribute.
pub(super) fn escaped(name: &str) -> String {
    let mut out = String::with_capacity(name.len());
    for character in name.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            _ if character.is_control() => out.push(' '),
            _ => out.push(character),
        }
    }
    out
}
