//! What a run says at its end: one line a point, a short table, and where the time went.

use std::path::Path;

use sph_io::table::{Column, Table};
use sph_riemann::StageTimes;

use crate::outcome::{PointOutcome, Status};
use crate::run::RunEnd;

/// One line about a point.
pub fn line(outcome: &PointOutcome) -> String {
    let u_p = outcome.particle_velocity;
    match &outcome.status {
        Status::Failed(reason) => format!("u_p = {u_p} m/s failed: {reason}"),
        status => {
            let (u_s, error) = (outcome.shock_velocity, outcome.standard_error);
            let (cells, time) = (outcome.fed_cells, outcome.wall_seconds);
            let warnings: String = outcome.warnings.iter().map(|w| format!("\n  warning: {w}")).collect();
            // A point that was stopped early has not told anything yet.
            let found = match u_s.is_finite() {
                true => format!("u_s = {u_s:.1} ± {error:.1} m/s"),
                false => "no u_s yet".into(),
            };
            format!("u_p = {u_p} m/s: {found}, {status}, {cells:.1} cells fed in {time:.1} s{warnings}")
        }
    }
}

/// The columns of the table that fit a terminal.
pub fn points(outcomes: &[&PointOutcome]) -> Table {
    let float = |name: &str, unit: &str, value: &dyn Fn(&PointOutcome) -> f64| {
        Column::float(name, unit, "", outcomes.iter().map(|o| value(o)).collect::<Vec<_>>())
    };
    let state =
        |o: &PointOutcome, f: &dyn Fn(&crate::observe::States) -> f64| o.states.as_ref().map_or(f64::NAN, f);
    let percent = |o: &PointOutcome, f: &dyn Fn(&sph_materials::jump::JumpResiduals) -> f64| {
        o.residuals.as_ref().map_or(f64::NAN, |r| rounded(100.0 * f(r), 2))
    };
    let status = |o: &PointOutcome| match o.status {
        Status::Failed(_) => "failed".to_string(),
        _ => o.status.to_string(),
    };
    Table::new("Points")
        .with(float("u_p", "m/s", &|o| o.particle_velocity))
        .with(float("u_s", "m/s", &|o| rounded(o.shock_velocity, 1)))
        .with(float("±", "m/s", &|o| rounded(o.standard_error, 1)))
        .with(float("by mass", "m/s", &|o| rounded(o.mass_balance_velocity, 1)))
        .with(float("Δσ", "GPa", &|o| rounded(state(o, &|s| s.stress_jump() * 1e-9), 3)))
        .with(float("σ_HEL", "GPa", &|o| rounded(state(o, &|s| -s.ahead.stress * 1e-9), 3)))
        .with(float("ρ packing", "g/cm3", &|o| rounded(state(o, &|s| s.behind.packing_density * 1e-3), 3)))
        .with(float("ρ own", "g/cm3", &|o| rounded(state(o, &|s| s.behind.own_density * 1e-3), 3)))
        .with(float("mass", "%", &|o| percent(o, &|r| r.mass)))
        .with(float("momentum", "%", &|o| percent(o, &|r| r.momentum)))
        .with(float("energy", "%", &|o| percent(o, &|r| r.energy)))
        .with(float("cells fed", "", &|o| rounded(o.fed_cells, 1)))
        .with(float("time", "s", &|o| rounded(o.wall_seconds, 1)))
        .with(Column::text("status", "", outcomes.iter().map(|o| status(o)).collect::<Vec<_>>()))
}

/// Where the time of the solver went.
pub fn stages(stages: &StageTimes) -> Table {
    let rows = stages.table();
    Table::new("Time by stage of the solver, all points")
        .with(Column::text("stage", "", rows.iter().map(|r| r.0.to_string()).collect::<Vec<_>>()))
        .with(Column::float("time", "s", "", rows.iter().map(|r| rounded(r.1, 2)).collect::<Vec<_>>()))
        .with(Column::float(
            "share",
            "%",
            "",
            rows.iter().map(|r| rounded(100.0 * r.2, 1)).collect::<Vec<_>>(),
        ))
}

/// The end of a run for programs: how it ended, the points, the time of the stages.
pub fn json(end: &RunEnd, outcomes: &[&PointOutcome], folder: &Path, seconds: f64) -> serde_json::Value {
    let finite = |value: f64| value.is_finite().then_some(value);
    let points: Vec<serde_json::Value> = outcomes
        .iter()
        .map(|o| {
            serde_json::json!({
                "particle_velocity": o.particle_velocity,
                "shock_velocity": finite(o.shock_velocity),
                "standard_error": finite(o.standard_error),
                "mass_balance_velocity": finite(o.mass_balance_velocity),
                "status": o.status.to_string(),
                "seconds": o.wall_seconds,
                "particle_steps": o.particle_steps,
            })
        })
        .collect();
    let mut stages = StageTimes::default();
    outcomes.iter().for_each(|o| stages.merge(&o.stages));
    let stages: Vec<serde_json::Value> = stages
        .table()
        .iter()
        .map(|row| serde_json::json!({"stage": row.0, "seconds": row.1, "share": row.2}))
        .collect();
    serde_json::json!({
        "format": 1,
        "end": end.word(),
        "folder": folder,
        "seconds": seconds,
        "points": points,
        "stages": stages,
        "interventions": super::monitors::interventions(outcomes),
    })
}

fn rounded(value: f64, digits: i32) -> f64 {
    let scale = 10f64.powi(digits);
    (value * scale).round() / scale
}
