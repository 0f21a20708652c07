//! `cargo xtask bench`: times every extractor, after comparing it with the definition.

use crate::{models, shell};

/// Where the report goes if nothing else is said.
const OUTPUT: &str = "target/report";

pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    let mut command =
        shell::cargo(["run", "--release", "--locked", "-p", "drypoint-tests", "--bin", "bench"]);
    command.arg("--").args(arguments);
    let says_where =
        |argument: &String| argument.starts_with("-o") || argument.starts_with("--output");
    if !arguments.iter().any(says_where) {
        command.args(["--output", OUTPUT]);
    }
    command.env("DRYPOINT_COMMIT", commit());
    models::hand_to(&mut command)?;
    shell::run(command)
}

/// What the report is of; "unknown" outside a repository.
fn commit() -> String {
    let mut git = std::process::Command::new("git");
    let output = git.args(["describe", "--always", "--dirty", "--abbrev=9"]).output();
    let output = output.ok().filter(|output| output.status.success());
    let text = output.and_then(|output| String::from_utf8(output.stdout).ok());
    text.map_or("unknown".to_owned(), |text| text.trim().to_owned())
}
