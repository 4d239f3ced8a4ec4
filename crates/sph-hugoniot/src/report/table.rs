//! The table of all points, and the tables of one.

use sph_io::table::{Column, Table};

use crate::config::Case;
use crate::microstructure::Sample;
use crate::observe::{Bin, MeanState};
use crate::outcome::PointOutcome;

/// A column of numbers: name, unit, description, and how a row gives its value.
pub(super) type Number<Row> = (&'static str, &'static str, &'static str, fn(&Row) -> f64);

/// What is measured of a point.
const MEASURED: [Number<PointOutcome>; 24] = [
    ("u_p", "m/s", "particle velocity behind the front, imposed", |o| o.particle_velocity),
    ("u_s", "m/s", "shock velocity relative to the medium ahead, from the front's way", |o| o.shock_velocity),
    ("u_s_error", "m/s", "uncertainty of u_s: batch means over whole cells, and slow drift", |o| {
        o.standard_error
    }),
    ("u_s_mass", "m/s", "shock velocity from the mass of the plateau", |o| o.mass_balance_velocity),
    ("stress_jump", "Pa", "rise of -sigma_xx across the compaction wave", |o| {
        o.states.map_or(f64::NAN, |s| s.stress_jump())
    }),
    ("sigma_hel", "Pa", "-sigma_xx between precursor and compaction wave", |o| {
        o.states.map_or(f64::NAN, |s| -s.ahead.stress)
    }),
    ("stress_final", "Pa", "-sigma_xx behind the compaction wave: stress_jump + sigma_hel", |o| {
        behind(o, |s| -s.stress)
    }),
    ("rho_packing", "kg/m3", "density behind: mass per volume of space", |o| {
        behind(o, |s| s.packing_density)
    }),
    ("rho_own", "kg/m3", "density behind: as the particles carry it", |o| behind(o, |s| s.own_density)),
    ("packing_over_own", "", "rho_packing / rho_own: below 1 with open pores", |o| {
        behind(o, |s| s.packing_density / s.own_density)
    }),
    ("residual_mass", "", "miss of the jump condition of mass", |o| o.residuals.map_or(f64::NAN, |r| r.mass)),
    ("residual_momentum", "", "miss of the jump condition of momentum", |o| {
        o.residuals.map_or(f64::NAN, |r| r.momentum)
    }),
    ("residual_energy", "", "miss of the jump condition of energy, sound counted", |o| {
        o.residuals.map_or(f64::NAN, |r| r.energy)
    }),
    (
        "energy_carried_off",
        "",
        "part of the wave's work that leaves the front as sound, heat farther behind",
        |o| o.states.map_or(f64::NAN, |s| s.energy_carried_off()),
    ),
    ("pores_left", "", "volume of pores over volume of space behind", |o| {
        o.states.map_or(f64::NAN, |s| s.pores_left())
    }),
    ("relaxation_length", "m", "how far behind the front the matter still relaxes", |o| {
        o.states.map_or(f64::NAN, |s| s.relaxation_length)
    }),
    ("precursor_speed", "m/s", "speed of the elastic precursor, mean over its rise, on its first way", |o| {
        o.precursor.map_or(f64::NAN, |p| p.speed)
    }),
    ("precursor_foot_speed", "m/s", "speed of its lowest level, a sixteenth of its rise", |o| {
        o.precursor.map_or(f64::NAN, |p| p.foot_speed)
    }),
    ("precursor_u", "m/s", "particle velocity behind the precursor, on its first way", |o| {
        o.precursor.map_or(f64::NAN, |p| p.behind.velocity)
    }),
    ("precursor_stress", "Pa", "-sigma_xx behind the precursor, on its first way", |o| {
        o.precursor.map_or(f64::NAN, |p| -p.behind.stress)
    }),
    ("precursor_residual_mass", "", "miss of the conservation of mass in the precursor", |o| {
        o.precursor_residuals.map_or(f64::NAN, |r| r.mass)
    }),
    ("precursor_residual_momentum", "", "miss of the conservation of momentum in the precursor", |o| {
        o.precursor_residuals.map_or(f64::NAN, |r| r.momentum)
    }),
    ("precursor_residual_energy", "", "miss of the conservation of energy in the precursor", |o| {
        o.precursor_residuals.map_or(f64::NAN, |r| r.energy)
    }),
    ("u_p_effective", "m/s", "u_p that the ends of the window imposed", |o| o.effective_particle_velocity),
];

/// What a point cost, and how well its books close.
const SPENT: [Number<PointOutcome>; 4] = [
    ("fed_cells", "", "cells of the medium fed", |o| o.fed_cells),
    ("particle_steps_per_second", "1/s", "particles advanced in a second", |o| o.particle_steps_per_second()),
    ("ledger_residual", "", "gap of the ledger of mass, momentum and energy", |o| o.ledger_residual),
    ("wall_time", "s", "time that the point took", |o| o.wall_seconds),
];

/// Columns of the averaged profile.
const PROFILE: [Number<Bin>; 9] = [
    ("xi", "m", "distance from the front, positive ahead", |b| b.place),
    ("rho_packing", "kg/m3", "mass per volume of space", |b| b.packing_density),
    ("rho_own", "kg/m3", "density as the particles carry it", |b| b.own_density),
    ("sigma_xx", "Pa", "longitudinal stress over space, positive in tension", |b| b.stress),
    ("pressure", "Pa", "pressure over space", |b| b.pressure),
    ("u_x", "m/s", "velocity relative to the undisturbed medium", |b| b.velocity),
    ("e", "J/kg", "specific internal energy", |b| b.internal_energy),
    ("k", "J/kg", "kinetic energy of the motion relative to the mean", |b| b.fluctuation_energy),
    ("q", "W/m2", "energy flux of the motion relative to the mean: sound, jets", |b| {
        b.fluctuation_energy_flux
    }),
];

/// Columns of the front's way: time, swept length, u_s of each cell.
const HISTORY: [Number<(f64, f64, f64)>; 3] = [
    ("time", "s", "when the front left the cell", |c| c.0),
    ("swept", "m", "length of the medium that the front has swept", |c| c.1),
    ("u_s", "m/s", "shock velocity over the cell", |c| c.2),
];

/// Names of all materials.
fn material_names(case: &Case) -> String {
    case.materials().iter().map(|m| m.name.clone()).collect::<Vec<_>>().join(" + ")
}

fn behind(outcome: &PointOutcome, value: fn(&MeanState) -> f64) -> f64 {
    outcome.states.map_or(f64::NAN, |s| value(&s.behind))
}

pub(super) fn add<Row>(table: Table, columns: &[Number<Row>], rows: &[&Row]) -> Table {
    columns.iter().fold(table, |table, (name, unit, text, value)| {
        table.with(Column::float(name, unit, text, rows.iter().map(|r| value(r)).collect::<Vec<_>>()))
    })
}

/// The table of all points: one row each, in the order of u_p.
pub fn hugoniot(case: &Case, sample: &Sample, outcomes: &[&PointOutcome]) -> Table {
    let title = format!(
        "Shock Hugoniot of {}: {}, porosity {:.5}, D = {:e} m",
        case.name,
        material_names(case),
        sample.porosity,
        case.medium.particle_size
    );
    let whole = |name: &str, text: &str, value: fn(&PointOutcome) -> i64| {
        Column::integer(name, "", text, outcomes.iter().map(|o| value(o)).collect::<Vec<_>>())
    };
    let status: Vec<String> = outcomes.iter().map(|o| o.status.to_string()).collect();
    let table = add(Table::new(title), &MEASURED, outcomes)
        .with(whole("averaged_cells", "cells that u_s is averaged over", |o| o.averaged_cells as i64))
        .with(whole("steps", "steps made", |o| o.steps as i64))
        .with(whole("particles", "particles in the window at the end", |o| o.particles as i64));
    let pores = |o: &PointOutcome| o.states.map_or_else(String::new, |s| s.zone().to_string());
    super::monitors::with_worst(add(table, &SPENT, outcomes), outcomes)
        .with(Column::text(
            "pores",
            "open or shut behind",
            outcomes.iter().map(|o| pores(o)).collect::<Vec<_>>(),
        ))
        .with(Column::text(
            "precursor",
            "read, or why not",
            outcomes.iter().map(|o| precursor(o)).collect::<Vec<_>>(),
        ))
        .with(Column::text("status", "how the point ended", status))
}

/// Whether the precursor could be read, and why not.
fn precursor(outcome: &PointOutcome) -> String {
    match (&outcome.precursor, &outcome.precursor_missing) {
        (Some(_), _) => "read".to_owned(),
        (None, Some(reason)) => reason.clone(),
        (None, None) => "the point did not start".to_owned(),
    }
}

/// The averaged profile of a point.
pub fn profile(outcome: &PointOutcome) -> Table {
    let title =
        format!("Averaged profile at u_p = {} m/s in the frame of the front", outcome.particle_velocity);
    add(Table::new(title), &PROFILE, &outcome.profile.iter().collect::<Vec<_>>())
}

/// u_s over each cell that the front of a point swept.
pub fn history(outcome: &PointOutcome) -> Table {
    let title = format!("Way of the front at u_p = {} m/s, cell by cell", outcome.particle_velocity);
    add(Table::new(title), &HISTORY, &outcome.cell_velocities.iter().collect::<Vec<_>>())
}
