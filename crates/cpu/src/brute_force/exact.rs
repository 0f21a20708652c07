//! One exact sign per face.

use std::cmp::Ordering;

use drypoint_mesh::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, face_sides};

use crate::Statistics;

/// Tests every edge of a mesh: one exact sign per face, then two look-ups per edge.
///
/// What does not depend on the viewpoint is laid out once: which edges to test, and which faces
/// they lie between. 16 bytes an edge and 1 a face.
#[derive(Clone, Debug)]
pub struct BruteForce<'mesh> {
    mesh: &'mesh Mesh,
    edges: Vec<Candidate>,
    sides: Vec<Ordering>,
}

/// An edge and the faces it lies between.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    edge: EdgeId,
    left: u32,
    right: u32,
    /// The side of the right face that does not count as its front: the back, or, where the wing
    /// reads the face turned over, the front.
    right_back: Ordering,
}

impl<'mesh> BruteForce<'mesh> {
    /// Lays out the edges that `filter` keeps. Linear.
    pub fn new(mesh: &'mesh Mesh, adjacency: &MeshAdjacency, filter: EdgeFilter) -> Self {
        let candidate = |edge| {
            let [left, right] = adjacency.sides(edge).map(|half| half.triangle());
            let turned = adjacency.is_right_turned(edge);
            let right_back = if turned { Ordering::Greater } else { Ordering::Less };
            Candidate { edge, left, right, right_back }
        };
        let edges = adjacency.edges(filter).map(candidate).collect();
        Self { mesh, edges, sides: Vec::with_capacity(mesh.triangles().len()) }
    }

    /// Replaces `contours` by the contour edges seen from `viewpoint`, by id. Allocates nothing
    /// once `contours` is large enough.
    pub fn extract(&mut self, viewpoint: Viewpoint, contours: &mut Vec<EdgeId>) -> Statistics {
        face_sides(self.mesh, viewpoint, &mut self.sides);
        let sides = &self.sides;
        let is_contour = |candidate: &&Candidate| {
            let left_is_front = sides[candidate.left as usize] != Ordering::Less;
            let right_is_front = sides[candidate.right as usize] != candidate.right_back;
            left_is_front != right_is_front
        };
        contours.clear();
        contours.extend(self.edges.iter().filter(is_contour).map(|candidate| candidate.edge));
        Statistics {
            edges_tested: self.edges.len(),
            contour_edges: contours.len(),
            ..Statistics::default()
        }
    }

    /// How many edges are tested from each viewpoint.
    pub fn edge_count(&self) -> usize {
        self.edges.len()
    }
}
