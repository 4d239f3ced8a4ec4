//! `cargo xtask validate`: builds `sph-validate` in release and runs it with the same options.

use std::process::{Command, ExitCode};

use crate::process;

/// Options are those of `sph-validate`; it knows and lists the suites and schemes.
#[derive(clap::Args)]
#[command(disable_help_flag = true)]
pub struct Arguments {
    /// Options of `sph-validate`: --tier quick|full, --suite, --scheme, --out, --threads; --help explains them.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    options: Vec<String>,
}

/// Exit status: that of `sph-validate`.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let mut command = process::cargo();
    // The folder of the caller stays, so that --out means what it says there.
    command.args(["run", "--quiet", "--release", "--package", "sph-validate", "--bin", "sph-validate"]);
    command.arg("--manifest-path").arg(process::root().join("Cargo.toml"));
    if let Some(commit) = commit() {
        command.env("SPH_VALIDATE_COMMIT", commit);
    }
    process::hand_over(command.arg("--").args(&arguments.options))
}

/// The state of the repository for the report, where git knows it.
fn commit() -> Option<String> {
    let mut git = Command::new("git");
    git.arg("-C").arg(process::root()).args(["describe", "--always", "--dirty"]);
    let output = git.output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}
