//! From rates to the state at the end of the step.
//!
//! ```text
//! U ← U + τ f/ρ
//! x ← x + τ ½(U + U_new)                    (explicit schemes: x + τ U)
//! ρ ← ρ exp(-τ ∇·U) exp(τ r)                (paper eq. (16); r: volume consistency)
//! e ← e + τ p/ρ - τ a·(U + ½τ a)            E = e + U²/2 changes by τ p/ρ exactly
//! S ← return(Q (S + 2G τ dev D) Qᵀ)         Q turns by ½ curl U τ, exactly orthogonal (Cayley)
//! ```
//!
//! Eight particles at a time: the module `block`; the module `plain` has the same for one particle, for tests.
//!
//! While a particle's new state is at hand, its equation of state is evaluated once, for failure and for the next step: the
//! update leaves behind the records, rows and least steps that [`crate::prepare`] would fill.
//!
//! Where the velocity is imposed, e takes what is left after the *unconstrained* change of ½U², and the velocity stays;
//! momentum and energy that the constraint puts in are reported. Frozen particles only translate.

mod block;
#[cfg(test)]
mod plain;

use rayon::prelude::*;
use sph_core::dimension::{Components, Dimension};
use sph_core::lanes::{InstructionSet, Line};
use sph_core::neighbors::{NeighborLists, TILE, TILE_BLOCKS};
use sph_core::particles::{Constraint, Particles};
use sph_core::tiles::TiledColumn;

use crate::dimension::SolidDimension;
use crate::error::{Stage, StepError};
use crate::interventions::Interventions;
use crate::matter::Matter;
use crate::pass::{TilePairs, ask_ahead, collect};
use crate::record::{Prepared, Row};
use crate::scheme::{Settings, SurfaceTreatment};
use crate::time_step::{LeastStep, TimeStepReason};
pub use block::UpdateTile;

/// Largest relative change of density that volume consistency makes in a step [-].
const LARGEST_RELAXATION: f64 = 1e-3;

/// What imposed velocities put into the particles in a step, tile by tile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConstraintInput {
    /// Momentum [kg m/s], per meter of depth in the plane.
    pub impulse: [f64; 3],
    /// Total energy [J], per meter of depth in the plane.
    pub work: f64,
}

/// What the update of a tile found.
#[derive(Clone, Copy, Debug, Default)]
pub struct TileReport {
    /// What imposed velocities put in.
    pub input: ConstraintInput,
    /// First particle with a state that cannot be.
    pub broken: Option<u32>,
    /// Work of the volume consistency: ∫ P |dV| of the density it changes [J], per meter of depth in the plane.
    pub relaxation_work: f64,
    /// Bounds that acted.
    pub interventions: Interventions,
}

/// The step at whose end something was found.
#[derive(Clone, Copy, Debug)]
pub struct StepEnd {
    /// Time at its end [s].
    pub time: f64,
    /// Its length [s].
    pub time_step: f64,
    /// Why it was as long.
    pub reason: TimeStepReason,
}

/// What the passes found.
pub struct Outcome<'a, D: SolidDimension> {
    /// Rows of blocks; those of the next step afterwards.
    pub rows: &'a mut [Line],
    /// Records of the contact pass; those of the next step afterwards, in a scheme without reconstruction.
    pub sides: &'a mut [Line],
    /// What pairs added up to, without what tiles have for each other; records of the next step afterwards, in a scheme with
    /// reconstruction.
    pub sums: &'a mut [Line],
    /// The lists.
    pub lists: &'a NeighborLists<D>,
    /// What tiles have for each other.
    pub pairs: &'a [TilePairs],
    /// Least steps of the tiles, afterwards.
    pub least: &'a mut [LeastStep],
}

/// Columns of particles that a step changes.
struct Columns<'a, D: Dimension> {
    position: D::Axes<TiledColumn<'a, f64>>,
    velocity: D::Axes<TiledColumn<'a, f64>>,
    deviator: D::Tensor<TiledColumn<'a, f64>>,
    density: TiledColumn<'a, f64>,
    energy: TiledColumn<'a, f64>,
    plastic_strain: TiledColumn<'a, f64>,
    relative_speed: TiledColumn<'a, f64>,
    failed: TiledColumn<'a, bool>,
    distension: TiledColumn<'a, f64>,
}

/// What the update of a tile writes besides the columns.
pub(crate) struct Written<'a> {
    report: &'a mut TileReport,
    least: &'a mut LeastStep,
    /// Rows of its blocks, to be read before.
    rows: &'a mut [Line],
    /// What the pairs of its particles added up to, to be read before.
    sums: &'a mut [Line],
    /// Records of the next step; `None`: they take the place of the sums.
    records: Option<&'a mut [Line]>,
}

/// What the update reads besides the state of particles.
struct Context<'a> {
    matter: &'a Matter,
    settings: &'a Settings,
    /// Records of the contact pass, in a scheme with reconstruction.
    sides: &'a [Line],
    time_step: f64,
    instructions: InstructionSet,
    /// Eigenvalue of L below which its inverse is capped [-]; zero where nothing is.
    least_eigenvalue: f64,
}

/// Advances all particles by one step. `reports` has one entry a tile.
pub fn update<D: SolidDimension>(
    particles: &mut Particles<D>,
    matter: &Matter,
    settings: &Settings,
    outcome: Outcome<'_, D>,
    (time_step, instructions): (f64, InstructionSet),
    reports: &mut [TileReport],
) {
    for_each_tile::<D>(particles, matter, settings, outcome, (time_step, instructions), reports, D::update);
}

