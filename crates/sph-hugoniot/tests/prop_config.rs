//! Case files changed at random: always an answer, never a panic, and every fault inside the text.

use proptest::prelude::*;
use sph_hugoniot::{config, template};

/// One change of a text.
#[derive(Clone, Debug)]
enum Change {
    Remove { at: usize, length: usize },
    Insert { at: usize, text: String },
    Repeat { at: usize, length: usize },
    Cut { at: usize },
}

fn change() -> impl Strategy<Value = Change> {
    let piece = prop_oneof![
        Just("(".to_string()),
        Just(")".into()),
        Just("[".into()),
        Just("]".into()),
        Just("\"".into()),
        Just(",".into()),
        Just(":".into()),
        Just("//".into()),
        Just("/*".into()),
        Just("r#\"".into()),
        Just("NaN".into()),
        Just("-1e999".into()),
        Just("Some(".into()),
        Just("None".into()),
        Just("µ".into()),
        Just("\\u{110000}".into()),
        Just("#![".into()),
        ".{0,6}"
    ];
    prop_oneof![
        (any::<usize>(), 1..40usize).prop_map(|(at, length)| Change::Remove { at, length }),
        (any::<usize>(), piece).prop_map(|(at, text)| Change::Insert { at, text }),
        (any::<usize>(), 1..80usize).prop_map(|(at, length)| Change::Repeat { at, length }),
        any::<usize>().prop_map(|at| Change::Cut { at }),
    ]
}

fn apply(text: &str, change: &Change) -> String {
    let mut chars: Vec<char> = text.chars().collect();
    let place = |at: usize| at % (chars.len() + 1);
    match change {
        Change::Remove { at, length } => {
            let at = place(*at);
            let end = (at + length).min(chars.len());
            chars.drain(at..end);
        }
        Change::Insert { at, text } => {
            let at = place(*at);
            chars.splice(at..at, text.chars());
        }
        Change::Repeat { at, length } => {
            let at = place(*at);
            let piece: Vec<char> = chars[at..(at + length).min(chars.len())].to_vec();
            chars.splice(at..at, piece);
        }
        Change::Cut { at } => {
            let at = place(*at);
            chars.truncate(at);
        }
    }
    chars.into_iter().collect()
}

fn answers(text: &str) {
    if let Err(error) = config::parse(text, "case.ron") {
        assert!(!error.faults.is_empty(), "refused without a reason:\n{text}");
        assert!(error.render(false).contains("error"));
        for fault in &error.faults {
            assert!(fault.span.start <= text.len() + 1, "{fault:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_templates_get_an_answer(which in 0..2usize, changes in prop::collection::vec(change(), 1..6)) {
        let text = changes.iter().fold(template::TEMPLATES[which].1.to_string(), |text, change| apply(&text, change));
        answers(&text);
    }

    #[test]
    fn any_text_gets_an_answer(text in "\\PC{0,200}") {
        answers(&text);
    }

    /// Whatever this reader accepts, the reference reader of RON accepts as well.
    #[test]
    fn accepted_texts_are_ron(changes in prop::collection::vec(change(), 1..3)) {
        let text = changes.iter().fold(template::TEMPLATES[1].1.to_string(), |text, change| apply(&text, change));
        if config::parse(&text, "case.ron").is_ok() {
            let options = ron::Options::default();
            let read = options.from_str::<serde::de::IgnoredAny>(&text);
            prop_assert!(read.is_ok(), "{read:?}\n{text}");
        }
    }
}
