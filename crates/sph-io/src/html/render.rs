//! A page's parts as HTML.

use super::text::{escaped, marked};
use super::{Block, Check, Page, Picture, Section, TableView, Verdict};
use crate::table::{Column, Values, cell};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::fmt::Write;

const STYLE: &str = include_str!("style.css");

pub(super) fn page(page: &Page) -> Result<String, String> {
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{}</title>\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n<header>\n<h1>{}</h1>\n",
        escaped(&page.title),
        marked(&page.title)
    );
    if !page.lead.is_empty() {
        out += &format!("<p class=\"lead\">{}</p>\n", marked(&page.lead));
    }
    if let Some((verdict, words)) = &page.verdict {
        let (class, badge, words) = (class(*verdict), badge(*verdict, ""), marked(words));
        out += &format!("<p class=\"answer {class}\">{badge} {words}</p>\n");
    }
    out += &facts(&page.facts);
    out += &contents(&page.sections);
    out += "</header>\n<main>\n";
    for part in &page.sections {
        section(&mut out, part, 2)?;
    }
    out += "</main>\n";
    if !page.footer.is_empty() {
        out += &format!("<footer>{}</footer>\n", marked(&page.footer));
    }
    Ok(out + "</body>\n</html>\n")
}

fn contents(sections: &[Section]) -> String {
    if sections.len() < 3 {
        return String::new();
    }
    let item = |s: &Section| format!("<a href=\"#{}\">{}</a>", escaped(&s.anchor()), marked(&s.heading));
    format!("<nav>{}</nav>\n", sections.iter().map(item).collect::<Vec<_>>().join("\n"))
}

fn section(out: &mut String, part: &Section, level: usize) -> Result<(), String> {
    let level = level.min(5);
    let badge = part.verdict.as_ref().map_or(String::new(), |(verdict, words)| badge(*verdict, words));
    let heading = format!("<h{level}>{} {badge}</h{level}>", marked(&part.heading));
    let anchor = escaped(&part.anchor());
    if part.is_folded {
        *out += &format!("<details class=\"section\" id=\"{anchor}\">\n<summary>{heading}</summary>\n");
    } else {
        *out += &format!("<section id=\"{anchor}\">\n{heading}\n");
    }
    blocks(out, &part.blocks, level)?;
    *out += if part.is_folded { "</details>\n" } else { "</section>\n" };
    Ok(())
}

fn blocks(out: &mut String, blocks: &[Block], level: usize) -> Result<(), String> {
    let mut rest = blocks;
    while let Some((first, others)) = rest.split_first() {
        rest = others;
        match first {
            Block::Text(text) => *out += &format!("<p>{}</p>\n", marked(text)),
            Block::List(items) => {
                let items: String = items.iter().map(|item| format!("<li>{}</li>\n", marked(item))).collect();
                *out += &format!("<ul>\n{items}</ul>\n");
            }
            Block::Facts(names) => *out += &facts(names),
            Block::Checks(checks) => *out += &checks.iter().map(check).collect::<String>(),
            Block::Table(view) => *out += &table(view)?,
            Block::Code(code) => *out += &format!("<pre><code>{}</code></pre>\n", escaped(code)),
            Block::Section(part) => section(out, part, level + 1)?,
            Block::Strip(pictures) => {
                *out += "<div class=\"strip\">\n";
                pictures.iter().try_for_each(|(p, caption)| picture(out, p, caption))?;
                *out += "</div>\n";
            }
            Block::Picture(..) => {
                let more = rest.iter().take_while(|block| matches!(block, Block::Picture(..))).count();
                *out += "<div class=\"pictures\">\n";
                for block in std::iter::once(first).chain(&rest[..more]) {
                    if let Block::Picture(p, caption) = block {
                        picture(out, p, caption)?;
                    }
                }
                *out += "</div>\n";
                rest = &rest[more..];
            }
        }
    }
    Ok(())
}

fn facts(facts: &[(String, String)]) -> String {
    if facts.is_empty() {
        return String::new();
    }
    let rows = facts.iter().map(|(name, text)| {
        format!("<div><dt>{}</dt><dd>{}</dd></div>\n", marked(name), marked(text).replace('\n', "<br>"))
    });
    format!("<dl>\n{}</dl>\n", rows.collect::<String>())
}

