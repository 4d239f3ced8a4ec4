//! Whole runs of small cases: results, failures, interrupts, threads.

use std::path::Path;
use std::process::Command;

use sph_io::table::Table;

#[path = "../examples/one_point.rs"]
mod one_point;
#[path = "../examples/small_sweep.rs"]
mod small_sweep;

#[test]
fn the_examples_run() {
    one_point::main().unwrap();
    small_sweep::main().unwrap();
}

fn hugoniot() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hugoniot"));
    command.env_remove("RUST_BACKTRACE").env_remove("RUST_LOG");
    command
}

fn smoke() -> &'static str {
    sph_hugoniot::template::text("smoke").unwrap()
}

/// Writes a case into a folder and runs it there; (exit code, standard error).
fn run(folder: &Path, case: &str, arguments: &[&str]) -> (i32, String) {
    std::fs::write(folder.join("case.ron"), case).unwrap();
    let output = hugoniot().current_dir(folder).args(["run", "case.ron"]).args(arguments).output().unwrap();
    (output.status.code().unwrap(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn the_smoke_case_runs_from_file_to_report() {
    let folder = tempfile::tempdir().unwrap();
    let (code, message) = run(folder.path(), smoke(), &["--up", "300", "--out", "an ä folder", "--quiet"]);
    assert_eq!((code, message.as_str()), (0, ""));
    let out = folder.path().join("an ä folder");
    let table = Table::read_csv(out.join("hugoniot.csv")).unwrap();
    let value = |name: &str| table.floats(name).unwrap()[0];
    // The jump conditions of shut pores leave 1117.7 to 1122.5 m/s; a coarse, short run is near.
    assert!((value("u_s") / 1120.0 - 1.0).abs() < 0.01, "u_s = {}", value("u_s"));
    assert!((value("u_s_mass") / value("u_s") - 1.0).abs() < 0.01);
    assert!((value("packing_over_own") - 1.0).abs() < 0.01);
    assert!(value("ledger_residual") < 1e-12);
    for name in ["residual_mass", "residual_momentum", "residual_energy"] {
        assert!(value(name).abs() < 0.03, "{name} = {}", value(name));
    }
    for file in [
        "report.html",
        "points/up_0300/monitors.csv",
        "hugoniot.json",
        "case.ron",
        "case.json",
        "points/up_0300/profile.csv",
        "points/up_0300/history.csv",
    ] {
        assert!(out.join(file).metadata().unwrap().len() > 100, "{file}");
    }
    for name in ["hugoniot", "hugoniot_with_solid", "profile_up_0300", "history_up_0300"] {
        for ending in ["svg", "png"] {
            assert!(
                out.join(format!("plots/{name}.{ending}")).metadata().unwrap().len() > 1000,
                "{name}.{ending}"
            );
        }
    }
    assert!(out.join("curve/curve.csv").exists() && out.join("curve/fits.json").exists());
    assert!(out.join("plots/fields_up_0300.png").metadata().unwrap().len() > 1000);
}

/// Points on one thread each, and one point on three threads, give the same bits.
#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let case = smoke().replace("max_fed_cells: 12", "max_fed_cells: 9").replace("Cells(4)", "Cells(2)");
    let mut tables = Vec::new();
    for (threads, points) in [("1", "300"), ("3", "300"), ("2", "300,310")] {
        let (code, message) =
            run(folder.path(), &case, &["--up", points, "--threads", threads, "--out", threads, "--quiet"]);
        assert_eq!(code, 0, "{message}");
        tables.push(Table::read_csv(folder.path().join(threads).join("hugoniot.csv")).unwrap());
    }
    for name in
        ["u_s", "u_s_error", "stress_jump", "rho_packing", "residual_energy", "fed_cells", "ledger_residual"]
    {
        let bits: Vec<u64> = tables.iter().map(|t| t.floats(name).unwrap()[0].to_bits()).collect();
        assert!(bits.iter().all(|b| *b == bits[0]), "{name} differs: {bits:?}");
    }
}

/// A Courant number that the printed scheme does not bear breaks the fast point; the slow one is kept.
#[test]
fn a_failed_point_is_reported_and_the_others_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let case = smoke().replace(
        "window: (length: Cells(8)),",
        "window: (length: Cells(8)), scheme: (scheme: TkcMuscl, cfl: 1.0, limiter: MinmodPrinted, smoothing: 0.45),",
    );
    let (code, message) = run(folder.path(), &case, &["--up", "300,1000", "--out", "out", "--quiet"]);
    assert_eq!(code, 3, "{message}");
    // A particle breaks, or the time step for it falls to nothing: the last bits decide which is seen first.
    let told = |text: &str| text.contains("failed: ") && text.contains("particle ");
    assert!(message.contains("u_p = 1000 m/s failed: "), "{message}");
    assert!(told(&message) && message.contains("hint: "), "{message}");
    let csv = std::fs::read_to_string(folder.path().join("out/hugoniot.csv")).unwrap();
    let rows: Vec<&str> = csv.lines().filter(|l| !l.starts_with('#')).collect();
    assert_eq!(rows.len(), 3, "{csv}");
    assert!(rows[1].starts_with("300,") && !rows[1].contains("failed"), "{csv}");
    assert!(rows[2].starts_with("1000,") && told(rows[2]), "{csv}");
}

#[test]
fn bad_input_runs_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (code, message) = run(folder.path(), &smoke().replace("2 um", "2 GPa"), &["--out", "out"]);
    assert_eq!(code, 2);
    assert!(message.contains("case.ron:11:24") && message.contains("unit of pressure"), "{message}");
    assert!(!folder.path().join("out").exists());
    assert_eq!(run(folder.path(), smoke(), &["--up", "100,fast"]).0, 2);
    assert_eq!(run(folder.path(), smoke(), &["--up", "-5"]).0, 2);
    let (code, message) = run(folder.path(), smoke(), &["--up", "1500"]);
    assert!(code == 2 && message.contains("overruns the elastic precursor"), "{message}");
    std::fs::write(folder.path().join("file"), "").unwrap();
    let (code, message) = run(folder.path(), smoke(), &["--out", "file/out"]);
    assert_eq!(code, 1, "the input is right, the folder cannot be made");
    assert!(message.contains("file/out"), "{message}");
}

