//! Porous copper in the moving window where the pores shut: the jump conditions leave no freedom.
//!
//! Two round pores in each cell of 20 µm × 20 µm, m = 1.3514 at every resolution (n particles along an edge of the cell,
//! D = 20 µm / n, 13 (n/10)² of them cut out of each pore, the nearest to its middle). Box of 12 cells (14 at
//! 150 m/s), inlet of fixed velocity, 24 cells fed, means over the last 12. Every scheme has volume consistency here:
//! what is asked is the shock velocity once the packing agrees with the density. Contacts have the thermodynamic sound
//! speed, as in the program.
//!
//! Variants: u_p in m/s of the copper with strength; `strengthless-…` has a yield strength of 1 MPa in place of
//! 350 MPa (none at all would switch volume consistency off), which leaves the jump conditions exact; `200-theta-…` has a
//! wider kernel, h_ij = θ(D_i + D_j); `200-jitter` moves every particle of the sample by up to a tenth of D along each axis;
//! `200-precursor` runs twice, with volume consistency and without, and compares the stress of the precursor.
//!
//! Measured: shock velocity from the front and from the balance of mass, in % off the middle of what the jump
//! conditions allow (no deviator to 2Y/3 behind the shock: ± 0.2 %; a precursor of 0.20 GPa stands ahead); both against
//! each other; density of the packing over the particles' own.
//!
//! Reference: exact, [`sph_materials::porous`]: conservation and the same equation of state.

use std::time::Instant;

use sph_core::{Components, Dim2, Domain, Particle, Particles};
use sph_io::plot::{Axis, Figure, Series};
use sph_materials::porous::{PorousMedium, Precursor};
use sph_materials::{Material, SoundSpeedModel, Strength};
use sph_riemann::{Settings, VolumeConsistency};
use sph_window::{FeedSample, PlateauMargins, Window, WindowError, WindowSettings};

use super::window::{Averages, advance, outcome};
use super::{About, Drawing, Picture, ReferenceKind, Suite, disorder};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::{Curve, Outcome};
use crate::plots;
use crate::run::material;
use crate::watch::Watch;

/// Edge of the cell [m].
const CELL: f64 = 20e-6;
/// Cells that are fed.
const FED_CELLS: f64 = 24.0;
/// Particles cut out of each pore at ten particles along the edge.
const CUT: u32 = 13;
/// Stress of the precursor that stands ahead of the shock [Pa].
const PRECURSOR: f64 = 0.20e9;
/// Yield strength of the strengthless copper [Pa].
const LITTLE: f64 = 1e6;

/// Shock velocity from the front, off the jump conditions.
const FRONT: Metric = Metric::value("front_velocity_error", "%");
/// Shock velocity from the balance of mass, off the jump conditions.
const BALANCE: Metric = Metric::value("mass_balance_error", "%");
/// Difference of the two.
const DISAGREEMENT: Metric = Metric::value("front_less_balance", "%");
/// Density of the packing over the particles' own, less one.
const PACKING: Metric = Metric::value("packing_excess", "%");
/// Stress of the elastic precursor with volume consistency, off that without.
const PRECURSOR_CHANGE: Metric = Metric::value("precursor_change", "%");
/// Shock velocity from the front.
const VELOCITY: Metric = Metric::value("shock_velocity", "m/s");

/// Jitter of the particles where there is one [D].
const JITTER: f64 = 0.1;

/// A variant: its name, u_p [m/s], cells of the box, and what differs from copper with strength on a lattice, θ = 0.5.
struct Problem {
    variant: &'static str,
    velocity: f64,
    cells: f64,
    differs: Differs,
}

/// In what a variant differs.
#[derive(Clone, Copy, PartialEq)]
enum Differs {
    Not,
    /// No strength to speak of.
    Strengthless,
    /// Smoothing θ [-].
    Smoothing(f64),
    /// Jittered particles.
    Jittered,
    /// A second run without volume consistency, for the precursor.
    Precursor,
}

