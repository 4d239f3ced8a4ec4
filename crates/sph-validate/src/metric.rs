//! What is measured of a run: error norms, places of waves, observed orders.

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A figure of a run: its name in `results.json` and in the files of gates, its unit, and what kind of figure it is.
///
/// A suite writes its figures as constants: `const STRESS_L1: Metric = Metric::norm("stress_l1", "GPa");`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Metric {
    /// Name, in `snake_case`.
    pub name: Cow<'static, str>,
    /// Unit of the value.
    pub unit: Cow<'static, str>,
    /// What kind of figure.
    pub kind: Kind,
}

/// What kind of figure a metric is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Norm of an error: the reference is zero, an order of convergence is reported.
    Norm,
    /// A value whose error has an order of convergence.
    ConvergingValue,
    /// A value beside its reference, or a distance from it; no order is reported.
    Value,
    /// What was lost of what must be conserved.
    Drift,
}

impl Metric {
    /// Norm of an error; its order of convergence is reported.
    pub const fn norm(name: &'static str, unit: &'static str) -> Self {
        Self::of_kind(name, unit, Kind::Norm)
    }

    /// A value, or a distance; no order is reported.
    pub const fn value(name: &'static str, unit: &'static str) -> Self {
        Self::of_kind(name, unit, Kind::Value)
    }

    /// A value whose error has an order of convergence, which is reported.
    pub const fn converging_value(name: &'static str, unit: &'static str) -> Self {
        Self::of_kind(name, unit, Kind::ConvergingValue)
    }

    /// What was lost of what must be conserved, as a share of it.
    pub const fn drift(name: &'static str) -> Self {
        Self::of_kind(name, "-", Kind::Drift)
    }

    const fn of_kind(name: &'static str, unit: &'static str, kind: Kind) -> Self {
        Self { name: Cow::Borrowed(name), unit: Cow::Borrowed(unit), kind }
    }

    /// Whether an order of convergence is reported.
    pub fn has_order(&self) -> bool {
        matches!(self.kind, Kind::Norm | Kind::ConvergingValue)
    }

    /// Name for readers: `stress l1`.
    pub fn title(&self) -> String {
        self.name.replace('_', " ")
    }
}

/// What a value should be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// Known before the run, in the unit of the metric; 0 for norms and shifts.
    Known(f64),
    /// What the finest run of the same variant and scheme gives: where no answer is known. The finest run itself is
    /// then held by no gate of the error.
    Finest,
}

/// A measured value beside what it should be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// What was measured.
    pub metric: Metric,
    /// The value, in [`Metric::unit`].
    pub value: f64,
    /// What it should be.
    pub target: Target,
}

impl Measurement {
    /// A measurement whose true value is zero.
    pub fn error_of(metric: Metric, value: f64) -> Self {
        Self::new(metric, value, 0.0)
    }

    /// A measurement whose true value is known.
    pub fn new(metric: Metric, value: f64, reference: f64) -> Self {
        Self { metric, value, target: Target::Known(reference) }
    }

    /// A measurement that is held against the finest run of its kin.
    pub fn against_finest(metric: Metric, value: f64) -> Self {
        Self { metric, value, target: Target::Finest }
    }
}

/// Mean of |value - reference| over pairs.
pub fn mean_absolute_difference(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (count, sum) = pairs
        .fold((0usize, 0.0), |(count, sum), (value, reference)| (count + 1, sum + (value - reference).abs()));
    sum / count as f64
}

/// Order between two resolutions: error ∝ n^(-order).
pub fn observed_order(coarse: (u32, f64), fine: (u32, f64)) -> f64 {
    (coarse.1 / fine.1).ln() / (f64::from(fine.0) / f64::from(coarse.0)).ln()
}

/// Order from the least-squares line of ln(error) over ln(n); `None` with fewer than two resolutions.
pub fn fitted_order(errors: &[(u32, f64)]) -> Option<f64> {
    if errors.len() < 2 {
        return None;
    }
    let points: Vec<(f64, f64)> = errors.iter().map(|&(n, error)| (f64::from(n).ln(), error.ln())).collect();
    let count = points.len() as f64;
    let mean_x = points.iter().map(|p| p.0).sum::<f64>() / count;
    let mean_y = points.iter().map(|p| p.1).sum::<f64>() / count;
    let covariance: f64 = points.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum();
    let variance: f64 = points.iter().map(|p| (p.0 - mean_x).powi(2)).sum();
    Some(-covariance / variance)
}

/// Means of `columns` equal in number of members, of pairs (place, value) sorted by place.
pub fn column_means(mut pairs: Vec<(f64, f64)>, members: usize) -> Vec<(f64, f64)> {
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mean = |chunk: &[(f64, f64)], pick: fn(&(f64, f64)) -> f64| {
        chunk.iter().map(pick).sum::<f64>() / chunk.len() as f64
    };
    pairs.chunks(members).map(|chunk| (mean(chunk, |p| p.0), mean(chunk, |p| p.1))).collect()
}

/// The place nearest to `expected` where a profile passes through `level`, linear between its points.
pub fn crossing(profile: &[(f64, f64)], level: f64, expected: f64) -> Option<f64> {
    let place = |pair: &[(f64, f64)]| {
        let [(x0, v0), (x1, v1)] = [pair[0], pair[1]];
        ((v0 - level) * (v1 - level) <= 0.0 && v0 != v1).then(|| x0 + (level - v0) / (v1 - v0) * (x1 - x0))
    };
    let distance = |x: &f64| (x - expected).abs();
    profile.windows(2).filter_map(place).min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

/// Centroid of a profile: Σ v x / Σ v.
pub fn centroid(profile: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (moment, sum) = profile.fold((0.0, 0.0), |(moment, sum), (x, v)| (moment + v * x, sum + v));
    moment / sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_of_an_exact_power_are_exact() {
        let errors: Vec<(u32, f64)> = [100, 200, 400].map(|n| (n, 3.0 / f64::from(n * n))).to_vec();
        assert!((observed_order(errors[0], errors[2]) - 2.0).abs() < 1e-12);
        assert!((fitted_order(&errors).expect("three resolutions") - 2.0).abs() < 1e-12);
        assert_eq!(fitted_order(&errors[..1]), None);
    }

    #[test]
    fn crossing_is_interpolated_and_the_nearest() {
        let profile = [(0.0, 0.0), (1.0, 2.0), (2.0, 0.0), (3.0, 4.0)];
        assert_eq!(crossing(&profile, 1.0, 0.0), Some(0.5));
        assert_eq!(crossing(&profile, 1.0, 3.0), Some(2.25));
        assert_eq!(crossing(&profile, 9.0, 0.0), None);
    }

    #[test]
    fn columns_are_averaged_in_order_of_place() {
        let pairs = vec![(2.0, 5.0), (1.0, 1.0), (2.0, 7.0), (1.0, 3.0)];
        assert_eq!(column_means(pairs, 2), [(1.0, 2.0), (2.0, 6.0)]);
    }

    #[test]
    fn centroid_and_mean_difference() {
        assert_eq!(centroid([(0.0, 1.0), (4.0, 3.0)].into_iter()), 3.0);
        assert_eq!(mean_absolute_difference([(1.0, 2.0), (5.0, 2.0)].into_iter()), 2.0);
    }
}
