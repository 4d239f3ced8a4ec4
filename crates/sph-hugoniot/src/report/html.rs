//! `report.html`: the whole run on one page, for a person who has to decide whether to believe it.

use sph_io::clock;
use sph_io::field_image::{ColorMap, Field, FieldImage};
use sph_io::html::{Page, Picture, Section, TableView, Verdict};
use sph_io::table::{Column, Table};
use sph_riemann::StageTimes;

use super::belief::{self, Answer};
use super::curves::Curves;
use super::planes::{self, Plane};
use super::{machine, monitors, plots, profile_plots, summary};
use crate::check::{Check as CaseCheck, duration};
use crate::config::Case;
use crate::film::Frame;
use crate::microstructure::{Sample, picture};
use crate::outcome::{PointOutcome, Status};

/// A micrometer [1/m].
const MICRO: f64 = 1e6;
/// Part of the largest plastic strain at which the colors of the film end.
const STRAIN_SHOWN: f64 = 0.6;
/// Width of a frame of the film [points].
const FRAME_WIDTH: f64 = 480.0;

/// How a run was made.
#[derive(Clone, Debug, Default)]
pub struct RunFacts {
    /// The command.
    pub command: String,
    /// When it began, since 1970 [s].
    pub started: f64,
    /// How long it took [s].
    pub seconds: f64,
    /// Cores used.
    pub threads: usize,
    /// The case file as it was read.
    pub case_text: String,
}

/// The page of a run.
pub fn page(curves: &Curves<'_>, sample: &Sample, outcomes: &[&PointOutcome], facts: &RunFacts) -> Page {
    let case = curves.case;
    let (verdict, words) = answer(case, outcomes);
    let names: Vec<String> = case.materials().into_iter().map(|m| m.name).collect();
    let (name, size) = (names.join(" and "), case.medium.particle_size * MICRO);
    let lead = format!("u_s(u_p) of {name} with porosity {:.4}, particles of {size:.3} µm", sample.porosity);
    let mut page = Page::new(format!("Shock Hugoniot: {}", case.name))
        .with_lead(lead)
        .with_verdict(verdict, words)
        .with_facts(run_facts(outcomes, facts))
        .with_section(belief_section(case, outcomes))
        .with_section(curve_section(curves, outcomes));
    let mut points =
        Section::new("Point by point").with_text("Open a point for its history, profile, film and fields.");
    for outcome in outcomes {
        points = points.with_section(point_section(case, outcome));
    }
    page = page.with_section(points);
    page.with_section(interventions_section(outcomes))
        .with_section(case_section(case, sample, facts))
        .with_section(time_section(outcomes, facts))
        .with_footer(format!(
            "{}. Verdicts are hints where to look, not proofs; the guide says how each figure is meant.",
            machine::VERSION
        ))
}

fn run_facts(outcomes: &[&PointOutcome], facts: &RunFacts) -> Vec<(String, String)> {
    let fact = |name: &str, text: String| (name.to_owned(), text);
    let core_time: f64 = outcomes.iter().map(|o| o.wall_seconds).sum();
    vec![
        fact("command", format!("`{}`", facts.command.replace('`', "'"))),
        fact("program", machine::VERSION.to_owned()),
        fact("begun", clock::utc(facts.started)),
        fact(
            "took",
            format!(
                "{}; {} in the points, earlier runs included",
                duration(facts.seconds),
                duration(core_time)
            ),
        ),
        fact("machine", machine::machine()),
        fact("cores used", facts.threads.to_string()),
    ]
}

/// The answer to the first question: can this be believed?
fn answer(case: &Case, outcomes: &[&PointOutcome]) -> (Verdict, String) {
    let verdicts: Vec<Verdict> = outcomes.iter().map(|o| belief::verdict(case, o)).collect();
    let count = |wanted: Verdict| verdicts.iter().filter(|v| **v == wanted).count();
    let unfinished = outcomes.iter().filter(|o| o.status != Status::Settled).count();
    let (n, worst) = (outcomes.len(), Verdict::worst(verdicts.iter().copied()));
    let mut words = match worst {
        Verdict::Unknown => "Nothing could be judged".to_owned(),
        Verdict::Good if n == 1 => "All checks of the point hold".to_owned(),
        Verdict::Good => format!("All checks of all {n} points hold"),
        Verdict::Caution if n == 1 => "The point needs a look".to_owned(),
        Verdict::Bad if n == 1 => "The point is bad".to_owned(),
        _ => {
            format!(
                "Of {n} points {} pass all checks, {} need a look, {} are bad",
                count(Verdict::Good),
                count(Verdict::Caution),
                count(Verdict::Bad)
            )
        }
    };
    match (unfinished, n) {
        (0, _) => {}
        (_, 1) => words += "; it did not settle",
        _ => words += &format!("; {unfinished} did not settle"),
    }
    (worst, words + ".")
}

