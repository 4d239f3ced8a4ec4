//! What other programs take over: the fits, the P-α parameters, and the schema of the tables.
//!
//! ```text
//! curve/fits.csv, fits.json           parameters, errors, covariance, χ²
//! curve/p_alpha.txt, p_alpha.json     crush curve of Jutzi's quadratic form, with how it was fitted and what it misses
//! curve/table.schema.json             JSON schema of hugoniot.json, curve.json and fits.json's table form
//! ```

use std::fmt::Write;
use std::path::Path;

use anyhow::Result;
use serde_json::{Value, json};
use sph_io::table::{Column, Table};

use super::curves::Curves;
use crate::curve::crush::Calibration;
use crate::curve::fit::Fit;

/// JSON schema of the tables that a run writes.
pub const TABLE_SCHEMA: &str = include_str!("table.schema.json");
/// A gigapascal [Pa].
const GIGA: f64 = 1e9;

/// Writes the exports into a folder.
///
/// # Errors
/// If a file cannot be written.
pub fn write(curves: &Curves<'_>, folder: &Path) -> Result<()> {
    let text = |name: &str, text: &str| sph_io::write_atomic(folder.join(name), text.as_bytes());
    text("table.schema.json", TABLE_SCHEMA)?;
    text("fits.json", &format!("{:#}\n", fits_json(curves)))?;
    fits_table(curves).write_csv(folder.join("fits.csv"))?;
    if let Some(block) = p_alpha_text(curves) {
        text("p_alpha.txt", &block)?;
        text("p_alpha.json", &format!("{:#}\n", p_alpha_json(curves)))?;
    }
    Ok(())
}

fn fits_json(curves: &Curves<'_>) -> Value {
    let one = |fit: &Fit| {
        let names: Vec<&str> = fit.form.parameters().iter().map(|p| p.0).collect();
        let mut value = serde_json::to_value(fit).unwrap_or_default();
        value["parameters"] = json!(names);
        value["units"] = json!(fit.form.parameters().iter().map(|p| p.1).collect::<Vec<_>>());
        value
    };
    json!({ "case": curves.case.name, "fits": curves.fits.iter().map(one).collect::<Vec<_>>() })
}

/// One row a parameter.
fn fits_table(curves: &Curves<'_>) -> Table {
    let rows: Vec<(&Fit, usize)> =
        curves.fits.iter().flat_map(|f| (0..f.values.len()).map(move |k| (f, k))).collect();
    let words = |name: &str, text: &str, f: &dyn Fn(&Fit, usize) -> String| {
        Column::text(name, text, rows.iter().map(|(fit, k)| f(fit, *k)).collect::<Vec<_>>())
    };
    let floats = |name: &str, text: &str, f: &dyn Fn(&Fit, usize) -> f64| {
        Column::float(name, "", text, rows.iter().map(|(fit, k)| f(fit, *k)).collect::<Vec<_>>())
    };
    Table::new(format!("{}: fits of u_s(u_p)", curves.case.name))
        .with(words("fit", "form", &|f, _| f.form.name().into()))
        .with(words("parameter", "name", &|f, k| f.form.parameters()[k].0.into()))
        .with(words("unit", "of value and error", &|f, k| f.form.parameters()[k].1.into()))
        .with(floats("value", "in its unit", &|f, k| f.values[k]))
        .with(floats(
            "error",
            "standard error in its unit, widened where the scatter asks for it",
            &|f, k| f.errors[k],
        ))
        .with(floats("chi_squared", "with the errors of the points as given", &|f, _| f.chi_squared))
        .with(floats("degrees_of_freedom", "points less parameters", &|f, _| f.degrees_of_freedom as f64))
        .with(floats("widened_by", "factor of the errors", &|f, _| f.widened_by))
}

/// Misfits of u_s that P-α leaves at the points [-].
fn misfits(curves: &Curves<'_>, calibration: &Calibration) -> Vec<f64> {
    let predicted = curves.predicted(Some(calibration));
    predicted
        .iter()
        .zip(&curves.curve.points)
        .map(|(p, point)| p / point.shock_velocity.value - 1.0)
        .collect()
}

/// Greatest misfit of u_s over the points that P-α has a wave for [-].
fn worst(misfits: &[f64]) -> f64 {
    misfits
        .iter()
        .copied()
        .filter(|m| m.is_finite())
        .fold(0.0, |worst: f64, m| if m.abs() > worst.abs() { m } else { worst })
}

