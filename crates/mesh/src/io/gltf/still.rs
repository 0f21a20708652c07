//! A scene in which nothing moves: one mesh.

use glam::DAffine3;

use super::scene::Nodes;
use super::welded::{Found, Welded, add};
use super::{Piece, Surface};
use crate::io::error::ReadError;
use crate::io::parts::{self, Dropped, Model, Parts};

/// All triangles of the scene.
pub(super) struct Still<'a> {
    nodes: &'a Nodes,
    strict: bool,
    welded: Welded,
    triangles: Vec<[u32; 3]>,
    dropped: Dropped,
}

impl<'a> Still<'a> {
    /// With nodes at rest.
    pub(super) fn new(nodes: &'a Nodes, strict: bool) -> Self {
        let (welded, triangles, dropped) = Default::default();
        Self { nodes, strict, welded, triangles, dropped }
    }
}

impl Surface for Still<'_> {
    fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    fn add(&mut self, piece: &Piece<'_>) -> Result<(), ReadError> {
        let to_scene: DAffine3 = self.nodes.transform(piece.node);
        let mirrors = to_scene.matrix3.determinant() < 0.0;
        add(piece, &mut self.triangles, (&mut self.dropped, self.strict), |vertex| {
            let position = to_scene.transform_point3(piece.position(vertex));
            let found = self.welded.vertex(position.as_vec3());
            Ok(found.map_or(Found::Nowhere(position), |vertex| Found::Vertex(vertex, mirrors)))
        })
    }

    fn into_model(self, parts: Parts, materials: Parts) -> Result<Model, ReadError> {
        let model = parts::model(self.welded.positions, self.triangles, parts, materials)?;
        Ok(Model { dropped: self.dropped, ..model })
    }
}
