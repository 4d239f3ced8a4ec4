//! The drawing back end writes each dash of a line as a path of its own, with all its attributes, and numbers with the
//! noise of their last digits. Here successive paths with the same attributes become one, and numbers keep two decimals:
//! the picture is the same, the file a fraction.

const PATH: &str = "<path d=\"";

/// The SVG with its paths joined.
pub(crate) fn compact(svg: &str) -> String {
    let mut parts = svg.split(PATH);
    let mut out = parts.next().unwrap_or_default().to_owned();
    // Data and attributes of the path that is still open.
    let mut open: Option<(String, &str)> = None;
    for part in parts {
        let (data, rest) = part.split_once('"').unwrap_or((part, ""));
        let (attributes, tail) = rest.split_once("/>").unwrap_or((rest, ""));
        match &mut open {
            Some((joined, same)) if *same == attributes => add(joined, data),
            other => {
                close(&mut out, other.take());
                let mut joined = String::new();
                add(&mut joined, data);
                open = Some((joined, attributes));
            }
        }
        if !tail.is_empty() {
            close(&mut out, open.take());
            out.push_str(tail);
        }
    }
    close(&mut out, open);
    out
}

fn close(out: &mut String, path: Option<(String, &str)>) {
    if let Some((data, attributes)) = path {
        for text in [PATH, data.trim_end(), "\"", attributes, "/>"] {
            out.push_str(text);
        }
    }
}

/// Adds path data with numbers of two decimals at most.
fn add(joined: &mut String, data: &str) {
    for word in data.split_ascii_whitespace() {
        match word.parse::<f64>() {
            Ok(value) if word.contains('.') => {
                joined.push_str(&format!("{}", (value * 100.0).round() / 100.0))
            }
            _ => joined.push_str(word),
        }
        joined.push(' ');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_of_one_line_become_one_path_and_nothing_else_changes() {
        let dash = |x: &str, color: &str| format!("<path d=\"M {x} 46.4 L 7 8 \" stroke=\"{color}\" />");
        let svg = format!(
            "<svg><g>{}{}{}</g>{}<text>1.23456</text></svg>",
            dash("86.66", "#111"),
            dash("86.70000000000001", "#111"),
            dash("1", "#222"),
            dash("2", "#222")
        );
        assert_eq!(
            compact(&svg),
            "<svg><g><path d=\"M 86.66 46.4 L 7 8 M 86.7 46.4 L 7 8\" stroke=\"#111\" />\
             <path d=\"M 1 46.4 L 7 8\" stroke=\"#222\" /></g>\
             <path d=\"M 2 46.4 L 7 8\" stroke=\"#222\" /><text>1.23456</text></svg>"
        );
        assert_eq!(compact("<svg/>"), "<svg/>");
    }
}
