//! Reports for people: one HTML file with everything in it, pictures too; no network, no script.
//!
//! A [`Page`] has a title, a verdict, facts, and [`Section`]s; a section holds text, lists, facts, [`Check`]s, tables,
//! pictures, strips of pictures, code, and sections of its own, folded or open. Any text is escaped. Within texts
//! `` `code` `` is set as such, and `u_s`, `σ_{xx}`, `10^-3` as one would write them: a mark counts after a single
//! letter (`up_0100` stays) or, for `^`, after any letter or digit.
//!
//! Pages follow the reader's choice of light or dark, are readable on a phone (wide tables scroll, a picture grows
//! when it is touched), and print.
//!
//! ```
//! use sph_io::html::{Check, Page, Section, Verdict};
//! let checks = [Check::new(Verdict::Good, "Books close", "3e-15", "what came in less what went out")];
//! let section = Section::new("Can I believe this?").with_checks(checks).with_text("See `hugoniot.csv`.");
//! let page = Page::new("Porous copper").with_verdict(Verdict::Good, "all checks hold").with_section(section);
//! assert!(page.to_html().unwrap().contains("<code>hugoniot.csv</code>"));
//! ```

mod render;
mod text;

use crate::field_image::FieldImage;
use crate::plot::Figure;
use crate::table::Table;
use crate::{IoError, atomic};
use std::path::Path;

/// Width at which figures are drawn, in points: half a desktop, and words that can be read on a phone.
const FIGURE_WIDTH: f64 = 620.0;

/// What a check came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Not judged, for want of a measurement or of a bound.
    Unknown,
    /// As it should be.
    Good,
    /// To be looked at before one relies on it.
    Caution,
    /// Wrong.
    Bad,
}

impl Verdict {
    /// The worst of several; `Unknown` of none.
    pub fn worst(verdicts: impl IntoIterator<Item = Self>) -> Self {
        verdicts.into_iter().max().unwrap_or(Self::Unknown)
    }

    /// One word for it.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Unknown => "not judged",
            Self::Good => "good",
            Self::Caution => "look",
            Self::Bad => "bad",
        }
    }
}

/// One question that was asked of the results.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// Its answer.
    pub verdict: Verdict,
    /// What was asked, in a few words.
    pub name: String,
    /// What was found, with its unit.
    pub value: String,
    /// What it means, and what to do about it.
    pub meaning: String,
}

impl Check {
    /// A check with its answer.
    pub fn new(
        verdict: Verdict,
        name: impl Into<String>,
        value: impl Into<String>,
        meaning: impl Into<String>,
    ) -> Self {
        Self { verdict, name: name.into(), value: value.into(), meaning: meaning.into() }
    }
}

/// A picture that becomes a part of the page.
#[derive(Debug, Clone, PartialEq)]
pub enum Picture {
    /// Curves; dark pages show them on dark.
    Plot(Box<Figure>),
    /// Fields of particles.
    Fields(Box<FieldImage>),
    /// A PNG file's bytes.
    Png(Vec<u8>),
    /// An SVG file's text, of curves on white.
    Svg(String),
}

impl From<Figure> for Picture {
    /// The figure, drawn anew at a width that suits a page.
    fn from(figure: Figure) -> Self {
        let panel_height = figure.panel_height * (FIGURE_WIDTH / figure.width).max(0.75);
        Self::Plot(Box::new(Figure { width: FIGURE_WIDTH, panel_height, ..figure }))
    }
}

impl From<FieldImage> for Picture {
    fn from(image: FieldImage) -> Self {
        Self::Fields(Box::new(image))
    }
}

/// A table, and what goes beside its values.
#[derive(Debug, Clone, PartialEq)]
pub struct TableView {
    table: Table,
    /// Column and verdict of each row.
    verdicts: Vec<(String, Vec<Verdict>)>,
    /// Column and target of each row.
    links: Vec<(String, Vec<String>)>,
}

impl From<&Table> for TableView {
    fn from(table: &Table) -> Self {
        Self { table: table.clone(), verdicts: Vec::new(), links: Vec::new() }
    }
}

impl TableView {
    /// The table with the values of a column marked, one verdict a row.
    #[must_use]
    pub fn with_verdicts(mut self, column: &str, verdicts: impl Into<Vec<Verdict>>) -> Self {
        self.verdicts.push((column.to_owned(), verdicts.into()));
        self
    }

    /// The table with the values of a column leading elsewhere, one target a row: `#` and the [`anchor`] of a section,
    /// or a file beside the page. An empty target leads nowhere.
    #[must_use]
    pub fn with_links(mut self, column: &str, targets: impl Into<Vec<String>>) -> Self {
        self.links.push((column.to_owned(), targets.into()));
        self
    }

    fn verdict(&self, column: &str, row: usize) -> Option<Verdict> {
        let (_, verdicts) = self.verdicts.iter().find(|(name, _)| name == column)?;
        verdicts.get(row).copied()
    }

    fn link(&self, column: &str, row: usize) -> Option<&str> {
        let (_, targets) = self.links.iter().find(|(name, _)| name == column)?;
        targets.get(row).map(String::as_str).filter(|target| !target.is_empty())
    }
}

#[derive(Debug, Clone, PartialEq)]
enum Block {
    Text(String),
    List(Vec<String>),
    Facts(Vec<(String, String)>),
    Checks(Vec<Check>),
    Table(TableView),
    Picture(Picture, String),
    Strip(Vec<(Picture, String)>),
    Code(String),
    Section(Section),
}

/// A part of a page under a heading.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    heading: String,
    anchor: Option<String>,
    verdict: Option<(Verdict, String)>,
    is_folded: bool,
    blocks: Vec<Block>,
}

