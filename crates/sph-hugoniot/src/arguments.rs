//! What can be typed: commands, options, the values that they take.

use std::path::PathBuf;

use clap::{Parser, Subcommand};

use crate::config::PARTICLE_VELOCITIES;
use crate::config::units::{Length, Velocity};
use crate::shell::ColorChoice;
use crate::{restart, schema};

const EXAMPLES: &str = "Examples:
  hugoniot init porous-copper > case.ron     write a commented case file
  hugoniot check case.ron                    porosity reached, particles, memory, time
  hugoniot run case.ron                      all points of the case
  hugoniot run case.ron --up 100,150         two points only
  hugoniot run case.ron --out results/a --threads 2 --quiet
  hugoniot run case.ron --resolutions 2um,1um,0.5um
                                             u_s at vanishing particle size
  hugoniot run case.ron --resume             go on after Ctrl-C, a crash or a power cut
  hugoniot status results/porous-copper      how far a run is, from another terminal
  hugoniot completions bash > ~/.local/share/bash-completion/completions/hugoniot

RUST_LOG=info tells of each point when start-up ends and what each block gives.
Ctrl-C once: the points keep their states and stop; twice: the process ends at once. --resume goes on either way.
Exit codes: 0 done, 1 a file could not be read or written, 2 bad input, 3 a point failed, 130 interrupted";

/// From a case file to the shock Hugoniot u_s(u_p) of a porous solid, with uncertainty.
#[derive(Debug, Parser)]
#[command(name = "hugoniot", version, after_help = EXAMPLES)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Colors in messages
    #[arg(long, global = true, value_enum, default_value_t)]
    pub color: ColorChoice,
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
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
        threads: Option<u16>,
        /// PNG file for the picture of the sample; default: sample.png in the case's folder of results
        #[arg(long, value_name = "FILE", value_parser = png_file)]
        picture: Option<PathBuf>,
    },
    /// Run the points of a case; results go into its folder
    #[command(
        after_help = "Examples:\n  hugoniot run case.ron\n  hugoniot run case.ron --up 100,150 --out results/two"
    )]
    Run {
        /// Case file
        case: PathBuf,
        /// Particle velocities in m/s, in place of those of the case
        #[arg(long, value_name = "U_P", value_delimiter = ',', value_parser = particle_velocity, allow_negative_numbers = true)]
        up: Vec<f64>,
        /// Particle sizes, in place of that of the case: the sweep with each, and u_s at vanishing size
        #[arg(long, value_name = "D", value_delimiter = ',', value_parser = particle_size)]
        resolutions: Vec<f64>,
        /// Folder of the results, in place of that of the case
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Cores to use; default: all
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
        threads: Option<u16>,
        /// Go on with an earlier run in the folder: finished points are kept, the others go on where they were
        #[arg(long, conflicts_with = "replace")]
        resume: bool,
        /// Throw the results of an earlier run in the folder away
        #[arg(long)]
        replace: bool,
        /// Time between two states of a point on disk, in seconds
        #[arg(long, value_name = "SECONDS", default_value_t = restart::INTERVAL.as_secs_f64(), value_parser = seconds, allow_negative_numbers = true)]
        keep_every: f64,
        /// No progress, no summary; failures are still told
        #[arg(long)]
        quiet: bool,
        /// The summary at the end as JSON
        #[arg(long)]
        json: bool,
    },
    /// Show how far a run is, or how it ended
    #[command(
        after_help = "Examples:\n  hugoniot status results/porous-copper\n  watch -n 2 hugoniot status results/porous-copper\n  \
                      hugoniot status results/porous-copper --json | jq .seconds_left"
    )]
    Status {
        /// Folder of the results
        folder: PathBuf,
        /// As JSON
        #[arg(long)]
        json: bool,
    },
    /// Write the completions for a shell to standard output
    #[command(after_help = "Examples:
  hugoniot completions bash > ~/.local/share/bash-completion/completions/hugoniot
  hugoniot completions zsh > \"${fpath[1]}/_hugoniot\"
  hugoniot completions fish > ~/.config/fish/completions/hugoniot.fish")]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Write the manual pages into a folder
    #[command(after_help = "Example:\n  hugoniot man ~/.local/share/man/man1")]
    Man {
        /// The folder; it is made if it is not there
        folder: PathBuf,
    },
    /// Write the JSON schema of what --json gives to standard output
    #[command(
        after_help = "Examples:\n  hugoniot schema status\n  hugoniot schema check > check.schema.json"
    )]
    Schema {
        /// Which one
        #[arg(value_enum)]
        of: schema::Schema,
    },
}

/// Reads a particle velocity: `100`, `100 m/s`, `0.1 km/s`.
fn particle_velocity(text: &str) -> Result<f64, String> {
    let value = match text.trim().parse::<f64>() {
        Ok(value) => value,
        Err(_) => Velocity::parse(text)?.si,
    };
    let (low, high) = PARTICLE_VELOCITIES;
    match (low..=high).contains(&value) {
        true => Ok(value),
        false => Err(format!("out of range; hint: from {low} to {high} m/s")),
    }
}

/// Reads the path of a picture: one that ends in `.png`, so that the name tells what is in it.
fn png_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        true => Ok(path),
        false => Err("pictures are PNG files; hint: a name such as sample.png".to_owned()),
    }
}

/// Reads a particle size: `1um`, `500 nm`.
fn particle_size(text: &str) -> Result<f64, String> {
    let size = Length::parse(text)?.si;
    if size > 0.0 { Ok(size) } else { Err(format!("{text} is no particle size; hint: such as 1um")) }
}

/// Reads a time in seconds.
fn seconds(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("{text:?} is no number of seconds"))?;
    if (0.0..=1e6).contains(&value) { Ok(value) } else { Err("out of range; hint: 0 to 1e6 s".to_owned()) }
}
