//! The documentation of the Rust sources: rustdoc with warnings denied, of private items too, and links that lead nowhere.
//!
//! rustdoc takes units in brackets, [m/s], for links. The lint on broken links is off in the workspace therefore, and
//! forced here: what it says of a unit is left out, what it says of a link is a fault. A link has its name in backticks, or
//! says where it leads. A name in brackets without backticks cannot be told from a unit, and is not checked.

use std::path::Path;
use std::process::{Command, ExitCode, Stdio};

use anyhow::Context;
use serde_json::Value;

use crate::process;

/// The lint on links that lead nowhere.
const BROKEN: &str = "rustdoc::broken_intra_doc_links";
/// What rustdoc says where it has the line of a comment, but not the place of the link in the source.
const IN_LINE: &str = "the link appears in this line:\n\n";

/// Builds the public documentation, which stays in `target/doc`; what may not be in it is told.
pub fn build() -> anyhow::Result<ExitCode> {
    process::run(&mut rustdoc("-D warnings"))
}

/// Builds the documentation of all items, beside the public one, and tells the links that lead nowhere: how many, and whether
/// all was built.
pub fn check_links() -> anyhow::Result<(usize, ExitCode)> {
    let metadata = process::metadata(&["--no-deps", "--offline"])?;
    let target = metadata["target_directory"].as_str().context("cargo names no target folder")?;
    let built = metadata["build_directory"].as_str().unwrap_or(target);
    let mut command = rustdoc(&format!("-D warnings --force-warn {BROKEN}"));
    // Only the pages go to a folder of their own; what is built on the way is shared.
    command.arg("--target-dir").arg(Path::new(target).join("private")).env("CARGO_BUILD_BUILD_DIR", built);
    command.args(["--document-private-items", "--message-format", "json"]).stderr(Stdio::inherit());
    let output = command.output().context("cannot start cargo doc")?;
    let told = told(&String::from_utf8_lossy(&output.stdout));
    told.iter().for_each(|message| eprintln!("{}", message["rendered"].as_str().unwrap_or_default()));
    let built = if output.status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    Ok((told.iter().filter(|message| is_broken(message)).count(), built))
}

fn rustdoc(flags: &str) -> Command {
    let mut command = process::cargo();
    let given = std::env::var("RUSTDOCFLAGS").unwrap_or_default();
    command.env("RUSTDOCFLAGS", format!("{given} {flags}").trim());
    command.args(["doc", "--workspace", "--no-deps", "--manifest-path"]);
    command.arg(process::root().join("Cargo.toml"));
    command
}

/// What the compiler says, but for units that it takes for links.
fn told(messages: &str) -> Vec<Value> {
    let messages = messages.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let of_compiler = messages.filter(|message| message["reason"] == "compiler-message");
    of_compiler.map(|message| message["message"].clone()).filter(|message| !is_unit(message)).collect()
}

fn is_broken(message: &Value) -> bool {
    message["code"]["code"] == BROKEN
}

/// True for a broken link that is a unit: its bracket stands right before the name.
fn is_unit(message: &Value) -> bool {
    is_broken(message) && before_link(message).is_some_and(|before| before.ends_with('['))
}

/// What stands in its line before the name of the link.
fn before_link(message: &Value) -> Option<String> {
    let notes = message["children"].as_array()?.iter().filter_map(|note| note["message"].as_str());
    let (line, length) = match notes.filter_map(|note| note.strip_prefix(IN_LINE)).next() {
        Some(note) => {
            let (line, marks) = note.split_once('\n')?;
            (line, marks.chars().take_while(|c| *c == ' ').count())
        }
        None => {
            let text = &message["spans"][0]["text"][0];
            let start = usize::try_from(text["highlight_start"].as_u64()?).ok()?;
            (text["text"].as_str()?, start.checked_sub(1)?)
        }
    };
    Some(line.chars().take(length).collect())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// What rustdoc says of the name that stands in a line of a comment.
    fn broken(line: &str, name: &str) -> String {
        let start = line[..line.find(name).unwrap()].chars().count() + 1;
        let text = json!({ "text": line, "highlight_start": start, "highlight_end": start + name.len() });
        said(
            json!({ "code": { "code": BROKEN }, "spans": [{ "text": [text] }], "children": [], "rendered": name }),
        )
    }

    fn said(message: Value) -> String {
        json!({ "reason": "compiler-message", "message": message }).to_string()
    }

    #[test]
    fn units_are_no_links_and_links_that_lead_nowhere_are_told() {
        let of_comment = |line: &str, marks: &str| {
            let note = json!({ "message": format!("{IN_LINE}{line}\n{marks}") });
            let text = json!({ "text": "    /// Twice.", "highlight_start": 5, "highlight_end": 15 });
            said(
                json!({ "code": { "code": BROKEN }, "spans": [{ "text": [text] }], "children": [note], "rendered": line }),
            )
        };
        let other = json!({ "code": { "code": "rustdoc::bare_urls" }, "spans": [], "children": [], "rendered": "a URL" });
        let messages = [
            broken("/// Velocity [m/s].", "m/s"),
            broken("/// Density ρ0 [kg/m³], as [`Part::density`].", "kg/m³"),
            broken("/// Density ρ0 [kg/m³], as [`Part::density`].", "Part::density"),
            broken("/// See [the part](Part::speed).", "Part::speed"),
            of_comment("Times [s].", "       ^"),
            of_comment("Of [`Times`].", "     ^^^^^"),
            said(other),
            json!({ "reason": "compiler-artifact" }).to_string(),
            "no JSON".to_owned(),
        ];
        let told = told(&messages.join("\n"));
        let expected =
            [("Part::density", true), ("Part::speed", true), ("Of [`Times`].", true), ("a URL", false)];
        let found = told.iter().map(|message| (message["rendered"].as_str().unwrap(), is_broken(message)));
        assert_eq!(found.collect::<Vec<_>>(), expected);
    }
}
