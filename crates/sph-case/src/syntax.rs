//! Text of a case file (RON) → tree of values with their places.
//!
//! The tree keeps what serde's data model loses: where each value stands. A part that cannot be read becomes
//! [`Value::Unreadable`] after its fault was noted, and reading goes on behind the next comma or bracket, so that
//! one pass finds all faults. Comments, raw strings and trailing commas are as in RON; maps `{…}` are not used by
//! case files and are refused.

use crate::fault::{Fault, Faults};
use crate::node::{Entry, Node, Value};

/// Deepest nesting that is read: far beyond any case, far below the stack.
const MAX_DEPTH: usize = 64;

/// Reads the whole text; `example` is the hint beside an empty one; `None` when not even the outermost value could be found.
pub fn parse(text: &str, example: &str, faults: &Faults) -> Option<Node> {
    let mut parser = Parser { text, at: 0, depth: 0, unclosed_told: false, faults };
    parser.skip_attributes();
    if parser.peek().is_none() {
        faults.push(Fault::new(0..text.len(), "the file is empty").hint(example));
        return None;
    }
    let node = parser.value();
    parser.skip_space();
    if parser.at < text.len() && node.value != Value::Unreadable {
        faults.push(Fault::new(
            parser.at..text.len().min(parser.at + 1),
            "something follows behind the end of the case",
        ));
    }
    (node.value != Value::Unreadable).then_some(node)
}

struct Parser<'t> {
    text: &'t str,
    at: usize,
    depth: usize,
    unclosed_told: bool,
    faults: &'t Faults,
}

