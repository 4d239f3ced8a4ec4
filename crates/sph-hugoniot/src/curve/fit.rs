//! Fits of u_s(u_p): linear, quadratic, and two straight lines that meet at a break.
//!
//! | fit | u_s(u_p) | parameters |
//! |---|---|---|
//! | linear | c + s u | c, s |
//! | quadratic | c + s u + q u² | c, s, q |
//! | two-piece | c + s₁ u below the break b, c + s₁ b + s₂ (u - b) above | c, s₁, b, s₂ |
//!
//! # Errors
//!
//! Points are weighted by their standard errors. χ² then tells whether these explain the scatter about the fit: its mean
//! is the number of degrees of freedom ν. Where χ²/ν > 1 the errors are too small for this form of curve, or the form is
//! wrong; then all errors that are quoted are widened by √(χ²/ν) (Birge's ratio), and both χ² and the factor are told.
//! They are never made smaller. If a point has no error all count alike, and their scatter gives the errors.
//!
//! Intervals are those of Student's t for ν degrees of freedom where the scatter gave the errors, and of the normal
//! distribution where the points' own errors did.
//!
//! # The break
//!
//! At each break the other three parameters are a linear fit; the break is where its χ² is least, by a scan over all
//! places with two points on either side. Its interval holds all breaks with χ² < χ²_min + t² (Birge's ratio)²: it is
//! not symmetric, and not one piece where the data allow two breaks; then its outermost ends are told.
//!
//! Source: R. T. Birge, Phys. Rev. 40 (1932) 207; profile likelihood: W. H. Press et al., *Numerical Recipes*, ch. 15.6.

use nalgebra::DMatrix;
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};

use super::least_squares::{self, Solution};

/// Part of a normal distribution within one standard deviation.
const ONE_SIGMA: f64 = 0.682_689_492_137;
/// Confidence level of the band that is drawn [-].
pub(crate) const BAND: f64 = 0.95;
/// Places that a break is tried at between the outermost ones.
const SCAN: usize = 120;

/// One point to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitPoint {
    /// u_p [m/s].
    pub particle_velocity: f64,
    /// u_s [m/s].
    pub shock_velocity: f64,
    /// Standard error of u_s [m/s]; not positive or not finite if unknown.
    pub standard_error: f64,
}

/// Form of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Form {
    /// One straight line.
    Linear,
    /// A parabola.
    Quadratic,
    /// Two straight lines that meet.
    TwoPiece,
}

impl Form {
    /// All forms.
    pub const ALL: [Self; 3] = [Self::Linear, Self::Quadratic, Self::TwoPiece];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Quadratic => "quadratic",
            Self::TwoPiece => "two-piece",
        }
    }

    /// (name, unit) of each parameter.
    pub fn parameters(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Linear => &[("c", "m/s"), ("s", "")],
            Self::Quadratic => &[("c", "m/s"), ("s", ""), ("q", "s/m")],
            Self::TwoPiece => &[("c", "m/s"), ("s_below", ""), ("break", "m/s"), ("s_above", "")],
        }
    }

    fn value(self, a: &[f64], u: f64) -> f64 {
        match self {
            Self::Linear => a[0] + a[1] * u,
            Self::Quadratic => a[0] + u * (a[1] + a[2] * u),
            Self::TwoPiece => a[0] + a[1] * u.min(a[2]) + a[3] * (u - a[2]).max(0.0),
        }
    }

    /// ∂u_s/∂a at u.
    fn gradient(self, a: &[f64], u: f64) -> Vec<f64> {
        match self {
            Self::Linear => vec![1.0, u],
            Self::Quadratic => vec![1.0, u, u * u],
            Self::TwoPiece if u <= a[2] => vec![1.0, u, 0.0, 0.0],
            Self::TwoPiece => vec![1.0, a[2], a[1] - a[3], u - a[2]],
        }
    }
}

/// Where the errors of a fit come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum ErrorSource {
    /// The standard errors of the points.
    Points,
    /// The standard errors of the points, widened by Birge's ratio: they do not explain the scatter.
    Widened,
    /// The scatter alone: points without errors, all counted alike.
    Scatter,
    /// Nothing: as many parameters as points without errors.
    Unknown,
}

