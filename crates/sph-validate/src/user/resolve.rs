//! Schema → problem: required fields, defaults, ranges, and what the exact solution says. All faults are noted.

use sph_case::fault::name_hint;
use sph_case::units::{Number, Pressure, TimeKind, show};
use sph_case::{Checker, Faults, Field, Span};
use sph_materials::eos::{Linear, LinearGamma, Logarithmic, MieGruneisen};
use sph_materials::{EquationOfState, Failure, Material, SoundSpeedModel, Strength, library};

use super::User;
use super::schema::*;
use crate::case::SchemeName;
use crate::suites::Suite;
use crate::suites::riemann::{Problem, Riemann, Setup, SideState};

/// Resolutions that are accepted.
const RESOLUTIONS: (u64, u64) = (20, 20_000);
/// Moduli and strengths that are accepted [Pa].
const STRENGTH: (f64, f64) = (1.0, 1e13);

/// Turns what was written into a suite; `None` when a fault was noted, here or before.
pub fn resolve(schema: &CaseSchema, whole: &Span, faults: &Faults) -> Option<Box<dyn Suite>> {
    let r = Resolver { checker: Checker { faults } };
    let name = r.name(&schema.name, whole);
    let schemes = r.schemes(&schema.schemes);
    let resolutions = r.resolutions(&schema.resolutions, whole);
    let problem = schema.problem.required("problem", whole, faults);
    let span = schema.problem.span().unwrap_or(whole.clone());
    let user = |problem| {
        let (name, schemes, resolutions) = (name?, schemes?, resolutions?);
        Some(User { name, schemes, resolutions, problem })
    };
    let suite: Box<dyn Suite> = match problem? {
        ProblemSchema::Riemann(riemann) => {
            let setup = r.riemann(riemann, &span);
            Box::new(Riemann { user: Some(user(setup?)?) })
        }
    };
    faults.is_empty().then_some(suite)
}

struct Resolver<'f> {
    checker: Checker<'f>,
}

