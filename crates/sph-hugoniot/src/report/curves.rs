//! The Hugoniot of a run with all that is laid beside it: fits, theory, calibrated crush curves, measured data.

use anyhow::Result;
use sph_io::table::{Column, Table};
use sph_materials::porous::ShearBehind;

use super::{Report, export, planes};
use crate::config::Case;
use crate::config::case::DataSource;
use crate::curve::crush::{self, Calibration};
use crate::curve::fit::{ErrorSource, Fit, Form};
use crate::curve::measured::{self, DataError, DataSet};
use crate::curve::points::{Curve, CurvePoint};
use crate::curve::theory::{Theory, TheoryCurve};
use crate::microstructure::Sample;
use crate::outcome::PointOutcome;

/// Everything of a curve.
#[derive(Debug)]
pub struct Curves<'c> {
    /// The case.
    pub case: &'c Case,
    /// The points.
    pub curve: Curve,
    /// Theory of the medium.
    pub theory: Theory<'c>,
    /// The fits that the points determine.
    pub fits: Vec<Fit>,
    /// P-α with n = 2.
    pub quadratic: Option<Calibration>,
    /// P-α with n fitted.
    pub free: Option<Calibration>,
    /// Measured points.
    pub data: &'c [DataSet],
    /// Whether Boade's powder is laid beside.
    pub with_boade: bool,
    /// Density ρ0 of the solid, the mean of all materials [kg/m³].
    pub solid_density: f64,
}

/// Reads the measured data that a case names.
///
/// # Errors
/// A file that cannot be read, or all that is wrong with it.
pub fn load_data(case: &Case) -> Result<Vec<DataSet>, DataError> {
    let files = case.data.iter().filter_map(|source| match source {
        DataSource::Boade1970 => None,
        DataSource::Csv { file, name } => Some(measured::load(file, name.as_deref())),
    });
    files.collect()
}

impl<'c> Curves<'c> {
    /// Fits and calibrates.
    pub fn new(case: &'c Case, sample: &Sample, outcomes: &[&PointOutcome], data: &'c [DataSet]) -> Self {
        let curves = Self::of(case, Curve::new(sample.bulk_density(), outcomes), data);
        Self { solid_density: sample.density, ..curves }
    }

    fn of(case: &'c Case, curve: Curve, data: &'c [DataSet]) -> Self {
        let theory = case.single_material().map_or_else(Theory::none, |solid| {
            Theory::new(solid, curve.bulk_density, curve.precursor_stress)
        });
        let points = curve.to_fit();
        let fits = Form::ALL.iter().filter_map(|&form| Fit::new(form, &points)).collect();
        let calibrate = |n| crush::calibrate(&curve, theory.medium.as_ref()?, n);
        let (quadratic, free) = (calibrate(Some(2.0)), calibrate(None));
        let with_boade = case.data.contains(&DataSource::Boade1970);
        let solid_density = case.material.reference_density;
        Self { case, theory, fits, quadratic, free, data, with_boade, curve, solid_density }
    }

    /// The fit of a form, if the points determine it.
    pub fn fit(&self, form: Form) -> Option<&Fit> {
        self.fits.iter().find(|f| f.form == form)
    }

    /// m = ρ0/ρ00 of the sample [-].
    pub fn theory_porosity(&self) -> f64 {
        self.solid_density / self.curve.bulk_density
    }

    /// u_p of the theory's curves [m/s]: those of points and data, a little wider.
    pub fn speeds(&self, places: u32) -> Vec<f64> {
        let points = self.curve.points.iter().map(|p| p.particle_velocity);
        let data = self.data.iter().flat_map(|d| &d.points).map(|d| d.particle_velocity);
        let all: Vec<f64> = points.chain(data).collect();
        let high = 1.12 * all.iter().copied().fold(0.0, f64::max);
        let low = 0.4 * all.iter().copied().fold(f64::INFINITY, f64::min);
        (0..=places).map(|k| low + (high - low) * f64::from(k) / f64::from(places)).collect()
    }

    /// u_s of a theory at each point [m/s]; `NaN` where it has none.
    fn at_points(&self, states: impl Fn(&[f64]) -> TheoryCurve) -> Vec<f64> {
        let at =
            |p: &CurvePoint| states(&[p.particle_velocity]).first().map_or(f64::NAN, |s| s.shock_velocity);
        self.curve.points.iter().map(at).collect()
    }

    /// u_s that P-α with a calibration gives at each point [m/s].
    pub fn predicted(&self, calibration: Option<&Calibration>) -> Vec<f64> {
        match calibration {
            Some(c) => self.at_points(|u| self.theory.crushed(u, c.curve)),
            None => vec![f64::NAN; self.curve.points.len()],
        }
    }

