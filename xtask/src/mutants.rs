//! `cargo xtask validate --mutants`: do the tests notice a broken bound?
//!
//! Each mutant is one textual replacement in a copy of the workspace; the tests of its suite run
//! there, and the tables of who noticed what must be those in `docs/mutants.md`. `--bless` writes
//! that file instead. Another crate joins in with a suite of its own in [`SUITES`].

mod bounds;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use crate::shell;
use bounds::BOUNDS;

/// Where the expected table is kept, from the root.
const TABLE: &str = "docs/mutants.md";

/// The tests of a package, and what they are put before.
struct Suite {
    package: &'static str,
    /// Which tests the columns stand for: a sentence above the table.
    about: &'static str,
    /// Columns of the table: heading, and what the names of the tests in it start with. What starts
    /// with none of them is a unit test, and counted in a last column.
    rings: &'static [(&'static str, &'static str)],
    mutants: &'static [Mutant],
}

/// One way to break the code.
struct Mutant {
    name: &'static str,
    /// From the root.
    file: &'static str,
    /// Must occur exactly once in the file.
    find: &'static str,
    replace: &'static str,
}

const SUITES: &[Suite] = &[Suite {
    package: "drypoint-bounds",
    about: "The rings are those of `crates/bounds/tests/rings.rs`.",
    rings: &[
        ("1 anything", "ring_1_"),
        ("2 grazing", "ring_2_"),
        ("3 rim", "ring_3_"),
        ("4 not vacuous", "ring_4_"),
    ],
    mutants: BOUNDS,
}];

const fn mutant(
    name: &'static str,
    file: &'static str,
    find: &'static str,
    replace: &'static str,
) -> Mutant {
    Mutant { name, file, find, replace }
}

/// Runs all mutants. Arguments: `--bless` writes the table instead of comparing.
///
/// # Errors
/// A test fails without a mutant, a replacement finds no place or leaves code that does not
/// compile, a mutant goes unnoticed, or the table is not the expected one.
pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    let mut bless = false;
    for argument in arguments.iter().filter(|&argument| argument != "--mutants") {
        match argument.as_str() {
            "--bless" => bless = true,
            other => {
                return Err(format!("`validate --mutants` takes no `{other}`, only `--bless`"));
            }
        }
    }
    let root = shell::root();
    let workspace = Copy::new(&root)?;
    let mut page = INTRODUCTION.to_owned();
    for suite in SUITES {
        workspace.check_unbroken(suite)?;
        let mut rows = Vec::new();
        for (index, mutant) in suite.mutants.iter().enumerate() {
            eprintln!(
                "{} {} of {}: {}",
                suite.package,
                index + 1,
                suite.mutants.len(),
                mutant.name
            );
            let caught = workspace.caught_by(suite, mutant)?;
            if !caught.contains(&true) {
                return Err(format!("no test notices the mutant {}", mutant.name));
            }
            rows.push((mutant.name, caught));
        }
        page += &section(suite, &rows);
    }
    print!("{page}");
    compare(&root.join(TABLE), &page, bless)
}

fn compare(path: &Path, page: &str, bless: bool) -> Result<(), String> {
    if bless {
        return fs::write(path, page).map_err(|e| format!("cannot write {}: {e}", path.display()));
    }
    let expected = fs::read_to_string(path).unwrap_or_default();
    let changes = changed_lines(&expected, page);
    if changes.is_empty() {
        return Ok(());
    }
    Err(format!("{TABLE} says otherwise; `--bless` rewrites it\n{changes}"))
}

/// Lines that only one of the texts has, marked `-` and `+`.
fn changed_lines(expected: &str, actual: &str) -> String {
    let [old, new] = [expected, actual].map(|text| text.lines().collect::<BTreeSet<_>>());
    let mut changes = String::new();
    for (mark, lines) in [("-", old.difference(&new)), ("+", new.difference(&old))] {
        lines.for_each(|line| writeln!(changes, "{mark} {line}").unwrap_or_default());
    }
    changes
}