/// Runs an update on all tiles.
fn for_each_tile<D: SolidDimension>(
    particles: &mut Particles<D>,
    matter: &Matter,
    settings: &Settings,
    outcome: Outcome<'_, D>,
    (time_step, instructions): (f64, InstructionSet),
    reports: &mut [TileReport],
    work: impl Fn(UpdateTile<'_, D>) + Sync,
) {
    fn tiled<D: Dimension>(columns: &mut D::AxisColumns) -> D::Axes<TiledColumn<'_, f64>> {
        let mut columns = columns.as_mut().iter_mut();
        Components::from_fn(|_| TiledColumn::new(columns.next().expect("one column an axis")))
    }
    let mut deviator = particles.deviator.as_mut().iter_mut();
    let columns = Columns::<D> {
        position: tiled::<D>(&mut particles.position),
        velocity: tiled::<D>(&mut particles.velocity),
        deviator: Components::from_fn(|_| TiledColumn::new(deviator.next().expect("one column a component"))),
        density: TiledColumn::new(&mut particles.density),
        energy: TiledColumn::new(&mut particles.specific_internal_energy),
        plastic_strain: TiledColumn::new(&mut particles.plastic_strain),
        relative_speed: TiledColumn::new(&mut particles.relative_speed),
        failed: TiledColumn::new(&mut particles.failed),
        distension: TiledColumn::new(&mut particles.distension),
    };
    let least_eigenvalue = match settings.surface {
        SurfaceTreatment::SpectralCap { cap } if settings.scheme.reconstructs() => 1.0 / cap,
        _ => 0.0,
    };
    let Outcome { rows, sides, sums, lists, pairs, least } = outcome;
    let own = lists.n_padded() * D::CONSTANT_SIDES_LINES;
    let (sides, records) = match settings.scheme.prepared() {
        Prepared::State => (&*sides, None),
        Prepared::ConstantSides => (&[][..], Some(&mut sides[..own])),
    };
    let context = Context { matter, settings, sides, time_step, instructions, least_eigenvalue };
    let fixed = Fixed {
        material: &particles.material,
        constraint: &particles.constraint,
        mass: &particles.mass,
        size: &particles.size,
        packing_excess: &particles.packing_excess,
    };
    let run = |t: usize, tile: Written<'_>| {
        collect(lists, pairs, instructions, t, tile.sums);
        ask_ahead(lists, pairs, t, tile.sums);
        // SAFETY: the parallel iterators visit every tile once, and these are the only parts taken.
        let columns = unsafe { TileColumns::<D>::take(&columns, t) };
        *tile.report = TileReport::default();
        work(UpdateTile { columns, first: t * TILE, fixed: &fixed, context: &context, written: tile });
    };
    let reports = reports.par_iter_mut().zip(least);
    let rows = rows.par_chunks_mut(TILE_BLOCKS * Row::count::<D>());
    let tiles = reports.zip(rows).zip(sums.par_chunks_mut(TILE * D::SUM_LINES)).enumerate();
    if let Some(records) = records {
        let records = records.par_chunks_mut(TILE * D::CONSTANT_SIDES_LINES);
        tiles.zip(records).for_each(|((t, (((report, least), rows), sums)), records)| {
            run(t, Written { report, least, rows, sums, records: Some(records) });
        });
    } else {
        tiles.for_each(|(t, (((report, least), rows), sums))| {
            run(t, Written { report, least, rows, sums, records: None });
        });
    }
}

/// Columns that a step leaves as they are.
struct Fixed<'a> {
    material: &'a [u16],
    constraint: &'a [Constraint],
    mass: &'a [f64],
    size: &'a [f64],
    packing_excess: &'a [f64],
}

/// The parts of one tile. The components of vectors and tensors stand in fixed arrays, three and six being the most.
struct TileColumns<'a, D: Dimension> {
    position: [&'a mut [f64]; 3],
    velocity: [&'a mut [f64]; 3],
    deviator: [&'a mut [f64]; 6],
    density: &'a mut [f64],
    energy: &'a mut [f64],
    plastic_strain: &'a mut [f64],
    relative_speed: &'a mut [f64],
    failed: &'a mut [bool],
    distension: &'a mut [f64],
    dimension: std::marker::PhantomData<D>,
}

impl<'a, D: SolidDimension> TileColumns<'a, D> {
    /// # Safety
    /// As [`TiledColumn::tile`].
    unsafe fn take(columns: &Columns<'a, D>, t: usize) -> Self {
        // SAFETY: the caller's promise; each column is taken once below.
        unsafe {
            Self {
                position: std::array::from_fn(|a| {
                    if a < D::COUNT { columns.position[a].tile(t) } else { &mut [] }
                }),
                velocity: std::array::from_fn(|a| {
                    if a < D::COUNT { columns.velocity[a].tile(t) } else { &mut [] }
                }),
                deviator: std::array::from_fn(|k| {
                    if k < D::TENSOR_COUNT { columns.deviator[k].tile(t) } else { &mut [] }
                }),
                density: columns.density.tile(t),
                energy: columns.energy.tile(t),
                plastic_strain: columns.plastic_strain.tile(t),
                relative_speed: columns.relative_speed.tile(t),
                failed: columns.failed.tile(t),
                distension: columns.distension.tile(t),
                dimension: std::marker::PhantomData,
            }
        }
    }
}

/// The error of the first broken particle, if any.
pub fn first_broken<D: SolidDimension>(
    reports: &[TileReport],
    particles: &Particles<D>,
    end: StepEnd,
) -> Option<StepError> {
    let i = reports.iter().find_map(|report| report.broken)? as usize;
    Some(StepError::Broken {
        particle: particles.id[i],
        position: (0..D::COUNT).map(|a| particles.position[a][i]).collect(),
        stage: Stage::Update,
        time: end.time,
        time_step: end.time_step,
        reason: end.reason,
        density: particles.density[i],
        specific_internal_energy: particles.specific_internal_energy[i],
    })
}
