//! Text into HTML: escaped, with code, subscripts and superscripts.

/// The text with what HTML takes for its own replaced; within attributes too.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(character),
            // Not allowed in HTML, and a terminal's colors begin with one.
            _ if character.is_control() => out.push('\u{fffd}'),
            _ => out.push(character),
        }
    }
    out
}

/// The text escaped, with its marks set.
pub(super) fn marked(text: &str) -> String {
    let mut out = String::new();
    for (k, part) in text.split('`').enumerate() {
        let is_code = k % 2 == 1 && text.matches('`').count() > k;
        match (k, is_code) {
            (_, true) => out += &format!("<code>{}</code>", escaped(part)),
            (k, false) if k % 2 == 1 => out += &format!("`{}", with_scripts(part)),
            _ => out += &with_scripts(part),
        }
    }
    out
}

/// The text escaped, with subscripts and superscripts.
fn with_scripts(text: &str) -> String {
    let characters: Vec<char> = text.chars().collect();
    let (mut out, mut k) = (String::new(), 0);
    while k < characters.len() {
        let tag = match characters[k] {
            '_' if follows_one_letter(&characters, k) => "sub",
            '^' if k > 0 && characters[k - 1].is_alphanumeric() => "sup",
            _ => "",
        };
        let (script, length) = if tag.is_empty() { (String::new(), 0) } else { script(&characters[k + 1..]) };
        if script.is_empty() {
            out += &escaped(&characters[k].to_string());
            k += 1;
        } else {
            out += &format!("<{tag}>{}</{tag}>", escaped(&script));
            k += 1 + length;
        }
    }
    out
}

fn follows_one_letter(characters: &[char], k: usize) -> bool {
    let is_word = |c: char| c.is_alphabetic() || c == '_';
    k > 0
        && characters[k - 1].is_alphabetic()
        && (k < 2 || !is_word(characters[k - 2]) || characters[k - 2] == 'Δ')
}

/// The braced group or the word at the start, and how many characters it takes.
fn script(characters: &[char]) -> (String, usize) {
    if characters.first() == Some(&'{') {
        let inside: String = characters[1..].iter().take_while(|&&c| c != '}').collect();
        let length = inside.chars().count() + 2;
        return if length <= characters.len() { (inside, length) } else { (String::new(), 0) };
    }
    let signs = usize::from(matches!(characters.first(), Some('-' | '−' | '+')));
    let length = signs + characters[signs..].iter().take_while(|c| c.is_alphanumeric()).count();
    if length == signs {
        return (String::new(), 0);
    }
    (characters[..length].iter().map(|&c| if c == '-' { '−' } else { c }).collect(), length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_gets_through_unescaped() {
        let evil = "<script>alert('x')</script> & \"y\" \u{1b}[31m";
        let safe = "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; &quot;y&quot; \u{fffd}[31m";
        assert_eq!(escaped(evil), safe);
        assert_eq!(marked(evil), safe);
        assert_eq!(marked("`<b>`"), "<code>&lt;b&gt;</code>");
        assert_eq!(marked("a_{<b>}"), "a<sub>&lt;b&gt;</sub>");
    }

    #[test]
    fn marks_count_after_one_letter() {
        assert_eq!(marked("u_s(u_p)"), "u<sub>s</sub>(u<sub>p</sub>)");
        assert_eq!(marked("½u_p^2"), "½u<sub>p</sub><sup>2</sup>");
        assert_eq!(marked("Δσ_xx"), "Δσ<sub>xx</sub>");
        assert_eq!(marked("up_0100 and rho_own"), "up_0100 and rho_own");
        assert_eq!(marked("3·10^-4, m^2"), "3·10<sup>−4</sup>, m<sup>2</sup>");
        assert_eq!(marked("u_ a_{b ^2 _x"), "u_ a_{b ^2 _x");
    }

    #[test]
    fn a_lone_backtick_stays() {
        assert_eq!(marked("a ` b"), "a ` b");
        assert_eq!(marked("`a` ` b"), "<code>a</code> ` b");
    }
}
