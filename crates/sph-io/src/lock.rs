//! One program at a time in a folder.
//!
//! The lock is the operating system's own, on a small file in the folder, and ends with the process that holds it,
//! however that ends: a file left behind after a crash locks nobody out. It is advisory: only programs that ask for
//! it are kept away.
//!
//! A process that was killed holds its lock for some moments more, until the system has taken it apart. Whoever goes on at
//! once would meet it, so [`FolderLock::acquire`] tries for [`PATIENCE`] before it gives up.

use crate::IoError;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

pub(crate) const FILE_NAME: &str = ".lock";

/// How long a folder that another holds is asked for.
pub const PATIENCE: Duration = Duration::from_secs(2);
/// Time between two tries.
const AGAIN: Duration = Duration::from_millis(25);

/// A folder held for this process, until it is dropped.
#[derive(Debug)]
pub struct FolderLock {
    file: File,
    path: PathBuf,
}

impl FolderLock {
    /// Takes the folder; waits up to [`PATIENCE`] for one that holds it to end.
    ///
    /// # Errors
    /// [`IoError::Locked`] with the holder's process id if another holds it all the while; [`IoError::File`] if the folder is
    /// missing, not writable, or its file system knows no locks.
    pub fn acquire(folder: impl AsRef<Path>) -> Result<Self, IoError> {
        Self::acquire_within(folder.as_ref(), PATIENCE)
    }

    fn acquire_within(folder: &Path, patience: Duration) -> Result<Self, IoError> {
        let path = folder.join(FILE_NAME);
        // Not truncated on opening: it may hold the id of another process.
        let mut options = OpenOptions::new();
        let options = options.read(true).write(true).create(true).truncate(false);
        let mut file = options.open(&path).map_err(IoError::file(&path, "open the lock file"))?;
        let asked = Instant::now();
        loop {
            match file.try_lock() {
                Ok(()) => break,
                Err(TryLockError::WouldBlock) if asked.elapsed() < patience => std::thread::sleep(AGAIN),
                Err(TryLockError::WouldBlock) => {
                    return Err(IoError::Locked { holder: holder(&mut file), waited: asked.elapsed(), path });
                }
                Err(TryLockError::Error(error)) => return Err(IoError::file(&path, "lock")(error)),
            }
        }
        note_holder(&mut file, &format!("{}\n", std::process::id()))
            .map_err(IoError::file(&path, "write the lock file"))?;
        Ok(Self { file, path })
    }

    /// Who holds the folder, without taking it; `None` if nobody does.
    ///
    /// # Errors
    /// [`IoError::File`] if the lock file cannot be read, or its file system knows no locks.
    pub fn holder(folder: impl AsRef<Path>) -> Result<Option<String>, IoError> {
        let path = folder.as_ref().join(FILE_NAME);
        if !path.exists() {
            return Ok(None);
        }
        let mut file = File::open(&path).map_err(IoError::file(&path, "open the lock file"))?;
        match file.try_lock_shared() {
            Ok(()) => Ok(None),
            Err(TryLockError::WouldBlock) => Ok(Some(holder(&mut file))),
            Err(TryLockError::Error(error)) => Err(IoError::file(&path, "look at the lock")(error)),
        }
    }

    /// The lock file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        // The lock itself ends with the file's handle; the empty file says that nobody is there.
        let _ = note_holder(&mut self.file, "");
    }
}

fn note_holder(file: &mut File, words: &str) -> std::io::Result<()> {
    file.set_len(0)?;
    file.rewind()?;
    file.write_all(words.as_bytes())
}

/// Who holds the lock; some systems do not let others read a locked file.
fn holder(file: &mut File) -> String {
    let mut content = String::new();
    match file.read_to_string(&mut content) {
        Ok(_) if !content.trim().is_empty() => format!("process {}", content.trim()),
        _ => "another process".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_is_refused_and_told_by_whom() {
        let folder = tempfile::tempdir().unwrap();
        let first = FolderLock::acquire(folder.path()).unwrap();
        let patience = Duration::from_millis(300);
        let error = FolderLock::acquire_within(folder.path(), patience).unwrap_err();
        let IoError::Locked { waited, .. } = &error else { panic!("{error}") };
        assert!(*waited >= patience, "{waited:?}");
        let expected =
            format!("in use by process {} (waited {:.1} s)", std::process::id(), waited.as_secs_f64());
        assert!(error.to_string().contains(&expected), "{error}");
        assert_eq!(
            FolderLock::holder(folder.path()).unwrap(),
            Some(format!("process {}", std::process::id()))
        );
        drop(first);
        assert_eq!(FolderLock::holder(folder.path()).unwrap(), None);
        FolderLock::acquire(folder.path()).unwrap();
    }

    /// As after a kill: the one who goes on at once gets the folder as soon as the system has let it go.
    #[test]
    fn a_folder_that_is_let_go_in_time_is_taken() {
        let folder = tempfile::tempdir().unwrap();
        let first = FolderLock::acquire(folder.path()).unwrap();
        let asked = Instant::now();
        let held = Duration::from_millis(150);
        let ending = std::thread::spawn(move || {
            std::thread::sleep(held);
            drop(first);
        });
        FolderLock::acquire_within(folder.path(), Duration::from_secs(60)).unwrap();
        assert!(asked.elapsed() >= held, "taken while it was held");
        ending.join().unwrap();
    }

    #[test]
    fn a_file_left_behind_locks_nobody_out() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(FILE_NAME), "999999999\nand more").unwrap();
        let lock = FolderLock::acquire(folder.path()).unwrap();
        assert_eq!(std::fs::read_to_string(lock.path()).unwrap(), format!("{}\n", std::process::id()));
    }

    #[test]
    fn a_missing_folder_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(FolderLock::acquire(folder.path().join("absent")), Err(IoError::File { .. })));
    }
}
