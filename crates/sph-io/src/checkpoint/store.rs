//! The last two checkpoints of a run in one folder.

use super::{Checkpoint, ColumnData, read, write};
use crate::IoError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::path::{Path, PathBuf};

const EXTENSION: &str = "ckpt";
/// Checkpoints that are kept: the newest, and the one before in case the newest is damaged.
const N_KEPT: usize = 2;

/// Numbered checkpoints `STEM-0000000001.ckpt`, … of which the last two are kept.
#[derive(Debug, Clone)]
pub struct CheckpointStore {
    folder: PathBuf,
    stem: String,
}

/// What [`CheckpointStore::load`] found.
#[derive(Debug)]
pub struct Loaded<H> {
    /// The newest whole checkpoint.
    pub checkpoint: Checkpoint<H>,
    /// Newer ones that could not be used, to be reported to the user.
    pub skipped: Vec<IoError>,
}

impl CheckpointStore {
    /// The store of a run; nothing is read or written yet.
    pub fn new(folder: impl Into<PathBuf>, stem: impl Into<String>) -> Self {
        Self { folder: folder.into(), stem: stem.into() }
    }

    /// Writes a checkpoint, then removes all but the last two. Returns its path.
    ///
    /// # Errors
    /// As [`write()`]; the earlier checkpoints then still stand.
    pub fn save<H: Serialize>(
        &self,
        header: &H,
        columns: &[(&str, ColumnData<'_>)],
    ) -> Result<PathBuf, IoError> {
        let mut files = self.files()?;
        let number = files.last().map_or(1, |(number, _)| number + 1);
        let path = self.folder.join(format!("{}-{number:010}.{EXTENSION}", self.stem));
        write(&path, header, columns)?;
        files.push((number, path.clone()));
        for (_, old) in &files[..files.len().saturating_sub(N_KEPT)] {
            fs::remove_file(old).map_err(IoError::file(old, "remove an old checkpoint"))?;
        }
        Ok(path)
    }

    /// Reads the newest checkpoint that is whole; `None` if there are no checkpoints. A damaged one is set aside
    /// under the further extension `damaged`, so that the next [`save`](Self::save) does not count it among the two.
    ///
    /// # Errors
    /// The newest one's error if none can be used; [`IoError::File`] if the folder cannot be read.
    pub fn load<H: DeserializeOwned>(&self) -> Result<Option<Loaded<H>>, IoError> {
        let mut skipped = Vec::new();
        for (_, path) in self.files()?.into_iter().rev() {
            match read(&path) {
                Ok(checkpoint) => return Ok(Some(Loaded { checkpoint, skipped })),
                Err(error) => {
                    if matches!(error, IoError::Damaged { .. }) {
                        set_aside(&path);
                    }
                    skipped.push(error);
                }
            }
        }
        skipped.into_iter().next().map_or(Ok(None), Err)
    }

    /// Number and path of the checkpoints present, the oldest first.
    fn files(&self) -> Result<Vec<(u64, PathBuf)>, IoError> {
        let entries = fs::read_dir(&self.folder).map_err(IoError::file(&self.folder, "list the folder"))?;
        let mut files = Vec::new();
        for entry in entries {
            let path = entry.map_err(IoError::file(&self.folder, "list the folder"))?.path();
            if let Some(number) = self.number(&path) {
                files.push((number, path));
            }
        }
        files.sort_unstable();
        Ok(files)
    }

    /// The number of one of this store's checkpoints; `None` for any other file.
    fn number(&self, path: &Path) -> Option<u64> {
        let name = path.file_name()?.to_str()?;
        let rest = name.strip_prefix(&self.stem)?.strip_prefix('-')?;
        rest.strip_suffix(EXTENSION)?.strip_suffix('.')?.parse().ok()
    }
}

/// Renames a damaged checkpoint. A read-only folder is no reason not to load the one before.
fn set_aside(path: &Path) {
    let mut name = path.as_os_str().to_owned();
    name.push(".damaged");
    let _ = fs::rename(path, name);
}
