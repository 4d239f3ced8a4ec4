//! Measured points of a Hugoniot from a CSV file.
//!
//! ```text
//! # Boade 1970, pressed copper powder          comments begin with #
//! u_p [m/s], u_s [km/s], u_s_error [m/s], source
//! 120, 0.52, 10, shot 3
//! 250, 0.95, , shot 7                           an empty cell: no error known
//! ```
//!
//! | column | what it is | unit |
//! |---|---|---|
//! | `u_p`, `u_s` | particle and shock velocity; required | of velocity, required |
//! | `u_p_error`, `u_s_error` | their standard errors | of velocity |
//! | `u_ahead` | particle velocity behind an elastic precursor: it is subtracted from both, as the window counts from there | of velocity |
//! | `source` | where a point is from | none |
//!
//! Columns may stand in any order; others are refused, so that a misspelt one is not lost. Units stand in brackets in
//! the header. All faults of a file are told at once, each with line and column.

use std::io::Read;
use std::path::Path;

use crate::config::fault::name_hint;
use crate::config::units::Velocity;

/// Largest file that is read [bytes].
const MAX_FILE: u64 = 1 << 20;
/// Most faults of a file that are told.
const MAX_FAULTS: usize = 20;
/// Names of the columns; the last one is text.
const COLUMNS: [&str; 6] = ["u_p", "u_s", "u_p_error", "u_s_error", "u_ahead", "source"];

/// A measured point, relative to the matter ahead of the wave.
#[derive(Clone, Debug, PartialEq)]
pub struct DataPoint {
    /// u_p [m/s].
    pub particle_velocity: f64,
    /// u_s [m/s].
    pub shock_velocity: f64,
    /// Standard error of u_p [m/s]; zero if unknown.
    pub particle_velocity_error: f64,
    /// Standard error of u_s [m/s]; zero if unknown.
    pub shock_velocity_error: f64,
    /// Where it is from; empty if not told.
    pub source: String,
}

/// Measured points of one file.
#[derive(Clone, Debug, PartialEq)]
pub struct DataSet {
    /// Words for the legend.
    pub name: String,
    /// The points, in the order of the file.
    pub points: Vec<DataPoint>,
}

/// One thing that is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{line}:{column}: {message}")]
pub struct DataFault {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is wrong, with a hint.
    pub message: String,
}

/// A file that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum DataError {
    /// The system does not give it.
    #[error("{path}: the measured data cannot be read: {reason}")]
    Unreadable {
        /// The file.
        path: String,
        /// What the system says.
        reason: String,
    },
    /// What is in it is not what is wanted.
    #[error("{}", faults.iter().map(|f| format!("{path}:{f}")).collect::<Vec<_>>().join("\n"))]
    Faults {
        /// The file.
        path: String,
        /// What is wrong, in the order of the text.
        faults: Vec<DataFault>,
    },
}

/// Reads a file; `name` for the legend, else the common source of its points or the file's name.
///
/// # Errors
/// A file that cannot be read, or what is wrong with it.
pub fn load(path: &Path, name: Option<&str>) -> Result<DataSet, DataError> {
    let shown = path.display().to_string();
    let unreadable = |reason: String| DataError::Unreadable { path: shown.clone(), reason };
    let mut bytes = Vec::new();
    // Not by the length that the system tells: a device or a pipe has none.
    let read = std::fs::File::open(path).and_then(|file| file.take(MAX_FILE + 1).read_to_end(&mut bytes));
    read.map_err(|e| unreadable(e.to_string()))?;
    if bytes.len() as u64 > MAX_FILE {
        return Err(unreadable(format!(
            "it has more than {MAX_FILE} bytes, which are the most that are read"
        )));
    }
    let text = String::from_utf8(bytes).map_err(|e| unreadable(format!("it is not UTF-8 text: {e}")))?;
    let points = parse(&text).map_err(|faults| DataError::Faults { path: shown.clone(), faults })?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let first = points.first().map(|p| p.source.clone()).filter(|s| !s.is_empty());
    let common = first.filter(|s| points.iter().all(|p| p.source == *s));
    Ok(DataSet { name: name.map(str::to_string).or(common).unwrap_or(stem), points })
}

