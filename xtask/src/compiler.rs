//! The Rust compiler, and its versions.

use crate::shell;
use std::env;
use std::process::Command;

/// The compiler that cargo will use.
pub(crate) struct Compiler {
    /// For example `1.88.0`.
    pub(crate) release: String,
    /// The platform that it runs on, for example `x86_64-unknown-linux-gnu`.
    pub(crate) host: String,
}

impl Compiler {
    pub(crate) fn find() -> Result<Self, String> {
        let mut command = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
        command.arg("-vV");
        let version = shell::output(command)?;
        let field = |name: &str| {
            let value = version.lines().find_map(|line| line.strip_prefix(name));
            value.map(str::to_owned).ok_or_else(|| format!("`rustc -vV` prints no `{name}`"))
        };
        Ok(Self { release: field("release: ")?, host: field("host: ")? })
    }
}

/// Compares numbers, not text: 1.100 is newer than 1.88, and 1.88 is 1.88.0. A suffix such as `-nightly` is passed over.
pub(crate) fn is_older(release: &str, wanted: &str) -> bool {
    let numbers = |version: &str| {
        let release = version.split(['-', '+']).next().unwrap_or_default();
        let mut numbers = release.split('.').map(|number| number.parse::<u32>().unwrap_or(0));
        [(); 3].map(|()| numbers.next().unwrap_or(0))
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
        check("1.88", "1.88.0", false);
        check("1.87.9", "1.88", true);
        check("1.100.0", "1.88", false);
        check("1.9.0", "1.88", true);
        check("2.0.0-nightly", "1.88", false);
        check("1.88.0-nightly", "1.88.0", false);
    }
}