/// A fit of u_s(u_p).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// Its form.
    pub form: Form,
    /// Parameters, in the order of [`Form::parameters`] [m/s, 1, s/m].
    pub values: Vec<f64>,
    /// Their standard errors, in the units of the values, widened where need be.
    pub errors: Vec<f64>,
    /// Their covariance, in products of the units of the values, widened where need be.
    pub covariance: Vec<Vec<f64>>,
    /// χ² with the errors of the points as given; the sum of squares [m²/s²] where they have none.
    pub chi_squared: f64,
    /// ν: points less parameters.
    pub degrees_of_freedom: usize,
    /// χ²/ν [-]; none for ν = 0.
    pub reduced_chi_squared: Option<f64>,
    /// Probability of a χ² this great or greater if form and errors are right [-]; none without errors of the points.
    pub probability: Option<f64>,
    /// Factor by which errors were widened [-]: 1, or √(χ²/ν).
    pub widened_by: f64,
    /// Where the errors come from.
    pub error_source: ErrorSource,
    /// Interval of the break at one standard deviation [m/s].
    pub break_interval: Option<(f64, f64)>,
    /// Least and greatest u_p of the points [m/s].
    pub range: (f64, f64),
}

impl Fit {
    /// Fits the points; `None` if they are too few, or too close together.
    pub fn new(form: Form, points: &[FitPoint]) -> Option<Self> {
        let mut points: Vec<FitPoint> = points.to_vec();
        points.sort_by(|a, b| a.particle_velocity.total_cmp(&b.particle_velocity));
        let has_errors = points.iter().all(|p| p.standard_error.is_finite() && p.standard_error > 0.0);
        let data = Data::new(&points, has_errors);
        let solution = match form {
            Form::Linear => data.polynomial(2)?,
            Form::Quadratic => data.polynomial(3)?,
            Form::TwoPiece => data.two_piece()?,
        };
        Self::from_solution(form, &data, solution, has_errors)
    }

    fn from_solution(form: Form, data: &Data, solution: Solution, has_errors: bool) -> Option<Self> {
        let nu = data.x.len().checked_sub(solution.parameters.len())?;
        let reduced = (nu > 0).then(|| solution.chi_squared / nu as f64);
        let (error_source, widened_by) = match (has_errors, reduced) {
            (true, Some(reduced)) if reduced > 1.0 => (ErrorSource::Widened, reduced.sqrt()),
            (true, _) => (ErrorSource::Points, 1.0),
            (false, Some(reduced)) => (ErrorSource::Scatter, reduced.sqrt()),
            (false, None) => (ErrorSource::Unknown, f64::NAN),
        };
        let covariance = solution.covariance * (widened_by * widened_by);
        let errors = (0..covariance.ncols()).map(|k| covariance[(k, k)].sqrt()).collect();
        let probability = match (has_errors, nu) {
            (true, 1..) => ChiSquared::new(nu as f64).ok().map(|d| d.sf(solution.chi_squared)),
            _ => None,
        };
        let mut fit = Self {
            form,
            errors,
            covariance: covariance.row_iter().map(|row| row.iter().copied().collect()).collect(),
            values: solution.parameters,
            chi_squared: solution.chi_squared,
            degrees_of_freedom: nu,
            reduced_chi_squared: reduced,
            probability,
            widened_by,
            error_source,
            break_interval: None,
            range: (data.x[0], data.x[data.x.len() - 1]),
        };
        if form == Form::TwoPiece && nu > 0 {
            let allowance = (fit.quantile(ONE_SIGMA) * widened_by).powi(2);
            fit.break_interval = data.breaks_below(fit.values[2], fit.chi_squared + allowance);
        }
        Some(fit)
    }

    /// u_s of the fit at u_p [m/s].
    pub fn shock_velocity(&self, particle_velocity: f64) -> f64 {
        self.form.value(&self.values, particle_velocity)
    }

    /// Standard error of the fit's u_s at u_p [m/s], from the covariance of its parameters.
    pub fn standard_error(&self, particle_velocity: f64) -> f64 {
        let g = self.form.gradient(&self.values, particle_velocity);
        let row = |i: usize| -> f64 { self.covariance[i].iter().zip(&g).map(|(c, g)| c * g).sum() };
        (0..g.len()).map(|i| g[i] * row(i)).sum::<f64>().max(0.0).sqrt()
    }

    /// Half width of the confidence band at u_p [m/s].
    pub fn band(&self, particle_velocity: f64) -> f64 {
        self.quantile(BAND) * self.standard_error(particle_velocity)
    }

    /// Standard errors that hold this part of the distribution between them and their negatives.
    fn quantile(&self, level: f64) -> f64 {
        let at = 0.5 * (1.0 + level);
        match self.error_source {
            ErrorSource::Points => Normal::new(0.0, 1.0).map_or(f64::NAN, |d| d.inverse_cdf(at)),
            ErrorSource::Widened | ErrorSource::Scatter => {
                StudentsT::new(0.0, 1.0, self.degrees_of_freedom as f64)
                    .map_or(f64::NAN, |d| d.inverse_cdf(at))
            }
            ErrorSource::Unknown => f64::NAN,
        }
    }
}

