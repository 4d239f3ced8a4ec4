//! Gates: what a figure must reach to pass.
//!
//! The figures are data, one file a suite: `validation/<suite>/gates.ron`. A published figure is written as it was
//! printed; the gate asks for an error that is not greater, with half a unit of the last printed digit to spare, since
//! that much is unknown of the published one. What this program itself has reached is held likewise, with a twentieth to
//! spare: a change that loses accuracy is noticed. An order of convergence must be at least the given one.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::case::{Case, SchemeName, SuiteName};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};

/// Share of the error by which a run may be worse than what this program has reached before.
const REACHED_MARGIN: f64 = 0.05;

/// What a row must fulfil.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Gate {
    /// |value - reference| must not be greater.
    ErrorAtMost(f64),
    /// The value must not be less.
    AtLeast(f64),
}

impl Gate {
    /// Whether the gate lets a value pass. A not-a-number never passes.
    pub fn passes(self, value: f64, reference: f64) -> bool {
        match self {
            Self::ErrorAtMost(limit) => (value - reference).abs() <= limit,
            Self::AtLeast(limit) => value >= limit,
        }
    }
}

impl std::fmt::Display for Gate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::ErrorAtMost(limit) => write!(f, "error ≤ {limit:.4}", limit = Significant(*limit)),
            Self::AtLeast(limit) => write!(f, "≥ {limit}"),
        }
    }
}

/// A number with as many significant digits as its precision says.
pub struct Significant(pub f64);

impl std::fmt::Display for Significant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = f.precision().unwrap_or(4);
        let magnitude = self.0.abs().log10().floor();
        if self.0 == 0.0 || !magnitude.is_finite() {
            return write!(f, "{}", self.0);
        }
        if !(-4.0..6.0).contains(&magnitude) {
            return write!(f, "{:.*e}", digits.saturating_sub(1), self.0);
        }
        let decimals = (digits as f64 - 1.0 - magnitude).max(0.0) as usize;
        write!(f, "{:.decimals$}", self.0)
    }
}

/// The gates of one suite, as its file has them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GateFile {
    /// Where the figures come from.
    pub source: String,
    figures: Vec<Figure>,
    reached: Vec<Figure>,
    limits: Vec<Limit>,
    orders: Vec<Order>,
}

/// Figures of a scheme, by resolution, as printed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Figure {
    scheme: SchemeName,
    metric: Metric,
    printed: BTreeMap<u32, String>,
    /// Uncertainty of the reading of the figure, in its unit: allowed as well.
    #[serde(default)]
    reading: f64,
}

/// A limit of the error at every resolution.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Limit {
    scheme: SchemeName,
    metric: Metric,
    error_at_most: f64,
}

/// Least order of convergence, by the fit over all resolutions of a tier.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Order {
    scheme: SchemeName,
    metric: Metric,
    at_least: f64,
}

impl GateFile {
    /// The gates of a suite, compiled in from its folder.
    pub fn of(suite: SuiteName) -> Result<Self, ValidateError> {
        let text = match suite {
            SuiteName::Riemann => include_str!("../../../validation/riemann/gates.ron"),
            SuiteName::SoundWave => include_str!("../../../validation/sound-wave/gates.ron"),
            SuiteName::Verny => include_str!("../../../validation/verny/gates.ron"),
        };
        let fault = |reason: String| ValidateError::Gates { suite: suite.as_str(), reason };
        let file: Self = ron::from_str(text).map_err(|error| fault(error.to_string()))?;
        let mut printed = file.figures.iter().chain(&file.reached).flat_map(|figure| figure.printed.values());
        match printed.find(|text| Printed::read(text).is_none()) {
            Some(text) => Err(fault(format!("`{text}` is not a printed number"))),
            None => Ok(file),
        }
    }

