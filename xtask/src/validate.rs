//! `cargo xtask validate`: every extractor against the definition, or the tests against broken bounds.

use crate::{models, mutants, shell};

pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    if arguments.iter().any(|argument| argument == "--mutants") {
        return mutants::run(arguments);
    }
    let mut command =
        shell::cargo(["run", "--release", "--locked", "-p", "drypoint-tests", "--bin", "validate"]);
    command.arg("--").args(arguments);
    models::hand_to(&mut command)?;
    shell::run(command)
}
