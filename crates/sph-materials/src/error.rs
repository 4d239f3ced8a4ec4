//! What can be wrong: with a material, with a name, with a wave that is asked for.

use thiserror::Error;

/// A number of a material that cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MaterialError {
    /// Infinite or not a number.
    #[error("material `{material}`: {field} = {value} {unit} is not a finite number")]
    NotFinite {
        /// Name of the material.
        material: String,
        /// Field that is wrong.
        field: &'static str,
        /// Its value, SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// Must be strictly greater than a bound.
    #[error("material `{material}`: {field} = {value} {unit} must be greater than {least}")]
    NotAbove {
        /// Name of the material.
        material: String,
        /// Field that is wrong.
        field: &'static str,
        /// Its value, SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// The bound.
        least: f64,
    },
    /// Must be strictly less than a bound.
    #[error("material `{material}`: {field} = {value} {unit} must be less than {bound}")]
    NotBelow {
        /// Name of the material.
        material: String,
        /// Field that is wrong.
        field: &'static str,
        /// Its value, SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// The bound.
        bound: f64,
    },
    /// Must be at least a bound.
    #[error("material `{material}`: {field} = {value} {unit} must not be less than {least}")]
    BelowLeast {
        /// Name of the material.
        material: String,
        /// Field that is wrong.
        field: &'static str,
        /// Its value, SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// The bound.
        least: f64,
    },
    /// The quasi-acoustic sound speed of a material whose reference state has no stiffness.
    #[error(
        "material `{material}`: no quasi-acoustic sound speed, since the bulk modulus at the reference density is zero; take the thermodynamic one"
    )]
    NoQuasiAcousticSpeed {
        /// Name of the material.
        material: String,
    },
}

/// A material that the library cannot give.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LibraryError {
    /// No material of that name.
    #[error("no material is named `{name}`; did you mean `{nearest}`? The library has: {}", known.join(", "))]
    UnknownMaterial {
        /// Name that was asked for.
        name: String,
        /// Known name with the fewest letters to change.
        nearest: &'static str,
        /// All known names.
        known: Vec<&'static str>,
    },
    /// The text of an entry does not read as an entry.
    #[error("material entry `{name}`: {message}")]
    Syntax {
        /// Name of the entry.
        name: String,
        /// What the reader said, with line and column.
        message: String,
    },
    /// A number has a unit that does not measure its quantity.
    #[error("material entry `{name}`: {field} has unit `{unit}`; known units of a {dimension} are {}", known.join(", "))]
    Unit {
        /// Name of the entry.
        name: String,
        /// Field of the number.
        field: &'static str,
        /// Unit that was written.
        unit: String,
        /// What the field measures.
        dimension: &'static str,
        /// Units that would do.
        known: Vec<&'static str>,
    },
    /// A number of an entry is out of its bounds.
    #[error("material entry `{name}`: {}", faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Invalid {
        /// Name of the entry.
        name: String,
        /// Every fault.
        faults: Vec<MaterialError>,
    },
}

