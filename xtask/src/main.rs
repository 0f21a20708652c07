//! Tasks for the people who build Drypoint: `cargo xtask COMMAND`, one file per command.
//!
//! Nothing here depends on the crates it builds, so that it runs when they do not compile.

#![allow(clippy::print_stdout, reason = "what a task prints is what it is for")]

mod bench;
mod ci;
mod compiler;
mod manifest;
mod models;
mod mutants;
mod shell;
mod test;
mod tidy;
mod validate;

use std::process::ExitCode;

const HELP: &str = "\
Usage: cargo xtask <COMMAND>

  test [-- ARGS]       check the machine, then run every test; ARGS go to cargo test
  tidy                 check lengths, layers in Cargo.toml, links and the other rules of CONTRIBUTING.md
  validate [ARGS]      compare every extractor with the definition on every shape and model
  validate --boundary  look at every patch from where it is just culled, and at meshes from near by
  validate --mutants   break the bounds on purpose and compare who notices with docs/mutants.md;
                       with --bless: write that page
  bench [ARGS]         count and time every extractor, into target/report; --quick: in three minutes
  models [NAME...]     list the meshes that are worth having, their terms and sources; --download gets them
  ci                   what CI runs, in the same order

Meshes for test, validate and bench are looked for in the folder DRYPOINT_MODELS.
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match dispatch(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {}", message.trim_end());
            ExitCode::FAILURE
        }
    }
}

fn dispatch(arguments: &[String]) -> Result<(), String> {
    let Some((command, rest)) = arguments.split_first() else {
        print!("{HELP}");
        return Ok(());
    };
    // `validate` and `bench` hand their arguments on; these and `models` have a help of their own.
    let asks_help = rest.first().is_some_and(|first| first == "--help" || first == "-h");
    match command.as_str() {
        "test" | "tidy" | "ci" if asks_help => {
            print!("{HELP}");
            Ok(())
        }
        "test" => test::run(rest),
        "tidy" => no_arguments(command, rest).and_then(|()| tidy::run()),
        "validate" => validate::run(rest),
        "bench" => bench::run(rest),
        "models" => models::run(rest),
        "ci" => no_arguments(command, rest).and_then(|()| ci::run()),
        "help" | "--help" | "-h" => {
            print!("{HELP}");
            Ok(())
        }
        other => Err(format!("no command `{other}`\n\n{HELP}")),
    }
}

fn no_arguments(command: &str, rest: &[String]) -> Result<(), String> {
    match rest {
        [] => Ok(()),
        [argument, ..] => Err(format!("`{command}` takes no `{argument}`\n\n{HELP}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(arguments: &[&str], expected_error: Option<&str>) {
        let arguments: Vec<String> = arguments.iter().map(|&a| a.to_owned()).collect();
        let error = dispatch(&arguments).err();
        assert_eq!(error.as_deref().and_then(|e| e.lines().next()), expected_error);
    }

    #[test]
    fn help_is_no_error() {
        check(&[], None);
        check(&["--help"], None);
        check(&["test", "--help"], None);
    }

    #[test]
    fn what_is_not_known_is_an_error() {
        check(&["tset"], Some("no command `tset`"));
        check(&["tidy", "--fix"], Some("`tidy` takes no `--fix`"));
        check(
            &["models", "--get"],
            Some("`models` takes no `--get`; see `cargo xtask models --help`"),
        );
        check(&["ci", "now"], Some("`ci` takes no `now`"));
        check(
            &["test", "--quick"],
            Some("`test` takes no `--quick`; what cargo test should get comes after `--`"),
        );
    }
}
