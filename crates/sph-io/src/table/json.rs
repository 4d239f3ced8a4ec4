//! JSON, column by column.

use super::{Table, Values};
use serde_json::{Value, json};

pub(super) fn write(table: &Table) -> Value {
    let columns: Vec<Value> = table
        .columns
        .iter()
        .map(|column| {
            json!({
                "name": column.name,
                "unit": column.unit,
                "description": column.description,
                "values": values(&column.values),
            })
        })
        .collect();
    json!({ "title": table.title, "columns": columns })
}

/// `serde_json` turns a number that is not finite into `null`, and writes the shortest digits that read back.
fn values(values: &Values) -> Value {
    match values {
        Values::Float(values) => json!(values),
        Values::Integer(values) => json!(values),
        Values::Text(values) => json!(values),
    }
}
