//! Results of an earlier run in the folder: gone on with, replaced, or left alone.

use std::path::Path;

use anyhow::{Context, Result};
use serde_json::Value;
use sph_io::atomic;

use crate::config::Case;
use crate::report::machine;
use crate::run::Earlier;

/// Version of what a run keeps in its folder: `case.json`, and the headers of states and outcomes.
///
/// Whoever changes what these hold (`PointOutcome`, `PointProgress`, `WindowState`, `Case`) raises it: a run then refuses to
/// go on with a folder of another version, in place of reading one thing as another.
pub const FOLDER_FORMAT: u64 = 4;

/// The resolved case as a folder keeps it, with the version of its form and of the program.
///
/// # Errors
/// If the case cannot be written as JSON.
pub fn case_json(case: &Case) -> Result<String> {
    let mut value = serde_json::to_value(case)?;
    value["format"] = FOLDER_FORMAT.into();
    value["program"] = machine::VERSION.into();
    Ok(serde_json::to_string_pretty(&value)?)
}

/// What stands against going on with a folder of another version.
fn other_version(folder: &Path, before: &Value) -> Option<String> {
    let format = before["format"].as_u64();
    if format == Some(FOLDER_FORMAT) {
        return None;
    }
    let of = format.map_or("no format that is named".to_owned(), |n| format!("format {n}"));
    let program = before["program"].as_str().unwrap_or("an earlier program");
    Some(format!(
        "{}: the folder is of {of}, written by {program}; {} goes on with format {FOLDER_FORMAT} only; hint: finish it with \
         the program that began it, or --out names another folder, or --replace throws the earlier results away",
        folder.display(),
        machine::VERSION
    ))
}

/// What a run leaves in its folder besides what the next one writes anew before its first step.
const FOLDERS: [&str; 3] = ["points", "curve", "plots"];
const FILES: [&str; 3] = ["hugoniot.csv", "hugoniot.json", "report.html"];

/// Parts of a case that may differ when a run goes on: which points, and what is drawn of them. But for the
/// [grids](same_grids) that kept sums stand on.
const FREE: [&str; 7] = ["points", "refinement", "data", "output", "name", "format", "program"];

/// Makes the folder ready; the reason if the run must not start.
///
/// # Errors
/// If the folder cannot be read or cleared.
pub fn settle(folder: &Path, case: &Case, earlier: Earlier) -> Result<Option<String>> {
    let path = folder.join("case.json");
    if !path.exists() {
        return Ok(None);
    }
    match earlier {
        Earlier::Refuse => Ok(Some(format!(
            "{}: there are results of an earlier run; hint: --resume goes on with it, --replace throws it away, --out \
             names another folder",
            folder.display()
        ))),
        Earlier::Replace => {
            clear(folder)?;
            Ok(None)
        }
        Earlier::Resume => {
            let text = std::fs::read_to_string(&path)?;
            let before: Value = serde_json::from_str(&text)
                .with_context(|| format!("{}: is not what a run writes", path.display()))?;
            if let Some(refusal) = other_version(folder, &before) {
                return Ok(Some(refusal));
            }
            let changes = changes(&before, &serde_json::to_value(case)?);
            Ok((!changes.is_empty()).then(|| {
                format!(
                    "{}: the case has changed since, and a run goes on only with the same:\n{}\nhint: --out names another \
                     folder, --replace throws the earlier results away",
                    folder.display(),
                    changes.join("\n")
                )
            }))
        }
    }
}

/// Removes the results of an earlier run, and nothing else.
fn clear(folder: &Path) -> Result<()> {
    let folders = FOLDERS.map(|name| folder.join(name)).into_iter().filter(|path| path.exists());
    let files = FILES.map(|name| folder.join(name)).into_iter().filter(|path| path.exists());
    let cannot = |path: &Path| format!("{}: cannot be removed", path.display());
    for path in folders {
        std::fs::remove_dir_all(&path).with_context(|| cannot(&path))?;
    }
    for path in files {
        std::fs::remove_file(&path).with_context(|| cannot(&path))?;
    }
    Ok(())
}

