//! The case file as it is written: every field optional, with its place; nothing checked but types and units.
//!
//! [`super::resolve`] says which fields are required, what the defaults are, and which ranges hold.

use serde::Deserialize;
use sph_core::kernel::KernelFamily;
use sph_materials::SoundSpeedModel;
use sph_riemann::{Limiter, Scheme};

use super::field::Field;
pub use super::schema_medium::*;
use super::units::{Count, Density, Number, Pressure, Velocity, Viscosity};

/// The whole file.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CaseSchema {
    /// What it is called in reports.
    pub name: Field<String>,
    /// Number of the format.
    pub format: Field<Count>,
    /// The solid.
    pub material: Field<MaterialSchema>,
    /// Several materials, in place of one.
    pub materials: Field<Vec<Field<MaterialSchema>>>,
    /// Cell, pores and particles.
    pub medium: Field<MediumSchema>,
    /// How the equations are solved.
    pub scheme: Field<SchemeSchema>,
    /// The moving window.
    pub window: Field<WindowSchema>,
    /// How the frame in which the front stands is found.
    pub search: Field<SearchSchema>,
    /// Particle velocities u_p.
    pub points: Field<PointsSchema>,
    /// When a point has settled.
    pub stop: Field<StopSchema>,
    /// Measured curves to lay beside the computed one.
    pub data: Field<Vec<Field<DataSchema>>>,
    /// What is written.
    pub output: Field<OutputSchema>,
}

/// Particle velocities u_p; a plain list `[…]` is read as `List`.
#[derive(Debug, Deserialize)]
pub enum PointsSchema {
    /// Each of them.
    List(Vec<Field<Velocity>>),
    /// Evenly spaced.
    Range(RangeSchema),
    /// Evenly spaced at first, then where the curve bends.
    Adaptive(AdaptiveSchema),
}

/// Evenly spaced u_p: either a step or a count.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RangeSchema {
    /// Least u_p.
    pub from: Field<Velocity>,
    /// Greatest u_p.
    pub to: Field<Velocity>,
    /// Distance of neighbors.
    pub step: Field<Velocity>,
    /// Number of points, both ends included.
    pub count: Field<Count>,
}

/// u_p that are added where the curve bends.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AdaptiveSchema {
    /// Least u_p.
    pub from: Field<Velocity>,
    /// Greatest u_p.
    pub to: Field<Velocity>,
    /// Relative error of linear interpolation of u_s between neighbors.
    pub tolerance: Field<Number>,
    /// Points at most, the initial ones included.
    pub max_points: Field<Count>,
    /// Evenly spaced points at the start.
    pub initial_points: Field<Count>,
}

/// A measured curve.
#[derive(Debug, Deserialize)]
pub enum DataSchema {
    /// Pressed copper powder of Boade (1970).
    Boade1970,
    /// Points from a CSV file.
    Csv(CsvSchema),
}

/// Points from a CSV file.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CsvSchema {
    /// The file; relative to the case file's folder.
    pub file: Field<String>,
    /// Name in the legend; without it the source column or the file's name.
    pub name: Field<String>,
}

/// The solid: from the library, with changes, or in full.
#[derive(Debug, Deserialize)]
pub enum MaterialSchema {
    /// A named material of the library; fields given here replace the library's.
    Library(LibrarySchema),
    /// A Mie-Grüneisen solid with all its parameters.
    MieGruneisen(SolidSchema),
}

/// A named material and what is changed in it.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LibrarySchema {
    /// Name in the library.
    pub name: Field<String>,
    /// Another name for this case: a library's material may be used twice, with different changes.
    pub called: Field<String>,
    /// Shear modulus G.
    pub shear_modulus: Field<Pressure>,
    /// Yield strength Y.
    pub yield_strength: Field<Pressure>,
    /// Tensile strength T.
    pub tensile_strength: Field<Pressure>,
    /// What happens beyond it.
    pub tensile_failure: Field<FailureSchema>,
    /// Bulk sound speed of the contact.
    pub contact_sound_speed: Field<SoundSpeedModel>,
}

/// All parameters of a Mie-Grüneisen solid.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SolidSchema {
    /// What it is called.
    pub name: Field<String>,
    /// Density ρ0 of the undisturbed solid.
    pub density: Field<Density>,
    /// c_a of the solid's u_s = c_a + s_a u_p.
    pub bulk_sound_speed: Field<Velocity>,
    /// s_a of the solid's u_s = c_a + s_a u_p.
    pub hugoniot_slope: Field<Number>,
    /// Grüneisen coefficient γ.
    pub gruneisen_coefficient: Field<Number>,
    /// Shear modulus G; without it a fluid.
    pub shear_modulus: Field<Pressure>,
    /// Yield strength Y; without it elastic.
    pub yield_strength: Field<Pressure>,
    /// Tensile strength T; without it unlimited.
    pub tensile_strength: Field<Pressure>,
    /// What happens beyond it.
    pub tensile_failure: Field<FailureSchema>,
    /// Bulk sound speed of the contact.
    pub contact_sound_speed: Field<SoundSpeedModel>,
}

/// What happens beyond the tensile strength.
#[derive(Debug, Deserialize)]
pub enum FailureSchema {
    /// Neither tension nor shear until it is compressed again.
    Cutoff,
    /// Voids grow.
    VoidGrowth(VoidGrowthSchema),
}

/// Parameters of the growth of voids.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct VoidGrowthSchema {
    /// α0 of the voids that are there from the beginning.
    pub initial_distension: Field<Number>,
    /// η of the matrix.
    pub viscosity: Field<Viscosity>,
    /// φ_c at which voids meet.
    pub coalescence_porosity: Field<Number>,
}

