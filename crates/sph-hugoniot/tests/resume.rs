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
    let mut child = start(&smoke_case(), &out, &["--keep-every", "0"]);
    std::thread::sleep(Duration::from_millis(400));
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    let mut states: Vec<PathBuf> = std::fs::read_dir(out.join("points"))
        .expect("points")
        .flat_map(|point| std::fs::read_dir(point.expect("a point").path()).expect("its files"))
        .map(|file| file.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|e| e == "ckpt"))
        .collect();
    states.sort();
    assert_eq!(states.len(), 2, "{states:?}");
    let mut bytes = std::fs::read(&states[1]).expect("a state");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&states[1], bytes).expect("a damaged state");
    let mut command = hugoniot(&smoke_case(), &out, &["--resume"]);
    command.env("RUST_LOG", "warn");
    let (code, said) = finish(command);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("the state before it is taken"), "{said}");
}