const PROBLEMS: [Problem; 10] = [
    Problem { variant: "150", velocity: 150.0, cells: 14.0, differs: Differs::Not },
    Problem { variant: "200", velocity: 200.0, cells: 12.0, differs: Differs::Not },
    Problem { variant: "250", velocity: 250.0, cells: 12.0, differs: Differs::Not },
    Problem { variant: "300", velocity: 300.0, cells: 12.0, differs: Differs::Not },
    Problem { variant: "200-theta-0.55", velocity: 200.0, cells: 12.0, differs: Differs::Smoothing(0.55) },
    Problem { variant: "200-theta-0.60", velocity: 200.0, cells: 12.0, differs: Differs::Smoothing(0.60) },
    Problem { variant: "200-jitter", velocity: 200.0, cells: 12.0, differs: Differs::Jittered },
    Problem { variant: "200-precursor", velocity: 200.0, cells: 12.0, differs: Differs::Precursor },
    Problem { variant: "strengthless-150", velocity: 150.0, cells: 12.0, differs: Differs::Strengthless },
    Problem { variant: "strengthless-300", velocity: 300.0, cells: 12.0, differs: Differs::Strengthless },
];

/// The suite.
pub struct WindowPorous;

impl Suite for WindowPorous {
    fn about(&self) -> About {
        About {
            name: "window-porous",
            title: "Porous copper in the moving window, shut pores",
            resolution: "particles along an edge of the cell",
            reference: ReferenceKind::Analytic,
            gates: include_str!("../../validation/window-porous/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let problems = match tier {
            Tier::Quick => &PROBLEMS[2..3],
            Tier::Full => &PROBLEMS[..],
        };
        let of_scheme = |problem: &Problem, scheme| {
            let resolutions = if tier == Tier::Quick { &[10] } else { problem.resolutions(scheme) };
            Case::grid_of("window-porous", problem.variant, &[scheme], resolutions)
        };
        let grid = |problem| SchemeName::ALL.into_iter().flat_map(move |scheme| of_scheme(problem, scheme));
        problems.iter().flat_map(grid).collect()
    }

    fn work(&self, case: &Case) -> f64 {
        let (problem, n) = (Problem::of(case), f64::from(case.n));
        let steps = FED_CELLS * n / (3.8 * problem.velocity) * 5500.0 / case.scheme.courant();
        let runs = if problem.differs == Differs::Precursor { 2.0 } else { 1.0 };
        0.85 * runs * problem.cells * n * n * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let started = Instant::now();
        let problem = Problem::of(case);
        let copper = problem.copper()?;
        let [low, high] = problem.exact(&copper)?;
        let fault = |source| ValidateError::Window { case: case.to_string(), source: Box::new(source) };
        let mut sample = sample(case.n, copper.reference_density).map_err(fault)?;
        if problem.differs == Differs::Jittered {
            sample = jittered(&sample, JITTER * CELL / f64::from(case.n)).map_err(fault)?;
        }
        let settings = WindowSettings {
            // Two cells behind the front and half a cell before the outlet, at every resolution.
            plateau: PlateauMargins { front: 2.0 * f64::from(case.n), outlet: 0.5 * f64::from(case.n) },
            ..WindowSettings::new(problem.cells * CELL, problem.velocity)
        };
        let mut solver = case.scheme.settings();
        solver.volume_consistency = Some(VolumeConsistency::default());
        if let Differs::Smoothing(smoothing) = problem.differs {
            solver.smoothing = smoothing;
        }
        let without = Settings { volume_consistency: None, ..solver };
        let mut window =
            Window::new(sample.clone(), vec![copper.clone()], solver, settings).map_err(fault)?;
        let means = advance(case, &mut window, watch, FED_CELLS * CELL)?;
        let mut measurements = measure(&window, &means, [low, high]);
        if problem.differs == Differs::Precursor {
            let mut other = Window::new(sample, vec![copper], without, settings).map_err(fault)?;
            let plain = advance(case, &mut other, watch, FED_CELLS * CELL)?;
            let change = 100.0 * (means.stress_ahead / plain.stress_ahead - 1.0);
            measurements.push(Measurement::error_of(PRECURSOR_CHANGE, change));
        }
        let off = 100.0 * (2.0 * means.front_velocity(&window) / (low + high) - 1.0);
        let curves = vec![Curve::new("error", vec![(problem.velocity, off)])];
        Ok(outcome(case, &window, measurements, curves, Vec::new(), started))
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let mut pictures = Vec::new();
        for (strong, name) in [(true, "window-porous"), (false, "window-porous-strengthless")] {
            let of_kind: Vec<&Outcome> =
                outcomes.iter().copied().filter(|o| Problem::of(&o.case).is_strong() == strong).collect();
            if !of_kind.is_empty() {
                pictures.push(picture(name, strong, &of_kind)?);
            }
        }
        Ok(pictures)
    }
}

impl Problem {
    fn of(case: &Case) -> &'static Self {
        PROBLEMS.iter().find(|problem| problem.variant == case.variant).unwrap_or(&PROBLEMS[0])
    }

