//! The problems of a case, each with the conditions that its exact solution puts.

use sph_case::units::{LengthKind, Pressure, Time, TimeKind, Velocity, VelocityKind, show};
use sph_case::{Field, Span};
use sph_materials::hugoniot::{PistonWaves, elastic_limit, overdriven_threshold, piston as exact_waves};
use sph_materials::{EquationOfState, Material, Strength};

use super::super::schema::*;
use super::Resolver;
use crate::suites::riemann::{Problem, Setup, SideState};
use crate::suites::{piston, sound_wave, verny, window_solid};

/// Lengths that are accepted [m].
const LENGTH: (f64, f64) = (1e-9, 1e3);
/// Durations that are accepted [s].
const DURATION: (f64, f64) = (1e-15, 10.0);
/// Velocities of pistons, walls and pulses that are accepted [m/s].
const VELOCITY: (f64, f64) = (1e-6, 1e5);

impl Resolver<'_> {
    pub(super) fn riemann(&self, riemann: &RiemannSchema, span: &Span) -> Option<Setup> {
        let material = self.material(&riemann.material, span);
        let left = self.state(&riemann.left, "left", span);
        let right = self.state(&riemann.right, "right", span);
        let length = self.checker.needed(&riemann.length, "length", span, LENGTH.0, LENGTH.1);
        let duration = self.checker.needed(&riemann.time, "time", span, DURATION.0, DURATION.1);
        let setup =
            Setup { material: material?, left: left?, right: right?, length: length?, duration: duration? };
        if !matches!(setup.material.equation_of_state, EquationOfState::Logarithmic(_)) {
            let span = riemann.material.span().unwrap_or(span.clone());
            let message =
                "the exact solution of the Riemann problem needs a logarithmic equation of state".into();
            self.checker.refuse(span, message, "`Logarithmic(…)`, or `Library(name: \"aluminium-riemann\")`");
            return None;
        }
        let hint = "the problem has no exact solution of this kind; change stresses, velocities or strength";
        let problem = self.solved(Problem::new(&setup), span, hint)?;
        self.waves_stay_inside(&setup, &problem, &riemann.time).then_some(setup)
    }

    /// What an exact solver gives, or the condition that it names, as a fault.
    fn solved<T>(&self, result: Result<T, impl std::fmt::Display>, span: &Span, hint: &str) -> Option<T> {
        result.map_err(|error| self.checker.refuse(span.clone(), error.to_string(), hint)).ok()
    }

    fn waves_stay_inside(&self, setup: &Setup, problem: &Problem, time: &Field<Time>) -> bool {
        if setup.left == setup.right {
            let hint = "give the sides different stresses or velocities";
            let span = time.span().unwrap_or_default();
            self.checker.refuse(span, "both sides are in the same state: there is no wave".into(), hint);
            return false;
        }
        self.is_in_time(problem.reach(), 0.5 * setup.length, setup.duration, time)
    }

    /// The frozen ends are undisturbed as long as no wave reaches them: `reach` [m] is the way of the fastest wave in
    /// `duration` [s], `end` [m] what it has.
    fn is_in_time(&self, reach: f64, end: f64, duration: f64, time: &Field<Time>) -> bool {
        // A tenth for the width that particles give to a front.
        let latest = duration * 0.9 * end / reach;
        if duration > latest {
            let (way, shown) = (show::<LengthKind>(reach), show::<TimeKind>(duration));
            let message = format!(
                "the fastest wave runs {way} in {shown}, the domain ends at {}",
                show::<LengthKind>(end)
            );
            let span = time.span().unwrap_or_default();
            self.checker.refuse(span, message, &format!("at most {}", show::<TimeKind>(latest)));
        }
        duration <= latest
    }

    pub(super) fn piston(&self, schema: &PistonSchema, span: &Span) -> Option<piston::Setup> {
        let material = self.plastic_material(&schema.material, span);
        let velocity = self.checker.needed(&schema.velocity, "velocity", span, -VELOCITY.1, VELOCITY.1);
        let length = self.checker.needed(&schema.length, "length", span, LENGTH.0, LENGTH.1);
        let duration = self.checker.needed(&schema.time, "time", span, DURATION.0, DURATION.1);
        let setup = piston::Setup {
            material: material?,
            velocity: velocity?,
            length: length?,
            duration: duration?,
            mirrored: true,
        };
        let waves = self.waves(&setup.material, &schema.velocity, setup.velocity)?;
        if let PistonWaves::Overdriven { shock } = waves {
            let threshold = overdriven_threshold(&setup.material).map(show::<VelocityKind>);
            let message = format!(
                "the shock is overdriven: at u_p = {} it runs at {} and swallows its precursor",
                show::<VelocityKind>(setup.velocity),
                show::<VelocityKind>(shock.wave_speed)
            );
            let below = threshold.map_or("a lower velocity".into(), |u_p| format!("below {u_p}"));
            let hint = format!("{below} there are two waves; `Window(…)` takes an overdriven shock");
            self.checker.refuse(schema.velocity.span().unwrap_or(span.clone()), message, &hint);
            return None;
        }
        let reach = self.solved(setup.reach(), span, "change velocity or material")?;
        self.is_in_time(reach, setup.length, setup.duration, &schema.time).then_some(setup)
    }

    /// The waves ahead of a piston; an elastic wave alone is a fault.
    fn waves(&self, material: &Material, field: &Field<Velocity>, velocity: f64) -> Option<PistonWaves> {
        let span = field.span().unwrap_or_default();
        let waves =
            self.solved(exact_waves(material, velocity), &span, "a velocity that pushes, and not too far")?;
        if let PistonWaves::Elastic { .. } = waves {
            let limit = elastic_limit(material).map_or(0.0, |precursor| precursor.behind.particle_velocity);
            let message = format!(
                "there is no plastic wave: at u_p = {} the solid stays elastic",
                show::<VelocityKind>(velocity)
            );
            self.checker.refuse(span, message, &format!("it yields above {}", show::<VelocityKind>(limit)));
            return None;
        }
        Some(waves)
    }

    /// A solid that yields.
    fn plastic_material(&self, field: &Field<MaterialSchema>, group: &Span) -> Option<Material> {
        let material = self.material(field, group)?;
        if matches!(material.strength, Strength::PerfectPlastic { .. }) {
            return Some(material);
        }
        let message = format!("the solid `{}` does not yield: there is no plastic flow", material.name);
        let hint = "give it a `yield_strength`";
        self.checker.refuse(field.span().unwrap_or(group.clone()), message, hint);
        None
    }

    pub(super) fn window(&self, schema: &WindowSchema, span: &Span) -> Option<window_solid::Setup> {
        let material = self.plastic_material(&schema.material, span);
        let velocity = self.checker.needed(&schema.velocity, "velocity", span, -VELOCITY.1, VELOCITY.1);
        let fed = self.checker.count(&schema.fed, window_solid::FED.into(), 1000, 100_000);
        let setup = window_solid::Setup {
            material: material?,
            velocity: velocity?,
            fed: u32::try_from(fed?).unwrap_or(window_solid::FED),
        };
        self.waves(&setup.material, &schema.velocity, setup.velocity).map(|_| setup)
    }

    pub(super) fn sound_wave(&self, schema: &SoundWaveSchema, span: &Span) -> Option<sound_wave::Setup> {
        let material = self.material(&schema.material, span);
        let amplitude = self.checker.needed(&schema.amplitude, "amplitude", span, VELOCITY.0, VELOCITY.1);
        let needed = |field, name| self.checker.needed(field, name, span, LENGTH.0, LENGTH.1);
        let width = needed(&schema.width, "width");
        let length = needed(&schema.length, "length");
        let travel = needed(&schema.travel, "travel");
        let setup = sound_wave::Setup {
            material: material?,
            amplitude: amplitude?,
            width: width?,
            length: length?,
            travel: travel?,
        };
        let is_weak = self.wave_is_weak(&setup, schema);
        let is_alone = self.pulses_are_alone(&setup, schema);
        (is_weak && is_alone).then_some(setup)
    }

    /// The wave must stay elastic and must not steepen into a shock: the mesh has no artificial viscosity.
    fn wave_is_weak(&self, setup: &sound_wave::Setup, schema: &SoundWaveSchema) -> bool {
        let (material, strength) = (&setup.material, &setup.material.strength);
        let speed = material.longitudinal_sound_speed(material.reference_density, 0.0);
        let span = schema.amplitude.span().unwrap_or_default();
        // Uniaxial strain u/c of a half: σ_vM = 2 G u/c.
        let yielding = strength.yield_strength() * speed / strength.shear_modulus();
        if strength.yield_strength().is_finite() && setup.amplitude > yielding {
            let message = format!(
                "the wave is not elastic: an amplitude of {} makes the solid yield",
                show::<VelocityKind>(setup.amplitude)
            );
            let hint = format!("at most {}", show::<VelocityKind>(yielding));
            self.checker.refuse(span, message, &hint);
            return false;
        }
        // The steepest place, 0.6 a/w, breaks after about w/(2 a); a fifth of that leaves the pulse smooth.
        let greatest = 0.1 * setup.width * speed / setup.travel;
        if setup.amplitude > greatest {
            let message = format!(
                "a pulse of {} steepens towards a shock over {}",
                show::<VelocityKind>(setup.amplitude),
                show::<LengthKind>(setup.travel)
            );
            let hint = format!("at most {}, or a shorter way", show::<VelocityKind>(greatest));
            self.checker.refuse(span, message, &hint);
        }
        setup.amplitude <= greatest
    }

    /// The two pulses must have parted, and must not have met their images.
    fn pulses_are_alone(&self, setup: &sound_wave::Setup, schema: &SoundWaveSchema) -> bool {
        let (least, greatest) = (1.5 * setup.width, 0.5 * setup.length - 2.0 * setup.width);
        // Round-off of a sum of printed lengths is no fault.
        let is_good = setup.travel >= least && setup.travel <= greatest * (1.0 + 1e-9);
        if !is_good {
            let message = format!(
                "after {} the pulses of width {} overlap, each other or their images in a period of {}",
                show::<LengthKind>(setup.travel),
                show::<LengthKind>(setup.width),
                show::<LengthKind>(setup.length)
            );
            let hint = if greatest >= least {
                format!("from {} to {}", show::<LengthKind>(least), show::<LengthKind>(greatest))
            } else {
                format!("a period of {} or more", show::<LengthKind>(7.0 * setup.width))
            };
            self.checker.refuse(schema.travel.span().unwrap_or_default(), message, &hint);
        }
        is_good
    }

    pub(super) fn shell(&self, schema: &ShellSchema, span: &Span) -> Option<verny::Setup> {
        let material = self.plastic_material(&schema.material, span);
        let needed = |field, name| self.checker.needed(field, name, span, LENGTH.0, LENGTH.1);
        let (inner, outer) =
            (needed(&schema.inner_radius, "inner_radius"), needed(&schema.outer_radius, "outer_radius"));
        let (inner_radius, outer_radius) = inner.zip(outer)?;
        if outer_radius < 1.01 * inner_radius {
            let message = "the outer radius must be greater than the inner one".into();
            let hint = format!("more than {}", show::<LengthKind>(1.01 * inner_radius));
            self.checker.refuse(schema.outer_radius.span().unwrap_or_default(), message, &hint);
            return None;
        }
        let setup = verny::Setup { material: material?, inner_radius, outer_radius, velocity: 0.0 };
        let velocity = self.shell_velocity(schema, &setup, span)?;
        let setup = verny::Setup { velocity, ..setup };
        self.shell_stops(&setup, schema, span).then_some(setup)
    }

    /// As given, or that which would bring a rigid-plastic shell to the given radius [m/s].
    fn shell_velocity(&self, schema: &ShellSchema, setup: &verny::Setup, span: &Span) -> Option<f64> {
        match (&schema.velocity, &schema.stop_radius) {
            (Field::Absent, Field::Absent) => {
                let message = "neither `velocity` nor `stop_radius` is given".into();
                self.checker.refuse(span.clone(), message, "one of them");
                None
            }
            (Field::Absent, stop) => {
                let stop =
                    self.checker.quantity(stop, 0.05 * setup.inner_radius, 0.999 * setup.inner_radius)?;
                Some(setup.rigid_plastic().velocity(stop))
            }
            (velocity, Field::Absent) => self.checker.quantity(velocity, VELOCITY.0, VELOCITY.1),
            (velocity, _) => {
                let message =
                    "`velocity` and `stop_radius` are both given: one follows from the other".into();
                self.checker.refuse(velocity.span().unwrap_or(span.clone()), message, "one of them");
                None
            }
        }
    }

    /// The rigid-plastic shell must stop, and must flow well beyond the elastic strain.
    fn shell_stops(&self, setup: &verny::Setup, schema: &ShellSchema, span: &Span) -> bool {
        let span = schema.velocity.span().or(schema.stop_radius.span()).unwrap_or(span.clone());
        let (shell, strength) = (setup.rigid_plastic(), &setup.material.strength);
        let shown = show::<VelocityKind>(setup.velocity);
        let Some(stop) = shell.stop_radius(setup.velocity) else {
            let message =
                format!("the shell does not stop: at {shown} it has more energy than plastic work can take");
            self.checker.refuse(
                span,
                message,
                &format!("below {}", show::<VelocityKind>(shell.velocity(0.0))),
            );
            return false;
        };
        // Shear strain at yield of a shell that keeps its area, Y/(2√3 G); five times that is flow.
        let yielding = strength.yield_strength() / (2.0 * 3f64.sqrt() * strength.shear_modulus());
        let strain = (setup.inner_radius / stop).ln();
        if strain < 5.0 * yielding {
            let least = shell.velocity(setup.inner_radius * (-5.0 * yielding).exp());
            let message = format!(
                "there is hardly plastic flow: at {shown} the inner surface moves by {:.3} %, it yields at {:.3} %",
                100.0 * strain,
                100.0 * yielding
            );
            self.checker.refuse(span, message, &format!("at least {}", show::<VelocityKind>(least)));
        }
        strain >= 5.0 * yielding
    }

    fn state(&self, field: &Field<StateSchema>, name: &str, group: &Span) -> Option<SideState> {
        let state = field.required(name, group, self.faults())?;
        let stress = self.optional_pressure(&state.stress, -1e12, 1e12);
        let velocity = match &state.velocity {
            Field::Absent => Some(0.0),
            given => self.checker.quantity(given, -1e5, 1e5),
        };
        Some(SideState { stress: stress?, velocity: velocity? })
    }

    fn optional_pressure(&self, field: &Field<Pressure>, low: f64, high: f64) -> Option<f64> {
        match field {
            Field::Absent => Some(0.0),
            given => self.checker.quantity(given, low, high),
        }
    }
}