/// Reads the points of a text.
///
/// # Errors
/// All that is wrong, in the order of the text; twenty faults at most.
pub fn parse(text: &str) -> Result<Vec<DataPoint>, Vec<DataFault>> {
    let mut faults = Vec::new();
    let mut lines = text.lines().enumerate().map(|(k, line)| (k + 1, line.trim_start_matches('\u{feff}')));
    let mut rows =
        lines.by_ref().filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'));
    let Some((line, header)) = rows.next() else {
        let message = "there is no header; hint: u_p [m/s], u_s [m/s], u_s_error [m/s], source".to_string();
        return Err(vec![DataFault { line: 1, column: 1, message }]);
    };
    if header.contains(';') && !header.contains(',') {
        let column = header.chars().position(|c| c == ';').map_or(1, |k| k + 1);
        let message =
            "there is one column only; hint: cells are separated by commas, not by semicolons".to_string();
        return Err(vec![DataFault { line, column, message }]);
    }
    let columns = header_columns(line, header, &mut faults);
    let mut points = Vec::new();
    for (line, row) in rows {
        if faults.len() >= MAX_FAULTS {
            break;
        }
        points.extend(point(line, row, &columns, &mut faults));
    }
    if points.is_empty() && faults.is_empty() {
        let message = "there are no points below the header".to_string();
        faults.push(DataFault { line, column: 1, message });
    }
    if faults.is_empty() { Ok(points) } else { Err(faults) }
}

/// A column of the file: which of [`COLUMNS`] it is, and the size of its unit [m/s].
type Kind = Option<(usize, f64)>;

fn header_columns(line: usize, header: &str, faults: &mut Vec<DataFault>) -> Vec<Kind> {
    let mut seen = [false; COLUMNS.len()];
    let mut kinds = Vec::new();
    for (column, cell) in cells(header) {
        let kind = match column_kind(&cell) {
            Ok((which, _)) if seen[which] => Err(format!("`{}` stands in the header twice", COLUMNS[which])),
            other => other,
        };
        match kind {
            Ok((which, size)) => {
                seen[which] = true;
                kinds.push(Some((which, size)));
            }
            Err(message) => {
                kinds.push(None);
                faults.push(DataFault { line, column, message });
            }
        }
    }
    for (which, name) in COLUMNS.iter().enumerate().take(2) {
        if !seen[which] && faults.is_empty() {
            let message = format!("the column `{name}` is missing; hint: `{name} [m/s]` in the header");
            faults.push(DataFault { line, column: 1, message });
        }
    }
    kinds
}

/// Reads `u_s [km/s]`.
fn column_kind(cell: &str) -> Result<(usize, f64), String> {
    let (name, unit) = match cell.split_once('[') {
        Some((name, rest)) => match rest.split_once(']') {
            Some((unit, after)) if after.trim().is_empty() => (name.trim(), Some(unit.trim())),
            _ => return Err(format!("the unit of `{}` has no closing bracket", name.trim())),
        },
        None => (cell.trim(), None),
    };
    let Some(which) = COLUMNS.iter().position(|c| *c == name) else {
        return Err(format!("there is no column `{name}`; hint: {}", name_hint(name, &COLUMNS)));
    };
    match (which + 1 == COLUMNS.len(), unit) {
        (true, None) => Ok((which, 1.0)),
        (true, Some(_)) => Err(format!("`{name}` is text and has no unit")),
        (false, None) => Err(format!("`{name}` has no unit; hint: `{name} [m/s]`")),
        (false, Some(unit)) => Ok((which, Velocity::parse(&format!("1 {unit}"))?.si)),
    }
}

fn point(line: usize, row: &str, columns: &[Kind], faults: &mut Vec<DataFault>) -> Option<DataPoint> {
    let cells = cells(row);
    if cells.len() != columns.len() {
        let (n, expected) = (cells.len(), columns.len());
        let column = cells.get(expected).map_or(row.chars().count() + 1, |c| c.0);
        let message = format!("the line has {n} cells, the header {expected}");
        faults.push(DataFault { line, column, message });
        return None;
    }
    let before = faults.len();
    // Values of a column whose unit is not known say nothing against each other.
    let is_whole = [0, 1].iter().all(|which| columns.iter().flatten().any(|(known, _)| known == which));
    let mut values = [0.0; COLUMNS.len()];
    let mut source = String::new();
    for ((column, cell), kind) in cells.iter().zip(columns) {
        let Some((which, size)) = *kind else { continue };
        if which + 1 == COLUMNS.len() {
            source = cell.trim().to_string();
            continue;
        }
        match value(which, cell.trim(), size) {
            Ok(value) => values[which] = value,
            Err(message) => faults.push(DataFault { line, column: *column, message }),
        }
    }
    let [u_p, u_s, u_p_error, u_s_error, ahead, _] = values;
    if is_whole && faults.len() == before && u_s <= u_p {
        let message = format!("u_s = {u_s} m/s does not exceed u_p = {u_p} m/s: no wave compresses so far");
        faults.push(DataFault { line, column: 1, message });
    }
    if is_whole && faults.len() == before && u_p <= ahead {
        let message = format!("u_p = {u_p} m/s does not exceed u_ahead = {ahead} m/s");
        faults.push(DataFault { line, column: 1, message });
    }
    (is_whole && faults.len() == before).then_some(DataPoint {
        particle_velocity: u_p - ahead,
        shock_velocity: u_s - ahead,
        particle_velocity_error: u_p_error,
        shock_velocity_error: u_s_error,
        source,
    })
}