impl Parser<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn eat(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        if found {
            self.at += c.len_utf8();
        }
        found
    }

    fn skip_space(&mut self) {
        loop {
            self.at += self.rest().len() - self.rest().trim_start().len();
            if self.rest().starts_with("//") {
                self.at += self.rest().find('\n').unwrap_or(self.rest().len());
            } else if self.rest().starts_with("/*") {
                self.skip_block_comment();
            } else {
                return;
            }
        }
    }

    fn skip_block_comment(&mut self) {
        let start = self.at;
        let mut open = 0;
        loop {
            if self.rest().starts_with("/*") {
                open += 1;
                self.at += 2;
            } else if self.rest().starts_with("*/") {
                open -= 1;
                self.at += 2;
                if open == 0 {
                    return;
                }
            } else if let Some(c) = self.peek() {
                self.at += c.len_utf8();
            } else {
                return self
                    .faults
                    .push(Fault::new(start..start + 2, "this comment has no end").hint("close it by `*/`"));
            }
        }
    }

    /// `#![enable(implicit_some)]` and the like: allowed, without effect.
    fn skip_attributes(&mut self) {
        self.skip_space();
        while self.rest().starts_with("#![") {
            self.at += self.rest().find(']').map_or(self.rest().len(), |i| i + 1);
            self.skip_space();
        }
    }

    fn fault(&mut self, start: usize, message: impl Into<String>, hint: &str) -> Value {
        let fault = Fault::new(start..self.at.max(start + 1), message);
        self.faults.push(if hint.is_empty() { fault } else { fault.hint(hint) });
        Value::Unreadable
    }

    fn value(&mut self) -> Node {
        self.skip_space();
        let start = self.at;
        let value = match self.peek() {
            Some('"') => self.text_value(),
            Some('r') if self.rest().starts_with("r\"") || self.rest().starts_with("r#") => self.raw_text(),
            Some('[') => self.list(),
            Some('(') => self.group(None),
            Some(c) if c.is_ascii_digit() || matches!(c, '-' | '+' | '.') => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.named(),
            Some(c) => {
                self.at += c.len_utf8();
                self.fault(start, format!("a value was expected here, not `{c}`"), "")
            }
            None => {
                self.fault(start, "the file ends where a value was expected", "a closing bracket is missing")
            }
        };
        Node { span: start..self.at, value }
    }

    fn text_value(&mut self) -> Value {
        let start = self.at;
        self.at += 1;
        let mut out = String::new();
        while let Some(c) = self.peek().filter(|&c| c != '\n') {
            self.at += c.len_utf8();
            match c {
                '"' => return Value::Text(out),
                '\\' => {
                    let backslash = self.at - 1;
                    match self.escape() {
                        Some(c) => out.push(c),
                        None => _ = self.fault(backslash, "this escape is not known", "such as \\\" or \\\\"),
                    }
                }
                c => out.push(c),
            }
        }
        let value = self.fault(start, "this text has no end on its line", "close it by `\"`");
        // The comma at the line's end was meant to stand behind the text.
        let line = self.text[start..self.at].trim_end();
        if line.ends_with(',') {
            self.at = start + line.len() - 1;
        }
        value
    }

    fn escape(&mut self) -> Option<char> {
        let c = self.peek()?;
        self.at += c.len_utf8();
        match c {
            'n' => Some('\n'),
            't' => Some('\t'),
            '\\' | '"' | '\'' => Some(c),
            'u' => {
                let (digits, _) = self.rest().strip_prefix('{')?.split_once('}')?;
                let (code, length) = (u32::from_str_radix(digits, 16).ok()?, digits.len() + 2);
                self.at += length;
                char::from_u32(code)
            }
            _ => None,
        }
    }

    fn raw_text(&mut self) -> Value {
        let start = self.at;
        self.at += 1;
        let hashes = self.rest().len() - self.rest().trim_start_matches('#').len();
        self.at += hashes;
        if !self.eat('"') {
            return self.fault(start, "a raw text opens by r\" or r#\"", "");
        }
        let close = format!("\"{}", "#".repeat(hashes));
        match self.rest().find(&close) {
            Some(end) => {
                let out = self.rest()[..end].to_string();
                self.at += end + close.len();
                Value::Text(out)
            }
            None => self.fault(start, "this raw text has no end", ""),
        }
    }

    fn number(&mut self) -> Value {
        let start = self.at;
        let more = |c: char| c.is_alphanumeric() || matches!(c, '.' | '_' | '-' | '+');
        self.at += self.rest().find(|c| !more(c)).unwrap_or(self.rest().len());
        let word = self.text[start..self.at].replace('_', "");
        if let Some(unit) = self.bare_unit() {
            return self.fault(
                start,
                format!("{word} {unit} stands without quotes"),
                &format!("write \"{word} {unit}\""),
            );
        }
        match (word.parse::<i64>(), word.parse::<f64>()) {
            (Ok(i), _) => Value::Integer(i),
            (_, Ok(x)) => Value::Number(x),
            _ => self.fault(
                start,
                format!("`{word}` is not a number"),
                "a quantity with its unit stands in quotes: \"20 um\"",
            ),
        }
    }

    /// Takes the word that follows a number on the same line, if it is no field name.
    fn bare_unit(&mut self) -> Option<String> {
        let start = self.at;
        self.at += self.rest().len() - self.rest().trim_start_matches(' ').len();
        let is_word = self.at > start && self.peek().is_some_and(char::is_alphabetic) && !self.at_key();
        if !is_word {
            self.at = start;
            return None;
        }
        let from = self.at;
        self.at += self
            .rest()
            .find(|c: char| !c.is_alphanumeric() && !matches!(c, '/' | '^'))
            .unwrap_or(self.rest().len());
        Some(self.text[from..self.at].to_string())
    }

    /// Identifier: a keyword, a bare name, or the name of a group.
    fn named(&mut self) -> Value {
        let start = self.at;
        let name = self.identifier();
        match name.as_str() {
            "true" => return Value::Bool(true),
            "false" => return Value::Bool(false),
            "NaN" => return Value::Number(f64::NAN),
            "inf" => return Value::Number(f64::INFINITY),
            _ => {}
        }
        self.skip_space();
        if self.peek() == Some('(') {
            let value = self.group(Some(name));
            return match value {
                Value::Tuple(Some(some), mut items) if some == "Some" && items.len() == 1 => {
                    items.remove(0).value
                }
                other => other,
            };
        }
        self.at = start + name.len();
        Value::Name(name)
    }

    fn identifier(&mut self) -> String {
        let start = self.at;
        self.at += self.rest().find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(self.rest().len());
        self.text[start..self.at].to_string()
    }

    /// True when `identifier :` stands here.
    fn at_key(&mut self) -> bool {
        let start = self.at;
        let named =
            self.peek().is_some_and(|c| c.is_alphabetic() || c == '_') && !self.identifier().is_empty();
        self.skip_space();
        let found = named && self.peek() == Some(':');
        self.at = start;
        found
    }

    fn enter(&mut self, open: usize) -> bool {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            self.at = self.text.len();
            self.fault(open, "nested too deeply", "");
        }
        self.depth <= MAX_DEPTH
    }

    fn list(&mut self) -> Value {
        let open = self.at;
        self.at += 1;
        let mut items = Vec::new();
        if self.enter(open) {
            self.sequence(open, ']', |parser| items.push(parser.value()));
        }
        self.depth -= 1;
        Value::List(items)
    }

    fn group(&mut self, name: Option<String>) -> Value {
        let open = self.at;
        self.at += 1;
        let (mut entries, mut items) = (Vec::new(), Vec::new());
        if self.enter(open) {
            self.sequence(open, ')', |parser| {
                if parser.at_key() {
                    entries.push(parser.entry());
                } else {
                    items.push(parser.value());
                }
            });
        }
        self.depth -= 1;
        if !items.is_empty() && !entries.is_empty() {
            for item in items.iter().filter(|i| i.value != Value::Unreadable) {
                let fault = Fault::new(
                    item.span.clone(),
                    format!("{} stands here without a field name", item.value.describe()),
                );
                self.faults.push(fault.hint("write `name: value`"));
            }
            items.clear();
        }
        if items.is_empty() { Value::Struct(name, entries) } else { Value::Tuple(name, items) }
    }

    fn entry(&mut self) -> Entry {
        let start = self.at;
        let key = self.identifier();
        let key_span = start..self.at;
        self.skip_space();
        self.eat(':');
        let node = self.value();
        Entry { key, key_span, node }
    }

    /// Items up to `close`, separated by commas; goes on behind the next comma after a fault.
    fn sequence(&mut self, open: usize, close: char, mut item: impl FnMut(&mut Self)) {
        loop {
            self.skip_space();
            if self.eat(close) {
                return;
            }
            match self.peek() {
                None => return self.unclosed(open, close),
                Some(c @ (')' | ']')) => {
                    self.fault(self.at, format!("`{c}` closes nothing; `{close}` was expected"), "");
                    return;
                }
                _ => item(self),
            }
            self.skip_space();
            if self.eat(',') || matches!(self.peek(), None | Some(')' | ']')) {
                continue;
            }
            self.resume();
        }
    }

    fn unclosed(&mut self, open: usize, close: char) {
        if !std::mem::replace(&mut self.unclosed_told, true) {
            self.faults.push(Fault::new(open..open + 1, format!("this bracket is not closed by `{close}`")));
        }
    }

    /// No comma where one must stand: noted; reading goes on at a field name on this level, or behind the comma.
    fn resume(&mut self) {
        let start = self.at;
        self.faults.push(Fault::new(start..start + 1, "a comma is missing before this"));
        if self.at_key() {
            return;
        }
        while let Some(c) = self.peek() {
            match c {
                ')' | ']' => return,
                ',' => {
                    self.at += 1;
                    return;
                }
                '"' => _ = self.text_value(),
                '(' | '[' => _ = self.value(),
                c => self.at += c.len_utf8(),
            }
            self.skip_space();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Option<Node>, Vec<Fault>) {
        let faults = Faults::default();
        let node = parse(text, "", &faults);
        (node, faults.into_sorted())
    }

    #[test]
    fn values_of_all_kinds_are_read_with_their_places() {
        let text = "// head\n#![enable(implicit_some)]\nCase(a: 1, b: -2.5e-3, /* x /* y */ */ c: \"20 µm\", d: [Square, Some(3)], e: Library(\"copper\"), f: true,)";
        let (node, faults) = read(text);
        assert_eq!(faults, []);
        let Value::Struct(Some(name), entries) = node.unwrap().value else { panic!() };
        assert_eq!(name, "Case");
        assert_eq!(entries[0].node.value, Value::Integer(1));
        assert_eq!(entries[1].node.value, Value::Number(-2.5e-3));
        assert_eq!(&text[entries[2].node.span.clone()], "\"20 µm\"");
        let Value::List(items) = &entries[3].node.value else { panic!() };
        assert_eq!((&items[0].value, &items[1].value), (&Value::Name("Square".into()), &Value::Integer(3)));
        assert!(matches!(&entries[4].node.value, Value::Tuple(Some(n), i) if n == "Library" && i.len() == 1));
    }

    #[test]
    fn reading_goes_on_after_a_fault() {
        let (node, faults) = read("(a: 20 um, b: ?, c: \"open\n, d: 4 e: 5)");
        let Some(Node { value: Value::Struct(_, entries), .. }) = node else { panic!("no struct") };
        assert_eq!(faults.len(), 4, "{faults:#?}");
        assert_eq!(entries.last().unwrap().node.value, Value::Integer(5));
    }

    #[test]
    fn escapes_that_do_not_end_or_are_not_known_are_told_and_reading_ends_within_the_text() {
        for text in ["(a: \"\\u{110000", "(a: \"\\u{41", "(a: \"\\u{", "(a: \"\\é\")", "(a: \"\\"] {
            let (_, faults) = read(text);
            assert!(!faults.is_empty(), "{text}");
            assert!(faults.iter().all(|f| text.get(f.span.clone()).is_some()), "{text}: {faults:?}");
        }
        assert!(read("(a: \"\\u{41}\")").1.is_empty());
    }

    #[test]
    fn open_brackets_and_deep_nesting_are_told() {
        assert!(read("(a: [1, 2").1.iter().any(|f| f.message.contains("not closed")));
        assert!(read(&"(".repeat(100_000)).1.iter().any(|f| f.message.contains("nested too deeply")));
        assert!(read("(a: 1]").1[0].message.contains("closes nothing"));
        assert!(read("  // nothing").1[0].message.contains("empty"));
        assert!(read("(a: 1) 2").1[0].message.contains("follows"));
    }
}
