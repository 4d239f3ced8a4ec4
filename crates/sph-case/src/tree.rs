//! Tree of values → the schema's types, through serde.
//!
//! A serde deserializer over [`Node`]. It knows what serde's derived code knows (names of fields and variants) and the
//! place of every value, so it can name the nearest field for a misspelt one, and it goes on after a fault: a field
//! of type [`Field`](crate::field::Field) that cannot be read becomes `Bad` after its fault was noted, and the others are read.

use std::fmt;

use serde::Deserialize;
use serde::de::{self, DeserializeSeed, Deserializer, IntoDeserializer, Visitor};

use crate::fault::{Fault, Faults, Span, backticked, name_hint};
use crate::field::FIELD;
use crate::node::{Entry, Node, Value};

/// Why a value was refused. `hint` follows the message after `; hint: ` when it passes through serde.
#[derive(Debug)]
pub struct TreeError {
    message: String,
    span: Option<Span>,
}

/// Between message and hint in an error's text.
pub const HINT: &str = "; hint: ";

impl fmt::Display for TreeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for TreeError {}

impl de::Error for TreeError {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self { message: message.to_string(), span: None }
    }
}

impl TreeError {
    fn at(span: &Span, message: String) -> Self {
        Self { message, span: Some(span.clone()) }
    }

    fn into_fault(self, default: &Span) -> Fault {
        let span = self.span.unwrap_or_else(|| default.clone());
        match self.message.split_once(HINT) {
            Some((message, hint)) => Fault::new(span, message).hint(hint),
            None => Fault::new(span, self.message),
        }
    }
}

/// Name of the variant that a plain list `[…]` is read as, in enums that have it.
const LIST: &str = "List";

/// Reads a whole tree; faults are noted, `None` when the outermost value does not fit.
pub fn read<T: for<'de> Deserialize<'de>>(node: &Node, faults: &Faults) -> Option<T> {
    T::deserialize(Tree { node, faults, named: false })
        .map_err(|e| faults.push(e.into_fault(&node.span)))
        .ok()
}

/// A node as a serde deserializer. `named`: the name in front of the brackets was a variant and is used up.
#[derive(Clone, Copy)]
struct Tree<'t> {
    node: &'t Node,
    faults: &'t Faults,
    named: bool,
}

impl Tree<'_> {
    fn unexpected(&self, wanted: &dyn fmt::Display) -> TreeError {
        TreeError::at(
            &self.node.span,
            format!("{} stands here; expected {wanted}", self.node.value.describe()),
        )
    }

    /// Notes fields that the struct does not have, and fields given twice; keeps the rest.
    fn known_entries<'t>(&self, entries: &'t [Entry], fields: &[&str]) -> Vec<&'t Entry> {
        let mut seen: Vec<&str> = Vec::new();
        let mut known = Vec::new();
        for entry in entries {
            if !fields.contains(&entry.key.as_str()) {
                let fault =
                    Fault::new(entry.key_span.clone(), format!("there is no field `{}` here", entry.key));
                self.faults.push(fault.hint(name_hint(&entry.key, fields)));
            } else if seen.contains(&entry.key.as_str()) {
                self.faults
                    .push(Fault::new(entry.key_span.clone(), format!("`{}` is given twice", entry.key)));
            } else {
                seen.push(&entry.key);
                known.push(entry);
            }
        }
        known
    }
}

struct Expected<V>(V);

impl<'de, V: Visitor<'de>> fmt::Display for Expected<&V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.expecting(f)
    }
}

