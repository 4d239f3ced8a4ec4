//! The command line of `hugoniot`: what can be typed, and which exit code follows.

use std::io::IsTerminal;
use std::path::PathBuf;

use clap::{Parser, Subcommand};

use crate::config;
use crate::{check, template};

/// Everything went well.
pub const SUCCESS: u8 = 0;
/// The input is wrong: nothing was run.
pub const BAD_INPUT: u8 = 2;
/// At least one point failed; what was computed is kept.
pub const NUMERICAL_FAILURE: u8 = 3;
/// Stopped by Ctrl-C; what was computed is kept.
pub const INTERRUPTED: u8 = 130;

const EXAMPLES: &str = "Examples:
  hugoniot init porous-copper > case.ron     write a commented case file
  hugoniot check case.ron                    porosity reached, particles, memory, time
  hugoniot run case.ron                      all points of the case
  hugoniot run case.ron --up 100,150         two points only
  hugoniot run case.ron --out results/a --threads 2 --quiet

Exit codes: 0 done, 2 bad input, 3 a point failed, 130 interrupted";

/// From a case file to the shock Hugoniot u_s(u_p) of a porous solid, with uncertainty.
#[derive(Debug, Parser)]
#[command(name = "hugoniot", version, after_help = EXAMPLES)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write a commented case file to standard output
    #[command(after_help = "Example:\n  hugoniot init porous-copper > case.ron")]
    Init {
        /// Name of the template; without it the names are listed
        template: Option<String>,
    },
    /// Show what a case file resolves to; run nothing
    #[command(
        after_help = "Examples:\n  hugoniot check case.ron\n  hugoniot check case.ron --json | jq .porosity_reached"
    )]
    Check {
        /// Case file
        case: PathBuf,
        /// As JSON
        #[arg(long)]
        json: bool,
        /// Cores that the time is estimated for; default: all
        #[arg(long, value_name = "N")]
        threads: Option<usize>,
    },
}

/// Runs the command; returns the exit code.
pub fn execute(arguments: Arguments) -> anyhow::Result<u8> {
    match arguments.command {
        Command::Init { template } => Ok(init(template.as_deref())),
        Command::Check { case, json, threads } => check_case(&case, json, threads),
    }
}

fn init(name: Option<&str>) -> u8 {
    let names = template::names();
    let Some(name) = name else {
        println!("{}", names.join("\n"));
        return SUCCESS;
    };
    match template::text(name) {
        Some(text) => {
            print!("{text}");
            SUCCESS
        }
        None => {
            eprintln!(
                "error: there is no template {name:?}; hint: {}",
                config::fault::name_hint(name, &names)
            );
            BAD_INPUT
        }
    }
}

/// Reads a case file; its faults go to standard error.
fn load(path: &std::path::Path) -> Option<config::Case> {
    let color = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    config::load(path).map_err(|error| eprintln!("{}", error.render(color).trim_end())).ok()
}

fn check_case(path: &std::path::Path, json: bool, threads: Option<usize>) -> anyhow::Result<u8> {
    let Some(case) = load(path) else { return Ok(BAD_INPUT) };
    let check = check::Check::new(case, threads.unwrap_or_else(available_threads).max(1));
    if json {
        println!("{}", serde_json::to_string_pretty(&check)?);
    } else {
        print!("{}", check.to_text());
    }
    Ok(SUCCESS)
}

/// Cores of this machine.
pub fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
