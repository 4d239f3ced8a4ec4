//! `summary.md`: the tables of a validation for readers, figures over resolutions.

use std::fmt::Write as _;

use crate::case::SchemeName;
use crate::gate::Significant;
use crate::plots::Written;
use crate::report::{Report, Row, SuiteRecord};

/// The whole document. Plots are taken to lie beside it.
pub fn summary(report: &Report, pictures: &[Written]) -> String {
    let mut text = String::from("# Validation\n\n");
    let _ = writeln!(text, "Made by `{}` ({} tier).", report.provenance.command, report.tier.as_str());
    let _ = writeln!(text, "{}.\n", report.tally());
    text.push_str(concat!(
        "A figure in bold missed its gate: it must not be farther from the reference than the published figure of ",
        "the same run (half a unit of its last printed digit allowed), nor than what this program has reached before ",
        "(a twentieth allowed). Order: of the whole row, by least squares in ln n. Set-ups, references and gates: ",
        "`validation/<suite>/`.\n\n",
    ));
    for suite in &report.suites {
        push_suite(&mut text, report, suite);
        for picture in pictures.iter().filter(|picture| picture.suite == suite.name) {
            let _ = writeln!(text, "![{}]({})\n", picture.caption, picture.file);
        }
    }
    push_failures(&mut text, report);
    push_costs(&mut text, report);
    text
}

fn push_suite(text: &mut String, report: &Report, suite: &SuiteRecord) {
    let rows: Vec<&Row> = report.rows.iter().filter(|row| row.suite == suite.name).collect();
    let mut resolutions: Vec<u32> = rows.iter().filter_map(|row| row.n).collect();
    resolutions.sort_unstable();
    resolutions.dedup();
    let _ = writeln!(
        text,
        "## {}\n\nn: {}. Reference: {}.",
        suite.title,
        suite.resolution,
        suite.reference.title()
    );
    if !suite.source.is_empty() {
        let _ = writeln!(text, "Source of the gates: {}.", suite.source);
    }
    let heads: Vec<String> = resolutions.iter().map(|n| format!(" n = {n} |")).collect();
    let _ = writeln!(text, "\n| scheme | figure | reference |{} order |", heads.concat());
    let _ = writeln!(text, "|---|---|---|{}---|", "---|".repeat(resolutions.len()));
    let mut seen: Vec<(&str, SchemeName, &str)> = Vec::new();
    for row in rows.iter().filter(|row| row.n.is_some()) {
        let line = (row.variant.as_str(), row.scheme, row.metric.as_str());
        if !seen.contains(&line) {
            seen.push(line);
            push_line(text, &rows, row, &resolutions);
        }
    }
    text.push('\n');
    push_known(text, &rows);
}

/// The known misses of a suite, one line a cause; then those that pass.
fn push_known(text: &mut String, rows: &[&Row]) {
    let mut causes: Vec<&str> = Vec::new();
    for cause in rows.iter().filter_map(|row| row.known_miss.as_deref()) {
        if !causes.contains(&cause) {
            causes.push(cause);
        }
    }
    if !causes.is_empty() {
        let lines: Vec<String> = causes.iter().map(|cause| format!("- {cause}\n")).collect();
        let _ = writeln!(text, "Known misses:\n\n{}", lines.concat());
    }
    let line = |row: &Row| {
        let variant = if row.variant.is_empty() { String::new() } else { format!("{}, ", row.variant) };
        let n = row.n.map_or(String::new(), |n| format!(", n = {n}"));
        format!("- {variant}{}, {}{n}\n", row.scheme.title(), row.metric.replace('_', " "))
    };
    let mended: String = rows.iter().copied().filter(|row| row.mended_miss.is_some()).map(line).collect();
    if !mended.is_empty() {
        let _ = writeln!(
            text,
            "Known misses that pass; their entries can be taken out of the gates:\n\n{mended}"
        );
    }
}

/// One line of a suite's table: a figure of a variant and scheme over the resolutions.
fn push_line(text: &mut String, rows: &[&Row], first: &Row, resolutions: &[u32]) {
    let is_kin = |row: &&&Row| (&row.variant, row.scheme) == (&first.variant, first.scheme);
    let cells: Vec<&&Row> = rows.iter().filter(is_kin).filter(|row| row.metric == first.metric).collect();
    let reference = first.reference.filter(|&value| value != 0.0);
    let reference = reference.map_or(String::new(), |value| format!("{:.5}", Significant(value)));
    let variant = if first.variant.is_empty() { String::new() } else { format!("{}, ", first.variant) };
    let figure = first.metric.replace('_', " ");
    let _ = write!(text, "| {variant}{} | {figure} [{}] | {reference} |", first.scheme.title(), first.unit);
    for n in resolutions {
        let cell = cells.iter().find(|row| row.n == Some(*n));
        let _ = write!(text, " {} |", cell.map_or(String::new(), |row| shown(row)));
    }
    let name = format!("{}_order", first.metric);
    let order = rows.iter().filter(is_kin).find(|row| row.n.is_none() && row.metric == name);
    let _ = writeln!(text, " {} |", order.map_or(String::new(), |row| shown(row)));
}

/// The value, bold where it missed its gate.
fn shown(row: &Row) -> String {
    let digits = if row.reference.is_some_and(|reference| reference != 0.0) { 5 } else { 3 };
    let value = format!("{:.*}", digits, Significant(row.value));
    if row.passed == Some(false) { format!("**{value}**") } else { value }
}

fn push_failures(text: &mut String, report: &Report) {
    let failures = report.runs.iter().filter_map(|run| run.failure.as_ref());
    let lines: Vec<String> = failures.map(|failure| format!("- {failure}\n")).collect();
    if !lines.is_empty() {
        let _ = writeln!(text, "## Runs that failed\n\n{}", lines.concat());
    }
}

fn push_costs(text: &mut String, report: &Report) {
    text.push_str("## Cost\n\nSeconds by the clock; runs side by side share the machine, and a costly run may have several threads.\n\n");
    text.push_str(
        "| suite | variant | scheme | n | particles | steps | wall time, s | million particle-steps/s |\n",
    );
    text.push_str("|---|---|---|---|---|---|---|---|\n");
    for run in &report.runs {
        let Some(cost) = run.cost else { continue };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {:.1} | {:.2} |",
            run.case.suite,
            run.case.variant,
            run.case.scheme.title(),
            run.case.n,
            cost.particles,
            cost.steps,
            cost.seconds,
            cost.rate()
        );
    }
}
