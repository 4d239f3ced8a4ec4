//! Gates: what a figure must reach to pass.
//!
//! The figures are data, one file a suite: `validation/<suite>/gates.ron`. A published figure is written as it was
//! printed; the gate asks for an error that is not greater, with half a unit of the last printed digit to spare, since
//! that much is unknown of the published one. What this program itself has reached is held likewise, with a twentieth to
//! spare: a change that loses accuracy is noticed. An order of convergence must be at least the given one.
//!
//! A gate that is missed for a reason that is understood, or looked for in vain, stays where it is: the miss is written
//! beside it (`known`), with what was reached and why. It is shown as a miss, but held to that figure alone; a miss that
//! grows, or one that nobody has explained, fails the validation. One that passes again is told: its entry has had its day.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::case::{Case, SchemeName};
use crate::error::ValidateError;

/// Share of the error by which a run may be worse than what this program has reached before.
const REACHED_MARGIN: f64 = 0.05;

/// What a row must fulfil.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
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

/// The gates of one suite, as its file has them. An entry without a scheme or a variant is meant for all of them.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GateFile {
    /// Where the figures come from.
    pub source: String,
    #[serde(default)]
    figures: Vec<Figure>,
    #[serde(default)]
    reached: Vec<Figure>,
    #[serde(default)]
    limits: Vec<Limit>,
    #[serde(default)]
    limits_by_resolution: Vec<Envelope>,
    #[serde(default)]
    orders: Vec<Order>,
    #[serde(default)]
    known: Vec<KnownMiss>,
}

/// Figures of a scheme, by resolution, as printed.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Figure {
    #[serde(default)]
    scheme: Option<SchemeName>,
    #[serde(default)]
    variant: Option<String>,
    metric: String,
    printed: BTreeMap<u32, String>,
    /// Uncertainty of the reading of the figure, in its unit: allowed as well.
    #[serde(default)]
    reading: f64,
}

/// A limit of the error at every resolution.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Limit {
    #[serde(default)]
    scheme: Option<SchemeName>,
    #[serde(default)]
    variant: Option<String>,
    metric: String,
    error_at_most: f64,
}

/// Limits of the error, one a resolution.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Envelope {
    #[serde(default)]
    scheme: Option<SchemeName>,
    #[serde(default)]
    variant: Option<String>,
    metric: String,
    error_at_most: BTreeMap<u32, f64>,
}

/// A gate that is known to be missed: what is reached instead, and why.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct KnownMiss {
    #[serde(default)]
    scheme: Option<SchemeName>,
    #[serde(default)]
    variant: Option<String>,
    metric: String,
    reached: BTreeMap<u32, String>,
    cause: String,
}

/// Least order of convergence, by the fit over all resolutions of a tier.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Order {
    #[serde(default)]
    scheme: Option<SchemeName>,
    #[serde(default)]
    variant: Option<String>,
    metric: String,
    at_least: f64,
}

/// For which rows an entry is meant.
struct Meant<'f> {
    scheme: Option<SchemeName>,
    variant: Option<&'f str>,
    metric: &'f str,
}

impl Meant<'_> {
    fn fits(&self, case: &Case, metric: &str) -> bool {
        self.metric == metric && self.fits_case(case)
    }

    fn fits_case(&self, case: &Case) -> bool {
        self.scheme.is_none_or(|scheme| scheme == case.scheme)
            && self.variant.is_none_or(|variant| variant == case.variant)
    }
}

macro_rules! meant {
    ($($entry:ident),*) => {$(
        impl $entry {
            fn meant(&self) -> Meant<'_> {
                Meant { scheme: self.scheme, variant: self.variant.as_deref(), metric: &self.metric }
            }
        }
    )*};
}

meant!(Figure, Limit, Envelope, KnownMiss, Order);

impl GateFile {
    /// Reads the gates of a suite from the text of its file; an empty text has no gates.
    ///
    /// # Errors
    /// [`ValidateError::Gates`] for a text that is not RON of this form, or a printed figure that is no number.
    pub fn read(suite: &str, text: &str) -> Result<Self, ValidateError> {
        if text.is_empty() {
            return Ok(Self::default());
        }
        let fault = |reason: String| ValidateError::Gates { suite: suite.to_owned(), reason };
        let format =
            ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        let file: Self = format.from_str(text).map_err(|error| fault(error.to_string()))?;
        let printed = file.figures.iter().chain(&file.reached).flat_map(|figure| figure.printed.values());
        let mut printed = printed.chain(file.known.iter().flat_map(|miss| miss.reached.values()));
        match printed.find(|text| Printed::read(text).is_none()) {
            Some(text) => Err(fault(format!("`{text}` is not a printed number"))),
            None => Ok(file),
        }
    }

