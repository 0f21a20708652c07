//! `cargo xtask ci`: what CI runs, in the same order.
//!
//! Rationale. The steps go from cheap to dear, so that a slip of form is known in seconds; the
//! first failure ends the run, because the next steps would repeat it.
//!
//! - *tidy* comes first: it reads, it compiles nothing.
//! - *fmt* reads too.
//! - *rust-version* asks cargo's metadata whether a dependency needs a newer compiler than the
//!   workspace promises. That finds the usual way in which the promise breaks, without a second
//!   toolchain.
//! - *clippy* runs over all targets with the default features, then over the library or program of each
//!   crate that has features, with none of them and with each alone: features are additive only if every
//!   one of them builds without the others. The two differ because cargo unifies features over the
//!   workspace, so the first run never sees a crate without them.
//! - *doc* turns a broken link in a doc comment into a failure.
//! - *test* is last and longest. The command is read out of README.md, so that what a newcomer is
//!   told to type is what is tested.
//!
//! Everything is `--locked`: a stale Cargo.lock is a failure, not an update.

use crate::compiler::{Compiler, is_older};
use crate::manifest::{self, Manifest};
use crate::{shell, tidy};
use std::fs;
use std::path::Path;
use std::time::Instant;

pub(crate) fn run() -> Result<(), String> {
    let root = shell::root();
    let start = Instant::now();
    step("tidy", || tidy::check(&root))?;
    step("fmt", || cargo("fmt --all --check"))?;
    step("rust-version", || rust_version(&root))?;
    step("clippy", || cargo("clippy --workspace --all-targets --locked -- -D warnings"))?;
    step("clippy by feature", || clippy_by_feature(&root))?;
    step("doc", doc)?;
    step("test", || test_as_the_readme_says(&root))?;
    println!("\nci: passed in {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

fn step(name: &str, check: impl FnOnce() -> Result<(), String>) -> Result<(), String> {
    println!("\n== {name}");
    let start = Instant::now();
    let result = check();
    let seconds = start.elapsed().as_secs_f64();
    match result {
        Ok(()) => {
            println!("== {name}: passed in {seconds:.1} s");
            Ok(())
        }
        Err(message) => Err(format!("{message}\nci: {name} failed after {seconds:.1} s")),
    }
}

fn cargo(arguments: &str) -> Result<(), String> {
    println!("cargo {arguments}");
    shell::run(shell::cargo(arguments.split_whitespace()))
}

fn doc() -> Result<(), String> {
    let arguments = "doc --workspace --no-deps --locked";
    println!("RUSTDOCFLAGS=-Dwarnings cargo {arguments}");
    let mut command = shell::cargo(arguments.split_whitespace());
    command.env("RUSTDOCFLAGS", "-Dwarnings");
    shell::run(command)
}

fn rust_version(root: &Path) -> Result<(), String> {
    let promised = manifest::rust_version(root)?;
    // Only what this platform uses, as for the tests: nothing more needs to be downloaded.
    let mut command = shell::cargo(["metadata", "--locked", "--format-version", "1"]);
    command.args(["--filter-platform", &Compiler::find()?.host]);
    let metadata = shell::output(command)?;
    let metadata: serde_json::Value =
        serde_json::from_str(&metadata).map_err(|e| format!("cargo metadata: {e}"))?;
    if let Some(what) = needs_newer(&metadata, &promised) {
        return Err(format!("{what}, Cargo.toml promises {promised}"));
    }
    println!("no dependency needs a newer compiler than {promised}");
    Ok(())
}

/// The first package that the promised compiler cannot build.
fn needs_newer(metadata: &serde_json::Value, promised: &str) -> Option<String> {
    metadata["packages"].as_array()?.iter().find_map(|package| {
        let needed = package["rust_version"].as_str()?;
        let name = package["name"].as_str()?;
        is_older(promised, needed).then(|| format!("`{name}` needs rustc {needed}"))
    })
}

fn clippy_by_feature(root: &Path) -> Result<(), String> {
    for (package, features) in packages_with_features(root)? {
        let clippy = |features: &str| {
            cargo(&format!(
                "clippy -p {package} --no-default-features {features} --locked -- -D warnings"
            ))
        };
        clippy("")?;
        for feature in features {
            clippy(&format!("--features {feature}"))?;
        }
    }
    Ok(())
}

/// Each package in crates/ that has features, with all of them but `default`.
fn packages_with_features(root: &Path) -> Result<Vec<(String, Vec<String>)>, String> {
    let folder = root.join("crates");
    let wrong = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut found = Vec::new();
    for entry in fs::read_dir(&folder).map_err(wrong)? {
        let path = entry.map_err(wrong)?.path().join("Cargo.toml");
        let Ok(text) = fs::read_to_string(&path) else { continue };
        let manifest = Manifest::parse(&text).map_err(|e| format!("{}: {e}", path.display()))?;
        let mut features = manifest.keys(&["features"]);
        features.retain(|feature| feature != "default");
        if let (Some((name, _)), false) =
            (manifest.string(&["package", "name"]), features.is_empty())
        {
            found.push((name.to_owned(), features));
        }
    }
    found.sort();
    Ok(found)
}

fn test_as_the_readme_says(root: &Path) -> Result<(), String> {
    let path = root.join("README.md");
    let readme = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let command = test_command(&readme).ok_or("README.md gives no line `cargo xtask test`")?;
    cargo(command)
}

/// What follows `cargo` in the first line of a code block that runs the tests.
fn test_command(readme: &str) -> Option<&str> {
    let mut in_code = false;
    readme.lines().find_map(|line| {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        }
        let typed = line.split(" #").next()?.trim().trim_start_matches("$ ");
        let command = typed.strip_prefix("cargo ")?;
        (in_code && command.starts_with("xtask test")).then_some(command)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(readme: &str, expected: Option<&str>) {
        assert_eq!(test_command(readme), expected);
    }

    #[test]
    fn the_test_command_is_read_from_the_readme() {
        check("# A\n\n```sh\ncargo run\ncargo xtask test\n```\n", Some("xtask test"));
        check(
            "```\n$ cargo xtask test -- --quiet   # all of it\n```\n",
            Some("xtask test -- --quiet"),
        );
        check("cargo xtask test\n", None);
        check("```\ncargo test\n```\ncargo xtask test\n", None);
    }

    #[test]
    fn a_dependency_may_not_need_a_newer_compiler() {
        let metadata = |needed: &str| {
            let packages = r#"{"packages": [{"name": "a", "rust_version": null},"#;
            let text = format!(r#"{packages} {{"name": "b", "rust_version": "{needed}"}}]}}"#);
            serde_json::from_str(&text).expect("it is JSON")
        };
        assert_eq!(needs_newer(&metadata("1.88.0"), "1.88"), None);
        let found = needs_newer(&metadata("1.89"), "1.88");
        assert_eq!(found.as_deref(), Some("`b` needs rustc 1.89"));
    }

    #[test]
    fn features_are_read_from_the_manifests() {
        let found = packages_with_features(&shell::root()).expect("the workspace can be read");
        let mesh = found.iter().find(|(name, _)| name == "drypoint-mesh").expect("it has features");
        assert!(mesh.1.contains(&"obj".to_owned()));
        assert!(!mesh.1.contains(&"default".to_owned()));
    }
}
