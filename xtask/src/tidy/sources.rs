//! The rules that single files obey.

use super::Fault;
use crate::code::{blank, has_word, test_lines};
use crate::files::Text;

/// Files of more lines are refused.
const TOO_LONG: usize = 600;
/// Files of more lines are told.
const LONG: usize = 400;

/// Folders of single machines: a path into them means nothing elsewhere.
const MACHINE_FOLDERS: [&str; 4] = ["work", "tmp", "root", "home"];

/// Macros that write to the terminal.
const PRINTS: [&str; 7] =
    ["println!", "eprintln!", "print!", "eprint!", "console::print", "console::print_line", "console::note"];

/// Sources that may print, beside `src/bin/`, and why.
const MAY_PRINT: [(&str, &str); 5] = [
    ("crates/sph-hugoniot/src/cli.rs", "what the user asked for, and the faults of a case file"),
    ("crates/sph-hugoniot/src/run.rs", "failed points and the summary at the end of a run"),
    ("crates/sph-validate/src/cli.rs", "the tables and the gates that were missed"),
    ("xtask/src/", "a program"),
    ("crates/sph-hugoniot/src/study/mod.rs", "tells of a study as `run.rs` does of a run"),
];

/// Sources with unsafe code, and why.
const MAY_BE_UNSAFE: [(&str, &str); 16] = [
    ("crates/sph-core/src/lanes/avx2.rs", "instructions of the processor"),
    ("crates/sph-core/src/lanes/avx512.rs", "instructions of the processor"),
    (
        "crates/sph-core/src/lanes/mod.rs",
        "records loaded without bounds checks; kernels compiled for instructions",
    ),
    ("crates/sph-core/src/lanes/plain.rs", "the same interface as the other lanes"),
    ("crates/sph-core/src/lanes/tests.rs", "the same interface"),
    ("crates/sph-core/src/lanes/prefetch.rs", "an instruction of the processor that asks for memory"),
    ("crates/sph-core/src/memory.rs", "advice to the system about pages of memory"),
    ("crates/sph-core/src/tiles.rs", "a dozen columns split into tiles without an allocation"),
    ("crates/sph-riemann/src/pass/contact/mod.rs", "records loaded without bounds checks"),
    ("crates/sph-riemann/src/pass/gradient.rs", "records loaded without bounds checks"),
    ("crates/sph-riemann/src/pass/mod.rs", "records loaded without bounds checks"),
    ("crates/sph-riemann/src/pass/centering.rs", "records loaded without bounds checks"),
    ("crates/sph-riemann/src/pass/closure.rs", "records loaded without bounds checks"),
    ("crates/sph-riemann/src/pass/sums.rs", "sums of pairs added into a tile's buffer without bounds checks"),
    ("crates/sph-riemann/src/update/mod.rs", "the tiles of all columns of a step"),
    ("crates/sph-riemann/tests/allocation.rs", "an allocator that counts"),
];

/// What was found.
#[derive(Debug, Default)]
pub struct Findings {
    /// What is refused.
    pub faults: Vec<Fault>,
    /// What is only told.
    pub notes: Vec<String>,
}

/// Looks at every text.
pub fn check(texts: &[Text]) -> Findings {
    let mut findings = Findings::default();
    for text in texts {
        machine_paths(text, &mut findings.faults);
        if text.is_rust() {
            rust(text, &mut findings);
        }
    }
    stale_exceptions(texts, &mut findings.faults);
    findings
}

fn rust(text: &Text, findings: &mut Findings) {
    let mut refuse = |line: usize, message: &str| {
        findings.faults.push(Fault { path: text.path.clone(), line, message: message.into() });
    };
    if !text.content.starts_with("//!") {
        refuse(1, "no module docs; hint: the first line is `//! What this is for.`");
    }
    for (k, _) in text.content.lines().enumerate().filter(|(_, line)| is_raw_formula(line)) {
        refuse(k + 1, "a formula that rustdoc shows as it is typed; hint: plain letters, as in ρ0 u_s²");
    }
    let code = blank(&text.content);
    if must_be_silent(&text.path) {
        for k in print_lines(&code) {
            refuse(k + 1, "a library prints; hint: return it, or list the file in xtask/src/tidy/sources.rs");
        }
    }
    for (k, line) in code.lines().enumerate() {
        if has_word(line, "dbg!") {
            refuse(k + 1, "dbg! was left behind");
        }
        if line.trim_start().starts_with("#[ignore") {
            refuse(k + 1, "an ignored test; hint: make it quick, or move it to a command");
        }
        if has_word(line, "unsafe") && !listed(&MAY_BE_UNSAFE, &text.path) {
            refuse(k + 1, "unsafe code in a file that is not listed in xtask/src/tidy/sources.rs");
        }
    }
    let lines = text.content.lines().count();
    if lines > TOO_LONG {
        refuse(0, &format!("{lines} lines, more than {TOO_LONG}; hint: two things in one file"));
    } else if lines > LONG {
        findings.notes.push(format!("{}: {lines} lines", text.path));
    }
}

