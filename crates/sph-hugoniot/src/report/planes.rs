//! Figure 8: the points beside theory, measurements and what was published, in four planes; and the fits.

use sph_io::Color;
use sph_io::plot::{Axis, Figure, LegendPosition, Panel, Series};
use sph_materials::porous::ShearBehind;

use super::curves::Curves;
use crate::curve::fit::{Fit, Form};
use crate::curve::points::{CurvePoint, Measured};
use crate::curve::theory::{TheoryCurve, TheoryState};
use crate::reference;

/// Pascals in a gigapascal.
const GIGA: f64 = 1e9;
/// Places of a curve.
const PLACES: u32 = 160;

/// A plane in which the Hugoniot is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// u_s over u_p.
    ShockVelocity,
    /// -σ_xx over u_p.
    StressVelocity,
    /// -σ_xx over ρ.
    StressDensity,
    /// -σ_xx over V.
    StressVolume,
}

impl Plane {
    /// All planes, with the names of their pictures.
    pub const ALL: [(Self, &'static str); 4] = [
        (Self::ShockVelocity, "hugoniot"),
        (Self::StressVelocity, "stress_velocity"),
        (Self::StressDensity, "stress_density"),
        (Self::StressVolume, "stress_volume"),
    ];

    fn axes(self) -> (Axis, Axis) {
        let stress = || Axis::new("−σ_{xx} [GPa]");
        match self {
            Self::ShockVelocity => (Axis::new("u_p [m/s]"), Axis::new("u_s [m/s]")),
            Self::StressVelocity => (Axis::new("u_p [m/s]"), stress()),
            Self::StressDensity => (Axis::new("ρ [g/cm^3]"), stress()),
            Self::StressVolume => (Axis::new("V [cm^3/g]"), stress()),
        }
    }

    /// Place of a state in the units of the axes.
    fn place(self, s: &TheoryState) -> (f64, f64) {
        let stress = s.stress / GIGA;
        match self {
            Self::ShockVelocity => (s.particle_velocity, s.shock_velocity),
            Self::StressVelocity => (s.particle_velocity, stress),
            Self::StressDensity => (s.density / 1e3, stress),
            Self::StressVolume => (1e3 / s.density, stress),
        }
    }

    /// Place of a point and its errors in the units of the axes.
    fn measured(self, p: &CurvePoint) -> (Measured, Measured) {
        let exact = |value| Measured { value, error: 0.0 };
        let scaled = |m: Measured, size: f64| Measured { value: m.value * size, error: m.error * size };
        let stress = scaled(p.stress, 1.0 / GIGA);
        match self {
            Self::ShockVelocity => (exact(p.particle_velocity), p.shock_velocity),
            Self::StressVelocity => (exact(p.particle_velocity), stress),
            Self::StressDensity => (scaled(p.density, 1e-3), stress),
            Self::StressVolume => (scaled(p.volume(), 1e3), stress),
        }
    }
}

/// A theory with its place in the legend.
struct Drawn {
    label: &'static str,
    color: Color,
    style: fn(&str, &[f64], &[f64]) -> Series,
    states: TheoryCurve,
}

const BLUE: Color = Color::CYCLE[0];
const VERMILION: Color = Color::CYCLE[1];
const GREEN: Color = Color::CYCLE[2];
const PURPLE: Color = Color::CYCLE[3];
const SKY: Color = Color::CYCLE[4];
const ORANGE: Color = Color::CYCLE[5];

/// The points beside all that is known, in one plane; curves that lie outside of it are left out.
pub fn plane(curves: &Curves<'_>, plane: Plane) -> Figure {
    let mut figure = everything(curves, plane);
    let (low, high) = figure.panels[0].y.range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    figure.panels[0].series.retain(|s| s.y.iter().any(|y| (low..=high).contains(y)));
    if plane == Plane::StressVelocity {
        // The curves fill the panel; the legend stands beside it.
        figure.width = 1200.0;
        return figure.with_legend(LegendPosition::Outside);
    }
    figure
}

fn everything(curves: &Curves<'_>, plane: Plane) -> Figure {
    let (mut x, mut y) = plane.axes();
    let title = format!("{}, m = {:.4}", curves.case.name, curves.theory_porosity());
    let shown = shown_points(curves, plane);
    let drawn = theories(curves);
    let extent = extent(curves, plane, &shown);
    y = y.with_range(extent.1.0, extent.1.1);
    x = x.with_range(extent.0.0, extent.0.1);
    let mut figure = Figure::new(title, x, y);
    figure = figure.with(points_series(&shown, "this run", BLUE, |p| p.settled));
    if shown.iter().any(|(p, ..)| !p.settled) {
        figure = figure.with(points_series(&shown, "not settled", Color::GRAY, |p| !p.settled));
    }
    for theory in drawn.iter().filter(|t| t.states.len() > 1) {
        let (x, y): (Vec<f64>, Vec<f64>) = theory.states.iter().map(|s| plane.place(s)).unzip();
        figure = figure.with((theory.style)(theory.label, &x, &y).with_color(theory.color));
    }
    if plane == Plane::ShockVelocity {
        for (k, data) in curves.data.iter().enumerate() {
            let column = |f: fn(&crate::curve::measured::DataPoint) -> f64| {
                data.points.iter().map(f).collect::<Vec<_>>()
            };
            let series =
                Series::points(&data.name, &column(|d| d.particle_velocity), &column(|d| d.shock_velocity))
                    .with_error(&column(|d| d.shock_velocity_error))
                    .with_x_error(&column(|d| d.particle_velocity_error))
                    .with_color(Color::CYCLE[(k + 5) % Color::CYCLE.len()]);
            figure = figure.with(series);
        }
    }
    figure
}

/// The same as u_s over u_p on a logarithmic axis, with the solid's own Hugoniot in sight.
pub fn with_solid(curves: &Curves<'_>) -> Figure {
    let mut figure = everything(curves, Plane::ShockVelocity);
    figure.x.range = None;
    figure.panels[0].y = Axis::log("u_s [m/s]");
    figure
}

fn shown_points<'c>(curves: &'c Curves<'_>, plane: Plane) -> Vec<(&'c CurvePoint, Measured, Measured)> {
    let place = |p| {
        let (x, y) = plane.measured(p);
        (p, x, y)
    };
    curves.curve.points.iter().map(place).collect()
}