fn check(check: &Check) -> String {
    format!(
        "<div class=\"check {}\">{}<div><strong>{}</strong> <span class=\"value\">{}</span><p>{}</p></div></div>\n",
        class(check.verdict),
        badge(check.verdict, ""),
        marked(&check.name),
        marked(&check.value),
        marked(&check.meaning)
    )
}

const fn class(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Unknown => "unknown",
        Verdict::Good => "good",
        Verdict::Caution => "caution",
        Verdict::Bad => "wrong",
    }
}

/// A colored word with a sign, so that color is not all that tells.
fn badge(verdict: Verdict, words: &str) -> String {
    let words = if words.is_empty() { verdict.word() } else { words };
    let sign = match verdict {
        Verdict::Unknown => "–",
        Verdict::Good => "✓",
        Verdict::Caution => "!",
        Verdict::Bad => "✗",
    };
    format!(
        "<span class=\"badge {}\"><b aria-hidden=\"true\">{sign}</b> {}</span>",
        class(verdict),
        marked(words)
    )
}

fn table(view: &TableView) -> Result<String, String> {
    let table = &view.table;
    let n_rows = table.n_rows();
    if let Some(short) = table.columns.iter().find(|c| c.values.len() != n_rows) {
        return Err(format!("column `{}` has {} rows, another has {n_rows}", short.name, short.values.len()));
    }
    let head: String = table.columns.iter().map(heading).collect();
    let mut out = String::from("<div class=\"scroll\"><table>\n");
    if !table.title.is_empty() {
        _ = writeln!(out, "<caption>{}</caption>", marked(&table.title));
    }
    _ = writeln!(out, "<thead><tr>{head}</tr></thead>\n<tbody>");
    for row in 0..n_rows {
        let cells: String = table.columns.iter().map(|column| data(view, column, row)).collect();
        _ = writeln!(out, "<tr>{cells}</tr>");
    }
    out += "</tbody></table></div>\n";
    Ok(out + &descriptions(&table.columns))
}

fn heading(column: &Column) -> String {
    let unit = if column.unit.is_empty() {
        String::new()
    } else {
        format!(" <small>{}</small>", marked(&column.unit))
    };
    let (class, title) = (alignment(column), escaped(&column.description));
    format!("<th scope=\"col\"{class} title=\"{title}\">{}{unit}</th>", marked(&column.name))
}

fn data(view: &TableView, column: &Column, row: usize) -> String {
    let mut text = marked(&cell(&column.values, row));
    if let Some(target) = view.link(&column.name, row) {
        text = format!("<a href=\"{}\">{text}</a>", escaped(target));
    }
    if let Some(verdict) = view.verdict(&column.name, row).filter(|_| !text.is_empty()) {
        text = format!("<span class=\"mark {}\">{text}</span>", class(verdict));
    }
    format!("<td{}>{text}</td>", alignment(column))
}

const fn alignment(column: &Column) -> &'static str {
    if matches!(column.values, Values::Text(_)) { " class=\"words\"" } else { "" }
}

fn descriptions(columns: &[Column]) -> String {
    let lines: Vec<(String, String)> = columns
        .iter()
        .filter(|c| !c.description.is_empty())
        .map(|c| (c.name.clone(), c.description.clone()))
        .collect();
    if lines.is_empty() {
        return String::new();
    }
    format!(
        "<details class=\"columns\"><summary>What the columns are</summary>\n{}</details>\n",
        facts(&lines)
    )
}

fn picture(out: &mut String, picture: &Picture, caption: &str) -> Result<(), String> {
    let (kind, source) = match picture {
        Picture::Plot(figure) => ("plot", svg_source(&figure.to_svg()?)),
        Picture::Svg(text) => ("plot", svg_source(text)),
        Picture::Fields(image) => ("fields", png_source(&image.to_small_png()?)),
        Picture::Png(bytes) => ("fields", png_source(bytes)),
    };
    // The hidden box keeps whether the picture is grown: no script needed.
    _ = writeln!(
        out,
        "<figure class=\"{kind}\"><label><input type=\"checkbox\" aria-label=\"grow the picture\">\
         <span class=\"scroll\"><img src=\"{source}\" alt=\"{}\"></span></label>\
         <figcaption>{}</figcaption></figure>",
        escaped(caption),
        marked(caption)
    );
    Ok(())
}

fn svg_source(text: &str) -> String {
    format!("data:image/svg+xml;base64,{}", STANDARD.encode(text))
}

fn png_source(bytes: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(bytes))
}
