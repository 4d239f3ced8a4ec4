//! A run that is killed at any moment goes on with the same bits; results that are there are never lost by accident.

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

/// The table without the columns that tell of time, and the profile and history of each point.
fn results(out: &Path) -> Vec<(String, String)> {
    let table = std::fs::read_to_string(out.join("hugoniot.csv")).expect("a table");
    let rows: Vec<&str> = table.lines().filter(|line| !line.starts_with('#')).collect();
    let timed = |name: &str| name.starts_with("wall_time") || name.starts_with("particle_steps_per_second");
    let kept: Vec<usize> =
        rows[0].split(',').enumerate().filter(|(_, name)| !timed(name)).map(|(k, _)| k).collect();
    let cut = |row: &&str| {
        let cells: Vec<&str> = row.split(',').collect();
        kept.iter().map(|&k| cells[k]).collect::<Vec<_>>().join(",")
    };
    let mut list = vec![("hugoniot.csv".to_string(), rows.iter().map(cut).collect::<Vec<_>>().join("\n"))];
    let mut points: Vec<PathBuf> =
        std::fs::read_dir(out.join("points")).expect("points").map(|e| e.expect("a point").path()).collect();
    points.sort();
    let names = ["profile.csv", "history.csv", "blocks.csv", "search.csv"];
    for file in points.iter().flat_map(|p| names.map(|name| p.join(name))).filter(|file| file.exists()) {
        list.push((
            file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            std::fs::read_to_string(&file).expect("a table of the point"),
        ));
    }
    list
}

#[test]
fn a_killed_run_goes_on_with_the_same_bits() {
    goes_on_with_the_same_bits(&smoke_case(), 2 * 3);
}

/// The bisection keeps a second state, the one that its trials start from, and its log.
#[test]
fn a_killed_bisection_goes_on_with_the_same_bits() {
    let folder = tempfile::tempdir().expect("a folder");
    let case = folder.path().join("bisection.ron");
    let search = "search: Bisection(samples: 1, rounds: 1, tolerance: \"60 m/s\"), points: [\"300 m/s\"],";
    let text = std::fs::read_to_string(smoke_case()).expect("the case");
    let text = text.replace("points: [\"200 m/s\", \"300 m/s\"],", search);
    assert!(text.contains("Bisection"));
    std::fs::write(&case, text).expect("a file");
    goes_on_with_the_same_bits(&case, 4);
}

fn goes_on_with_the_same_bits(case: &Path, tables: usize) {
    let folder = tempfile::tempdir().expect("a folder");
    let straight = folder.path().join("straight through");
    assert_eq!(finish(hugoniot(case, &straight, &[])).0, Some(0));

    let killed = folder.path().join("killed, often");
    // A state after each step: wherever it is killed, one is there or half written.
    let mut kills = 0;
    for milliseconds in [30, 150, 400, 90, 700, 250, 1100] {
        let mut child = start(case, &killed, &["--resume", "--keep-every", "0.05"]);
        std::thread::sleep(Duration::from_millis(milliseconds));
        if child.try_wait().expect("a process").is_none() {
            child.kill().expect("it can be killed");
            kills += 1;
        }
        child.wait().expect("it ends");
    }
    assert!(kills >= 2, "the case is long enough to be killed in");
    assert_eq!(finish(hugoniot(case, &killed, &["--resume"])), (Some(0), String::new()));
    assert_eq!(results(&straight).len(), 1 + tables);
    for ((name, a), (_, b)) in results(&straight).iter().zip(&results(&killed)) {
        assert!(a == b, "{name} differs:\n{a}\n{b}");
    }

    // Once more: nothing is left to do, and nothing changes.
    let before = results(&killed);
    assert_eq!(finish(hugoniot(case, &killed, &["--resume"])).0, Some(0));
    assert!(before == results(&killed));
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
