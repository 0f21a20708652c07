//! Which of our packages may depend on which. Arrows point down.

use super::Finding;
use super::tree::{File, Tree};
use crate::manifest::Manifest;

/// Each package, and those of ours below it. A package above may also depend on nothing.
const LAYERS: &[(&str, &[&str])] = &[
    ("drypoint-mesh", &[]),
    ("drypoint-bounds", &["drypoint-mesh"]),
    ("drypoint-fusion", &["drypoint-bounds", "drypoint-mesh"]),
    ("drypoint-cpu", &["drypoint-fusion", "drypoint-bounds", "drypoint-mesh"]),
    // A baseline must not see the fusion that it judges.
    ("drypoint-baselines", &["drypoint-bounds", "drypoint-mesh"]),
    ("drypoint-lines", &["drypoint-mesh"]),
    ("drypoint-shaders", &["drypoint-fusion", "drypoint-bounds", "drypoint-mesh"]),
    ("drypoint-wgpu", &["drypoint-shaders", "drypoint-fusion", "drypoint-bounds", "drypoint-mesh"]),
    ("drypoint-ash", &["drypoint-shaders", "drypoint-fusion", "drypoint-bounds", "drypoint-mesh"]),
    ("drypoint", LIBRARIES),
    ("drypoint-tests", LIBRARIES),
    // It has to run when they do not compile.
    ("xtask", &[]),
];

const LIBRARIES: &[&str] = &[
    "drypoint-mesh",
    "drypoint-bounds",
    "drypoint-fusion",
    "drypoint-cpu",
    "drypoint-baselines",
    "drypoint-lines",
    "drypoint-shaders",
    "drypoint-wgpu",
    "drypoint-ash",
];

pub(crate) fn arrows(tree: &Tree) -> Vec<Finding> {
    let Some(workspace) = tree.workspace() else { return Vec::new() };
    tree.packages().flat_map(|(file, manifest)| of_package(file, &manifest, &workspace)).collect()
}

fn of_package(file: &File, manifest: &Manifest<'_>, workspace: &Manifest<'_>) -> Vec<Finding> {
    let Some((name, line)) = manifest.string(&["package", "name"]) else { return Vec::new() };
    let Some((_, below)) = LAYERS.iter().find(|(package, _)| *package == name) else {
        return vec![
            file.finding(line, format!("`{name}` has no place in xtask/src/tidy/layers.rs")),
        ];
    };
    let is_ours = |package: &str| LAYERS.iter().any(|(ours, _)| *ours == package);
    let dependencies = manifest.dependencies(workspace).into_iter();
    let wrong =
        dependencies.filter(|d| is_ours(&d.package) && !below.contains(&d.package.as_str()));
    wrong
        .map(|d| file.finding(d.line, format!("`{name}` must not depend on `{}`", d.package)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::testing::{MESH_MANIFEST, check};

    const MESH: &str = "crates/mesh/Cargo.toml";
    const XTASK: &str = "xtask/Cargo.toml";

    fn mesh_with(lines: &str) -> String {
        format!("{MESH_MANIFEST}{lines}")
    }

    #[test]
    fn arrows_point_down() {
        let bounds = mesh_with("drypoint-mesh.workspace = true\n")
            .replace("name = \"drypoint-mesh\"", "name = \"drypoint-bounds\"");
        check(&[(XTASK, &bounds)], &[]);
        let xtask = bounds.replace("drypoint-bounds", "xtask");
        check(&[(XTASK, &xtask)], &["xtask/Cargo.toml:11 layers"]);
    }

    #[test]
    fn no_kind_of_dependency_points_up() {
        let found = &["crates/mesh/Cargo.toml:12 layers"];
        check(&[(MESH, &mesh_with("\ndrypoint-bounds.workspace = true\n"))], found);
        check(
            &[(MESH, &mesh_with("\nup = { package = \"drypoint-cpu\", version = \"1\" }\n"))],
            found,
        );
        check(&[(MESH, &mesh_with("\nstrokes.workspace = true\n"))], found);
        check(
            &[(MESH, &mesh_with("[dev-dependencies]\ndrypoint-bounds.workspace = true\n"))],
            found,
        );
        check(&[(MESH, &mesh_with("[build-dependencies]\ndrypoint-bounds = \"1\"\n"))], found);
        check(
            &[(MESH, &mesh_with("[target.'cfg(unix)'.dependencies]\ndrypoint-bounds = \"1\"\n"))],
            found,
        );
    }

    #[test]
    fn a_new_package_is_given_its_place() {
        let core = mesh_with("").replace("drypoint-mesh", "drypoint-core");
        check(&[(XTASK, &core)], &["xtask/Cargo.toml:2 layers"]);
        // What is no part of the workspace has none.
        check(&[("fuzz/Cargo.toml", &format!("[workspace]\n{core}"))], &[]);
    }
}