/// A copy of the workspace, to be broken.
struct Copy {
    root: PathBuf,
    /// Shared by all mutants, so that only the broken package is built again.
    target: PathBuf,
}

impl Copy {
    fn new(root: &Path) -> Result<Self, String> {
        let target =
            std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
        let place = target.join("mutants");
        let copy = Self { root: place.join("workspace"), target: place.join("target") };
        mirror(root, &copy.root).map_err(|e| format!("cannot copy the workspace: {e}"))?;
        Ok(copy)
    }

    /// Whether all tests pass as long as nothing is broken.
    fn check_unbroken(&self, suite: &Suite) -> Result<(), String> {
        let failed = self.failed_tests(suite)?;
        match failed.first() {
            None => Ok(()),
            Some(test) => Err(format!("{} fails `{test}` without any mutant", suite.package)),
        }
    }

    /// For each column of its suite whether it notices the mutant.
    fn caught_by(&self, suite: &Suite, mutant: &Mutant) -> Result<Vec<bool>, String> {
        let path = self.root.join(mutant.file);
        let error = |e: std::io::Error| format!("{}: {e}", mutant.file);
        let sound = fs::read_to_string(&path).map_err(error)?;
        let broken = mutant.apply(&sound)?;
        fs::write(&path, broken).map_err(error)?;
        let failed = self.failed_tests(suite);
        fs::write(&path, sound).map_err(error)?;
        let failed = failed.map_err(|e| format!("mutant {}: {e}", mutant.name))?;
        Ok(columns(suite, &failed))
    }

    /// The names of the tests that fail.
    fn failed_tests(&self, suite: &Suite) -> Result<Vec<String>, String> {
        let arguments = [
            "test",
            "--quiet",
            "--locked",
            "--no-fail-fast",
            "--lib",
            "--tests",
            "--package",
            suite.package,
        ];
        let output = shell::cargo(arguments)
            .args(["--", "--format", "pretty"])
            .current_dir(&self.root)
            .env("CARGO_TARGET_DIR", &self.target)
            // Nobody reads the backtraces of mutants, and linking is half of what a mutant costs.
            .env("CARGO_PROFILE_TEST_DEBUG", "0")
            .env("RUST_BACKTRACE", "0")
            .output()
            .map_err(|e| format!("cannot start cargo: {e}"))?;
        let report = String::from_utf8_lossy(&output.stdout);
        let failed = failed_tests(&report);
        if !output.status.success() && failed.is_empty() {
            let errors = String::from_utf8_lossy(&output.stderr);
            return Err(format!("does not compile or run\n{errors}"));
        }
        Ok(failed)
    }
}

impl Mutant {
    fn apply(&self, source: &str) -> Result<String, String> {
        match source.matches(self.find).count() {
            1 => Ok(source.replacen(self.find, self.replace, 1)),
            count => Err(format!(
                "mutant {}: {} has {count} times what it replaces, not once: {}",
                self.name, self.file, self.find
            )),
        }
    }
}

/// Names in lines `test NAME ... FAILED`.
fn failed_tests(report: &str) -> Vec<String> {
    let name =
        |line: &str| Some(line.strip_prefix("test ")?.strip_suffix(" ... FAILED")?.to_owned());
    report.lines().filter_map(name).collect()
}

/// For each ring whether a test of it failed, and last whether any other test did.
fn columns(suite: &Suite, failed: &[String]) -> Vec<bool> {
    let in_ring = |test: &String, &(_, prefix): &(_, &str)| test.starts_with(prefix);
    let rings = suite.rings.iter().map(|ring| failed.iter().any(|test| in_ring(test, ring)));
    let others = failed.iter().any(|test| !suite.rings.iter().any(|ring| in_ring(test, ring)));
    rings.chain([others]).collect()
}

/// How [`TABLE`] begins.
const INTRODUCTION: &str = "\
# Who notices a broken bound

