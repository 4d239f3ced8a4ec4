//! At the prompt: status, JSON with its schemas, colors, completions, odd folders, a home that must not be written to.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;
use sph_hugoniot::schema::Schema;

fn hugoniot(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hugoniot"));
    command.env_remove("RUST_BACKTRACE").env_remove("RUST_LOG").env_remove("NO_COLOR");
    command.current_dir(folder).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Size of all files below a folder.
fn bytes_below(folder: &Path) -> f64 {
    let size = |entry: std::fs::DirEntry| {
        if entry.path().is_dir() {
            bytes_below(&entry.path())
        } else {
            entry.metadata().unwrap().len() as f64
        }
    };
    std::fs::read_dir(folder).unwrap().map(|entry| size(entry.unwrap())).sum()
}

/// Few cells, and little to be measured: a run of about a second.
fn quick_case() -> String {
    let smoke = sph_hugoniot::template::text("smoke").unwrap();
    smoke.replace("max_fed_cells: 12", "max_fed_cells: 6").replace("Cells(4)", "Cells(2)")
}

/// Where a value is not what its schema says: the words that this program's schemas use, and no others.
fn misfits(schema: &Value, value: &Value, place: &str, list: &mut Vec<String>) {
    let kind = match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(n) if n.is_i64() || n.is_u64() => "integer",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    };
    let fits = |t: &Value| t == kind || (t == "number" && kind == "integer");
    let is_of_kind = match &schema["type"] {
        Value::Array(kinds) => kinds.iter().any(fits),
        Value::Null => true,
        kind => fits(kind),
    };
    if !is_of_kind {
        list.push(format!("{place}: {kind} in place of {}", schema["type"]));
    }
    if schema["enum"].as_array().is_some_and(|words| !words.contains(value)) {
        list.push(format!("{place}: {value} is none of {}", schema["enum"]));
    }
    let names = schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
    list.extend(names.filter(|name| value.get(name).is_none()).map(|name| format!("{place}: no {name}")));
    for (name, inner) in value.as_object().into_iter().flatten() {
        match schema["properties"].get(name) {
            Some(schema) => misfits(schema, inner, &format!("{place}.{name}"), list),
            None if schema["additionalProperties"] == false => {
                list.push(format!("{place}: {name} is not in it"))
            }
            None => {}
        }
    }
    for (k, inner) in value.as_array().into_iter().flatten().enumerate() {
        misfits(&schema["items"], inner, &format!("{place}[{k}]"), list);
    }
}

fn assert_fits(schema: Schema, json: &[u8]) -> Value {
    let schema: Value = serde_json::from_str(schema.text()).unwrap();
    let value: Value = serde_json::from_slice(json).unwrap();
    let mut list = Vec::new();
    misfits(&schema, &value, "", &mut list);
    assert!(list.is_empty(), "{list:#?}\n{value:#}");
    value
}

