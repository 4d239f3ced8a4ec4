//! The pictures: u_s(u_p) beside theory and what was published, and profile, history and fields of each point.

use sph_io::field_image::{ColorMap, Field, FieldImage};
use sph_io::plot::{Axis, Figure, Panel, Series};
use sph_materials::hugoniot;
use sph_materials::porous::{PorousMedium, Precursor};

use crate::config::Case;
use crate::microstructure::Sample;
use crate::outcome::PointOutcome;
use crate::reference;

/// Longest strip of a field image, in heights of the cell.
const LONGEST_STRIP: f64 = 16.0;
/// Microns in a meter.
const MICRO: f64 = 1e6;
/// Pascals in a gigapascal.
const GIGA: f64 = 1e9;

/// u_s(u_p) of all points beside the published fit and the jump conditions of shut pores.
pub fn shock_velocities(case: &Case, sample: &Sample, outcomes: &[&PointOutcome]) -> Figure {
    let measured = measured(outcomes);
    let title = format!("{}, m = {:.3}", case.name, sample.porosity);
    let mut figure =
        Figure::new(title, Axis::new("u_p [m/s]"), Axis::new("u_s [m/s]")).with(measured_series(&measured));
    let speeds = range_of(outcomes);
    if reference::is_published_medium(case) {
        let inside: Vec<f64> = speeds.iter().copied().filter(|&u| u <= reference::LIMIT).collect();
        let fit: Vec<f64> = inside.iter().map(|&u| reference::published_fit(u)).collect();
        figure = figure.with(Series::line("published fit (2024)", &inside, &fit));
    }
    if let Some((u_p, u_s)) = shut_pores(case, sample, outcomes, &speeds) {
        figure = figure.with(Series::dashed("pores shut: jump conditions", &u_p, &u_s));
    }
    figure
}

/// The same on a logarithmic axis, with the solid's own Hugoniot.
pub fn with_solid(case: &Case, sample: &Sample, outcomes: &[&PointOutcome]) -> Figure {
    let speeds = range_of(outcomes);
    let solid: Vec<f64> = speeds
        .iter()
        .map(|&u| hugoniot::principal(&case.material, u).map_or(f64::NAN, |jump| jump.shock_velocity()))
        .collect();
    let mut figure = shock_velocities(case, sample, outcomes);
    figure.panels[0].y = Axis::log("u_s [m/s]");
    figure.with(Series::dotted("solid, without pores", &speeds, &solid))
}

/// (u_p, u_s, error) of the points that have a u_s.
fn measured(outcomes: &[&PointOutcome]) -> Vec<(f64, f64, f64)> {
    let good = outcomes.iter().filter(|o| o.shock_velocity.is_finite());
    good.map(|o| (o.effective_particle_velocity, o.shock_velocity, o.standard_error)).collect()
}

fn measured_series(points: &[(f64, f64, f64)]) -> Series {
    let column = |f: fn(&(f64, f64, f64)) -> f64| points.iter().map(f).collect::<Vec<_>>();
    let error = column(|p| if p.2.is_finite() { p.2 } else { 0.0 });
    Series::points("this run, standard error", &column(|p| p.0), &column(|p| p.1)).with_error(&error)
}

/// Values of u_p for the curves: the points' range, a little wider.
fn range_of(outcomes: &[&PointOutcome]) -> Vec<f64> {
    let speeds = outcomes.iter().map(|o| o.particle_velocity);
    let high = speeds.clone().fold(0.0, f64::max) * 1.08;
    let low = speeds.fold(f64::INFINITY, f64::min) * 0.8;
    (0..=120).map(|k| low + (high - low) * f64::from(k) / 120.0).collect()
}

/// Jump conditions of shut pores behind the measured precursor stress, without mean deviator.
fn shut_pores(
    case: &Case,
    sample: &Sample,
    outcomes: &[&PointOutcome],
    speeds: &[f64],
) -> Option<(Vec<f64>, Vec<f64>)> {
    let stresses: Vec<f64> = outcomes.iter().filter_map(|o| o.states).map(|s| -s.ahead.stress).collect();
    let stress = if stresses.is_empty() { 0.0 } else { crate::statistics::mean(&stresses).max(0.0) };
    let medium =
        PorousMedium::with_porosity(&case.material, sample.porosity, Precursor::Standing { stress }).ok()?;
    let point = |&u: &f64| Some((u, medium.shock_velocity_range(u).ok()?.lower));
    Some(speeds.iter().filter_map(point).unzip())
}

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
