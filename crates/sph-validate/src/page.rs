//! `report.html`: a validation on one page that needs nothing else.

use sph_io::html::{self, Page, Section, TableView, Verdict};
use sph_io::table::{Column, Table};

use crate::case::SchemeName;
use crate::error::ValidateError;
use crate::gate::Significant;
use crate::outcome::Outcome;
use crate::report::{Report, Row, SuiteRecord};
use crate::runner::{Ended, suites_of};
use crate::suites::Drawing;

/// The page of a report.
///
/// # Errors
/// If the gates of a suite cannot be read or one of its pictures cannot be drawn.
pub fn page(report: &Report, ended: &[Ended<'_>]) -> Result<Page, ValidateError> {
    let (verdict, words) = answer(report);
    let mut page = Page::new("Validation: problems with known answers")
        .with_lead(
            "Each problem is run with the real program at several resolutions, and each figure is held against an exact \
             solution, an independent one, or a measurement.",
        )
        .with_verdict(verdict, words)
        .with_facts(facts(report))
        .with_section(overview(report));
    for suite in &report.suites {
        page = page.with_section(suite_section(report, suite, ended)?);
    }
    Ok(page.with_section(costs(report)).with_footer(
        "A gate is the narrowest of: the published figure of the same run (half a unit of its last printed digit allowed), \
         what this program has reached before (a twentieth allowed), a limit. Sources: validation/<problem>/README.md.",
    ))
}

/// The verdict over everything, in a sentence.
fn answer(report: &Report) -> (Verdict, String) {
    let failed = report.runs.iter().filter(|run| run.failure.is_some()).count();
    let words = format!("{} runs: {}", report.runs.len(), report.tally());
    match (failed, verdict(report.rows.iter())) {
        (0, Verdict::Unknown) => (Verdict::Unknown, format!("{words}: nothing is judged here")),
        (0, verdict) => (verdict, words),
        _ => (Verdict::Bad, format!("{words}; {failed} runs failed")),
    }
}

fn facts(report: &Report) -> Vec<(&'static str, String)> {
    let made = &report.provenance;
    let core_seconds: f64 = report.runs.iter().filter_map(|run| run.cost).map(|cost| cost.seconds).sum();
    let mut took = format!("{:.0} s; {core_seconds:.0} s of computing in the runs", made.seconds);
    if made.taken_over > 0 {
        took += &format!("; {} runs taken over from an earlier validation of the same code", made.taken_over);
    }
    vec![
        ("command", format!("`{}`", made.command)),
        ("program", format!("{}, code {}", made.version, made.code)),
        ("commit", made.commit.clone().unwrap_or_else(|| "unknown".into())),
        ("compiler", made.compiler.clone()),
        ("machine", made.machine.clone()),
        ("begun", made.begun.clone()),
        ("took", took),
    ]
}

/// Verdict of some rows: good if all gates passed, to be looked at if the misses are known ones or known ones pass, unknown
/// without gates.
fn verdict<'r>(rows: impl Iterator<Item = &'r Row>) -> Verdict {
    Verdict::worst(rows.filter_map(|row| match (row.passed?, &row.known_miss) {
        (true, _) if row.mended_miss.is_some() => Some(Verdict::Caution),
        (true, _) => Some(Verdict::Good),
        (false, Some(_)) => Some(Verdict::Caution),
        (false, None) => Some(Verdict::Bad),
    }))
}

fn rows_of<'r>(report: &'r Report, suite: &'r SuiteRecord) -> impl Iterator<Item = &'r Row> {
    report.rows.iter().filter(|row| row.suite == suite.name)
}

