//! The pictures of each point: profile, history and fields.

use sph_io::field_image::{ColorMap, Field, FieldImage};
use sph_io::plot::{Axis, Figure, Panel, Series};

use crate::outcome::PointOutcome;

/// Longest strip of a field image, in heights of the cell.
const LONGEST_STRIP: f64 = 16.0;
/// Microns in a meter.
const MICRO: f64 = 1e6;
/// Pascals in a gigapascal.
const GIGA: f64 = 1e9;

/// Averaged profile of a point: density (packing and own), -σ_xx and P, u_x over the distance from the front.
pub fn profile(outcome: &PointOutcome) -> Figure {
    let column =
        |f: &dyn Fn(&crate::observe::Bin) -> f64| outcome.profile.iter().map(f).collect::<Vec<f64>>();
    let xi = column(&|b| b.place * MICRO);
    let title = format!("u_p = {} m/s, mean of {} cells", outcome.particle_velocity, outcome.averaged_cells);
    Figure::stacked(title, Axis::new("x − x_{front} [µm]"))
        .with_panel(
            Panel::new(Axis::new("ρ [g/cm^3]"))
                .with(Series::line("packing", &xi, &column(&|b| b.packing_density / 1e3)))
                .with(Series::dashed("particles' own", &xi, &column(&|b| b.own_density / 1e3))),
        )
        .with_panel(
            Panel::new(Axis::new("stress [GPa]"))
                .with(Series::line("−σ_{xx}", &xi, &column(&|b| -b.stress / GIGA)))
                .with(Series::dashed("P", &xi, &column(&|b| b.pressure / GIGA))),
        )
        .with_panel(Panel::new(Axis::new("u_x [m/s]")).with(Series::line("", &xi, &column(&|b| b.velocity))))
}

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

/// The last moment of a point: own density, σ_xx and u_x of each particle.
pub fn fields(outcome: &PointOutcome) -> FieldImage {
    let fields = &outcome.fields;
    let scaled = |values: &[f64], factor: f64| values.iter().map(|v| v * factor).collect::<Vec<_>>();
    let (length, height) = (fields.extent.0 * MICRO, fields.extent.1 * MICRO);
    let title = format!("u_p = {} m/s, t = {:.3} µs", outcome.particle_velocity, fields.time * MICRO);
    FieldImage::new(title, (0.0, length), (0.0, height))
        .with_particles(scaled(&fields.x, MICRO), scaled(&fields.y, MICRO), scaled(&fields.size, MICRO))
        .with_field(Field::new("ρ [g/cm^3]", scaled(&fields.density, 1e-3), ColorMap::Sequential))
        .with_field(Field::new("σ_{xx} [GPa]", scaled(&fields.stress, 1.0 / GIGA), ColorMap::Diverging))
        .with_field(Field::new("u_x [m/s]", fields.velocity.clone(), ColorMap::Heat))
        .with_periods(2)
        .with_strips((length / height / LONGEST_STRIP).ceil().max(1.0) as usize)
}
