//! Checks of single fields: ranges, defaults, required fields. Each notes its fault.

use crate::fault::{Fault, Faults, Span};
use crate::field::Field;
use crate::units::{Count, Kind, Number, Quantity, show, significant};

/// Checks of single fields and groups. A value that does not pass is `None`, and its fault is noted.
pub struct Checker<'f> {
    /// Where faults are noted.
    pub faults: &'f Faults,
}

impl Checker<'_> {
    /// Notes a fault with a hint.
    pub fn refuse(&self, span: Span, message: String, hint: &str) {
        self.faults.push(Fault::new(span, message).hint(hint));
    }

    /// A group that may be absent: then all its fields have their defaults.
    pub fn group<S: Default, T>(&self, field: &Field<S>, read: impl Fn(&S) -> Option<T>) -> Option<T> {
        match field {
            Field::Absent => read(&S::default()),
            Field::Bad(_) => None,
            Field::Good(group, _) => read(group),
        }
    }

    /// A quantity within [low, high], SI.
    pub fn quantity<K: Kind>(&self, field: &Field<Quantity<K>>, low: f64, high: f64) -> Option<f64> {
        let Field::Good(value, span) = field else { return None };
        if (low..=high).contains(&value.si) {
            return Some(value.si);
        }
        let message = format!("{} is out of range", show::<K>(value.si));
        self.refuse(span.clone(), message, &format!("from {} to {}", show::<K>(low), show::<K>(high)));
        None
    }

    /// A required quantity within [low, high], SI.
    pub fn needed<K: Kind>(
        &self,
        field: &Field<Quantity<K>>,
        name: &str,
        group: &Span,
        low: f64,
        high: f64,
    ) -> Option<f64> {
        field.required(name, group, self.faults);
        self.quantity(field, low, high)
    }

    /// A plain number within [low, high], or the default.
    pub fn number(&self, field: &Field<Number>, default: f64, low: f64, high: f64) -> Option<f64> {
        let Field::Good(Number(value), span) = field else {
            return matches!(field, Field::Absent).then_some(default);
        };
        if (low..=high).contains(value) {
            return Some(*value);
        }
        let hint = format!(
            "from {} to {}; {} if left out",
            significant(low),
            significant(high),
            significant(default)
        );
        self.refuse(span.clone(), format!("{} is out of range", significant(*value)), &hint);
        None
    }

    /// A plain number within [low, high], if one is given.
    pub fn number_if_given(&self, field: &Field<Number>, low: f64, high: f64) -> Option<Option<f64>> {
        let Field::Good(Number(value), span) = field else {
            return matches!(field, Field::Absent).then_some(None);
        };
        if (low..=high).contains(value) {
            return Some(Some(*value));
        }
        let hint = format!("from {} to {}, or left out", significant(low), significant(high));
        self.refuse(span.clone(), format!("{} is out of range", significant(*value)), &hint);
        None
    }

    /// A whole number within [low, high], or the default.
    pub fn count(&self, field: &Field<Count>, default: u64, low: u64, high: u64) -> Option<usize> {
        let Field::Good(Count(value), span) = field else {
            return matches!(field, Field::Absent).then_some(default as usize);
        };
        if (low..=high).contains(value) {
            return Some(*value as usize);
        }
        self.refuse(span.clone(), format!("{value} is out of range"), &format!("from {low} to {high}"));
        None
    }

    /// The number of the format that the file is written in; a file that names none is of the first.
    ///
    /// A newer one than `newest` is refused: it may say things that this program knows nothing of. What an older one
    /// means is the caller's to know.
    pub fn format(&self, field: &Field<Count>, newest: u64) -> Option<u64> {
        let Field::Good(Count(format), span) = field else {
            return matches!(field, Field::Absent).then_some(1);
        };
        if (1..=newest).contains(format) {
            return Some(*format);
        }
        let message = format!("the file is of format {format}; this program reads formats up to {newest}");
        let hint = match format {
            0 => "the first format is 1, and may be left out",
            _ => "a newer version of this program reads it",
        };
        self.refuse(span.clone(), message, hint);
        None
    }

    /// A choice, or the default.
    pub fn choice<T: Copy>(&self, field: &Field<T>, default: T) -> Option<T> {
        match field {
            Field::Absent => Some(default),
            Field::Bad(_) => None,
            Field::Good(value, _) => Some(*value),
        }
    }
}
