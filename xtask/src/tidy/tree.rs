//! The files that the rules read.

use super::Finding;
use crate::manifest::Manifest;
use proc_macro2::{TokenStream, TokenTree};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use syn::{Item, ItemMod, Meta};

/// Text files of the workspace, in the order of their paths.
pub(crate) struct Tree {
    pub(crate) root: PathBuf,
    pub(crate) files: Vec<File>,
}

/// One text file.
pub(crate) struct File {
    /// From the root, with `/` between folders.
    pub(crate) path: String,
    pub(crate) text: String,
    /// `None` for what is not Rust, or does not parse.
    pub(crate) rust: Option<Rust>,
    /// Line and reason if this Rust file does not parse.
    error: Option<(usize, String)>,
    /// Holds tests or examples only: in `tests/`, `examples/` or `benches/`, or declared by a
    /// `#[cfg(test)] mod`.
    pub(crate) is_test: bool,
}

/// A Rust file, parsed.
pub(crate) struct Rust {
    pub(crate) tokens: TokenStream,
    pub(crate) items: Vec<Item>,
}

/// Everything a rule looks into. Pictures, lock files and golden files are none of their business.
const EXTENSIONS: [&str; 4] = ["rs", "wgsl", "toml", "md"];

impl Tree {
    /// Reads all text files below `root`, except build output and what starts with a dot.
    pub(crate) fn read(root: &Path) -> Result<Self, String> {
        let mut files = Vec::new();
        read_folder(root, "", &mut files)?;
        files.sort_by(|a, b| a.path.cmp(&b.path));
        let test_modules: BTreeSet<String> = files.iter().flat_map(test_modules).collect();
        for file in &mut files {
            file.is_test |= test_modules.contains(&file.path);
        }
        Ok(Self { root: root.to_owned(), files })
    }

    pub(crate) fn file(&self, path: &str) -> Option<&File> {
        self.files
            .binary_search_by(|file| file.path.as_str().cmp(path))
            .ok()
            .map(|i| &self.files[i])
    }

    /// Files with this extension.
    pub(crate) fn with_extension<'a>(
        &'a self,
        extension: &'a str,
    ) -> impl Iterator<Item = &'a File> {
        self.files.iter().filter(move |file| file.extension() == extension)
    }

    /// Every Rust file that parses.
    pub(crate) fn rust(&self) -> impl Iterator<Item = (&File, &Rust)> {
        self.files.iter().filter_map(|file| Some((file, file.rust.as_ref()?)))
    }

    /// Every manifest of a package of the workspace, with its file; not of those that are a
    /// workspace of their own.
    pub(crate) fn packages(&self) -> impl Iterator<Item = (&File, Manifest<'_>)> {
        let manifests = self.files.iter().filter(|file| file.path.ends_with("/Cargo.toml"));
        manifests
            .filter_map(|file| Some((file, Manifest::parse(&file.text).ok()?)))
            .filter(|(_, manifest)| !manifest.is_workspace())
    }

    /// The root's manifest; `None` if it is missing or does not parse.
    pub(crate) fn workspace(&self) -> Option<Manifest<'_>> {
        Manifest::parse(&self.file("Cargo.toml")?.text).ok()
    }
}

impl File {
    fn new(path: String, text: String) -> Self {
        let parsed = path.ends_with(".rs").then(|| parse(&text));
        let (rust, error) = match parsed {
            Some(Ok(rust)) => (Some(rust), None),
            Some(Err(error)) => (None, Some((error.span().start().line, error.to_string()))),
            None => (None, None),
        };
        let folders = path.rsplit_once('/').map_or("", |(folders, _)| folders).split('/');
        let is_test = folders.into_iter().any(|f| ["tests", "examples", "benches"].contains(&f));
        Self { path, text, rust, error, is_test }
    }

    pub(crate) fn name(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or(&self.path)
    }

    fn extension(&self) -> &str {
        self.path.rsplit_once('.').map_or("", |(_, extension)| extension)
    }

