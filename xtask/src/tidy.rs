//! `cargo xtask tidy`: the rules of CONTRIBUTING.md that a machine can check, as failures.

mod layers;
mod lengths;
mod links;
mod packages;
mod text;
mod tokens;
mod tree;

#[cfg(test)]
mod testing;

use crate::shell;
use std::path::Path;
use tree::Tree;

/// A rule, the reason for it, and how to find what breaks it.
struct Rule {
    name: &'static str,
    reason: &'static str,
    check: fn(&Tree) -> Vec<Finding>,
}

/// A place that breaks a rule.
struct Finding {
    /// From the root, with `/` between folders.
    path: String,
    /// From 1.
    line: usize,
    what: String,
}

/// CONTRIBUTING.md lists them in this order.
const RULES: &[Rule] = &[
    Rule {
        name: "syntax",
        reason: "the other rules read what this file says",
        check: tree::unreadable,
    },
    Rule {
        name: "file-length",
        reason: "a file holds one algorithm or one type, and is read in one sitting",
        check: lengths::files,
    },
    Rule {
        name: "function-length",
        reason: "a longer function needs a line `// Long because …` that says why",
        check: lengths::functions,
    },
    Rule {
        name: "parameters",
        reason: "beyond five, a struct with a documented field each is easier to call",
        check: lengths::parameters,
    },
    Rule {
        name: "shader-length",
        reason: "a shader is one stage; what stages share is a file of its own",
        check: lengths::shaders,
    },
    Rule {
        name: "lib-rs",
        reason: "lib.rs is the table of contents: docs, `mod` and `pub use`",
        check: tokens::lib_rs,
    },
    Rule {
        name: "unsafe",
        reason: "only crates/ash and SIMD kernels (simd*.rs) may need it",
        check: tokens::unsafe_code,
    },
    Rule {
        name: "unfinished",
        reason: "what is left to do is an issue, not a mark in the code",
        check: tokens::unfinished,
    },
    Rule { name: "marker", reason: "what is left to do is an issue", check: text::markers },
    Rule { name: "newline", reason: "a text file ends with a line", check: text::newlines },
    Rule {
        name: "layers",
        reason: "arrows point down, so that each crate can be used without those above",
        check: layers::arrows,
    },
    Rule {
        name: "package",
        reason: "each package says what it is, and shares one rust-version and one set of lints",
        check: packages::manifests,
    },
    Rule {
        name: "readme-table",
        reason: "the table of crates in README.md is how users choose one",
        check: packages::readme_table,
    },
    Rule {
        name: "rust-version",
        reason: "the oldest compiler stands in Cargo.toml alone, a copy would go stale",
        check: packages::rust_version,
    },
    Rule { name: "link", reason: "a reader follows it", check: links::links },
];

pub(crate) fn run() -> Result<(), String> {
    check(&shell::root())
}

/// Prints each finding as `path:line: what (rule: reason)`, in the order of the rules.
pub(crate) fn check(root: &Path) -> Result<(), String> {
    let tree = Tree::read(root)?;
    let mut count = 0;
    for rule in RULES {
        for Finding { path, line, what } in (rule.check)(&tree) {
            println!("{path}:{line}: {what} ({}: {})", rule.name, rule.reason);
            count += 1;
        }
    }
    let files = tree.files.len();
    match count {
        0 => {
            println!("{files} files are tidy by {} rules", RULES.len());
            Ok(())
        }
        1 => Err(format!("1 finding in {files} files")),
        _ => Err(format!("{count} findings in {files} files")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sound_tree_breaks_no_rule() {
        testing::check(&[], &[]);
    }

    #[test]
    fn a_finding_is_a_failure() {
        let sound = testing::plant(&[]);
        assert_eq!(check(sound.path()), Ok(()));
        let broken = testing::plant(&[("crates/mesh/src/a.rs", "fn a() {}")]);
        assert_eq!(check(broken.path()), Err("1 finding in 7 files".to_owned()));
    }

    /// The guide for contributors names every rule, in this order.
    #[test]
    fn contributing_lists_the_rules() {
        let guide =
            std::fs::read_to_string(shell::root().join("CONTRIBUTING.md")).expect("it exists");
        let listed = |line: &str| Some(line.strip_prefix("- `")?.split_once('`')?.0.to_owned());
        let listed: Vec<String> = guide.lines().filter_map(listed).collect();
        assert_eq!(listed, RULES.iter().map(|rule| rule.name).collect::<Vec<_>>());
    }
}
