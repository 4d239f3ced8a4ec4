//! What can go wrong, as full sentences.

use std::fmt;

use crate::time_step::TimeStepReason;

/// A set-up that cannot be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SetupError {
    /// Settings outside their range.
    #[error("settings of the scheme: {}", .0.join("; "))]
    Settings(Vec<String>),
    /// A particle names a material that is not there.
    #[error("particle {particle} names material {material}, but there are {count}")]
    NoSuchMaterial {
        /// Particle id.
        particle: u64,
        /// Index that it names.
        material: u16,
        /// Number of materials.
        count: usize,
    },
    /// A material whose numbers cannot be.
    #[error("material {name}: {faults}")]
    Material {
        /// Name of the material.
        name: String,
        /// What is wrong with it.
        faults: String,
    },
    /// A particle whose state cannot be.
    #[error("particle {particle} has {field} = {value} ({unit})")]
    Particle {
        /// Particle id.
        particle: u64,
        /// Which field.
        field: &'static str,
        /// Its value, in `unit`.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A column that does not hold one value for each particle.
    #[error("column {name} has {length} values, but there are {count} particles")]
    Column {
        /// Name of the column.
        name: String,
        /// Its length.
        length: usize,
        /// Number of particles.
        count: usize,
    },
    /// A periodic axis without extent.
    #[error("the box is periodic along axis {axis}, but its period is {period} m")]
    Period {
        /// Axis: 0, 1, 2.
        axis: usize,
        /// Period [m].
        period: f64,
    },
    /// A saved list position that is not finite.
    #[error("the saved list position of particle {particle} is {value} m along axis {axis}")]
    ListPosition {
        /// Index of the particle.
        particle: usize,
        /// Axis: 0, 1, 2.
        axis: usize,
        /// The position [m].
        value: f64,
    },
    /// Saved list positions that do not fit the particles.
    #[error("saved list positions have lengths {lengths:?}, but there are {count} particles")]
    ListPositions {
        /// Number of positions, by axis.
        lengths: Vec<usize>,
        /// Number of particles.
        count: usize,
    },
}

/// Where in a step something was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The choice of the time step.
    TimeStep,
    /// The update of the state.
    Update,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TimeStep => "the choice of the time step",
            Self::Update => "the update of the state",
        })
    }
}

/// A step that could not be completed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// A particle has a density, energy or stress that cannot be.
    #[error(
        "particle {particle} at {} is broken after {stage} at t = {time:.6e} s: density {density:.6e} kg/m3, \
         specific internal energy {specific_internal_energy:.6e} J/kg; the step was {time_step:.3e} s long ({reason}); \
         hint: a smaller Courant number, or a tensile failure model",
        place(.position)
    )]
    Broken {
        /// Particle id.
        particle: u64,
        /// Position [m].
        position: Vec<f64>,
        /// Where it was found.
        stage: Stage,
        /// Time at the end of the step [s].
        time: f64,
        /// Length of the step [s].
        time_step: f64,
        /// Why it was as long.
        reason: TimeStepReason,
        /// Density [kg/m³].
        density: f64,
        /// Specific internal energy [J/kg].
        specific_internal_energy: f64,
    },
    /// Particles were changed from outside, and one of them cannot be.
    #[error("particles were changed before this step, and {0}")]
    Particle(SetupError),
    /// There is nothing to move.
    #[error("there are no particles")]
    Empty,
    /// The longest step that the caller allows is no length of time.
    #[error("the step may be at most {limit} s long: that must be a number above zero")]
    Limit {
        /// What the caller allows [s].
        limit: f64,
    },
    /// The time step has fallen to nothing.
    #[error(
        "the time step fell to {time_step:.3e} s at t = {time:.6e} s, limited by particle {particle} with a signal speed \
         of {signal_speed:.4e} m/s; hint: look for a particle with a runaway energy"
    )]
    TimeStep {
        /// Time step [s].
        time_step: f64,
        /// Time [s].
        time: f64,
        /// Id of the particle that limits it.
        particle: u64,
        /// Its c_l + |U_rel| [m/s].
        signal_speed: f64,
    },
}

fn place(position: &[f64]) -> String {
    let coordinates: Vec<String> = position.iter().map(|x| format!("{x:.6e}")).collect();
    format!("({}) m", coordinates.join(", "))
}
