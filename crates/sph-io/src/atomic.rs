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
use std::fs::{File, ReadDir};
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
/// [`IoError::File`], also for an error that `write` returns; the old file then still stands, but where the folder could
/// not be flushed at the end: then the new one does, and a power cut may bring back the old.
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

/// Removes what killed processes left unfinished in a folder and in all folders below it; returns the files' paths.
///
/// Nothing else is touched: links are not followed, a folder below that has a lock file of its own is another program's
/// to clear ([`crate::lock`]), and one below that must not be listed is nobody's that writes there. The folder itself must be held, so
/// that nobody is writing into it.
///
/// # Errors
/// [`IoError::File`] if a folder cannot be listed or a file not be removed.
pub fn remove_leftovers(folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, IoError> {
    let folder = folder.as_ref();
    let mut removed = Vec::new();
    let entries = std::fs::read_dir(folder).map_err(IoError::file(folder, "list the folder"))?;
    clear(folder, entries, &mut removed)?;
    Ok(removed)
}

fn clear(folder: &Path, entries: ReadDir, removed: &mut Vec<PathBuf>) -> Result<(), IoError> {
    for entry in entries {
        let entry = entry.map_err(IoError::file(folder, "list the folder"))?;
        let path = entry.path();
        let kind = entry.file_type().map_err(IoError::file(&path, "look at"))?;
        if kind.is_file() && is_unfinished(&path) {
            std::fs::remove_file(&path).map_err(IoError::file(&path, "remove"))?;
            removed.push(path);
        } else if kind.is_dir() && !path.join(crate::lock::FILE_NAME).exists() {
            match std::fs::read_dir(&path) {
                Ok(entries) => clear(&path, entries, removed)?,
                // Such as `lost+found`, where the folder is the root of a disk.
                Err(error) if error.kind() == io::ErrorKind::PermissionDenied => {}
                Err(error) => return Err(IoError::file(&path, "list the folder")(error)),
            }
        }
    }
    Ok(())
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

/// Makes a rename survive a power cut. Windows cannot open folders as files and needs no such step; some file systems
/// refuse it, and folders may be written to but not read: the new file stands all the same, so that is no failure.
fn sync_folder(folder: &Path) -> io::Result<()> {
    use io::ErrorKind::{InvalidInput, PermissionDenied, Unsupported};
    if !cfg!(unix) {
        return Ok(());
    }
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error) if matches!(error.kind(), InvalidInput | PermissionDenied | Unsupported) => Ok(()),
        result => result,
    }
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
    fn leftovers_go_at_any_depth_and_everything_else_stays() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("points/up_0100/moments");
        fs::create_dir_all(&deep).unwrap();
        let left = |folder: &Path| temporary_in(folder).unwrap().keep().unwrap().1;
        let mut expected = [left(folder.path()), left(&deep), left(&folder.path().join("points"))];
        for name in ["a.txt", ".lock", ".a.tmp", "unfinished-a.tmp"] {
            fs::write(folder.path().join(name), b"x").unwrap();
        }
        for name in ["a.txt", ".a.tmp", "unfinished-a.tmp"] {
            fs::write(deep.join(name), b"x").unwrap();
        }
        fs::create_dir(folder.path().join(".unfinished-folder.tmp")).unwrap();
        let mut removed = remove_leftovers(folder.path()).unwrap();
        removed.sort();
        expected.sort();
        assert_eq!(removed, expected);
        assert_eq!(entries(folder.path()), 6);
        assert_eq!(entries(&deep), 3);
        assert!(remove_leftovers(folder.path()).unwrap().is_empty());
    }

    /// A folder of another run below this one, and what a link leads to, belong to others.
    #[test]
    fn leftovers_of_others_stay() {
        let folder = tempfile::tempdir().unwrap();
        let (held, elsewhere) = (folder.path().join("held"), tempfile::tempdir().unwrap());
        fs::create_dir(&held).unwrap();
        let _lock = crate::lock::FolderLock::acquire(&held).unwrap();
        let others = [&held, elsewhere.path()].map(|folder| temporary_in(folder).unwrap().keep().unwrap().1);
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(elsewhere.path(), folder.path().join("link")).unwrap();
            std::os::unix::fs::symlink(&others[1], folder.path().join(".unfinished-link.tmp")).unwrap();
        }
        assert!(remove_leftovers(folder.path()).unwrap().is_empty());
        assert!(others.iter().all(|path| path.exists()));
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
