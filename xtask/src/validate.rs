//! `cargo xtask validate`: every extractor against the definition, or the tests against broken bounds.

use crate::{models, shell};

pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    let mut command =
        shell::cargo(["run", "--release", "--locked", "-p", "drypoint-tests", "--bin", "validate"]);
    command.arg("--").args(arguments);
    models::hand_to(&mut command)?;
    shell::run(command)
}