impl<'de> Deserializer<'de> for Tree<'_> {
    type Error = TreeError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TreeError> {
        let wanted = Expected(&visitor).to_string();
        let result = match &self.node.value {
            Value::Bool(b) => visitor.visit_bool(*b),
            Value::Integer(i) => visitor.visit_i64(*i),
            Value::Number(x) => visitor.visit_f64(*x),
            Value::Text(s) => visitor.visit_str(s),
            Value::List(items) | Value::Tuple(None, items) => {
                visitor.visit_seq(Items { items: items.iter(), faults: self.faults })
            }
            _ => return Err(self.unexpected(&wanted)),
        };
        result.map_err(|e| match e.message.starts_with("invalid type") {
            true => self.unexpected(&wanted),
            false => TreeError { span: e.span.or(Some(self.node.span.clone())), ..e },
        })
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TreeError> {
        match &self.node.value {
            Value::Name(n) if n == "None" => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        v: V,
    ) -> Result<V::Value, TreeError> {
        if name == FIELD {
            return v.visit_seq(FieldParts { tree: self, next: 0 });
        }
        v.visit_newtype_struct(self)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TreeError> {
        match &self.node.value {
            Value::Struct(name, entries) if self.named || name.as_deref().is_none_or(|n| n == "Case") => {
                let entries = self.known_entries(entries, fields);
                visitor.visit_map(Entries {
                    entries: entries.into_iter(),
                    current: None,
                    faults: self.faults,
                })
            }
            Value::Name(_) if self.named => {
                visitor.visit_map(Entries { entries: vec![].into_iter(), current: None, faults: self.faults })
            }
            Value::Unreadable => Err(TreeError::at(&self.node.span, String::new())),
            _ => Err(self.unexpected(&format!(
                "a group of fields `({}: …)`{HINT}fields: {}",
                fields.first().unwrap_or(&""),
                backticked(fields)
            ))),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TreeError> {
        // A plain list may stand for the variant of that name.
        if matches!(self.node.value, Value::List(_)) && variants.contains(&LIST) {
            return visitor.visit_enum(Choice { tree: self, name: LIST });
        }
        let (Value::Name(name) | Value::Struct(Some(name), _) | Value::Tuple(Some(name), _)) =
            &self.node.value
        else {
            let (lists, names): (Vec<&str>, Vec<&str>) = variants.iter().partition(|v| **v == LIST);
            let list = if lists.is_empty() { "" } else { "a list `[…]`, or " };
            return Err(self.unexpected(&format!("{list}one of {}", backticked(&names))));
        };
        if !variants.contains(&name.as_str()) {
            let span = self.node.span.start..self.node.span.start + name.len();
            return Err(TreeError::at(
                &span,
                format!("`{name}` is not known here{HINT}{}", name_hint(name, variants)),
            ));
        }
        visitor.visit_enum(Choice { tree: self, name })
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct
        seq tuple tuple_struct map identifier ignored_any
    }
}

/// Start, end and value of a [`Field`](crate::field::Field).
struct FieldParts<'t> {
    tree: Tree<'t>,
    next: usize,
}

impl<'de> de::SeqAccess<'de> for FieldParts<'_> {
    type Error = TreeError;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, TreeError> {
        self.next += 1;
        let span = &self.tree.node.span;
        match self.next {
            1 => seed.deserialize((span.start as u64).into_deserializer()).map(Some),
            2 => seed.deserialize((span.end as u64).into_deserializer()).map(Some),
            _ if self.tree.node.value == Value::Unreadable => Ok(None),
            _ => Ok(seed.deserialize(self.tree).map_err(|e| self.tree.faults.push(e.into_fault(span))).ok()),
        }
    }
}

struct Items<'t> {
    items: std::slice::Iter<'t, Node>,
    faults: &'t Faults,
}

impl<'de> de::SeqAccess<'de> for Items<'_> {
    type Error = TreeError;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, TreeError> {
        let faults = self.faults;
        self.items.next().map(|node| seed.deserialize(Tree { node, faults, named: false })).transpose()
    }
}

struct Entries<'t> {
    entries: std::vec::IntoIter<&'t Entry>,
    current: Option<&'t Entry>,
    faults: &'t Faults,
}

impl<'de> de::MapAccess<'de> for Entries<'_> {
    type Error = TreeError;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, TreeError> {
        self.current = self.entries.next();
        self.current.map(|entry| seed.deserialize(entry.key.as_str().into_deserializer())).transpose()
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, TreeError> {
        let entry = self.current.ok_or_else(|| de::Error::custom("a value without a key"))?;
        seed.deserialize(Tree { node: &entry.node, faults: self.faults, named: false })
    }
}

/// A variant of an enum with what stands in its brackets.
struct Choice<'t> {
    tree: Tree<'t>,
    name: &'t str,
}

impl<'de> de::EnumAccess<'de> for Choice<'_> {
    type Error = TreeError;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Self), TreeError> {
        let name: de::value::StrDeserializer<'_, TreeError> = self.name.into_deserializer();
        Ok((seed.deserialize(name)?, self))
    }
}