/// How the equations are solved.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SchemeSchema {
    /// Scheme.
    pub scheme: Field<Scheme>,
    /// Limiter of the reconstruction.
    pub limiter: Field<Limiter>,
    /// Kernel.
    pub kernel: Field<KernelFamily>,
    /// θ in h_ij = θ(D_i + D_j).
    pub smoothing: Field<Number>,
    /// C in the time step C min D/(c_l + |U_rel|).
    pub cfl: Field<Number>,
    /// What replaces L⁻¹ at free surfaces.
    pub surface: Field<SurfaceSchema>,
    /// Skin of the neighbor lists in D; chosen from θ if left out.
    pub skin: Field<Number>,
    /// Relaxation of the density towards the particles' packing.
    pub volume_consistency: Field<VolumeConsistencySchema>,
    /// Closure of the faces between disordered particles.
    pub face_closure: Field<FaceClosureSchema>,
}

/// What replaces L⁻¹ at free surfaces.
#[derive(Debug, Deserialize)]
pub enum SurfaceSchema {
    /// L⁻¹ everywhere.
    None,
    /// L = I where the least eigenvalue of L⁻¹ is below 0.75.
    Printed(FloorSchema),
    /// L = I where the least eigenvalue of L is below 0.75.
    Intended(FloorSchema),
    /// Eigenvalues of the inverse capped.
    SpectralCap(CapSchema),
}

/// Least determinant of L.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FloorSchema {
    /// ε: L = I where det L < ε.
    pub determinant_floor: Field<Number>,
}

/// Largest eigenvalue of the inverse.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CapSchema {
    /// c: largest eigenvalue of K.
    pub cap: Field<Number>,
}

/// Closure of the faces between disordered particles.
#[derive(Debug, Deserialize)]
pub enum FaceClosureSchema {
    /// Faces as the pairs have them.
    Off,
    /// Closed.
    On(ClosureSchema),
}

/// Effort of the closure.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ClosureSchema {
    /// Sweeps in a step.
    pub sweeps: Field<Count>,
}

/// Relaxation of the density towards the particles' packing.
#[derive(Debug, Deserialize)]
pub enum VolumeConsistencySchema {
    /// Density by continuity alone.
    Off,
    /// With relaxation.
    On(RelaxationSchema),
}

/// Parameters of the relaxation.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RelaxationSchema {
    /// h_S / D of the wide kernel.
    pub width: Field<Number>,
    /// κ.
    pub rate: Field<Number>,
    /// Tolerance of ΔS.
    pub tolerance: Field<Number>,
    /// δ: deficit beyond which a particle lines a void.
    pub void_deficit: Field<Number>,
}

/// The moving window.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WindowSchema {
    /// Length.
    pub length: Field<LengthSchema>,
    /// Width of the inlet and of each outlet region in D.
    pub region_width: Field<Number>,
    /// What is imposed at the inlet.
    pub inlet: Field<InletSchema>,
    /// Wanted place of the front as a part of the length.
    pub front_place: Field<Number>,
}

/// What is imposed at the inlet.
#[derive(Debug, Deserialize)]
pub enum InletSchema {
    /// The velocity.
    FixedVelocity,
    /// The impedance: waves leave.
    ImpedanceMatched(WaveSpeedSchema),
}

/// Speed of the wave that an impedance-matched inlet lets out.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WaveSpeedSchema {
    /// Speed of the precursor.
    pub wave_speed: Field<Velocity>,
}

/// Length of the window.
#[derive(Debug, Deserialize)]
pub enum LengthSchema {
    /// From u_p.
    Auto,
    /// Number of cells.
    Cells(Field<Count>),
}

/// How the frame in which the front stands is found.
#[derive(Debug, Deserialize)]
pub enum SearchSchema {
    /// Boosts by the measured drift of the front.
    Tracking,
    /// The published search.
    Bisection(BisectionSchema),
}

/// The published search: bisection of the outlet velocity, each trial from a saved state.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BisectionSchema {
    /// Lower end of the first bracket of u_out.
    pub outlet_from: Field<Velocity>,
    /// Upper end of the first bracket of u_out.
    pub outlet_to: Field<Velocity>,
    /// Cells fed in a trial.
    pub samples: Field<Count>,
    /// Width of the bracket at which a round ends.
    pub tolerance: Field<Velocity>,
    /// Rounds of bisection.
    pub rounds: Field<Count>,
}

/// When a point has settled.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StopSchema {
    /// Cells fed before the first block.
    pub startup_cells: Field<StartupSchema>,
    /// Cells fed in a block.
    pub block_cells: Field<Count>,
    /// Successive blocks that must agree.
    pub blocks: Field<Count>,
    /// Relative agreement of u_s between blocks.
    pub tolerance: Field<Number>,
    /// Cells fed at most.
    pub max_fed_cells: Field<Count>,
}

/// Cells fed before the first block.
#[derive(Debug, Deserialize)]
pub enum StartupSchema {
    /// Until the start-up material has left.
    Auto,
    /// Number of cells.
    Cells(Field<Count>),
}

/// What is written.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OutputSchema {
    /// Folder of the results.
    pub directory: Field<String>,
    /// Profile bins in a cell.
    pub bins_per_cell: Field<Count>,
    /// Field images.
    pub images: Field<bool>,
    /// A series of moments for ParaView.
    pub snapshots: Field<SnapshotsSchema>,
}

/// A series of moments for ParaView.
#[derive(Debug, Deserialize)]
pub enum SnapshotsSchema {
    /// None.
    Off,
    /// One each time that the front has swept so many cells.
    Every(EverySchema),
}

/// How often, and how much.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EverySchema {
    /// Cells that the front sweeps between two moments.
    pub cells: Field<Number>,
    /// Megabytes that a point may write.
    pub limit_mb: Field<Number>,
}
