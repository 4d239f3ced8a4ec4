//! `cargo xtask docs`: rustdoc with warnings denied, links and commands of all Markdown files, and the guide as a book.
//!
//! Formulas are plain text, links are checked by [`links`], commands by [`commands`]; [`book`] builds the guide.

mod book;
mod commands;
mod links;

use std::process::{Command, ExitCode};

use crate::{files, process};

/// What is built.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Leave the book out: mdbook is installed if it is not there, which takes the network
    #[arg(long)]
    no_book: bool,
}

/// Builds and checks all documentation; exit status 1 if something is wrong.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let root = process::root();
    let rustdoc = process::run(&mut rustdoc())?;
    let (texts, exists) = (files::texts(&root)?, |path: &str| root.join(path).exists());
    let (broken, untrue) = (links::check(&texts, exists), commands::check(&texts, exists));
    for fault in broken.iter().chain(&untrue) {
        eprintln!("error: {fault}");
    }
    println!("docs: {} broken links, {} commands that are none", broken.len(), untrue.len());
    let book = if arguments.no_book {
        println!("docs: the book was not built, as asked");
        ExitCode::SUCCESS
    } else {
        book::build()?
    };
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