    /// Resolutions of the full tier; the printed scheme costs four times the third.
    fn resolutions(&self, scheme: SchemeName) -> &'static [u32] {
        use SchemeName::{Csph, TkcHancock, TkcMuscl};
        match (self.differs, scheme) {
            (Differs::Not, TkcHancock) => &[10, 20, 40],
            (Differs::Not, Csph) => &[10, 20, 30],
            (Differs::Not, TkcMuscl) if self.variant == "250" => &[10, 20, 30],
            (Differs::Not, TkcMuscl) => &[10, 20],
            (Differs::Strengthless, TkcHancock) => &[10, 20, 30],
            (Differs::Smoothing(_) | Differs::Jittered | Differs::Precursor, TkcHancock) => &[10, 20],
            _ => &[],
        }
    }

    fn is_strong(&self) -> bool {
        self.differs != Differs::Strengthless
    }

    fn copper(&self) -> Result<Material, ValidateError> {
        copper(self.is_strong())
    }

    fn exact(&self, copper: &Material) -> Result<[f64; 2], ValidateError> {
        exact(copper, self.is_strong(), self.velocity)
    }
}

fn copper(strong: bool) -> Result<Material, ValidateError> {
    let mut copper = Material { sound_speed: SoundSpeedModel::Thermodynamic, ..material("porous-copper")? };
    if !strong {
        let shear_modulus = copper.strength.shear_modulus();
        copper.strength = Strength::PerfectPlastic { shear_modulus, yield_strength: LITTLE };
    }
    Ok(copper)
}

/// Least and greatest shock velocity [m/s] that the jump conditions allow.
fn exact(copper: &Material, strong: bool, velocity: f64) -> Result<[f64; 2], ValidateError> {
    let precursor = if strong { Precursor::Standing { stress: PRECURSOR } } else { Precursor::None };
    let porosity = 100.0 / f64::from(100 - 2 * CUT);
    let range = PorousMedium::with_porosity(copper, porosity, precursor)?.shock_velocity_range(velocity)?;
    Ok([range.lower, range.upper])
}

fn measure(window: &Window<Dim2>, means: &Averages, [low, high]: [f64; 2]) -> Vec<Measurement> {
    let exact = 0.5 * (low + high);
    let percent = |value: f64, exact: f64| 100.0 * (value / exact - 1.0);
    let (front, balance) = (means.front_velocity(window), means.balance_velocity(window));
    vec![
        Measurement::error_of(FRONT, percent(front, exact)),
        Measurement::error_of(BALANCE, percent(balance, exact)),
        Measurement::error_of(DISAGREEMENT, percent(front, balance)),
        Measurement::error_of(PACKING, percent(means.packing_density, means.own_density)),
        Measurement::new(VELOCITY, front, exact),
    ]
}

/// One cell of a square lattice of n × n particles less those of two pores.
fn sample(n: u32, density: f64) -> Result<FeedSample<Dim2>, WindowError> {
    let size = CELL / f64::from(n);
    let quarter = 0.25 * f64::from(n);
    let cut = [quarter, 3.0 * quarter].map(|middle| pore(n, middle)).concat();
    let mut particles = Particles::default();
    for site in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).filter(|site| !cut.contains(site)) {
        let position = [(f64::from(site.0) + 0.5) * size, (f64::from(site.1) + 0.5) * size].into();
        let id = particles.len() as u64;
        particles.push(Particle::at_rest(id, position, density * size * size, size, density));
    }
    let cell = Domain::new([0.0, 0.0].into(), [CELL, CELL].into(), Components::from_fn(|_| true));
    FeedSample::new(particles, cell)
}

