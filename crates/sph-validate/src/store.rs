//! Finished runs on disk: `runs/<run>.ckpt` in the folder of the report.
//!
//! A run is kept as soon as it has ended, whole or not at all, with a number for the code that made it ([`CODE`]) and for
//! the parameters of its problem. `--resume` takes a kept run over if both are what this program would make it with:
//! the same code gives the same bits, so that a report of kept runs is that of an uninterrupted one, but for the times.
//! Runs of other code are computed again. Runs that failed are not kept.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sph_io::lock::FolderLock;
use sph_io::{atomic, checkpoint};

use crate::case::Case;
use crate::error::ValidateError;
use crate::outcome::Outcome;

/// A number for everything that a figure of a run can depend on; `build.rs` makes it.
pub const CODE: &str = env!("SPH_VALIDATE_CODE");

/// What happens to finished runs that a validation finds in its folder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Earlier {
    /// The validation is refused: nothing is lost by accident.
    #[default]
    Refuse,
    /// Those that this program would give again are taken over.
    Resume,
    /// They are thrown away.
    Replace,
}

/// The finished runs of a folder, which is held for this process.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    _lock: FolderLock,
}

/// A kept run.
#[derive(Serialize, Deserialize)]
struct Kept {
    code: String,
    parameters: String,
    outcome: Outcome,
}

impl Store {
    /// Opens the finished runs of a folder of reports, which is made if it is not there.
    ///
    /// # Errors
    /// If the folder cannot be made or is in use; [`ValidateError::Earlier`] if it holds runs that are to be refused.
    pub fn open(out: &Path, earlier: Earlier) -> Result<Self, ValidateError> {
        let folder = out.join("runs");
        let fault = |reason: String| ValidateError::Output { path: out.to_owned(), reason };
        std::fs::create_dir_all(&folder).map_err(|error| fault(error.to_string()))?;
        let lock = FolderLock::acquire(out).map_err(|error| fault(error.to_string()))?;
        let store = Self { folder, _lock: lock };
        let kept = store.kept().map_err(|error| fault(error.to_string()))?;
        if !kept.is_empty() && earlier == Earlier::Refuse {
            return Err(ValidateError::Earlier { folder: out.to_owned(), count: kept.len() });
        }
        if earlier == Earlier::Replace {
            kept.iter().try_for_each(std::fs::remove_file).map_err(|error| fault(error.to_string()))?;
        }
        // What a killed process was just writing.
        atomic::remove_leftovers(out).map_err(|error| fault(error.to_string()))?;
        Ok(store)
    }

    fn kept(&self) -> std::io::Result<Vec<PathBuf>> {
        let paths = std::fs::read_dir(&self.folder)?.map(|entry| entry.map(|entry| entry.path()));
        let is_kept = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "ckpt");
        Ok(paths.collect::<Result<Vec<_>, _>>()?.into_iter().filter(is_kept).collect())
    }

    fn path(&self, case: &Case) -> PathBuf {
        self.folder.join(format!("{}.ckpt", case.stem()))
    }

    /// The outcome of a run, if it is kept and this program would give the same. A file that cannot be read is none.
    pub fn load(&self, case: &Case, parameters: &str) -> Option<Outcome> {
        let kept = checkpoint::read::<Kept>(self.path(case)).ok()?.header;
        let is_same = kept.code == CODE && kept.parameters == parameters && kept.outcome.case == *case;
        is_same.then_some(kept.outcome)
    }

    /// Keeps the outcome of a run.
    ///
    /// # Errors
    /// [`ValidateError::Output`] if the file cannot be written.
    pub fn save(&self, outcome: &Outcome, parameters: &str) -> Result<(), ValidateError> {
        let path = self.path(&outcome.case);
        let kept =
            Kept { code: CODE.to_owned(), parameters: parameters.to_owned(), outcome: outcome.clone() };
        checkpoint::write(&path, &kept, &[])
            .map_err(|error| ValidateError::Output { path, reason: error.to_string() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::SchemeName;
    use crate::conservation::Conservation;
    use crate::metric::{Measurement, Metric};
    use crate::outcome::{Cost, Curve};

    fn outcome() -> Outcome {
        let metric = Metric::norm("stress_l1", "GPa");
        let measurements =
            [f64::NAN, 0.1 + 0.2].map(|value| Measurement::error_of(metric.clone(), value)).to_vec();
        Outcome {
            case: Case::new("riemann", SchemeName::Csph, 100).of_variant("steel"),
            measurements,
            conservation: Conservation { angular_momentum: Some(1e-17), ..Conservation::default() },
            curves: vec![Curve::new("profile", vec![(0.1, 0.3)])],
            fields: Vec::new(),
            cost: Cost { particles: 3, steps: 2, particle_steps: 6, seconds: 0.5 },
        }
    }

    #[test]
    fn kept_run_comes_back_to_the_last_bit_and_only_for_its_own_case_and_parameters() {
        let folder = tempfile::tempdir().expect("a folder");
        let store = Store::open(folder.path(), Earlier::Refuse).expect("an empty folder");
        let outcome = outcome();
        store.save(&outcome, "P = 1").expect("written");
        let back = store.load(&outcome.case, "P = 1").expect("kept");
        assert!(back.measurements[0].value.is_nan());
        assert_eq!(back.measurements[1..], outcome.measurements[1..]);
        assert_eq!((back.conservation, &back.curves), (outcome.conservation, &outcome.curves));
        assert!(store.load(&outcome.case, "P = 2").is_none());
        assert!(store.load(&Case { n: 200, ..outcome.case.clone() }, "P = 1").is_none());
    }

    #[test]
    fn damaged_file_is_no_run() {
        let folder = tempfile::tempdir().expect("a folder");
        let store = Store::open(folder.path(), Earlier::Refuse).expect("an empty folder");
        store.save(&outcome(), "").expect("written");
        let path = store.path(&outcome().case);
        let mut bytes = std::fs::read(&path).expect("the file");
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        std::fs::write(&path, bytes).expect("written");
        assert!(store.load(&outcome().case, "").is_none());
    }

    #[test]
    fn kept_runs_are_neither_lost_nor_taken_over_by_accident() {
        let folder = tempfile::tempdir().expect("a folder");
        let open = |earlier| Store::open(folder.path(), earlier);
        open(Earlier::Refuse).expect("an empty folder").save(&outcome(), "").expect("written");
        let left = ["", "runs", "plots"].map(|part| folder.path().join(part).join(".unfinished-Ab3x9q.tmp"));
        std::fs::create_dir_all(folder.path().join("plots")).expect("a folder");
        left.iter().for_each(|path| std::fs::write(path, "half").expect("written"));
        let refusal = open(Earlier::Refuse).expect_err("there is a run").to_string();
        assert!(refusal.contains("--resume") && refusal.contains("--replace"), "{refusal}");
        assert!(left.iter().all(|path| path.exists()), "a validation that is refused touches nothing");
        assert!(open(Earlier::Resume).expect("goes on").load(&outcome().case, "").is_some());
        assert!(!left.iter().any(|path| path.exists()), "what a killed process was writing is cleared away");
        assert!(open(Earlier::Replace).expect("throws away").load(&outcome().case, "").is_none());
    }

    #[test]
    fn two_validations_cannot_share_a_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = Store::open(folder.path(), Earlier::Refuse).expect("an empty folder");
        let error = Store::open(folder.path(), Earlier::Resume).expect_err("locked").to_string();
        assert!(error.contains("process"), "{error}");
        drop(first);
    }
}
