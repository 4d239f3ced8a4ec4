//! Any bytes as a checkpoint: whole, or damaged with a word; memory stays within what the file's length allows.
//!
//! The bytes are read twice: as they are, and with the checksums of header and directory made right, so that what stands
//! behind them is reached.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use sph_hugoniot::outcome::PointOutcome;
use sph_io::checkpoint;

/// The word at the beginning, and the version.
const HEAD: usize = 12;

/// Makes the checksum of the block at a place right; where the next block begins.
fn mend(bytes: &mut [u8], at: usize) -> Option<usize> {
    let length = u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize;
    let end = (at + 8).checked_add(length)?;
    let crc = crc32fast::hash(bytes.get(at + 8..end)?);
    bytes[at + 4..at + 8].copy_from_slice(&crc.to_le_bytes());
    Some(end)
}

fn read(bytes: &[u8]) {
    let path = Path::new("fuzzed.ckpt");
    let _ = checkpoint::read_bytes::<PointOutcome>(bytes, path);
    if let Ok(mut found) = checkpoint::read_bytes::<(u64, f64, String)>(bytes, path) {
        let names: Vec<String> = found.column_names().map(str::to_owned).collect();
        names.iter().for_each(|name| assert!(found.take(name).is_ok()));
    }
}

fuzz_target!(|bytes: &[u8]| {
    read(bytes);
    let mut mended = bytes.to_vec();
    if mend(&mut mended, HEAD).and_then(|next| mend(&mut mended, next)).is_some() {
        read(&mended);
    }
});
