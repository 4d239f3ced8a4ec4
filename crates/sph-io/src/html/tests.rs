//! Pages are whole, safe and self-contained.

use super::*;
use crate::field_image::{ColorMap, Field};
use crate::plot::{Axis, Series};
use crate::table::Column;

fn sample() -> Page {
    let table = Table::new("Points")
        .with(Column::float("u_p", "m/s", "particle velocity", [100.0, 200.0]))
        .with(Column::text("status", "how it ended", ["settled", "<failed>"].map(String::from)));
    let view = TableView::from(&table)
        .with_verdicts("status", [Verdict::Good, Verdict::Bad])
        .with_links("u_p", ["#at-100".into(), String::new()]);
    let figure =
        Figure::new("u_s", Axis::new("t"), Axis::new("u_s")).with(Series::line("", &[0.0, 1.0], &[1.0, 2.0]));
    let image = FieldImage::new("", (0.0, 1.0), (0.0, 1.0))
        .with_particles([0.5], [0.5], [0.5])
        .with_field(Field::new("rho", [1.0], ColorMap::Sequential));
    Page::new("Report of <me> & you")
        .with_verdict(Verdict::Caution, "one point failed")
        .with_facts([("version", "0.1")])
        .with_section(Section::new("Table").with_table(view))
        .with_section(Section::new("Pictures").with_picture(figure, "curve").with_picture(image, "field"))
        .with_section(
            Section::new("At 100")
                .folded()
                .with_checks([Check::new(Verdict::Good, "a", "1 %", "so")])
                .with_code("a < b"),
        )
        .with_footer("end")
}

#[test]
fn a_page_has_all_its_parts_and_needs_nothing_from_elsewhere() {
    let html = sample().to_html().unwrap();
    for part in [
        "<title>Report of &lt;me&gt; &amp; you</title>",
        "u<sub>p</sub> <small>m/s</small>",
        "<span class=\"mark wrong\">&lt;failed&gt;</span>",
        "<a href=\"#at-100\">100</a>",
        "<details class=\"section\" id=\"at-100\">",
        "src=\"data:image/svg+xml;base64,",
        "src=\"data:image/png;base64,",
        "a &lt; b",
        "<nav>",
    ] {
        assert!(html.contains(part), "{part} is missing");
    }
    for absent in ["<script", "http://", "https://", "@import", "url(", "<failed>", "<me>"] {
        assert!(!html.contains(absent), "{absent} is there");
    }
}

#[test]
fn tags_are_balanced() {
    let html = sample().to_html().unwrap();
    for tag in [
        "section", "details", "figure", "table", "tr", "td", "div", "span", "label", "dl", "p", "main",
        "body",
    ] {
        let open = html.matches(&format!("<{tag}>")).count() + html.matches(&format!("<{tag} ")).count();
        assert_eq!(open, html.matches(&format!("</{tag}>")).count(), "<{tag}>");
    }
}

#[test]
fn what_does_not_fit_is_named() {
    let uneven =
        Table::new("").with(Column::float("a", "", "", [1.0])).with(Column::float("b", "", "", [1.0, 2.0]));
    let page = Page::new("x").with_section(Section::new("y").with_table(&uneven));
    assert!(page.to_html().unwrap_err().contains("`a` has 1 rows"));
    let figure = Figure::new("", Axis::new("x"), Axis::new("y")).with(Series::line("s", &[1.0], &[]));
    let folder = tempfile::tempdir().unwrap();
    let page = Page::new("x").with_section(Section::new("y").with_picture(figure, ""));
    let error = page.write(folder.path().join("r.html")).unwrap_err().to_string();
    assert!(error.contains("r.html") && error.contains("`s` has 1 x"), "{error}");
}

#[test]
fn the_worst_verdict_counts_and_anchors_are_plain() {
    assert_eq!(Verdict::worst([Verdict::Good, Verdict::Bad, Verdict::Caution]), Verdict::Bad);
    assert_eq!(Verdict::worst([]), Verdict::Unknown);
    assert_eq!(anchor("u_p = 62.5 m/s <"), "u-p-62-5-m-s");
}
