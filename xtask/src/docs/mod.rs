//! `cargo xtask docs`: rustdoc with warnings denied, links of all sources and Markdown files, commands, and the guide as a
//! book.
//!
//! Formulas are plain text; [`rust`] checks the links of the sources, [`links`] those of Markdown, [`commands`] the commands;
//! [`book`] builds the guide.

mod book;
mod commands;
mod links;
mod rust;

use std::process::ExitCode;

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
    let ((lost, private), public) = (rust::check_links()?, rust::build()?);
    let (texts, exists) = (files::texts(&root)?, |path: &str| root.join(path).exists());
    let (broken, untrue) = (links::check(&texts, exists), commands::check(&texts, exists));
    for fault in broken.iter().chain(&untrue) {
        eprintln!("error: {fault}");
    }
    let n_broken = broken.len() + lost;
    println!("docs: {n_broken} broken links, {} commands that are none", untrue.len());
    let book = if arguments.no_book {
        println!("docs: the book was not built, as asked");
        ExitCode::SUCCESS
    } else {
        book::build()?
    };
    let is_built = [private, public, book].iter().all(|built| *built == ExitCode::SUCCESS);
    let good = is_built && n_broken == 0 && untrue.is_empty();
    Ok(if good { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
