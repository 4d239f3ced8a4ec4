//! Faults of a case file: where, what, and what to do about it.
//!
//! A [`Faults`] list collects everything that is wrong with a file, so that one run tells the user all of it. Each
//! fault is shown in the manner of a compiler: path, line, column, the line itself, the field, and a hint.

use std::cell::{Cell, RefCell};
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

/// Most faults of a file that are kept and told; the others are counted.
pub const MAX_FAULTS: usize = 100;
/// Longest line that is shown beside a fault [bytes].
const LONGEST_LINE: usize = 2000;

/// A place in the text, in bytes.
pub type Span = Range<usize>;

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Where in the text, in bytes.
    pub span: Span,
    /// Path of the field, such as `medium.pores.radius`; empty for the file as a whole.
    pub field: String,
    /// What is wrong, with value and unit.
    pub message: String,
    /// What to do.
    pub hint: Option<String>,
}

impl Fault {
    /// A fault without a hint.
    pub fn new(span: Span, message: impl Into<String>) -> Self {
        Self { span, field: String::new(), message: message.into(), hint: None }
    }

    /// The same fault with a hint.
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
}

/// Collects faults from anywhere in the reading of a file: the first [`MAX_FAULTS`], and how many more there were.
#[derive(Debug, Default)]
pub struct Faults {
    list: RefCell<Vec<Fault>>,
    left_out: Cell<usize>,
}

impl Faults {
    /// Adds a fault.
    pub fn push(&self, fault: Fault) {
        let mut list = self.list.borrow_mut();
        if list.len() < MAX_FAULTS {
            list.push(fault);
        } else {
            self.left_out.set(self.left_out.get() + 1);
        }
    }

    /// True while nothing is wrong.
    pub fn is_empty(&self) -> bool {
        self.list.borrow().is_empty()
    }

    /// Faults that were counted only.
    pub fn left_out(&self) -> usize {
        self.left_out.get()
    }

    /// The faults in the order of the text, each once.
    pub fn into_sorted(self) -> Vec<Fault> {
        let mut list = self.list.into_inner();
        list.sort_by_key(|f| (f.span.start, f.span.end));
        list.dedup();
        list
    }
}

/// A case file that cannot be used: its text and all that is wrong with it.
#[derive(Debug, thiserror::Error)]
#[error("{}", self.render(false))]
pub struct CaseError {
    /// Path as the user gave it.
    pub path: String,
    /// The file's text.
    pub text: String,
    /// What is wrong, in the order of the text: [`MAX_FAULTS`] at most.
    pub faults: Vec<Fault>,
    /// Faults beyond these.
    pub left_out: usize,
}

impl CaseError {
    /// All faults as text; `color` for a terminal.
    pub fn render(&self, color: bool) -> String {
        let renderer = if color { Renderer::styled() } else { Renderer::plain() };
        let mut out: Vec<String> = self.faults.iter().map(|f| self.render_one(&renderer, f)).collect();
        let (n, first) = match self.left_out {
            0 => (self.faults.len(), ""),
            more => (self.faults.len() + more, ", the first of them shown"),
        };
        let s = if n == 1 { "" } else { "s" };
        out.push(format!("{}: {n} fault{s} found{first}; nothing was run\n", self.path));
        out.join("\n")
    }