impl Resolver<'_> {
    fn faults(&self) -> &Faults {
        self.checker.faults
    }

    /// The name goes into file names.
    fn name(&self, field: &Field<String>, whole: &Span) -> Option<String> {
        let name = field.required("name", whole, self.faults())?;
        let is_good = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if !name.is_empty() && name.chars().all(is_good) {
            return Some(name.clone());
        }
        let message = format!("{name:?} cannot be a part of file names");
        self.checker.refuse(field.span().unwrap_or_default(), message, "letters, digits, `-` and `_`");
        None
    }

    fn schemes(&self, field: &Field<Vec<Field<SchemeName>>>) -> Option<Vec<SchemeName>> {
        match field {
            Field::Absent => Some(SchemeName::ALL.to_vec()),
            Field::Bad(_) => None,
            Field::Good(list, span) if list.is_empty() => {
                let hint = "`Csph`, `TkcMuscl`, `TkcHancock`; all if left out";
                self.checker.refuse(span.clone(), "no scheme is named".into(), hint);
                None
            }
            Field::Good(list, _) => {
                let mut schemes: Vec<SchemeName> =
                    list.iter().map(|scheme| scheme.get().copied()).collect::<Option<_>>()?;
                schemes.sort_unstable();
                schemes.dedup();
                Some(schemes)
            }
        }
    }

    fn resolutions(
        &self,
        field: &Field<Vec<Field<sph_case::units::Count>>>,
        whole: &Span,
    ) -> Option<Vec<u32>> {
        let list = field.required("resolutions", whole, self.faults())?;
        if list.is_empty() {
            let hint = "three or more show an order of convergence, such as [100, 200, 400]";
            self.checker.refuse(field.span().unwrap_or_default(), "no resolution is given".into(), hint);
            return None;
        }
        let (low, high) = RESOLUTIONS;
        let counts: Vec<Option<usize>> = list.iter().map(|n| self.checker.count(n, low, low, high)).collect();
        let mut resolutions: Vec<u32> =
            counts.into_iter().map(|n| u32::try_from(n?).ok()).collect::<Option<_>>()?;
        resolutions.sort_unstable();
        resolutions.dedup();
        Some(resolutions)
    }

    fn riemann(&self, riemann: &RiemannSchema, span: &Span) -> Option<Setup> {
        let material = self.material(&riemann.material, span);
        let left = self.state(&riemann.left, "left", span);
        let right = self.state(&riemann.right, "right", span);
        let length = self.checker.needed(&riemann.length, "length", span, 1e-9, 1e3);
        let duration = self.checker.needed(&riemann.time, "time", span, 1e-15, 10.0);
        let setup =
            Setup { material: material?, left: left?, right: right?, length: length?, duration: duration? };
        if !matches!(setup.material.equation_of_state, EquationOfState::Logarithmic(_)) {
            let span = riemann.material.span().unwrap_or(span.clone());
            let message =
                "the exact solution of the Riemann problem needs a logarithmic equation of state".into();
            self.checker.refuse(span, message, "`Logarithmic(…)`, or `Library(name: \"aluminium-riemann\")`");
            return None;
        }
        match Problem::new(&setup) {
            Ok(problem) => self.waves_stay_inside(&setup, &problem, &riemann.time).then_some(setup),
            Err(error) => {
                let hint =
                    "the problem has no exact solution of this kind; change stresses, velocities or strength";
                self.checker.refuse(span.clone(), error.to_string(), hint);
                None
            }
        }
    }

    /// The frozen ends are undisturbed as long as no wave reaches them.
    fn waves_stay_inside(
        &self,
        setup: &Setup,
        problem: &Problem,
        time: &Field<sph_case::units::Time>,
    ) -> bool {
        let (reach, half) = (problem.reach(), 0.5 * setup.length);
        let span = time.span().unwrap_or_default();
        if setup.left == setup.right {
            let hint = "give the sides different stresses or velocities";
            self.checker.refuse(span, "both sides are in the same state: there is no wave".into(), hint);
            return false;
        }
        // A tenth for the width that particles give to a front.
        let latest = setup.duration * 0.9 * half / reach;
        if setup.duration > latest {
            let shown = show::<TimeKind>(setup.duration);
            let message = format!(
                "the fastest wave runs {:.4} mm in {shown}, the domain ends at {:.4} mm",
                1e3 * reach,
                1e3 * half
            );
            self.checker.refuse(span, message, &format!("at most {}", show::<TimeKind>(latest)));
        }
        setup.duration <= latest
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

    fn material(&self, field: &Field<MaterialSchema>, group: &Span) -> Option<Material> {
        let schema = field.required("material", group, self.faults())?;
        let span = field.span().unwrap_or(group.clone());
        let material = match schema {
            MaterialSchema::Library(library) => self.library_material(library, &span),
            MaterialSchema::Logarithmic(m) => {
                let modulus = self.modulus(&m.bulk_modulus, "bulk_modulus", &span);
                let law = modulus.map(|bulk_modulus| Logarithmic { bulk_modulus });
                self.solid(
                    &m.density,
                    law.map(EquationOfState::Logarithmic),
                    (&m.shear_modulus, &m.yield_strength),
                    &span,
                )
            }
            MaterialSchema::Linear(m) => {
                let speed = self.checker.needed(&m.bulk_sound_speed, "bulk_sound_speed", &span, 1.0, 1e5);
                let law = speed.map(|bulk_sound_speed| Linear { bulk_sound_speed });
                self.solid(
                    &m.density,
                    law.map(EquationOfState::Linear),
                    (&m.shear_modulus, &m.yield_strength),
                    &span,
                )
            }
            MaterialSchema::LinearGamma(m) => {
                let speed = self.checker.needed(&m.bulk_sound_speed, "bulk_sound_speed", &span, 1.0, 1e5);
                let gamma = self.needed_number(&m.gamma, "gamma", &span, (1.0, 10.0));
                let law = speed.zip(gamma);
                let law = law.map(|(bulk_sound_speed, gamma)| LinearGamma { bulk_sound_speed, gamma });
                self.solid(
                    &m.density,
                    law.map(EquationOfState::LinearGamma),
                    (&m.shear_modulus, &m.yield_strength),
                    &span,
                )
            }
            MaterialSchema::MieGruneisen(m) => {
                let speed = self.checker.needed(&m.bulk_sound_speed, "bulk_sound_speed", &span, 1.0, 1e5);
                let slope = self.needed_number(&m.hugoniot_slope, "hugoniot_slope", &span, (0.0, 5.0));
                let gruneisen =
                    self.needed_number(&m.gruneisen_coefficient, "gruneisen_coefficient", &span, (0.0, 10.0));
                let law = speed.zip(slope).zip(gruneisen);
                let law = law.map(|((bulk_sound_speed, hugoniot_slope), gruneisen_coefficient)| {
                    MieGruneisen { bulk_sound_speed, hugoniot_slope, gruneisen_coefficient }
                });
                self.solid(
                    &m.density,
                    law.map(EquationOfState::MieGruneisen),
                    (&m.shear_modulus, &m.yield_strength),
                    &span,
                )
            }
        }?;
        for fault in material.validate().err().into_iter().flatten() {
            self.checker.refuse(span.clone(), fault.to_string(), "see the guide on materials");
        }
        Some(material)
    }

    fn modulus(&self, field: &Field<Pressure>, name: &str, span: &Span) -> Option<f64> {
        self.checker.needed(field, name, span, STRENGTH.0, STRENGTH.1)
    }

    fn needed_number(
        &self,
        field: &Field<Number>,
        name: &str,
        span: &Span,
        (low, high): (f64, f64),
    ) -> Option<f64> {
        field.required(name, span, self.faults())?;
        self.checker.number(field, low, low, high)
    }

    /// A named material; strength that is given beside the name replaces the library's.
    fn library_material(&self, m: &LibrarySchema, span: &Span) -> Option<Material> {
        let name = m.name.required("name", span, self.faults())?;
        let Ok(mut material) = library::material(name) else {
            let message = format!("no material of the library is called {name:?}");
            self.checker.refuse(
                m.name.span().unwrap_or_default(),
                message,
                &name_hint(name, &library::names()),
            );
            return None;
        };
        let given = |field: &Field<Pressure>, usual: f64| match field {
            Field::Absent => Some(usual),
            given => self.checker.quantity(given, STRENGTH.0, STRENGTH.1),
        };
        if !matches!((&m.shear_modulus, &m.yield_strength), (Field::Absent, Field::Absent)) {
            let shear_modulus = given(&m.shear_modulus, material.strength.shear_modulus());
            let yield_strength = given(&m.yield_strength, material.strength.yield_strength());
            material.strength = perfectly_plastic(shear_modulus?, yield_strength?);
        }
        Some(material)
    }

    fn solid(
        &self,
        density: &Field<sph_case::units::Density>,
        equation_of_state: Option<EquationOfState>,
        (shear_modulus, yield_strength): (&Field<Pressure>, &Field<Pressure>),
        span: &Span,
    ) -> Option<Material> {
        let density = self.checker.needed(density, "density", span, 1.0, 1e5);
        let shear_modulus = self.modulus(shear_modulus, "shear_modulus", span);
        let yield_strength = match yield_strength {
            Field::Absent => Some(f64::INFINITY),
            given => self.checker.quantity(given, STRENGTH.0, STRENGTH.1),
        };
        Some(Material {
            name: "solid".into(),
            reference_density: density?,
            equation_of_state: equation_of_state?,
            strength: perfectly_plastic(shear_modulus?, yield_strength?),
            failure: Failure::None,
            sound_speed: SoundSpeedModel::Thermodynamic,
        })
    }
}

/// Elastic where there is no limit.
fn perfectly_plastic(shear_modulus: f64, yield_strength: f64) -> Strength {
    if yield_strength.is_finite() {
        Strength::PerfectPlastic { shear_modulus, yield_strength }
    } else {
        Strength::Elastic { shear_modulus }
    }
}
