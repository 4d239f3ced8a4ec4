//! A series of snapshots in one folder, with the `.pvd` file that ParaView opens.

use super::{Snapshot, vtp};
use crate::{IoError, atomic};
use std::path::{Path, PathBuf};

/// Snapshots `STEM_000000.vtp`, `STEM_000001.vtp`, … and their list `STEM.pvd`, which is whole after each addition.
#[derive(Debug, Clone)]
pub struct SnapshotSeries {
    folder: PathBuf,
    stem: String,
    /// Time and file name of each snapshot.
    entries: Vec<(f64, String)>,
}

impl SnapshotSeries {
    /// A series without snapshots; nothing is written yet. Files of an earlier series of that name are replaced one
    /// by one.
    pub fn new(folder: impl Into<PathBuf>, stem: impl Into<String>) -> Self {
        Self { folder: folder.into(), stem: stem.into(), entries: Vec::new() }
    }

    /// A series that goes on: its earlier snapshots, which have these times, stay. The folder is made if it is not there.
    ///
    /// # Errors
    /// [`IoError::File`] if the folder cannot be made.
    pub fn resume(
        folder: impl Into<PathBuf>,
        stem: impl Into<String>,
        times: &[f64],
    ) -> Result<Self, IoError> {
        let mut series = Self::new(folder, stem);
        let folder = &series.folder;
        std::fs::create_dir_all(folder).map_err(IoError::file(folder, "make the folder"))?;
        series.entries = times.iter().enumerate().map(|(k, &time)| (time, series.name(k))).collect();
        Ok(series)
    }

    fn name(&self, index: usize) -> String {
        format!("{}_{index:06}.vtp", self.stem)
    }

    /// Writes a snapshot and adds it to the list. Returns the snapshot's path.
    ///
    /// # Errors
    /// As [`Snapshot::write_vtp`].
    pub fn add(&mut self, snapshot: &Snapshot<'_>) -> Result<PathBuf, IoError> {
        let name = self.name(self.entries.len());
        let path = self.folder.join(&name);
        snapshot.write_vtp(&path)?;
        self.entries.push((snapshot.time, name));
        atomic::write_atomic(self.path(), self.list().as_bytes())?;
        Ok(path)
    }

    /// The `.pvd` file, to be opened in ParaView.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        Path::new(&self.folder).join(format!("{}.pvd", self.stem))
    }

    /// Number of snapshots so far.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there is no snapshot yet.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    fn list(&self) -> String {
        let mut out = String::from(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n\
             <Collection>\n",
        );
        for (time, name) in &self.entries {
            let name = vtp::escaped(name);
            out += &format!("<DataSet timestep=\"{time:e}\" part=\"0\" file=\"{name}\"/>\n");
        }
        out + "</Collection>\n</VTKFile>\n"
    }
}
