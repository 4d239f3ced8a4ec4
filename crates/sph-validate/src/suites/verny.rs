//! Verney's cylindrical shell: an aluminum tube that moves inwards until plastic work has stopped it.
//!
//! R0 = 0.08 m, R1 = 0.1 m, u(r) = -U0 R0/r with U0 = 208.55 m/s, both surfaces free, θ = 0.5. The full tube is filled
//! with n concentric rings of particles of spacing D0 = 20 mm / n, as many in a ring as fit at that spacing.
//!
//! Measured: the inner radius at the stop, sqrt(R0² + change of the mean of r²), over all of the material and over the
//! innermost ring. Both are the inner radius of an incompressible shell, in which r² changes alike everywhere.
//!
//! Reference: the same shell on a Lagrangian mesh ([`crate::reference::lagrangian`]), with the same two readings. The
//! rigid-plastic formula ([`crate::reference::verney`]) gives 66.716 mm and is shown beside it.
//!
//! A user's shell ([`Setup`]) is of the same kind, of any solid with a yield strength; its mesh has the material's own
//! equation of state.
//!
//! Source: Howell and Ball, J. Comput. Phys. 175 (2002) 128; Rublev and Murzov (2024), section 2.1.3.

use std::sync::OnceLock;

use sph_core::geometry::concentric_rings;
use sph_core::{CoreError, Dim2, Domain, Particle, Particles};

use sph_io::plot::{Axis, Figure, LegendPosition, Panel, Series};

