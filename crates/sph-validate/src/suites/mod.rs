//! The suites: each sets up one problem, runs it with the real program and measures it.
//!
//! # A new suite
//!
//! is one file here, one folder `validation/<name>/` (`README.md` with its sources, `gates.ron`), and one line in
//! [`ALL`]. The file has a type that is a [`Suite`]; what a suite says and does:
//!
//! * [`Suite::about`]: names, what its resolution counts, what kind of reference it has, the text of its gates
//!   (`include_str!`);
//! * [`Suite::cases`]: the runs of a tier. A run is a [`Case`]: variant of the problem (a word: a material, a speed, an
//!   angle, `"3d"`; empty where there is one only), scheme, resolution. At least three resolutions a variant in the full
//!   tier, so that there is an order;
//! * [`Suite::work`]: particle-steps of a run, an estimate for the time left and for the order of runs;
//! * [`Suite::run`]: one run. Set up particles, make a `Run` (`run.rs`) (or a window), step, measure. Ends with
//!   `Run::outcome`, which adds what was conserved and what it cost. A suite with a moving
//!   window makes the [`Outcome`] itself; its [`Conservation`](crate::conservation::Conservation) is the closure of the
//!   window's ledger, and it asks [`Watch::check`](crate::watch::Watch::check) in each step;
//! * [`Suite::pictures`]: plots of all of its outcomes. What is drawn comes from the outcomes (figures, curves, fields),
//!   never from anywhere else: they may have been read from disk. Without it there is one plot of convergence for each
//!   figure that has an order.
//!
//! Figures are constants of type [`Metric`](crate::metric::Metric), in the file of the suite:
//! `const STRESS_L1: Metric = Metric::norm("stress_l1", "GPa");`. A figure is given with what it should be:
//! [`Measurement::error_of`](crate::metric::Measurement::error_of) (norms and shifts; it should be zero),
//! [`Measurement::new`](crate::metric::Measurement::new) (a value with its reference), or, where no answer is known,
//! [`Measurement::against_finest`](crate::metric::Measurement::against_finest) (the finest run of the same variant and
//! scheme is the answer).
//!
//! Nothing in a suite decides whether a figure is good enough: that is in [`crate::gate`], from the table of the suite's
//! folder. A gate of a figure that no run measures, or meant for no run of the suite, is an error. The drifts `mass_drift`,
//! `momentum_drift`, `energy_drift` and `angular_momentum_drift` are figures of every run; the first three must have a gate
//! in every suite. A suite draws no random number without a fixed seed: a run gives the same bits each time, on any number
//! of threads.

mod acoustic;
mod collapse;
mod disorder;
mod gas;
pub(crate) mod piston;
mod plate_impact;
pub(crate) mod riemann;
mod rigid_rotation;
mod shell_stop;
mod shells;
pub(crate) mod sound_wave;
mod spall;
mod spinning_disc;
mod strip;
mod taylor_bar;
pub(crate) mod verny;
mod vibration;
mod window;
mod window_porous;
pub(crate) mod window_solid;

use sph_io::field_image::FieldImage;
use sph_io::plot::Figure;

use crate::case::{Case, Tier};
use crate::error::ValidateError;
use crate::outcome::Outcome;
use crate::plots;
use crate::watch::Watch;

/// All suites, in the order of the report.
pub static ALL: &[&dyn Suite] = &[
    &riemann::Riemann::PUBLISHED,
    &sound_wave::PUBLISHED,
    &verny::PUBLISHED,
    &disorder::Disorder,
    &spall::Spall,
    &collapse::Collapse,
    &piston::Piston::OWN,
    &plate_impact::PlateImpact,
    &window_solid::WindowSolid::OWN,
    &window_porous::WindowPorous,
    &spinning_disc::SpinningDisc,
    &rigid_rotation::RigidRotation,
    &vibration::Vibration,
    &shells::Shells,
    &taylor_bar::TaylorBar,
    &gas::Gas,
    &acoustic::Acoustic,
];

/// A problem with a known answer.
pub trait Suite: Sync {
    /// What it is.
    fn about(&self) -> About;

    /// The runs of a tier, variant by variant, scheme by scheme, coarse to fine.
    fn cases(&self, tier: Tier) -> Vec<Case>;

    /// Work of a run: particle-steps, weighted by [`SchemeName::price`](crate::case::SchemeName::price).
    fn work(&self, case: &Case) -> f64;

    /// One run.
    ///
    /// # Errors
    /// If the reference does not exist, the run fails or is interrupted.
    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError>;

    /// What its answers depend on besides the code; a kept run of other parameters is computed again.
    fn parameters(&self) -> String {
        String::new()
    }

    /// The pictures of its outcomes, which are in the order of [`Self::cases`] and at least one.
    ///
    /// # Errors
    /// If the reference that is drawn beside the outcomes does not exist.
    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        Ok(plots::convergences(&self.about(), outcomes))
    }
}

/// What a suite is.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// Name in commands and files; folder in `validation/`.
    pub name: &'static str,
    /// Title in reports.
    pub title: &'static str,
    /// What `n` counts.
    pub resolution: &'static str,
    /// What the figures are held against.
    pub reference: ReferenceKind,
    /// Text of `validation/<name>/gates.ron`.
    pub gates: &'static str,
}

/// What the figures of a suite are held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReferenceKind {
    /// An exact solution, or a formula.
    Analytic,
    /// Another program's solution, a converged mesh or a measurement: shares no code with the particle method.
    External,
    /// Bounds of what can be: shows sanity, not truth.
    Bounds,
}

impl ReferenceKind {
    /// For readers.
    pub fn title(self) -> &'static str {
        match self {
            Self::Analytic => "exact",
            Self::External => "independent solution or measurement",
            Self::Bounds => "bounds",
        }
    }
}

/// A picture of a suite.
pub struct Picture {
    /// Name of its files, without an extension; begins with the name of the suite.
    pub name: String,
    /// What it shows, in a sentence for the report.
    pub caption: String,
    /// What is drawn.
    pub drawing: Drawing,
}

/// What is drawn.
pub enum Drawing {
    /// Curves.
    Plot(Figure),
    /// A field over the particles.
    Field(FieldImage),
}

/// A suite by its name.
pub fn find(name: &str) -> Option<&'static dyn Suite> {
    ALL.iter().copied().find(|suite| suite.about().name == name)
}

/// Names of all suites.
pub fn names() -> Vec<&'static str> {
    ALL.iter().map(|suite| suite.about().name).collect()
}