fn points_series(
    shown: &[(&CurvePoint, Measured, Measured)],
    label: &str,
    color: Color,
    which: fn(&CurvePoint) -> bool,
) -> Series {
    let chosen: Vec<_> = shown.iter().filter(|(p, ..)| which(p)).collect();
    let column = |f: &dyn Fn(&(&CurvePoint, Measured, Measured)) -> f64| {
        chosen.iter().map(|c| f(c)).collect::<Vec<f64>>()
    };
    Series::points(label, &column(&|c| c.1.value), &column(&|c| c.2.value))
        .with_error(&column(&|c| c.2.error))
        .with_x_error(&column(&|c| c.1.error))
        .with_color(color)
}

/// All theories of the case, those behind first.
fn theories(curves: &Curves<'_>) -> Vec<Drawn> {
    let speeds = curves.speeds(PLACES);
    let theory = &curves.theory;
    let mut list = vec![
        Drawn {
            label: "solid, without pores",
            color: Color::GRAY,
            style: Series::dotted,
            states: theory.solid(&speeds),
        },
        Drawn {
            label: "snow-plow",
            color: Color::GRAY,
            style: Series::dashed,
            states: theory.snow_plow(&speeds),
        },
        Drawn {
            label: "pores shut, no deviator",
            color: Color::BLACK,
            style: Series::line,
            states: theory.shut_pores(&speeds, ShearBehind::None),
        },
        Drawn {
            label: "pores shut, deviator 2Y/3",
            color: Color::BLACK,
            style: Series::dashed,
            states: theory.shut_pores(&speeds, ShearBehind::Yielded),
        },
    ];
    if let Some(found) = &curves.quadratic {
        let states = theory.crushed(&speeds, found.curve);
        list.push(Drawn { label: "P-α, quadratic crush curve", color: GREEN, style: Series::line, states });
    }
    if reference::is_published_medium(curves.case) {
        let states = published(curves, &speeds);
        list.push(Drawn { label: "published fits (2024)", color: VERMILION, style: Series::line, states });
    }
    if curves.with_boade {
        let states = theory.boade(&speeds);
        list.push(Drawn {
            label: "measured: copper powder, Boade (1970)",
            color: PURPLE,
            style: Series::line,
            states,
        });
    }
    list
}

/// The published fits with stress and density by the jump conditions behind this run's precursor.
fn published(curves: &Curves<'_>, speeds: &[f64]) -> TheoryCurve {
    let rho = curves.curve.bulk_density;
    let state = |&u: &f64| {
        let u_s = reference::published_fit(u);
        TheoryState {
            particle_velocity: u,
            shock_velocity: u_s,
            stress: curves.curve.precursor_stress + rho * u_s * u,
            density: rho * u_s / (u_s - u),
        }
    };
    speeds.iter().filter(|u| **u <= reference::LIMIT).map(state).collect()
}