/// Lines, from 0 on, that write to the terminal outside of tests.
fn print_lines(code: &str) -> Vec<usize> {
    let tests = test_lines(code);
    let prints = |line: &str| PRINTS.iter().any(|print| has_word(line, print));
    let lines = code.lines().enumerate().filter(|&(_, line)| prints(line));
    lines.map(|(k, _)| k).filter(|k| tests.iter().all(|test| !test.contains(k))).collect()
}

/// True for a doc comment with marks or commands of TeX.
fn is_raw_formula(line: &str) -> bool {
    let line = line.trim_start();
    let is_doc = line.starts_with("//!") || line.starts_with("///");
    is_doc
        && ["\\(", "\\[", "\\frac", "\\tfrac", "\\sqrt", "\\rho", "$$"].iter().any(|mark| line.contains(mark))
}

/// Libraries: sources below `src/` that are neither programs nor tests.
fn must_be_silent(path: &str) -> bool {
    let test = path.ends_with("/tests.rs") || path.ends_with("_tests.rs");
    path.contains("/src/") && !path.contains("/src/bin/") && !test && !listed(&MAY_PRINT, path)
}

fn listed(list: &[(&str, &str)], path: &str) -> bool {
    list.iter().any(|(listed, _)| path == *listed || (listed.ends_with('/') && path.starts_with(listed)))
}

fn machine_paths(text: &Text, faults: &mut Vec<Fault>) {
    for (k, line) in text.content.lines().enumerate() {
        if let Some(folder) = MACHINE_FOLDERS.iter().find(|folder| names_folder(line, folder)) {
            let message = format!("a path into the folder {folder} of one machine");
            faults.push(Fault { path: text.path.clone(), line: k + 1, message });
        }
    }
}

/// True if an absolute path that starts with the folder stands in the line.
fn names_folder(line: &str, folder: &str) -> bool {
    let pattern = format!("/{folder}/");
    let inside_a_path = |c: char| c.is_alphanumeric() || "_-.~*})/".contains(c);
    line.match_indices(&pattern).any(|(at, _)| !line[..at].ends_with(inside_a_path))
}

