//! How numbers are written: exactly in files, briefly on the terminal.

/// The shortest decimal number that reads back as the same bits; with an exponent where that is shorter.
pub(super) fn exact(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() || (1e-5..1e16).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// Six significant digits at most, without trailing zeros.
pub(super) fn brief(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let scientific = format!("{value:.5e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..6).contains(&exponent) {
        let n_decimals = usize::try_from(5 - exponent).unwrap_or(0);
        trim_zeros(&format!("{value:.n_decimals$}")).to_owned()
    } else {
        format!("{}e{exponent}", trim_zeros(mantissa))
    }
}

fn trim_zeros(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brief_keeps_six_digits() {
        let cases = [
            (938.123456, "938.123"),
            (0.1, "0.1"),
            (-0.0001234567, "-0.000123457"),
            (1.0e-9, "1e-9"),
            (999_999.96, "1e6"),
            (123_456.7, "123457"),
            (f64::NAN, "NaN"),
            (0.0, "0"),
        ];
        for (value, expected) in cases {
            assert_eq!(brief(value), expected);
        }
    }

    #[test]
    fn exact_reads_back() {
        for value in [0.1 + 0.2, 1e300, 5e-324, -0.0, 1e16, 9.999e-6, f64::INFINITY, 8.93e3] {
            assert_eq!(exact(value).parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
    }
}
