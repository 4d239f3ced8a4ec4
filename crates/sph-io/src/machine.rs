//! On which machine, and with which command, a program runs.

/// The processor's own name, where the system tells it.
#[must_use]
pub fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

/// The command that this process was started with, as one would type it.
#[must_use]
pub fn command() -> String {
    let words = std::env::args_os().enumerate().map(|(k, word)| {
        let word = word.to_string_lossy().into_owned();
        let name = word.rsplit(['/', '\\']).next().unwrap_or(&word).to_owned();
        if k == 0 { name } else { quoted(word) }
    });
    words.collect::<Vec<_>>().join(" ")
}

/// A word as a shell takes it for one.
#[must_use]
pub fn quoted(word: String) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "/._-,:=+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_a_shell_would_split_them() {
        assert_eq!(quoted("results/ä-1".into()), "results/ä-1");
        assert_eq!(quoted("my case.ron".into()), "'my case.ron'");
        assert_eq!(quoted("it's".into()), r"'it'\''s'");
        assert_eq!(quoted(String::new()), "''");
    }
}