/// Ranges of both axes: those of the points (and measured data), a little wider; curves may run out.
fn extent(
    curves: &Curves<'_>,
    plane: Plane,
    shown: &[(&CurvePoint, Measured, Measured)],
) -> ((f64, f64), (f64, f64)) {
    let mut places: Vec<(f64, f64)> = shown.iter().map(|(_, x, y)| (x.value, y.value)).collect();
    if plane == Plane::ShockVelocity {
        let data = curves.data.iter().flat_map(|d| &d.points);
        places.extend(data.map(|d| (d.particle_velocity, d.shock_velocity)));
    }
    let wider = |values: Vec<f64>, floor: bool, alone: f64| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // One point alone spreads over nothing: what is around it is then of its own size.
        let margin = if high == low { alone * high.abs() } else { 0.1 * (high - low).max(0.05 * high.abs()) };
        (if floor { 0.0 } else { low - margin }, high + margin)
    };
    let is_velocity = matches!(plane, Plane::ShockVelocity | Plane::StressVelocity);
    // Densities differ by little where velocities and stresses differ by much.
    let x = wider(places.iter().map(|p| p.0).collect(), is_velocity, if is_velocity { 0.2 } else { 0.02 });
    let y = wider(places.iter().map(|p| p.1).collect(), plane != Plane::ShockVelocity, 0.2);
    (x, (y.0.max(0.0), y.1))
}

/// The fits with the band of the two-piece one, and what is left of the points in percent.
pub fn fits(curves: &Curves<'_>) -> Figure {
    let shown = shown_points(curves, Plane::ShockVelocity);
    let (low, high) = curves.curve.range().unwrap_or((0.0, 1.0));
    let speeds: Vec<f64> =
        (0..=PLACES).map(|k| low + (high - low) * f64::from(k) / f64::from(PLACES)).collect();
    let mut above =
        Panel::new(Axis::new("u_s [m/s]")).with(points_series(&shown, "this run", BLUE, |p| p.settled));
    let mut below = Panel::new(Axis::new("u_s over two-piece fit − 1 [%]"));
    let main = curves
        .fit(Form::TwoPiece)
        .or_else(|| curves.fit(Form::Quadratic))
        .or_else(|| curves.fit(Form::Linear));
    let colors = [(Form::Linear, SKY), (Form::Quadratic, ORANGE), (Form::TwoPiece, VERMILION)];
    for (form, color) in colors {
        let Some(fit) = curves.fit(form) else { continue };
        let values: Vec<f64> = speeds.iter().map(|&u| fit.shock_velocity(u)).collect();
        above = above.with(Series::line(form.name(), &speeds, &values).with_color(color));
        if let Some(main) = main {
            below = residual_curve(below, fit, main, &speeds, color);
        }
    }
    if let Some(main) = main {
        below.y.label = format!("u_s over {} fit − 1 [%]", main.form.name());
        let column = |f: &dyn Fn(&CurvePoint) -> f64| {
            shown.iter().filter(|s| s.0.settled).map(|s| f(s.0)).collect::<Vec<_>>()
        };
        let percent = |p: &CurvePoint| {
            100.0 * (p.shock_velocity.value / main.shock_velocity(p.particle_velocity) - 1.0)
        };
        let error = |p: &CurvePoint| 100.0 * p.shock_velocity.error / p.shock_velocity.value;
        let series = Series::points("", &column(&|p| p.particle_velocity), &column(&percent));
        below = below.with(series.with_error(&column(&error)).with_color(BLUE));
    }
    let title = format!("{}: fits, with 95 % confidence bands", curves.case.name);
    let mut figure = Figure::stacked(title, Axis::new("u_p [m/s]")).with_panel(above).with_panel(below);
    figure.panel_height = 320.0;
    figure
}

/// A fit over the main one, with its confidence band.
fn residual_curve(panel: Panel, fit: &Fit, main: &Fit, speeds: &[f64], color: Color) -> Panel {
    let percent = |u_s: f64, u: f64| 100.0 * (u_s / main.shock_velocity(u) - 1.0);
    let column = |f: &dyn Fn(f64) -> f64| speeds.iter().map(|&u| percent(f(u), u)).collect::<Vec<_>>();
    let middle = column(&|u| fit.shock_velocity(u));
    let panel = if fit.form == main.form {
        let low = column(&|u| fit.shock_velocity(u) - fit.band(u));
        let high = column(&|u| fit.shock_velocity(u) + fit.band(u));
        panel.with(Series::band("", speeds, &low, &high).with_color(color))
    } else {
        panel
    };
    panel.with(Series::line("", speeds, &middle).with_color(color))
}
