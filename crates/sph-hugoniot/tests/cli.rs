//! The command line: exit codes and what is said.

use assert_cmd::Command;

fn hugoniot() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hugoniot"));
    command.env_remove("RUST_BACKTRACE").env_remove("RUST_LOG");
    command
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn init_writes_a_case_that_check_accepts() {
    let folder = tempfile::tempdir().unwrap();
    for template in ["porous-copper", "smoke"] {
        let output = hugoniot().args(["init", template]).assert().success().get_output().stdout.clone();
        let path = folder.path().join(format!("{template} ä.ron"));
        std::fs::write(&path, output).unwrap();
        hugoniot().current_dir(folder.path()).arg("check").arg(&path).assert().success();
        assert!(
            folder.path().join(format!("results/{template}/sample.png")).exists(),
            "the picture of the sample"
        );
    }
}

#[test]
fn shipped_cases_are_the_templates() {
    let cases = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for (name, template) in sph_hugoniot::template::TEMPLATES {
        let shipped = std::fs::read_to_string(cases.join(format!("{name}.ron"))).unwrap();
        assert!(
            shipped == template,
            "cases/{name}.ron differs from crates/sph-hugoniot/templates/{name}.ron"
        );
    }
}

#[test]
fn check_tells_what_a_case_resolves_to() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.ron");
    std::fs::write(&path, sph_hugoniot::template::text("porous-copper").unwrap()).unwrap();
    let output = hugoniot()
        .current_dir(folder.path())
        .args(["check", "--json"])
        .arg(&path)
        .assert()
        .success()
        .get_output()
        .stdout
        .clone();
    let value: serde_json::Value = serde_json::from_slice(&output).unwrap();
    assert_eq!(value["particles_per_cell"], 296);
    let reached = value["porosity_reached"].as_f64().unwrap();
    assert!((reached - 1.3514).abs() < 1e-4);
}

#[test]
fn a_broken_file_lists_all_faults_and_exits_with_two() {
    let bad = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/bad/many_faults.ron");
    for command in ["check", "run"] {
        let assert = hugoniot().arg(command).arg(&bad).assert().code(2);
        let message = text(&assert.get_output().stderr);
        for part in
            ["many_faults.ron:6:15", "medium.cell: `GPa`", "hint: did you mean `VanLeer`?", "16 faults found"]
        {
            assert!(message.contains(part), "{part} is missing in\n{message}");
        }
        assert!(assert.get_output().stdout.is_empty());
    }
}

#[test]
fn wrong_arguments_and_missing_files_exit_with_two() {
    hugoniot().arg("walk").assert().code(2);
    hugoniot().args(["init", "porous-coper"]).assert().code(2);
    let assert = hugoniot().args(["check", "no such file.ron"]).assert().code(2);
    let message = text(&assert.get_output().stderr);
    assert!(message.contains("no such file.ron"), "{message}");
    assert!(!message.contains("1 |"), "a file without text has no line to show: {message}");
}

#[test]
fn an_argument_out_of_range_is_told_with_its_range() {
    for (arguments, hint) in [
        (["run", "case.ron", "--up", "-5"], "out of range; hint: from 1 to 3000 m/s"),
        (["run", "case.ron", "--up", "1e300"], "out of range; hint: from 1 to 3000 m/s"),
        (["run", "case.ron", "--keep-every", "-5"], "out of range; hint: 0 to 1e6 s"),
        (["check", "case.ron", "--picture", "sample.jpg"], "pictures are PNG files"),
    ] {
        let assert = hugoniot().args(arguments).assert().code(2);
        let message = text(&assert.get_output().stderr);
        assert!(message.contains(hint), "{arguments:?}: {message}");
        assert!(message.lines().all(|line| line.len() < 120), "{arguments:?}: {message}");
    }
}

#[test]
fn help_shows_examples() {
    let help = text(&hugoniot().arg("--help").assert().success().get_output().stdout);
    assert!(help.contains("hugoniot init porous-copper > case.ron") && help.contains("Exit codes"));
    let help = help.split_whitespace().collect::<Vec<_>>().join(" "); // Lines end where the terminal does.
    for code in ["0 done", "1 a file", "2 bad input", "3 a point failed", "130 interrupted"] {
        assert!(help.contains(code), "{code}");
    }
}

/// A reader that has gone wants no more; a full disk is told. Neither is a panic.
#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_cannot_be_written_is_no_panic() {
    let plain = || std::process::Command::new(env!("CARGO_BIN_EXE_hugoniot"));
    let full = || std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    for arguments in [&["init", "porous-copper"][..], &["schema", "table"], &["completions", "bash"]] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = plain().args(arguments).stdout(writer).output().unwrap();
        assert_eq!((output.status.code(), &output.stderr[..]), (Some(0), &b""[..]), "{arguments:?}");
        let output = plain().args(arguments).stdout(full()).output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {told}");
        assert!(told.starts_with("error: standard output cannot be written: "), "{arguments:?}: {told}");
        // Nor does it matter whether faults can be told.
        let status = plain().args(["check", "nowhere.ron"]).stderr(full()).status().unwrap();
        assert_eq!(status.code(), Some(2));
    }
}
