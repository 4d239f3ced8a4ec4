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
//! Source: Howell and Ball, J. Comput. Phys. 175 (2002) 128; Rublev and Murzov (2024), section 2.1.3.

use std::sync::OnceLock;

use sph_core::geometry::concentric_rings;
use sph_core::{CoreError, Dim2, Domain, Particle, Particles};

use sph_io::field_image::FieldImage;
use sph_io::plot::{Axis, Figure, LegendPosition, Panel, Series};

use super::{About, Drawing, Picture, ReferenceKind, Suite};
use crate::case::{Case, SchemeName, Tier};
use crate::error::ValidateError;
use crate::metric::{Measurement, Metric};
use crate::outcome::{Curve, Field, Outcome};
use crate::plots;
use crate::reference::lagrangian::{Ends, Mesh, Scheme, Solid, Symmetry, Viscosity, Zone};
use crate::reference::verney::Shell;
use crate::run::{Run, material};
use crate::watch::Watch;

/// Inner radius R0 [m].
const INNER_RADIUS: f64 = 0.08;
/// Outer radius R1 [m].
const OUTER_RADIUS: f64 = 0.1;
/// Velocity U0 of the inner surface [m/s].
const VELOCITY: f64 = 208.55;
const SMOOTHING: f64 = 0.5;
const ZONES: usize = 400;
/// The stop is not looked for before this time [s]: waves across the wall do not stop the shell.
const EARLIEST_STOP: f64 = 60e-6;
/// How long both readings must have risen again [s].
const AFTER_STOP: f64 = 6e-6;
/// A shell that still moves inwards now does not stop [s].
const LATEST_STOP: f64 = 250e-6;

/// Inner radius at the stop from the mean of r² over the whole shell.
const STOP_RADIUS_BY_SQUARE: Metric = Metric::value("stop_radius_by_square", "mm");
/// Inner radius at the stop from the innermost ring of particles.
const STOP_RADIUS_BY_RING: Metric = Metric::value("stop_radius_by_ring", "mm");
/// Time of the stop of the innermost ring.
const STOP_TIME: Metric = Metric::value("stop_time", "us");

/// The suite.
pub struct Verny;

impl Suite for Verny {
    fn about(&self) -> About {
        About {
            name: "verny",
            title: "Verney's cylindrical shell",
            resolution: "rings of particles (D0 = 20 mm / n)",
            reference: ReferenceKind::External,
            gates: include_str!("../../validation/verny/gates.ron"),
        }
    }

    fn cases(&self, tier: Tier) -> Vec<Case> {
        let resolutions: &[u32] = match tier {
            Tier::Quick => &[5, 10],
            Tier::Full => &[5, 10, 20, 40],
        };
        Case::grid("verny", &SchemeName::ALL, resolutions)
    }

    fn work(&self, case: &Case) -> f64 {
        let n = f64::from(case.n);
        let steps = 140e-6 * 6400.0 * n / (OUTER_RADIUS - INNER_RADIUS) / case.scheme.courant();
        9.0 * std::f64::consts::PI * n * n * steps * case.scheme.price()
    }

    fn run(&self, case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
        run(case, watch)
    }

    fn pictures(&self, outcomes: &[&Outcome]) -> Result<Vec<Picture>, ValidateError> {
        let radius = Picture {
            name: "verny".into(),
            caption: "inner radius at the stop over the particle size, all schemes above, near the references below"
                .into(),
            drawing: Drawing::Plot(stop_radius_plot(outcomes)?),
        };
        let mut pictures = vec![radius];
        pictures.extend(plots::fields("verny", outcomes, image));
        Ok(pictures)
    }
}

/// The least of a reading over time.
#[derive(Clone, Copy, Debug)]
struct Least {
    value: f64,
    time: f64,
}

impl Least {
    const NONE: Self = Self { value: f64::INFINITY, time: 0.0 };

    fn see(&mut self, value: f64, time: f64) {
        if value < self.value {
            *self = Self { value, time };
        }
    }
}

/// Both readings of r² of the inner surface [m²], at their least.
struct Stop {
    /// From all of the material.
    all: Least,
    /// From its innermost layer.
    ring: Least,
}

impl Stop {
    const UNSEEN: Self = Self { all: Least::NONE, ring: Least::NONE };