/// One line of a calibration.
pub fn sentence(curves: &Curves<'_>, c: &Calibration) -> String {
    format!(
        "P-α, n = 2: P_e = ({:.3} ± {:.3}) GPa, P_s = ({:.3} ± {:.3}) GPa, α_0 = {:.5}; α missed by {:.4}, u_s by {:.1} % at most",
        c.curve.elastic_pressure / GIGA,
        c.elastic_pressure_error / GIGA,
        c.curve.solid_pressure / GIGA,
        c.solid_pressure_error / GIGA,
        c.curve.initial_distension,
        c.misfit,
        100.0 * worst(&misfits(curves, c))
    )
}

/// The block of parameters for people and input files; `None` without a calibration.
pub fn p_alpha_text(curves: &Curves<'_>) -> Option<String> {
    let c = curves.quadratic.as_ref()?;
    let mut out = String::new();
    let mut line = |text: String| _ = writeln!(out, "{text}");
    line(format!("# P-alpha parameters of {}, {}", curves.case.name, curves.case.material.name));
    line(
        "# alpha(P) = 1 + (alpha_0 - 1) ((P_s - P)/(P_s - P_e))^2 for P_e < P < P_s; alpha_0 below, 1 above"
            .into(),
    );
    line("# Form: M. Jutzi, W. Benz & P. Michel, Icarus 198 (2008) 242-255.".into());
    line("# P: -sigma_xx behind the compaction wave, precursor included (not the mean pressure). alpha: density of the".into());
    line("# solid at that stress over the density behind. Both by the jump conditions from u_s(u_p).".into());
    line(format!(
        "# Fit: least squares in alpha over {} points with open and {} with shut pores, all alike; errors from the misfit.",
        c.open.len(),
        c.shut.len()
    ));
    line(format!("rho_solid    = {:<12} # kg/m3", curves.case.material.reference_density));
    line(format!("alpha_0      = {:<12.6} # exact: porosity of the sample", c.curve.initial_distension));
    line(format!(
        "P_e          = {:<12.4e} # Pa, +- {:.1e}",
        c.curve.elastic_pressure, c.elastic_pressure_error
    ));
    line(format!("P_s          = {:<12.4e} # Pa, +- {:.1e}", c.curve.solid_pressure, c.solid_pressure_error));
    line(format!(
        "# sigma_HEL measured: {:.4e} Pa; root mean square misfit of alpha: {:.4}",
        curves.curve.precursor_stress, c.misfit
    ));
    if c.curve.elastic_pressure < curves.curve.precursor_stress {
        line("# P_e lies below sigma_HEL: the form cannot start at the measured precursor and follow the points.".into());
    }
    if let Some((free, error)) = curves.free.as_ref().and_then(|f| Some((f, f.exponent_error?))) {
        line(format!(
            "# With the exponent free: n = {:.2} +- {:.2}, P_e = {:.4e} Pa, P_s = {:.4e} Pa, misfit {:.4}",
            free.curve.exponent, error, free.curve.elastic_pressure, free.curve.solid_pressure, free.misfit
        ));
    }
    line("# u_p [m/s]   u_s of the run [m/s]   u_s of P-alpha [m/s]   difference [%]".into());
    for (point, (predicted, misfit)) in
        curves.curve.points.iter().zip(curves.predicted(Some(c)).iter().zip(misfits(curves, c)))
    {
        line(format!(
            "# {:10.1} {:22.1} {:22.1} {:16.2}",
            point.particle_velocity,
            point.shock_velocity.value,
            predicted,
            100.0 * misfit
        ));
    }
    Some(out)
}

fn p_alpha_json(curves: &Curves<'_>) -> Value {
    let with_misfit = |c: &Calibration| {
        let mut value = serde_json::to_value(c).unwrap_or_default();
        value["predicted_u_s"] = json!(curves.predicted(Some(c)));
        value["relative_misfit_of_u_s"] = json!(misfits(curves, c));
        value
    };
    json!({
        "case": curves.case.name,
        "form": "alpha = 1 + (alpha_0 - 1) ((P_s - P)/(P_s - P_e))^n",
        "source": "M. Jutzi, W. Benz & P. Michel, Icarus 198 (2008) 242-255",
        "pressure": "-sigma_xx behind the compaction wave, precursor included",
        "units": "SI",
        "solid_density": curves.solid_density,
        "precursor_stress": curves.curve.precursor_stress,
        "u_p": curves.curve.points.iter().map(|p| p.particle_velocity).collect::<Vec<_>>(),
        "u_s": curves.curve.points.iter().map(|p| p.shock_velocity.value).collect::<Vec<_>>(),
        "quadratic": curves.quadratic.as_ref().map(with_misfit),
        "free_exponent": curves.free.as_ref().map(with_misfit),
    })
}
