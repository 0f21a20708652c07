//! A small tree that breaks no rule, to plant one violation in.

use super::{RULES, Tree};
use std::fs;
use tempfile::TempDir;

const SOUND: [(&str, &str); 6] = [
    (
        "Cargo.toml",
        "[workspace]\nmembers = [\"crates/*\"]\n\n[workspace.package]\nrust-version = \"1.88\"\n\n\
         [workspace.dependencies]\nglam = \"0.34\"\ndrypoint-mesh = { path = \"crates/mesh\" }\n\
         drypoint-bounds = { path = \"crates/bounds\" }\nstrokes = { package = \"drypoint-lines\", path = \"crates/lines\" }\n",
    ),
    (
        "README.md",
        "# Drypoint\n\nIn [words](docs/words.md#edge-and-wing).\n\n\
         | crate | what |\n|---|---|\n| [`drypoint-mesh`](crates/mesh) | meshes |\n",
    ),
    ("docs/words.md", "# Words\n\n## Edge and `Wing`\n\nSee [above](#words).\n"),
    ("crates/mesh/Cargo.toml", MESH_MANIFEST),
    ("crates/mesh/src/lib.rs", "//! Meshes.\n\nmod mesh;\n\npub use mesh::Mesh;\n"),
    ("crates/mesh/src/mesh.rs", "/// A mesh.\npub struct Mesh;\n"),
];

/// Ends within `[dependencies]`, so that a test can add one.
pub(crate) const MESH_MANIFEST: &str = "[package]\nname = \"drypoint-mesh\"\ndescription = \"Meshes\"\n\
    rust-version.workspace = true\n\n[lints]\nworkspace = true\n\n[dependencies]\nglam.workspace = true\n";

/// The sound tree with these files added or put in the place of its own.
pub(crate) fn plant(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (path, text) in SOUND.iter().chain(files) {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().expect("it lies in the folder")).expect("a new folder");
        fs::write(path, text).expect("a new file");
    }
    folder
}

/// Plants `files` and expects exactly these findings of all rules, each as `path:line rule`.
#[track_caller]
pub(crate) fn check(files: &[(&str, &str)], expected: &[&str]) {
    let folder = plant(files);
    let tree = Tree::read(folder.path()).expect("the tree can be read");
    let mut found = Vec::new();
    for rule in RULES {
        let findings = (rule.check)(&tree).into_iter();
        found.extend(findings.map(|f| format!("{}:{} {}", f.path, f.line, rule.name)));
    }
    assert_eq!(found, expected);
}
