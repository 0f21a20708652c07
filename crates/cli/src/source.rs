//! Where the mesh comes from: a file, or a shape that is built in.

use std::path::Path;

use drypoint_fusion::PatchSet;
use drypoint_mesh::{Mesh, MeshAdjacency, io, shapes};

use crate::progress::Stage;

/// Extension of the files that `drypoint patches` writes.
pub(crate) const PATCHES_EXTENSION: &str = "patches";

/// Triangles of a built-in shape if the user names no count.
const SHAPE_TRIANGLES: usize = 20_000;

/// Most triangles of a built-in shape.
const MOST_SHAPE_TRIANGLES: usize = 10_000_000;

/// A mesh and what was known of it.
pub(crate) struct Source {
    /// As the user gave it, for messages.
    pub(crate) name: String,
    /// File name without folder and extension, or the shape's name.
    pub(crate) stem: String,
    pub(crate) model: io::Model,
}

impl Source {
    /// Reads a mesh file, or builds `shape:NAME` or `shape:NAME:TRIANGLES`.
    pub(crate) fn load(model: &Path) -> Result<Self, String> {
        let name = model.display().to_string();
        let _stage = Stage::new(&format!("reading {name}"));
        if let Some(shape) = name.strip_prefix("shape:") {
            let (shape, mesh) = build_shape(shape)?;
            let triangles = 0..u32::try_from(mesh.triangles().len()).map_err(|e| e.to_string())?;
            let parts = vec![io::Part { name: shape.to_owned(), triangles }];
            return Ok(Self { stem: stem(model), model: io::Model { mesh, parts }, name });
        }
        if is_patches_file(model) {
            return Err(format!("{name}: is a patch file; this command needs the mesh itself"));
        }
        if model.is_dir() {
            return Err(format!("{name}: is a folder, not a mesh file"));
        }
        let read = io::read(model).map_err(|error| format!("{name}: {error}"))?;
        Ok(Self { name, stem: stem(model), model: read })
    }

    pub(crate) fn mesh(&self) -> &Mesh {
        &self.model.mesh
    }

    /// Pairs the mesh's half-edges.
    pub(crate) fn adjacency(&self) -> MeshAdjacency {
        let _stage = Stage::new("finding edges");
        MeshAdjacency::new(self.mesh())
    }
}

/// File name of a model without folder and extension, or the name of its shape.
pub(crate) fn stem(model: &Path) -> String {
    let name = model.display().to_string();
    match name.strip_prefix("shape:") {
        Some(shape) => shape.split(':').next().unwrap_or_default().to_owned(),
        None => model.file_stem().unwrap_or_default().display().to_string(),
    }
}

/// Whether `path` is meant as a file that `drypoint patches` wrote.
pub(crate) fn is_patches_file(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(PATCHES_EXTENSION))
}

/// Loads a file that `drypoint patches` wrote.
pub(crate) fn load_patches(path: &Path) -> Result<PatchSet, String> {
    let _stage = Stage::new(&format!("reading {}", path.display()));
    let fail = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
    let bytes = std::fs::read(path).map_err(|error| fail(&error))?;
    PatchSet::from_bytes(&bytes).map_err(|error| fail(&error))
}

fn build_shape(shape: &str) -> Result<(&str, Mesh), String> {
    let (name, triangles) = match shape.split_once(':') {
        None => (shape, SHAPE_TRIANGLES),
        Some((name, count)) => match count.parse() {
            Ok(count) if count <= MOST_SHAPE_TRIANGLES => (name, count),
            _ => {
                return Err(format!(
                    "shape:{shape}: '{count}' is no number of triangles up to {MOST_SHAPE_TRIANGLES}"
                ));
            }
        },
    };
    match shapes::by_name(name, triangles) {
        Some(mesh) if !mesh.triangles().is_empty() => Ok((name, mesh)),
        Some(_) => Err(format!("shape:{shape}: has no faces")),
        None => Err(format!(
            "shape:{shape}: there is no shape '{name}'; there are {}",
            shapes::NAMES.join(", ")
        )),
    }
}
