//! Edges as fusion sees them: in f64, in a frame where half the longest side of the mesh is 1.

use drypoint_mesh::{EdgeId, HalfEdge, Mesh, MeshAdjacency, Wing};
use glam::DVec3;

/// Sine of the smallest corner angle at which a face's normal is trusted. Differences of f32 lose at
/// most 2⁻⁵³ of their size in f64, so above this the normal is off by some 1e-8 radians, well within
/// what the bounds are grown by. Edges of thinner faces are always tested, those of faces without area
/// among them.
const LEAST_SINE: f64 = 1e-8;

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
}

impl<'a> Frame<'a> {
    /// `None` if the mesh has no extent, and so no face with an area.
    pub(crate) fn new(mesh: &'a Mesh, adjacency: &'a MeshAdjacency) -> Option<Self> {
        let bounds = mesh.bounds()?;
        let unit = bounds.half_longest_side();
        (unit > 0.0).then(|| Self { mesh, adjacency, center: bounds.center(), unit })
    }

    fn position(&self, vertex: u32) -> DVec3 {
        (self.mesh.position(vertex).as_dvec3() - self.center) / self.unit
    }

    pub(crate) fn midpoint(&self, edge: EdgeId) -> DVec3 {
        let [a, b] = self.adjacency.wing(edge).ends();
        0.5 * (self.position(a) + self.position(b))
    }

    /// Vertices at its ends, lower first; equal numbers are equal places.
    pub(crate) fn ends(&self, edge: EdgeId) -> [u32; 2] {
        self.adjacency.wing(edge).ends()
    }

    /// `None` if a face of the edge spans no plane that can be trusted, or is missing.
    pub(crate) fn shape(&self, edge: EdgeId) -> Option<EdgeShape> {
        let wing = self.adjacency.wing(edge);
        if wing.right == Wing::NONE {
            return None;
        }
        let normals = [self.unit_normal(wing.left_face())?, self.unit_normal(wing.right_face())?];
        let vertices = wing.ends();
        let [tail, head] = vertices.map(|v| self.mesh.position(v).as_dvec3());
        let direction = (head - tail).try_normalize()?;
        Some(EdgeShape { normals, vertices, ends: vertices.map(|v| self.position(v)), direction })
    }

    /// Normal and offset of a triangle's plane; `None` if it spans none that can be trusted.
    pub(crate) fn plane(&self, triangle: [u32; 3]) -> Option<(DVec3, f64)> {
        let [a, b, c] = triangle;
        // A sliver may be trusted at one corner and not at another, and edges look from each.
        let turned = [[a, b, c], [b, c, a], [c, a, b]];
        let normal = turned.into_iter().find_map(|corners| self.unit_normal(corners))?;
        let middle: DVec3 = triangle.iter().map(|&vertex| self.position(vertex)).sum();
        Some((normal, normal.dot(middle) / 3.0))
    }

    /// The triangles on the left and the right of an edge that is no boundary, and whether the wing
    /// reads the right one turned over.
    pub(crate) fn triangles(&self, edge: EdgeId) -> ([u32; 2], bool) {
        let triangles = self.adjacency.sides(edge).map(HalfEdge::triangle);
        (triangles, self.adjacency.is_right_turned(edge))
    }

    fn unit_normal(&self, face: [u32; 3]) -> Option<DVec3> {
        let [a, b, c] = face.map(|v| self.mesh.position(v).as_dvec3());
        let (u, v) = ((b - a).try_normalize()?, (c - a).try_normalize()?);
        let normal = u.cross(v);
        // A sliver's angle may be small at any one corner, as long as the normal is sure.
        (normal.length() >= LEAST_SINE).then(|| normal.normalize())
    }
}
