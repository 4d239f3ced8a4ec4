//! Any text as a table of measured data: points, or faults with their places.

#![no_main]

use libfuzzer_sys::fuzz_target;
use sph_hugoniot::curve::measured;

fuzz_target!(|text: &str| {
    match measured::parse(text) {
        Ok(points) => assert!(points.len() <= text.lines().count()),
        Err(faults) => assert!(!faults.is_empty(), "refused without a reason"),
    }
});