/// A wave that cannot be; each message names the condition that breaks.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum HugoniotError {
    /// The piston does not push.
    #[error(
        "piston velocity {value} m/s must be positive and finite: a receding piston sends a release, not a shock"
    )]
    PistonVelocity {
        /// Piston velocity [m/s].
        value: f64,
    },
    /// The material has no Hugoniot elastic limit.
    #[error(
        "material `{material}` has no elastic limit: it needs a shear modulus and a finite yield strength that is not lost in its round-off"
    )]
    NoElasticLimit {
        /// Name of the material.
        material: String,
    },
    /// The elastic limit lies at a density that no shock from rest reaches.
    #[error(
        "material `{material}` yields at {density} kg/m³ in uniaxial strain, and no shock from rest reaches that density: its yield strength is too high for its shear modulus"
    )]
    ElasticLimitTooDense {
        /// Name of the material.
        material: String,
        /// Density at the elastic limit [kg/m³].
        density: f64,
    },
    /// No density gives the piston's velocity.
    #[error(
        "no state behind the shock moves at {piston_velocity} m/s: a single shock does not reach {density_limit} kg/m³"
    )]
    BeyondCompressionLimit {
        /// Piston velocity [m/s].
        piston_velocity: f64,
        /// Density that no shock passes; infinite where it grows without bound before that velocity [kg/m³].
        density_limit: f64,
    },
    /// Even the weakest plastic wave overtakes the precursor.
    #[error(
        "no two-wave structure: the weakest plastic wave ({plastic_speed} m/s) is not slower than the precursor ({precursor_speed} m/s)"
    )]
    PrecursorTooSlow {
        /// Speed of the elastic precursor [m/s].
        precursor_speed: f64,
        /// Speed of an infinitely weak plastic wave behind it [m/s].
        plastic_speed: f64,
    },
    /// No piston velocity makes the plastic wave catch the precursor.
    #[error("the plastic wave stays slower than the precursor up to a piston velocity of {searched_to} m/s")]
    NeverOverdriven {
        /// Highest piston velocity that was tried [m/s].
        searched_to: f64,
    },
    /// The porous medium is not lighter than its solid.
    #[error(
        "initial density {initial_density} kg/m³ must be positive and less than the solid's {solid_density} kg/m³"
    )]
    NotPorous {
        /// Density of the medium [kg/m³].
        initial_density: f64,
        /// Reference density of the solid [kg/m³].
        solid_density: f64,
    },
    /// A number of a porous medium that is infinite or not a number.
    #[error("{field} = {value} {unit} is not a finite number")]
    NotFinite {
        /// Which number.
        field: &'static str,
        /// Its value, SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A stress, speed or density of a porous medium that must be strictly greater than a bound.
    #[error("{field} = {value} {unit} must be finite and greater than {least}")]
    NotAbove {
        /// Which number.
        field: &'static str,
        /// Its value, SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// The bound.
        least: f64,
    },
    /// A stress, rate or distension of a porous medium that must be at least a bound.
    #[error("{field} = {value} {unit} must be finite and not less than {least}")]
    BadNumber {
        /// Which number.
        field: &'static str,
        /// Its value, SI.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// The least that would do.
        least: f64,
    },
    /// Heating outweighs compression: stress falls with density.
    #[error(
        "porosity {porosity} is not less than {limit}: the heat of compaction expands the solid more than the shock compresses it"
    )]
    AnomalousCompaction {
        /// Ratio of the densities of solid and medium [1].
        porosity: f64,
        /// Ratio from which on the Hugoniot is anomalous [1].
        limit: f64,
    },
    /// The shut-pore state would hang together by tension.
    #[error(
        "pores cannot be shut by a yielded solid at {piston_velocity} m/s: the mean pressure behind would be {pressure} Pa, below zero"
    )]
    MeanTension {
        /// Piston velocity [m/s].
        piston_velocity: f64,
        /// Mean pressure that would result [Pa].
        pressure: f64,
    },
    /// The piston is slower than the matter behind the precursor.
    #[error(
        "piston velocity {piston_velocity} m/s does not exceed the {precursor_velocity} m/s behind the precursor"
    )]
    BelowPrecursor {
        /// Piston velocity [m/s].
        piston_velocity: f64,
        /// Particle velocity behind the precursor [m/s].
        precursor_velocity: f64,
    },
    /// The compaction wave is not slower than its precursor.
    #[error(
        "the compaction wave ({wave_speed} m/s) is not slower than its precursor ({precursor_speed} m/s)"
    )]
    PrecursorOvertaken {
        /// Speed of the compaction wave [m/s].
        wave_speed: f64,
        /// Speed of the precursor [m/s].
        precursor_speed: f64,
    },
    /// The solid has no density for a pressure at the energy that goes with it.
    #[error(
        "no density of the solid from half of its reference density on has a pressure of {pressure} Pa at the energy that the jump conditions give"
    )]
    NoSolidDensity {
        /// Pressure that was asked for [Pa].
        pressure: f64,
    },
    /// A compaction curve leaves the matter behind the wave no denser than ahead of it.
    #[error(
        "the compaction curve leaves {density} kg/m³ at {stress} Pa, no more than the {density_ahead} kg/m³ behind the precursor: its distension is too large for this medium"
    )]
    NotCompacted {
        /// Stress behind the wave [Pa].
        stress: f64,
        /// Density that the curve gives there [kg/m³].
        density: f64,
        /// Density behind the precursor [kg/m³].
        density_ahead: f64,
    },
    /// A compaction curve was asked outside the range of its data.
    #[error("stress {stress} Pa lies outside the curve's range, {least} to {greatest} Pa")]
    OutsideCurve {
        /// Stress behind the wave [Pa].
        stress: f64,
        /// Stress of the precursor [Pa].
        least: f64,
        /// End of the data [Pa].
        greatest: f64,
    },
    /// A compaction curve was asked for a piston that is too fast for its data.
    #[error("piston velocity {piston_velocity} m/s is beyond the curve's data, which end at {greatest} m/s")]
    BeyondCurve {
        /// Piston velocity [m/s].
        piston_velocity: f64,
        /// Piston velocity at the end of the data [m/s].
        greatest: f64,
    },
}