    /// The points in all planes beside theory and fit.
    pub fn table(&self) -> Table {
        let points = &self.curve.points;
        let of = |name: &str, unit: &str, text: &str, f: &dyn Fn(&CurvePoint) -> f64| {
            Column::float(name, unit, text, points.iter().map(f).collect::<Vec<_>>())
        };
        let shut = |shear| self.at_points(|u| self.theory.shut_pores(u, shear));
        let fitted = |p: &CurvePoint| {
            self.fit(Form::TwoPiece).map_or(f64::NAN, |f| f.shock_velocity(p.particle_velocity))
        };
        let settled = |p: &CurvePoint| if p.settled { "settled" } else { "not settled" }.to_string();
        Table::new(format!("{}: the curve in all planes, by the jump conditions", self.case.name))
            .with(of("u_p", "m/s", "particle velocity behind the front", &|p| p.particle_velocity))
            .with(of("u_s", "m/s", "shock velocity", &|p| p.shock_velocity.value))
            .with(of("u_s_error", "m/s", "its standard error", &|p| p.shock_velocity.error))
            .with(of("sigma", "Pa", "-sigma_xx behind, sigma_HEL included", &|p| p.stress.value))
            .with(of("sigma_error", "Pa", "from the standard error of u_s", &|p| p.stress.error))
            .with(of("rho", "kg/m3", "density behind", &|p| p.density.value))
            .with(of("rho_error", "kg/m3", "from the standard error of u_s", &|p| p.density.error))
            .with(of("volume", "m3/kg", "volume of a kilogram behind", &|p| p.volume().value))
            .with(of("volume_error", "m3/kg", "from the standard error of u_s", &|p| p.volume().error))
            .with(of("sigma_profile", "Pa", "-sigma_xx behind in the averaged profile", &|p| {
                p.profile_stress
            }))
            .with(of("rho_profile", "kg/m3", "density behind in the averaged profile", &|p| {
                p.profile_density
            }))
            .with(of("two_piece_fit", "m/s", "u_s of the two-piece fit", &fitted))
            .with(Column::float(
                "shut_lower",
                "m/s",
                "u_s of shut pores, no deviator behind",
                shut(ShearBehind::None),
            ))
            .with(Column::float(
                "shut_upper",
                "m/s",
                "u_s of shut pores, deviator 2Y/3 behind",
                shut(ShearBehind::Yielded),
            ))
            .with(Column::float(
                "p_alpha",
                "m/s",
                "u_s of P-alpha with the calibrated quadratic crush curve",
                self.predicted(self.quadratic.as_ref()),
            ))
            .with(Column::text(
                "status",
                "only settled points are fitted",
                points.iter().map(settled).collect::<Vec<_>>(),
            ))
    }

    /// What the summary says of the fits and of P-α, one line each.
    pub fn lines(&self) -> Vec<String> {
        let mut lines: Vec<String> = self.fits.iter().map(sentence).collect();
        lines.extend(self.quadratic.as_ref().map(|c| export::sentence(self, c)));
        lines
    }

    /// Writes tables, exports and pictures into the folder of a run.
    ///
    /// # Errors
    /// If a file or the folder cannot be written.
    pub fn write(&self, report: &Report) -> Result<()> {
        let folder = report.folder().join("curve");
        std::fs::create_dir_all(&folder)?;
        self.table().write_csv(folder.join("curve.csv"))?;
        self.table().write_json(folder.join("curve.json"))?;
        export::write(self, &folder)?;
        for (plane, name) in planes::Plane::ALL {
            report.write_figure(&planes::plane(self, plane), name)?;
        }
        report.write_figure(&planes::with_solid(self), "hugoniot_with_solid")?;
        if self.fits.is_empty() { Ok(()) } else { report.write_figure(&planes::fits(self), "fits") }
    }
}

/// A fit as a formula with its errors and what they rest on.
pub fn sentence(fit: &Fit) -> String {
    let pm = |k: usize, digits: usize| format!("({:.digits$} ± {:.digits$})", fit.values[k], fit.errors[k]);
    let formula = match fit.form {
        Form::Linear => format!("u_s = {} m/s + {} u_p", pm(0, 1), pm(1, 3)),
        Form::Quadratic => {
            let (q, error) = (1e3 * fit.values[2], 1e3 * fit.errors[2]);
            format!("u_s = {} m/s + {} u_p + ({q:.3} ± {error:.3})e-3 s/m u_p²", pm(0, 1), pm(1, 3))
        }
        Form::TwoPiece => {
            let interval = fit.break_interval.map_or(String::new(), |(a, b)| format!(" [{a:.1}, {b:.1}]"));
            format!(
                "u_s = {} m/s + {} u_p to the break at {:.1}{interval} m/s, slope {} above",
                pm(0, 1),
                pm(1, 3),
                fit.values[2],
                pm(3, 3)
            )
        }
    };
    format!("{}: {formula}; {}", fit.form.name(), ground(fit))
}

