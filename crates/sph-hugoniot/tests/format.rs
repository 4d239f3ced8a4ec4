//! A run that was begun with the present folder format and killed is kept in `tests/format`: today's program goes on with
//! it, or the format has changed without its number. The shapes of all stored types are held by `src/restart_tests.rs`.
//!
//! After a change on purpose: raise `FOLDER_FORMAT` in `src/report/earlier.rs`, then
//! `RENEW_FORMAT=1 cargo test -p sph-hugoniot format`.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const POINT: &str = "points/up_0300";

fn golden() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/format")
}

fn hugoniot(out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hugoniot"));
    command.arg("run").arg(golden().join("case.ron")).arg("--out").arg(out).args([
        "--quiet",
        "--threads",
        "1",
    ]);
    command.args(more).env_remove("RUST_BACKTRACE").env_remove("RUST_LOG").stdout(Stdio::null());
    command
}

fn states(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder.join(POINT)) else { return Vec::new() };
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut states: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|e| e == "ckpt")).collect();
    states.sort();
    states
}

/// What a resume needs of a run: the case as it was resolved, and one state.
fn keep(from: &Path, state: &Path, to: &Path) {
    let _ = std::fs::remove_dir_all(to);
    std::fs::create_dir_all(to.join(POINT)).expect("a folder");
    std::fs::copy(from.join("case.json"), to.join("case.json")).expect("the case");
    let name = state.file_name().expect("a name");
    std::fs::copy(state, to.join(POINT).join(name)).expect("the state");
}

/// Begins the run anew and keeps its first state, which is small.
fn renew() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut child = hugoniot(folder.path(), &["--keep-every", "0"]).spawn().expect("the program starts");
    let first = loop {
        if let Some(first) = states(folder.path()).first() {
            // Held before the next states push it out.
            child.kill().expect("SIGKILL");
            child.wait().expect("it ends");
            break states(folder.path()).first().unwrap_or(first).clone();
        }
        assert!(child.try_wait().expect("a process").is_none(), "it ended before it kept a state");
        std::thread::sleep(std::time::Duration::from_millis(1));
    };
    keep(folder.path(), &first, &golden().join("run"));
}

#[test]
fn a_run_of_the_present_format_goes_on() {
    if std::env::var_os("RENEW_FORMAT").is_some() {
        renew();
    }
    let folder = tempfile::tempdir().expect("a folder");
    let kept = golden().join("run");
    let [state] = &states(&kept)[..] else { panic!("one state is kept in {}", kept.display()) };
    keep(&kept, state, folder.path());
    let output = hugoniot(folder.path(), &["--resume"]).output().expect("the program runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(
        output.status.code(),
        Some(0),
        "a run that an earlier build began cannot be gone on with: raise FOLDER_FORMAT in src/report/earlier.rs, then \
         RENEW_FORMAT=1 cargo test -p sph-hugoniot format\n{said}"
    );
    assert!(folder.path().join(POINT).join("outcome.ckpt").exists());
}
