//! The history of each point.

use sph_io::plot::{Axis, Figure, Series};

use crate::outcome::PointOutcome;

/// u_s over each cell that the front swept, and its mean over the cells that count.
pub fn history(outcome: &PointOutcome, cell: f64) -> Figure {
    let swept: Vec<f64> = outcome.cell_velocities.iter().map(|c| c.1 / cell).collect();
    let velocity: Vec<f64> = outcome.cell_velocities.iter().map(|c| c.2).collect();
    let title = format!("u_p = {} m/s: u_s cell by cell", outcome.particle_velocity);
    let figure = Figure::new(title, Axis::new("cells swept by the front"), Axis::new("u_s [m/s]"))
        .with(Series::line_with_points("one cell", &swept, &velocity));
    let last = swept.len();
    let first = last.saturating_sub(outcome.averaged_cells);
    if outcome.averaged_cells < 2 || !outcome.shock_velocity.is_finite() {
        return figure;
    }
    let label = format!("mean {:.1} ± {:.1}", outcome.shock_velocity, outcome.standard_error);
    figure.with(Series::dashed(&label, &[swept[first], swept[last - 1]], &[outcome.shock_velocity; 2]))
}
