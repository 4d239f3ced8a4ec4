//! Results that are there are never lost by accident, and damaged states are told. That a run which was killed goes on with
//! the same bits is the matter of `soak.rs`.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use sph_io::lock::FolderLock;

fn smoke_case() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/smoke.ron")
}

fn hugoniot(case: &Path, out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hugoniot"));
    command.arg("run").arg(case).arg("--out").arg(out).args(["--quiet", "--threads", "1"]).args(more);
    command.env_remove("RUST_BACKTRACE").env_remove("RUST_LOG").stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

fn start(case: &Path, out: &Path, more: &[&str]) -> Child {
    hugoniot(case, out, more).spawn().expect("the program starts")
}

/// Exit code and what was said on standard error.
fn finish(mut command: Command) -> (Option<i32>, String) {
    let output = command.output().expect("the program runs");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// The states of a point, the oldest first; none if there is no such folder yet.
fn states(point: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(point).into_iter().flatten();
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut states: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|e| e == "ckpt")).collect();
    states.sort();
    states
}

/// Waits until something is there that a run writes. A run that ends before has failed.
fn wait_for(child: &mut Child, there: impl Fn() -> bool) {
    while !there() {
        assert!(child.try_wait().expect("a process").is_none() || there(), "the run has ended");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn kill(mut child: Child) {
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
}

#[test]
fn a_folder_in_use_is_refused_and_told_by_whom() {
    let folder = tempfile::tempdir().expect("a folder");
    let _lock = FolderLock::acquire(folder.path()).expect("nobody holds it");
    let (code, said) = finish(hugoniot(&smoke_case(), folder.path(), &["--resume"]));
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains(&format!("in use by process {} (waited ", std::process::id())), "{said}");
}

#[test]
fn earlier_results_are_not_overwritten_and_a_changed_case_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("run");
    let mut child = start(&smoke_case(), &out, &["--keep-every", "0"]);
    wait_for(&mut child, || out.join("case.json").exists());
    kill(child);

    let (code, said) = finish(hugoniot(&smoke_case(), &out, &[]));
    assert_eq!(code, Some(2));
    assert!(said.contains("--resume"), "{said}");

    let text = std::fs::read_to_string(smoke_case()).expect("the case");
    assert!(text.contains("smoothing: 0.5") || !text.contains("smoothing"));
    let changed = folder.path().join("changed.ron");
    let with_theta = text.replacen("medium:", "scheme: (cfl: 0.35), medium:", 1);
    std::fs::write(&changed, with_theta).expect("a file");
    let (code, said) = finish(hugoniot(&changed, &out, &["--resume"]));
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("scheme.courant: 0.4 -> 0.35"), "{said}");
}

#[test]
fn a_damaged_state_is_told_and_the_one_before_it_taken() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("run");
    let mut child = start(&smoke_case(), &out, &["--up", "300", "--keep-every", "0"]);
    wait_for(&mut child, || states(&out.join("points/up_0300")).len() >= 2);
    kill(child);
    let newest = states(&out.join("points/up_0300")).pop().expect("a state");
    let mut bytes = std::fs::read(&newest).expect("a state");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&newest, bytes).expect("a damaged state");
    let (code, said) = finish(hugoniot(&smoke_case(), &out, &["--up", "300", "--resume"]));
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("the state before it is taken"), "{said}");
    assert_eq!(said.lines().count(), 1, "and nothing else: {said}");
}

#[test]
fn a_run_that_an_error_stopped_does_not_look_killed() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("run");
    // The page cannot be written where a folder is; all before it can.
    std::fs::create_dir_all(out.join("report.html")).expect("a folder in the way");
    let (code, said) = finish(hugoniot(&smoke_case(), &out, &["--up", "300"]));
    assert_eq!(code, Some(1), "{said}");
    let output = Command::new(env!("CARGO_BIN_EXE_hugoniot")).arg("status").arg(&out).output();
    let told = String::from_utf8_lossy(&output.expect("the program runs").stdout).into_owned();
    assert!(told.contains("smoke: stopped by an error, 1 of 1 points ended"), "{told}");
    assert!(told.contains("go on with: hugoniot run ") && told.contains("--resume"), "{told}");
}

#[test]
fn a_status_that_cannot_be_written_is_told_once_and_the_run_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("run");
    std::fs::create_dir_all(out.join("status.json")).expect("a folder in the way");
    let (code, said) = finish(hugoniot(&smoke_case(), &out, &["--up", "300"]));
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(said.matches("status.json").count(), 1, "{said}");
    assert!(said.contains("WARN") && said.lines().count() == 1, "{said}");
}

/// Folders below a place, and the place itself.
fn folders(place: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(place).expect("a folder").map(|entry| entry.expect("an entry").path());
    let below: Vec<PathBuf> = entries.filter(|path| path.is_dir()).collect();
    [place.to_owned()].into_iter().chain(below.iter().flat_map(|folder| folders(folder))).collect()
}

/// What a killed process was just writing is cleared away at the next start, in every folder that a run makes, and nothing
/// else is.
#[test]
fn unfinished_files_of_a_killed_run_are_cleared_away() {
    let folder = tempfile::tempdir().unwrap();
    let (case, out) = (folder.path().join("case.ron"), folder.path().join("out"));
    let text = std::fs::read_to_string(smoke_case()).unwrap();
    let series = "output: (snapshots: Every(cells: 4), ";
    assert!(text.contains("output: ("));
    std::fs::write(&case, text.replace("output: (", series)).unwrap();
    let (code, said) = finish(hugoniot(&case, &out, &["--up", "300"]));
    assert_eq!(code, Some(0), "{said}");
    let found = folders(&out);
    for part in ["plots", "curve", "points", "points/up_0300", "points/up_0300/snapshots"] {
        assert!(found.contains(&out.join(part)), "{part}: {found:?}");
    }
    let left: Vec<PathBuf> = found.iter().map(|folder| folder.join(".unfinished-Ab3x9q.tmp")).collect();
    let own = out.join("points/my notes.tmp");
    // As after a kill between the outcome and the end of the states on the way to it.
    let state = out.join("points/up_0300/state-0000000007.ckpt");
    left.iter().chain([&own, &state]).for_each(|path| std::fs::write(path, "x").unwrap());

    let (code, _) = finish(hugoniot(&case, &out, &["--up", "300"]));
    assert_eq!(code, Some(2), "a run that is refused");
    assert!(left.iter().all(|path| path.exists()), "touches nothing");
    let mut command = hugoniot(&case, &out, &["--up", "300", "--resume"]);
    command.env("RUST_LOG", "debug");
    let (code, said) = finish(command);
    assert_eq!(code, Some(0), "{said}");
    let told = said.matches("left unfinished by a process that was killed").count();
    assert_eq!(told, left.len(), "{said}");
    assert!(!left.iter().any(|path| path.exists()) && own.exists() && !state.exists());
}