    /// The gate of an error of `metric` at `reference`: the narrowest of those that are meant for it.
    pub fn of_figure(&self, case: &Case, metric: &str, reference: f64) -> Option<Gate> {
        let errors = |figures: &[Figure], margin: f64| -> Vec<f64> {
            let meant = figures.iter().filter(|figure| figure.meant().fits(case, metric));
            let limit = |figure: &Figure| {
                let printed = Printed::read(figure.printed.get(&case.n)?)?;
                Some(printed.error_at_most(reference, margin) + figure.reading)
            };
            meant.filter_map(limit).collect()
        };
        let limits = self.limits.iter().filter(|limit| limit.meant().fits(case, metric));
        let limits = limits.map(|limit| limit.error_at_most);
        let envelopes = self.limits_by_resolution.iter().filter(|limit| limit.meant().fits(case, metric));
        let limits = limits.chain(envelopes.filter_map(|limit| limit.error_at_most.get(&case.n).copied()));
        let published = errors(&self.figures, 0.0);
        let reached = errors(&self.reached, REACHED_MARGIN);
        published.into_iter().chain(reached).chain(limits).reduce(f64::min).map(Gate::ErrorAtMost)
    }

    /// The gate of an order of convergence.
    pub fn of_order(&self, case: &Case, metric: &str) -> Option<Gate> {
        let order = self.orders.iter().find(|order| order.meant().fits(case, metric))?;
        Some(Gate::AtLeast(order.at_least))
    }

    /// Why a figure that missed its gate was expected to: the cause of a known miss, if the figure is no farther from its
    /// reference than what the file says is reached (a twentieth allowed).
    pub fn known_cause(&self, case: &Case, metric: &str, value: f64, reference: f64) -> Option<&str> {
        let mut misses = self.known.iter().filter(|miss| miss.meant().fits(case, metric));
        let held = |miss: &&KnownMiss| {
            let reached = miss.reached.get(&case.n).and_then(|text| Printed::read(text));
            reached.is_some_and(|reached| {
                (value - reference).abs() <= reached.error_at_most(reference, REACHED_MARGIN)
            })
        };
        misses.find(held).map(|miss| miss.cause.as_str())
    }

    /// Number and cause of the entry that names a figure of a run as a known miss, whether it is missed or not.
    pub fn entry_of_miss(&self, case: &Case, metric: &str) -> Option<(usize, &str)> {
        let names = |miss: &KnownMiss| miss.meant().fits(case, metric) && miss.reached.contains_key(&case.n);
        let number = self.known.iter().position(names)?;
        Some((number, &self.known[number].cause))
    }

    /// An entry that is meant for none of the `cases` of a suite, or for a resolution that none of them has: it would never
    /// judge anything.
    pub fn idle(&self, cases: &[Case]) -> Option<String> {
        let printed =
            self.figures.iter().chain(&self.reached).map(|f| (f.meant(), f.printed.keys().collect()));
        let envelopes =
            self.limits_by_resolution.iter().map(|e| (e.meant(), e.error_at_most.keys().collect()));
        let known = self.known.iter().map(|miss| (miss.meant(), miss.reached.keys().collect()));
        let any = self.limits.iter().map(Limit::meant).chain(self.orders.iter().map(Order::meant));
        let mut entries = printed.chain(envelopes).chain(known).chain(any.map(|meant| (meant, Vec::new())));
        entries.find_map(|(meant, resolutions): (Meant<'_>, Vec<&u32>)| {
            let fitting: Vec<u32> =
                cases.iter().filter(|case| meant.fits_case(case)).map(|case| case.n).collect();
            let lacking = resolutions.into_iter().find(|n| !fitting.contains(n));
            let whose = || {
                let variant =
                    meant.variant.map_or(String::new(), |variant| format!(", variant \"{variant}\""));
                let scheme = meant.scheme.map_or(String::new(), |scheme| format!(", {scheme}"));
                format!("`{}`{scheme}{variant}", meant.metric)
            };
            match lacking {
                _ if fitting.is_empty() => Some(format!("{}: no run of the suite is meant", whose())),
                Some(n) => Some(format!("{}: no run of the suite has n = {n}", whose())),
                None => None,
            }
        })
    }

    /// A figure that the file judges in runs like `case` and that is not among those `measured`: it would never be
    /// held against anything.
    pub fn unmeasured(&self, case: &Case, measured: &[&str]) -> Option<&str> {
        let figures = self.figures.iter().chain(&self.reached).map(Figure::meant);
        let limits = self.limits.iter().map(Limit::meant);
        let limits = limits.chain(self.limits_by_resolution.iter().map(Envelope::meant));
        let known = self.known.iter().map(KnownMiss::meant);
        let all = figures.chain(limits).chain(known).chain(self.orders.iter().map(Order::meant));
        let mut metrics = all.filter(|meant| meant.fits_case(case)).map(|meant| meant.metric);
        metrics.find(|metric| !measured.contains(metric))
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
#[path = "gate_tests.rs"]
mod tests;
