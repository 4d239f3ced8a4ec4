//! Where an axis has ticks and what they say.

/// The ticks of one axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ticks {
    /// Values and their words.
    pub major: Vec<(f64, String)>,
    /// Values without words.
    pub minor: Vec<f64>,
    /// Power of ten that all words are to be multiplied by, if any.
    pub exponent: Option<i32>,
}

impl Ticks {
    /// About `wanted` ticks with words in the range.
    pub fn new(range: (f64, f64), log: bool, wanted: usize) -> Self {
        let wanted = wanted.max(2);
        if log {
            return logarithmic(range, wanted);
        }
        // A short axis can fall between its round numbers: one tick alone gives no scale.
        let mut tries = (wanted..wanted + 4).map(|wanted| linear(range, wanted));
        tries.find(|ticks| ticks.major.len() > 1).unwrap_or_else(|| linear(range, wanted))
    }

    /// Ticks with words at given values.
    pub fn at(values: &[f64]) -> Self {
        let major = values.iter().map(|&value| (value, signed(&value.to_string()))).collect();
        Self { major, minor: Vec::new(), exponent: None }
    }
}

fn linear((low, high): (f64, f64), wanted: usize) -> Ticks {
    let (step, n_parts) = nice_step((high - low) / wanted as f64);
    let exponent = common_exponent(low.abs().max(high.abs()));
    let unit = 10f64.powi(exponent.unwrap_or(0));
    let n_decimals = (-(step / unit).log10().floor()).max(0.0) as usize;
    let major = multiples(step, low, high)
        .map(|value| (value, signed(&format!("{:.n_decimals$}", value / unit))))
        .collect();
    Ticks { major, minor: multiples(step / f64::from(n_parts), low, high).collect(), exponent }
}

/// The next of 1, 2, 5 times a power of ten above `raw`, and into how many parts minor ticks divide it.
fn nice_step(raw: f64) -> (f64, u32) {
    let decade = 10f64.powf(raw.log10().floor());
    let (factor, n_parts) = match raw / decade {
        ratio if ratio <= 1.0 + 1e-9 => (1.0, 5),
        ratio if ratio <= 2.0 + 1e-9 => (2.0, 4),
        ratio if ratio <= 5.0 + 1e-9 => (5.0, 5),
        _ => (10.0, 5),
    };
    (factor * decade, n_parts)
}

/// More ticks than any axis has: an end to ranges so narrow or tiny that the step rounds to nothing.
const MOST: usize = 500;

fn multiples(step: f64, low: f64, high: f64) -> impl Iterator<Item = f64> {
    let slack = 1e-9;
    let (first, last) = ((low / step - slack).ceil() as i64, (high / step + slack).floor() as i64);
    (first..=last).take(MOST).map(move |k| k as f64 * step)
}

/// Long or tiny numbers are written with a common power of ten, a multiple of three.
fn common_exponent(size: f64) -> Option<i32> {
    let exponent = size.log10().floor() as i32;
    (size > 0.0 && !(-2..5).contains(&exponent)).then(|| 3 * exponent.div_euclid(3))
}

/// The number with a minus sign as wide as a plus, and none before zero.
fn signed(number: &str) -> String {
    match number.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => number.to_owned(),
    }
}

fn logarithmic(range: (f64, f64), wanted: usize) -> Ticks {
    let leads: [&[u32]; 3] = [&[1], &[1, 2, 5], &[1, 2, 3, 4, 5, 6, 7, 8, 9]];
    let chosen = leads.iter().map(|lead| in_decades(range, lead)).find(|values| values.len() >= 3);
    let Some(values) = chosen else { return linear(range, wanted) };
    let every = values.len().div_ceil(2 * wanted).max(1);
    let plain = range.0 >= 0.99e-3 && range.1 <= 1.01e5;
    let major: Vec<_> =
        values.into_iter().step_by(every).map(|value| (value, logarithmic_label(value, plain))).collect();
    let minor = in_decades(range, &[1, 2, 3, 4, 5, 6, 7, 8, 9]);
    Ticks { major, minor, exponent: None }
}

/// The values `lead · 10^k` in the range, in order.
fn in_decades((low, high): (f64, f64), leads: &[u32]) -> Vec<f64> {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let within = |value: &f64| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(value);
    (first..=last)
        .flat_map(|k| leads.iter().map(move |&lead| f64::from(lead) * 10f64.powi(k)))
        .filter(within)
        .collect()
}

fn logarithmic_label(value: f64, plain: bool) -> String {
    let exponent = (value.log10() + 1e-9).floor();
    let lead = (value / 10f64.powf(exponent)).round();
    if plain {
        let n_decimals = (-exponent).max(0.0) as usize;
        format!("{value:.n_decimals$}")
    } else if lead == 1.0 {
        format!("10^{{{}}}", signed(&exponent.to_string()))
    } else {
        format!("{lead}×10^{{{}}}", signed(&exponent.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(range: (f64, f64), log: bool, wanted: usize) -> Vec<String> {
        Ticks::new(range, log, wanted).major.into_iter().map(|(_, word)| word).collect()
    }

    #[test]
    fn linear_ticks_are_round() {
        assert_eq!(words((0.0, 300.0), false, 6), ["0", "50", "100", "150", "200", "250", "300"]);
        assert_eq!(words((-0.3, 0.31), false, 4), ["−0.2", "0.0", "0.2"]);
        assert_eq!(words((-1.0, 1.0), false, 3), ["−1", "0", "1"]);
    }

    #[test]
    fn a_short_axis_has_two_numbers() {
        assert_eq!(words((-9.99, 9.99), false, 2), ["−5", "0", "5"]);
    }

    #[test]
    fn long_numbers_share_a_power_of_ten() {
        let ticks = Ticks::new((0.0, 2.0e9), false, 4);
        assert_eq!(ticks.exponent, Some(9));
        assert_eq!(ticks.major[1].1, "0.5");
        assert_eq!(Ticks::new((0.0, 4.0e-6), false, 4).exponent, Some(-6));
        assert_eq!(Ticks::new((0.0, 0.05), false, 4).exponent, None);
    }

    #[test]
    fn logarithmic_ticks_fit_short_and_long_ranges() {
        assert_eq!(words((90.0, 1700.0), true, 6), ["100", "200", "500", "1000"]);
        assert_eq!(words((1e-5, 1.0), true, 6)[0], "10^{−5}");
        assert_eq!(words((2.0e-6, 9.0e-6), true, 6).len(), 8);
        assert_eq!(words((0.01, 0.2), true, 6), ["0.01", "0.02", "0.05", "0.1", "0.2"]);
        assert!(words((1.01, 1.02), true, 5).len() >= 3);
    }

    #[test]
    fn ranges_at_the_end_of_the_numbers_come_to_an_end() {
        for range in [(0.0, 5e-324), (1.0, 1.0 + f64::EPSILON), (-f64::MAX, f64::MAX)] {
            assert!(Ticks::new(range, false, 5).major.len() <= MOST);
        }
    }

    #[test]
    fn long_logarithmic_ranges_are_thinned() {
        assert!(words((1e-30, 1e30), true, 6).len() <= 12);
    }
}