/// The points as columns.
struct Data {
    x: Vec<f64>,
    y: Vec<f64>,
    sigma: Vec<f64>,
}

impl Data {
    fn new(points: &[FitPoint], has_errors: bool) -> Self {
        let column = |f: fn(&FitPoint) -> f64| points.iter().map(f).collect::<Vec<_>>();
        let sigma = if has_errors { column(|p| p.standard_error) } else { vec![1.0; points.len()] };
        Self { x: column(|p| p.particle_velocity), y: column(|p| p.shock_velocity), sigma }
    }

    fn polynomial(&self, terms: usize) -> Option<Solution> {
        let design = DMatrix::from_fn(self.x.len(), terms, |i, k| self.x[i].powi(k as i32));
        least_squares::linear(&design, &self.y, &self.sigma)
    }

    /// The three linear parameters c, s₁, s₂ with the break at b.
    fn broken_at(&self, b: f64) -> Option<Solution> {
        let design = DMatrix::from_fn(self.x.len(), 3, |i, k| match k {
            0 => 1.0,
            1 => self.x[i].min(b),
            _ => (self.x[i] - b).max(0.0),
        });
        least_squares::linear(&design, &self.y, &self.sigma)
    }

    fn chi_squared_at(&self, b: f64) -> f64 {
        self.broken_at(b).map_or(f64::INFINITY, |s| s.chi_squared)
    }

    /// Breaks that leave two points on either side [m/s].
    fn break_range(&self) -> Option<(f64, f64)> {
        let n = self.x.len();
        (n >= 4 && self.x[1] < self.x[n - 2]).then(|| (self.x[1], self.x[n - 2]))
    }

    /// Places that are tried: an even scan, and the points themselves, where χ² has its kinks.
    fn scan(&self) -> Option<Vec<f64>> {
        let (low, high) = self.break_range()?;
        let mut places: Vec<f64> = (0..=SCAN).map(|k| low + (high - low) * k as f64 / SCAN as f64).collect();
        places.extend(self.x.iter().copied().filter(|x| (low..=high).contains(x)));
        places.sort_by(f64::total_cmp);
        places.dedup();
        Some(places)
    }

    fn two_piece(&self) -> Option<Solution> {
        let places = self.scan()?;
        let chi: Vec<f64> = places.iter().map(|&b| self.chi_squared_at(b)).collect();
        let best = (0..places.len()).min_by(|&a, &b| chi[a].total_cmp(&chi[b]))?;
        let (low, high) = (places[best.saturating_sub(1)], places[(best + 1).min(places.len() - 1)]);
        let b = least_between(low, high, |b| self.chi_squared_at(b));
        let b = if self.chi_squared_at(b) <= chi[best] { b } else { places[best] };
        let three = self.broken_at(b)?;
        let (c, below, above) = (three.parameters[0], three.parameters[1], three.parameters[2]);
        let values = vec![c, below, b, above];
        let slopes = DMatrix::from_fn(self.x.len(), 4, |i, k| Form::TwoPiece.gradient(&values, self.x[i])[k]);
        // The same values again: a linear problem about the solution gives the covariance of all four.
        let about = least_squares::linear(&slopes, &self.y, &self.sigma)?;
        Some(Solution { parameters: values, covariance: about.covariance, chi_squared: three.chi_squared })
    }

    /// Outermost breaks with a χ² below a limit, which the best one is [m/s].
    fn breaks_below(&self, best: f64, limit: f64) -> Option<(f64, f64)> {
        let mut places = self.scan()?;
        places.insert(places.partition_point(|&b| b < best), best);
        let is_inside = |b: f64| self.chi_squared_at(b) <= limit;
        let first = places.iter().position(|&b| is_inside(b))?;
        let last = places.iter().rposition(|&b| is_inside(b))?;
        let edge = |outside: Option<&f64>, inside: f64| {
            outside.map_or(inside, |&outside| edge_between(outside, inside, is_inside))
        };
        let before = first.checked_sub(1).and_then(|k| places.get(k));
        Some((edge(before, places[first]), edge(places.get(last + 1), places[last])))
    }
}

/// The last place inside on the way from inside to outside.
fn edge_between(mut outside: f64, mut inside: f64, is_inside: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..20 {
        let middle = 0.5 * (outside + inside);
        if is_inside(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

/// Where a function of one minimum between two places has it: golden section.
fn least_between(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    for _ in 0..40 {
        let (a, b) = (high - ratio * (high - low), low + ratio * (high - low));
        if f(a) <= f(b) {
            high = b;
        } else {
            low = a;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
#[path = "fit_tests.rs"]
mod tests;
