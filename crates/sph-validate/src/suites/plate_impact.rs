//! Symmetric plate impact: a copper flyer strikes a copper target twice as thick; reverberation, free-surface velocity.
//!
//! Flyer 3 mm, target 6 mm, 200 m/s, n columns in the target (D = 6 mm / n), a strip periodic across, both outer faces
//! free, θ = 0.5. Copper: Mie-Grüneisen, Y = 0.35 GPa, without tensile failure: the releases from both faces meet and
//! pull, and the tension is carried. 3.6 µs: precursor, plastic shock, pull-back and first ringing at the free face.
//!
//! Measured at the outermost column of the target, over time: the mean of |u - reference| until 2.9 µs, and of the rest; the times at which it passes
//! half of the way to the precursor's and to the full velocity; the mean velocity of the plateau (1.75 to 2.05 µs, in
//! impact of equal plates near the velocity of the flyer). The reference is read at the same matter, D/2 below the face.
//!
//! The rest of the history is apart since a lattice that is pulled with 3 GPa tears, the sooner the finer it is (instability in
//! tension; the case leaves failure out on purpose): what tears in the spall plane from 2.2 µs on reaches the face at 2.95 µs.
//!
//! Reference: the same plates on a Lagrangian mesh of 1800 zones ([`crate::reference::lagrangian`]).

use sph_core::{Dim2, Particles};
use sph_io::plot::{Axis, Figure};
use sph_materials::{Failure, Material};

use super::{About, Drawing, Picture, ReferenceKind, Suite, strip};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric, crossing, mean_absolute_difference};
use crate::outcome::{Curve, Outcome};
use crate::plots;
use crate::reference::lagrangian::{Ends, Mesh, Scheme, Solid, Symmetry, Viscosity, Zone};
use crate::run::{Run, material};
use crate::watch::Watch;

const FLYER: f64 = 3e-3;
const TARGET: f64 = 6e-3;
const VELOCITY: f64 = 200.0;
const DURATION: f64 = 3.6e-6;
/// Zones of the mesh in 9 mm.
const ZONES: usize = 1800;
/// Before any sign of the pulled matter in the spall plane reaches the face [s].
const PULLED: f64 = 2.9e-6;
/// Times between which the plateau is read [s].
const PLATEAU: (f64, f64) = (1.75e-6, 2.05e-6);
const SMOOTHING: f64 = 0.5;

/// Mean over time of |u - reference| at the free face, until the pulled matter shows there.
const FACE_VELOCITY_L1: Metric = Metric::norm("face_velocity_l1", "m/s");
/// The same of the rest of the history.
const LATE_VELOCITY_L1: Metric = Metric::norm("late_velocity_l1", "m/s");
/// Velocity of the plateau at the free face.
const PLATEAU_VELOCITY: Metric = Metric::value("plateau_velocity", "m/s");
/// Arrival of the precursor at the free face.
const PRECURSOR_ARRIVAL: Metric = Metric::value("precursor_arrival", "us");
/// Arrival of the plastic shock at the free face.
const SHOCK_ARRIVAL: Metric = Metric::value("shock_arrival", "us");

/// Velocity [m/s] over time [s].
type History = Vec<(f64, f64)>;

/// The suite.
pub struct PlateImpact;

