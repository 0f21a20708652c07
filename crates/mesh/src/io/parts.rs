//! What a reader returns.

use std::ops::Range;

use glam::Vec3;

use super::ReadError;
use crate::{MAX_TRIANGLES, Mesh, MeshError};

/// A mesh and the names that the file gives to runs of its triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The mesh; at least one triangle.
    pub mesh: Mesh,
    /// In file order; the ranges follow one another and cover all triangles.
    pub parts: Vec<Part>,
}

/// Triangles that belong together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// The latest `o` or `g` name in OBJ, the name of a solid in ascii STL; in glTF the name of the
    /// node, else of its mesh, else "node 3", followed by "/2" for primitive 2 of a mesh of
    /// several. Empty where the file gives none.
    pub name: String,
    /// Indices of its triangles; never empty.
    pub triangles: Range<u32>,
}

/// Parts while a file is read.
#[derive(Debug, Default)]
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

    /// The model of these positions and triangles.
    ///
    /// # Errors
    /// No triangles, or more than [`MAX_TRIANGLES`].
    pub(super) fn into_model(
        mut self,
        positions: Vec<Vec3>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Model, ReadError> {
        let count = triangles.len();
        if count == 0 {
            return Err(ReadError::NoFaces);
        }
        if self.starts.first().is_none_or(|&(_, start)| start > 0) {
            self.starts.insert(0, (String::new(), 0));
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
        Ok(Model { mesh: Mesh::new(positions, triangles)?, parts })
    }
}