    fn is_over(&self, time: f64) -> bool {
        time > EARLIEST_STOP && time > self.all.time.max(self.ring.time) + AFTER_STOP
    }

    /// Inner radii [mm] from all of the material and from its innermost layer.
    fn radii(&self) -> [f64; 2] {
        [self.all, self.ring].map(|least| 1e3 * least.value.sqrt())
    }

    /// The stop on the mesh, computed once a process.
    fn reference() -> &'static Self {
        static REFERENCE: OnceLock<Stop> = OnceLock::new();
        REFERENCE.get_or_init(Self::compute)
    }

    /// The numbers of the material are written out here, so that a fault of the library shows as an error.
    fn compute() -> Self {
        const DENSITY: f64 = 2785.0;
        let solid = Solid {
            pressure: &|density, energy| 5328.0 * 5328.0 * (density - DENSITY) + density * energy,
            shear_modulus: 27.6e9,
            yield_strength: 0.3e9,
            sound_speed: 6600.0,
        };
        let scheme = Scheme {
            symmetry: Symmetry::Cylindrical,
            ends: Ends::Free,
            cfl: 0.7,
            viscosity: Viscosity::default(),
        };
        let rest = Zone { density: DENSITY, energy: 0.0, deviator: [0.0; 3] };
        let ends = [INNER_RADIUS, OUTER_RADIUS];
        let mut mesh = Mesh::new(solid, scheme, ends, ZONES, |_| rest, |r| -speed(r));
        let start = mesh.mean_square_radius();
        let mut stop = Self::UNSEEN;
        while !stop.is_over(mesh.time()) {
            mesh.step(mesh.time_step());
            stop.all.see(INNER_RADIUS.powi(2) + mesh.mean_square_radius() - start, mesh.time());
            stop.ring.see(mesh.radius()[0].powi(2), mesh.time());
        }
        stop
    }
}

/// Initial speed inwards [m/s] at radius `r` [m].
fn speed(r: f64) -> f64 {
    VELOCITY * INNER_RADIUS / r
}

/// Inner radius at the stop [mm] as the figure of the suite shows it: rigid-plastic formula, mesh by r².
fn references() -> Result<[f64; 2], ValidateError> {
    let material = material("aluminium-verney")?;
    let shell = Shell {
        inner_radius: INNER_RADIUS,
        outer_radius: OUTER_RADIUS,
        density: material.reference_density,
        yield_strength: material.strength.yield_strength(),
    };
    let formula = shell.stop_radius(VELOCITY).unwrap_or(f64::NAN);
    Ok([1e3 * formula, Stop::reference().radii()[0]])
}

/// Runs one resolution.
fn run(case: &Case, watch: Watch<'_>) -> Result<Outcome, ValidateError> {
    let material = material("aluminium-verney")?;
    let particles = particles(case.n, material.reference_density)
        .map_err(|error| ValidateError::Packing { case: case.to_string(), reason: error.to_string() })?;
    let reader = Reader::new(&particles);
    let mut settings = case.scheme.settings();
    settings.smoothing = SMOOTHING;
    let mut run = Run::new(case, watch, Domain::open(), material, particles, settings)?;
    let (mut stop, mut pictured) = (Stop::UNSEEN, 0.0);
    let mut fields = vec![start_field(&run)];
    while !stop.is_over(run.simulation.time()) {
        if run.simulation.time() >= LATEST_STOP {
            let reason = format!("the shell has not stopped after {:.1} us", 1e6 * LATEST_STOP);
            return Err(ValidateError::NotReached { case: case.to_string(), reason });
        }
        run.step(LATEST_STOP)?;
        let time = run.simulation.time();
        reader.read(&run, &mut stop);
        // The picture of the stop: the first step after the least of the mean square radius, the last such one.
        if time > EARLIEST_STOP && stop.all.time < time && pictured != stop.all.time {
            pictured = stop.all.time;
            fields.truncate(1);
            fields.push(stop_field(&run));
        }
        run.tell(time / 135e-6);
    }
    let curve = vec![(20.0 / f64::from(case.n), stop.radii()[0])];
    Ok(run.outcome(measurements(&stop), vec![Curve::new("stop", curve)], fields))
}