impl Suite for PlateImpact {
    fn about(&self) -> About {
        About {
            name: "plate-impact",
            title: "Symmetric plate impact",
            resolution: "particles across the target",
            reference: ReferenceKind::External,
            gates: include_str!("../../validation/plate-impact/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[60, 120],
            Tier::Full => &[60, 120, 240],
        };
        Case::grid("plate-impact", &SchemeName::ALL, resolutions)
    }

    fn work(&self, case: &Case) -> f64 {
        let n = f64::from(case.n);
        let steps = DURATION * 5000.0 * n / TARGET / case.scheme.courant();
        9.0 * n * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let copper = copper()?;
        let size = TARGET / f64::from(case.n);
        let reference = reference(&copper, TARGET - 0.5 * size);
        let (particles, last) = particles(case.n, copper.reference_density);
        let domain = strip::domain([-FLYER, TARGET], size, false);
        let mut settings = case.scheme.settings();
        settings.smoothing = SMOOTHING;
        let mut run = Run::new(case, watch, domain, copper, particles, settings)?;
        let mut history: History = vec![(0.0, 0.0)];
        while run.simulation.time() < DURATION * (1.0 - 1e-12) {
            run.step(DURATION)?;
            let time = run.simulation.time();
            history.push((time, face_velocity(&run, last)));
            run.tell(time / DURATION);
        }
        let measurements = measure(&history, &reference);
        let shown = |history: History| history.into_iter().map(|(t, u)| (1e6 * t, u)).collect();
        let curves = vec![Curve::new("face", shown(history)), Curve::new("reference", shown(reference))];
        Ok(run.outcome(measurements, curves, Vec::new()))
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let title = "Symmetric plate impact of copper, 200 m/s: velocity of the free face";
        let figure = Figure::new(title, Axis::new("t [µs]"), Axis::new("u [m/s]"));
        let finest = outcomes.iter().max_by_key(|outcome| outcome.case.n);
        let reference = finest.map_or(&[][..], |outcome| outcome.curve("reference"));
        let mut pictures = vec![Picture {
            name: "plate-impact".into(),
            caption:
                "velocity of the free face of the target: precursor, shock, plateau, pull-back and ringing"
                    .into(),
            drawing: Drawing::Plot(plots::profiles(figure, outcomes, "face", ("1-D mesh", reference))),
        }];
        pictures.extend(plots::convergences(&self.about(), outcomes));
        Ok(pictures)
    }
}

/// The copper of the porous medium, without failure.
fn copper() -> Result<Material, ValidateError> {
    Ok(Material { failure: Failure::None, ..material("porous-copper")? })
}

/// Flyer and target, and the first identifier of the outermost column.
fn particles(n: u32, density: f64) -> (Particles<Dim2>, u64) {
    let size = TARGET / f64::from(n);
    let flyer = i64::from(n / 2);
    let particles = strip::particles(-flyer..i64::from(n), size, density, |x, particle| {
        particle.velocity = [if x < 0.0 { VELOCITY } else { 0.0 }, 0.0].into();
    });
    let last = (particles.len() - strip::ROWS as usize) as u64;
    (particles, last)
}

/// Mean velocity of the outermost column [m/s].
fn face_velocity(run: &Run<'_, Dim2>, first_of_column: u64) -> f64 {
    let particles = run.simulation.particles();
    let column = (0..particles.len()).filter(|&i| particles.id[i] >= first_of_column);
    column.map(|i| particles.velocity[0][i]).sum::<f64>() / f64::from(strip::ROWS)
}

/// Velocity over time of the matter that is at `place` [m] at the start, on the mesh.
fn reference(copper: &Material, place: f64) -> History {
    let pressure = |density: f64, energy: f64| copper.pressure(density, energy);
    let solid = Solid {
        pressure: &pressure,
        shear_modulus: copper.strength.shear_modulus(),
        yield_strength: copper.strength.yield_strength(),
        sound_speed: 5200.0,
    };
    let viscosity = Viscosity { quadratic: 2.0, linear: 0.1 };
    let scheme = Scheme { symmetry: Symmetry::Planar, ends: Ends::Free, cfl: 0.5, viscosity };
    let rest = Zone { density: copper.reference_density, energy: 0.0, deviator: [0.0; 3] };
    let width = (FLYER + TARGET) / ZONES as f64;
    let moving = |x: f64| if x.abs() < 0.1 * width { 0.5 } else { f64::from(x < 0.0) };
    let mut mesh = Mesh::new(solid, scheme, [-FLYER, TARGET], ZONES, |_| rest, |x| VELOCITY * moving(x));
    let node = (place + FLYER) / width;
    let below = (node.floor() as usize).min(ZONES - 1);
    let share = node - below as f64;
    let mut history = vec![(0.0, 0.0)];
    while mesh.time() < DURATION {
        mesh.step(mesh.time_step());
        let u = mesh.velocity();
        history.push((mesh.time(), (1.0 - share) * u[below] + share * u[below + 1]));
    }
    history
}

/// Value of a history at a time, linear between its points.
fn at(history: &[(f64, f64)], time: f64) -> f64 {
    let next = history.partition_point(|point| point.0 < time).clamp(1, history.len() - 1);
    let [(t0, u0), (t1, u1)] = [history[next - 1], history[next]];
    u0 + (time - t0) / (t1 - t0) * (u1 - u0)
}

fn measure(history: &[(f64, f64)], reference: &[(f64, f64)]) -> Vec<Measurement> {
    const TIMES: u32 = 2000;
    let times = |from: f64, to: f64| {
        (0..TIMES).map(move |k| from + (to - from) * (f64::from(k) + 0.5) / f64::from(TIMES))
    };
    let difference = |from: f64, to: f64| {
        mean_absolute_difference(times(from, to).map(|t| (at(history, t), at(reference, t))))
    };
    let plateau =
        |of: &[(f64, f64)]| times(PLATEAU.0, PLATEAU.1).map(|t| at(of, t)).sum::<f64>() / f64::from(TIMES);
    // The precursor lifts the face to 39 m/s: 15 m/s is passed by it, 120 m/s by the shock.
    let arrival = |of: &[(f64, f64)], level: f64| 1e6 * crossing(of, level, 1.3e-6).unwrap_or(f64::NAN);
    let beside = |metric, level| Measurement::new(metric, arrival(history, level), arrival(reference, level));
    vec![
        Measurement::error_of(FACE_VELOCITY_L1, difference(0.0, PULLED)),
        Measurement::error_of(LATE_VELOCITY_L1, difference(PULLED, DURATION)),
        Measurement::new(PLATEAU_VELOCITY, plateau(history), plateau(reference)),
        beside(PRECURSOR_ARRIVAL, 15.0),
        beside(SHOCK_ARRIVAL, 120.0),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flyer_has_half_of_the_target_and_all_of_the_momentum() {
        let (particles, last) = particles(60, 8960.0);
        assert_eq!(particles.len(), 6 * 90);
        assert_eq!(last as usize, particles.len() - 6);
        let moving = particles.velocity[0].iter().filter(|&&u| u == VELOCITY).count();
        assert_eq!(moving, 6 * 30);
        assert!((particles.position[0][last as usize] - (TARGET - 0.5 * TARGET / 60.0)).abs() < 1e-12);
    }

    /// Before the releases arrive the face of equal plates moves nearly with the flyer's velocity, and the precursor
    /// lifts it first, to twice its own particle velocity.
    #[test]
    fn reference_has_precursor_and_plateau() {
        let copper = copper().expect("in the library");
        let history = reference(&copper, TARGET);
        let limit = sph_materials::hugoniot::elastic_limit(&copper).expect("a limit");
        let lifted = at(&history, 1.36e-6);
        println!("face: {lifted} m/s, precursor {} m/s", limit.behind.particle_velocity);
        assert!((lifted / (2.0 * limit.behind.particle_velocity) - 1.0).abs() < 0.05, "{lifted}");
        let full = at(&history, 0.5 * (PLATEAU.0 + PLATEAU.1));
        assert!((full / VELOCITY - 1.0).abs() < 0.02, "{full}");
    }

    #[test]
    fn histories_are_linear_between_their_points() {
        let history = [(0.0, 0.0), (1.0, 2.0), (2.0, 2.0)];
        assert_eq!(at(&history, 0.25), 0.5);
        assert_eq!(at(&history, 5.0), 2.0);
    }
}
