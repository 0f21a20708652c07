//! The triangles of a model, for passes of depths.

use std::ops::Range;

use drypoint_mesh::Mesh;
use drypoint_mesh::rig::Skin;

use crate::{BendingFace, Part, RigLayout};

/// Triangles of the parts of a model as they lie in buffers: 12 bytes each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Triangles {
    /// Three vertices each, numbered on from part to part.
    pub indices: Vec<u32>,
    /// A [`Part`] for each part, at multiples of the alignment.
    pub uniforms: Vec<u8>,
    /// The parts.
    pub parts: Vec<TrianglePart>,
}

/// Triangles that are drawn together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrianglePart {
    /// Where its uniform begins.
    pub uniform: u32,
    /// Its indices.
    pub indices: Range<u32>,
    /// How many times each instance has them. `None` if each instance has vertices of its own, among which the
    /// indices count.
    pub copies: Option<u32>,
}

impl Triangles {
    /// Of the meshes of all parts, in order. Uniforms begin at multiples of `alignment`, in bytes.
    ///
    /// # Panics
    /// If there are more than 2³² indices or vertices.
    pub fn new(meshes: &[&Mesh], alignment: usize) -> Self {
        let part_count = number(meshes.len());
        let mut all = Self::default();
        let mut first_vertex = 0;
        for (part, mesh) in (0..).zip(meshes) {
            let part = Part { part, part_count, first_placement: 0 };
            all.add_mesh(mesh, &mut first_vertex, (part, 1), alignment);
        }
        all
    }

    /// Of a rig that is laid out so: the shapes of its parts, and its faces that bend. `None` if `skin` is of
    /// another rig.
    ///
    /// # Panics
    /// As [`Triangles::new`].
    pub fn of_rig(
        (layout, bending): (&RigLayout, &[BendingFace]),
        skin: &Skin,
        most_instances: u32,
        alignment: usize,
    ) -> Option<Self> {
        let mut all = Self::default();
        let mut first_vertex = 0;
        for class in &layout.classes {
            let part_count = number(class.shapes.len());
            let first_placement = class.placements_before * most_instances;
            for (part, &shape) in (0..).zip(&class.shapes) {
                let mesh = &skin.shapes().get(shape as usize)?.mesh;
                let part = Part { part, part_count, first_placement };
                all.add_mesh(mesh, &mut first_vertex, (part, class.copies), alignment);
            }
        }
        if first_vertex != layout.counts.first_vertex {
            return None;
        }
        if !bending.is_empty() {
            let first_placement = layout.part_count() * most_instances;
            let part = Part { part: 0, part_count: 1, first_placement };
            let vertices = bending.iter().flat_map(|face| face.corners);
            all.add(vertices, part, None, alignment);
        }
        Some(all)
    }

    fn add_mesh(
        &mut self,
        mesh: &Mesh,
        first_vertex: &mut u32,
        (part, copies): (Part, u32),
        alignment: usize,
    ) {
        let first = *first_vertex;
        let vertices = mesh.triangles().iter().flatten().map(|vertex| first + vertex);
        self.add(vertices, part, Some(copies), alignment);
        *first_vertex += number(mesh.positions().len());
    }

    fn add(
        &mut self,
        vertices: impl Iterator<Item = u32>,
        part: Part,
        copies: Option<u32>,
        alignment: usize,
    ) {
        let first = number(self.indices.len());
        self.indices.extend(vertices);
        let indices = first..number(self.indices.len());
        self.parts.push(TrianglePart { uniform: number(self.uniforms.len()), indices, copies });
        self.uniforms.extend_from_slice(bytemuck::bytes_of(&part));
        let stride = alignment.max(size_of::<Part>());
        self.uniforms.resize(self.uniforms.len().next_multiple_of(stride), 0);
    }
}

fn number(length: usize) -> u32 {
    u32::try_from(length).expect("what has a number is counted in 32 bits")
}
