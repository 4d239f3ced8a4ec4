//! A resolution study: the same sweep at several particle sizes, and u_s at D → 0.
//!
//! ```text
//! D_2um/, D_1um/, …            one whole run each
//! resolution.csv, .json        u_s at each D, extrapolated, with uncertainty and observed order
//! plots/resolution.png, .svg   u_s(D) relative to the extrapolated value
//! ```
//!
//! Each run is resumed, refused or replaced as a single one is; a study that was stopped goes on with `--resume`.

pub mod extrapolate;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result, anyhow};
use sph_io::console;
use sph_io::plot::{Axis, Figure, Series};
use sph_io::table::{Column, Table, Values};

use self::extrapolate::{AtSize, Extrapolated, extrapolate};
use crate::config::Case;
use crate::config::units::{LengthKind, show};
use crate::report::earlier;
use crate::run::{self, RunEnd, RunOptions};

/// A micrometer [1/m].
const MICRO: f64 = 1e6;

/// What a study found at one u_p.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// u_p [m/s].
    pub particle_velocity: f64,
    /// u_s at each particle size that settled.
    pub sizes: Vec<AtSize>,
    /// u_s at D → 0; none with fewer than two sizes.
    pub limit: Option<Extrapolated>,
}

/// Runs a case at each of its particle sizes, one after another, from the coarsest on.
///
/// # Errors
/// As a single run.
pub fn run(cases: &[Case], case_text: &str, options: &RunOptions, interrupt: &AtomicBool) -> Result<RunEnd> {
    let _lock = match run::hold(&options.folder)? {
        Ok(lock) => lock,
        Err(refused) => return Ok(refused),
    };
    // The results of one run and those of a study of sizes, in one folder, would tell of two things.
    if options.folder.join("case.json").exists() {
        return Ok(RunEnd::Refused(format!(
            "{}: there are results of a run with one particle size; hint: --out names another folder",
            options.folder.display()
        )));
    }
    let mut some_failed = false;
    let mut tables = Vec::new();
    for case in cases {
        if interrupt.load(Ordering::Relaxed) {
            return Ok(RunEnd::Interrupted);
        }
        let size = case.medium.particle_size;
        let folder = folder_of(&options.folder, size);
        if !options.quiet && !options.json {
            console::print_line(format_args!("D = {}: {}", show::<LengthKind>(size), folder.display()))?;
        }
        let quiet = options.quiet || options.json;
        let single = RunOptions { folder: folder.clone(), quiet, json: false, ..options.clone() };
        match run::run(case, case_text, &single, interrupt)? {
            RunEnd::Done => {}
            RunEnd::SomeFailed => some_failed = true,
            other => return Ok(other),
        }
        tables.push((size, Table::read_csv(folder.join("hugoniot.csv"))?));
    }
    let rows = rows(&tables)?;
    earlier::clear_leftovers(&options.folder)?;
    write(&options.folder, &cases[0].name, &rows)?;
    let table = table(&cases[0].name, &rows);
    if options.json {
        console::print_line(format_args!("{:#}", table.to_json()))?;
    } else if !options.quiet {
        console::print_line(table.to_text())?;
    }
    Ok(if some_failed { RunEnd::SomeFailed } else { RunEnd::Done })
}

/// Folder of the run with a particle size [m]: `D_1um`.
pub fn folder_of(folder: &Path, particle_size: f64) -> PathBuf {
    folder.join(format!("D_{}", show::<LengthKind>(particle_size).replace(' ', "")))
}

/// The settled points of all runs by u_p, extrapolated.
///
/// # Errors
/// If a table of a run lacks what is read of it.
fn rows(tables: &[(f64, Table)]) -> Result<Vec<Row>> {
    let mut rows: Vec<Row> = Vec::new();
    for (size, table) in tables {
        let of = || format!("hugoniot.csv of the run with D = {}", show::<LengthKind>(*size));
        let column = |name: &str| numbers(table, name).with_context(of);
        let (u_p, u_s, error) = (column("u_p")?, column("u_s")?, column("u_s_error")?);
        let status = match table.column("status").map(|c| &c.values) {
            Some(Values::Text(words)) => words,
            _ => return Err(anyhow!("there is no column of words `status`")).with_context(of),
        };
        for (k, &particle_velocity) in u_p.iter().enumerate() {
            if status[k] != "settled" {
                continue;
            }
            let at = AtSize { particle_size: *size, shock_velocity: u_s[k], standard_error: error[k] };
            match rows.iter_mut().find(|r| r.particle_velocity == particle_velocity) {
                Some(row) => row.sizes.push(at),
                None => rows.push(Row { particle_velocity, sizes: vec![at], limit: None }),
            }
        }
    }
    rows.sort_by(|a, b| a.particle_velocity.total_cmp(&b.particle_velocity));
    rows.iter_mut().for_each(|row| row.limit = extrapolate(&row.sizes));
    Ok(rows)
}

/// A column of numbers, whole or not.
fn numbers(table: &Table, name: &str) -> Result<Vec<f64>> {
    match table.column(name).map(|c| &c.values) {
        Some(Values::Float(values)) => Ok(values.clone()),
        Some(Values::Integer(values)) => Ok(values.iter().map(|&v| v as f64).collect()),
        _ => Err(anyhow!("there is no column of numbers `{name}`")),
    }
}

fn write(folder: &Path, name: &str, rows: &[Row]) -> Result<()> {
    let plots = folder.join("plots");
    std::fs::create_dir_all(&plots)
        .with_context(|| format!("{}: the folder cannot be made", plots.display()))?;
    table(name, rows).write_csv(folder.join("resolution.csv"))?;
    table(name, rows).write_json(folder.join("resolution.json"))?;
    let figure = figure(name, rows);
    figure.write_svg(plots.join("resolution.svg"))?;
    Ok(figure.write_png(plots.join("resolution.png"))?)
}