fn overview(report: &Report) -> Section {
    let suites = &report.suites;
    let text = |name: &str, cell: &dyn Fn(&SuiteRecord) -> String| {
        Column::text(name, "", suites.iter().map(cell).collect::<Vec<_>>())
    };
    let gates = |suite: &SuiteRecord| rows_of(report, suite).filter(|row| row.passed.is_some()).count();
    let passed = |suite: &SuiteRecord| rows_of(report, suite).filter(|row| row.passed == Some(true)).count();
    let runs = |suite: &SuiteRecord| report.runs.iter().filter(|run| run.case.suite == suite.name).count();
    let table = Table::new("Problems")
        .with(text("problem", &|suite| suite.title.clone()))
        .with(text("held against", &|suite| suite.reference.title().to_owned()))
        .with(text("runs", &|suite| runs(suite).to_string()))
        .with(text("gates passed", &|suite| format!("{} of {}", passed(suite), gates(suite))));
    let anchors: Vec<String> =
        suites.iter().map(|suite| format!("#{}", html::anchor(&suite.title))).collect();
    let verdicts: Vec<Verdict> = suites.iter().map(|suite| verdict(rows_of(report, suite))).collect();
    let view = TableView::from(&table).with_links("problem", anchors).with_verdicts("gates passed", verdicts);
    let mut section = Section::new("Overview").with_table(view);
    let missed: Vec<String> = report.unexplained().map(judged_line).collect();
    if !missed.is_empty() {
        section = section.with_text("Gates that were missed:").with_list(missed);
    }
    let known: Vec<String> = report.failures().filter_map(known_line).collect();
    if !known.is_empty() {
        section = section
            .with_text("Gates whose misses are known; they were not moved, and a miss may not grow:")
            .with_list(known);
    }
    let mended: Vec<String> = report.mended().map(judged_line).collect();
    if !mended.is_empty() {
        section = section
            .with_text(
                "Known misses that pass; their entries can be taken out of validation/<problem>/gates.ron:",
            )
            .with_list(mended);
    }
    let failed: Vec<String> = report.runs.iter().filter_map(|run| run.failure.clone()).collect();
    if !failed.is_empty() {
        section = section.with_text("Runs that failed:").with_list(failed);
    }
    section
}

fn judged_line(row: &Row) -> String {
    let n = row.n.map_or("all n".into(), |n| format!("n = {n}"));
    let gate = row.gate.map_or(String::new(), |gate| gate.to_string());
    let value = Significant(row.value);
    let variant = if row.variant.is_empty() { String::new() } else { format!("{}, ", row.variant) };
    let scheme = row.scheme.title();
    let unit = if row.unit == "-" { String::new() } else { format!(" {}", row.unit) };
    format!("{}: {variant}{scheme}, {n}: {} = {value:.4}{unit}; {gate}", row.suite, row.metric)
}

/// A known miss with its cause.
fn known_line(row: &Row) -> Option<String> {
    Some(format!("{}: {}", judged_line(row), row.known_miss.as_ref()?))
}

