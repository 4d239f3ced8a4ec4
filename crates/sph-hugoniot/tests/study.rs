//! A resolution study from the command line: one run a particle size, a table, a picture; it goes on where it was.

use std::path::Path;
use std::process::Command;

use sph_io::table::Table;

fn study(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    // Most of the time would go into pictures of the fields, which other tests look at.
    let text =
        sph_hugoniot::template::text("smoke").unwrap().replace("output: (", "output: (images: false, ");
    assert!(text.contains("images: false"));
    std::fs::write(folder.join("case.ron"), text).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_hugoniot"))
        .current_dir(folder)
        .args(["run", "case.ron", "--out", "out", "--quiet"])
        .args(arguments)
        .output()
        .unwrap();
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn a_study_runs_each_particle_size_and_extrapolates() {
    let folder = tempfile::tempdir().unwrap();
    let sizes = ["--up", "300", "--resolutions", "2um,2.5um"];
    assert_eq!(study(folder.path(), &sizes), (Some(0), String::new()));
    let out = folder.path().join("out");
    let outcome = |size: &str| {
        out.join(size).join("points/up_0300/outcome.ckpt").metadata().unwrap().modified().unwrap()
    };
    let first = (outcome("D_2.5um"), outcome("D_2um"));
    let table = Table::read_csv(out.join("resolution.csv")).unwrap();
    let value = |name: &str| table.floats(name).unwrap()[0];
    let (coarse, fine) = (value("u_s_2.5um"), value("u_s_2um"));
    // Between Richardson's formula of first and of second order.
    let richardson = |ratio: f64| (ratio * fine - coarse) / (ratio - 1.0);
    let expected = 0.5 * (richardson(1.25) + richardson(1.25 * 1.25));
    assert!((value("u_s_limit") / expected - 1.0).abs() < 1e-9, "{coarse} {fine}");
    assert!(value("uncertainty") >= value("order_spread"));
    assert!(out.join("plots/resolution.png").metadata().unwrap().len() > 1000);

    // Nothing is lost by accident, and a study that goes on computes nothing again; what a killed one was just writing goes.
    let left = ["", "plots", "D_2um/plots", "D_2.5um/points/up_0300"]
        .map(|part| out.join(part).join(".unfinished-Ab3x9q.tmp"));
    left.iter().for_each(|path| std::fs::write(path, "half").unwrap());
    let (code, said) = study(folder.path(), &sizes);
    assert!(code == Some(2) && said.contains("--resume"), "{said}");
    let more = [&sizes[..], &["--resume"]].concat();
    assert_eq!(study(folder.path(), &more), (Some(0), String::new()));
    assert_eq!(first, (outcome("D_2.5um"), outcome("D_2um")));
    assert!(!left.iter().any(|path| path.exists()));
}

#[test]
fn a_folder_that_holds_a_run_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("out")).unwrap();
    std::fs::write(folder.path().join("out/case.json"), "{}").unwrap();
    for more in [&[][..], &["--resume"], &["--replace"]] {
        let (code, told) = study(folder.path(), &[&["--resolutions", "2um"], more].concat());
        assert_eq!(code, Some(2), "{told}");
        assert!(told.contains("there are results of a run with one particle size; hint: --out"), "{told}");
    }
}

#[test]
fn a_particle_size_that_does_not_fit_is_told_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let (code, said) = study(folder.path(), &["--resolutions", "2um,3um"]);
    assert_eq!(code, Some(2));
    assert!(said.contains("with --resolutions 3 um") && said.contains("does not divide"), "{said}");
    assert!(!folder.path().join("out").exists());
    assert_eq!(study(folder.path(), &["--resolutions", "1GPa"]).0, Some(2));
}

/// A pipe can be read once: so is it with a file that is edited while the run begins.
#[cfg(unix)]
#[test]
fn the_case_is_read_once_for_all_particle_sizes_and_for_what_is_kept() {
    use std::io::Write;
    let folder = tempfile::tempdir().unwrap();
    let text = sph_hugoniot::template::text("smoke")
        .unwrap()
        .replace("output: (", "output: (images: false, ")
        .replace("max_fed_cells: 12", "max_fed_cells: 6")
        .replace("Cells(4)", "Cells(2)");
    let mut child = Command::new(env!("CARGO_BIN_EXE_hugoniot"))
        .current_dir(folder.path())
        .args(["run", "/dev/stdin", "--up", "300", "--resolutions", "2.5um", "--out", "out", "--quiet"])
        .stdin(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(std::fs::read_to_string(folder.path().join("out/D_2.5um/case.ron")).unwrap(), text);
}
