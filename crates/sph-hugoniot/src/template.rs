//! Case files that `hugoniot init` writes.

/// Name and text of every template.
pub const TEMPLATES: [(&str, &str); 2] = [
    ("porous-copper", include_str!("../templates/porous-copper.ron")),
    ("smoke", include_str!("../templates/smoke.ron")),
];

/// Names of all templates.
pub fn names() -> Vec<&'static str> {
    TEMPLATES.iter().map(|(name, _)| *name).collect()
}

/// The text of a template.
pub fn text(name: &str) -> Option<&'static str> {
    TEMPLATES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_template_is_a_good_case() {
        for (name, text) in super::TEMPLATES {
            if let Err(error) = crate::config::parse(text, name) {
                panic!("{error}");
            }
        }
    }
}