/// What the errors of a fit rest on.
fn ground(fit: &Fit) -> String {
    let nu = fit.degrees_of_freedom;
    match (fit.error_source, fit.reduced_chi_squared) {
        (ErrorSource::Points, Some(reduced)) => format!("χ²/ν = {reduced:.2}, ν = {nu}"),
        (ErrorSource::Points, None) => "as many parameters as points: nothing is left to test it".into(),
        (ErrorSource::Widened, Some(reduced)) => format!(
            "χ²/ν = {reduced:.3e}, ν = {nu}: standard errors do not explain the scatter, errors widened by {:.1}",
            fit.widened_by
        ),
        (ErrorSource::Scatter, _) => format!("points without errors: from their scatter, ν = {nu}"),
        _ => "as many parameters as points without errors: errors unknown".into(),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::curve::measured::DataPoint;
    use crate::curve::points::tests::shipped;

    pub fn shipped_case() -> Case {
        let text = crate::template::text("porous-copper").unwrap();
        let mut case = crate::config::parse(text, "porous-copper.ron").unwrap();
        case.data = vec![DataSource::Boade1970];
        case
    }

    pub fn data() -> Vec<DataSet> {
        let point = |u_p: f64, u_s: f64| DataPoint {
            particle_velocity: u_p,
            shock_velocity: u_s,
            particle_velocity_error: 8.0,
            shock_velocity_error: 25.0,
            source: String::new(),
        };
        vec![DataSet { name: "made up".into(), points: vec![point(120.0, 480.0), point(260.0, 950.0)] }]
    }

    #[test]
    fn the_shipped_curve_is_drawn_in_all_planes_and_exported() {
        let (case, data, folder) = (shipped_case(), data(), tempfile::tempdir().unwrap());
        let curves = Curves::of(&case, shipped(), &data);
        let report = Report::create(folder.path(), &case, "").unwrap();
        report.write_curves(&curves).unwrap();
        let names =
            ["hugoniot", "hugoniot_with_solid", "stress_velocity", "stress_density", "stress_volume", "fits"];
        for file in names.iter().flat_map(|n| [format!("plots/{n}.svg"), format!("plots/{n}.png")]) {
            assert!(folder.path().join(&file).metadata().unwrap().len() > 5000, "{file}");
        }
        for file in [
            "curve.csv",
            "curve.json",
            "fits.csv",
            "fits.json",
            "p_alpha.txt",
            "p_alpha.json",
            "table.schema.json",
        ] {
            assert!(folder.path().join("curve").join(file).metadata().unwrap().len() > 300, "{file}");
        }
        let lines = curves.lines().join("\n");
        for part in
            ["linear: u_s = (", "quadratic: ", "two-piece: ", "to the break at 12", "P-α, n = 2: P_e = (0."]
        {
            assert!(lines.contains(part), "{part} is missing in\n{lines}");
        }
    }

    /// The block is read back as the numbers that it was made of.
    #[test]
    fn the_parameter_block_holds_the_calibrated_numbers() {
        let (case, curve) = (shipped_case(), shipped());
        let curves = Curves::of(&case, curve, &[]);
        let block = export::p_alpha_text(&curves).unwrap();
        let value = |name: &str| -> f64 {
            let line = block.lines().find(|l| l.starts_with(name)).unwrap();
            line.split(['=', '#']).nth(1).unwrap().trim().parse().unwrap()
        };
        let found = curves.quadratic.as_ref().unwrap().curve;
        for (name, wanted) in [
            ("P_e", found.elastic_pressure),
            ("P_s", found.solid_pressure),
            ("alpha_0", found.initial_distension),
        ] {
            assert!((value(name) / wanted - 1.0).abs() < 1e-4, "{name}: {} {wanted}", value(name));
        }
        assert_eq!(block.lines().filter(|l| l.starts_with("#  ")).count(), 8, "{block}");
    }

    #[test]
    fn without_settled_points_there_is_no_fit_and_still_a_curve() {
        let (case, mut curve) = (shipped_case(), shipped());
        curve.points.iter_mut().for_each(|p| p.settled = false);
        let curves = Curves::of(&case, curve, &[]);
        assert!(curves.fits.is_empty() && curves.quadratic.is_none() && curves.lines().is_empty());
        assert_eq!(curves.table().n_rows(), 8);
    }
}