fn measurements(stop: &Stop) -> Vec<Measurement> {
    let exact = Stop::reference();
    let ([all, ring], [exact_all, exact_inner]) = (stop.radii(), exact.radii());
    vec![
        Measurement::new(STOP_RADIUS_BY_SQUARE, all, exact_all),
        Measurement::new(STOP_RADIUS_BY_RING, ring, exact_inner),
        Measurement::new(STOP_TIME, 1e6 * stop.ring.time, 1e6 * exact.ring.time),
    ]
}

/// Rings of spacing D0, the innermost first.
fn particles(rings: u32, density: f64) -> Result<Particles<Dim2>, CoreError> {
    let size = (OUTER_RADIUS - INNER_RADIUS) / f64::from(rings);
    let packing = concentric_rings(Default::default(), INNER_RADIUS, OUTER_RADIUS, size)?;
    let mut particles = Particles::default();
    for (point, volume) in packing.points().zip(&packing.volume) {
        let mut particle = Particle::at_rest(particles.len() as u64, point, density * volume, size, density);
        let radius = point.length();
        particle.velocity = point * (-speed(radius) / radius);
        particles.push(particle);
    }
    Ok(particles)
}

/// Reads r² of the inner surface from the particles: R0² and the change of the mean r², of all and of the innermost
/// ring. In an incompressible shell r² changes alike everywhere.
struct Reader {
    /// The innermost ring has the first identifiers: how many.
    innermost: u64,
    /// Mean r² of all and of the innermost ring at the start [m²].
    start: [f64; 2],
}

impl Reader {
    fn new(particles: &Particles<Dim2>) -> Self {
        let limit = square_radius(particles, 0) * (1.0 + 1e-9);
        let is_innermost = |i: &usize| square_radius(particles, *i) < limit;
        let innermost = (0..particles.len()).filter(is_innermost).count() as u64;
        let mut reader = Self { innermost, start: [0.0; 2] };
        reader.start = reader.means(particles);
        reader
    }

    /// Mean r² of all of the material and of its innermost ring [m²].
    fn means(&self, particles: &Particles<Dim2>) -> [f64; 2] {
        let (mut mass, mut all, mut ring) = (0.0, 0.0, 0.0);
        for i in 0..particles.len() {
            let square = square_radius(particles, i);
            mass += particles.mass[i];
            all += particles.mass[i] * square;
            if particles.id[i] < self.innermost {
                ring += square;
            }
        }
        [all / mass, ring / self.innermost as f64]
    }

    fn read(&self, run: &Run<'_, Dim2>, stop: &mut Stop) {
        let [all, ring] = self.means(run.simulation.particles());
        let time = run.simulation.time();
        stop.all.see(INNER_RADIUS.powi(2) + all - self.start[0], time);
        stop.ring.see(INNER_RADIUS.powi(2) + ring - self.start[1], time);
    }
}

fn square_radius(particles: &Particles<Dim2>, i: usize) -> f64 {
    particles.position[0][i].powi(2) + particles.position[1][i].powi(2)
}

/// The picture of the start: the radial speed inwards.
fn start_field(run: &Run<'_, Dim2>) -> Field {
    let particles = run.simulation.particles();
    let inwards = |i: usize| {
        let product: f64 = (0..2).map(|a| particles.position[a][i] * particles.velocity[a][i]).sum();
        -product / square_radius(particles, i).sqrt()
    };
    field(run, "start", ("radial speed inwards [m/s]", (160.0, 210.0)), inwards)
}

/// The picture of the stop: the von Mises stress.
fn stop_field(run: &Run<'_, Dim2>) -> Field {
    let particles = run.simulation.particles();
    let mises = |i: usize| {
        let [xx, yy, zz, xy]: [f64; 4] = std::array::from_fn(|k| particles.deviator[k][i]);
        1e-9 * (1.5 * (xx * xx + yy * yy + zz * zz + 2.0 * xy * xy)).sqrt()
    };
    field(run, "stop", ("σ_{vM} [GPa]", (0.0, 0.3)), mises)
}

