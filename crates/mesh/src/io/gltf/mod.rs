//! glTF 2.0 and GLB: Khronos Group, glTF 2.0 Specification, 2.0.1, 2021.
//!
//! What is drawn is the default scene, or all scenes if none is, or all nodes if there is no scene.
//! Transforms are applied in f64. Skinned meshes are drawn in the rest pose of the scene (§3.7.3.3
//! of the specification: joint transform times inverse bind matrix, the node's own transform
//! unused), morph targets at weight 0. Where a transform mirrors, triangles are turned, so that the
//! outside stays outside. Points and lines are left out.
//!
//! The crate `gltf` parses the container and the JSON; its validation and its accessor readers are
//! not used, because at 1.4 they panic on indices, counts and strides that are out of range.
//! Integer positions (`KHR_mesh_quantization`) are read too.

mod accessor;
mod document;
mod scene;
mod skin;

use std::path::Path;

use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked::Valid;
use glam::{DVec3, Vec3};
use rustc_hash::FxHashMap;

use super::error::{Fault, Place, ReadError};
use super::parts::{self, Model, Parts};
use crate::{MAX_TRIANGLES, MeshError};
use accessor::Elements;
use document::Document;
use scene::Nodes;
use skin::Placement;

/// Reads a glTF or GLB file. Files it names are looked for in `folder`.
pub(super) fn parse(bytes: &[u8], folder: Option<&Path>) -> Result<Model, ReadError> {
    let document = Document::parse(bytes, folder)?;
    let nodes = Nodes::of(&document.root)?;
    let mut welded = Welded::default();
    let mut parts = Parts::default();
    for index in nodes.drawn(&document.root)? {
        let node = &document.root.nodes[index];
        let Some(mesh_index) = node.mesh.map(|mesh| mesh.value()) else { continue };
        let place = Place::Json(format!("nodes[{index}]"));
        let mesh = document::object(&document.root.meshes, mesh_index, "meshes", &place)?;
        let mut names = [&node.name, &mesh.name].into_iter().flatten();
        let name = names.next().cloned().unwrap_or_else(|| format!("node {index}"));
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let several = mesh.primitives.len() > 1;
            let name = if several { format!("{name}/{number}") } else { name.clone() };
            parts.begin(name, welded.triangles.len());
            let place = Place::Json(format!("meshes[{mesh_index}].primitives[{number}]"));
            if let Some(triangles) = triangles(&document, primitive, &place)? {
                let placement = Placement::new(&document, &nodes, index, primitive)?;
                welded.add(&document, primitive, &triangles, &placement, &place)?;
            }
        }
    }
    parts::model(welded.positions, welded.triangles, parts, Parts::default())
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

/// All triangles of the scene; vertices at one position are one.
#[derive(Default)]
struct Welded {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Vertices by the bits of their coordinates.
    known: FxHashMap<[u32; 3], u32>,
}

impl Welded {
    fn add(
        &mut self,
        document: &Document<'_>,
        primitive: &Primitive,
        triangles: &[[u32; 3]],
        placement: &Placement<'_>,
        place: &Place,
    ) -> Result<(), ReadError> {
        let count = self.triangles.len() + triangles.len();
        if count > MAX_TRIANGLES {
            return Err(MeshError::TooManyTriangles { count }.into());
        }
        let positions = positions(document, primitive, place)?;
        // For each vertex of the primitive its vertex of the scene, once it is used.
        let mut welded = vec![u32::MAX; positions.count()];
        self.triangles.reserve(triangles.len());
        for &triangle in triangles {
            let mut corners = [0; 3];
            for (corner, &vertex) in corners.iter_mut().zip(&triangle) {
                let vertex_count = positions.count() as u64;
                let slot = welded.get_mut(vertex as usize).ok_or_else(|| {
                    let vertex = i64::from(vertex);
                    Fault::VertexOutOfRange { vertex, vertex_count }.at(place.clone())
                })?;
                if *slot == u32::MAX {
                    let index = vertex as usize;
                    let stored = DVec3::from_array([0, 1, 2].map(|i| positions.real(index, i)));
                    let position =
                        placement.apply(index, stored).map_err(|f| f.at(place.clone()))?;
                    *slot = self.vertex(position, vertex).map_err(|f| f.at(place.clone()))?;
                }
                *corner = *slot;
            }
            let [a, b, c] = corners;
            let mirrored = placement.mirrors(triangle[0] as usize);
            self.triangles.push(if mirrored { [a, c, b] } else { corners });
        }
        Ok(())
    }

    /// The vertex at this position; `source` is its number in the file.
    fn vertex(&mut self, position: DVec3, source: u32) -> Result<u32, Fault> {
        // Adding 0 turns −0 into 0.
        let position = position.as_vec3() + Vec3::ZERO;
        if !position.is_finite() {
            let (vertex, position) = (u64::from(source), position.to_array());
            return Err(Fault::NotFinite { vertex, position });
        }
        let key = position.to_array().map(f32::to_bits);
        Ok(*self.known.entry(key).or_insert_with(|| {
            self.positions.push(position);
            // At most three to a triangle, and those are counted.
            u32::try_from(self.positions.len() - 1).unwrap_or(u32::MAX)
        }))
    }
}
