//! Any bytes as a checkpoint: whole, or damaged with a word; memory stays within what the file's length allows.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use sph_io::checkpoint;

fuzz_target!(|bytes: &[u8]| {
    let _ = checkpoint::read_bytes::<(u64, f64, String)>(bytes, Path::new("fuzzed.ckpt"));
});
