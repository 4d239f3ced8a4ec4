//! What a run gave: figures, conservation, cost, and what its pictures need.
//!
//! An outcome is kept on disk as it is, so that a finished run is never computed again.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::case::Case;
use crate::conservation::Conservation;
use crate::metric::Measurement;

/// What a run gave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Which run.
    pub case: Case,
    /// Its figures.
    pub measurements: Vec<Measurement>,
    /// What was lost of what must be conserved.
    pub conservation: Conservation,
    /// Curves for its plots, in the units of the plots.
    pub curves: Vec<Curve>,
    /// Fields over the particles, for pictures.
    pub fields: Vec<Field>,
    /// What it cost.
    pub cost: Cost,
}

impl Outcome {
    /// Its figures, the drifts of what must be conserved behind them.
    pub fn figures(&self) -> impl Iterator<Item = Measurement> {
        self.measurements.iter().cloned().chain(self.conservation.measurements())
    }

    /// A figure by its name.
    pub fn figure(&self, metric: &str) -> Option<Measurement> {
        self.figures().find(|figure| figure.metric.name == metric)
    }

    /// Points of a curve; none if there is no curve of that name.
    pub fn curve(&self, name: &str) -> &[(f64, f64)] {
        self.curves.iter().find(|curve| curve.name == name).map_or(&[], |curve| &curve.points)
    }
}

/// A curve for a plot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// What it is, within its suite.
    pub name: String,
    /// Its points, in the units of the plot.
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// A curve with its name.
    pub fn new(name: &str, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.to_owned(), points }
    }
}

/// A scalar over the particles at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Field {
    /// What and when, as a word for file names; fields named `start` are alike for all schemes and drawn once.
    pub name: String,
    /// What and when, for readers.
    pub title: String,
    /// What the values are, with their unit.
    pub label: String,
    /// Values at the ends of the color bar, in the unit of the label.
    pub range: (f64, f64),
    /// Places of the particles [mm].
    pub x: Vec<f64>,
    /// Places of the particles [mm].
    pub y: Vec<f64>,
    /// Extent of the particles [mm].
    pub size: Vec<f64>,
    /// Values, in the unit of the label.
    pub values: Vec<f64>,
}

/// What a run cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Cost {
    /// Particles at the end, those outside of the domain included.
    pub particles: usize,
    /// Time steps.
    pub steps: u64,
    /// Sum of the particles over the steps.
    pub particle_steps: u64,
    /// Wall time [s].
    pub seconds: f64,
}

impl Cost {
    /// Million particle-steps per second.
    pub fn rate(&self) -> f64 {
        if self.seconds > 0.0 { 1e-6 * self.particle_steps as f64 / self.seconds } else { 0.0 }
    }
}
