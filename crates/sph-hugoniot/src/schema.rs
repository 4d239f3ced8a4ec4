//! JSON schemas of what the program writes for other programs.

use clap::ValueEnum;

/// What there is a schema of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Schema {
    /// `hugoniot check --json`
    Check,
    /// `hugoniot run --json`
    Run,
    /// `hugoniot status --json`, and `status.json` but for its `state`
    Status,
    /// `hugoniot.json`
    Table,
}

impl Schema {
    /// Every one.
    pub const ALL: [Self; 4] = [Self::Check, Self::Run, Self::Status, Self::Table];

    /// The schema (JSON Schema, draft 2020-12).
    pub fn text(self) -> &'static str {
        match self {
            Self::Check => include_str!("../schemas/check.schema.json"),
            Self::Run => include_str!("../schemas/run.schema.json"),
            Self::Status => include_str!("../schemas/status.schema.json"),
            Self::Table => include_str!("../schemas/table.schema.json"),
        }
    }
}