/// Exceptions that nobody needs any more must go.
fn stale_exceptions(texts: &[Text], faults: &mut Vec<Fault>) {
    for (path, _) in MAY_BE_UNSAFE {
        let used = texts.iter().any(|t| t.path == path && has_word(&blank(&t.content), "unsafe"));
        if !used {
            let message = "listed as unsafe in xtask/src/tidy/sources.rs, but is not there or not unsafe";
            faults.push(Fault { path: path.into(), line: 0, message: message.into() });
        }
    }
    for exception @ (path, _) in MAY_PRINT {
        let mut below = texts.iter().filter(|t| t.is_rust() && listed(&[exception], &t.path));
        if !below.any(|t| !print_lines(&blank(&t.content)).is_empty()) {
            let message = "may print as xtask/src/tidy/sources.rs has it, but is not there or does not";
            faults.push(Fault { path: path.into(), line: 0, message: message.into() });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults_of(path: &str, content: &str) -> Vec<String> {
        let text = Text { path: path.into(), content: content.into() };
        let mut findings = Findings::default();
        machine_paths(&text, &mut findings.faults);
        if text.is_rust() {
            rust(&text, &mut findings);
        }
        findings.faults.iter().map(|fault| format!("{}: {}", fault.line, fault.message)).collect()
    }

    #[test]
    fn a_good_file_has_no_faults() {
        let good = "//! Sums.\n\n/// Prints nothing: println!(\"unsafe\") in words is fine.\npub fn f() {}\n";
        assert_eq!(faults_of("crates/sph-core/src/x.rs", good), [""; 0]);
    }

    #[test]
    fn every_fault_is_told_with_its_line() {
        let bad = "use x;\nfn f() {\n    println!(\"a\");\n    unsafe { g() }\n}\n\n#[ignore]\nfn t() { dbg!(1); }\n";
        let faults = faults_of("crates/sph-core/src/x.rs", bad);
        assert_eq!(faults.len(), 5, "{faults:?}");
        for (fault, start) in
            faults.iter().zip(["1: no module", "3: a library", "4: unsafe", "7: an ign", "8: dbg"])
        {
            assert!(fault.starts_with(start), "{fault}");
        }
    }

    #[test]
    fn formulas_that_would_not_be_typeset_are_refused() {
        let docs = "//! P = ρ0 c², `c = √(B/ρ)` [m/s].\n";
        assert_eq!(faults_of("crates/a/src/x.rs", docs), [""; 0]);
        for raw in [r"//! \\( \rho_0 \\)", r"//! \[ P = B \]", "//! $$ P = B $$"] {
            assert_eq!(faults_of("crates/a/src/x.rs", raw).len(), 1, "{raw}");
        }
    }

    #[test]
    fn programs_tests_and_examples_may_print() {
        let prints = "//! Prints.\n\nfn main() {\n    println!(\"a\");\n}\n";
        for path in [
            "crates/a/src/bin/a.rs",
            "crates/a/examples/b.rs",
            "crates/a/tests/c.rs",
            "crates/a/src/d_tests.rs",
        ] {
            assert_eq!(faults_of(path, prints), [""; 0], "{path}");
        }
        let tested = "//! Silent.\n\n#[cfg(test)]\nmod tests {\n    fn t() { println!(\"a\"); }\n}\n";
        assert_eq!(faults_of("crates/a/src/x.rs", tested), [""; 0]);
        assert_eq!(faults_of("crates/a/src/x.rs", prints).len(), 1);
    }

    /// What stands behind the tests is looked at like what stands before them.
    #[test]
    fn a_print_behind_the_tests_is_found() {
        for tests in ["mod tests;", "fn t() {\n}", "mod tests {\n    fn t() { println!(); }\n}"] {
            let source = format!("//! Prints.\n\n#[cfg(test)]\n{tests}\nfn f(){{println!()}}\n");
            let faults = faults_of("crates/a/src/x.rs", &source);
            let line = source.lines().count();
            assert!(faults.len() == 1 && faults[0].starts_with(&format!("{line}: a library")), "{faults:?}");
        }
    }

    /// A file that has come to be silent must go from the list, and so must one that prints in its tests alone.
    #[test]
    fn an_exception_that_is_not_used_is_told() {
        let (path, _) = MAY_PRINT[0];
        let is_told = |content: &str| {
            let mut faults = Vec::new();
            stale_exceptions(&[Text { path: path.into(), content: content.into() }], &mut faults);
            faults.iter().any(|fault| fault.path == path)
        };
        assert!(!is_told("//! Prints.\n\nfn f() {\n    println!();\n}\n"));
        assert!(is_told("//! Silent: println!() in words.\n"));
        assert!(is_told("//! Silent.\n\n#[cfg(test)]\nmod tests {\n    fn t() { println!() }\n}\n"));
    }

    #[test]
    fn machine_paths_are_found_and_others_are_not() {
        let folder = MACHINE_FOLDERS[1];
        for bad in [format!("open(\"/{folder}/a\")"), format!("see /{folder}/x.csv")] {
            assert_eq!(faults_of("docs/a.md", &bad).len(), 1, "{bad}");
        }
        for good in [format!("target/{folder}/a"), format!("https://x.org/{folder}/a"), "/usr/bin/env".into()]
        {
            assert_eq!(faults_of("docs/a.md", &good), [""; 0], "{good}");
        }
    }

    #[test]
    fn long_files_are_told_and_very_long_ones_refused() {
        let of_lines = |n: usize| Text { path: "crates/a/src/x.rs".into(), content: "//! x\n".repeat(n) };
        let mut findings = Findings::default();
        rust(&of_lines(LONG), &mut findings);
        assert!(findings.notes.is_empty() && findings.faults.is_empty());
        rust(&of_lines(LONG + 1), &mut findings);
        assert!(findings.notes.len() == 1 && findings.faults.is_empty());
        rust(&of_lines(TOO_LONG + 1), &mut findings);
        assert_eq!(findings.faults.len(), 1);
    }
}
