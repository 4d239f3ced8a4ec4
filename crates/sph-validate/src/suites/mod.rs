//! The suites: each sets up one problem for the solver, runs it and measures it.
//!
//! A suite is four functions: the resolutions of a tier, the work of a run (for the time left), the run itself, and
//! the reference curve of its plot. Nothing in a suite decides whether a figure is good enough: that is in
//! [`crate::gate`].

pub mod riemann;
pub mod sound_wave;
pub mod verny;

use std::time::Instant;

use sph_core::{Dim2, Domain, Particle, Particles};
use sph_materials::{Material, library};
use sph_riemann::{Settings, Simulation};

use crate::case::{Case, SchemeName, SuiteName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};

/// Called with the share of the run that is done, 0 to 1.
pub type Progress<'a> = &'a dyn Fn(f64);

/// What a run gave.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Which run.
    pub case: Case,
    /// Its figures.
    pub measurements: Vec<Measurement>,
    /// Its curve in the plot of the suite, in the units of the plot.
    pub curve: Vec<(f64, f64)>,
    /// Fields over the particles, for pictures.
    pub fields: Vec<Field>,
    /// What it cost.
    pub cost: Cost,
}

impl Outcome {
    /// Distance of a figure from its reference, if the run has it.
    pub fn error(&self, metric: Metric) -> Option<f64> {
        self.measurements.iter().find(|measurement| measurement.metric == metric).map(Measurement::error)
    }
}

/// A scalar over the particles at one time.
#[derive(Clone, Debug)]
pub struct Field {
    /// When, as a word for file names.
    pub moment: &'static str,
    /// What and when.
    pub title: String,
    /// What the values are, with their unit.
    pub label: &'static str,
    /// Values at the ends of the color bar.
    pub range: (f64, f64),
    /// Places of the particles [mm].
    pub x: Vec<f64>,
    /// Places of the particles [mm].
    pub y: Vec<f64>,
    /// Extent of the particles [mm].
    pub size: Vec<f64>,
    /// Values.
    pub values: Vec<f64>,
}

/// What a run cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Cost {
    /// Particles, those outside of the domain included.
    pub particles: usize,
    /// Time steps.
    pub steps: u64,
    /// Million particle-steps per second.
    pub million_particle_steps_per_second: f64,
    /// Wall time [s].
    pub seconds: f64,
}

/// Resolutions of a suite in a tier, coarse to fine.
pub fn resolutions(suite: SuiteName, tier: Tier) -> &'static [u32] {
    match (suite, tier) {
        (SuiteName::Riemann | SuiteName::SoundWave, Tier::Quick) => &[100, 200, 400],
        (SuiteName::Riemann | SuiteName::SoundWave, Tier::Full) => &[100, 200, 400, 800, 1600],
        (SuiteName::Verny, Tier::Quick) => &[5, 10],
        (SuiteName::Verny, Tier::Full) => &[5, 10, 20, 40],
    }
}

/// The runs of a tier, all of `suites` with all of `schemes`.
pub fn plan(suites: &[SuiteName], schemes: &[SchemeName], tier: Tier) -> Vec<Case> {
    let mut cases = Vec::new();
    for &suite in suites {
        for &scheme in schemes {
            cases.extend(resolutions(suite, tier).iter().map(|&n| Case { suite, scheme, n }));
        }
    }
    cases
}

/// Work of a run, in particle-steps weighted by the price of the scheme: for the order of runs and the time left.
pub fn work(case: Case) -> f64 {
    let n = f64::from(case.n);
    let (particles, steps) = match case.suite {
        SuiteName::Riemann => (6.0 * n, riemann::DURATION * 6400.0 * n / riemann::LENGTH),
        SuiteName::SoundWave => (6.0 * n, sound_wave::duration() * 5100.0 * n / sound_wave::LENGTH),
        SuiteName::Verny => (std::f64::consts::PI * 9.0 * n * n, 140e-6 * 6400.0 * n / 0.02),
    };
    let price = match case.scheme {
        SchemeName::Csph => 0.5,
        SchemeName::TkcMuscl | SchemeName::TkcHancock => 1.0,
    };
    particles * steps * price / case.courant()
}

