//! Rules on the bare text of a file.

use super::Finding;
use super::tree::Tree;

/// Spelled in two halves, because the rule reads this file too.
const MARKERS: [&str; 3] = [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X")];

/// Marks in code and comments, and examples in docs that are not even compiled.
pub(crate) fn markers(tree: &Tree) -> Vec<Finding> {
    let mut found = Vec::new();
    for file in tree.with_extension("rs").chain(tree.with_extension("wgsl")) {
        for (index, line) in file.text.lines().enumerate() {
            let mut words = line.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            if let Some(marker) = words.find(|word| MARKERS.contains(word)) {
                found.push(file.finding(index + 1, format!("`{marker}`")));
            }
            if is_ignored_example(line) {
                found.push(file.finding(index + 1, "an example that is not compiled"));
            }
        }
    }
    found
}

pub(crate) fn newlines(tree: &Tree) -> Vec<Finding> {
    let mut found = Vec::new();
    for file in &tree.files {
        if !file.text.is_empty() && !file.text.ends_with('\n') {
            found.push(file.finding(file.text.lines().count(), "no newline at the end"));
        }
    }
    found
}

/// A doc comment that opens a code block with the word `ignore`.
fn is_ignored_example(line: &str) -> bool {
    let line = line.trim_start();
    let doc = line.strip_prefix("///").or_else(|| line.strip_prefix("//!"));
    let info = doc.and_then(|doc| doc.trim_start().strip_prefix("```"));
    info.is_some_and(|info| info.split([',', ' ']).any(|word| word.starts_with("ignore")))
}

#[cfg(test)]
mod tests {
    use super::super::testing::check;
    use super::MARKERS;

    const A: &str = "crates/mesh/src/a.rs";

    #[test]
    fn no_marker_is_left() {
        for marker in MARKERS {
            let found = &["crates/mesh/src/a.rs:2 marker"];
            check(&[(A, &format!("//! Docs.\n// {marker}: later.\n"))], found);
            check(&[(A, &format!("//! Docs.\n//{marker}(me)\n"))], found);
            check(&[(A, &format!("// A{marker} {marker}S.\n"))], &[]);
            check(&[("a.wgsl", &format!("// {marker}\n"))], &["a.wgsl:1 marker"]);
        }
    }

    #[test]
    fn examples_are_compiled() {
        check(&[(A, "//! ```ignore\n//! a\n//! ```\n")], &["crates/mesh/src/a.rs:1 marker"]);
        check(
            &[(A, "/// ```rust,ignore\n/// a\n/// ```\nfn a() {}\n")],
            &["crates/mesh/src/a.rs:1 marker"],
        );
        check(&[(A, "/// ```text\n/// ignore\n/// ```\nfn a() {}\n")], &[]);
    }

    #[test]
    fn the_last_line_ends() {
        check(&[(A, "fn a() {}\n\n// End.")], &["crates/mesh/src/a.rs:3 newline"]);
        check(&[("docs/a.md", "A")], &["docs/a.md:1 newline"]);
        check(&[(A, "")], &[]);
    }
}
