//! The program: exit status, files, messages.

use std::path::Path;
use std::process::{Command, Output};

fn validate(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_sph-validate"))
        .args(arguments)
        .arg("--out")
        .arg(folder)
        .output()
        .expect("the program starts")
}

fn error_text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn unknown_names_list_what_there_is() {
    let folder = tempfile::tempdir().expect("a folder");
    for (option, known) in [
        ("--suite", "riemann, sound-wave, verny"),
        ("--scheme", "csph, tkc-muscl, tkc-hancock"),
        ("--tier", "quick, full"),
    ] {
        let output = validate(&[option, "verney"], folder.path());
        assert_eq!(output.status.code(), Some(2), "{option}");
        let text = error_text(&output);
        assert!(text.contains(known), "{option}: {text}");
    }
}

#[test]
fn folder_that_cannot_be_made_is_file_trouble() {
    let file = tempfile::NamedTempFile::new().expect("a file");
    let output = validate(&["--suite", "riemann"], &file.path().join("below-a-file"));
    assert_eq!(output.status.code(), Some(1));
    assert!(error_text(&output).contains("below-a-file"), "{}", error_text(&output));
}

#[test]
fn finished_runs_are_taken_over_and_never_lost_by_accident() {
    let folder = tempfile::tempdir().expect("a folder");
    let suite = ["--suite", "riemann", "--scheme", "tkc-hancock"];
    let run = |more: &[&str]| validate(&[&suite[..], more].concat(), folder.path());
    assert_eq!(run(&[]).status.code(), Some(0));
    let rows = || {
        let text = std::fs::read_to_string(folder.path().join("results.json")).expect("results.json");
        let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        (json["rows"].clone(), json["runs"].clone())
    };
    let first = rows();
    let refused = run(&[]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(error_text(&refused).contains("3 finished runs"), "{}", error_text(&refused));
    let resumed = run(&["--resume"]);
    assert_eq!(resumed.status.code(), Some(0));
    assert!(!error_text(&resumed).contains("n = 400:"), "computed again: {}", error_text(&resumed));
    assert_eq!(rows(), first, "the same figures, and the times of the runs that were kept");
    assert!(error_text(&run(&["--replace"])).contains("n = 400:"));
}

/// What was asked for has no runs: that is told, and does not pass.
#[test]
fn nothing_to_run_does_not_pass() {
    let folder = tempfile::tempdir().unwrap();
    let output = validate(&["--suite", "collapse", "--scheme", "csph"], folder.path());
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.contains("nothing to run"), "{told}");
}

#[test]
fn one_suite_with_one_scheme_writes_table_json_summary_and_plots() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = validate(&["--suite", "riemann", "--scheme", "tkc-hancock"], folder.path());
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{table}\n{}", error_text(&output));
    assert!(table.contains("stress_l1_order") && table.contains("gates passed"), "{table}");
    let json = std::fs::read_to_string(folder.path().join("results.json")).expect("results.json");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert!(json["rows"].as_array().is_some_and(|rows| rows.iter().all(|row| row["suite"] == "riemann")));
    let summary = std::fs::read_to_string(folder.path().join("summary.md")).expect("summary.md");
    assert!(
        summary.contains("cargo xtask validate --tier quick --suite riemann --scheme tkc-hancock"),
        "{summary}"
    );
    for plot in ["riemann.svg", "riemann.png", "riemann-convergence.svg", "riemann-convergence.png"] {
        assert!(folder.path().join(plot).is_file(), "{plot}");
        assert!(!plot.ends_with("png") || summary.contains(plot), "{plot} is shown");
    }
}