    fn render_one(&self, renderer: &Renderer, fault: &Fault) -> String {
        let title = match fault.field.as_str() {
            "" => fault.message.clone(),
            field => format!("{field}: {}", fault.message),
        };
        let span = self.clamp(&fault.span);
        let title = Level::ERROR.primary_title(title);
        let mut group: Group<'_> = if self.text.is_empty() {
            title.element(Origin::path(self.path.as_str()))
        } else if self.line_is_long(span.start) {
            let (line, column) = self.line_and_column(span.start);
            title.element(Origin::path(self.path.as_str()).line(line).char_column(column))
        } else {
            let snippet = Snippet::source(self.text.as_str()).path(self.path.as_str()).line_start(1);
            title.element(snippet.annotation(AnnotationKind::Primary.span(span)))
        };
        if let Some(hint) = &fault.hint {
            group = group.element(Level::HELP.with_name("hint").message(hint.as_str()));
        }
        let mut text = renderer.render(&[group]).to_string();
        text.push('\n');
        text
    }

    /// True where the line that a place stands in is too long to be shown.
    fn line_is_long(&self, at: usize) -> bool {
        let begin = self.text[..at].rfind('\n').map_or(0, |k| k + 1);
        let end = self.text[at..].find('\n').map_or(self.text.len(), |k| at + k);
        end - begin > LONGEST_LINE
    }

    /// A span inside the text, on character boundaries.
    fn clamp(&self, span: &Span) -> Span {
        let floor = |mut at: usize| {
            at = at.min(self.text.len());
            while !self.text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        floor(span.start)..floor(span.end.max(span.start))
    }

    /// Line and column, from 1, of a byte offset.
    pub fn line_and_column(&self, at: usize) -> (usize, usize) {
        let before = &self.text[..self.clamp(&(at..at)).start];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
    }
}

/// The name in `names` that `word` was probably meant to be.
pub fn nearest<'n>(word: &str, names: &[&'n str]) -> Option<&'n str> {
    let score = |name: &str| strsim::jaro_winkler(&word.to_lowercase(), &name.to_lowercase());
    let best = names.iter().copied().max_by(|a, b| score(a).total_cmp(&score(b)))?;
    (score(best) > 0.75).then_some(best)
}

/// A hint from a list of names: the nearest one, or all of them.
pub fn name_hint(word: &str, names: &[&str]) -> String {
    match nearest(word, names) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("one of {}", backticked(names)),
    }
}

/// Names in backticks, separated by commas.
pub fn backticked(names: &[&str]) -> String {
    names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_shown_with_path_line_column_field_and_hint() {
        let error = CaseError {
            path: "case.ron".into(),
            text: "(\n  µ: 1,\n  cell: \"20 GPa\",\n)".into(),
            faults: vec![Fault {
                span: 19..27,
                field: "medium.cell".into(),
                message: "`GPa` is a pressure".into(),
                hint: Some("such as \"20 um\"".into()),
            }],
            left_out: 0,
        };
        let text = error.render(false);
        for part in [
            "error: medium.cell: `GPa` is a pressure",
            "case.ron:3:9",
            "^^^^^^^^",
            "hint: such as",
            "1 fault found",
        ] {
            assert!(text.contains(part), "{part} is missing in\n{text}");
        }
        assert_eq!(error.line_and_column(19), (3, 9));
    }

    #[test]
    fn spans_outside_the_text_are_drawn_at_its_end() {
        let faults = vec![Fault::new(2..99, "cut")];
        let error = CaseError { path: "a".into(), text: "(µ".into(), faults, left_out: 0 };
        assert!(error.render(true).contains("cut"));
    }

    #[test]
    fn what_is_told_of_many_faults_and_of_long_lines_is_bounded() {
        let faults = Faults::default();
        (0..1000).for_each(|k| faults.push(Fault::new(k..k + 1, format!("fault {k}"))));
        let (left_out, text) = (faults.left_out(), "µ".repeat(100_000));
        let error = CaseError { path: "a".into(), text, faults: faults.into_sorted(), left_out };
        let told = error.render(false);
        assert!(told.contains("fault 99") && !told.contains("fault 100"), "{told}");
        assert!(told.contains("1000 faults found, the first of them shown"), "{told}");
        assert!(told.contains("a:1:50") && told.len() < 10_000, "{told}");
    }

    #[test]
    fn nearest_name_is_found_and_nonsense_is_not() {
        assert_eq!(nearest("porosty", &["cell", "porosity"]), Some("porosity"));
        assert_eq!(nearest("xyzzy", &["cell", "porosity"]), None);
    }
}
