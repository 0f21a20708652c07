//! Where the mesh comes from: a file, or a shape that is built in.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use clap::Args;
use drypoint_fusion::{PatchFileError, PatchSet, mesh_hash};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, io, shapes};

use crate::args::Edges;
use crate::memory::{self, Work};
use crate::output::tell;
use crate::progress::Stage;

/// Extension of the files that `drypoint patches` writes.
pub(crate) const PATCHES_EXTENSION: &str = "patches";

/// How much of a file is read to see whether it holds patches.
const SNIFFED: u64 = 4096;

/// Triangles of a built-in shape if the user names no count.
const SHAPE_TRIANGLES: usize = 20_000;

/// Most triangles of a built-in shape.
const MOST_SHAPE_TRIANGLES: usize = 10_000_000;

/// How a mesh file is read.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct ReadArgs {
    /// Refuse a mesh file with a vertex that is NaN or infinite, rather than leave out the faces that
    /// use it
    #[arg(long)]
    pub(crate) strict: bool,
}

/// A mesh and what was known of it.
pub(crate) struct Source {
    /// As the user gave it, for messages.
    pub(crate) name: String,
    pub(crate) model: io::Model,
    /// Whether the mesh is a pose of a rig, so that vertices that meet in it are not one for that.
    pub(crate) is_posed: bool,
}

impl Source {
    /// Reads a mesh file, or builds `shape:NAME` or `shape:NAME:TRIANGLES`, if there is memory for what
    /// is to be done with it.
    pub(crate) fn load(model: &Path, read: ReadArgs, work: Work) -> Result<Self, String> {
        let name = model.display().to_string();
        let stage = Stage::new(&format!("reading {name}"));
        if let Some(shape) = name.strip_prefix("shape:") {
            let (shape, mesh) = build_shape(shape, work)?;
            let triangles = 0..u32::try_from(mesh.triangles().len()).map_err(|e| e.to_string())?;
            let run = |name: &str| io::Part { name: name.to_owned(), triangles: triangles.clone() };
            let (parts, materials) = (vec![run(shape)], vec![run("")]);
            let model = io::Model { mesh, parts, materials, ..io::Model::default() };
            return Ok(Self { model, name, is_posed: false });
        }
        if is_patches(model) {
            return Err(format!("{name}: is a patch file; a mesh is wanted here"));
        }
        if model.is_dir() {
            return Err(format!("{name}: is a folder, not a mesh file"));
        }
        memory::check(model, None, work)?;
        let options = io::ReadOptions { strict: read.strict };
        let model = io::read_with(model, &options).map_err(|error| format!("{name}: {error}"))?;
        drop(stage);
        let io::Dropped { vertices, faces } = model.dropped;
        if vertices > 0 {
            tell(&format!(
                "drypoint: {name}: left out what is at no finite position: vertices {vertices}, faces \
                 {faces}"
            ));
        }
        Ok(Self { name, model, is_posed: false })
    }

    /// Reads a mesh for drawing, and with it the patches if `model` is a .patches file: that holds
    /// edges but no triangles, which hide lines, so `mesh` must be what it was built from.
    pub(crate) fn load_with_patches(
        model: &Path,
        mesh: Option<&Path>,
        read: ReadArgs,
        work: Work,
    ) -> Result<(Self, Option<PatchSet>), String> {
        let name = model.display();
        match (is_patches(model), mesh) {
            (false, None) => Ok((Self::load(model, read, work)?, None)),
            (false, Some(_)) => Err(format!("--model: {name} is a mesh itself, no .patches file")),
            (true, None) => Err(format!(
                "{name}: holds no triangles, which hide lines; give the mesh it was built from \
                 with --model"
            )),
            (true, Some(mesh)) => {
                let patches = load_patches(model)?;
                let source = Self::load(mesh, read, Work::Patches)?;
                if mesh_hash(source.mesh()) != patches.provenance().mesh_hash {
                    return Err(format!("{name}: was not built from {}", source.name));
                }
                Ok((source, Some(patches)))
            }
        }
    }

    pub(crate) fn mesh(&self) -> &Mesh {
        &self.model.mesh
    }

    /// Pairs the mesh's half-edges.
    pub(crate) fn adjacency(&self) -> MeshAdjacency {
        let _stage = Stage::new("finding edges");
        self.adjacency_in_silence()
    }

    /// The same, without progress: one of many.
    pub(crate) fn adjacency_in_silence(&self) -> MeshAdjacency {
        if self.is_posed {
            MeshAdjacency::welded(self.mesh(), (0..).take(self.mesh().positions().len()).collect())
        } else {
            MeshAdjacency::new(self.mesh())
        }
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

/// Whether `path` is named as a file that `drypoint patches` writes.
pub(crate) fn is_named_patches(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(PATCHES_EXTENSION))
}

/// Whether a file is one that `drypoint patches` wrote: by how it begins, or by its name, so that a
/// damaged one is told as such. Never reads from a pipe, which could not be read again.
pub(crate) fn is_patches(path: &Path) -> bool {
    let begins_so = || {
        let file = File::open(path).ok().filter(|_| path.is_file())?;
        let mut start = Vec::new();
        file.take(SNIFFED).read_to_end(&mut start).ok()?;
        let foreign = matches!(PatchSet::from_bytes(&start), Err(PatchFileError::Foreign));
        Some(!start.is_empty() && !foreign)
    };
    is_named_patches(path) || begins_so().unwrap_or(false)
}

/// Loads a file that `drypoint patches` wrote.
pub(crate) fn load_patches(path: &Path) -> Result<PatchSet, String> {
    let _stage = Stage::new(&format!("reading {}", path.display()));
    let fail = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
    if path.is_dir() {
        return Err(fail(&"is a folder, not a patch file"));
    }
    let bytes = std::fs::read(path).map_err(|error| fail(&error))?;
    PatchSet::from_bytes(&bytes).map_err(|error| fail(&error))
}

/// The patches of the file `path`, if they are those of the edges that are `wanted`.
pub(crate) fn holding(
    patches: PatchSet,
    wanted: Option<Edges>,
    path: &Path,
) -> Result<PatchSet, String> {
    let filter = patches.edge_filter();
    if wanted.is_none_or(|wanted| filter == wanted.into()) {
        return Ok(patches);
    }
    let held = match filter {
        EdgeFilter::Convex => "convex",
        EdgeFilter::All => "all",
    };
    let name = path.display();
    Err(format!("{name}: holds the patches of {held} edges; leave --edges out, or build it anew"))
}

fn build_shape(shape: &str, work: Work) -> Result<(&str, Mesh), String> {
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
    memory::check(Path::new(&format!("shape:{shape}")), Some(triangles as u64), work)?;
    match shapes::by_name(name, triangles) {
        Some(mesh) if !mesh.triangles().is_empty() => Ok((name, mesh)),
        Some(_) => Err(format!("shape:{shape}: has no faces")),
        None => Err(format!(
            "shape:{shape}: there is no shape '{name}'; there are {}",
            shapes::NAMES.join(", ")
        )),
    }
}
