//! Rust sources without their comments and without what stands in texts.

use std::ops::RangeInclusive;

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

/// The lines, from 0 on, of the items that stand behind `#[cfg(test)]`, in a source that is blank where [`blank`] makes it so.
pub fn test_lines(code: &str) -> Vec<RangeInclusive<usize>> {
    let line_of = |at: usize| code[..at].matches('\n').count();
    let marks = code.match_indices("#[cfg(test)]");
    marks.map(|(at, mark)| line_of(at)..=line_of(end_of_item(code, at + mark.len()))).collect()
}

/// Where the item ends that starts here: at its `;`, at the `,` of a field or an arm, at the end of its braces, or, with
/// nothing of these, before the bracket that closes what is around it.
fn end_of_item(code: &str, from: usize) -> usize {
    let mut open = 0_usize;
    for (at, c) in code[from..].char_indices() {
        match c {
            '(' | '[' | '{' => open += 1,
            ')' | ']' | '}' if open == 0 => return from + code[from..from + at].trim_end().len(),
            ')' | ']' => open -= 1,
            '}' => {
                open -= 1;
                if open == 0 {
                    return from + at;
                }
            }
            ';' | ',' if open == 0 => return from + at,
            _ => {}
        }
    }
    code.len()
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
    fn tests_end_where_their_item_ends() {
        let cases = [
            ("#[cfg(test)]\nmod tests;\nfn f() {}\n", vec![0..=1]),
            ("fn f() {}\n\n#[cfg(test)]\nmod tests {\n    fn t() {}\n}\nfn g() {}\n", vec![2..=5]),
            (
                "#[cfg(test)]\nfn t(x: [u8; 2], y: u8) -> u8 {\n    x[0]\n}\n\n#[cfg(test)]\nuse a::{b, c};\n",
                vec![0..=3, 5..=6],
            ),
            ("#[cfg(test)]\n#[path = \"  \"]\nmod tests;\n", vec![0..=2]),
            ("struct A {\n    #[cfg(test)]\n    n: usize,\n    m: usize,\n}\n", vec![1..=2]),
            ("struct A {\n    #[cfg(test)]\n    n: usize\n}\nfn f() {}\n", vec![1..=2]),
            ("#[cfg(test)]\nmod never_closed {\n", vec![0..=2]),
        ];
        for (code, expected) in cases {
            assert_eq!(test_lines(code), expected, "{code}");
        }
    }

    #[test]
    fn words_are_whole() {
        assert!(has_word("    unsafe {", "unsafe"));
        assert!(!has_word("unsafe_code = 1", "unsafe"));
        assert!(has_word("x.dbg!(1)", "dbg!"));
    }
}
