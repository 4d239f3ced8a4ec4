//! The case file as it is written: every field optional, with its place; nothing checked but types and units.

use serde::Deserialize;
use sph_case::Field;
use sph_case::units::{Count, Density, Length, Number, Pressure, Time, Velocity};

use crate::case::SchemeName;

/// The whole file.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CaseSchema {
    /// What it is called in reports and file names.
    pub name: Field<String>,
    /// Number of the format.
    pub format: Field<Count>,
    /// The problem.
    pub problem: Field<ProblemSchema>,
    /// Schemes to run; all if left out.
    pub schemes: Field<Vec<Field<SchemeName>>>,
    /// Resolutions.
    pub resolutions: Field<Vec<Field<Count>>>,
}

/// The problem.
#[derive(Debug, Deserialize)]
pub enum ProblemSchema {
    /// Elastic-plastic Riemann problem.
    Riemann(RiemannSchema),
    /// Piston that pushes into a solid: precursor and plastic shock.
    Piston(PistonSchema),
    /// Longitudinal sound wave: a pulse of velocity splits in two.
    SoundWave(SoundWaveSchema),
    /// Cylindrical shell that moves inwards until plastic work has stopped it.
    Shell(ShellSchema),
    /// Steady shock in a solid, in the moving window.
    Window(WindowSchema),
}

/// Elastic-plastic Riemann problem.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RiemannSchema {
    /// The solid.
    pub material: Field<MaterialSchema>,
    /// State at x < 0.
    pub left: Field<StateSchema>,
    /// State at x > 0.
    pub right: Field<StateSchema>,
    /// Length of the domain.
    pub length: Field<Length>,
    /// Time of the comparison.
    pub time: Field<Time>,
}

/// Piston: the plane in which two equal blocks meet.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PistonSchema {
    /// The solid; with a yield strength.
    pub material: Field<MaterialSchema>,
    /// Velocity of the piston.
    pub velocity: Field<Velocity>,
    /// Length of a block.
    pub length: Field<Length>,
    /// Time of the comparison.
    pub time: Field<Time>,
}

/// Sound wave: U_x(0) = amplitude exp(-2 x²/width²).
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SoundWaveSchema {
    /// The solid.
    pub material: Field<MaterialSchema>,
    /// Greatest velocity at the start.
    pub amplitude: Field<Velocity>,
    /// Width of the pulse.
    pub width: Field<Length>,
    /// Period along x.
    pub length: Field<Length>,
    /// Way of the pulses until the comparison.
    pub travel: Field<Length>,
}

/// Cylindrical shell.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ShellSchema {
    /// The solid; with a yield strength.
    pub material: Field<MaterialSchema>,
    /// Inner radius R0.
    pub inner_radius: Field<Length>,
    /// Outer radius R1.
    pub outer_radius: Field<Length>,
    /// Velocity of the inner surface, inwards; or `stop_radius`.
    pub velocity: Field<Velocity>,
    /// Inner radius at which the shell would stop if it were rigid and plastic; or `velocity`.
    pub stop_radius: Field<Length>,
}

/// Steady shock in the moving window.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WindowSchema {
    /// The solid; with a yield strength.
    pub material: Field<MaterialSchema>,
    /// Velocity of the piston, u_p.
    pub velocity: Field<Velocity>,
    /// Length of the medium that is fed, in particle sizes.
    pub fed: Field<Count>,
}

/// A state of uniaxial loading from the undisturbed solid.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StateSchema {
    /// σ_xx, negative in compression; 0 if left out.
    pub stress: Field<Pressure>,
    /// u along x; 0 if left out.
    pub velocity: Field<Velocity>,
}

/// The solid: from the library, or in full, by its equation of state.
#[derive(Debug, Deserialize)]
pub enum MaterialSchema {
    /// A named material of the library; strength given here replaces the library's.
    Library(LibrarySchema),
    /// P = B ln(ρ/ρ0).
    Logarithmic(LogarithmicSchema),
    /// P = c0² (ρ - ρ0).
    Linear(LinearSchema),
    /// P = c0² (ρ - ρ0) + (Γ - 1) ρ e.
    LinearGamma(LinearGammaSchema),
    /// Mie-Grüneisen on the solid's linear shock Hugoniot.
    MieGruneisen(MieGruneisenSchema),
}

/// A named material.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LibrarySchema {
    /// Name in the library.
    pub name: Field<String>,
    /// Shear modulus G.
    pub shear_modulus: Field<Pressure>,
    /// Yield strength Y.
    pub yield_strength: Field<Pressure>,
}

/// P = B ln(ρ/ρ0).
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LogarithmicSchema {
    /// Density ρ0.
    pub density: Field<Density>,
    /// Bulk modulus B.
    pub bulk_modulus: Field<Pressure>,
    /// Shear modulus G.
    pub shear_modulus: Field<Pressure>,
    /// Yield strength Y.
    pub yield_strength: Field<Pressure>,
}

/// P = c0² (ρ - ρ0).
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LinearSchema {
    /// Density ρ0.
    pub density: Field<Density>,
    /// Bulk sound speed c0.
    pub bulk_sound_speed: Field<Velocity>,
    /// Shear modulus G.
    pub shear_modulus: Field<Pressure>,
    /// Yield strength Y.
    pub yield_strength: Field<Pressure>,
}

/// P = c0² (ρ - ρ0) + (Γ - 1) ρ e.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LinearGammaSchema {
    /// Density ρ0.
    pub density: Field<Density>,
    /// Bulk sound speed c0 of the undisturbed solid.
    pub bulk_sound_speed: Field<Velocity>,
    /// Γ.
    pub gamma: Field<Number>,
    /// Shear modulus G.
    pub shear_modulus: Field<Pressure>,
    /// Yield strength Y.
    pub yield_strength: Field<Pressure>,
}

/// Mie-Grüneisen on the solid's linear shock Hugoniot.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MieGruneisenSchema {
    /// Density ρ0.
    pub density: Field<Density>,
    /// c_a of u_s = c_a + s_a u_p.
    pub bulk_sound_speed: Field<Velocity>,
    /// s_a of u_s = c_a + s_a u_p.
    pub hugoniot_slope: Field<Number>,
    /// Grüneisen coefficient.
    pub gruneisen_coefficient: Field<Number>,
    /// Shear modulus G.
    pub shear_modulus: Field<Pressure>,
    /// Yield strength Y.
    pub yield_strength: Field<Pressure>,
}
