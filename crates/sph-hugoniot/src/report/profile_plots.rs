//! Profile and fields of a point.
//!
//! The averaged profiles are drawn as the source's figure 9 has them: the mean of many moments as a solid line, single
//! moments dashed. The fields are those of its figure 7, with plastic strain and slip beside them.

use sph_io::Color;
use sph_io::field_image::{ColorMap, Field, FieldImage};
use sph_io::plot::{Axis, Figure, Panel, Series};

use crate::observe::Bin;
use crate::outcome::PointOutcome;

/// Longest strip of a field image, in heights of the cell.
const LONGEST_STRIP: f64 = 16.0;
/// Single moments that are drawn.
const MOMENTS: usize = 1;
/// Microns in a meter.
const MICRO: f64 = 1e6;
/// Joules in a kilojoule.
const KILO: f64 = 1e3;
/// Pascals in a gigapascal.
const GIGA: f64 = 1e9;

/// Color of single moments.
const MOMENT_COLOR: Color = Color::rgb(180, 180, 180);

/// A quantity of a bin, in the unit of its axis.
type Quantity = fn(&Bin) -> f64;

fn column(bins: &[Bin], value: impl Fn(&Bin) -> f64) -> Vec<f64> {
    bins.iter().map(value).collect()
}

/// Single moments of a quantity, dashed and thin beside the mean.
fn with_moments(mut panel: Panel, outcome: &PointOutcome, value: Quantity) -> Panel {
    let moments = &outcome.snapshots;
    for (k, bins) in moments.iter().rev().take(MOMENTS).enumerate() {
        let (place, values) = (column(bins, |b| b.place * MICRO), column(bins, value));
        let label = if k == 0 { "one moment" } else { "" };
        panel = panel.with(Series::dashed(label, &place, &values).with_color(MOMENT_COLOR));
    }
    panel
}

/// Averaged profile of a point: density (packing and own), -σ_xx and P, u_x, specific internal energy over the distance
/// from the front; dashed what the jump condition of energy asks of e behind.
pub fn profile(outcome: &PointOutcome) -> Figure {
    let bins = &outcome.profile;
    let place = column(bins, |b| b.place * MICRO);
    let title = format!(
        "u_p = {} m/s, mean of {} moments over {} cells",
        outcome.particle_velocity, outcome.profile_looks, outcome.averaged_cells
    );
    let (density, stress, velocity): (Quantity, Quantity, Quantity) =
        (|b| b.packing_density / 1e3, |b| -b.stress / GIGA, |b| b.velocity);
    let panel = |label: &str, value: Quantity| with_moments(Panel::new(Axis::new(label)), outcome, value);
    Figure::stacked(title, Axis::new("x − x_{front} [µm]"))
        .with_panel(
            panel("ρ [g/cm^3]", density)
                .with(Series::line("packing", &place, &column(bins, density)))
                .with(Series::line("particles' own", &place, &column(bins, |b| b.own_density / 1e3))),
        )
        .with_panel(
            panel("stress [GPa]", stress)
                .with(Series::line("−σ_{xx}", &place, &column(bins, stress)))
                .with(Series::line("P", &place, &column(bins, |b| b.pressure / GIGA))),
        )
        .with_panel(panel("u_x [m/s]", velocity).with(Series::line("mean", &place, &column(bins, velocity))))
        .with_panel(energy_panel(outcome, &place))
}

/// Specific internal energy, with that of the motion about the mean, and what the jump condition asks for behind:
/// e_a + ½(Σ_a + Σ_b)(1/ρ_a - 1/ρ_b).
fn energy_panel(outcome: &PointOutcome, place: &[f64]) -> Panel {
    let (internal, with_motion): (Quantity, Quantity) =
        (|b| b.internal_energy / KILO, |b| (b.internal_energy + b.fluctuation_energy) / KILO);
    let panel = Panel::new(Axis::new("e [kJ/kg]"))
        .with(Series::line("internal", place, &column(&outcome.profile, internal)))
        .with(Series::line("with motion about the mean", place, &column(&outcome.profile, with_motion)));
    let (Some(states), Some(&first)) = (outcome.states, place.first()) else { return panel };
    let volume_loss = 1.0 / states.ahead.packing_density - 1.0 / states.behind.packing_density;
    let gain = -0.5 * (states.ahead.stress + states.behind.stress) * volume_loss;
    let asked = (states.ahead.internal_energy + gain) / KILO;
    panel.with(Series::dashed("jump condition", &[first, 0.0], &[asked, asked]))
}

/// The last moment of a point: own density, σ_xx, u_x, plastic strain and slip of each particle.
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
        .with_field(Field::new("plastic strain", fields.plastic_strain.clone(), ColorMap::Heat))
        .with_field(Field::new("slip [m/s]", fields.slip.clone(), ColorMap::Heat))
        .with_periods(2)
        .with_strips((length / height / LONGEST_STRIP).ceil().max(1.0) as usize)
}
