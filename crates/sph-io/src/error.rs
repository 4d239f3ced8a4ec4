//! The one error type of this crate; every message begins with the path that it is about.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What can go wrong when something is written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// The operating system refused.
    #[error("{}: cannot {action}: {cause}", path.display())]
    File {
        /// File or folder that was asked for.
        path: PathBuf,
        /// What was tried, as a verb with its object.
        action: &'static str,
        /// The system's own message; it stands in the sentence, so it is no further source of the error.
        cause: io::Error,
    },
    /// What the caller wants written does not fit together, so nothing was written.
    #[error("{}: nothing written: {reason}", path.display())]
    Invalid {
        /// File that was to be written.
        path: PathBuf,
        /// What does not fit.
        reason: String,
    },
    /// The file is there, and its content is not what was once written.
    #[error("{}: damaged: {what}", path.display())]
    Damaged {
        /// File that was read.
        path: PathBuf,
        /// The part that is damaged, and how it was noticed.
        what: String,
    },
    /// The file was written in another version of the format.
    #[error("{}: format version {found}, and this program reads version {expected}", path.display())]
    Version {
        /// File that was read.
        path: PathBuf,
        /// Version found in the file.
        found: u32,
        /// Version that this program reads.
        expected: u32,
    },
    /// The file is whole, and holds something else than what is asked of it.
    #[error("{}: does not fit: {what}", path.display())]
    Mismatch {
        /// File that was read.
        path: PathBuf,
        /// What does not fit.
        what: String,
    },
    /// Somebody else is at work in the folder.
    #[error("{}: in use by {holder} (waited {:.1} s); wait for its end or choose another folder", path.display(), waited.as_secs_f64())]
    Locked {
        /// The lock file.
        path: PathBuf,
        /// Who holds it, as written in the lock file.
        holder: String,
        /// How long it was waited for.
        waited: Duration,
    },
}

impl IoError {
    /// Wraps a system error; for `map_err`.
    pub(crate) fn file(path: &Path, action: &'static str) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        move |cause| Self::File { path, action, cause }
    }

    pub(crate) fn invalid(path: &Path, reason: impl Into<String>) -> Self {
        Self::Invalid { path: path.to_path_buf(), reason: reason.into() }
    }

    pub(crate) fn damaged(path: &Path, what: impl Into<String>) -> Self {
        Self::Damaged { path: path.to_path_buf(), what: what.into() }
    }

    pub(crate) fn mismatch(path: &Path, what: impl Into<String>) -> Self {
        Self::Mismatch { path: path.to_path_buf(), what: what.into() }
    }

    /// The file or folder that the error is about.
    #[must_use]
    pub fn path(&self) -> &Path {
        match self {
            Self::File { path, .. }
            | Self::Invalid { path, .. }
            | Self::Damaged { path, .. }
            | Self::Mismatch { path, .. }
            | Self::Version { path, .. }
            | Self::Locked { path, .. } => path,
        }
    }
}
