//! The shapes of what a folder keeps stand in `tests/format/stored-types.txt`, for the number [`FOLDER_FORMAT`]: a change
//! of one without the other is found here.
//!
//! After a change on purpose: raise `FOLDER_FORMAT` in `report/earlier.rs`, then
//! `RENEW_FORMAT=1 cargo test -p sph-hugoniot format`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde_reflection::{Samples, Tracer, TracerConfig};

use super::SavedSnapshot;
use crate::outcome::PointOutcome;
use crate::point::PointProgress;
use crate::report::earlier::FOLDER_FORMAT;
use crate::settle;
use sph_window::WindowState;
use sph_window::search::bisection;

fn golden() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/format/stored-types.txt")
}

/// Enums among the stored types: a trace sees one variant of each at a time, and of one within a list the first only;
/// those are traced by themselves too.
const ENUMS: [&str; 5] = ["Decision", "Phase", "Result", "Stage", "Status"];

/// Every container below a type, with the names, order and kinds of its fields and variants.
fn shape<T: DeserializeOwned>() -> String {
    let (mut tracer, samples) = (Tracer::new(TracerConfig::default()), Samples::new());
    let top = loop {
        let (top, _) = tracer.trace_type_once::<T>(&samples).expect("a type that can be traced");
        let more = ENUMS.iter().filter(|name| tracer.check_incomplete_enum(name).is_some()).count();
        if more == 0 {
            break top;
        }
    };
    let registry = tracer.registry().expect("ENUMS names every enum");
    let mut text = format!("== {top:?}\n");
    for (name, container) in registry {
        writeln!(text, "{name}: {container:?}").expect("text");
    }
    text
}

fn shapes() -> String {
    let types = [
        shape::<WindowState>(),
        shape::<PointProgress>(),
        shape::<PointOutcome>(),
        shape::<SavedSnapshot>(),
        shape::<bisection::Decision>(),
        shape::<bisection::Stage>(),
        shape::<settle::Decision>(),
    ];
    format!("FOLDER_FORMAT = {FOLDER_FORMAT}\n{}", types.concat())
}

#[test]
fn the_stored_types_are_those_of_the_folder_format() {
    let now = shapes();
    if std::env::var_os("RENEW_FORMAT").is_some() {
        std::fs::create_dir_all(golden().parent().expect("a folder")).expect("a folder");
        std::fs::write(golden(), &now).expect("the file");
    }
    let before = std::fs::read_to_string(golden()).expect("the shapes of the present format");
    let changed: Vec<&str> = now.lines().filter(|line| !before.lines().any(|old| old == *line)).collect();
    assert!(
        now == before,
        "what a folder keeps has changed its shape: raise FOLDER_FORMAT in report/earlier.rs, then RENEW_FORMAT=1 cargo test \
         -p sph-hugoniot format\n{}",
        changed.join("\n")
    );
}