fn field(
    run: &Run<'_, Dim2>,
    name: &str,
    (label, range): (&str, (f64, f64)),
    value: impl Fn(usize) -> f64,
) -> Field {
    let particles = run.simulation.particles();
    let millimeters = |column: &[f64]| column.iter().map(|x| 1e3 * x).collect();
    let size = 20.0 / f64::from(run.case.n);
    let extent = |i: usize| 1e3 * (particles.mass[i] / particles.density[i]).sqrt();
    let scheme = run.case.scheme.title();
    Field {
        name: name.into(),
        title: match name {
            "start" => format!("start, D_0 = {size} mm"),
            _ => format!("{scheme}, D_0 = {size} mm, t = {:.1} µs", 1e6 * run.simulation.time()),
        },
        label: label.into(),
        range,
        x: millimeters(&particles.position[0]),
        y: millimeters(&particles.position[1]),
        size: (0..particles.len()).map(extent).collect(),
        values: (0..particles.len()).map(value).collect(),
    }
}

/// One quadrant of the shell.
fn image(field: &Field) -> FieldImage {
    let side = (0.0, 1.04e3 * OUTER_RADIUS);
    plots::field_image(field, side, side)
}

/// The inner radius at the stop over the particle size: all schemes above, near the references below.
fn stop_radius_plot(outcomes: &[&Outcome]) -> Result<Figure, ValidateError> {
    let [formula, by_square] = references()?;
    let size = |outcome: &Outcome| 20.0 / f64::from(outcome.case.n);
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
    let near = Axis::new("r'_0 [mm]").with_range(by_square - 0.08, formula + 0.05);
    let mut figure = Figure::stacked(
        "Inner radius at the stop (mean of r²)",
        Axis::log("particle size D_0 [mm]").with_ticks(&[0.5, 1.0, 2.0, 4.0]),
    )
    .with_panel(panel(Axis::new("r'_0 [mm]")).with_legend(LegendPosition::TopLeft))
    .with_panel(panel(near).with_legend(LegendPosition::Hidden));
    figure.panel_height = 360.0;
    Ok(figure)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_have_the_mass_and_energy_of_the_shell() {
        let particles = particles(10, 2785.0).expect("rings");
        let mass: f64 = particles.mass.iter().sum();
        let area = std::f64::consts::PI * (OUTER_RADIUS.powi(2) - INNER_RADIUS.powi(2));
        assert!((mass / (2785.0 * area) - 1.0).abs() < 1e-12);
        let square = |i: usize| particles.velocity[0][i].powi(2) + particles.velocity[1][i].powi(2);
        let energy: f64 = (0..particles.len()).map(|i| 0.5 * particles.mass[i] * square(i)).sum();
        // ½ ρ ∫ u² dA of u = -U0 R0/r.
        let exact = std::f64::consts::PI * 2785.0 * (VELOCITY * INNER_RADIUS).powi(2) * 1.25f64.ln();
        assert!((energy / exact - 1.0).abs() < 1e-4, "{energy} against {exact}");
    }

    /// An incompressible shell: r² falls by the same amount everywhere, and both readings give the inner radius.
    #[test]
    fn readings_of_an_incompressible_shell_are_its_inner_radius() {
        let mut particles = particles(8, 2785.0).expect("rings");
        let reader = Reader::new(&particles);
        let start = reader.means(&particles);
        let fall = INNER_RADIUS.powi(2) - 0.07f64.powi(2);
        for i in 0..particles.len() {
            let factor = (1.0 - fall / square_radius(&particles, i)).sqrt();
            (0..2).for_each(|a| particles.position[a][i] *= factor);
        }
        let end = reader.means(&particles);
        for k in 0..2 {
            let radius = (INNER_RADIUS.powi(2) + end[k] - start[k]).sqrt();
            assert!((radius - 0.07).abs() < 1e-12, "{radius}");
        }
        assert_eq!(reader.innermost, (std::f64::consts::TAU * 0.08125 / 0.0025).round() as u64);
    }

    #[test]
    fn references_are_the_known_ones() {
        let [formula, by_square] = references().expect("in the library");
        assert!((formula - 66.716).abs() < 5e-4, "{formula}");
        let inner = Stop::reference().radii()[1];
        assert!((by_square - 66.514).abs() < 1e-3 && (inner - 66.536).abs() < 1e-3, "{by_square} {inner}");
    }
}