#[cfg(unix)]
fn interrupt(child: &std::process::Child) {
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
}

/// A run of a case in a folder, once its point is under way.
#[cfg(unix)]
fn under_way(folder: &Path, case: &str) -> std::process::Child {
    std::fs::write(folder.join("case.ron"), case).unwrap();
    let mut command = hugoniot();
    command.current_dir(folder).args(["run", "case.ron", "--up", "300", "--out", "out", "--quiet"]);
    let mut child = command.stderr(std::process::Stdio::piped()).spawn().unwrap();
    while !folder.join("out/points/up_0300").exists() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before its point began");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    std::thread::sleep(std::time::Duration::from_millis(100));
    child
}

/// The smoke case without an end, so that a busy machine cannot come too late.
#[cfg(unix)]
fn endless() -> String {
    smoke().replace("max_fed_cells: 12", "max_fed_cells: 100000").replace("tolerance: 0.1", "tolerance: 1e-5")
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_goes_on_to_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = under_way(folder.path(), smoke());
    interrupt(&child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(folder.path().join("out/report.html").exists());
    let resumed = hugoniot()
        .current_dir(folder.path())
        .args(["run", "case.ron", "--up", "300", "--out", "out", "--quiet", "--resume"])
        .env("RUST_LOG", "info")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&resumed.stderr);
    assert_eq!(resumed.status.code(), Some(0), "{said}");
    let csv = std::fs::read_to_string(folder.path().join("out/hugoniot.csv")).unwrap();
    assert!(csv.lines().last().unwrap().ends_with("settled"), "{csv}");
}

/// The second Ctrl-C does not wait for the report, which the first one does.
#[cfg(unix)]
#[test]
fn a_second_interrupt_stops_at_once() {
    use std::io::{BufRead, BufReader};
    let folder = tempfile::tempdir().unwrap();
    let mut child = under_way(folder.path(), &endless());
    let mut said = BufReader::new(child.stderr.take().unwrap()).lines();
    interrupt(&child);
    assert!(said.any(|line| line.unwrap().contains("again to stop at once")));
    interrupt(&child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(!folder.path().join("out/report.html").exists());
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_what_was_computed() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = under_way(folder.path(), &endless());
    interrupt(&child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let csv = std::fs::read_to_string(folder.path().join("out/hugoniot.csv")).unwrap();
    assert!(csv.lines().last().unwrap().ends_with("interrupted"), "{csv}");
}
