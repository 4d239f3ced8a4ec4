//! Quantities with units: `"4.06 um"`, `"0.35 GPa"`, `"100 m/s"` → SI.
//!
//! A quantity is written as a text of number and unit. A unit of another kind is named as such; a bare number is
//! refused, because nothing tells its unit. NaN and infinities are refused everywhere.

use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::{self, Deserializer, Visitor};

use crate::fault::nearest;
use crate::tree::HINT;

/// A kind of quantity with its units.
pub trait Kind: Copy + fmt::Debug + PartialEq + 'static {
    /// What it is called: `length`.
    const NAME: &'static str;
    /// An example of its spelling: `"20 um"`.
    const EXAMPLE: &'static str;
    /// Units with their size in SI; the first is the SI unit.
    const UNITS: &'static [(&'static str, f64)];
}

macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident, $name:literal, $example:literal, [$(($unit:literal, $size:expr)),*];)*) => {
        $($(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $kind;
        impl Kind for $kind {
            const NAME: &'static str = $name;
            const EXAMPLE: &'static str = $example;
            const UNITS: &'static [(&'static str, f64)] = &[$(($unit, $size)),*];
        })*
        /// Name and units of every kind.
        const KINDS: &[(&str, &[(&str, f64)])] = &[$(($kind::NAME, $kind::UNITS)),*];
    };
}

kinds! {
    /// Lengths [m].
    LengthKind, "length", "\"20 um\"",
        [("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6), ("µm", 1e-6), ("μm", 1e-6), ("nm", 1e-9)];
    /// Pressures and stresses [Pa].
    PressureKind, "pressure", "\"0.35 GPa\"",
        [("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9), ("bar", 1e5), ("kbar", 1e8), ("Mbar", 1e11)];
    /// Velocities [m/s].
    VelocityKind, "velocity", "\"100 m/s\"", [("m/s", 1.0), ("km/s", 1e3), ("mm/us", 1e3), ("cm/us", 1e4)];
    /// Mass densities [kg/m³].
    DensityKind, "density", "\"8960 kg/m3\"",
        [("kg/m3", 1.0), ("kg/m^3", 1.0), ("kg/m³", 1.0), ("g/cm3", 1e3), ("g/cm^3", 1e3), ("g/cm³", 1e3), ("g/cc", 1e3)];
    /// Times [s].
    TimeKind, "time", "\"1.5 us\"", [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("µs", 1e-6), ("μs", 1e-6), ("ns", 1e-9)];
    /// Dynamic viscosities [Pa s].
    ViscosityKind, "viscosity", "\"10 Pa s\"", [("Pa s", 1.0), ("Pa*s", 1.0), ("poise", 0.1), ("kpoise", 100.0)];
}

/// A quantity of a kind, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity<K: Kind> {
    /// Value in SI.
    pub si: f64,
    kind: PhantomData<K>,
}

/// A length [m].
pub type Length = Quantity<LengthKind>;
/// A pressure or stress [Pa].
pub type Pressure = Quantity<PressureKind>;
/// A velocity [m/s].
pub type Velocity = Quantity<VelocityKind>;
/// A mass density [kg/m³].
pub type Density = Quantity<DensityKind>;
/// A dynamic viscosity [Pa s].
pub type Viscosity = Quantity<ViscosityKind>;
/// A time [s].
pub type Time = Quantity<TimeKind>;

impl<K: Kind> Quantity<K> {
    /// A quantity of this value in SI.
    pub fn from_si(si: f64) -> Self {
        Self { si, kind: PhantomData }
    }

    /// Reads number and unit.
    ///
    /// # Errors
    /// In words, with a hint: no number in front, a unit that is missing, unknown or of another kind, a value that is not finite.
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let split = text
            .char_indices()
            .find(|&(i, c)| c.is_whitespace() || (c.is_alphabetic() && !is_exponent(text, i)) || c == 'µ')
            .map_or(text.len(), |(i, _)| i);
        let (number, unit) = (text[..split].trim(), text[split..].trim());
        let value: f64 = number
            .parse()
            .map_err(|_| format!("{text:?} has no number in front{HINT}such as {}", K::EXAMPLE))?;
        if unit.is_empty() {
            return Err(format!("{text:?} has no unit{HINT}a {} is written such as {}", K::NAME, K::EXAMPLE));
        }
        let size = unit_size::<K>(unit)?;
        let si = value * size;
        if !si.is_finite() {
            return Err(format!("{text:?} is not a finite number"));
        }
        Ok(Self { si, kind: PhantomData })
    }
}

/// True at the `e` of `1e-6`.
fn is_exponent(text: &str, at: usize) -> bool {
    let mut next = text[at..].chars();
    matches!(next.next(), Some('e' | 'E'))
        && at > 0
        && next.next().is_some_and(|c| c.is_ascii_digit() || c == '-' || c == '+')
}

fn unit_size<K: Kind>(unit: &str) -> Result<f64, String> {
    if let Some((_, size)) = K::UNITS.iter().find(|(name, _)| *name == unit) {
        return Ok(*size);
    }
    let units: Vec<&str> = K::UNITS.iter().map(|u| u.0).collect();
    let list = units.iter().filter(|u| u.is_ascii()).copied().collect::<Vec<_>>().join(", ");
    if let Some((kind, _)) = KINDS.iter().find(|(_, units)| units.iter().any(|u| u.0 == unit)) {
        return Err(format!(
            "`{unit}` is a unit of {kind}, but this field is a {}{HINT}units: {list}",
            K::NAME
        ));
    }
    let meant = nearest(unit, &units).map_or(String::new(), |u| format!("did you mean `{u}`? "));
    Err(format!("the unit `{unit}` is not known{HINT}{meant}units of {}: {list}", K::NAME))
}

impl<'de, K: Kind> Deserialize<'de> for Quantity<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(QuantityVisitor(PhantomData))
    }
}

