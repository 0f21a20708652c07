//! The triangles of a model, for passes of depths.

use std::ops::Range;

use drypoint_mesh::Mesh;

use crate::Part;

/// Triangles of the parts of a model as they lie in buffers: 12 bytes each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Triangles {
    /// Three vertices each, numbered on from part to part.
    pub indices: Vec<u32>,
    /// A [`Part`] for each part, at multiples of the alignment.
    pub uniforms: Vec<u8>,
    /// Where each part's uniform begins, and its indices.
    pub parts: Vec<(u32, Range<u32>)>,
}

impl Triangles {
    /// Of the meshes of all parts, in order. Uniforms begin at multiples of `alignment`, in bytes.
    ///
    /// # Panics
    /// If there are more than 2³² indices or vertices.
    pub fn new(meshes: &[&Mesh], alignment: usize) -> Self {
        let part_count = number(meshes.len());
        let stride = alignment.max(size_of::<Part>());
        let mut all = Self::default();
        let mut first_vertex = 0;
        for (part, mesh) in (0..).zip(meshes) {
            let first = number(all.indices.len());
            let triangles = mesh.triangles().iter().flatten();
            all.indices.extend(triangles.map(|vertex| first_vertex + vertex));
            first_vertex += number(mesh.positions().len());
            let indices = first..number(all.indices.len());
            all.parts.push((number(all.uniforms.len()), indices));
            all.uniforms.extend_from_slice(bytemuck::bytes_of(&Part { part, part_count }));
            all.uniforms.resize(all.uniforms.len().next_multiple_of(stride), 0);
        }
        all
    }
}

fn number(length: usize) -> u32 {
    u32::try_from(length).expect("what has a number is counted in 32 bits")
}
