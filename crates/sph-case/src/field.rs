//! A field of a case file, with its place.

use std::fmt;

use serde::Deserialize;
use serde::de::{self, Deserializer, Visitor};

use crate::fault::{Fault, Faults, Span};

/// Name by which [`Field`] makes itself known to the deserializer.
pub(super) const FIELD: &str = "$sph_case::Field";

/// A field of the case file: absent, refused (the fault is noted), or read, with its place.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Field<T> {
    /// Not in the file.
    #[default]
    Absent,
    /// In the file, but refused; the fault is noted.
    Bad(Span),
    /// Read.
    Good(T, Span),
}

impl<T> Field<T> {
    /// The value, if it was read.
    pub fn get(&self) -> Option<&T> {
        match self {
            Field::Good(value, _) => Some(value),
            _ => None,
        }
    }

    /// Place in the text, if it is there.
    pub fn span(&self) -> Option<Span> {
        match self {
            Field::Absent => None,
            Field::Bad(span) | Field::Good(_, span) => Some(span.clone()),
        }
    }

    /// The value; an absent field is a fault at the place of its group.
    pub fn required(&self, name: &str, group: &Span, faults: &Faults) -> Option<&T> {
        if matches!(self, Field::Absent) {
            let end = group.end.saturating_sub(1).max(group.start)..group.end;
            faults.push(
                Fault::new(end, format!("the field `{name}` is missing"))
                    .hint(format!("add `{name}: …` here")),
            );
        }
        self.get()
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Field<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_newtype_struct(FIELD, FieldVisitor(std::marker::PhantomData))
    }
}

struct FieldVisitor<T>(std::marker::PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for FieldVisitor<T> {
    type Value = Field<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a field")
    }

    fn visit_seq<A: de::SeqAccess<'de>>(self, mut access: A) -> Result<Field<T>, A::Error> {
        let mut bound = || access.next_element::<u64>().map(|b| b.unwrap_or(0) as usize);
        let span = bound()?..bound()?;
        Ok(match access.next_element::<T>()? {
            Some(value) => Field::Good(value, span),
            None => Field::Bad(span),
        })
    }
}
