//! Edges as fusion sees them: in f64, in a frame where half the longest side of the mesh is 1.

use drypoint_mesh::{EdgeClass, EdgeId, HalfEdge, Mesh, MeshAdjacency, unit_normal};
use glam::DVec3;
use rayon::prelude::*;

/// The planes and the place of one edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeShape {
    /// Unit normals of the left and the right face.
    pub(crate) normals: [DVec3; 2],
    /// Its ends in the mesh, lower first; equal numbers are equal places.
    pub(crate) vertices: [u32; 2],
    /// Where these are.
    pub(crate) ends: [DVec3; 2],
    /// Unit vector along it.
    pub(crate) direction: DVec3,
}

/// A mesh in a frame of its own, so that its unit and its place change nothing.
pub(crate) struct Frame<'a> {
    pub(crate) mesh: &'a Mesh,
    adjacency: &'a MeshAdjacency,
    center: DVec3,
    /// Half the longest side of the mesh's box.
    pub(crate) unit: f64,
    /// Of each triangle: 24 bytes each. Zero for one that spans no plane that can be trusted.
    normals: Vec<DVec3>,
}

impl<'a> Frame<'a> {
    /// `None` if the mesh has no extent, and so no face with an area.
    pub(crate) fn new(mesh: &'a Mesh, adjacency: &'a MeshAdjacency) -> Option<Self> {
        let bounds = mesh.bounds()?;
        let unit = bounds.half_longest_side();
        let normals = || {
            let triangles = mesh.triangles().par_iter();
            triangles
                .map(|&corners| {
                    unit_normal(corners.map(|vertex| mesh.position(vertex))).unwrap_or_default()
                })
                .collect()
        };
        (unit > 0.0).then(|| Self {
            mesh,
            adjacency,
            center: bounds.center(),
            unit,
            normals: normals(),
        })
    }

    fn position(&self, vertex: u32) -> DVec3 {
        (self.mesh.position(vertex).as_dvec3() - self.center) / self.unit
    }

    /// The middle of an edge, in model units.
    pub(crate) fn middle(&self, edge: EdgeId) -> DVec3 {
        let [a, b] = self.ends(edge).map(|vertex| self.mesh.position(vertex).as_dvec3());
        0.5 * (a + b)
    }

    /// The same in the frame.
    pub(crate) fn midpoint(&self, edge: EdgeId) -> DVec3 {
        (self.middle(edge) - self.center) / self.unit
    }

    /// Vertices at its ends, lower first; equal numbers are equal places.
    pub(crate) fn ends(&self, edge: EdgeId) -> [u32; 2] {
        self.adjacency.wing(edge).ends()
    }

    /// Whether both faces of the edge are there, and span planes that can be trusted.
    pub(crate) fn has_shape(&self, edge: EdgeId) -> bool {
        let is_trusted = |&triangle: &u32| self.normal(triangle) != DVec3::ZERO;
        self.adjacency.class(edge) != EdgeClass::Boundary
            && self.triangles(edge).0.iter().all(is_trusted)
    }

    /// `None` if [`Frame::has_shape`] is false.
    pub(crate) fn shape(&self, edge: EdgeId) -> Option<EdgeShape> {
        if !self.has_shape(edge) {
            return None;
        }
        let ([left, right], is_turned) = self.triangles(edge);
        let right = if is_turned { -self.normal(right) } else { self.normal(right) };
        let vertices = self.ends(edge);
        let [tail, head] = vertices.map(|v| self.mesh.position(v).as_dvec3());
        let direction = (head - tail).try_normalize()?;
        let ends = vertices.map(|v| self.position(v));
        Some(EdgeShape { normals: [self.normal(left), right], vertices, ends, direction })
    }

    /// Unit normal of a triangle; zero if it spans no plane that can be trusted.
    pub(crate) fn normal(&self, triangle: u32) -> DVec3 {
        self.normals[triangle as usize]
    }

    /// n · p of a triangle's plane, from the mean of its corners.
    pub(crate) fn offset(&self, triangle: u32) -> f64 {
        let corners = self.mesh.triangles()[triangle as usize];
        let middle: DVec3 = corners.iter().map(|&vertex| self.position(vertex)).sum();
        self.normal(triangle).dot(middle) / 3.0
    }

    /// The triangles on the left and the right of an edge that is no boundary, and whether the wing
    /// reads the right one turned over.
    pub(crate) fn triangles(&self, edge: EdgeId) -> ([u32; 2], bool) {
        let triangles = self.adjacency.sides(edge).map(HalfEdge::triangle);
        (triangles, self.adjacency.is_right_turned(edge))
    }
}
