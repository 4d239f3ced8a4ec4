//! Any text as a case file: an answer, never a panic; a refusal has a reason, and its places lie inside the text.

#![no_main]

use libfuzzer_sys::fuzz_target;
use sph_hugoniot::config;

fuzz_target!(|text: &str| {
    if let Err(error) = config::parse(text, "case.ron") {
        assert!(!error.faults.is_empty(), "refused without a reason");
        assert!(error.faults.iter().all(|fault| fault.span.start <= text.len() + 1));
        assert!(error.render(false).contains("error"));
    }
});
