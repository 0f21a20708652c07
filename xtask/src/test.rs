//! `cargo xtask test`: finds out what the machine lacks, then runs every test and doc test.

use crate::{HELP, manifest, models, shell};
use std::env;
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
    let mut tests = shell::cargo(["test", "--workspace", "--locked"]);
    tests.args(for_cargo);
    models::hand_to(&mut tests)?;
    prepare()?;
    shell::run(tests)
}

/// Leaves nothing to be found out half-way through the build.
fn prepare() -> Result<(), String> {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let mut command = Command::new(rustc);
    command.arg("-vV");
    let version = shell::output(command)?;
    let field = |name: &str| version.lines().find_map(|line| line.strip_prefix(name));
    let release = field("release: ").ok_or("`rustc -vV` names no release")?;
    let host = field("host: ").ok_or("`rustc -vV` names no host")?;
    let wanted = manifest::rust_version(&shell::root())?;
    if is_older(release, &wanted) {
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
    shell::run(shell::cargo(["fetch", "--quiet", "--locked", "--target", host])).map_err(|e| {
        format!("{e}\nthe crates cannot be had: connect once to the network, then run this again")
    })
}

fn starts(program: &str) -> bool {
    let mut command = Command::new(program);
    let quiet = command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
    quiet.status().is_ok()
}

/// Compares numbers, not text: 1.100 is newer than 1.88. A suffix such as `-nightly` is passed over.
pub(crate) fn is_older(release: &str, wanted: &str) -> bool {
    let numbers = |version: &str| -> Vec<u32> {
        let release = version.split(['-', '+']).next().unwrap_or_default();
        release.split('.').map(|number| number.parse().unwrap_or(0)).collect()
    };
    numbers(release) < numbers(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(release: &str, wanted: &str, expected: bool) {
        assert_eq!(is_older(release, wanted), expected, "{release} against {wanted}");
    }

    #[test]
    fn versions_are_compared_by_number() {
        check("1.88.0", "1.88", false);
        check("1.87.9", "1.88", true);
        check("1.100.0", "1.88", false);
        check("1.9.0", "1.88", true);
        check("2.0.0-nightly", "1.88", false);
        check("1.88.0-nightly", "1.88.0", false);
    }
}