/// A velocity in m/s; empty cells are zero where the column may be left out.
fn value(which: usize, cell: &str, size: f64) -> Result<f64, String> {
    let name = COLUMNS[which];
    if cell.is_empty() && which >= 2 {
        return Ok(0.0);
    }
    let number: f64 = cell.parse().map_err(|_| format!("{cell:?} is no number for `{name}`"))?;
    let value = number * size;
    let good = if which < 2 { value > 0.0 } else { value >= 0.0 };
    if value.is_finite() && good && value < 1e6 {
        return Ok(value);
    }
    // As it was written, where it is too large for a number.
    let told = if value.is_finite() { format!("{value} m/s") } else { cell.to_string() };
    Err(format!(
        "{name} = {told} is out of range; hint: {} 0, below 1e6 m/s",
        if which < 2 { "above" } else { "from" }
    ))
}

/// The cells of a line with their columns, from 1; a cell in quotes may hold commas.
fn cells(line: &str) -> Vec<(usize, String)> {
    let mut list = vec![(1, String::new())];
    let mut within_quotes = false;
    for (place, character) in line.chars().enumerate() {
        match character {
            '"' => within_quotes = !within_quotes,
            ',' if !within_quotes => list.push((place + 2, String::new())),
            _ => {
                if let Some((_, cell)) = list.last_mut() {
                    cell.push(character);
                }
            }
        }
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_read_in_si_with_their_errors() {
        let text = "# a comment\nsource, u_s [km/s], u_p [m/s], u_s_error [m/s]\n\"shot 1, left\", 0.5, 100, 5\nshot 2,0.6,130,\n";
        let points = parse(text).unwrap();
        assert_eq!((points[0].shock_velocity, points[0].shock_velocity_error), (500.0, 5.0));
        assert_eq!(points[0].source, "shot 1, left");
        assert_eq!((points[1].particle_velocity, points[1].shock_velocity_error), (130.0, 0.0));
    }

    #[test]
    fn velocities_ahead_are_subtracted() {
        let points = parse("u_p [m/s],u_s [m/s],u_ahead [m/s]\n113,438,13\n").unwrap();
        assert_eq!((points[0].particle_velocity, points[0].shock_velocity), (100.0, 425.0));
    }

    #[test]
    fn every_fault_is_told_with_its_place() {
        let text =
            "u_p [m/s],u_s [m/s],u_s_error [m/s]\n100,fast,1\n-5,400,1\n300,200,1\n100,400\n100,400,NaN\n";
        let told: Vec<String> = parse(text).unwrap_err().iter().map(DataFault::to_string).collect();
        let expected = [
            "2:5: \"fast\" is no number",
            "3:1: u_p = -5",
            "4:1: u_s = 200",
            "5:8: the line has 2",
            "6:9: u_s_error = NaN",
        ];
        assert_eq!(told.len(), expected.len(), "{told:#?}");
        for (told, expected) in told.iter().zip(expected) {
            assert!(told.starts_with(expected), "{told} {expected}");
        }
    }

    #[test]
    fn values_without_a_unit_are_not_compared() {
        for header in ["u_p,u_s", "u_p [m/s],u_s"] {
            let faults = parse(&format!("{header}\n100,600\n")).unwrap_err();
            assert!(faults.iter().all(|f| f.line == 1), "{header}: {faults:?}");
        }
        let told = parse("u_p [m/s],u_s [m/s]\n100,1e400\n").unwrap_err()[0].to_string();
        assert_eq!(told, "2:5: u_s = 1e400 is out of range; hint: above 0, below 1e6 m/s");
    }

    #[test]
    fn headers_are_checked() {
        for (header, part) in [
            ("u_p,u_s [m/s]", "1:1: `u_p` has no unit"),
            ("u_p [m/s],us [m/s]", "1:11: there is no column `us`; hint: did you mean"),
            ("u_p [GPa],u_s [m/s]", "unit of pressure"),
            ("u_p [m/s],u_p [m/s]", "1:11: `u_p` stands in the header twice"),
            ("u_p [m/s]", "`u_s` is missing"),
            ("u_p [m/s,u_s", "no closing bracket"),
            ("u_p [m/s];u_s [m/s]", "1:10: there is one column only; hint: cells are separated by commas"),
            ("", "there is no header"),
            ("u_p [m/s],u_s [m/s]", "no points"),
        ] {
            let faults = parse(&format!("{header}\n")).unwrap_err();
            let told: Vec<String> = faults.iter().map(DataFault::to_string).collect();
            assert!(told.iter().any(|t| t.contains(part)), "{header}: {told:?}");
        }
    }
}
