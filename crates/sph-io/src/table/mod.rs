//! Tables: named columns with units, to CSV, to JSON, and to the terminal.
//!
//! Files carry every number with as many digits as it takes to read the same bits back; the terminal shows six
//! significant ones. Units and descriptions travel with the numbers: in CSV as comment lines and in the header
//! (`name [unit]`), in JSON as fields.
//!
//! A number that is not finite is `NaN`, `inf` or `-inf` in CSV and `null` in JSON, which has no word for it.

mod csv;
mod json;
mod number;
mod text;

pub(crate) use text::cell;

use crate::{IoError, atomic};
use std::path::Path;

/// The values of one column.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Real numbers, in the column's unit.
    Float(Vec<f64>),
    /// Whole numbers, such as counts.
    Integer(Vec<i64>),
    /// Words, such as a status.
    Text(Vec<String>),
}

impl Values {
    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Float(values) => values.len(),
            Self::Integer(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// One named column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name, as programs that read the file will call it.
    pub name: String,
    /// Unit, such as `m/s`; empty if there is none.
    pub unit: String,
    /// One line that says what it is.
    pub description: String,
    /// The values, one a row.
    pub values: Values,
}

impl Column {
    fn new(name: &str, unit: &str, description: &str, values: Values) -> Self {
        Self { name: name.to_owned(), unit: unit.to_owned(), description: description.to_owned(), values }
    }

    /// A column of real numbers.
    pub fn float(name: &str, unit: &str, description: &str, values: impl Into<Vec<f64>>) -> Self {
        Self::new(name, unit, description, Values::Float(values.into()))
    }

    /// A column of whole numbers.
    pub fn integer(name: &str, unit: &str, description: &str, values: impl Into<Vec<i64>>) -> Self {
        Self::new(name, unit, description, Values::Integer(values.into()))
    }

    /// A column of words.
    pub fn text(name: &str, description: &str, values: impl Into<Vec<String>>) -> Self {
        Self::new(name, "", description, Values::Text(values.into()))
    }

    /// The header cell: `name [unit]`, or `name` where there is no unit.
    fn heading(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} [{}]", self.name, self.unit) }
    }
}

/// Columns of equal length under one title.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// What the table shows, in one line.
    pub title: String,
    /// The columns, from left to right.
    pub columns: Vec<Column>,
}