/// Runs one case.
pub fn run(case: Case, progress: Progress<'_>) -> Result<Outcome, ValidateError> {
    match case.suite {
        SuiteName::Riemann => riemann::run(case, progress),
        SuiteName::SoundWave => sound_wave::run(case, progress),
        SuiteName::Verny => verny::run(case, progress),
    }
}

/// A simulation that knows its case and its cost.
struct Run {
    case: Case,
    simulation: Simulation<Dim2>,
    started: Instant,
    /// Kinetic and internal energy at the start [J/m].
    energy: [f64; 2],
}

impl Run {
    /// The solver with the settings of the scheme, but for what the case says of Courant number and limiter.
    fn new(
        case: Case,
        domain: Domain<Dim2>,
        material: Material,
        particles: Particles<Dim2>,
        smoothing: f64,
    ) -> Result<Self, ValidateError> {
        let mut settings = Settings::for_scheme(case.scheme.scheme());
        settings.smoothing = smoothing;
        settings.courant = case.courant();
        settings.limiter = case.limiter().unwrap_or(settings.limiter);
        if case.scheme != SchemeName::TkcHancock {
            // The published schemes know no volume consistency.
            settings.volume_consistency = None;
        }
        let simulation = Simulation::new(domain, vec![material], particles, settings)
            .map_err(|source| ValidateError::Setup { case, source })?;
        let energy = energies(&simulation);
        Ok(Self { case, simulation, started: Instant::now(), energy })
    }

    /// One step, ending at `end` [s] at the latest.
    fn step(&mut self, end: f64) -> Result<(), ValidateError> {
        let (case, time) = (self.case, self.simulation.time());
        match self.simulation.step_at_most(end - time) {
            Ok(_) => Ok(()),
            Err(source) => Err(ValidateError::Numerical { case, time, source }),
        }
    }

    /// Steps to `end` [s].
    fn advance(&mut self, end: f64, progress: Progress<'_>) -> Result<(), ValidateError> {
        // A remainder of round-off size is no step.
        while self.simulation.time() < end * (1.0 - 1e-12) {
            self.step(end)?;
            progress(self.simulation.time() / end);
        }
        Ok(())
    }

    /// Change of the total energy since the start, over the greater of the kinetic energies: e counts from the
    /// reference state, so that the total may be zero.
    fn energy_drift(&self) -> Measurement {
        let [kinetic, internal] = energies(&self.simulation);
        let change = (kinetic - self.energy[0]) + (internal - self.energy[1]);
        Measurement::error_of(Metric::EnergyDrift, change / kinetic.max(self.energy[0]))
    }

    fn cost(&self) -> Cost {
        let seconds = self.started.elapsed().as_secs_f64();
        Cost {
            particles: self.simulation.particles().len(),
            steps: self.simulation.step_count(),
            million_particle_steps_per_second: 1e-6 * self.simulation.particle_steps() as f64 / seconds,
            seconds,
        }
    }
}

/// Kinetic and internal energy [J/m].
fn energies(simulation: &Simulation<Dim2>) -> [f64; 2] {
    let totals = simulation.totals();
    [totals.kinetic_energy, totals.internal_energy]
}

/// A named material of the library.
pub(crate) fn material(name: &str) -> Result<Material, ValidateError> {
    library::material(name).map_err(|error| ValidateError::Material(error.to_string()))
}

/// A free particle of the first material on a square lattice, at rest and without stress.
fn particle_at(id: usize, position: [f64; 2], size: f64, density: f64) -> Particle<Dim2> {
    Particle::at_rest(id as u64, position.into(), density * size * size, size, density)
}
