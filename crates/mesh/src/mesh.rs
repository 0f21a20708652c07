//! Positions and triangles, as loaded.

use glam::{DVec3, Vec3};

/// Most triangles in one [`Mesh`], so that every half-edge `3 * triangle + corner` fits a `u32`
/// and [`HalfEdge::NONE`](crate::HalfEdge::NONE) stays free.
pub const MAX_TRIANGLES: usize = (u32::MAX / 3) as usize;

/// A triangle mesh: positions in the model's own unit, triangles counter-clockwise seen from
/// outside.
///
/// Every index is in range and every position is finite. Nothing else is promised: vertices may
/// repeat or go unused, triangles may have no area, lie twice in the same place or be wound any
/// way; [`MeshAdjacency`](crate::MeshAdjacency) copes and counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A mesh of these positions and triangles. Linear.
    ///
    /// # Errors
    /// The first triangle that names a missing vertex, the first position that is NaN or infinite,
    /// or more than [`MAX_TRIANGLES`].
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if triangles.len() > MAX_TRIANGLES {
            return Err(MeshError::TooManyTriangles { count: triangles.len() });
        }
        if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
            return Err(MeshError::NotFinite { vertex, position: positions[vertex] });
        }
        let vertex_count = positions.len();
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertex_count) {
                return Err(MeshError::VertexOutOfRange { triangle, vertex, vertex_count });
            }
        }
        Ok(Self { positions, triangles })
    }

    /// Vertex positions, in the order of the source.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Vertex indices of each triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Position of one vertex.
    ///
    /// # Panics
    /// If `vertex` is out of range.
    pub fn position(&self, vertex: u32) -> Vec3 {
        self.positions[vertex as usize]
    }

    /// Positions of the corners of one triangle.
    ///
    /// # Panics
    /// If `triangle` is out of range.
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|v| self.position(v))
    }

    /// The box around all vertices that a triangle uses; `None` if there is no triangle. Linear.
    pub fn bounds(&self) -> Option<Aabb> {
        let mut corners = self.triangles.iter().flatten().map(|&v| self.position(v));
        let first = corners.next()?;
        let start = Aabb { min: first, max: first };
        Some(corners.fold(start, |b, p| Aabb { min: b.min.min(p), max: b.max.max(p) }))
    }

    /// The same mesh moved so that the center of its box is the origin, and scaled so that the
    /// longest side of its box is 2: the unit scale that figures are quoted at. A mesh without
    /// extent is returned as it is.
    #[must_use]
    pub fn normalized(&self) -> Self {
        let Some(bounds) = self.bounds().filter(|b| b.half_longest_side() > 0.0) else {
            return self.clone();
        };
        let (center, scale) = (bounds.center(), 1.0 / bounds.half_longest_side());
        let to_unit = |p: &Vec3| ((p.as_dvec3() - center) * scale).as_vec3();
        let positions = self.positions.iter().map(to_unit).collect();
        // Only a vertex that no triangle uses can be far enough outside the box to overflow.
        Self::new(positions, self.triangles.clone()).unwrap_or_else(|_| self.clone())
    }
}

/// An axis-aligned box, in model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The point half-way between the corners, in f64 so that it is exact for every f32 box.
    pub fn center(&self) -> DVec3 {
        0.5 * (self.min.as_dvec3() + self.max.as_dvec3())
    }

    /// Lengths of the sides.
    pub fn size(&self) -> DVec3 {
        self.max.as_dvec3() - self.min.as_dvec3()
    }

    /// Half the longest side: the unit of view profiles, and of the distances of viewpoints in the papers.
    pub fn half_longest_side(&self) -> f64 {
        0.5 * self.size().max_element()
    }
}

/// Why positions and triangles make no [`Mesh`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} uses vertex {vertex}, but there are only {vertex_count}")]
    VertexOutOfRange {
        /// Index of the triangle, from 0.
        triangle: usize,
        /// The index it names, from 0.
        vertex: u32,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// A position is NaN or infinite.
    #[error("vertex {vertex} is at ({}, {}, {}), which is no finite position", position.x, position.y, position.z)]
    NotFinite {
        /// Index of the vertex, from 0.
        vertex: usize,
        /// Its position.
        position: Vec3,
    },
    /// More triangles than half-edge indices.
    #[error("{count} triangles are more than the {MAX_TRIANGLES} that fit one mesh")]
    TooManyTriangles {
        /// How many there are.
        count: usize,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner() -> Vec<Vec3> {
        vec![Vec3::ZERO, Vec3::X, Vec3::Y]
    }

    #[test]
    fn nonsense_is_refused_with_its_place() {
        assert_eq!(
            Mesh::new(corner(), vec![[0, 1, 2], [0, 1, 3]]),
            Err(MeshError::VertexOutOfRange { triangle: 1, vertex: 3, vertex_count: 3 })
        );
        let mut positions = corner();
        positions[2].y = f32::INFINITY;
        let error = Mesh::new(positions, vec![]).unwrap_err();
        assert_eq!(error.to_string(), "vertex 2 is at (0, inf, 0), which is no finite position");
    }

    #[test]
    fn the_box_ignores_unused_vertices() {
        let mut positions = corner();
        positions.push(Vec3::splat(f32::MAX));
        let mesh = Mesh::new(positions, vec![[0, 1, 2]]).unwrap();
        let bounds = mesh.bounds().unwrap();
        assert_eq!((bounds.min, bounds.max), (Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)));
        assert_eq!(bounds.half_longest_side(), 0.5);
        assert_eq!(Mesh::default().bounds(), None);
    }

    #[test]
    fn a_normalized_mesh_fills_the_unit_box() {
        let mesh = Mesh::new(corner(), vec![[0, 1, 2]]).unwrap().normalized();
        let bounds = mesh.bounds().unwrap();
        assert_eq!(
            (bounds.min, bounds.max),
            (Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 0.0))
        );
    }
}
