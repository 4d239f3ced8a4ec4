//! Spall: a flyer of copper hits a target two and a half times as thick at 100 m/s; the releases from both free surfaces
//! meet inside of the target and tear it.
//!
//! Four rows of particles, periodic in y, D = flyer / n; copper without strength, so that the wave diagram is simple, with
//! T = 1 GPa. Variants: `cutoff` ([`sph_materials::Failure::TensileCutoff`]) and `voids`
//! ([`sph_materials::Failure::VoidGrowth`]).
//!
//! Measured: the thickness of the scab, by the mass behind the widest gap between columns, against the place where the
//! wave diagram first reaches T (`WaveDiagram`); and the tensile strength that an experiment would read from the
//! pull-back of the rear surface, T = ½ ρ0 c0 Δu (Novikov).
//!
//! Source: wave diagram of plate impact, e.g. T. Antoun et al., *Spall Fracture*, Springer (2003), chapters 2 and 4.

use sph_core::{Dim2, Domain, Particles};
use sph_materials::{EquationOfState, Failure, Material, Strength, VoidGrowth};

use super::{About, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::{Curve, Outcome};
use crate::run::{Run, material, particle_at};
use crate::watch::Watch;

/// Thickness of the flyer [m].
const FLYER: f64 = 1e-3;
/// Thickness of the target over that of the flyer.
const RATIO: f64 = 2.5;
/// Velocity of the flyer [m/s].
const SPEED: f64 = 100.0;
/// Tensile strength [Pa].
const TENSILE_STRENGTH: f64 = 1e9;
const ROWS: u32 = 4;
/// End of a run [s]: the scab has torn off and rung once.
const DURATION: f64 = 1.5e-6;

/// Thickness of the scab, undeformed.
const SCAB: Metric = Metric::converging_value("scab_thickness", "mm");
/// Strength read from the pull-back.
const PULL_BACK: Metric = Metric::value("pull_back_strength", "GPa");
/// Layers without tensile strength at the end, in the target.
const TORN: Metric = Metric::value("torn_layers", "-");
/// Velocity of the rear surface [m/s] over time [µs].
const HISTORY: &str = "rear surface";

/// The suite.
pub struct Spall;

impl Suite for Spall {
    fn about(&self) -> About {
        About {
            name: "spall",
            title: "Spall of a copper plate",
            resolution: "particles across the flyer",
            reference: ReferenceKind::Analytic,
            gates: include_str!("../../validation/spall/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[25, 50],
            Tier::Full => &[25, 50, 100, 200],
        };
        let of_variant =
            |variant: &&str| Case::grid_of("spall", variant, &[SchemeName::TkcHancock], resolutions);
        ["cutoff", "voids"].iter().flat_map(of_variant).collect()
    }

    fn work(&self, case: &Case) -> f64 {
        let n = f64::from(case.n);
        let steps = DURATION * 4200.0 * n / FLYER / case.scheme.courant();
        f64::from(ROWS) * (1.0 + RATIO) * n * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let copper = copper(&case.variant)?;
        let diagram = WaveDiagram::new(&copper)?;
        let size = FLYER / f64::from(case.n);
        let domain = Domain::new([-1.0, 0.0].into(), [1.0, f64::from(ROWS) * size].into(), [false, true]);
        let particles = plates(case.n, &copper);
        let mut run = Run::new(case, watch, domain, copper, particles, case.scheme.settings())?;
        let mut history = Vec::new();
        while run.simulation.time() < DURATION * (1.0 - 1e-12) {
            run.step(DURATION)?;
            run.tell(run.simulation.time() / DURATION);
            history.push((1e6 * run.simulation.time(), rear_velocity(&run)));
        }
        let columns = columns(run.simulation.particles());
        let behind = columns.len() - widest_gap(&columns);
        let torn = columns[case.n as usize..].iter().filter(|column| column.torn).count();
        let measurements = vec![
            Measurement::new(SCAB, 1e3 * size * behind as f64, 1e3 * diagram.scab_thickness()),
            Measurement::new(
                PULL_BACK,
                1e-9 * diagram.strength_of(pull_back(&history)),
                1e-9 * TENSILE_STRENGTH,
            ),
            Measurement::error_of(TORN, torn as f64),
        ];
        Ok(run.outcome(measurements, vec![Curve::new(HISTORY, history)], Vec::new()))
    }
}

fn copper(variant: &str) -> Result<Material, ValidateError> {
    let mut copper = material("porous-copper")?;
    copper.strength = Strength::Fluid;
    copper.failure = match variant {
        "voids" => Failure::VoidGrowth(VoidGrowth::of_strength(TENSILE_STRENGTH)),
        _ => Failure::TensileCutoff { tensile_strength: TENSILE_STRENGTH },
    };
    Ok(copper)
}

/// The flyer at x < 0 with its velocity, the target at rest; identifiers count the columns from the left.
fn plates(n: u32, copper: &Material) -> Particles<Dim2> {
    let size = FLYER / f64::from(n);
    let target = (RATIO * f64::from(n)).round() as u32;
    let mut particles = Particles::default();
    for column in 0..n + target {
        for row in 0..ROWS {
            let x = (f64::from(column) - f64::from(n) + 0.5) * size;
            let y = (f64::from(row) + 0.5) * size;
            let mut particle =
                particle_at::<Dim2>(particles.len(), [x, y].into(), size, copper.reference_density);
            particle.velocity.x = if column < n { SPEED } else { 0.0 };
            particles.push(particle);
        }
    }
    particles
}

/// A column of particles.
#[derive(Clone, Copy, Debug, Default)]
struct Column {
    /// Mean place [m].
    x: f64,
    /// Whether most of it carries no tension.
    torn: bool,
}

fn columns(particles: &Particles<Dim2>) -> Vec<Column> {
    let rows = ROWS as usize;
    let mut columns = vec![(0.0, 0); particles.len() / rows];
    for i in 0..particles.len() {
        let column = &mut columns[particles.id[i] as usize / rows];
        column.0 += particles.position[0][i] / f64::from(ROWS);
        column.1 += u32::from(particles.failed[i]);
    }
    columns.into_iter().map(|(x, failed)| Column { x, torn: 2 * failed > ROWS }).collect()
}

/// The first column behind the widest gap.
fn widest_gap(columns: &[Column]) -> usize {
    let gap = |k: &usize| columns[*k].x - columns[k - 1].x;
    (1..columns.len()).max_by(|a, b| gap(a).total_cmp(&gap(b))).unwrap_or(0)
}

fn rear_velocity(run: &Run<'_, Dim2>) -> f64 {
    let particles = run.simulation.particles();
    let first = (particles.len() - ROWS as usize) as u64;
    let rear = (0..particles.len()).filter(|&i| particles.id[i] >= first);
    rear.map(|i| particles.velocity[0][i]).sum::<f64>() / f64::from(ROWS)
}

/// From the greatest velocity of the rear surface to the least one after it [m/s].
fn pull_back(history: &[(f64, f64)]) -> f64 {
    let (mut greatest, mut deepest) = (f64::MIN, 0.0_f64);
    for &(_, velocity) in history {
        greatest = greatest.max(velocity);
        deepest = deepest.max(greatest - velocity);
    }
    deepest
}

/// Plane waves in two plates of one fluid with u_s = c + s u, in Lagrangian coordinates.
///
/// Both shocks run with U = c + s u, u half of the velocity of impact. The releases from the free surfaces are fans
/// centered where the shocks arrive. With the isentrope taken for the Hugoniot, P = ρ0 (c + s u) u, a characteristic of
/// pressure P runs with C(P) = c + 2 s u(P) (to the second order in u/c), and where one of each fan meet the pressure is
/// P_1 + P_2 - P_0.
struct WaveDiagram {
    density: f64,
    c: f64,
    s: f64,
}

impl WaveDiagram {
    fn new(copper: &Material) -> Result<Self, ValidateError> {
        let EquationOfState::MieGruneisen(law) = &copper.equation_of_state else {
            return Err(ValidateError::Material("the wave diagram needs a linear u_s(u_p)".into()));
        };
        Ok(Self { density: copper.reference_density, c: law.bulk_sound_speed, s: law.hugoniot_slope })
    }

    fn pressure(&self, velocity: f64) -> f64 {
        self.density * (self.c + self.s * velocity) * velocity
    }

    /// Pressure on the characteristic of a fan that runs with the mean speed `speed`, 0 to that of the shock.
    fn in_fan(&self, speed: f64) -> f64 {
        self.pressure(((speed - self.c) / (2.0 * self.s)).clamp(0.0, 0.5 * SPEED))
    }

    /// Pressure at the place x [m], target from 0 on, and time t [s] after the releases have met there.
    fn pressure_at(&self, x: f64, t: f64) -> f64 {
        let shock = self.c + self.s * 0.5 * SPEED;
        let from_flyer = self.in_fan((x + FLYER) / (t - FLYER / shock));
        let from_rear = self.in_fan((RATIO * FLYER - x) / (t - RATIO * FLYER / shock));
        from_flyer + from_rear - self.pressure(0.5 * SPEED)
    }

    /// Distance from the rear surface of the place that reaches the strength first [m].
    fn scab_thickness(&self) -> f64 {
        let shock = self.c + self.s * 0.5 * SPEED;
        // When a place reaches the strength: pressure falls with time there.
        let torn_at = |x: f64| {
            let (mut early, mut late) = (RATIO * FLYER / shock * (1.0 + 1e-9), 3.0 * RATIO * FLYER / self.c);
            for _ in 0..60 {
                let middle = 0.5 * (early + late);
                if self.pressure_at(x, middle) > -TENSILE_STRENGTH { early = middle } else { late = middle }
            }
            late
        };
        let places = (1..10_000).map(|k| RATIO * FLYER * f64::from(k) / 10_000.0);
        let first = places.min_by(|&a, &b| torn_at(a).total_cmp(&torn_at(b))).unwrap_or(0.0);
        RATIO * FLYER - first
    }

    /// Tensile strength [Pa] that a pull-back [m/s] tells of.
    fn strength_of(&self, pull_back: f64) -> f64 {
        0.5 * self.density * self.c * pull_back
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scab_of_the_diagram_is_a_little_thinner_than_the_flyer() {
        // Heads alone: h_t - ½(h_t - h_f)(1 + C/U), with C/U = 4080/4005.
        let diagram = WaveDiagram::new(&copper("cutoff").expect("in the library")).expect("linear");
        let heads = RATIO * FLYER - 0.5 * (RATIO - 1.0) * FLYER * (1.0 + 4080.0 / 4005.0);
        let thickness = diagram.scab_thickness();
        assert!((thickness - heads).abs() < 0.05 * FLYER, "{thickness} m, heads meet at {heads} m");
    }

    #[test]
    fn pull_back_is_read_after_the_peak() {
        let history = [(0.0, 0.0), (1.0, 100.0), (2.0, 45.0), (3.0, 80.0)];
        assert_eq!(pull_back(&history), 55.0);
    }
}
