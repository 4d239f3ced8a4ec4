//! What is kept of a point on disk: its outcome once it has ended, its whole state now and then until then.
//!
//! ```text
//! points/up_0100/outcome.ckpt            the outcome: a finished point is never computed again
//! points/up_0100/state-0000000007.ckpt   the last two states of a point under way
//! ```
//!
//! A state has everything, to the last bit: a run that was stopped and goes on has the bits of one that was not.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use sph_core::{Constraint, Dim2, Dimension, Particles};
use sph_io::IoError;
use sph_io::checkpoint::{self, Checkpoint, CheckpointStore, ColumnData};
use sph_window::{Snapshot, Window, WindowState};

use crate::config::Case;
use crate::microstructure::Sample;
use crate::outcome::PointOutcome;
use crate::point::PointProgress;
use crate::setup;

/// Time between two states on disk, unless asked for otherwise.
pub(crate) const INTERVAL: Duration = Duration::from_secs(60);

/// Where a point is kept, and how often.
#[derive(Debug)]
pub struct Keeper {
    folder: PathBuf,
    store: CheckpointStore,
    interval: Duration,
    last: Instant,
    stage_ended: bool,
}

/// A state beside its columns.
#[derive(Serialize, Deserialize)]
struct SavedPoint {
    window: WindowState,
    progress: PointProgress,
    has_lists: bool,
    snapshot: Option<SavedSnapshot>,
}

/// The state that the trials of a bisection start from, beside its columns.
#[derive(Serialize, Deserialize)]
struct SavedSnapshot {
    state: WindowState,
    has_lists: bool,
}

/// What the names of its columns begin with.
const SNAPSHOT: &str = "saved_";

impl Keeper {
    /// Keeps a point in its folder, which is made.
    ///
    /// # Errors
    /// If the folder cannot be made.
    pub fn new(folder: &Path, interval: Duration) -> Result<Self> {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
        let store = CheckpointStore::new(folder, "state");
        Ok(Self { folder: folder.to_path_buf(), store, interval, last: Instant::now(), stage_ended: false })
    }

