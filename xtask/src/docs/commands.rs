//! Commands and code blocks of Markdown files: what a page tells to type must exist.
//!
//! Tasks of this program are read as they would be at the prompt; packages, tests, benches and examples that cargo is to run
//! must be there. The commands of `hugoniot` and `sph-validate` are read by their own tests, `tests/guide.rs` of each; blocks of
//! Rust run as doc tests of the crate, or stand line by line in an example.

use std::collections::BTreeSet;
use std::path::Path;

use clap::Parser;

use crate::files::Text;
use crate::tidy::Fault;

/// Faults of all commands and code blocks; `exists` tells whether a path relative to the root is there.
pub fn check(texts: &[Text], exists: impl Fn(&str) -> bool) -> Vec<Fault> {
    let mut faults = Vec::new();
    for page in texts.iter().filter(|text| text.path.ends_with(".md")) {
        for (line, command) in commands(&page.content) {
            if let Err(message) = is_good(&command, &exists) {
                faults.push(Fault { path: page.path.clone(), line, message });
            }
        }
        if page.content.contains("\n```rust") && !is_tested(page, texts) {
            let message =
                "Rust code that no doc test compiles; hint: take it line by line from an example".into();
            faults.push(Fault { path: page.path.clone(), line: 0, message });
        }
    }
    faults
}

/// True if the page is the README of a crate whose library takes it in as a doc test, or if each line of its Rust code
/// stands in an example.
fn is_tested(page: &Text, texts: &[Text]) -> bool {
    let library = Path::new(&page.path).with_file_name("src").join("lib.rs");
    let library = library.to_string_lossy().replace('\\', "/");
    let takes_it_in = |text: &Text| text.content.contains("include_str!(\"../README.md\")");
    if page.path.ends_with("README.md") {
        return texts.iter().any(|text| text.path == library && takes_it_in(text));
    }
    let examples = texts.iter().filter(|text| text.path.contains("/examples/"));
    let lines: BTreeSet<&str> = examples.flat_map(|text| text.content.lines()).map(str::trim).collect();
    rust_lines(&page.content).all(|line| lines.contains(line))
}

/// Lines of Rust code of a page.
fn rust_lines(page: &str) -> impl Iterator<Item = &str> {
    let blocks = page.split("\n```rust").skip(1).filter_map(|rest| rest.split("\n```").next());
    blocks.flat_map(|block| block.lines().skip(1)).map(str::trim).filter(|line| !line.is_empty())
}

/// What a page tells to type, with the line: `cargo …` at the beginning of a line of code, or alone between backticks.
fn commands(page: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut in_code = false;
    for (k, line) in page.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        } else if in_code {
            let typed = line.trim().trim_start_matches("$ ");
            found.extend(typed.starts_with("cargo ").then(|| (k + 1, command_of(typed))));
        } else {
            let spans = line.split('`').skip(1).step_by(2).filter(|span| span.starts_with("cargo "));
            found.extend(spans.map(|span| (k + 1, command_of(span))));
        }
    }
    found
}

/// A line without its remark; of `[options]` and of a|choice what would be typed first.
fn command_of(line: &str) -> String {
    let end = [" #", "  ", " > "].iter().filter_map(|mark| line.find(mark)).min().unwrap_or(line.len());
    let words = line[..end].split_whitespace().filter(|word| *word != "…");
    let first = |word: &str| word.replace(['[', ']'], "").split('|').next().unwrap_or_default().to_owned();
    words.map(first).collect::<Vec<_>>().join(" ")
}

/// What is wrong with a command.
fn is_good(command: &str, exists: impl Fn(&str) -> bool) -> Result<(), String> {
    let words: Vec<&str> = command.split_whitespace().skip(1).collect();
    let (Some(first), rest) = (words.first(), &words[1.min(words.len())..]) else { return Ok(()) };
    if *first == "xtask" {
        let typed = std::iter::once("cargo xtask").chain(rest.iter().copied());
        return match crate::Arguments::try_parse_from(typed) {
            Err(error) if error.use_stderr() && !rest.is_empty() => {
                Err(format!("`{command}`: {}", error.to_string().lines().next().unwrap_or_default()))
            }
            _ => Ok(()),
        };
    }
    let after = |names: [&str; 2]| {
        words.iter().position(|word| names.contains(word)).and_then(|k| words.get(k + 1)).copied()
    };
    let Some(package) = after(["-p", "--package"]) else { return Ok(()) };
    if !exists(&format!("crates/{package}/Cargo.toml")) && package != "xtask" {
        return Err(format!("`{command}`: there is no package {package}"));
    }
    for (option, folder) in [("--example", "examples"), ("--test", "tests"), ("--bench", "benches")] {
        if let Some(name) = after([option, option]) {
            let paths = [format!("{name}.rs"), format!("{name}/main.rs")];
            if !paths.iter().any(|path| exists(&format!("crates/{package}/{folder}/{path}"))) {
                return Err(format!("`{command}`: {package} has no {name} in {folder}"));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(content: &str) -> Text {
        Text { path: "docs/src/a.md".into(), content: content.into() }
    }

    #[test]
    fn the_commands_of_all_pages_exist() {
        let root = crate::process::root();
        let texts = crate::files::texts(&root).unwrap();
        let count: usize =
            texts.iter().filter(|t| t.path.ends_with(".md")).map(|t| commands(&t.content).len()).sum();
        assert!(count > 40, "only {count} commands were found");
        let faults: Vec<String> =
            check(&texts, |path| root.join(path).exists()).iter().map(ToString::to_string).collect();
        assert!(faults.is_empty(), "{}", faults.join("\n"));
    }

    #[test]
    fn what_does_not_exist_is_told() {
        let exists = |path: &str| ["crates/a/Cargo.toml", "crates/a/examples/b.rs"].contains(&path);
        let of = |content: &str| check(&[page(content)], exists).len();
        assert_eq!(of("Type `cargo xtask tidy`, or\n```sh\ncargo xtask soak --kills 3   # long\n```\n"), 0);
        assert_eq!(of("Type `cargo xtask tidyness`."), 1);
        assert_eq!(of("```text\ncargo xtask soak [--kills many|few]   many\n```\n"), 1);
        assert_eq!(of("`cargo run -p a --example b -- x`"), 0);
        assert_eq!(of("`cargo run -p a --example c` and `cargo test -p c`"), 2);
        assert_eq!(of("\n```rust\nlet a = 1;\n```\n"), 1);
    }
}
