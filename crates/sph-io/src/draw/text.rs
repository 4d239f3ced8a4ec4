//! Words with subscripts and superscripts, and how wide they are.
//!
//! `u_s`, `sigma_{xx}` and `10^{-3}` are set as one would write them: a subscript or superscript is a braced group,
//! or the letters and digits that follow (a sign before them). A backslash takes the next character as it stands.

/// Size of a subscript or superscript relative to the text around it.
const SMALL: f64 = 0.72;
/// How far a superscript stands above the line, in font sizes; a subscript stands as far below as `DROP`.
const RISE: f64 = 0.38;
const DROP: f64 = -0.2;

/// Widths of the characters from space to tilde in thousandths of the font size: DejaVu Sans, the font of the back end.
#[rustfmt::skip]
const ASCII_WIDTHS: [u16; 95] = [
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361, 318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635, 611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352, 635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592, 525, 636, 337, 636, 838,
];

/// A piece of text in one size at one height.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Run {
    pub text: String,
    /// Size relative to the whole text's font size.
    pub size: f64,
    /// Height of its base line above that of the whole text, in font sizes.
    pub rise: f64,
}

impl Run {
    /// Width at a font size of 1.
    pub fn width(&self) -> f64 {
        self.size * self.text.chars().map(character_width).sum::<f64>()
    }
}

/// Width of marked-up text at a font size.
pub(crate) fn width(markup: &str, size: f64) -> f64 {
    size * runs(markup).iter().map(Run::width).sum::<f64>()
}

fn character_width(character: char) -> f64 {
    let thousandths = match character {
        ' '..='~' => ASCII_WIDTHS[character as usize - 32],
        '−' | '×' | '±' | '≤' | '≥' | '≈' | 'ω' => 838,
        '²' | '³' | '·' => 400,
        '—' => 1000,
        'Δ' | 'Φ' | 'Ω' => 750,
        _ => 630,
    };
    f64::from(thousandths) / 1000.0
}

/// Takes marked-up text apart.
pub(crate) fn runs(markup: &str) -> Vec<Run> {
    let mut out: Vec<Run> = Vec::new();
    let mut characters = markup.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '_' | '^' => {
                let rise = if character == '^' { RISE } else { DROP };
                out.push(Run { text: group(&mut characters), size: SMALL, rise });
            }
            '\\' => push_plain(&mut out, characters.next().unwrap_or('\\')),
            _ => push_plain(&mut out, character),
        }
    }
    out
}

fn push_plain(runs: &mut Vec<Run>, character: char) {
    match runs.last_mut() {
        Some(run) if run.rise == 0.0 => run.text.push(character),
        _ => runs.push(Run { text: character.to_string(), size: 1.0, rise: 0.0 }),
    }
}

/// The braced group, or the word, that follows a mark.
fn group(characters: &mut std::iter::Peekable<std::str::Chars<'_>>) -> String {
    if characters.next_if_eq(&'{').is_some() {
        return characters.by_ref().take_while(|&character| character != '}').collect();
    }
    let mut text = String::new();
    if let Some(sign) = characters.next_if(|character| matches!(character, '-' | '−' | '+')) {
        text.push(if sign == '-' { '−' } else { sign });
    }
    while let Some(character) = characters.next_if(|character| character.is_alphanumeric()) {
        text.push(character);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(markup: &str) -> Vec<(String, bool)> {
        runs(markup).into_iter().map(|run| (run.text, run.rise > 0.0)).collect()
    }

    #[test]
    fn marks_end_with_their_word_or_brace() {
        let run = |text: &str, up| (text.to_owned(), up);
        assert_eq!(texts("u_s [m/s]"), [run("u", false), run("s", false), run(" [m/s]", false)]);
        assert_eq!(texts("u_s-u_p").len(), 4);
        assert_eq!(texts("10^-3"), [run("10", false), run("−3", true)]);
        assert_eq!(texts("a_{x, y}b"), [run("a", false), run("x, y", false), run("b", false)]);
        assert_eq!(texts(r"file\_name"), [run("file_name", false)]);
        assert_eq!(texts("end_"), [run("end", false), run("", false)]);
    }

    #[test]
    fn a_subscript_is_narrower() {
        assert!(width("x_x", 10.0) < width("xx", 10.0));
        assert!((width("00", 10.0) - 12.72).abs() < 1e-9);
    }
}
