//! Reading `Cargo.toml` files, with the line of each thing.

use std::fs;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

/// One manifest, parsed from a text that the caller keeps.
pub(crate) struct Manifest<'t> {
    text: &'t str,
    table: DeTable<'t>,
}

/// One line of a `[dependencies]` table, also of the dev, build and per-target ones.
pub(crate) struct Dependency {
    /// The name of the package, which is not the key if it is renamed.
    pub(crate) package: String,
    pub(crate) line: usize,
}

impl<'t> Manifest<'t> {
    pub(crate) fn parse(text: &'t str) -> Result<Self, String> {
        let table = DeTable::parse(text).map_err(|e| e.to_string())?;
        Ok(Self { text, table: table.into_inner() })
    }

    /// The string at `path`, e.g. `["package", "name"]`, and its line.
    pub(crate) fn string(&self, path: &[&str]) -> Option<(&str, usize)> {
        let value = at(&self.table, path)?;
        Some((value.get_ref().as_str()?, self.line(value.span().start)))
    }

    /// Whether it is the root of a workspace, its own or that of others.
    pub(crate) fn is_workspace(&self) -> bool {
        at(&self.table, &["workspace"]).is_some()
    }

    pub(crate) fn is_true(&self, path: &[&str]) -> bool {
        at(&self.table, path).and_then(|value| value.get_ref().as_bool()) == Some(true)
    }

    /// The keys of the table at `path`, in alphabetical order; none if there is no such table.
    pub(crate) fn keys(&self, path: &[&str]) -> Vec<String> {
        let table = at(&self.table, path).and_then(|value| value.get_ref().as_table());
        table.into_iter().flatten().map(|(key, _)| key.get_ref().to_string()).collect()
    }

    /// All dependencies, of every kind and target, in the order of the file. `workspace` is the
    /// root's manifest, which says what `workspace = true` stands for.
    pub(crate) fn dependencies(&self, workspace: &Manifest<'_>) -> Vec<Dependency> {
        let mut tables = dependency_tables(&self.table);
        let targets = at(&self.table, &["target"]).and_then(|value| value.get_ref().as_table());
        for (_, target) in targets.into_iter().flatten() {
            tables.extend(target.get_ref().as_table().into_iter().flat_map(dependency_tables));
        }
        let mut found: Vec<Dependency> = tables
            .into_iter()
            .flatten()
            .map(|(key, value)| Dependency {
                package: workspace.package_of(key.get_ref(), value),
                line: self.line(key.span().start),
            })
            .collect();
        found.sort_by_key(|dependency| dependency.line);
        found
    }

    /// The package that the dependency `key = value` of any member means.
    fn package_of(&self, key: &str, value: &Spanned<DeValue<'_>>) -> String {
        let shared = at(&self.table, &["workspace", "dependencies", key]);
        let is_shared = field(value, "workspace").and_then(DeValue::as_bool) == Some(true);
        let value = if is_shared { shared.unwrap_or(value) } else { value };
        field(value, "package").and_then(DeValue::as_str).unwrap_or(key).to_owned()
    }

    fn line(&self, offset: usize) -> usize {
        line_of(self.text, offset)
    }
}

/// The number of the line, from 1, that holds the byte at `offset`.
pub(crate) fn line_of(text: &str, offset: usize) -> usize {
    1 + text.as_bytes()[..offset.min(text.len())].iter().filter(|&&byte| byte == b'\n').count()
}

/// The oldest compiler that the workspace promises to build with. It stands in one place only.
pub(crate) fn rust_version(root: &Path) -> Result<String, String> {
    let path = root.join("Cargo.toml");
    let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let manifest = Manifest::parse(&text).map_err(|e| format!("{}: {e}", path.display()))?;
    let version = manifest.string(&["workspace", "package", "rust-version"]);
    let (version, _) = version.ok_or_else(|| format!("{}: no rust-version", path.display()))?;
    Ok(version.to_owned())
}

fn at<'m, 't>(table: &'m DeTable<'t>, path: &[&str]) -> Option<&'m Spanned<DeValue<'t>>> {
    let (first, rest) = path.split_first()?;
    let value = table.iter().find(|(key, _)| key.get_ref() == first).map(|(_, value)| value)?;
    if rest.is_empty() { Some(value) } else { at(value.get_ref().as_table()?, rest) }
}

fn field<'m, 't>(value: &'m Spanned<DeValue<'t>>, name: &str) -> Option<&'m DeValue<'t>> {
    at(value.get_ref().as_table()?, &[name]).map(Spanned::get_ref)
}

type Entry<'m, 't> = (&'m Spanned<DeString<'t>>, &'m Spanned<DeValue<'t>>);

fn dependency_tables<'m, 't>(table: &'m DeTable<'t>) -> Vec<Vec<Entry<'m, 't>>> {
    ["dependencies", "dev-dependencies", "build-dependencies"]
        .iter()
        .filter_map(|kind| at(table, &[kind])?.get_ref().as_table())
        .map(|table| table.iter().collect())
        .collect()
}
