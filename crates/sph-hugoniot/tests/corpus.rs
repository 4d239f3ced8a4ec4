//! Case files that must be accepted, and case files that must be refused with the announced faults.

use std::path::{Path, PathBuf};

use sph_hugoniot::config;

fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases").join(folder);
    let mut list: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    list.retain(|path| path.extension().is_some_and(|e| e == "ron"));
    list.sort();
    assert!(list.len() >= 3);
    list
}

#[test]
fn good_cases_are_accepted() {
    for path in files("good") {
        config::load(&path).unwrap_or_else(|error| panic!("{error}"));
    }
}

/// Announced faults: (line, text).
fn announced(text: &str) -> Vec<(usize, String)> {
    let mut code_line = 0;
    let mut list = Vec::new();
    for (number, line) in text.lines().enumerate() {
        match line.trim().strip_prefix("//^ ") {
            Some(expected) => list.push((code_line, expected.trim().to_string())),
            None => code_line = number + 1,
        }
    }
    list
}

#[test]
fn bad_cases_are_refused_with_every_announced_fault_and_no_other() {
    for path in files("bad") {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let error = config::load(&path).expect_err(&name);
        let mut found: Vec<(usize, String)> = error
            .faults
            .iter()
            .map(|f| {
                (
                    error.line_and_column(f.span.start).0,
                    format!("{} {}", f.message, f.hint.as_deref().unwrap_or("")),
                )
            })
            .collect();
        for (line, text) in announced(&error.text) {
            let at = found.iter().position(|(l, t)| *l == line && t.contains(&text));
            found.remove(
                at.unwrap_or_else(|| {
                    panic!("{name}:{line}: no fault says {text:?}\n{}", error.render(false))
                }),
            );
        }
        assert!(found.is_empty(), "{name}: faults that are not announced: {found:#?}");
    }
}

/// A list that is too long is refused; none of it is left out in silence.
#[test]
fn lists_that_are_too_long_are_refused() {
    let medium = |list: &str| {
        format!(
            "Case(name: \"long\", material: Library(name: \"porous-copper\"), \
             medium: (cell: \"20 um\", {list}, particle_size: \"1 um\"), points: [\"100 m/s\"])"
        )
    };
    let layers = "(thickness: \"0.01 um\", of: Void), ".repeat(2001);
    let sets = "(of: Void), ".repeat(2001);
    for (list, told) in [
        (format!("layers: [{layers}]"), "2001 layers are listed"),
        (format!("inclusions: [{sets}]"), "2001 sets of inclusions are listed"),
    ] {
        let error = config::parse(&medium(&list), "long.ron").expect_err(told);
        assert!(
            error.faults.iter().any(|fault| fault.message == told),
            "{told}: {}",
            error.faults[0].message
        );
    }
}
