//! Links of Markdown files: every relative one must lead somewhere.
//!
//! A link to a heading must name one that is there, in the spelling that forges and mdbook give headings. Chapters of
//! the guide may link to each other only, since a book takes nothing else along, and every chapter must be in its table
//! of contents. Links to the network are not followed. Files of the repository that are named as `code` must be there too.

use std::collections::BTreeSet;

use crate::files::Text;
use crate::tidy::Fault;

/// Folder of the guide's chapters.
const GUIDE: &str = "docs/src/";

/// What a `code` starts with that names a file of the repository.
const NAMES_A_FILE: [&str; 5] = ["crates/", "xtask/", "cases/", "validation/", "docs/"];

/// A link as it is written.
#[derive(Debug, PartialEq, Eq)]
struct Link {
    line: usize,
    target: String,
}

/// Faults of all links; `exists` tells whether a path relative to the root is there.
pub fn check(texts: &[Text], exists: impl Fn(&str) -> bool) -> Vec<Fault> {
    let pages: Vec<&Text> = texts.iter().filter(|text| text.path.ends_with(".md")).collect();
    let mut faults = Vec::new();
    for page in &pages {
        for link in links(&page.content) {
            if let Some(message) = fault_of(page, &link.target, &pages, &exists) {
                faults.push(Fault { path: page.path.clone(), line: link.line, message });
            }
        }
        for name in named_files(&page.content).filter(|name| !exists(&name.target)) {
            let message = format!("{} is not there", name.target);
            faults.push(Fault { path: page.path.clone(), line: name.line, message });
        }
    }
    faults.extend(lost_chapters(&pages));
    faults
}

fn fault_of(page: &Text, target: &str, pages: &[&Text], exists: impl Fn(&str) -> bool) -> Option<String> {
    if target.contains("://") || target.starts_with("mailto:") {
        return None;
    }
    let (file, heading) = target.split_once('#').unwrap_or((target, ""));
    let path = if file.is_empty() { Some(page.path.clone()) } else { resolve(&page.path, file) };
    let Some(path) = path else { return Some(format!("{target} leads out of the repository")) };
    if !exists(&path) {
        return Some(format!("{target} leads nowhere"));
    }
    if page.path.starts_with(GUIDE) && !path.starts_with(GUIDE) {
        return Some(format!("{target} leads out of the guide; hint: name the file as code"));
    }
    let known = pages.iter().find(|other| other.path == path).map(|other| headings(&other.content));
    match known {
        Some(known) if !heading.is_empty() && !known.contains(heading) => {
            Some(format!("{target}: there is no such heading"))
        }
        _ => None,
    }
}

/// The path that a relative one means, seen from a page; `None` above the root.
fn resolve(page: &str, target: &str) -> Option<String> {
    let mut parts: Vec<&str> = page.split('/').collect();
    parts.pop();
    for part in target.trim_end_matches('/').split('/') {
        match part {
            "." => {}
            ".." => _ = parts.pop()?,
            part => parts.push(part),
        }
    }
    Some(parts.join("/"))
}

/// All inline links, pictures and reference definitions outside of code.
fn links(content: &str) -> Vec<Link> {
    let mut links = Vec::new();
    for (line, text) in prose(content) {
        let text = without_code(text);
        let mut rest = text.as_str();
        while let Some(at) = rest.find("](") {
            rest = &rest[at + 2..];
            let Some(end) = rest.find(')') else { break };
            let target = rest[..end].split_whitespace().next().unwrap_or_default();
            links.push(Link { line, target: target.to_owned() });
            rest = &rest[end..];
        }
        let definition = text.trim_start().strip_prefix('[').and_then(|rest| rest.split_once("]: "));
        if let Some((name, target)) = definition
            && !name.contains(['[', ']'])
        {
            links.push(Link { line, target: target.trim().to_owned() });
        }
    }
    links
}

/// Files that are named as `code`, without those that stand for many.
fn named_files(content: &str) -> impl Iterator<Item = Link> {
    prose(content).flat_map(|(line, text)| {
        let codes = text.split('`').skip(1).step_by(2);
        let files = codes.filter(|code| NAMES_A_FILE.iter().any(|start| code.starts_with(start)));
        let single = files.filter(|file| !file.contains(['*', '<', '{', '…', ' ']) && !file.contains("your"));
        single
            .map(move |file| Link { line, target: file.trim_end_matches('/').to_owned() })
            .collect::<Vec<_>>()
    })
}

