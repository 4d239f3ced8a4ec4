//! CSV with a header of names and units, and comment lines that begin with `# `.

use super::number::exact;
use super::{Column, Table, Values};
use std::fmt::Write;

pub(super) fn write(table: &Table) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "# {}", one_line(&table.title));
    for column in &table.columns {
        let _ = writeln!(out, "# {}: {}", one_line(&column.heading()), one_line(&column.description));
    }
    let header: Vec<String> = table.columns.iter().map(|column| quoted(&column.heading())).collect();
    let _ = writeln!(out, "{}", header.join(","));
    for row in 0..table.n_rows() {
        let cells: Vec<String> = table.columns.iter().map(|column| cell(&column.values, row)).collect();
        let _ = writeln!(out, "{}", cells.join(","));
    }
    out
}

fn cell(values: &Values, row: usize) -> String {
    match values {
        Values::Float(values) => values.get(row).map_or(String::new(), |&value| exact(value)),
        Values::Integer(values) => values.get(row).map_or(String::new(), i64::to_string),
        Values::Text(values) => values.get(row).map_or(String::new(), |value| quoted(&one_line(value))),
    }
}

fn one_line(text: &str) -> String {
    text.replace(['\n', '\r'], " ")
}

/// Quotes a cell that would otherwise be read as several, or as a comment.
fn quoted(text: &str) -> String {
    if text.contains([',', '"']) || text.starts_with('#') {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

pub(super) fn read(content: &str) -> Result<Table, String> {
    let comments: Vec<&str> = content.lines().filter_map(comment).collect();
    let mut rows =
        content.lines().enumerate().filter(|(_, line)| comment(line).is_none() && !line.is_empty());
    let (_, header) = rows.next().ok_or("there is no header line")?;
    let headings = split(header);
    let mut cells: Vec<Vec<String>> = vec![Vec::new(); headings.len()];
    for (line_idx, line) in rows {
        let row = split(line);
        if row.len() != headings.len() {
            let (n, expected) = (row.len(), headings.len());
            return Err(format!("line {} has {n} cells, the header {expected}", line_idx + 1));
        }
        cells.iter_mut().zip(row).for_each(|(column, cell)| column.push(cell));
    }
    let mut table = Table::new(comments.first().copied().unwrap_or_default());
    for (heading, cells) in headings.iter().zip(cells) {
        table.columns.push(column_from(heading, cells, &comments));
    }
    Ok(table)
}

fn comment(line: &str) -> Option<&str> {
    line.strip_prefix('#').map(str::trim)
}

fn column_from(heading: &str, cells: Vec<String>, comments: &[&str]) -> Column {
    let (name, unit) = match heading.split_once(" [") {
        Some((name, rest)) => (name, rest.trim_end_matches(']')),
        None => (heading, ""),
    };
    let description =
        comments.iter().find_map(|line| line.strip_prefix(heading)?.strip_prefix(':')).unwrap_or_default();
    Column::new(name.trim(), unit, description.trim(), values_from(cells))
}

fn values_from(cells: Vec<String>) -> Values {
    if let Ok(values) = cells.iter().map(|cell| cell.trim().parse()).collect() {
        return Values::Integer(values);
    }
    match cells.iter().map(|cell| cell.trim().parse()).collect() {
        Ok(values) => Values::Float(values),
        Err(_) => Values::Text(cells),
    }
}

/// Splits a line at its commas, those within quotes excepted.
fn split(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut within_quotes = false;
    let mut characters = line.chars().peekable();
    while let Some(character) = characters.next() {
        let Some(cell) = cells.last_mut() else { break };
        match character {
            '"' if within_quotes && characters.peek() == Some(&'"') => cell.extend(characters.next()),
            '"' => within_quotes = !within_quotes,
            ',' if !within_quotes => cells.push(String::new()),
            _ => cell.push(character),
        }
    }
    cells
}
