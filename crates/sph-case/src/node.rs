//! The tree of a case file: values with their places in the text.

use std::borrow::Cow;

use crate::fault::Span;

/// Characters of a text that are shown when it stands at the wrong place.
const LONGEST_SHOWN: usize = 60;

/// A value and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Place in the text, in bytes.
    pub span: Span,
    /// What stands there.
    pub value: Value,
}

/// What can stand in a case file.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `true`, `false`.
    Bool(bool),
    /// `12`, fits into 64 bits.
    Integer(i64),
    /// `1.35`; also `NaN` and `inf`, which every field refuses.
    Number(f64),
    /// `"20 um"`.
    Text(String),
    /// `Square`.
    Name(String),
    /// `(cell: …)` or `Square(radius: …)`.
    Struct(Option<String>, Vec<Entry>),
    /// `Library("copper")`.
    Tuple(Option<String>, Vec<Node>),
    /// `[…]`.
    List(Vec<Node>),
    /// Could not be read; the fault is noted.
    Unreadable,
}

/// `key: value` in a struct.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Name of the field.
    pub key: String,
    /// Place of the name.
    pub key_span: Span,
    /// Value of the field.
    pub node: Node,
}

impl Value {
    /// The value as a reader would call it.
    pub fn describe(&self) -> String {
        match self {
            Value::Bool(b) => format!("`{b}`"),
            Value::Integer(i) => format!("the number {i}"),
            Value::Number(x) => format!("the number {x}"),
            Value::Text(s) => format!("the text {:?}", short(s)),
            Value::Name(n) => format!("`{}`", short(n)),
            Value::Struct(Some(n), _) | Value::Tuple(Some(n), _) => format!("`{}(…)`", short(n)),
            Value::Struct(None, _) => "a group of fields `(…: …)`".into(),
            Value::Tuple(None, _) => "a group `(…)`".into(),
            Value::List(_) => "a list `[…]`".into(),
            Value::Unreadable => "something unreadable".into(),
        }
    }
}

/// A text, or its beginning if it is long.
fn short(text: &str) -> Cow<'_, str> {
    match text.char_indices().nth(LONGEST_SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]).into(),
        None => text.into(),
    }
}

/// Path of the field that stands at `span`, such as `medium.pores.radius` or `points[2]`.
pub fn path_to(node: &Node, span: &Span) -> String {
    let holds = |outer: &Span| outer.start <= span.start && span.end <= outer.end;
    let join = |head: String, tail: String| match tail.as_str() {
        "" => head,
        t if t.starts_with('[') => head + t,
        _ => head + "." + &tail,
    };
    match &node.value {
        Value::Struct(_, entries) => entries
            .iter()
            .find(|e| holds(&(e.key_span.start..e.node.span.end)))
            .map(|e| join(e.key.clone(), path_to(&e.node, span)))
            .unwrap_or_default(),
        Value::List(items) => items
            .iter()
            .position(|i| holds(&i.span))
            .map(|k| join(format!("[{k}]"), path_to(&items[k], span)))
            .unwrap_or_default(),
        Value::Tuple(_, items) => {
            items.iter().find(|i| holds(&i.span)).map_or(String::new(), |i| path_to(i, span))
        }
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::Faults;
    use crate::syntax::parse;

    #[test]
    fn the_path_of_a_place_is_found() {
        let text = "(medium: (pores: Square(radius: \"4 um\")), points: [1, 2])";
        let node = parse(text, "", &Faults::default()).unwrap();
        let at = |part: &str| text.find(part).map(|i| i..i + part.len()).unwrap();
        assert_eq!(path_to(&node, &at("\"4 um\"")), "medium.pores.radius");
        assert_eq!(path_to(&node, &at("2")), "points[1]");
    }
}
