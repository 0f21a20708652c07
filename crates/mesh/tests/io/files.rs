//! Files made in memory, and the two checks of what is read from them.

use std::fmt::Write;
use std::ops::Range;

use drypoint_mesh::io::{Format, Model, Part, parse};
use glam::Vec3;

/// The one place that asks for positions and triangles.
#[track_caller]
pub(crate) fn check(
    format: Format,
    bytes: &[u8],
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
) -> Model {
    let model = parse(format, bytes).unwrap_or_else(|error| panic!("{error}"));
    let expected: Vec<Vec3> = positions.iter().map(|&p| p.into()).collect();
    assert_eq!(model.mesh.positions(), expected);
    assert_eq!(model.mesh.triangles(), triangles);
    model
}

/// The one place that asks for parts.
#[track_caller]
pub(crate) fn check_parts(model: &Model, expected: &[(&str, Range<u32>)]) {
    check_runs(&model.parts, expected);
}

/// The one place that asks for materials.
#[track_caller]
pub(crate) fn check_materials(model: &Model, expected: &[(&str, Range<u32>)]) {
    check_runs(&model.materials, expected);
}

#[track_caller]
fn check_runs(runs: &[Part], expected: &[(&str, Range<u32>)]) {
    let found: Vec<_> = runs.iter().map(|r| (r.name.as_str(), r.triangles.clone())).collect();
    assert_eq!(found, expected);
}

/// A PLY header.
pub(crate) fn ply(encoding: &str, declarations: &str) -> String {
    format!("ply\nformat {encoding} 1.0\n{declarations}\nend_header\n")
}

/// A binary STL file of these corners, three to a facet.
pub(crate) fn binary_stl(header: &[u8], corners: &[[f32; 3]]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(u32::try_from(corners.len() / 3).unwrap().to_le_bytes());
    for facet in corners.chunks_exact(3) {
        bytes.extend([0; 12]);
        bytes.extend(facet.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// A GLB file of this JSON and binary chunk.
pub(crate) fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (name, chunk, filler) in [(b"JSON", json.as_bytes(), b' '), (b"BIN\0", binary, 0)] {
        let length = chunk.len().next_multiple_of(4);
        bytes.extend(u32::try_from(length).unwrap().to_le_bytes());
        bytes.extend(name);
        bytes.extend(chunk);
        bytes.resize(bytes.len() + length - chunk.len(), filler);
    }
    let length = u32::try_from(bytes.len()).unwrap().to_le_bytes();
    bytes[8..12].copy_from_slice(&length);
    bytes
}

/// Builds a glTF document: data first, then the JSON that uses it.
#[derive(Default)]
pub(crate) struct Gltf {
    binary: Vec<u8>,
    views: String,
    accessors: String,
    view_count: usize,
    accessor_count: usize,
}

impl Gltf {
    /// Adds data as a view and an accessor of it; `kind` is its component type and shape, and what
    /// else it says. Returns the accessor's index.
    pub(crate) fn data(&mut self, bytes: &[u8], count: usize, kind: &str) -> usize {
        let view = self.view(bytes);
        self.accessor(&format!(r#""bufferView": {view}, "count": {count}, {kind}"#))
    }

    /// Adds data as a view. Returns its index.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        let (offset, length) = (self.binary.len(), bytes.len());
        let comma = if self.view_count > 0 { "," } else { "" };
        let view = format!(r#"{{"buffer": 0, "byteOffset": {offset}, "byteLength": {length}}}"#);
        write!(self.views, "{comma}{view}").unwrap();
        self.binary.extend(bytes);
        self.view_count += 1;
        self.view_count - 1
    }

    /// Adds an accessor as it is. Returns its index.
    pub(crate) fn accessor(&mut self, fields: &str) -> usize {
        let comma = if self.accessor_count > 0 { "," } else { "" };
        write!(self.accessors, "{comma}{{{fields}}}").unwrap();
        self.accessor_count += 1;
        self.accessor_count - 1
    }

    /// Adds f32 as an accessor of this shape, such as VEC3.
    pub(crate) fn floats(&mut self, values: &[f32], shape: &str) -> usize {
        let size = match shape {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let kind = format!(r#""componentType": 5126, "type": "{shape}""#);
        self.data(&bytes, values.len() / size, &kind)
    }

    /// Adds vertex indices of 16 bits.
    pub(crate) fn shorts(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.data(&bytes, values.len(), r#""componentType": 5123, "type": "SCALAR""#)
    }

    /// The document with this rest, in a buffer of this uri.
    pub(crate) fn json(&self, uri: &str, rest: &str) -> String {
        let Self { binary, views, accessors, .. } = self;
        let length = binary.len();
        let data = format!(
            r#""buffers": [{{{uri} "byteLength": {length}}}], "bufferViews": [{views}], "accessors": [{accessors}]"#
        );
        format!(r#"{{"asset": {{"version": "2.0"}}, {data}, {rest}}}"#)
    }

    /// The same as a GLB file.
    pub(crate) fn glb(&self, rest: &str) -> Vec<u8> {
        glb(&self.json("", rest), &self.binary)
    }

    /// The binary data so far.
    pub(crate) fn binary(&self) -> &[u8] {
        &self.binary
    }
}

/// The corners of one triangle.
pub(crate) const CORNERS: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

/// A GLB file whose only mesh, "tri", is one triangle, with these nodes and whatever else.
pub(crate) fn one_triangle(nodes: &str, rest: &str) -> Vec<u8> {
    let mut gltf = Gltf::default();
    let positions = gltf.floats(&CORNERS, "VEC3");
    let mesh = format!(
        r#"{{"name": "tri", "primitives": [{{"attributes": {{"POSITION": {positions}}}}}]}}"#
    );
    gltf.glb(&format!(r#""meshes": [{mesh}], "nodes": {nodes}{rest}"#))
}