/// Each question with its worst answer, and all answers in a table.
fn belief_section(case: &Case, outcomes: &[&PointOutcome]) -> Section {
    let all: Vec<Vec<Answer>> = outcomes.iter().map(|o| belief::answers(case, o)).collect();
    let worst = (0..belief::NAMES.len()).filter_map(|k| {
        let worse = |a: &usize, b: &usize| {
            let (a, b) = (&all[*a][k], &all[*b][k]);
            a.check.verdict.cmp(&b.check.verdict).then(a.severity.total_cmp(&b.severity))
        };
        let at = (0..all.len()).max_by(worse)?;
        let mut check = all[at][k].check.clone();
        if all.len() > 1 {
            check.value = format!("{} (worst: u_p = {} m/s)", check.value, outcomes[at].particle_velocity);
        }
        Some(check)
    });
    let mut section = Section::new("Can I believe this?").with_checks(worst.collect::<Vec<_>>());
    if all.len() > 1 {
        section = section.with_table(verdict_table(outcomes, &all));
    }
    let warnings = warnings(outcomes);
    if warnings.is_empty() {
        section
    } else {
        section.with_section(Section::new("Warnings").with_list(warnings))
    }
}

fn verdict_table(outcomes: &[&PointOutcome], all: &[Vec<Answer>]) -> TableView {
    let u_p: Vec<f64> = outcomes.iter().map(|o| o.particle_velocity).collect();
    let mut table = Table::new("Verdicts").with(Column::float("u_p", "m/s", "", u_p));
    for (k, name) in belief::NAMES.iter().enumerate() {
        let words: Vec<String> = all.iter().map(|checks| checks[k].check.verdict.word().to_owned()).collect();
        table = table.with(Column::text(name, "", words));
    }
    let mut view = TableView::from(&table).with_links("u_p", links(outcomes));
    for (k, name) in belief::NAMES.iter().enumerate() {
        view = view.with_verdicts(name, all.iter().map(|checks| checks[k].check.verdict).collect::<Vec<_>>());
    }
    view
}

fn warnings(outcomes: &[&PointOutcome]) -> Vec<String> {
    let failed = outcomes.iter().filter_map(|o| match &o.status {
        Status::Failed(reason) => Some(format!("u_p = {} m/s failed: {reason}", o.particle_velocity)),
        _ => None,
    });
    let doubtful = outcomes.iter().flat_map(|o| {
        o.warnings.iter().map(|warning| format!("u_p = {} m/s: {warning}", o.particle_velocity))
    });
    failed.chain(doubtful).collect()
}

fn links(outcomes: &[&PointOutcome]) -> Vec<String> {
    outcomes.iter().map(|o| format!("#{}", o.file_stem())).collect()
}

/// Planes in the order of the page.
const CURVE_PICTURES: [(Plane, &str); 4] = [
    (Plane::ShockVelocity, "Shock velocity over particle velocity."),
    (Plane::StressVelocity, "Stress behind the wave over particle velocity."),
    (Plane::StressDensity, "Stress over density behind the wave."),
    (Plane::StressVolume, "Stress over volume behind the wave."),
];

fn curve_section(curves: &Curves<'_>, outcomes: &[&PointOutcome]) -> Section {
    let mut section = Section::new("The curve");
    if !curves.curve.points.is_empty() {
        for (plane, words) in CURVE_PICTURES {
            section = section.with_picture(planes::plane(curves, plane), words);
        }
        section = section.with_picture(planes::with_solid(curves), "u_s beside the solid without pores.");
    }
    if !curves.fits.is_empty() {
        section = section.with_picture(planes::fits(curves), "Fits, and what they leave of the points.");
        for line in curves.lines() {
            section = section.with_text(line);
        }
    }
    let verdicts: Vec<Verdict> = outcomes
        .iter()
        .map(|o| match o.status {
            Status::Settled => Verdict::Good,
            Status::Failed(_) => Verdict::Bad,
            _ => Verdict::Caution,
        })
        .collect();
    let table = TableView::from(&summary::points(outcomes))
        .with_links("u_p", links(outcomes))
        .with_verdicts("status", verdicts);
    section.with_table(table).with_text(
        "`hugoniot.csv` beside this page has more columns, each with its unit and meaning; `points/` has the profiles and \
         histories.",
    )
}

