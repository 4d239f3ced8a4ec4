//! What a shell and a terminal want of the program: completions, manual pages, colors.

use std::io::IsTerminal;
use std::path::Path;

use anyhow::{Context, Result};
use clap::{CommandFactory, ValueEnum};
use clap_complete::Shell;

use crate::cli::Arguments;

/// When colors are used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ColorChoice {
    /// On a terminal, unless `NO_COLOR` is set
    #[default]
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

impl ColorChoice {
    /// Whether messages on standard error are colored.
    pub fn is_on(self) -> bool {
        let unwanted = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        match self {
            Self::Always => true,
            Self::Never => false,
            Self::Auto => std::io::stderr().is_terminal() && !unwanted,
        }
    }
}

/// The completions for a shell, as the text that it reads.
pub fn completions(shell: Shell) -> Vec<u8> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "hugoniot", &mut text);
    text
}

/// Writes the manual pages, `hugoniot.1` and one a command, into a folder, which is made; their number.
///
/// # Errors
/// If the folder cannot be made or written to.
pub fn write_manual(folder: &Path) -> Result<usize> {
    std::fs::create_dir_all(folder)
        .with_context(|| format!("{}: the folder cannot be made", folder.display()))?;
    let mut command = Arguments::command();
    command.build();
    let pages = manual_pages(&command)?;
    for (name, page) in &pages {
        sph_io::write_atomic(folder.join(name), page)?;
    }
    Ok(pages.len())
}

/// Name and text of each page.
///
/// # Errors
/// If a page cannot be drawn up.
fn manual_pages(command: &clap::Command) -> Result<Vec<(String, Vec<u8>)>> {
    let parts = command.get_subcommands().filter(|part| part.get_name() != "help");
    let names = parts.map(|part| (format!("hugoniot-{}", part.get_name()), part.clone()));
    std::iter::once(("hugoniot".to_owned(), command.clone()))
        .chain(names)
        .map(|(name, part)| {
            let mut page = Vec::new();
            let manual = clap_mangen::Man::new(part).title(name.clone());
            manual.render(&mut page).with_context(|| format!("{name}.1: the page cannot be drawn up"))?;
            Ok((format!("{name}.1"), page))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shell_learns_every_command() {
        for shell in [Shell::Bash, Shell::Zsh, Shell::Fish] {
            let text = String::from_utf8(completions(shell)).unwrap();
            for word in ["init", "check", "run", "status", "keep-every"] {
                assert!(text.contains(word), "{shell}: {word} is missing");
            }
        }
    }

    #[test]
    fn every_command_has_a_page() {
        let folder = tempfile::tempdir().unwrap();
        let n_commands = Arguments::command().get_subcommands().count();
        assert_eq!(write_manual(folder.path()).unwrap(), 1 + n_commands, "one of the whole, one a command");
        let page = std::fs::read_to_string(folder.path().join("hugoniot-run.1")).unwrap();
        assert!(page.contains("keep\\-every") && page.contains("EXTRA"), "{page}");
    }
}
