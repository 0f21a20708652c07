//! What a reader returns.

use std::ops::Range;

use glam::Vec3;

use super::ReadError;
use crate::rig::Rig;
use crate::{MAX_TRIANGLES, Mesh, MeshError};

/// A mesh and the names that the file gives to runs of its triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The mesh; at least one triangle.
    pub mesh: Mesh,
    /// In file order; the ranges follow one another and cover all triangles.
    pub parts: Vec<Part>,
    /// The same triangles by their material, cut and named anew: in file order, the ranges follow
    /// one another and cover all triangles, and no two that follow have one name. One run of the
    /// empty name where the file names no materials.
    pub materials: Vec<Part>,
    /// What of the file is not in the mesh.
    pub dropped: Dropped,
    /// The same triangles on vertices that move: of a glTF file with skins, morph targets or animations, or
    /// that places a mesh more than once. `mesh` is how it looks at rest.
    pub rig: Option<Rig>,
    /// For each vertex of the rig the one of `mesh` that it is at rest; empty without a rig.
    pub rig_vertices: Vec<u32>,
}

/// What a reader left out, because no surface can be made of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    /// Vertices that are NaN, infinite or beyond the range of f32. They keep their numbers, at the
    /// origin, and no triangle uses them.
    pub vertices: usize,
    /// Faces of the file that use such a vertex, each counted once, whatever its corners.
    pub faces: usize,
}

/// Triangles that belong together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// In [`Model::parts`] the latest `o` or `g` name in OBJ, the name of a solid in ascii STL; in
    /// glTF the name of the node, else of its mesh, else "node 3", followed by "/2" for primitive 2
    /// of a mesh of several. In [`Model::materials`] the latest `usemtl` name in OBJ, and in glTF
    /// the name of the material, else "material 3". Empty where the file gives none.
    pub name: String,
    /// Indices of its triangles; never empty.
    pub triangles: Range<u32>,
}

/// Parts while a file is read.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    /// Names, each with the number of triangles before it.
    starts: Vec<(String, usize)>,
}

impl Parts {
    /// From here on, triangles belong to `name`. A part without triangles is dropped; one of the
    /// same name as the part before it is a continuation.
    pub(super) fn begin(&mut self, name: String, triangle_count: usize) {
        if self.starts.last().is_some_and(|&(_, start)| start == triangle_count) {
            self.starts.pop();
        }
        if self.starts.last().is_none_or(|(last, _)| *last != name) {
            self.starts.push((name, triangle_count));
        }
    }

    /// Adds those of a piece that comes after so many triangles.
    pub(super) fn append(&mut self, piece: Self, triangle_count: usize) {
        for (name, start) in piece.starts {
            self.begin(name, triangle_count + start);
        }
    }

    /// The same without some of the triangles, given by their numbers in order.
    pub(super) fn without(self, removed: &[usize]) -> Self {
        let mut parts = Self::default();
        for (name, start) in self.starts {
            parts.begin(name, start - removed.partition_point(|&triangle| triangle < start));
        }
        parts
    }

    /// The parts of so many triangles.
    ///
    /// # Errors
    /// More than [`MAX_TRIANGLES`].
    fn ending_at(mut self, count: usize) -> Result<Vec<Part>, MeshError> {
        match self.starts.first_mut() {
            // What is before the first name belongs to an empty one.
            Some((name, start)) if name.is_empty() => *start = 0,
            Some((_, 0)) => {}
            _ => self.starts.insert(0, (String::new(), 0)),
        }
        let index = |triangle: usize| {
            let too_many = MeshError::TooManyTriangles { count };
            u32::try_from(triangle).ok().filter(|_| count <= MAX_TRIANGLES).ok_or(too_many)
        };
        let mut parts = Vec::with_capacity(self.starts.len());
        let mut end = count;
        for (name, start) in self.starts.into_iter().rev().filter(|&(_, start)| start < count) {
            parts.push(Part { name, triangles: index(start)?..index(end)? });
            end = start;
        }
        parts.reverse();
        Ok(parts)
    }
}

/// The model of these positions and triangles, with what is named in them.
///
/// # Errors
/// No triangles, or more than [`MAX_TRIANGLES`].
pub(super) fn model(
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    parts: Parts,
    materials: Parts,
) -> Result<Model, ReadError> {
    let count = triangles.len();
    if count == 0 {
        return Err(ReadError::NoFaces);
    }
    let (parts, materials) = (parts.ending_at(count)?, materials.ending_at(count)?);
    let mesh = Mesh::new(positions, triangles)?;
    Ok(Model { mesh, parts, materials, ..Model::default() })
}
