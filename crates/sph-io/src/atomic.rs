//! Files that are either whole or not there.
//!
//! The bytes go to a nameless neighbor of the target, are flushed to the disk, and take the target's name in one
//! step; then the folder itself is flushed. After a crash at any moment the target holds its old or its new content,
//! never a part. The file's mode is 0644 less the process's umask (a plain temporary file would be 0600, unreadable
//! to the colleagues who share the folder).
//!
//! A process that is killed leaves its neighbor of the target behind, under a name that nothing else has;
//! [`remove_leftovers`] clears such files away.
//!
//! It does not create folders: a misspelled output folder is an error and no new folder.

use crate::IoError;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// What the names of unfinished files begin and end with.
const UNFINISHED: (&str, &str) = (".unfinished-", ".tmp");

/// Writes `contents` to `path`, atomically.
///
/// # Errors
/// [`IoError::File`] if the folder is missing, not writable, or the disk is full; the old file then still stands.
pub fn write_atomic(path: impl AsRef<Path>, contents: &[u8]) -> Result<(), IoError> {
    write_atomic_with(path, |file| file.write_all(contents))
}

/// Writes to `path`, atomically, what `write` puts into the writer it is handed (buffered).
///
/// # Errors
/// [`IoError::File`], also for an error that `write` returns; the old file then still stands.
pub fn write_atomic_with(
    path: impl AsRef<Path>,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), IoError> {
    let path = path.as_ref();
    let folder = folder_of(path);
    let mut file = temporary_in(folder).map_err(IoError::file(path, "create a file beside it"))?;
    fill(&mut file, write).map_err(IoError::file(path, "write"))?;
    file.persist(path).map_err(|e| e.error).map_err(IoError::file(path, "put the new file in place"))?;
    sync_folder(folder).map_err(IoError::file(folder, "flush the folder"))
}

/// Removes what killed processes left unfinished in a folder, not in the folders below it; returns the files' paths.
///
/// Nobody may be writing into the folder: see [`crate::lock`].
///
/// # Errors
/// [`IoError::File`] if the folder cannot be listed or a file not be removed.
pub fn remove_leftovers(folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, IoError> {
    let folder = folder.as_ref();
    let mut removed = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(IoError::file(folder, "list the folder"))? {
        let path = entry.map_err(IoError::file(folder, "list the folder"))?.path();
        if is_unfinished(&path) {
            std::fs::remove_file(&path).map_err(IoError::file(&path, "remove"))?;
            removed.push(path);
        }
    }
    Ok(removed)
}

fn is_unfinished(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    name.starts_with(UNFINISHED.0) && name.ends_with(UNFINISHED.1)
}

/// The folder that holds `path`; `.` for a bare name.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED.0).suffix(UNFINISHED.1);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Given at creation, so that the kernel takes the umask off.
        builder.permissions(std::fs::Permissions::from_mode(0o644));
    }
    builder.tempfile_in(folder)
}

fn fill(file: &mut NamedTempFile, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut writer = BufWriter::with_capacity(1 << 16, file.as_file_mut());
    write(&mut writer)?;
    writer.flush()?;
    drop(writer);
    file.as_file().sync_all()
}

/// Makes a rename survive a power cut. Windows cannot open folders as files and needs no such step.
fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn entries(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn replaces_the_old_content_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_atomic(&path, b"old and long").unwrap();
        write_atomic(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(entries(folder.path()), 1);
    }

    #[test]
    fn a_failing_writer_leaves_the_old_file_and_no_rest() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_atomic(&path, b"old").unwrap();
        let result = write_atomic_with(&path, |file| {
            file.write_all(b"half of the n")?;
            Err(io::Error::other("the power went"))
        });
        assert!(result.unwrap_err().to_string().contains("the power went"));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(entries(folder.path()), 1);
    }

    #[test]
    fn leftovers_go_and_everything_else_stays() {
        let folder = tempfile::tempdir().unwrap();
        let (_, left) = temporary_in(folder.path()).unwrap().keep().unwrap();
        for name in ["a.txt", ".lock", ".a.tmp", "unfinished-a.tmp"] {
            fs::write(folder.path().join(name), b"x").unwrap();
        }
        assert_eq!(remove_leftovers(folder.path()).unwrap(), [left]);
        assert_eq!(entries(folder.path()), 4);
        assert!(remove_leftovers(folder.path()).unwrap().is_empty());
    }

    #[test]
    fn a_missing_folder_is_named_in_the_error() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_atomic(folder.path().join("absent/a.txt"), b"x").unwrap_err();
        assert!(error.to_string().contains("absent/a.txt"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn has_the_mode_that_a_plain_file_would_have() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (atomic, plain) = (folder.path().join("atomic"), folder.path().join("plain"));
        write_atomic(&atomic, b"x").unwrap();
        fs::write(&plain, b"x").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        // A plain file is created with 0666 less the umask, this one with 0644 less the umask.
        assert_eq!(mode(&atomic), mode(&plain) & 0o644);
    }
}