Each row breaks a package by one replacement in its source (`xtask/src/mutants.rs`) and runs its
tests: rings of tests that aim closer and closer to the edge of what the code claims, and the unit
tests beside the code. A ring that misses a mutant cannot be relied on to find that mistake.
`cargo xtask validate --mutants` compares this page with what it finds, `--mutants --bless` rewrites
it.
";

/// The table of one suite.
fn section(suite: &Suite, rows: &[(&str, Vec<bool>)]) -> String {
    let mut page = format!("\n## {}\n\n{}\n\n| Mutant |", suite.package, suite.about);
    let headings = suite.rings.iter().map(|&(heading, _)| heading).chain(["unit tests"]);
    headings.for_each(|heading| write!(page, " {heading} |").unwrap_or_default());
    page += "\n|---|";
    page += &"---|".repeat(suite.rings.len() + 1);
    for (name, caught) in rows {
        write!(page, "\n| {name} |").unwrap_or_default();
        for &caught in caught {
            page += if caught { " **caught** |" } else { " missed |" };
        }
    }
    page + "\n"
}

/// Makes `to` the same as `from`, but for hidden files and `target`. Files that are the same already
/// are not touched, so that cargo builds nothing twice.
fn mirror(from: &Path, to: &Path) -> std::io::Result<()> {
    fs::create_dir_all(to)?;
    let mut kept = BTreeSet::new();
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (name, kind) = (entry.file_name(), entry.file_type()?);
        let is_source = name != "target" && !name.as_encoded_bytes().starts_with(b".");
        let (source, copy) = (entry.path(), to.join(&name));
        if is_source && kind.is_dir() {
            mirror(&source, &copy)?;
        } else if is_source && kind.is_file() {
            let content = fs::read(&source)?;
            if fs::read(&copy).ok().as_ref() != Some(&content) {
                fs::write(&copy, content)?;
            }
        } else {
            continue;
        }
        kept.insert(name);
    }
    for entry in fs::read_dir(to)? {
        let entry = entry?;
        if !kept.contains(&entry.file_name()) {
            if entry.file_type()?.is_dir() {
                fs::remove_dir_all(entry.path())?;
            } else {
                fs::remove_file(entry.path())?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_replacement_has_its_place() {
        for mutant in SUITES.iter().flat_map(|suite| suite.mutants) {
            let source = fs::read_to_string(shell::root().join(mutant.file)).unwrap();
            let broken = mutant.apply(&source).unwrap();
            assert_ne!(source, broken, "{}", mutant.name);
        }
    }

    #[test]
    fn a_replacement_without_its_place_is_an_error() {
        let mutant = mutant("m", "m.rs", "sin", "cos");
        assert_eq!(mutant.apply("a sin b"), Ok("a cos b".to_owned()));
        assert!(mutant.apply("nothing").unwrap_err().contains("0 times"));
        assert!(mutant.apply("sin and sin").unwrap_err().contains("2 times"));
    }

    #[test]
    fn failures_are_sorted_into_columns() {
        let report = "running 3 tests\ntest ring_2_x ... FAILED\ntest ring_1_x ... ok\n\
                      test cone::tests::y ... FAILED\n\nfailures:\n    ring_2_x\n";
        let failed = failed_tests(report);
        assert_eq!(failed, ["ring_2_x", "cone::tests::y"]);
        assert_eq!(columns(&SUITES[0], &failed), [false, true, false, false, true]);
        assert_eq!(columns(&SUITES[0], &[]), [false; 5]);
    }

    #[test]
    fn the_page_is_a_table() {
        let page = section(&SUITES[0], &[("m", vec![true, false, false, false, true])]);
        assert!(page.ends_with("\n| m | **caught** | missed | missed | missed | **caught** |\n"));
        assert_eq!(changed_lines(&page, &page), "");
        assert_eq!(changed_lines("a\nb\n", "a\nc\n"), "- b\n+ c\n");
    }
}
