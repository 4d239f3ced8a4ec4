//! A report with one of everything: `cargo run -p sph-io --example report -- FOLDER`.

use sph_io::field_image::{ColorMap, Field, FieldImage};
use sph_io::html::{Check, Page, Picture, Section, TableView, Verdict};
use sph_io::plot::{Axis, Figure, Series};
use sph_io::table::{Column, Table};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: report FOLDER")?;
    let page = Page::new("Shock Hugoniot of porous copper")
        .with_lead("u_s(u_p) from three points, with made-up numbers")
        .with_verdict(Verdict::Caution, "One of three points has not settled; the others pass all checks.")
        .with_facts([("program", "example"), ("command", "`cargo run -p sph-io --example report`")])
        .with_section(Section::new("Can I believe this?").with_checks(checks()))
        .with_section(Section::new("Points").with_table(points()).with_picture(curve(), "Shock velocity."))
        .with_section(
            Section::new("u_p = 100 m/s")
                .with_anchor("up-100")
                .with_verdict(Verdict::Good, "settled")
                .folded()
                .with_strip((0..6).map(|k| (Picture::from(blob(k)), format!("{} ns", 10 * k))))
                .with_code("Case(name: \"example\")"),
        )
        .with_footer("Made by the example `report` of sph-io.");
    Ok(page.write(std::path::Path::new(&folder).join("report.html"))?)
}

fn checks() -> [Check; 3] {
    [
        Check::new(
            Verdict::Good,
            "Books close",
            "3·10^-15",
            "What came in, less what went out, is what is there.",
        ),
        Check::new(Verdict::Caution, "Settled", "2 of 3 points", "`max_fed_cells` came first: raise it."),
        Check::new(Verdict::Unknown, "Pores", "", "No profile was taken."),
    ]
}

fn points() -> TableView {
    let table = Table::new("Points")
        .with(Column::float("u_p", "m/s", "particle velocity behind the front", [100.0, 150.0, 200.0]))
        .with(Column::float("u_s", "m/s", "shock velocity", [433.2, 571.1, 757.9]))
        .with(Column::float("±", "m/s", "standard error", [4.1, 2.2, 3.9]))
        .with(Column::text(
            "status",
            "how it ended",
            ["settled", "not settled", "settled"].map(String::from),
        ));
    TableView::from(&table)
        .with_verdicts("status", [Verdict::Good, Verdict::Caution, Verdict::Good])
        .with_links("u_p", ["#up-100".to_owned()])
}

fn curve() -> Figure {
    Figure::new("", Axis::new("u_p [m/s]"), Axis::new("u_s [m/s]")).with(
        Series::points("computed", &[100.0, 150.0, 200.0], &[433.2, 571.1, 757.9])
            .with_error(&[4.1, 2.2, 3.9]),
    )
}

/// A disc of particles that is pressed flat.
fn blob(step: u32) -> FieldImage {
    let places = (0..40).flat_map(|i| (0..40).map(move |j| (f64::from(i) - 19.5, f64::from(j) - 19.5)));
    let inside: Vec<(f64, f64)> = places.filter(|(x, y)| x.hypot(*y) < 16.0).collect();
    let part = 1.0 - 0.1 * f64::from(step);
    let x: Vec<f64> = inside.iter().map(|p| p.0 * part + 20.0).collect();
    let y: Vec<f64> = inside.iter().map(|p| p.1 + 20.0).collect();
    let value: Vec<f64> = inside.iter().map(|p| p.0.hypot(p.1)).collect();
    let size = vec![1.0; x.len()];
    FieldImage { width: 500.0, ..FieldImage::new("", (0.0, 40.0), (0.0, 40.0)) }
        .with_particles(x, y, size)
        .with_field(Field::new("distance [µm]", value, ColorMap::Sequential))
}