/// Lines with their numbers, without those of fenced code.
fn prose(content: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut fence: Option<&str> = None;
    content.lines().enumerate().filter_map(move |(k, line)| {
        let start = line.trim_start();
        match fence {
            Some(mark) => {
                if start.starts_with(mark) {
                    fence = None;
                }
                None
            }
            None => match ["```", "~~~"].into_iter().find(|mark| start.starts_with(mark)) {
                Some(mark) => {
                    fence = Some(mark);
                    None
                }
                None => Some((k + 1, line)),
            },
        }
    })
}

/// The line without its `code`.
fn without_code(line: &str) -> String {
    line.split('`').step_by(2).collect::<Vec<_>>().join("`")
}

/// Headings as links spell them: lower case, blanks as hyphens, nothing but letters, digits, hyphens, underscores; a
/// number behind repeated ones.
fn headings(content: &str) -> BTreeSet<String> {
    let mut known = BTreeSet::new();
    let is_heading = |line: &&str| line.starts_with('#') && line.trim_start_matches('#').starts_with(' ');
    for line in prose(content).map(|(_, line)| line).filter(is_heading) {
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let kept = title.chars().filter(|&c| c.is_alphanumeric() || "-_ ".contains(c));
        let name: String = kept.map(|c| if c == ' ' { '-' } else { c }).collect();
        let numbered = (1..).map(|n| format!("{name}-{n}"));
        let free = std::iter::once(name.clone()).chain(numbered).find(|name| !known.contains(name));
        known.extend(free);
    }
    known
}

/// Chapters that the table of contents does not name.
fn lost_chapters(pages: &[&Text]) -> Vec<Fault> {
    let contents = format!("{GUIDE}SUMMARY.md");
    let Some(summary) = pages.iter().find(|page| page.path == contents) else { return Vec::new() };
    let named: BTreeSet<String> =
        links(&summary.content).iter().filter_map(|link| resolve(&contents, &link.target)).collect();
    let chapters = pages.iter().filter(|page| page.path.starts_with(GUIDE) && page.path != contents);
    let lost = chapters.filter(|page| !named.contains(&page.path));
    lost.map(|page| Fault {
        path: page.path.clone(),
        line: 0,
        message: "the chapter is not in SUMMARY.md".into(),
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(path: &str, content: &str) -> Text {
        Text { path: path.into(), content: content.into() }
    }

    fn faults(pages: &[Text]) -> Vec<String> {
        let exists =
            |path: &str| pages.iter().any(|p| p.path == path) || path == "a/picture.png" || path == "a";
        check(pages, exists).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn good_links_are_good() {
        let text = "# One two\n[b](b.md) ![p](a/picture.png \"title\") [x](https://x.org) [self](#one-two)\n\
                    [folder](a/)\n\n[d]: a/c.md#über-alles\n`[no](link)`\n```text\n[no](link)\n```\n";
        let pages = [page("r.md", text), page("b.md", ""), page("a/c.md", "## Über alles!\n[up](../b.md)")];
        assert_eq!(faults(&pages), [""; 0]);
    }

    #[test]
    fn every_bad_link_is_told_with_its_line() {
        let text = "# T\n[a](none.md)\n[b](../out.md) and [c](#none)\n\n[d]: gone.md\n";
        let told = faults(&[page("r.md", text)]);
        assert_eq!(
            told,
            [
                "r.md:2: none.md leads nowhere",
                "r.md:3: ../out.md leads out of the repository",
                "r.md:3: #none: there is no such heading",
                "r.md:5: gone.md leads nowhere",
            ]
        );
    }

    #[test]
    fn files_named_as_code_must_be_there() {
        let text = "`crates/a.rs` `crates/gone.rs` `crates/*/x` `cargo run`\n```sh\n`crates/no`\n```\n";
        let pages = [page("r.md", text), page("crates/a.rs", "")];
        assert_eq!(faults(&pages), ["r.md:1: crates/gone.rs is not there"]);
    }

    #[test]
    fn the_guide_keeps_to_itself_and_is_complete() {
        let pages = [
            page("docs/src/SUMMARY.md", "[One](one.md)"),
            page("docs/src/one.md", "[out](../../r.md)"),
            page("docs/src/two.md", ""),
            page("r.md", "[in](docs/src/one.md)"),
        ];
        let told = faults(&pages);
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told[0].starts_with("docs/src/one.md:1: ../../r.md leads out of the guide"));
        assert!(told[1].starts_with("docs/src/two.md: the chapter is not in"));
    }

    #[test]
    fn repeated_headings_are_numbered() {
        let known = headings("# A b\n## A b\n```sh\n# not one\n```\n#no\n### `K` and L⁻¹\n");
        assert_eq!(known.into_iter().collect::<Vec<_>>(), ["a-b", "a-b-1", "k-and-l¹"]);
    }
}
