//! A table for people: title, names, units, a rule, rows.

use super::number::brief;
use super::{Column, Table, Values};

/// Two spaces stand between columns.
const GAP: &str = "  ";

pub(super) fn write(table: &Table) -> String {
    let n_rows = table.n_rows();
    let columns: Vec<Vec<String>> = table.columns.iter().map(|column| aligned(column, n_rows)).collect();
    let mut out = format!("{}\n", table.title);
    for line in 0..n_rows + 3 {
        let cells: Vec<&str> = columns.iter().map(|column| column[line].as_str()).collect();
        out.push_str(cells.join(GAP).trim_end());
        out.push('\n');
    }
    out
}

/// The column's lines, name, unit and rule first, all of one width.
fn aligned(column: &Column, n_rows: usize) -> Vec<String> {
    let mut cells = vec![column.name.clone(), column.unit.clone(), String::new()];
    cells.extend((0..n_rows).map(|row| cell(&column.values, row)));
    let width = cells.iter().map(|cell| cell.chars().count()).max().unwrap_or(0);
    cells[2] = "─".repeat(width);
    let is_text = matches!(column.values, Values::Text(_));
    cells
        .iter()
        .map(|cell| if is_text { format!("{cell:<width$}") } else { format!("{cell:>width$}") })
        .collect()
}

/// A value with six significant digits, or as it stands.
pub(crate) fn cell(values: &Values, row: usize) -> String {
    match values {
        Values::Float(values) => values.get(row).map_or(String::new(), |&value| brief(value)),
        Values::Integer(values) => values.get(row).map_or(String::new(), i64::to_string),
        Values::Text(values) => values.get(row).cloned().unwrap_or_default(),
    }
}
