//! The logs of a point: what each block of cells said, and what a bisection tried.

use sph_io::table::{Column, Table};
use sph_window::search::bisection::Trial;

use crate::outcome::PointOutcome;
use crate::settle::BlockRecord;

fn numbers<Row>(name: &str, unit: &str, text: &str, rows: &[Row], value: impl Fn(&Row) -> f64) -> Column {
    Column::float(name, unit, text, rows.iter().map(value).collect::<Vec<_>>())
}

fn words<Row>(name: &str, text: &str, rows: &[Row], value: impl Fn(&Row) -> String) -> Column {
    Column::text(name, text, rows.iter().map(value).collect::<Vec<_>>())
}

/// What was concluded from each block of cells: why the point went on, and why it ended.
pub fn blocks(outcome: &PointOutcome) -> Table {
    let rows = &outcome.blocks;
    let column = |name: &str, unit: &str, text: &str, value: fn(&BlockRecord) -> f64| {
        numbers(name, unit, text, rows, value)
    };
    Table::new(format!("Blocks of cells at u_p = {} m/s", outcome.particle_velocity))
        .with(column("from", "", "cells swept when the block started", |b| b.from))
        .with(column("to", "", "cells swept when it ended", |b| b.to))
        .with(column("u_s", "m/s", "shock velocity over the block", |b| b.shock_velocity))
        .with(column("u_s_mean", "m/s", "shock velocity over the blocks that must agree", |b| b.mean))
        .with(column("spread", "", "spread of their u_s, relative to the mean", |b| b.spread))
        .with(column("drift", "", "change of u_s along them, relative to the mean", |b| b.drift))
        .with(column("u_s_error", "m/s", "uncertainty of the mean", |b| b.error))
        .with(words("decision", "what followed", rows, |b| b.decision.to_string()))
}

/// What a bisection tried, in order.
pub fn search(outcome: &PointOutcome) -> Table {
    let rows = &outcome.search;
    let column =
        |name: &str, unit: &str, text: &str, value: fn(&Trial) -> f64| numbers(name, unit, text, rows, value);
    Table::new(format!("Bisection at u_p = {} m/s: every trial", outcome.particle_velocity))
        .with(column("round", "", "round of bisection, 0: the way of the front to its place", |t| {
            f64::from(t.round)
        }))
        .with(words("stage", "what it was", rows, |t| format!("{:?}", t.stage)))
        .with(column("start", "s", "time of the saved state that it started from", |t| t.start))
        .with(column("u_out", "m/s", "outlet velocity", |t| t.outlet_velocity))
        .with(column("u_in", "m/s", "inlet velocity, u_out + u_p", |t| t.inlet_velocity))
        .with(column("drift", "1/s", "mean slope of omega", |t| t.drift.unwrap_or(f64::NAN)))
        .with(column("bracket_from", "m/s", "lower end of the bracket of u_out after it", |t| t.bracket.0))
        .with(column("bracket_to", "m/s", "upper end of the bracket of u_out after it", |t| t.bracket.1))
        .with(column("fed", "", "cells fed in it", |t| t.fed))
        .with(column("particle_steps", "", "particles advanced in it", |t| t.particle_steps as f64))
        .with(words("decision", "what followed", rows, |t| format!("{:?}", t.decision)))
}