    pub(crate) fn finding(&self, line: usize, what: impl Into<String>) -> Finding {
        Finding { path: self.path.clone(), line, what: what.into() }
    }
}

/// Rust files and manifests that cannot be parsed: no other rule sees into them.
pub(crate) fn unreadable(tree: &Tree) -> Vec<Finding> {
    let mut found = Vec::new();
    for file in &tree.files {
        if let Some((line, error)) = &file.error {
            found.push(file.finding(*line, error.as_str()));
        }
        if let Some(error) =
            Manifest::parse(&file.text).err().filter(|_| file.name() == "Cargo.toml")
        {
            found.push(file.finding(1, error));
        }
    }
    found
}

fn parse(text: &str) -> Result<Rust, syn::Error> {
    let items = syn::parse_file(text)?.items;
    Ok(Rust { tokens: TokenStream::from_str(text)?, items })
}

fn read_folder(root: &Path, below: &str, files: &mut Vec<File>) -> Result<(), String> {
    let folder = root.join(below);
    let wrong = |e: std::io::Error| format!("{}: {e}", folder.display());
    for entry in fs::read_dir(&folder).map_err(wrong)? {
        let entry = entry.map_err(wrong)?;
        let kind = entry.file_type().map_err(wrong)?;
        let Ok(name) = entry.file_name().into_string() else { continue };
        let path = if below.is_empty() { name.clone() } else { format!("{below}/{name}") };
        if name.starts_with('.') || name == "target" {
            continue;
        }
        if kind.is_dir() {
            read_folder(root, &path, files)?;
        } else if kind.is_file() && EXTENSIONS.iter().any(|e| name.ends_with(&format!(".{e}"))) {
            let text = fs::read_to_string(entry.path()).map_err(|e| format!("{path}: {e}"))?;
            files.push(File::new(path, text));
        }
    }
    Ok(())
}

/// The files that `file` declares by `#[cfg(test)] mod name;`.
fn test_modules(file: &File) -> Vec<String> {
    let (folder, name) = file.path.rsplit_once('/').unwrap_or(("", &file.path));
    let below = match name {
        "lib.rs" | "main.rs" | "mod.rs" => folder.to_owned(),
        _ => format!("{folder}/{}", name.trim_end_matches(".rs")),
    };
    let items = file.rust.iter().flat_map(|rust| &rust.items);
    let declared = items.filter_map(|item| match item {
        Item::Mod(module) if module.content.is_none() && is_test_only(module) => {
            Some(&module.ident)
        }
        _ => None,
    });
    declared
        .flat_map(|name| [format!("{below}/{name}.rs"), format!("{below}/{name}/mod.rs")])
        .collect()
}

/// Whether the module is there for `cargo test` only: `#[cfg(test)]` or `#[cfg(all(test, …))]`.
pub(crate) fn is_test_only(module: &ItemMod) -> bool {
    module.attrs.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) if list.path.is_ident("cfg") => demands_test(list.tokens.clone()),
        _ => false,
    })
}

fn demands_test(tokens: TokenStream) -> bool {
    let mut before = None;
    tokens.into_iter().any(|token| {
        let found = match &token {
            TokenTree::Ident(name) => name == "test",
            TokenTree::Group(group) => {
                before.take().is_some_and(|name| name == "all") && demands_test(group.stream())
            }
            _ => false,
        };
        before = if let TokenTree::Ident(name) = token { Some(name) } else { None };
        found
    })
}

#[cfg(test)]
mod tests {
    use super::super::testing::check;

    #[test]
    fn what_does_not_parse_is_reported() {
        check(
            &[("crates/mesh/src/a.rs", "fn a() {}\n\nfn b( {}\n")],
            &["crates/mesh/src/a.rs:3 syntax"],
        );
    }

    #[test]
    fn build_output_and_hidden_folders_are_passed_over() {
        check(&[("target/a.rs", "fn ("), (".git/b.rs", "fn (")], &[]);
    }
}
