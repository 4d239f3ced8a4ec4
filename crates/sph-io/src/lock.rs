//! One program at a time in a folder.
//!
//! The lock is the operating system's own, on a small file in the folder, and ends with the process that holds it,
//! however that ends: a file left behind after a crash locks nobody out. It is advisory: only programs that ask for
//! it are kept away.

use crate::IoError;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};

const FILE_NAME: &str = ".lock";

/// A folder held for this process, until it is dropped.
#[derive(Debug)]
pub struct FolderLock {
    file: File,
    path: PathBuf,
}

impl FolderLock {
    /// Takes the folder.
    ///
    /// # Errors
    /// [`IoError::Locked`] with the holder's process id if another holds it; [`IoError::File`] if the folder is
    /// missing, not writable, or its file system knows no locks.
    pub fn acquire(folder: impl AsRef<Path>) -> Result<Self, IoError> {
        let path = folder.as_ref().join(FILE_NAME);
        // Not truncated on opening: it may hold the id of another process.
        let mut options = OpenOptions::new();
        let options = options.read(true).write(true).create(true).truncate(false);
        let mut file = options.open(&path).map_err(IoError::file(&path, "open the lock file"))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(IoError::Locked { holder: holder(&mut file), path });
            }
            Err(TryLockError::Error(error)) => return Err(IoError::file(&path, "lock")(error)),
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
        let message = FolderLock::acquire(folder.path()).unwrap_err().to_string();
        assert!(message.contains(&format!("in use by process {}", std::process::id())), "{message}");
        assert_eq!(
            FolderLock::holder(folder.path()).unwrap(),
            Some(format!("process {}", std::process::id()))
        );
        drop(first);
        assert_eq!(FolderLock::holder(folder.path()).unwrap(), None);
        FolderLock::acquire(folder.path()).unwrap();
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
