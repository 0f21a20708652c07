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
    model(&Document::parse(bytes, folder)?, strict)
}

fn model(document: &Document<'_>, strict: bool) -> Result<Model, ReadError> {
    let nodes = Nodes::of(&document.root)?;
    let drawn = nodes.drawn(&document.root)?;
    spend_on_places(document, &drawn)?;
    match Moving::new(document, &nodes, &drawn, strict)? {
        Some(moving) => read(document, &drawn, moving),
        None => read(document, &drawn, Still::new(&nodes, strict)),
    }
}

/// Takes what all places of meshes cost from what reading may cost, before any of them is read.
fn spend_on_places(document: &Document<'_>, drawn: &[usize]) -> Result<(), ReadError> {
    const TRIANGLE: u64 = 16;
    let root = &document.root;
    let available = document.buffers.iter().map(|buffer| buffer.len() as u64).sum::<u64>();
    let triangles = |primitive: &Primitive| {
        let positions = primitive.attributes.get(&Valid(Semantic::Positions));
        let corners = primitive.indices.or(positions.copied());
        let corners = corners.and_then(|corners| root.accessors.get(corners.value()));
        // More than there are bytes for is an error of its own.
        let corners = corners.map_or(0, |corners| corners.count.0).min(available);
        match primitive.mode {
            Valid(Mode::Triangles) => corners / 3,
            Valid(Mode::TriangleStrip | Mode::TriangleFan) => corners,
            _ => 0,
        }
    };
    let text = |name: &Option<String>| name.as_ref().map_or(0, |name| name.len() as u64 / 4);
    let of_primitive = |primitive: &Primitive| {
        let material = primitive.material.and_then(|material| root.materials.get(material.value()));
        TRIANGLE * triangles(primitive) + material.map_or(0, |material| text(&material.name))
    };
    let of_meshes: Vec<u64> = (root.meshes.iter())
        .map(|mesh| mesh.primitives.iter().map(of_primitive).fold(0, u64::saturating_add))
        .collect();
    for &node in drawn {
        let Some(index) = root.nodes[node].mesh.map(|mesh| mesh.value()) else { continue };
        let Some(mesh) = root.meshes.get(index) else { continue };
        // Each primitive is named after its node or its mesh.
        let names = text(&root.nodes[node].name).max(text(&mesh.name));
        let units = of_meshes[index].saturating_add(names * mesh.primitives.len() as u64);
        document.spend(units).map_err(|fault| fault.at(Place::Json(format!("nodes[{node}]"))))?;
    }
    Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle, of which all else is made: positions, indices, a time, a value, and zeros of which one is
    /// given anew.
    fn document(rest: &str) -> Vec<u8> {
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 48, "uri":
            "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAECAAAAAAAAAAAA"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 48}}], "accessors": [
            {{"bufferView": 0, "count": 3, "componentType": 5126, "type": "VEC3"}},
            {{"bufferView": 0, "byteOffset": 36, "count": 3, "componentType": 5121, "type": "SCALAR"}},
            {{"bufferView": 0, "byteOffset": 40, "count": 1, "componentType": 5126, "type": "SCALAR"}},
            {{"bufferView": 0, "count": 1, "componentType": 5126, "type": "VEC3"}},
            {{"count": 3, "componentType": 5126, "type": "VEC3", "sparse": {{"count": 1,
                "indices": {{"bufferView": 0, "byteOffset": 36, "componentType": 5121}},
                "values": {{"bufferView": 0}}}}}}], {rest}}}"#
        )
        .into_bytes()
    }

    /// What each further copy of `repeated`, which stands between the others, costs.
    #[track_caller]
    fn check(before: &str, repeated: &str, after: &str, expected: u64) {
        let cost = |count: usize| {
            let bytes = document(&format!("{before}{}{after}", vec![repeated; count].join(", ")));
            let document = Document::parse(&bytes, None).unwrap();
            let allowance = document.allowance.get();
            model(&document, true).unwrap_or_else(|error| panic!("{error}"));
            // The same with one unit less than it needs.
            let spent = allowance - document.allowance.get();
            document.allowance.set(spent - 1);
            let error = model(&document, true).unwrap_err().to_string();
            assert!(error.contains(": repeats data until"), "{error}");
            spent
        };
        assert_eq!(cost(7) - cost(3), 4 * expected, "{repeated}");
    }

    #[test]
    fn what_is_used_again_and_again_is_paid_for() {
        let mesh = |primitive: &str| {
            format!(
                r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}{primitive}}}]}}]"#
            )
        };
        // Places: a triangle, three vertices with an influence each.
        let before = mesh(r#", "indices": 1"#) + r#", "nodes": ["#;
        check(&before, r#"{"mesh": 0}"#, "]", 16 + 3 * 16);
        // Names, a fourth of their bytes.
        let name = "n".repeat(400);
        let named = format!(r#"{{"mesh": 0, "name": "{name}"}}"#);
        check(&before, &named, "]", 16 + 3 * 16 + 100);
        // Displacements: three of which two are not zero.
        let before = mesh(r#", "targets": [{"POSITION": 0}]"#);
        let (before, after) = before.split_at(before.find('[').unwrap() + 1);
        let (first, rest) = after.split_at(after.find(r#"{"POSITION": 0}]"#).unwrap());
        let (target, rest) = rest.split_at(r#"{"POSITION": 0}"#.len());
        let nodes = r#", "nodes": [{"mesh": 0}]"#;
        check(&format!("{before}{first}"), target, &format!("{rest}{nodes}"), 3 + 2 * 17);
        // The same of an accessor that is unpacked.
        let sparse = r#"{"POSITION": 4}"#;
        check(&format!("{before}{first}"), sparse, &format!("{rest}{nodes}"), 3 + 36);
        // Keys: one time, three numbers.
        let before = mesh("")
            + nodes
            + r#", "animations": [{"samplers": [{"input": 2, "output": 3}], "channels": ["#;
        let channel = r#"{"sampler": 0, "target": {"node": 0, "path": "translation"}}"#;
        check(&before, channel, "]}]", 8 * 4);
    }
}
