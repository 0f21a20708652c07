//! glTF 2.0 and GLB: Khronos Group, glTF 2.0 Specification, 2.0.1, 2021.
//!
//! What is drawn is the default scene, or all scenes if none is, or all nodes if there is no scene.
//! Transforms are applied in f64. Skinned meshes follow their joints alone (§3.7.3.3 of the
//! specification: joint transform times inverse bind matrix, the node's own transform unused); morph
//! targets are added by the weights of the node, else of the mesh, else not at all. Where a transform
//! mirrors, triangles are turned, so that the outside stays outside. Points and lines are left out.
//!
//! A scene in which nothing can move and no mesh is placed twice is read by `still.rs`, any other by
//! `moving.rs`, as a rig.
//!
//! The crate `gltf` parses the container and the JSON; its validation and its accessor readers are
//! not used, because at 1.4 they panic on indices, counts and strides that are out of range.
//! Integer positions (`KHR_mesh_quantization`) are read too.

mod accessor;
mod animation;
mod document;
mod moving;
mod scene;
mod skin;
mod still;
mod welded;

use std::path::Path;

use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked::Valid;
use glam::DVec3;

use super::ReadOptions;
use super::error::{Fault, Place, ReadError};
use super::parts::{Model, Parts};
use accessor::Elements;
use document::{Document, object};
use moving::Moving;
use scene::Nodes;
use still::Still;

/// Reads a glTF or GLB file. Files it names are looked for in `folder`.
pub(super) fn parse(
    bytes: &[u8],
    folder: Option<&Path>,
    &ReadOptions { strict }: &ReadOptions,
) -> Result<Model, ReadError> {
    let document = Document::parse(bytes, folder)?;
    let nodes = Nodes::of(&document.root)?;
    let drawn = nodes.drawn(&document.root)?;
    match Moving::new(&document, &nodes, &drawn, strict)? {
        Some(moving) => read(&document, &drawn, moving),
        None => read(&document, &drawn, Still::new(&nodes, strict)),
    }
}

/// What takes the triangles of a scene.
trait Surface {
    fn triangle_count(&self) -> usize;
    fn add(&mut self, piece: &Piece<'_>) -> Result<(), ReadError>;
    fn into_model(self, parts: Parts, materials: Parts) -> Result<Model, ReadError>;
}

/// The triangles of one primitive at one node.
struct Piece<'a> {
    document: &'a Document<'a>,
    node: usize,
    mesh: usize,
    primitive: &'a Primitive,
    place: Place,
    /// In the primitive's own vertices, which may be out of range.
    triangles: Vec<[u32; 3]>,
    positions: Elements<'a>,
}

impl Piece<'_> {
    /// Where a vertex is stored.
    fn position(&self, vertex: usize) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|i| self.positions.real(vertex, i)))
    }
}

/// Hands the primitives at the `drawn` nodes to `surface`, one after the other.
fn read(
    document: &Document<'_>,
    drawn: &[usize],
    mut surface: impl Surface,
) -> Result<Model, ReadError> {
    let (mut parts, mut materials) = (Parts::default(), Parts::default());
    for &node in drawn {
        let Some(mesh_index) = document.root.nodes[node].mesh.map(|mesh| mesh.value()) else {
            continue;
        };
        let place = Place::Json(format!("nodes[{node}]"));
        let mesh = object(&document.root.meshes, mesh_index, "meshes", &place)?;
        let mut names = [&document.root.nodes[node].name, &mesh.name].into_iter().flatten();
        let name = names.next().cloned().unwrap_or_else(|| format!("node {node}"));
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let several = mesh.primitives.len() > 1;
            let name = if several { format!("{name}/{number}") } else { name.clone() };
            let place = Place::Json(format!("meshes[{mesh_index}].primitives[{number}]"));
            parts.begin(name, surface.triangle_count());
            materials.begin(material(document, primitive, &place)?, surface.triangle_count());
            if let Some(triangles) = triangles(document, primitive, &place)? {
                let positions = positions(document, primitive, &place)?;
                let mesh = mesh_index;
                let piece = Piece { document, node, mesh, primitive, place, triangles, positions };
                surface.add(&piece)?;
            }
        }
    }
    surface.into_model(parts, materials)
}

/// The name of a primitive's material, else "material 3"; empty if it has none.
fn material(
    document: &Document<'_>,
    primitive: &Primitive,
    place: &Place,
) -> Result<String, ReadError> {
    let Some(index) = primitive.material.map(|material| material.value()) else {
        return Ok(String::new());
    };
    let material = object(&document.root.materials, index, "materials", place)?;
    Ok(material.name.clone().unwrap_or_else(|| format!("material {index}")))
}

/// The triangles of a primitive in its own vertices, which may be out of range; `None` if it is
/// made of points or lines.
fn triangles(
    document: &Document<'_>,
    primitive: &Primitive,
    place: &Place,
) -> Result<Option<Vec<[u32; 3]>>, ReadError> {
    let Valid(mode) = primitive.mode else {
        return Err(Fault::WrongType { expected: "a known primitive mode" }.at(place.clone()));
    };
    if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
        return Ok(None);
    }
    let corners: Vec<u32> = match primitive.indices {
        Some(indices) => {
            let indices = Elements::indices(document, indices.value(), place)?;
            (0..indices.count()).map(|i| indices.integer(i, 0)).collect()
        }
        None => {
            let count = positions(document, primitive, place)?.count();
            (0..u32::try_from(count).unwrap_or(u32::MAX)).collect()
        }
    };
    let is_proper = |&[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    Ok(Some(match mode {
        Mode::TriangleStrip => {
            // Triangles that only stitch strips together have a corner twice.
            let turned = |(i, t): (usize, &[u32])| {
                if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[0], t[2], t[1]] }
            };
            corners.windows(3).enumerate().map(turned).filter(is_proper).collect()
        }
        Mode::TriangleFan => {
            let around = |pair: &[u32]| [pair[0], pair[1], corners[0]];
            corners.windows(2).skip(1).map(around).collect()
        }
        _ => corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
    }))
}

fn positions<'a>(
    document: &'a Document<'_>,
    primitive: &Primitive,
    place: &Place,
) -> Result<Elements<'a>, ReadError> {
    let positions = primitive.attributes.get(&Valid(Semantic::Positions));
    let missing = || Fault::Missing { missing: "attribute POSITION" }.at(place.clone());
    Elements::positions(document, positions.ok_or_else(missing)?.value(), place)
}
