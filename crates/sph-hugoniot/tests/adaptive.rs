//! An adaptive sweep: points are added where the curve bends, and a run that goes on adds the same ones.

use std::path::Path;
use std::process::Command;
use std::time::SystemTime;

use sph_io::table::Table;

fn case(max_points: usize) -> String {
    let text = sph_hugoniot::template::text("smoke").unwrap();
    let points = format!(
        "points: Adaptive(from: \"100 m/s\", to: \"400 m/s\", tolerance: 1e-4, max_points: {max_points}, initial_points: 4)"
    );
    let text = text.replace("points: [\"200 m/s\", \"300 m/s\"]", &points);
    assert!(text.contains("Adaptive"));
    text.replace("particle_size: \"2 um\"", "particle_size: \"2.5 um\"")
        .replace("cell: \"20 um\"", "cell: \"15 um\"")
        .replace("CenteredSquare()", "Square()")
        .replace("length: Cells(8)", "length: Cells(6)")
        .replace("max_fed_cells: 12", "max_fed_cells: 11")
        .replace("Cells(4)", "Cells(5)")
        // Most of the time would go into pictures, which other tests look at.
        .replace("output: (", "output: (images: false, ")
}

fn run(folder: &Path, max_points: usize, arguments: &[&str]) -> Vec<f64> {
    std::fs::write(folder.join("case.ron"), case(max_points)).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_hugoniot"))
        .current_dir(folder)
        .args(["run", "case.ron", "--quiet"])
        .args(arguments)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let out = arguments[arguments.iter().position(|a| *a == "--out").unwrap() + 1];
    let table = Table::read_csv(folder.join(out).join("hugoniot.csv")).unwrap();
    let column = table.column("u_p").unwrap();
    match &column.values {
        sph_io::table::Values::Float(values) => values.clone(),
        sph_io::table::Values::Integer(values) => values.iter().map(|&v| v as f64).collect(),
        sph_io::table::Values::Text(values) => panic!("{values:?}"),
    }
}

fn outcome(folder: &Path, point: &str) -> SystemTime {
    folder.join("out/points").join(point).join("outcome.ckpt").metadata().unwrap().modified().unwrap()
}

#[test]
fn a_run_that_goes_on_adds_points_and_computes_none_again() {
    let folder = tempfile::tempdir().unwrap();
    let first = run(folder.path(), 4, &["--out", "out", "--threads", "2"]);
    assert_eq!(first.len(), 4, "{first:?}");
    let written = outcome(folder.path(), "up_0400");
    let more = run(folder.path(), 5, &["--out", "out", "--threads", "1", "--resume"]);
    assert_eq!(outcome(folder.path(), "up_0400"), written);
    assert!(more.len() == 5 && more.is_sorted(), "{more:?}");
    assert!(first.iter().all(|u| more.contains(u)), "{first:?} {more:?}");
    // Nothing is left to do: the same points are chosen, and all are there.
    assert_eq!(run(folder.path(), 5, &["--out", "out", "--resume"]), more);
}
