//! The table of all points, and the tables of one.

use sph_io::table::{Column, Table};

use crate::config::Case;
use crate::microstructure::Sample;
use crate::outcome::PointOutcome;

/// The table of all points: one row each, in the order of u_p.
pub fn hugoniot(case: &Case, sample: &Sample, outcomes: &[&PointOutcome]) -> Table {
    let title = format!(
        "Shock Hugoniot of {}: {}, porosity {:.5}, D = {:e} m",
        case.name, case.material.name, sample.porosity, case.medium.particle_size
    );
    let float = |name: &str, unit: &str, text: &str, value: &dyn Fn(&PointOutcome) -> f64| {
        Column::float(name, unit, text, outcomes.iter().map(|o| value(o)).collect::<Vec<_>>())
    };
    let whole = |name: &str, text: &str, value: &dyn Fn(&PointOutcome) -> u64| {
        Column::integer(name, "", text, outcomes.iter().map(|o| value(o) as i64).collect::<Vec<_>>())
    };
    let behind = |o: &PointOutcome, f: fn(&crate::observe::MeanState) -> f64| {
        o.states.map_or(f64::NAN, |s| f(&s.behind))
    };
    let ahead = |o: &PointOutcome, f: fn(&crate::observe::MeanState) -> f64| {
        o.states.map_or(f64::NAN, |s| f(&s.ahead))
    };
    Table::new(title)
        .with(float("u_p", "m/s", "particle velocity behind the front, imposed", &|o| o.particle_velocity))
        .with(float(
            "u_s",
            "m/s",
            "shock velocity relative to the medium ahead, from the front's way",
            &|o| o.shock_velocity,
        ))
        .with(float("u_s_error", "m/s", "standard error of u_s over whole cells, batch means", &|o| {
            o.standard_error
        }))
        .with(float("u_s_mass", "m/s", "shock velocity from the mass of the plateau", &|o| {
            o.mass_balance_velocity
        }))
        .with(float("stress_jump", "Pa", "rise of -sigma_xx across the compaction wave", &|o| {
            o.states.map_or(f64::NAN, |s| s.stress_jump())
        }))
        .with(float("sigma_hel", "Pa", "-sigma_xx between precursor and compaction wave", &|o| {
            ahead(o, |s| -s.stress)
        }))
        .with(float("rho_packing", "kg/m3", "density behind: mass per volume of space", &|o| {
            behind(o, |s| s.packing_density)
        }))
        .with(float("rho_own", "kg/m3", "density behind: as the particles carry it", &|o| {
            behind(o, |s| s.own_density)
        }))
        .with(float("packing_over_own", "", "rho_packing / rho_own: below 1 with open pores", &|o| {
            behind(o, |s| s.packing_density / s.own_density)
        }))
        .with(float("residual_mass", "", "miss of the jump condition of mass", &|o| {
            o.residuals.map_or(f64::NAN, |r| r.mass)
        }))
        .with(float("residual_momentum", "", "miss of the jump condition of momentum", &|o| {
            o.residuals.map_or(f64::NAN, |r| r.momentum)
        }))
        .with(float("residual_energy", "", "miss of the jump condition of energy", &|o| {
            o.residuals.map_or(f64::NAN, |r| r.energy)
        }))
        .with(float("u_p_effective", "m/s", "u_p that the ends of the window imposed", &|o| {
            o.effective_particle_velocity
        }))
        .with(float("fed_cells", "", "cells of the medium fed", &|o| o.fed_cells))
        .with(whole("averaged_cells", "cells that u_s is averaged over", &|o| o.averaged_cells as u64))
        .with(whole("steps", "steps made", &|o| o.steps))
        .with(whole("particles", "particles in the window at the end", &|o| o.particles as u64))
        .with(float("particle_steps_per_second", "1/s", "particles advanced in a second", &|o| {
            o.particle_steps_per_second()
        }))
        .with(float("ledger_residual", "", "gap of the ledger of mass, momentum and energy", &|o| {
            o.ledger_residual
        }))
        .with(float("wall_time", "s", "time that the point took", &|o| o.wall_seconds))
        .with(Column::text(
            "status",
            "how the point ended",
            outcomes.iter().map(|o| o.status.to_string()).collect::<Vec<_>>(),
        ))
}

/// The averaged profile of a point.
pub fn profile(outcome: &PointOutcome) -> Table {
    let float = |name: &str, unit: &str, text: &str, value: &dyn Fn(&crate::observe::Bin) -> f64| {
        Column::float(name, unit, text, outcome.profile.iter().map(value).collect::<Vec<_>>())
    };
    Table::new(format!(
        "Averaged profile at u_p = {} m/s in the frame of the front",
        outcome.particle_velocity
    ))
    .with(float("xi", "m", "distance from the front, positive ahead", &|b| b.place))
    .with(float("rho_packing", "kg/m3", "mass per volume of space", &|b| b.packing_density))
    .with(float("rho_own", "kg/m3", "density as the particles carry it", &|b| b.own_density))
    .with(float("sigma_xx", "Pa", "longitudinal stress over space, positive in tension", &|b| b.stress))
    .with(float("pressure", "Pa", "pressure over space", &|b| b.pressure))
    .with(float("u_x", "m/s", "velocity relative to the undisturbed medium", &|b| b.velocity))
    .with(float("e", "J/kg", "specific internal energy", &|b| b.internal_energy))
    .with(float("k", "J/kg", "kinetic energy of the motion relative to the mean", &|b| b.fluctuation_energy))
}

/// u_s over each cell that the front of a point swept.
pub fn history(outcome: &PointOutcome) -> Table {
    let float = |name: &str, unit: &str, text: &str, value: &dyn Fn(&(f64, f64, f64)) -> f64| {
        Column::float(name, unit, text, outcome.cell_velocities.iter().map(value).collect::<Vec<_>>())
    };
    Table::new(format!("Way of the front at u_p = {} m/s, cell by cell", outcome.particle_velocity))
        .with(float("time", "s", "when the front left the cell", &|c| c.0))
        .with(float("swept", "m", "length of the medium that the front has swept", &|c| c.1))
        .with(float("u_s", "m/s", "shock velocity over the cell", &|c| c.2))
}
