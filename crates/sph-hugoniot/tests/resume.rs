//! Results that are there are never lost by accident, and damaged states are told. That a run which was killed goes on with
//! the same bits is the matter of `soak.rs`.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

fn smoke_case() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/smoke.ron")
}

fn hugoniot(case: &Path, out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hugoniot"));
    command.arg("run").arg(case).arg("--out").arg(out).args(["--quiet", "--threads", "1"]).args(more);
    command.env_remove("RUST_BACKTRACE").stdout(Stdio::null()).stderr(Stdio::piped());
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

#[test]
fn earlier_results_are_not_overwritten_and_a_changed_case_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("run");
    let mut child = start(&smoke_case(), &out, &["--keep-every", "0"]);
    std::thread::sleep(Duration::from_millis(300));
    let (code, said) = finish(hugoniot(&smoke_case(), &out, &["--resume"]));
    if child.try_wait().expect("a process").is_none() {
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains("process"), "who holds the folder: {said}");
    }
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");

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
    while states(&out.join("points/up_0300")).len() < 2 {
        std::thread::sleep(Duration::from_millis(10));
    }
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    let newest = states(&out.join("points/up_0300")).pop().expect("a state");
    let mut bytes = std::fs::read(&newest).expect("a state");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&newest, bytes).expect("a damaged state");
    let mut command = hugoniot(&smoke_case(), &out, &["--up", "300", "--resume"]);
    command.env("RUST_LOG", "warn");
    let (code, said) = finish(command);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("the state before it is taken"), "{said}");
}

/// What a killed process was just writing is cleared away at the next start, and nothing else.
#[test]
fn unfinished_files_of_a_killed_run_are_cleared_away() {
    let folder = tempfile::tempdir().unwrap();
    let (case, out) = (smoke_case(), folder.path().join("out"));
    let mut child = start(&case, &out, &["--up", "300", "--keep-every", "0"]);
    let point = out.join("points/up_0300");
    while !point.exists() {
        std::thread::sleep(Duration::from_millis(10));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let left = [out.join(".unfinished-Ab3x9q.tmp"), point.join(".unfinished-Ab3x9q.tmp")];
    let own = out.join("points/my notes.tmp");
    left.iter().chain([&own]).for_each(|path| std::fs::write(path, "x").unwrap());

    let (code, _) = finish(hugoniot(&case, &out, &["--up", "300"]));
    assert_eq!(code, Some(2), "a run that is refused");
    assert!(left.iter().all(|path| path.exists()), "touches nothing");
    let mut command = hugoniot(&case, &out, &["--up", "300", "--resume"]);
    command.env("RUST_LOG", "debug");
    let (code, said) = finish(command);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.matches("left unfinished by a process that was killed").count() >= 2, "{said}");
    assert!(!left.iter().any(|path| path.exists()) && own.exists());
}