impl Table {
    /// A table without columns.
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), columns: Vec::new() }
    }

    /// The table with one more column at its right.
    #[must_use]
    pub fn with(mut self, column: Column) -> Self {
        self.columns.push(column);
        self
    }

    /// Number of rows: that of the longest column.
    #[must_use]
    pub fn n_rows(&self) -> usize {
        self.columns.iter().map(|column| column.values.len()).max().unwrap_or(0)
    }

    /// The column of that name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The column of that name, if it holds real numbers.
    #[must_use]
    pub fn floats(&self, name: &str) -> Option<&[f64]> {
        match &self.column(name)?.values {
            Values::Float(values) => Some(values),
            _ => None,
        }
    }

    /// The table as CSV: comment lines with title and descriptions, a header line, the rows.
    #[must_use]
    pub fn to_csv(&self) -> String {
        csv::write(self)
    }

    /// The table as JSON: `title`, and `columns` with `name`, `unit`, `description`, `values`.
    #[must_use]
    pub fn to_json(&self) -> serde_json::Value {
        json::write(self)
    }

    /// The table for the terminal: aligned, numbers with six significant digits.
    #[must_use]
    pub fn to_text(&self) -> String {
        text::write(self)
    }

    /// Writes [`Table::to_csv`] to a file, atomically.
    ///
    /// # Errors
    /// [`IoError::Invalid`] if the columns differ in length or two share a name, [`IoError::File`] from the system.
    pub fn write_csv(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        let path = path.as_ref();
        self.check(path)?;
        atomic::write_atomic(path, self.to_csv().as_bytes())
    }

    /// Writes [`Table::to_json`] to a file, atomically.
    ///
    /// # Errors
    /// As [`Table::write_csv`].
    pub fn write_json(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        let path = path.as_ref();
        self.check(path)?;
        atomic::write_atomic(path, format!("{:#}\n", self.to_json()).as_bytes())
    }

    /// Reads a CSV file: this crate's own, or any with a header line, `#` comments and commas. A column whose every
    /// cell is a number becomes whole or real numbers, any other one words.
    ///
    /// # Errors
    /// [`IoError::File`] from the system, [`IoError::Damaged`] with the line for a row of another length than the header.
    pub fn read_csv(path: impl AsRef<Path>) -> Result<Self, IoError> {
        let path = path.as_ref();
        let content = std::fs::read_to_string(path).map_err(IoError::file(path, "read"))?;
        csv::read(&content).map_err(|what| IoError::damaged(path, what))
    }

    fn check(&self, path: &Path) -> Result<(), IoError> {
        let n_rows = self.n_rows();
        for (k, column) in self.columns.iter().enumerate() {
            let length = column.values.len();
            if length != n_rows {
                let reason = format!("column `{}` has {length} rows, another has {n_rows}", column.name);
                return Err(IoError::invalid(path, reason));
            }
            if self.columns[..k].iter().any(|earlier| earlier.name == column.name) {
                return Err(IoError::invalid(path, format!("two columns are named `{}`", column.name)));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Table {
        Table::new("Points")
            .with(Column::float("u_s", "m/s", "shock velocity", [0.1, f64::NAN, -1.0e300]))
            .with(Column::integer("steps", "", "time steps", [1, -2, i64::MAX]))
            .with(Column::text("status", "how it ended", ["a, b", "say \"x\"", ""].map(String::from)))
    }

    #[test]
    fn csv_comes_back_with_the_same_bits_units_and_descriptions() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        let table = sample();
        table.write_csv(&path).unwrap();
        let back = Table::read_csv(&path).unwrap();
        assert_eq!(back.title, "Points");
        let (before, after) = (table.floats("u_s").unwrap(), back.floats("u_s").unwrap());
        assert!(after[1].is_nan());
        assert_eq!((before[0], before[2]), (after[0], after[2]));
        assert_eq!(back.columns[1..], table.columns[1..]);
        assert_eq!((&*back.columns[0].unit, &*back.columns[0].description), ("m/s", "shock velocity"));
    }

    #[test]
    fn json_says_null_for_what_is_not_a_number() {
        let json = sample().to_json();
        assert_eq!(json["columns"][0]["unit"], "m/s");
        assert!(json["columns"][0]["values"][1].is_null());
        assert_eq!(json["columns"][1]["values"][2], i64::MAX);
    }

    #[test]
    fn unequal_lengths_and_equal_names_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        let uneven = sample().with(Column::float("short", "", "", [1.0]));
        assert!(
            uneven.write_csv(&path).unwrap_err().to_string().contains("`short` has 1 rows, another has 3")
        );
        let twice = sample().with(Column::integer("u_s", "", "", [1, 2, 3]));
        assert!(twice.write_json(&path).unwrap_err().to_string().contains("two columns are named `u_s`"));
        assert!(!path.exists());
    }

    #[test]
    fn a_short_row_is_reported_with_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("t.csv");
        std::fs::write(&path, "# a reference\nx [m],y\n1,2\n3\n").unwrap();
        let message = Table::read_csv(&path).unwrap_err().to_string();
        assert!(message.contains("line 4") && message.contains("1 cells"), "{message}");
    }

    #[test]
    fn text_is_aligned() {
        let text = sample().to_text();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "Points");
        assert!(lines[1].contains("u_s") && lines[2].contains("m/s"), "{text}");
        let ends: Vec<usize> = lines[4..7].iter().map(|line| line.find("  ").unwrap_or(0)).collect();
        assert_eq!(lines.len(), 7, "{text}");
        assert!(ends.iter().all(|&end| end < 12), "{text}");
    }
}
