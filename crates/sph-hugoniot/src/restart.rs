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
use sph_io::checkpoint::{self, Checkpoint, CheckpointStore, ColumnData};
use sph_window::{Window, WindowState};

use crate::config::Case;
use crate::microstructure::Sample;
use crate::outcome::PointOutcome;
use crate::point::PointProgress;
use crate::setup;

/// Time between two states on disk, unless asked for otherwise.
pub const INTERVAL: Duration = Duration::from_secs(60);

/// Where a point is kept, and how often.
#[derive(Debug)]
pub struct Keeper {
    folder: PathBuf,
    store: CheckpointStore,
    interval: Duration,
    last: Instant,
}

/// A state beside its columns.
#[derive(Serialize, Deserialize)]
struct SavedPoint {
    window: WindowState,
    progress: PointProgress,
    has_lists: bool,
}

impl Keeper {
    /// Keeps a point in its folder, which is made.
    ///
    /// # Errors
    /// If the folder cannot be made.
    pub fn new(folder: &Path, interval: Duration) -> Result<Self> {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
        let store = CheckpointStore::new(folder, "state");
        Ok(Self { folder: folder.to_path_buf(), store, interval, last: Instant::now() })
    }

    /// Where the point is kept.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn outcome_path(&self) -> PathBuf {
        self.folder.join("outcome.ckpt")
    }

    /// The outcome, if the point has ended.
    ///
    /// # Errors
    /// If it cannot be read, or is damaged.
    pub fn outcome(&self) -> Result<Option<PointOutcome>> {
        let path = self.outcome_path();
        if !path.exists() {
            return Ok(None);
        }
        Ok(Some(checkpoint::read::<PointOutcome>(&path)?.header))
    }

    /// Keeps the outcome; states on the way to it are not needed any more.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn finish(&self, outcome: &PointOutcome) -> Result<()> {
        checkpoint::write(self.outcome_path(), outcome, &[])?;
        self.forget_states()
    }

    fn forget_states(&self) -> Result<()> {
        for entry in std::fs::read_dir(&self.folder)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if name.starts_with("state-") {
                std::fs::remove_file(&path)?;
            }
        }
        Ok(())
    }

    /// Removes what is kept.
    ///
    /// # Errors
    /// If it cannot be removed.
    pub fn forget(&self) -> Result<()> {
        let path = self.outcome_path();
        if path.exists() {
            std::fs::remove_file(&path)?;
        }
        self.forget_states()
    }

    /// True when the last state is old enough for another.
    pub fn is_due(&self) -> bool {
        self.last.elapsed() >= self.interval
    }

    /// Keeps the state of a point under way.
    ///
    /// # Errors
    /// If it cannot be written; the states before still stand.
    pub fn save(&mut self, window: &Window<Dim2>, progress: &PointProgress) -> Result<()> {
        let simulation = window.simulation();
        let particles = simulation.particles();
        let lists = simulation.list_positions();
        let header =
            SavedPoint { window: window.save(), progress: progress.clone(), has_lists: lists.is_some() };
        let numbers = particles.columns();
        let list_names = list_names();
        let material: Vec<u32> = particles.material.iter().map(|&m| u32::from(m)).collect();
        let constraint: Vec<u8> = particles.constraint.iter().map(|&c| c as u8).collect();
        let failed: Vec<u8> = particles.failed.iter().map(|&f| u8::from(f)).collect();
        let mut columns: Vec<(&str, ColumnData<'_>)> = vec![
            ("id", ColumnData::U64(&particles.id)),
            ("material", ColumnData::U32(&material)),
            ("constraint", ColumnData::U8(&constraint)),
            ("failed", ColumnData::U8(&failed)),
        ];
        columns.extend(numbers.iter().map(|(name, column)| (name.as_str(), ColumnData::F64(column))));
        for (name, column) in list_names.iter().zip(lists.unwrap_or_default()) {
            columns.push((name, ColumnData::F64(column)));
        }
        self.store.save(&header, &columns)?;
        self.last = Instant::now();
        Ok(())
    }

    /// The last state, if there is one; what is damaged is told, and the one before taken.
    ///
    /// # Errors
    /// If there are states and none can be used.
    pub fn load(
        &self,
        case: &Case,
        sample: &Sample,
        u_p: f64,
    ) -> Result<Option<(Window<Dim2>, PointProgress)>> {
        let Some(mut loaded) = self.store.load::<SavedPoint>()? else { return Ok(None) };
        for fault in &loaded.skipped {
            tracing::warn!("{fault}; the state before it is taken");
        }
        let particles = read_particles(&mut loaded.checkpoint)?;
        let mut lists = Vec::new();
        if loaded.checkpoint.header.has_lists {
            for name in list_names() {
                lists.push(loaded.checkpoint.take_f64(&name)?);
            }
        }
        let saved = loaded.checkpoint.header;
        let window = Window::restore(
            setup::feed_sample(sample)?,
            case.materials(),
            case.scheme,
            setup::window_settings(case, u_p),
            saved.window,
            particles,
            saved.has_lists.then_some(lists.as_slice()),
        )?;
        Ok(Some((window, saved.progress)))
    }
}

/// Names of the columns with the positions of the neighbour lists.
fn list_names() -> Vec<String> {
    ["x", "y", "z"][..Dim2::COUNT].iter().map(|axis| format!("list_{axis}")).collect()
}

fn read_particles(from: &mut Checkpoint<SavedPoint>) -> Result<Particles<Dim2>> {
    let material = from.take_u32("material")?;
    let mut particles = Particles::<Dim2> {
        id: from.take_u64("id")?,
        material: material.into_iter().map(u16::try_from).collect::<Result<_, _>>()?,
        constraint: from.take_u8("constraint")?.into_iter().map(constraint).collect::<Result<_>>()?,
        failed: from.take_u8("failed")?.into_iter().map(|f| f != 0).collect(),
        ..Default::default()
    };
    let names: Vec<String> = particles.columns().into_iter().map(|(name, _)| name).collect();
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

fn constraint(code: u8) -> Result<Constraint> {
    [Constraint::Free, Constraint::ImposedVelocity, Constraint::Frozen]
        .into_iter()
        .find(|&c| c as u8 == code)
        .with_context(|| format!("{code} is no constraint of a particle"))
}