pub use super::shell_stop::Setup;
use super::shell_stop::{Reader, Stop, Times, square_radius};
use super::{About, Drawing, Picture, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::gate::Significant;
use crate::metric::{Measurement, Metric};
use crate::outcome::{Curve, Field, Outcome};
use crate::plots;
use crate::run::Run;
use crate::user::User;
use crate::watch::Watch;

const SMOOTHING: f64 = 0.5;

/// Inner radius at the stop from the mean of r² over the whole shell.
const STOP_RADIUS_BY_SQUARE: Metric = Metric::value("stop_radius_by_square", "mm");
/// Inner radius at the stop from the innermost ring of particles.
const STOP_RADIUS_BY_RING: Metric = Metric::value("stop_radius_by_ring", "mm");
/// Time of the stop of the innermost ring.
const STOP_TIME: Metric = Metric::value("stop_time", "us");

/// The suite: the published shell, or a user's.
pub struct Verny {
    /// What the user asks for.
    user: Option<User<Setup>>,
    /// Computed once.
    reference: OnceLock<Stop>,
}

/// The published shell.
pub static PUBLISHED: Verny = Verny::new(None);

impl Verny {
    /// The published shell, or a user's.
    pub const fn new(user: Option<User<Setup>>) -> Self {
        Self { user, reference: OnceLock::new() }
    }

    fn setup(&self) -> Result<Setup, ValidateError> {
        match &self.user {
            Some(user) => Ok(user.problem.clone()),
            None => Setup::published(),
        }
    }

    fn times(&self, setup: &Setup) -> Times {
        match self.user {
            Some(_) => setup.times(),
            None => Times { earliest: 60e-6, after: 6e-6, latest: 250e-6 },
        }
    }

    /// The stop on the mesh.
    fn reference(&self, setup: &Setup) -> &Stop {
        let times = self.times(setup);
        self.reference.get_or_init(|| match self.user {
            Some(_) => Stop::of(setup, times),
            None => Stop::published(setup, times),
        })
    }
}

impl Suite for Verny {
    fn about(&self) -> About {
        About {
            name: "verny",
            title: "Verney's cylindrical shell",
            resolution: match self.user {
                Some(_) => "rings of particles across the wall",
                None => "rings of particles (D0 = 20 mm / n)",
            },
            reference: ReferenceKind::External,
            gates: match self.user {
                Some(_) => "",
                None => include_str!("../../validation/verny/gates.ron"),
            },
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        if let Some(user) = &self.user {
            return user.cases("verny");
        }
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[5, 10],
            Tier::Full => &[5, 10, 20, 40],
        };
        Case::grid("verny", &SchemeName::ALL, resolutions)
    }

    fn work(&self, case: &Case) -> f64 {
        let Ok(setup) = self.setup() else { return 1.0 };
        let n = f64::from(case.n);
        let sound = setup.material.longitudinal_sound_speed(setup.material.reference_density, 0.0);
        let time = 2.0 * self.times(&setup).earliest;
        let steps = time * sound * n / setup.wall() / case.scheme.courant();
        let around = std::f64::consts::PI * (setup.inner_radius + setup.outer_radius) / setup.wall();
        around * n * n * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        let setup = self.setup()?;
        run(case, watch, &setup, self.times(&setup), self.reference(&setup))
    }

    fn parameters(&self) -> String {
        self.user.as_ref().map_or(String::new(), |user| format!("{:?}", user.problem))
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let setup = self.setup()?;
        let radius = Picture {
            name: "verny".into(),
            caption: "inner radius at the stop over the particle size, all schemes above, near the references below"
                .into(),
            drawing: Drawing::Plot(stop_radius_plot(outcomes, &setup, self.reference(&setup))),
        };
        let mut pictures = vec![radius];
        // One quadrant of the shell.
        let side = (0.0, 1.04e3 * setup.outer_radius);
        pictures.extend(plots::fields("verny", outcomes, |field| plots::field_image(field, side, side)));
        Ok(pictures)
    }
}

/// Runs one resolution.
fn run(
    case: &Case,
    watch: Watch<'_>,
    setup: &Setup,
    times: Times,
    exact: &Stop,
) -> Result<Outcome, ValidateError> {
    let particles = particles(case.n, setup)
        .map_err(|error| ValidateError::Packing { case: case.to_string(), reason: error.to_string() })?;
    let reader = Reader::new(&particles, setup.inner_radius);
    let mut settings = case.scheme.settings();
    settings.smoothing = SMOOTHING;
    let mut run = Run::new(case, watch, Domain::open(), setup.material.clone(), particles, settings)?;
    let (mut stop, mut pictured) = (Stop::UNSEEN, 0.0);
    let mut fields = vec![start_field(&run, setup)];
    while !stop.is_over(run.simulation.time(), times) {
        if run.simulation.time() >= times.latest {
            let reason = format!("the shell has not stopped after {:.1} us", 1e6 * times.latest);
            return Err(ValidateError::NotReached { case: case.to_string(), reason });
        }
        run.step(times.latest)?;
        let time = run.simulation.time();
        reader.read(&run, &mut stop);
        // The picture of the stop: the first step after the least of the mean square radius, the last such one.
        if time > times.earliest && stop.all.time < time && pictured != stop.all.time {
            pictured = stop.all.time;
            fields.truncate(1);
            fields.push(stop_field(&run, setup));
        }
        run.tell(time / (1.04 * exact.ring.time + times.after));
    }
    let curve = vec![(1e3 * setup.wall() / f64::from(case.n), stop.radii()[0])];
    Ok(run.outcome(measurements(&stop, exact), vec![Curve::new("stop", curve)], fields))
}

fn measurements(stop: &Stop, exact: &Stop) -> Vec<Measurement> {
    let ([all, ring], [exact_all, exact_inner]) = (stop.radii(), exact.radii());
    vec![
        Measurement::new(STOP_RADIUS_BY_SQUARE, all, exact_all),
        Measurement::new(STOP_RADIUS_BY_RING, ring, exact_inner),
        Measurement::new(STOP_TIME, 1e6 * stop.ring.time, 1e6 * exact.ring.time),
    ]
}

/// Rings of spacing D0, the innermost first.
fn particles(rings: u32, setup: &Setup) -> Result<Particles<Dim2>, CoreError> {
    let (size, density) = (setup.wall() / f64::from(rings), setup.material.reference_density);
    let packing = concentric_rings(Default::default(), setup.inner_radius, setup.outer_radius, size)?;
    let mut particles = Particles::default();
    for (point, volume) in packing.points().zip(&packing.volume) {
        let mut particle = Particle::at_rest(particles.len() as u64, point, density * volume, size, density);
        let radius = point.length();
        particle.velocity = point * (-setup.speed(radius) / radius);
        particles.push(particle);
    }
    Ok(particles)
}

/// The picture of the start: the radial speed inwards.
fn start_field(run: &Run<'_, Dim2>, setup: &Setup) -> Field {
    let particles = run.simulation.particles();
    let inwards = |i: usize| {
        let product: f64 = (0..2).map(|a| particles.position[a][i] * particles.velocity[a][i]).sum();
        -product / square_radius(particles, i).sqrt()
    };
    // To the next ten beyond the slowest and the fastest.
    let (slowest, fastest) = (setup.speed(setup.outer_radius), setup.velocity);
    let range = (10.0 * (0.1 * slowest).floor(), 10.0 * (0.1 * fastest).ceil());
    field(run, setup, "start", ("radial speed inwards [m/s]", range), inwards)
}

/// The picture of the stop: the von Mises stress.
fn stop_field(run: &Run<'_, Dim2>, setup: &Setup) -> Field {
    let particles = run.simulation.particles();
    let mises = |i: usize| {
        let [xx, yy, zz, xy]: [f64; 4] = std::array::from_fn(|k| particles.deviator[k][i]);
        1e-9 * (1.5 * (xx * xx + yy * yy + zz * zz + 2.0 * xy * xy)).sqrt()
    };
    let greatest = 1e-9 * setup.material.strength.yield_strength();
    field(run, setup, "stop", ("σ_{vM} [GPa]", (0.0, greatest)), mises)
}

fn field(
    run: &Run<'_, Dim2>,
    setup: &Setup,
    name: &str,
    (label, range): (&str, (f64, f64)),
    value: impl Fn(usize) -> f64,
) -> Field {
    let particles = run.simulation.particles();
    let millimeters = |column: &[f64]| column.iter().map(|x| 1e3 * x).collect();
    let size = Significant(1e3 * setup.wall() / f64::from(run.case.n));
    let extent = |i: usize| 1e3 * (particles.mass[i] / particles.density[i]).sqrt();
    let scheme = run.case.scheme.title();
    Field {
        name: name.into(),
        title: match name {
            "start" => format!("start, D_0 = {size:.3} mm"),
            _ => format!("{scheme}, D_0 = {size:.3} mm, t = {:.1} µs", 1e6 * run.simulation.time()),
        },
        label: label.into(),
        range,
        x: millimeters(&particles.position[0]),
        y: millimeters(&particles.position[1]),
        size: (0..particles.len()).map(extent).collect(),
        values: (0..particles.len()).map(value).collect(),
    }
}

/// The inner radius at the stop over the particle size: all schemes above, near the references below.
fn stop_radius_plot(outcomes: &[&Outcome], setup: &Setup, exact: &Stop) -> Figure {
    let formula = 1e3 * setup.rigid_plastic().stop_radius(setup.velocity).unwrap_or(f64::NAN);
    let by_square = exact.radii()[0];
    let size = |outcome: &Outcome| 1e3 * setup.wall() / f64::from(outcome.case.n);
    let radius =
        |outcome: &Outcome| (size(outcome), outcome.curve("stop").first().map_or(f64::NAN, |point| point.1));
    let sizes = outcomes.iter().map(|outcome| size(outcome));
    let (least, greatest) = sizes.fold((f64::INFINITY, 0.0f64), |(a, b), d| (a.min(d), b.max(d)));
    // Flat series rather than annotations, so that they lie within the range of the plot.
    let flat = |style: fn(&str, &[f64], &[f64]) -> Series, label: &str, radius: f64| {
        let label = format!("{label}: {radius:.3} mm");
        style(&label, &[0.9 * least, 1.1 * greatest], &[radius, radius]).with_color(plots::BLACK)
    };
    let panel = |y: Axis| {
        let mut panel = Panel::new(y);
        for (label, points) in plots::by_kin(outcomes, radius) {
            panel = panel.with(plots::line(Series::line_with_points, &label, &points));
        }
        panel.with(flat(Series::dashed, "1-D mesh", by_square)).with(flat(
            Series::dotted,
            "rigid-plastic formula",
            formula,
        ))
    };
    let (low, high) = (by_square.min(formula), by_square.max(formula));
    let near = Axis::new("r'_0 [mm]").with_range(low - setup.inner_radius, high + 0.6 * setup.inner_radius);
    // Rounded: a tick is labeled with all digits of its number.
    let mut ticks: Vec<f64> = outcomes.iter().map(|outcome| (1e3 * size(outcome)).round() / 1e3).collect();
    ticks.sort_by(f64::total_cmp);
    ticks.dedup();
    let mut figure = Figure::stacked(
        "Inner radius at the stop (mean of r²)",
        Axis::log("particle size D_0 [mm]").with_ticks(&ticks),
    )
    .with_panel(panel(Axis::new("r'_0 [mm]")).with_legend(LegendPosition::TopLeft))
    .with_panel(panel(near).with_legend(LegendPosition::Hidden));
    figure.panel_height = 360.0;
    figure
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_have_the_mass_and_energy_of_the_shell() {
        let setup = Setup::published().expect("in the library");
        let particles = particles(10, &setup).expect("rings");
        let mass: f64 = particles.mass.iter().sum();
        let area = std::f64::consts::PI * (setup.outer_radius.powi(2) - setup.inner_radius.powi(2));
        assert!((mass / (2785.0 * area) - 1.0).abs() < 1e-12);
        let square = |i: usize| particles.velocity[0][i].powi(2) + particles.velocity[1][i].powi(2);
        let energy: f64 = (0..particles.len()).map(|i| 0.5 * particles.mass[i] * square(i)).sum();
        // ½ ρ ∫ u² dA of u = -U0 R0/r.
        let exact =
            std::f64::consts::PI * 2785.0 * (setup.velocity * setup.inner_radius).powi(2) * 1.25f64.ln();
        assert!((energy / exact - 1.0).abs() < 1e-4, "{energy} against {exact}");
    }

    /// An incompressible shell: r² falls by the same amount everywhere, and both readings give the inner radius.
    #[test]
    fn readings_of_an_incompressible_shell_are_its_inner_radius() {
        let setup = Setup::published().expect("in the library");
        let mut particles = particles(8, &setup).expect("rings");
        let reader = Reader::new(&particles, setup.inner_radius);
        let start = reader.means(&particles);
        let fall = setup.inner_radius.powi(2) - 0.07f64.powi(2);
        for i in 0..particles.len() {
            let factor = (1.0 - fall / square_radius(&particles, i)).sqrt();
            (0..2).for_each(|a| particles.position[a][i] *= factor);
        }
        let end = reader.means(&particles);
        for k in 0..2 {
            let radius = (setup.inner_radius.powi(2) + end[k] - start[k]).sqrt();
            assert!((radius - 0.07).abs() < 1e-12, "{radius}");
        }
        assert_eq!(reader.innermost, (std::f64::consts::TAU * 0.08125 / 0.0025).round() as u64);
    }

    #[test]
    fn references_are_the_known_ones() {
        let setup = Setup::published().expect("in the library");
        let formula = setup.rigid_plastic().stop_radius(setup.velocity).expect("it stops");
        assert!((formula - 0.066716).abs() < 5e-7, "{formula}");
        let [by_square, inner] = PUBLISHED.reference(&setup).radii();
        assert!((by_square - 66.514).abs() < 1e-3 && (inner - 66.536).abs() < 1e-3, "{by_square} {inner}");
        // A user's shell of the same numbers: other times of looking, the same stop.
        let [own_square, own_inner] = Stop::of(&setup, setup.times()).radii();
        assert!((own_square - by_square).abs() < 1e-3 && (own_inner - inner).abs() < 1e-3);
    }
}