fn suite_section(
    report: &Report,
    suite: &SuiteRecord,
    ended: &[Ended<'_>],
) -> Result<Section, ValidateError> {
    let worst = verdict(rows_of(report, suite));
    let mut section = Section::new(suite.title.clone()).with_verdict(worst, "").with_text(format!(
        "n: {}. Held against: {}.",
        suite.resolution,
        suite.reference.title()
    ));
    if !suite.source.is_empty() {
        section = section.with_text(format!("Gates from: {}.", suite.source));
    }
    let of_suite = ended.iter().filter(|ended| ended.job.case.suite == suite.name);
    let outcomes: Vec<&Outcome> = of_suite.filter_map(|ended| ended.result.as_ref().ok()).collect();
    let known = suites_of(ended).into_iter().find(|known| known.about().name == suite.name);
    let known = known.filter(|_| !outcomes.is_empty());
    let mut fields: Vec<(html::Picture, String)> = Vec::new();
    for picture in known.map(|known| known.pictures(&outcomes)).transpose()?.unwrap_or_default() {
        match picture.drawing {
            Drawing::Plot(figure) => section = section.with_picture(figure, picture.caption),
            Drawing::Field(image) => fields.push((image.into(), picture.caption)),
        }
    }
    if !fields.is_empty() {
        section = section.with_strip(fields);
    }
    let (conserved, figures): (Vec<&Row>, Vec<&Row>) =
        rows_of(report, suite).partition(|row| row.kind == crate::metric::Kind::Drift);
    let section = section.with_table(figures_table("Figures", &figures));
    let conserved_verdict = verdict(conserved.iter().copied());
    let conserved = Section::new("What must be conserved")
        .with_anchor(format!("{}-conserved", suite.name))
        .with_verdict(conserved_verdict, "")
        .folded()
        .with_table(figures_table("Relative drifts", &conserved));
    Ok(section.with_section(conserved))
}

/// Figures over resolutions, one line a figure of a variant and scheme, marked by their gates.
fn figures_table(title: &str, rows: &[&Row]) -> TableView {
    let mut lines: Vec<&Row> = Vec::new();
    let key = |row: &Row| (row.variant.clone(), row.scheme, row.metric.clone());
    for &row in rows.iter().filter(|row| row.n.is_some()) {
        if lines.iter().all(|line| key(line) != key(row)) {
            lines.push(row);
        }
    }
    let text = |name: &str, cell: &dyn Fn(&Row) -> String| {
        Column::text(name, "", lines.iter().map(|row| cell(row)).collect::<Vec<_>>())
    };
    let mut table = Table::new(title);
    if lines.iter().any(|row| !row.variant.is_empty()) {
        table = table.with(text("variant", &|row| row.variant.clone()));
    }
    table = table
        .with(text("scheme", &|row| row.scheme.title().to_owned()))
        .with(text("figure", &|row| format!("{} [{}]", row.metric.replace('_', " "), row.unit)))
        .with(text("reference", &|row| {
            let reference = row.reference.filter(|&value| value != 0.0);
            reference.map_or(String::new(), |value| format!("{:.5}", Significant(value)))
        }));
    let mut resolutions: Vec<u32> = rows.iter().filter_map(|row| row.n).collect();
    resolutions.sort_unstable();
    resolutions.dedup();
    let mut marks: Vec<(String, Vec<Verdict>)> = Vec::new();
    for n in resolutions {
        let cell = |line: &&Row| rows.iter().find(|row| row.n == Some(n) && key(row) == key(line));
        let name = format!("n = {n}");
        let words: Vec<String> =
            lines.iter().map(|line| cell(line).map_or(String::new(), |row| shown(row))).collect();
        let verdicts = lines.iter().map(|line| verdict(cell(line).copied().into_iter())).collect();
        table = table.with(Column::text(&name, "", words));
        marks.push((name, verdicts));
    }
    if rows.iter().any(|row| row.n.is_none()) {
        let order = |line: &&Row| {
            let name = format!("{}_order", line.metric);
            let is_it = |row: &&&Row| row.n.is_none() && row.metric == name;
            rows.iter().filter(is_it).find(|row| (&row.variant, row.scheme) == (&line.variant, line.scheme))
        };
        let words: Vec<String> = lines
            .iter()
            .map(|line| order(line).map_or(String::new(), |row| format!("{:.2}", row.value)))
            .collect();
        let verdicts = lines.iter().map(|line| verdict(order(line).copied().into_iter())).collect();
        table = table.with(Column::text("order", "", words));
        marks.push(("order".into(), verdicts));
    }
    let view = TableView::from(&table);
    marks.into_iter().fold(view, |view, (name, verdicts)| view.with_verdicts(&name, verdicts))
}

/// A value with as many digits as it is worth.
fn shown(row: &Row) -> String {
    let digits = if row.reference.is_some_and(|reference| reference != 0.0) { 5 } else { 3 };
    format!("{:.*}", digits, Significant(row.value))
}

fn costs(report: &Report) -> Section {
    let runs: Vec<_> = report.runs.iter().filter_map(|run| Some((&run.case, run.cost?))).collect();
    let text = |name: &str, cells: Vec<String>| Column::text(name, "", cells);
    let table = Table::new("Runs")
        .with(text("problem", runs.iter().map(|(case, _)| case.suite.clone()).collect()))
        .with(text("variant", runs.iter().map(|(case, _)| case.variant.clone()).collect()))
        .with(text(
            "scheme",
            runs.iter().map(|(case, _)| SchemeName::title(case.scheme).to_owned()).collect(),
        ))
        .with(text("n", runs.iter().map(|(case, _)| case.n.to_string()).collect()))
        .with(text("particles", runs.iter().map(|(_, cost)| cost.particles.to_string()).collect()))
        .with(text("steps", runs.iter().map(|(_, cost)| cost.steps.to_string()).collect()))
        .with(text("particle-steps", runs.iter().map(|(_, cost)| cost.particle_steps.to_string()).collect()))
        .with(text("time [s]", runs.iter().map(|(_, cost)| format!("{:.1}", cost.seconds)).collect()))
        .with(text("million a second", runs.iter().map(|(_, cost)| format!("{:.2}", cost.rate())).collect()));
    Section::new("What it cost")
        .with_text(
            "Runs side by side share the machine; times of runs that were taken over are those of their day.",
        )
        .with_section(Section::new("All runs").folded().with_table(&table))
}

#[cfg(test)]
#[path = "page_tests.rs"]
mod tests;