/// All particle sizes of a study [m], coarsest first.
fn sizes(rows: &[Row]) -> Vec<f64> {
    let mut sizes: Vec<f64> = rows.iter().flat_map(|r| &r.sizes).map(|s| s.particle_size).collect();
    sizes.sort_by(|a, b| b.total_cmp(a));
    sizes.dedup();
    sizes
}

/// One row a u_p: u_s at each D, and at D → 0.
fn table(name: &str, rows: &[Row]) -> Table {
    let of = |name: &str, unit: &str, text: &str, f: &dyn Fn(&Row) -> f64| {
        Column::float(name, unit, text, rows.iter().map(f).collect::<Vec<_>>())
    };
    let limit = |r: &Row, f: fn(&Extrapolated) -> f64| r.limit.as_ref().map_or(f64::NAN, f);
    let mut table = Table::new(format!("{name}: u_s over particle size, and at D → 0")).with(of(
        "u_p",
        "m/s",
        "particle velocity behind the front",
        &|r| r.particle_velocity,
    ));
    for size in sizes(rows) {
        let at = move |r: &Row, f: fn(&AtSize) -> f64| {
            r.sizes.iter().find(|s| s.particle_size == size).map_or(f64::NAN, f)
        };
        let label = show::<LengthKind>(size).replace(' ', "");
        table = table
            .with(of(&format!("u_s_{label}"), "m/s", "u_s of settled points at this D", &|r| {
                at(r, |s| s.shock_velocity)
            }))
            .with(of(&format!("error_{label}"), "m/s", "its standard error", &|r| {
                at(r, |s| s.standard_error)
            }));
    }
    table
        .with(of("u_s_limit", "m/s", "u_s at D → 0", &|r| limit(r, |l| l.shock_velocity)))
        .with(of("uncertainty", "m/s", "its standard uncertainty, all in all", &|r| {
            limit(r, |l| l.uncertainty)
        }))
        .with(of("statistical", "m/s", "part of it from standard errors", &|r| limit(r, |l| l.statistical)))
        .with(of("order_spread", "m/s", "part of it from the assumed orders", &|r| {
            limit(r, |l| l.order_spread)
        }))
        .with(of("observed_order", "", "order that fits best, where one shows", &|r| {
            limit(r, |l| l.observed_order.unwrap_or(f64::NAN))
        }))
}

/// u_s over D relative to the extrapolated value, with both errors.
fn figure(name: &str, rows: &[Row]) -> Figure {
    let title = format!("{name}: resolution");
    let mut figure = Figure::new(title, Axis::new("D [µm]"), Axis::new("u_s(D)/u_s(D → 0) − 1 [%]"));
    for row in rows {
        let Some(limit) = &row.limit else { continue };
        let percent = |u: f64| 100.0 * (u / limit.shock_velocity - 1.0);
        let error = |e: f64| 100.0 * e / limit.shock_velocity;
        let x: Vec<f64> =
            [0.0].into_iter().chain(row.sizes.iter().rev().map(|s| s.particle_size * MICRO)).collect();
        let y: Vec<f64> =
            [0.0].into_iter().chain(row.sizes.iter().rev().map(|s| percent(s.shock_velocity))).collect();
        let errors: Vec<f64> = [error(limit.uncertainty)]
            .into_iter()
            .chain(row.sizes.iter().rev().map(|s| error(s.standard_error)))
            .collect();
        let label = format!("u_p = {} m/s", row.particle_velocity);
        figure = figure.with(Series::line_with_points(&label, &x, &y).with_error(&errors));
    }
    figure
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run_table(shift: f64) -> Table {
        Table::new("run")
            .with(Column::float("u_p", "m/s", "", [100.0, 200.0, 300.0]))
            .with(Column::float("u_s", "m/s", "", [425.0 + 5.0 * shift, 757.0 + shift, 1117.0]))
            .with(Column::float("u_s_error", "m/s", "", [0.3, 0.1, 0.2]))
            .with(Column::text("status", "", ["settled", "settled", "not settled"].map(String::from)))
    }

    #[test]
    fn settled_points_of_all_runs_are_extrapolated_and_drawn() {
        let tables: Vec<(f64, Table)> = [2.0, 1.0, 0.5].iter().map(|&d| (d * 1e-6, run_table(d))).collect();
        let rows = rows(&tables).unwrap();
        assert_eq!(rows.len(), 2, "the point that never settled is left out");
        let limit = rows[0].limit.as_ref().unwrap();
        assert!((limit.shock_velocity - 425.0).abs() < limit.uncertainty, "{limit:?}");
        assert!((limit.observed_order.unwrap() - 1.0).abs() < 0.05);
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), "case", &rows).unwrap();
        let table = Table::read_csv(folder.path().join("resolution.csv")).unwrap();
        assert!(table.column("u_s_1um").is_some() && table.column("u_s_500nm").is_some());
        assert!(folder.path().join("plots/resolution.png").metadata().unwrap().len() > 5000);
    }

    #[test]
    fn a_table_that_lacks_a_column_is_an_error() {
        for missing in ["u_p", "u_s", "u_s_error", "status"] {
            let mut table = run_table(0.0);
            table.columns.retain(|column| column.name != missing);
            let error = format!("{:#}", rows(&[(2e-6, run_table(0.0)), (1e-6, table)]).unwrap_err());
            assert!(error.contains("D = 1 um") && error.contains(&format!("`{missing}`")), "{error}");
        }
    }
}