impl<'de> de::VariantAccess<'de> for Choice<'_> {
    type Error = TreeError;

    fn unit_variant(self) -> Result<(), TreeError> {
        match &self.tree.node.value {
            Value::Name(_) => Ok(()),
            _ => Err(TreeError::at(
                &self.tree.node.span,
                format!("`{0}` takes nothing in brackets{HINT}write `{0}`", self.name),
            )),
        }
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, TreeError> {
        match &self.tree.node.value {
            Value::Tuple(_, items) if items.len() == 1 => {
                seed.deserialize(Tree { node: &items[0], named: false, ..self.tree })
            }
            Value::Tuple(_, items) => Err(TreeError::at(
                &items[1].span,
                format!("`{}` takes one value, not {}", self.name, items.len()),
            )),
            _ => seed.deserialize(Tree { named: true, ..self.tree }),
        }
    }

    fn tuple_variant<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value, TreeError> {
        match &self.tree.node.value {
            // A visitor takes what it needs and leaves the rest unread: what is too much must be told here.
            Value::Tuple(_, items) if items.len() > len => Err(TreeError::at(
                &items[len].span,
                format!("`{}` takes {len} values, not {}", self.name, items.len()),
            )),
            Value::Tuple(_, items) => {
                visitor.visit_seq(Items { items: items.iter(), faults: self.tree.faults })
            }
            _ => Err(self.tree.unexpected(&format!("values in brackets behind `{}`", self.name))),
        }
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TreeError> {
        Tree { named: true, ..self.tree }.deserialize_struct("", fields, visitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Field;
    use crate::syntax;

    #[derive(Debug, Default, Deserialize, PartialEq)]
    #[serde(default, deny_unknown_fields)]
    struct Inner {
        count: Field<u32>,
        choice: Field<Shape>,
    }

    #[derive(Debug, Deserialize, PartialEq)]
    enum Shape {
        None,
        Round(Round),
        Oval(f64, f64),
    }

    #[derive(Debug, Default, Deserialize, PartialEq)]
    #[serde(default, deny_unknown_fields)]
    struct Round {
        radius: Field<f64>,
    }

    fn faults_of(text: &str) -> Vec<(String, Option<String>)> {
        let faults = Faults::default();
        if let Some(node) = syntax::parse(text, "", &faults) {
            read::<Inner>(&node, &faults);
        }
        faults.into_sorted().into_iter().map(|f| (f.message, f.hint)).collect()
    }

    #[test]
    fn a_good_text_is_read() {
        let faults = Faults::default();
        let node = syntax::parse("(count: 3, choice: Round(radius: 2.5))", "", &faults).unwrap();
        let inner: Inner = read(&node, &faults).unwrap();
        assert!(faults.is_empty());
        assert_eq!(inner.count, Field::Good(3, 8..9));
        let Some(Shape::Round(round)) = inner.choice.get() else { panic!() };
        assert_eq!(round.radius.get(), Some(&2.5));
    }

    #[test]
    fn every_fault_of_a_text_is_found_with_a_hint() {
        let found = faults_of("(count: \"3\", choise: None, choice: Rond(radius: 2))");
        assert_eq!(found.len(), 3, "{found:#?}");
        assert!(found[0].0.contains("the text \"3\" stands here; expected u32"));
        assert_eq!(found[1].1.as_deref(), Some("did you mean `choice`?"));
        assert_eq!(found[2].1.as_deref(), Some("did you mean `Round`?"));
    }

    #[test]
    fn numbers_out_of_range_doubles_and_brackets_too_many_are_told() {
        assert!(faults_of("(count: -1)")[0].0.contains("-1"));
        assert!(faults_of("(count: 1, count: 2)")[0].0.contains("given twice"));
        assert!(faults_of("(choice: None(3))")[0].0.contains("takes nothing in brackets"));
        assert!(faults_of("(choice: Round(radius: 1, diameter: 2))")[0].0.contains("no field `diameter`"));
        assert!(faults_of("(choice: Oval(1, 2))").is_empty());
        assert!(faults_of("(choice: Oval(1, 2, 3))")[0].0.contains("`Oval` takes 2 values, not 3"));
        assert!(!faults_of("(choice: Oval(1))").is_empty());
        assert!(faults_of("5")[0].0.contains("a group of fields"));
    }
}