fn point_section(case: &Case, outcome: &PointOutcome) -> Section {
    let u_p = outcome.particle_velocity;
    let (u_s, error) = (outcome.shock_velocity, outcome.standard_error);
    let heading = if u_s.is_finite() {
        format!("u_p = {u_p} m/s: u_s = {u_s:.1} ± {error:.1} m/s")
    } else {
        format!("u_p = {u_p} m/s")
    };
    let verdict = belief::verdict(case, outcome);
    let mut section = Section::new(heading)
        .with_anchor(outcome.file_stem())
        .with_verdict(verdict, "")
        .folded()
        .with_checks(belief::checks(case, outcome));
    if !outcome.cell_velocities.is_empty() {
        section = section.with_picture(
            plots::history(outcome, case.medium.cell),
            "u_s over each cell that the front swept. Dots that still climb or fall within the dashed stretch: not steady yet.",
        );
    }
    if !outcome.profile.is_empty() {
        section = section.with_picture(
            profile_plots::profile(outcome),
            "Averages in the frame of the front. The two densities must meet behind it where pores are shut.",
        );
    }
    if case.output.images && !outcome.film.is_empty() {
        section = section
            .with_text(format!(
                "The front on its way through the medium, u_x above plastic strain; the medium comes from the right. The \
                 colors of the strain end at {STRAIN_SHOWN} of its largest value in the film, {:.2}; more has the color \
                 of the end.",
                largest_strain(outcome)
            ))
            .with_strip(film(outcome));
    }
    if case.output.images && !outcome.fields.x.is_empty() {
        section = section.with_picture(
            profile_plots::fields(outcome),
            "The last moment: density, σ_xx, u_x, plastic strain, slip.",
        );
    }
    if !outcome.monitors.is_empty() {
        let table = Section::new("Monitors").folded().with_table(&monitors::table(outcome));
        section = section.with_section(table);
    }
    section
}

/// Largest plastic strain of the film [-].
fn largest_strain(outcome: &PointOutcome) -> f64 {
    f64::from(outcome.film.iter().flat_map(|f| &f.plastic_strain).fold(0.0_f32, |a, &b| a.max(b)))
}

/// The frames in one scale of color.
fn film(outcome: &PointOutcome) -> Vec<(Picture, String)> {
    let first = outcome.film[0].time;
    let strain = largest_strain(outcome).max(0.01);
    let range = (-0.3 * outcome.particle_velocity, 1.7 * outcome.particle_velocity);
    outcome
        .film
        .iter()
        .map(|frame| {
            (frame_image(frame, range, strain).into(), format!("{:.2} ns", 1e9 * (frame.time - first)))
        })
        .collect()
}

fn frame_image(frame: &Frame, velocity: (f64, f64), strain: f64) -> FieldImage {
    let scaled =
        |values: &[f32], factor: f64| values.iter().map(|&v| f64::from(v) * factor).collect::<Vec<_>>();
    let (from, to, height) = frame.extent;
    let image = FieldImage::new("", (from * MICRO, to * MICRO), (0.0, height * MICRO));
    FieldImage { width: FRAME_WIDTH, x_label: "x − x_{front} [µm]".into(), ..image }
        .with_particles(scaled(&frame.x, MICRO), scaled(&frame.y, MICRO), scaled(&frame.size, MICRO))
        .with_field(
            Field::new("u_x [m/s]", scaled(&frame.velocity, 1.0), ColorMap::Heat)
                .with_range(velocity.0, velocity.1),
        )
        .with_field(
            // The few jets of the front would take the whole scale.
            Field::new("plastic strain", scaled(&frame.plastic_strain, 1.0), ColorMap::Sequential)
                .with_range(0.0, STRAIN_SHOWN * strain),
        )
        .with_periods(2)
}

fn interventions_section(outcomes: &[&PointOutcome]) -> Section {
    let lines = monitors::interventions(outcomes);
    let section = Section::new("What acted on the way");
    if lines.is_empty() {
        return section.with_text("No bound acted on any value.");
    }
    section.with_text("Nothing is bounded in silence. These bounds acted:").with_list(lines)
}

fn case_section(case: &Case, sample: &Sample, facts: &RunFacts) -> Section {
    let check = CaseCheck::new(case.clone(), facts.threads.max(1));
    let json = serde_json::to_string_pretty(case).unwrap_or_default();
    let mut section = Section::new("The case");
    if case.output.images {
        section = section.with_picture(picture::draw(case, sample), "The medium: two by two cells.");
    }
    section
        .with_code(check.to_text())
        .with_section(Section::new("As it was written").folded().with_code(facts.case_text.clone()))
        .with_section(Section::new("As it was resolved, in SI with every default").folded().with_code(json))
}

fn time_section(outcomes: &[&PointOutcome], facts: &RunFacts) -> Section {
    let mut stages = StageTimes::default();
    outcomes.iter().for_each(|o| stages.merge(&o.stages));
    let steps: u64 = outcomes.iter().map(|o| o.particle_steps).sum();
    let core_time: f64 = outcomes.iter().map(|o| o.wall_seconds).sum();
    let text = format!(
        "{} on {} cores; {:.3e} particle-steps, {:.2} million a second in a point; lists rebuilt {} times.",
        duration(facts.seconds),
        facts.threads,
        steps as f64,
        steps as f64 / core_time / 1e6,
        stages.rebuilds
    );
    Section::new("How long it took").with_text(text).with_table(&summary::stages(&stages))
}