    /// The gate of a measurement: the narrowest of those that are meant for it.
    pub fn of_measurement(&self, case: Case, measurement: &Measurement) -> Option<Gate> {
        let is_meant = |scheme, metric| scheme == case.scheme && metric == measurement.metric;
        let errors = |figures: &[Figure], margin: f64| -> Vec<f64> {
            let meant = figures.iter().filter(|figure| is_meant(figure.scheme, figure.metric));
            let limit = |figure: &Figure| {
                let printed = Printed::read(figure.printed.get(&case.n)?)?;
                Some(printed.error_at_most(measurement.reference, margin) + figure.reading)
            };
            meant.filter_map(limit).collect()
        };
        let limits = self.limits.iter().filter(|limit| is_meant(limit.scheme, limit.metric));
        let limits = limits.map(|limit| limit.error_at_most);
        let published = errors(&self.figures, 0.0);
        let reached = errors(&self.reached, REACHED_MARGIN);
        published.into_iter().chain(reached).chain(limits).reduce(f64::min).map(Gate::ErrorAtMost)
    }

    /// The gate of an order of convergence.
    pub fn of_order(&self, scheme: SchemeName, metric: Metric) -> Option<Gate> {
        let order = self.orders.iter().find(|order| order.scheme == scheme && order.metric == metric)?;
        Some(Gate::AtLeast(order.at_least))
    }
}

/// A number as it was printed: known to half a unit of its last digit.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Printed {
    value: f64,
    half_unit: f64,
}

impl Printed {
    fn read(text: &str) -> Option<Self> {
        let value: f64 = text.parse().ok()?;
        let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
        let decimals = mantissa.split_once('.').map_or(0, |(_, fraction)| fraction.len()) as i32;
        let half_unit = 0.5 * 10f64.powi(exponent.parse::<i32>().ok()? - decimals);
        value.is_finite().then_some(Self { value, half_unit })
    }

    fn error_at_most(self, reference: f64, margin: f64) -> f64 {
        (1.0 + margin) * (self.value - reference).abs() + self.half_unit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_all_suites_are_good() {
        for suite in SuiteName::ALL {
            let file = GateFile::of(suite).expect("a readable file");
            assert!(!file.source.is_empty() && !file.figures.is_empty(), "{suite}");
        }
    }

    #[test]
    fn printed_figures_leave_half_a_unit_of_the_last_digit() {
        let limit = |text| Printed::read(text).expect("a number").error_at_most(0.0, 0.0);
        assert!((limit("0.0450") - 0.04505).abs() < 1e-12);
        assert!((limit("7.9e-4") - 7.95e-4).abs() < 1e-12);
        assert!((limit("-0.10") - 0.105).abs() < 1e-12);
        let reached = Printed::read("66.56").expect("a number").error_at_most(66.54, 0.05);
        assert!((reached - (1.05 * 0.02 + 0.005)).abs() < 1e-12);
        assert_eq!(Printed::read("about 3"), None);
        assert_eq!(Printed::read("NaN"), None);
    }

    #[test]
    fn gates_hold_on_both_sides_of_the_reference_and_refuse_nan() {
        let gate = Gate::ErrorAtMost(0.1);
        assert!(gate.passes(1.05, 1.0) && gate.passes(0.95, 1.0));
        assert!(!gate.passes(1.2, 1.0) && !gate.passes(0.8, 1.0) && !gate.passes(f64::NAN, 1.0));
        assert!(Gate::AtLeast(2.0).passes(2.0, 0.0) && !Gate::AtLeast(2.0).passes(f64::NAN, 0.0));
    }

    #[test]
    fn published_figure_becomes_the_gate_of_its_own_run_only() {
        let file = GateFile::of(SuiteName::Riemann).expect("a readable file");
        let measurement = Measurement::error_of(Metric::StressL1, 1.0);
        let case = |n| Case { suite: SuiteName::Riemann, scheme: SchemeName::TkcHancock, n };
        let gate = file.of_measurement(case(100), &measurement).expect("a gate at N = 100");
        assert!(matches!(gate, Gate::ErrorAtMost(limit) if limit <= 0.04505), "{gate}");
        assert_eq!(file.of_measurement(case(101), &measurement), None);
    }

    #[test]
    fn numbers_are_shown_with_significant_digits() {
        let shown = |value| format!("{:.4}", Significant(value));
        assert_eq!(shown(66.55714), "66.56");
        assert_eq!(shown(0.000_795_12), "0.0007951");
        assert_eq!(shown(1.234_4e-9), "1.234e-9");
        assert_eq!(shown(0.0), "0");
        assert_eq!(shown(f64::NAN), "NaN");
    }
}
