//! Tables of what was watched: each row of a point, and the worst of each point beside its results.

use sph_io::table::{Column, Table};
use sph_riemann::Interventions;

use super::table::{Number, add};
use crate::monitor::{MonitorRow, Worst};
use crate::outcome::PointOutcome;

/// Columns of a point's monitors.
const ROW: [Number<MonitorRow>; 14] = [
    ("time", "s", "when the front left the cell", |r| r.time),
    ("swept", "m", "length of the medium that the front has swept", |r| r.swept),
    ("momentum_gap", "", "gap of the books of momentum, of all that was booked", |r| r.momentum_gap),
    ("energy_gap", "", "gap of the books of energy, of all that was booked", |r| r.energy_gap),
    (
        "e_largest_over_mean",
        "",
        "largest specific internal energy of a free particle over the mean behind the front",
        |r| r.energy_largest_over_mean,
    ),
    ("e_least", "J/kg", "least specific internal energy of a free particle", |r| r.energy_least),
    ("packing_over_own", "", "density of the packing over the particles' own, behind the front now", |r| {
        r.packing_over_own
    }),
    (
        "relaxation_share",
        "",
        "virtual work of volume consistency since the start over the shock's energy input",
        |r| r.relaxation_share,
    ),
    ("failed_share", "", "share of particles that are failed in tension", |r| r.failed_share),
    ("floored_share", "", "share of particles whose sound speed stands at its floor", |r| r.floored_share),
    ("time_step_least", "s", "shortest step since the row before", |r| r.time_step_least),
    ("time_step_mean", "s", "mean step since the row before", |r| r.time_step_mean),
    ("limiting_c_l", "m/s", "sound speed of the particle that limited the shortest step", |r| {
        r.limiting_sound_speed
    }),
    ("limiting_u_rel", "m/s", "its largest speed relative to a neighbor", |r| r.limiting_relative_speed),
];

/// Columns of the worst of a point.
const WORST: [Number<Worst>; 8] = [
    ("momentum_gap", "", "largest gap of the books of momentum, of all that was booked", |w| w.momentum_gap),
    ("energy_gap", "", "largest gap of the books of energy, of all that was booked", |w| w.energy_gap),
    (
        "e_largest_over_mean",
        "",
        "largest specific internal energy of a free particle over the mean behind the front",
        |w| w.energy_largest_over_mean,
    ),
    ("e_least", "J/kg", "least specific internal energy of a free particle", |w| w.energy_least),
    ("relaxation_share", "", "virtual work of volume consistency over the shock's energy input", |w| {
        w.relaxation_share
    }),
    ("failed_share", "", "largest share of particles failed in tension", |w| w.failed_share),
    ("floored_share", "", "largest share of particles whose sound speed stands at its floor", |w| {
        w.floored_share
    }),
    ("time_step_least", "s", "shortest step", |w| w.time_step_least),
];

/// What acted up to a moment: bounds of the scheme, and boosts of the frame that were bounded.
#[derive(Clone, Copy, Debug, Default)]
struct Acted {
    interventions: Interventions,
    boosts_bounded: u64,
}

impl From<&MonitorRow> for Acted {
    fn from(row: &MonitorRow) -> Self {
        Self { interventions: row.interventions, boosts_bounded: row.boosts_bounded }
    }
}

impl From<Worst> for Acted {
    fn from(worst: Worst) -> Self {
        Self { interventions: worst.interventions, boosts_bounded: worst.boosts_bounded }
    }
}

/// A count: name, description, whether it counts particle-steps, and how it is read.
type Count = (&'static str, &'static str, bool, fn(&Acted) -> u64);

/// What acted, with what is counted.
const COUNTS: [Count; 4] = [
    ("inverse_capped", "particle-steps with the inverse of L at its cap: free surfaces", true, |a| {
        a.interventions.inverse_capped
    }),
    ("relaxation_bounded", "particle-steps with the relaxation of the volume at its bound", true, |a| {
        a.interventions.relaxation_bounded
    }),
    ("failures", "times that a particle failed in tension", true, |a| a.interventions.failures),
    (
        "boosts_bounded",
        "boosts of the frame that were bounded: the outlet would have moved into the box",
        false,
        |a| a.boosts_bounded,
    ),
];

/// The table with a column for each count at its right; `ending` follows each description.
fn with_counts(table: Table, acted: &[Acted], ending: &str) -> Table {
    COUNTS.iter().fold(table, |table, (name, text, _, value)| {
        let counts: Vec<i64> = acted.iter().map(|a| value(a) as i64).collect();
        table.with(Column::integer(name, "", &format!("{text}{ending}"), counts))
    })
}

/// What was watched of a point, a row for each cell that the front swept.
pub fn table(outcome: &PointOutcome) -> Table {
    let title =
        format!("Monitors at u_p = {} m/s, cell by cell of the front's way", outcome.particle_velocity);
    let rows: Vec<&MonitorRow> = outcome.monitors.iter().collect();
    let acted: Vec<Acted> = rows.iter().map(|row| Acted::from(*row)).collect();
    with_counts(add(Table::new(title), &ROW, &rows), &acted, ", since the start")
}

/// The table with the worst of each point at its right.
pub fn with_worst(table: Table, outcomes: &[&PointOutcome]) -> Table {
    let worst: Vec<Option<Worst>> = outcomes.iter().map(|o| o.worst()).collect();
    let table = WORST.iter().fold(table, |table, (name, unit, text, value)| {
        let values: Vec<f64> = worst.iter().map(|w| w.as_ref().map_or(f64::NAN, value)).collect();
        table.with(Column::float(name, unit, text, values))
    });
    let acted: Vec<Acted> = worst.iter().map(|w| w.map_or(Acted::default(), Acted::from)).collect();
    with_counts(table, &acted, "")
}

/// What bounded a value on the way, one line each; nothing acts in silence.
pub fn interventions(outcomes: &[&PointOutcome]) -> Vec<String> {
    let steps: u64 = outcomes.iter().map(|o| o.particle_steps).sum();
    let acted: Vec<Acted> = outcomes.iter().filter_map(|o| o.worst()).map(Acted::from).collect();
    let line = |(name, text, of_particle_steps, value): &Count| {
        let count: u64 = acted.iter().map(value).sum();
        let share = 100.0 * count as f64 / steps as f64;
        // Below a hundredth of a percent only the power of ten is of interest.
        let share = if share < 0.01 { format!("{share:.0e}") } else { format!("{share:.2}") };
        let share =
            if *of_particle_steps { format!(" ({share} % of all particle-steps)") } else { String::new() };
        (count > 0).then(|| format!("{name}: {count}{share}: {text}"))
    };
    let mut lines: Vec<String> = COUNTS.iter().filter_map(line).collect();
    let floored = outcomes.iter().filter_map(|o| o.worst()).map(|w| w.floored_share).fold(0.0, f64::max);
    if floored > 0.0 {
        lines.push(format!(
            "sound speed at its floor: {:.3} % of the particles at worst: states so far out in expansion that the equation \
             of state gives no sound speed",
            100.0 * floored
        ));
    }
    lines.extend(outcomes.iter().filter(|o| o.series.is_full()).map(|o| {
        let (n, megabytes) = (o.series.len(), o.series.bytes() as f64 / 1e6);
        let u_p = o.particle_velocity;
        format!("u_p = {u_p} m/s: limit_mb met after {n} moments for ParaView, {megabytes:.1} MB; later ones are left out")
    }));
    lines
}
