//! `cargo xtask bench`: times every extractor, after comparing it with the definition.

use crate::{models, shell};

pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    let mut command =
        shell::cargo(["run", "--release", "--locked", "-p", "drypoint-tests", "--bin", "bench"]);
    command.arg("--").args(arguments);
    models::hand_to(&mut command)?;
    shell::run(command)
}