    /// Where the point is kept.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn outcome_path(&self) -> PathBuf {
        self.folder.join("outcome.ckpt")
    }

    /// The outcome, if the point has ended. A damaged one is told and set aside: the point is then run once more, from its
    /// last state if there is one.
    ///
    /// # Errors
    /// If it cannot be read or set aside, or is of another version.
    pub fn outcome(&self) -> Result<Option<PointOutcome>> {
        let path = self.outcome_path();
        if !path.exists() {
            return Ok(None);
        }
        match checkpoint::read::<PointOutcome>(&path) {
            Ok(found) => Ok(Some(found.header)),
            Err(fault @ IoError::Damaged { .. }) => {
                let aside = self.folder.join("outcome.ckpt.damaged");
                std::fs::rename(&path, &aside)
                    .with_context(|| format!("{fault}; it cannot be set aside as {}", aside.display()))?;
                tracing::warn!("{fault}; the point goes on from its last state, or begins anew");
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Keeps the outcome; states on the way to it are not needed any more.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(crate) fn finish(&self, outcome: &PointOutcome) -> Result<()> {
        checkpoint::write(self.outcome_path(), outcome, &[])?;
        self.forget_states()
    }

    /// Removes the states on the way to an outcome.
    ///
    /// # Errors
    /// If one cannot be removed.
    pub(crate) fn forget_states(&self) -> Result<()> {
        for entry in std::fs::read_dir(&self.folder)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if name.starts_with("state-") {
                std::fs::remove_file(&path)?;
            }
        }
        Ok(())
    }

    /// True when the last state is old enough for another, or a stage of the point has ended since.
    pub(crate) fn is_due(&self) -> bool {
        self.stage_ended || self.last.elapsed() >= self.interval
    }

    /// A stage of the point has ended: its state is kept before the next step.
    pub(crate) fn make_due(&mut self) {
        self.stage_ended = true;
    }

    /// Keeps the state of a point under way.
    ///
    /// # Errors
    /// If it cannot be written; the states before still stand.
    pub(crate) fn save(&mut self, window: &Window<Dim2>, progress: &PointProgress) -> Result<()> {
        let simulation = window.simulation();
        let snapshot = window.snapshot();
        let present = Columns::of(simulation.particles(), simulation.list_positions(), "");
        let earlier = snapshot.map(|s| Columns::of(&s.particles, s.list_positions.as_deref(), SNAPSHOT));
        let header = SavedPoint {
            window: window.save(),
            progress: progress.clone(),
            has_lists: simulation.list_positions().is_some(),
            snapshot: snapshot
                .map(|s| SavedSnapshot { state: s.state.clone(), has_lists: s.list_positions.is_some() }),
        };
        let mut columns = present.data();
        columns.extend(earlier.iter().flat_map(Columns::data));
        self.store.save(&header, &columns)?;
        self.last = Instant::now();
        self.stage_ended = false;
        Ok(())
    }

    /// The last state, if there is one; what is damaged is told, and the one before taken.
    ///
    /// # Errors
    /// If there are states and none can be used.
    pub(crate) fn load(
        &self,
        case: &Case,
        sample: &Sample,
        u_p: f64,
    ) -> Result<Option<(Window<Dim2>, PointProgress)>> {
        let found = self.store.load::<SavedPoint>().with_context(|| {
            let folder = self.folder.display();
            format!(
                "{folder}: no state of this point can be used; hint: without this folder it is computed anew"
            )
        })?;
        let Some(mut loaded) = found else { return Ok(None) };
        for fault in &loaded.skipped {
            tracing::warn!("{fault}; the state before it is taken");
        }
        let (has_lists, earlier) = {
            let header = &loaded.checkpoint.header;
            (header.has_lists, header.snapshot.as_ref().map(|s| s.has_lists))
        };
        let (particles, lists) = read_moment(&mut loaded.checkpoint, "", has_lists)?;
        let moment = earlier.map(|lists| read_moment(&mut loaded.checkpoint, SNAPSHOT, lists)).transpose()?;
        let saved = loaded.checkpoint.header;
        let snapshot = saved.snapshot.zip(moment).map(|(saved, (particles, list_positions))| Snapshot {
            state: saved.state,
            particles,
            list_positions,
        });
        let window = Window::restore(
            setup::feed_sample(sample)?,
            case.materials(),
            case.scheme,
            setup::window_settings(case, u_p),
            saved.window,
            particles,
            lists.as_deref(),
        )?
        .with_snapshot(snapshot);
        Ok(Some((window, saved.progress)))
    }
}

/// Names of the columns with the positions of the neighbor lists.
fn list_names() -> Vec<String> {
    ["x", "y", "z"][..Dim2::COUNT].iter().map(|axis| format!("list_{axis}")).collect()
}

/// Particles, and the positions that their neighbor lists were built from.
type Moment = (Particles<Dim2>, Option<Vec<Vec<f64>>>);

/// Particles and list positions under names with a prefix.
fn read_moment(from: &mut Checkpoint<SavedPoint>, prefix: &str, has_lists: bool) -> Result<Moment> {
    let particles = read_particles(from, prefix)?;
    if !has_lists {
        return Ok((particles, None));
    }
    let lists = list_names()
        .iter()
        .map(|name| from.take_f64(&format!("{prefix}{name}")))
        .collect::<Result<_, _>>()?;
    Ok((particles, Some(lists)))
}

fn read_particles(from: &mut Checkpoint<SavedPoint>, prefix: &str) -> Result<Particles<Dim2>> {
    let under = |name: &str| format!("{prefix}{name}");
    let material = from.take_u32(&under("material"))?;
    let mut particles = Particles::<Dim2> {
        id: from.take_u64(&under("id"))?,
        material: material.into_iter().map(u16::try_from).collect::<Result<_, _>>()?,
        constraint: from.take_u8(&under("constraint"))?.into_iter().map(constraint).collect::<Result<_>>()?,
        failed: from.take_u8(&under("failed"))?.into_iter().map(|f| f != 0).collect(),
        ..Default::default()
    };
    let names: Vec<String> = particles.columns().into_iter().map(|(name, _)| under(&name)).collect();
    for (name, column) in names.iter().zip(particles.columns_mut()) {
        *column = from.take_f64(name)?;
    }
    let count = particles.id.len();
    let lengths = particles.columns().iter().map(|(_, c)| c.len()).collect::<Vec<_>>();
    let others = [particles.material.len(), particles.constraint.len(), particles.failed.len()];
    anyhow::ensure!(
        lengths.iter().chain(&others).all(|&length| length == count),
        "{}: the columns of particles have different lengths",
        from.path.display()
    );
    Ok(particles)
}

/// Columns of a checkpoint, with names of their own.
struct Columns<'p> {
    particles: &'p Particles<Dim2>,
    lists: Option<&'p [Vec<f64>]>,
    names: Vec<String>,
    material: Vec<u32>,
    constraint: Vec<u8>,
    failed: Vec<u8>,
}

impl<'p> Columns<'p> {
    fn of(particles: &'p Particles<Dim2>, lists: Option<&'p [Vec<f64>]>, prefix: &str) -> Self {
        let numbers = particles.columns();
        let fixed = ["id", "material", "constraint", "failed"].map(String::from);
        let of_lists = if lists.is_some() { list_names() } else { Vec::new() };
        let names = fixed.into_iter().chain(numbers.into_iter().map(|(name, _)| name)).chain(of_lists);
        Self {
            particles,
            lists,
            names: names.map(|name| format!("{prefix}{name}")).collect(),
            material: particles.material.iter().map(|&m| u32::from(m)).collect(),
            constraint: particles.constraint.iter().map(|&c| c as u8).collect(),
            failed: particles.failed.iter().map(|&f| u8::from(f)).collect(),
        }
    }

    /// As a checkpoint takes them, in the order of the names.
    fn data(&self) -> Vec<(&str, ColumnData<'_>)> {
        let mut data = vec![
            ColumnData::U64(&self.particles.id),
            ColumnData::U32(&self.material),
            ColumnData::U8(&self.constraint),
            ColumnData::U8(&self.failed),
        ];
        data.extend(self.particles.columns().into_iter().map(|(_, column)| ColumnData::F64(column)));
        data.extend(self.lists.unwrap_or_default().iter().map(|column| ColumnData::F64(column)));
        self.names.iter().map(String::as_str).zip(data).collect()
    }
}

fn constraint(code: u8) -> Result<Constraint> {
    [Constraint::Free, Constraint::ImposedVelocity, Constraint::Frozen]
        .into_iter()
        .find(|&c| c as u8 == code)
        .with_context(|| format!("{code} is no constraint of a particle"))
}

#[cfg(test)]
#[path = "restart_tests.rs"]
mod tests;