/// The sample with every particle moved by up to `amplitude` [m] along each axis.
fn jittered(sample: &FeedSample<Dim2>, amplitude: f64) -> Result<FeedSample<Dim2>, WindowError> {
    let mut particles = sample.particles().clone();
    disorder::shake(&mut particles, amplitude);
    let cell = *sample.cell();
    for axis in 0..2 {
        let (lower, period) = (cell.lower[axis], cell.period(axis));
        particles.position[axis].iter_mut().for_each(|x| *x = lower + (*x - lower).rem_euclid(period));
    }
    FeedSample::new(particles, cell)
}

/// The sites nearest to the middle of a pore on the cell's diagonal, as many as the porosity asks for.
fn pore(n: u32, middle: f64) -> Vec<(u32, u32)> {
    let mut sites: Vec<(u32, u32)> = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).collect();
    let offset = |k: u32| (f64::from(k) + 0.5 - middle).abs();
    let distance = |&(i, j): &(u32, u32)| offset(i).hypot(offset(j));
    // Of sites equally far those nearest to the vertical go first: a cut that is symmetric still.
    let nearer = |a: &(u32, u32), b: &(u32, u32)| {
        (distance(a) - distance(b)).abs().lt(&1e-9).then(|| offset(a.0).total_cmp(&offset(b.0)))
    };
    sites.sort_by(|a, b| nearer(a, b).unwrap_or_else(|| distance(a).total_cmp(&distance(b))));
    sites.truncate((CUT * n * n / 100) as usize);
    sites
}

/// Distance of the shock velocity from the middle of what the jump conditions allow; at the scale of u_s nothing is seen.
fn picture(name: &str, strong: bool, outcomes: &[&Outcome]) -> Result<Picture, ValidateError> {
    let copper = copper(strong)?;
    let velocities = (12..=32).map(|k| 10.0 * f64::from(k));
    let half_range = |u_p: f64| {
        let [low, high] = exact(&copper, strong, u_p)?;
        Ok((u_p, 100.0 * (high - low) / (high + low)))
    };
    let upper = velocities.map(half_range).collect::<Result<Vec<(f64, f64)>, ValidateError>>()?;
    let lower: Vec<(f64, f64)> = upper.iter().map(|&(u_p, half)| (u_p, -half)).collect();
    let title = if strong { "Porous copper, shut pores" } else { "Strengthless porous copper, shut pores" };
    let y = Axis::new("u_s off the jump conditions [%]");
    let figure = Figure::new(title, Axis::new("u_p [m/s]"), y);
    let figure = plots::marks_by_scheme(figure, outcomes, "error")
        .with(plots::line(Series::dotted, "jump conditions, 2Y/3", &upper).with_color(plots::BLACK))
        .with(plots::line(Series::dashed, "jump conditions, no deviator", &lower).with_color(plots::BLACK));
    Ok(Picture {
        name: name.into(),
        caption: "shock velocity from the front at every resolution, off the middle of what the jump conditions allow".into(),
        drawing: Drawing::Plot(figure),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn porosity_is_the_same_at_every_resolution() {
        for n in [10, 20, 30, 40] {
            let sample = sample(n, 8960.0).expect("a cell");
            assert!((8960.0 / sample.mean_density() - 100.0 / 74.0).abs() < 1e-9, "n = {n}");
            let mean: f64 =
                sample.particles().position[0].iter().sum::<f64>() / sample.particles().len() as f64;
            assert!((mean / CELL - 0.5).abs() < 1e-9, "balanced about the middle: {mean}");
        }
    }

    #[test]
    fn jump_conditions_are_those_of_the_guide() {
        let [low, high] = exact(&copper(true).expect("copper"), true, 250.0).expect("a shock");
        assert!((low - 939.5).abs() < 0.2 && (high - 943.7).abs() < 0.2, "{low} {high}");
        let [low, high] = exact(&copper(false).expect("copper"), false, 250.0).expect("a shock");
        assert!(high - low < 0.02, "exact without strength: {low} {high}");
    }
}
