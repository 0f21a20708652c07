//! `cargo xtask test`: finds out what the machine lacks, then runs every test and doc test.

use crate::compiler::{Compiler, is_older};
use crate::{HELP, manifest, models, shell};
use std::process::{Command, Stdio};

pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    let for_cargo = match arguments {
        [] => &[],
        [first, rest @ ..] if first == "--" => rest,
        [other, ..] => {
            let hint = "what cargo test should get comes after `--`";
            return Err(format!("`test` takes no `{other}`; {hint}\n\n{HELP}"));
        }
    };
    // One run shows all that fails: the next one is minutes away.
    let mut tests = shell::cargo(["test", "--workspace", "--locked", "--no-fail-fast"]);
    tests.args(for_cargo);
    models::hand_to(&mut tests)?;
    prepare()?;
    shell::run(tests)
}

/// Leaves nothing to be found out half-way through the build.
fn prepare() -> Result<(), String> {
    let Compiler { release, host } = Compiler::find()?;
    let wanted = manifest::rust_version(&shell::root())?;
    if is_older(&release, &wanted) {
        return Err(format!(
            "rustc is {release}, Drypoint needs {wanted} or newer: run `rustup update stable`"
        ));
    }
    // Only a notice: a linker that is set in cargo's own configuration is as good.
    if cfg!(unix) && !starts("cc") {
        let install = if cfg!(target_os = "macos") {
            "xcode-select --install"
        } else {
            "apt-get install gcc"
        };
        println!("no `cc` on the PATH: if linking fails, install a C compiler, e.g. `{install}`");
    }
    // Crates that are there already are not asked for again, so this works without a network too.
    shell::run(shell::cargo(["fetch", "--quiet", "--locked", "--target", &host])).map_err(|e| {
        format!("{e}\nthe crates cannot be had: connect once to the network, then run this again")
    })
}

fn starts(program: &str) -> bool {
    let mut command = Command::new(program);
    let quiet = command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
    quiet.status().is_ok()
}