struct QuantityVisitor<K>(PhantomData<K>);

impl<K: Kind> QuantityVisitor<K> {
    fn bare<E: de::Error>(number: impl fmt::Display) -> E {
        let unit = K::UNITS[0].0;
        E::custom(format!(
            "the number {number} has no unit{HINT}a {} is written such as {}; SI: \"{number} {unit}\"",
            K::NAME,
            K::EXAMPLE
        ))
    }
}

impl<K: Kind> Visitor<'_> for QuantityVisitor<K> {
    type Value = Quantity<K>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a {} such as {}", K::NAME, K::EXAMPLE)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Quantity<K>, E> {
        Quantity::parse(text).map_err(E::custom)
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<Quantity<K>, E> {
        Err(Self::bare(number))
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<Quantity<K>, E> {
        Err(Self::bare(number))
    }
}

/// A value in the unit that reads best: 2e-5 m as `20 um`, 1e-10 m as `0.1 nm`.
pub fn show<K: Kind>(si: f64) -> String {
    let fits = |size: f64| {
        size.log10().round() as i64 % 3 == 0 && (1.0 - 1e-9..1e3 - 1e-6).contains(&(si.abs() / size))
    };
    let smallest = K::UNITS.iter().min_by(|a, b| a.1.total_cmp(&b.1)).filter(|u| si != 0.0 && si.abs() < u.1);
    let fitting = K::UNITS.iter().find(|u| u.0.is_ascii() && fits(u.1));
    let best = fitting.or(smallest).unwrap_or(&K::UNITS[0]);
    format!("{} {}", significant(si / best.1), best.0)
}

/// Six significant digits, without trailing zeros.
pub fn significant(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    format!("{rounded}")
}

/// A whole number, not negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Count(pub u64);

impl<'de> Deserialize<'de> for Count {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(CountVisitor).map(Count)
    }
}

struct CountVisitor;

impl Visitor<'_> for CountVisitor {
    type Value = u64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a whole number such as 12")
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<u64, E> {
        u64::try_from(number).map_err(|_| E::custom(format!("{number} is negative")))
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<u64, E> {
        Err(E::custom(format!("{number} is not a whole number of 64 bits")))
    }
}

/// A plain finite number, without a unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number(pub f64);

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberVisitor).map(Number)
    }
}

struct NumberVisitor;

impl Visitor<'_> for NumberVisitor {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a plain number without a unit")
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<f64, E> {
        Ok(number as f64)
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<f64, E> {
        if number.is_finite() {
            Ok(number)
        } else {
            Err(E::custom(format!("{number} is not a finite number")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_read_into_si() {
        for (text, si) in [
            ("4.06 um", 4.06e-6),
            ("4.06µm", 4.06e-6),
            (" 1e-3 mm ", 1e-6),
            ("2.5E2nm", 2.5e-7),
            ("1 m", 1.0),
        ] {
            assert!((Length::parse(text).unwrap().si / si - 1.0).abs() < 1e-15, "{text}");
        }
        assert_eq!(Velocity::parse("1.9 km/s").unwrap().si, 1900.0);
        assert_eq!(Pressure::parse("3.5 kbar").unwrap().si, 3.5e8);
        assert_eq!(Density::parse("8.96 g/cm3").unwrap().si, 8960.0);
    }

    #[test]
    fn what_does_not_fit_is_named() {
        for (text, part) in [
            ("20 GPa", "`GPa` is a unit of pressure, but this field is a length"),
            ("20", "has no unit"),
            ("um", "has no number"),
            ("20 umm", "did you mean `um`?"),
            ("1e400 m", "finite"),
            ("NaN m", "no number"),
            ("", "no number"),
            ("20 qqq", "units of length: m, cm, mm, um, nm"),
        ] {
            let message = Length::parse(text).unwrap_err();
            assert!(message.contains(part), "{text}: {message}");
        }
    }

    #[test]
    fn values_are_shown_in_the_unit_that_reads_best() {
        assert_eq!(show::<LengthKind>(2e-5), "20 um");
        assert_eq!(show::<LengthKind>(4.06e-6), "4.06 um");
        assert_eq!(show::<LengthKind>(1e-10), "0.1 nm");
        assert_eq!(show::<LengthKind>(1e-3), "1 mm");
        assert_eq!(show::<PressureKind>(0.35e9), "350 MPa");
        assert_eq!(show::<VelocityKind>(-5.0), "-5 m/s");
        assert_eq!(show::<TimeKind>(0.0), "0 s");
    }
}
