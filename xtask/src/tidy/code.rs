//! Rust sources without their comments and without what stands in texts.

/// The source with blanks in place of comments and of the contents of strings and characters; lines stay lines.
pub fn blank(source: &str) -> String {
    let characters: Vec<char> = source.chars().collect();
    let mut out = String::with_capacity(source.len());
    let mut at = 0;
    while at < characters.len() {
        let end = end_of_text(&characters, at);
        if end == at {
            out.push(characters[at]);
            at += 1;
        } else {
            out.extend(characters[at..end].iter().map(|&c| if c == '\n' { '\n' } else { ' ' }));
            at = end;
        }
    }
    out
}

/// Where the comment or text ends that starts here; `at` if none does.
fn end_of_text(c: &[char], at: usize) -> usize {
    match (c[at], c.get(at + 1)) {
        ('/', Some('/')) => (at..c.len()).find(|&k| c[k] == '\n').unwrap_or(c.len()),
        ('/', Some('*')) => end_of_block_comment(c, at),
        ('"', _) => end_of_string(c, at),
        ('r', Some('"' | '#')) if !continues_a_word(c, at) => end_of_raw_string(c, at),
        ('\'', _) => end_of_character(c, at),
        _ => at,
    }
}

/// Block comments nest.
fn end_of_block_comment(c: &[char], at: usize) -> usize {
    let (mut depth, mut k) = (0, at);
    while k + 1 < c.len() {
        match (c[k], c[k + 1]) {
            ('/', '*') => (depth, k) = (depth + 1, k + 2),
            ('*', '/') => (depth, k) = (depth - 1, k + 2),
            _ => k += 1,
        }
        if depth == 0 {
            return k;
        }
    }
    c.len()
}

fn end_of_string(c: &[char], at: usize) -> usize {
    let mut k = at + 1;
    while k < c.len() && c[k] != '"' {
        k += if c[k] == '\\' { 2 } else { 1 };
    }
    (k + 1).min(c.len())
}

fn end_of_raw_string(c: &[char], at: usize) -> usize {
    let hashes = c[at + 1..].iter().take_while(|&&c| c == '#').count();
    let open = at + 1 + hashes;
    if c.get(open) != Some(&'"') {
        return at; // r#name
    }
    let closes =
        |k: usize| c[k] == '"' && c[k + 1..].iter().take(hashes).filter(|&&c| c == '#').count() == hashes;
    (open + 1..c.len()).find(|&k| closes(k)).map_or(c.len(), |k| k + 1 + hashes)
}

/// 'x' and '\n' are characters, 'a in a type is a lifetime.
fn end_of_character(c: &[char], at: usize) -> usize {
    match (c.get(at + 1), c.get(at + 2)) {
        (Some('\\'), _) => (at + 3..c.len()).find(|&k| c[k] == '\'').map_or(at, |k| k + 1),
        (Some(_), Some('\'')) => at + 3,
        _ => at,
    }
}

fn continues_a_word(c: &[char], at: usize) -> bool {
    at > 0 && (c[at - 1].is_alphanumeric() || c[at - 1] == '_')
}

/// True if `word` stands in `line` as a word of its own.
pub fn has_word(line: &str, word: &str) -> bool {
    let part_of_word = |c: char| c.is_alphanumeric() || c == '_';
    line.match_indices(word).any(|(at, _)| {
        !line[..at].ends_with(part_of_word) && !line[at + word.len()..].starts_with(part_of_word)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_texts_become_blanks() {
        let cases = [
            ("a(); // dbg!(1)", "a();           "),
            ("a(\"unsafe\")", "a(        )"),
            ("a(r#\"x \" unsafe\"#, 1)", "a(               , 1)"),
            ("/* a /* b */ c */d", "                 d"),
            ("f('\"', 'a', '\\'')", "f(   ,    ,     )"),
            ("fn f<'a>(x: &'a str)", "fn f<'a>(x: &'a str)"),
            ("\"\\\"\" + x", "     + x"),
            ("r#type = for r in x", "r#type = for r in x"),
        ];
        for (source, expected) in cases {
            assert_eq!(blank(source), expected, "{source}");
        }
        assert_eq!(blank("a \"x\ny\" b").lines().count(), 2);
        assert_eq!(blank("\"never closed"), " ".repeat(13));
    }

    #[test]
    fn words_are_whole() {
        assert!(has_word("    unsafe {", "unsafe"));
        assert!(!has_word("unsafe_code = 1", "unsafe"));
        assert!(has_word("x.dbg!(1)", "dbg!"));
    }
}
