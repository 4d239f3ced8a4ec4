//! `cargo xtask docs`: rustdoc with warnings denied, links and commands of all Markdown files, and the guide as a book.
//!
//! Nothing is taken from the network: formulas are plain text, links are checked by [`links`], commands by [`commands`]. The book needs
//! mdbook; without it everything else is done, and the way to get it is told.

mod commands;
mod links;

use std::process::{Command, ExitCode};

use crate::{files, process};

/// Builds and checks all documentation; exit status 1 if something is wrong.
pub fn run() -> anyhow::Result<ExitCode> {
    let root = process::root();
    let rustdoc = process::run(&mut rustdoc())?;
    let (texts, exists) = (files::texts(&root)?, |path: &str| root.join(path).exists());
    let (broken, untrue) = (links::check(&texts, exists), commands::check(&texts, exists));
    for fault in broken.iter().chain(&untrue) {
        eprintln!("error: {fault}");
    }
    println!("docs: {} broken links, {} commands that are none", broken.len(), untrue.len());
    let book = book()?;
    let good =
        rustdoc == ExitCode::SUCCESS && broken.is_empty() && untrue.is_empty() && book == ExitCode::SUCCESS;
    Ok(if good { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn rustdoc() -> Command {
    let mut command = process::cargo();
    let flags = std::env::var("RUSTDOCFLAGS").unwrap_or_default();
    command.env("RUSTDOCFLAGS", format!("{flags} -D warnings").trim());
    command.args(["doc", "--workspace", "--no-deps", "--manifest-path"]);
    command.arg(process::root().join("Cargo.toml"));
    command
}

/// Builds the guide into `target/book`, if mdbook is there.
fn book() -> anyhow::Result<ExitCode> {
    let found = Command::new("mdbook").arg("--version").output().is_ok_and(|output| output.status.success());
    if !found {
        println!(
            "docs: mdbook is not installed, the guide stays Markdown; hint: cargo install mdbook --locked"
        );
        return Ok(ExitCode::SUCCESS);
    }
    process::run(Command::new("mdbook").arg("build").arg(process::root().join("docs")))
}
