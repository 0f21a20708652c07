//! What every package says about itself, and what README.md says about the packages.

use super::Finding;
use super::tree::Tree;
use crate::manifest;
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use std::collections::BTreeSet;

pub(crate) fn manifests(tree: &Tree) -> Vec<Finding> {
    let mut found = Vec::new();
    if let Some(file) = tree.file("Cargo.toml")
        && manifest::rust_version(&tree.root).is_err()
    {
        found.push(file.finding(1, "no rust-version in [workspace.package]"));
    }
    for (file, manifest) in tree.packages() {
        let Some((_, line)) = manifest.string(&["package", "name"]) else { continue };
        let description = manifest.string(&["package", "description"]);
        if description.is_none_or(|(text, _)| text.trim().is_empty()) {
            found.push(file.finding(line, "no description"));
        }
        if !manifest.is_true(&["package", "rust-version", "workspace"]) {
            found.push(file.finding(line, "no `rust-version.workspace = true`"));
        }
        if !manifest.is_true(&["lints", "workspace"]) {
            found.push(file.finding(line, "no `[lints] workspace = true`"));
        }
    }
    found
}

/// Every package in crates/ is named in a table of README.md, or linked from it.
pub(crate) fn readme_table(tree: &Tree) -> Vec<Finding> {
    let readme = tree.file("README.md");
    let words = readme.map(|file| words_in_tables(&file.text)).unwrap_or_default();
    let mut found = Vec::new();
    for (file, manifest) in tree.packages().filter(|(file, _)| file.path.starts_with("crates/")) {
        let Some((name, line)) = manifest.string(&["package", "name"]) else { continue };
        if !words.contains(name) {
            found.push(file.finding(line, format!("no table in README.md names `{name}`")));
        }
    }
    found
}

/// README.md does not repeat which compiler is needed.
pub(crate) fn rust_version(tree: &Tree) -> Vec<Finding> {
    let mut found = Vec::new();
    for file in tree.files.iter().filter(|file| file.name() == "README.md") {
        for (index, line) in file.text.lines().enumerate() {
            if let Some(version) = names_a_compiler(line) {
                found.push(file.finding(index + 1, format!("compiler version {version}")));
            }
        }
    }
    found
}

fn words_in_tables(markdown: &str) -> BTreeSet<String> {
    let mut in_table = false;
    let mut words = BTreeSet::new();
    for event in Parser::new_ext(markdown, Options::ENABLE_TABLES) {
        match event {
            Event::Start(Tag::Table(_)) => in_table = true,
            Event::End(TagEnd::Table) => in_table = false,
            Event::Text(text) | Event::Code(text) if in_table => {
                words.extend(text.split_whitespace().map(str::to_owned));
            }
            _ => {}
        }
    }
    words
}

/// A version number of Rust since the 2018 edition, in a line that speaks of Rust. The line may hold
/// other figures too, so a bare `1.88` in a line about something else is let pass.
fn names_a_compiler(line: &str) -> Option<&str> {
    let lower = line.to_lowercase();
    let speaks_of_rust = ["rust", "msrv", "toolchain"].iter().any(|word| lower.contains(word));
    let mut words = line.split(|c: char| !c.is_ascii_alphanumeric() && c != '.');
    let is_version = |word: &&str| {
        let mut numbers = word.trim_matches('.').split('.');
        let (major, minor) = (numbers.next(), numbers.next().and_then(|n| n.parse::<u32>().ok()));
        major == Some("1") && minor.is_some_and(|minor| minor >= 31)
    };
    words.find(is_version).filter(|_| speaks_of_rust)
}

#[cfg(test)]
mod tests {
    use super::super::testing::{MESH_MANIFEST, check};

    const MESH: &str = "crates/mesh/Cargo.toml";

    #[test]
    fn a_package_says_what_it_is() {
        let found = &["crates/mesh/Cargo.toml:2 package"];
        check(&[(MESH, &MESH_MANIFEST.replace("description", "# description"))], found);
        check(&[(MESH, &MESH_MANIFEST.replace("\"Meshes\"", "\" \""))], found);
        check(&[(MESH, &MESH_MANIFEST.replace("[lints]", "[no-lints]"))], found);
        check(
            &[(
                MESH,
                &MESH_MANIFEST.replace("rust-version.workspace = true", "rust-version = \"1.88\""),
            )],
            found,
        );
    }

    #[test]
    fn the_workspace_names_its_compiler() {
        check(&[("Cargo.toml", "[workspace]\n")], &["Cargo.toml:1 package"]);
    }

    #[test]
    fn the_readme_lists_every_crate() {
        let found = &["crates/mesh/Cargo.toml:2 readme-table"];
        check(&[("README.md", "drypoint-mesh\n\n| crate |\n|---|\n| drypoint-mesher |\n")], found);
        check(&[("README.md", "| crate |\n|---|\n| drypoint-mesh |\n")], &[]);
    }

    #[test]
    fn the_readme_names_no_compiler() {
        let table = "| crate |\n|---|\n| drypoint-mesh |\n";
        let found = &["README.md:1 rust-version"];
        check(&[("README.md", &format!("Needs Rust 1.88 or newer.\n\n{table}"))], found);
        check(&[("README.md", &format!("rustc-1.90.0\n\n{table}"))], found);
        check(
            &[("README.md", &format!("Takes 1.88 s.\nA Rust crate of version 1.2.\n\n{table}"))],
            &[],
        );
    }
}