#[test]
fn a_run_in_an_odd_place_tells_its_end_as_json_that_fits_the_schemas() {
    let folder = tempfile::tempdir().unwrap();
    let home = folder.path().join("home");
    std::fs::create_dir(&home).unwrap();
    let mut permissions = std::fs::metadata(&home).unwrap().permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&home, permissions).unwrap();
    let place = folder.path().join("mit Leerzeichen, ä und 銅");
    std::fs::create_dir(&place).unwrap();
    std::fs::write(place.join("der Fall.ron"), quick_case()).unwrap();
    let out = "Ergebnisse 1";
    let mut command = Command::new(env!("CARGO_BIN_EXE_hugoniot"));
    command.env_clear().env("HOME", &home).env("TERM", "dumb").current_dir(&place);
    let output = command
        .args(["run", "der Fall.ron", "--up", "300", "--out", out, "--json", "--quiet", "--threads", "1"])
        .stdin(std::process::Stdio::null())
        .output()
        .unwrap();
    assert_eq!((output.status.code(), text(&output.stderr).as_str()), (Some(0), ""));
    let run = assert_fits(Schema::Run, &output.stdout);
    assert_eq!((&run["end"], &run["points"][0]["particle_velocity"]), (&"done".into(), &300.0.into()));
    assert_eq!(std::fs::read_dir(&home).unwrap().count(), 0);

    let status = assert_fits(Schema::Status, &hugoniot(&place, &["status", out, "--json"]).stdout);
    assert_eq!(status["state"], "done");
    assert!(
        status["go_on"].as_str().unwrap().contains("'der Fall.ron' --up 300 --out 'Ergebnisse 1' --resume"),
        "{status}"
    );
    let words = text(&hugoniot(&place, &["status", out]).stdout);
    assert!(words.contains("done, 1 of 1 points ended") && words.contains("300"), "{words}");
    assert_fits(Schema::Table, &std::fs::read(place.join(out).join("hugoniot.json")).unwrap());
    let check = assert_fits(Schema::Check, &hugoniot(&place, &["check", "der Fall.ron", "--json"]).stdout);
    let (foreseen, written) = (check["expected_disk_bytes"].as_f64().unwrap(), bytes_below(&place.join(out)));
    // Two points are foreseen; one was run.
    assert!((0.5..1.2).contains(&(written / foreseen)), "{written} bytes on disk, {foreseen} were foreseen");
    let page = std::fs::read_to_string(place.join(out).join("report.html")).unwrap();
    for part in
        ["Can I believe this?", "Shock Hugoniot: smoke", "id=\"up_0300\"", "'der Fall.ron'", "data:image/png"]
    {
        assert!(page.contains(part) || page.contains(&part.replace('\'', "&#39;")), "{part} is missing");
    }
    let verdict = ["All checks of the point hold", "The point needs a look", "The point is bad"];
    assert!(verdict.iter().any(|words| page.contains(words)), "one point is not spoken of as several");
}

#[test]
fn a_schema_that_does_not_fit_is_seen() {
    let schema: Value = serde_json::from_str(Schema::Run.text()).unwrap();
    let value: Value =
        serde_json::from_str(r#"{"format": 2, "end": 3, "more": null, "points": [{"seconds": "x"}]}"#)
            .unwrap();
    let mut list = Vec::new();
    misfits(&schema, &value, "", &mut list);
    for part in [
        ".format: 2 is none of",
        ".end: integer",
        "more is not in it",
        "no folder",
        ".points[0].seconds: string",
    ] {
        assert!(list.iter().any(|line| line.contains(part)), "{part} is missing in {list:#?}");
    }
}

#[test]
fn colors_are_off_when_piped_and_follow_the_option() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bad.ron"), "Case(nam: \"x\")").unwrap();
    let said = |arguments: &[&str]| text(&hugoniot(folder.path(), arguments).stderr);
    assert!(!said(&["check", "bad.ron"]).contains('\u{1b}'));
    assert!(said(&["check", "bad.ron", "--color", "always"]).contains('\u{1b}'));
    assert!(!said(&["check", "bad.ron", "--color", "never"]).contains('\u{1b}'));
    assert_eq!(hugoniot(folder.path(), &["check", "bad.ron", "--color", "pink"]).status.code(), Some(2));
}

#[test]
fn numbers_of_threads_that_cannot_be_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (command, threads) in [("check", "0"), ("run", "0"), ("run", "5000"), ("run", "two")] {
        let output = hugoniot(folder.path(), &[command, "case.ron", "--threads", threads]);
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains("for '--threads <N>'"), "{}", text(&output.stderr));
    }
}

#[test]
fn a_folder_without_a_run_is_told_and_schemas_and_completions_are_text() {
    let folder = tempfile::tempdir().unwrap();
    let output = hugoniot(folder.path(), &["status", "absent"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("absent: no run has written here; hint: "));
    std::fs::create_dir_all(folder.path().join("study/D_2um")).unwrap();
    std::fs::write(folder.path().join("study/D_2um/status.json"), "{}").unwrap();
    let said = text(&hugoniot(folder.path(), &["status", "study"]).stderr);
    assert!(said.contains("hint: the folder of one run, such as study/D_2um"), "{said}");
    for schema in ["check", "run", "status", "table"] {
        let output = hugoniot(folder.path(), &["schema", schema]);
        assert!(serde_json::from_slice::<Value>(&output.stdout).unwrap()["$schema"].is_string());
    }
    assert!(text(&hugoniot(folder.path(), &["completions", "fish"]).stdout).contains("complete -c hugoniot"));
    let output = hugoniot(folder.path(), &["man", "pages for man"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(folder.path().join("pages for man/hugoniot-run.1").exists());
}