impl Section {
    /// An empty section.
    pub fn new(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), anchor: None, verdict: None, is_folded: false, blocks: Vec::new() }
    }

    /// The section under another anchor than that of its heading, for links to it.
    #[must_use]
    pub fn with_anchor(self, anchor: impl Into<String>) -> Self {
        Self { anchor: Some(anchor.into()), ..self }
    }

    /// The section with a badge beside its heading, and words in it; the verdict's own word if they are empty.
    #[must_use]
    pub fn with_verdict(self, verdict: Verdict, words: impl Into<String>) -> Self {
        Self { verdict: Some((verdict, words.into())), ..self }
    }

    /// The section shut, until the reader opens it.
    #[must_use]
    pub fn folded(self) -> Self {
        Self { is_folded: true, ..self }
    }

    /// The section with one more paragraph.
    #[must_use]
    pub fn with_text(self, text: impl Into<String>) -> Self {
        self.with(Block::Text(text.into()))
    }

    /// The section with a list, one item a line.
    #[must_use]
    pub fn with_list<T: Into<String>>(self, items: impl IntoIterator<Item = T>) -> Self {
        self.with(Block::List(items.into_iter().map(Into::into).collect()))
    }

    /// The section with names and what they stand for, such as settings.
    #[must_use]
    pub fn with_facts<N: Into<String>, T: Into<String>>(
        self,
        facts: impl IntoIterator<Item = (N, T)>,
    ) -> Self {
        self.with(Block::Facts(facts.into_iter().map(|(n, t)| (n.into(), t.into())).collect()))
    }

    /// The section with checks, one a row.
    #[must_use]
    pub fn with_checks(self, checks: impl IntoIterator<Item = Check>) -> Self {
        self.with(Block::Checks(checks.into_iter().collect()))
    }

    /// The section with a table: its title, names, units, rows; descriptions of the columns below, folded.
    #[must_use]
    pub fn with_table(self, table: impl Into<TableView>) -> Self {
        self.with(Block::Table(table.into()))
    }

    /// The section with a picture and its caption. Curves that follow one another stand side by side where there is room.
    #[must_use]
    pub fn with_picture(self, picture: impl Into<Picture>, caption: impl Into<String>) -> Self {
        self.with(Block::Picture(picture.into(), caption.into()))
    }

    /// The section with pictures in one row that scrolls, such as successive moments.
    #[must_use]
    pub fn with_strip(self, pictures: impl IntoIterator<Item = (Picture, String)>) -> Self {
        self.with(Block::Strip(pictures.into_iter().collect()))
    }

    /// The section with text as it stands: a file, a command, a message.
    #[must_use]
    pub fn with_code(self, code: impl Into<String>) -> Self {
        self.with(Block::Code(code.into()))
    }

    /// The section with one of its own in it.
    #[must_use]
    pub fn with_section(self, section: Section) -> Self {
        self.with(Block::Section(section))
    }

    fn with(mut self, block: Block) -> Self {
        self.blocks.push(block);
        self
    }

    /// The section's place in the page, for links to it: `#` and this.
    #[must_use]
    pub fn anchor(&self) -> String {
        self.anchor.clone().unwrap_or_else(|| anchor(&self.heading))
    }
}

/// The anchor that a heading has: its letters and digits, small, with hyphens between the words.
#[must_use]
pub fn anchor(heading: &str) -> String {
    let plain: String = heading.chars().map(|c| if c.is_alphanumeric() { c } else { ' ' }).collect();
    plain.to_lowercase().split_whitespace().collect::<Vec<_>>().join("-")
}

/// A report.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    title: String,
    lead: String,
    verdict: Option<(Verdict, String)>,
    facts: Vec<(String, String)>,
    sections: Vec<Section>,
    footer: String,
}

impl Page {
    /// An empty page.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            lead: String::new(),
            verdict: None,
            facts: Vec::new(),
            sections: Vec::new(),
            footer: String::new(),
        }
    }

    /// The page with one sentence below its title.
    #[must_use]
    pub fn with_lead(self, lead: impl Into<String>) -> Self {
        Self { lead: lead.into(), ..self }
    }

    /// The page with the answer to the reader's first question at its top.
    #[must_use]
    pub fn with_verdict(self, verdict: Verdict, words: impl Into<String>) -> Self {
        Self { verdict: Some((verdict, words.into())), ..self }
    }

    /// The page with facts at its top: when, where, by which program.
    #[must_use]
    pub fn with_facts<N: Into<String>, T: Into<String>>(
        self,
        facts: impl IntoIterator<Item = (N, T)>,
    ) -> Self {
        Self { facts: facts.into_iter().map(|(n, t)| (n.into(), t.into())).collect(), ..self }
    }

    /// The page with one more section; the sections' headings are the page's contents.
    #[must_use]
    pub fn with_section(mut self, section: Section) -> Self {
        self.sections.push(section);
        self
    }

    /// The page with a last line.
    #[must_use]
    pub fn with_footer(self, footer: impl Into<String>) -> Self {
        Self { footer: footer.into(), ..self }
    }

    /// The page as text.
    ///
    /// # Errors
    /// What does not fit in a table or a picture: columns of unequal length, a range that cannot be drawn.
    pub fn to_html(&self) -> Result<String, String> {
        render::page(self)
    }

    /// Writes the page, atomically.
    ///
    /// # Errors
    /// [`IoError::Invalid`] as [`Page::to_html`], [`IoError::File`] from the system.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        let path = path.as_ref();
        let html = self.to_html().map_err(|reason| IoError::invalid(path, reason))?;
        atomic::write_atomic(path, html.as_bytes())
    }
}

#[cfg(test)]
mod tests;