/// Removes what a killed process was just writing into the folder, or into any folder below; other files of the user's stay.
/// The folder must be held.
///
/// # Errors
/// If a folder cannot be listed, or a file not be removed.
pub fn clear_leftovers(folder: &Path) -> Result<()> {
    for path in atomic::remove_leftovers(folder)? {
        tracing::debug!("{}: left unfinished by a process that was killed; removed", path.display());
    }
    Ok(())
}

/// What differs, one line each: `field: before -> now`.
fn changes(before: &Value, now: &Value) -> Vec<String> {
    let mut lines = Vec::new();
    compare("", before, now, &mut lines);
    same_grids(before, now, &mut lines);
    lines
}

/// What a point keeps is summed in bins of the profile, and numbered by the moments of a series: these grids stay.
fn same_grids(before: &Value, now: &Value, lines: &mut Vec<String>) {
    for place in ["/output/bins_per_cell", "/output/snapshots/every_cells"] {
        // A series may begin or end when a run goes on.
        if let (Some(a), Some(b)) = (before.pointer(place), now.pointer(place)) {
            compare(&place[1..].replace('/', "."), a, b, lines);
        }
    }
}

fn compare(place: &str, before: &Value, now: &Value, lines: &mut Vec<String>) {
    let below = |key: &str| if place.is_empty() { key.to_string() } else { format!("{place}.{key}") };
    match (before, now) {
        (Value::Object(a), Value::Object(b)) => {
            let keys: std::collections::BTreeSet<&String> = a.keys().chain(b.keys()).collect();
            for key in keys {
                if !(place.is_empty() && FREE.contains(&key.as_str())) {
                    let of =
                        |map: &serde_json::Map<String, Value>| map.get(key).cloned().unwrap_or(Value::Null);
                    compare(&below(key), &of(a), &of(b), lines);
                }
            }
        }
        _ if before == now => {}
        _ => lines.push(format!("  {place}: {before} -> {now}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_change_is_told_with_its_place_and_points_may_differ() {
        let before = json!({"points": [50.0], "medium": {"porosity": 1.35, "cell": 2e-5}});
        let now = json!({"points": [50.0, 75.0], "medium": {"porosity": 1.4, "cell": 2e-5}});
        assert_eq!(changes(&before, &now), ["  medium.porosity: 1.35 -> 1.4"]);
        assert!(changes(&before, &before).is_empty());
    }

    #[test]
    fn grids_that_kept_sums_stand_on_may_not_differ() {
        let output = |bins: u64, snapshots: Value| json!({"output": {"bins_per_cell": bins, "images": bins == 10, "snapshots": snapshots}});
        let (none, tenth) = (Value::Null, json!({"every_cells": 0.1}));
        let change = |before: &Value, now: &Value| changes(before, now);
        assert!(change(&output(10, none.clone()), &output(10, tenth.clone())).is_empty());
        let found = change(&output(10, none.clone()), &output(20, none));
        assert_eq!(found, ["  output.bins_per_cell: 10 -> 20"]);
        let found = change(&output(10, tenth), &output(10, json!({"every_cells": 0.5})));
        assert_eq!(found, ["  output.snapshots.every_cells: 0.1 -> 0.5"]);
    }

    #[test]
    fn replacing_clears_all_results_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        for name in FOLDERS {
            std::fs::create_dir(folder.path().join(name)).unwrap();
            std::fs::write(folder.path().join(name).join("old.csv"), b"x").unwrap();
        }
        for name in FILES.into_iter().chain(["case.json", "notes.txt"]) {
            std::fs::write(folder.path().join(name), b"x").unwrap();
        }
        clear(folder.path()).unwrap();
        let left =
            |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name().into_string().unwrap();
        let mut left: Vec<String> = std::fs::read_dir(folder.path()).unwrap().map(left).collect();
        left.sort();
        assert_eq!(left, ["case.json", "notes.txt"]);
    }

    #[test]
    fn a_folder_of_another_version_is_refused_with_a_word() {
        let said = |value: Value| other_version(Path::new("results/a"), &value);
        assert_eq!(said(json!({"format": FOLDER_FORMAT})), None);
        let newer = said(json!({"format": 99, "program": "hugoniot 9.9.9"})).unwrap();
        assert!(
            newer.contains("results/a: the folder is of format 99, written by hugoniot 9.9.9; "),
            "{newer}"
        );
        assert!(said(json!({"name": "x"})).unwrap().contains("no format that is named"));
    }
}
