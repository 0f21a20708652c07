//! What an edge is tested with.

use bytemuck::{Pod, Zeroable};
use drypoint_mesh::{EdgeId, Wing, has_area};
use glam::{DVec3, DVec4, Vec3, Vec4};

use crate::Frame;

/// The planes of an edge's two faces, in the [`Frame`] of its mesh: unit normal n, and −n · p for a point
/// p of the face. Zero where a face has no area, which is seen from the front from everywhere.
///
/// All edges of a face hold the same plane bit for bit, negated where it is read turned over.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct EdgePlanes {
    /// Of the left face.
    pub left: Vec4,
    /// Of the right face.
    pub right: Vec4,
}

/// Vertices of an edge, lower index first, its id in the mesh's adjacency, and its class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct EdgeEnds {
    /// The lower index.
    pub from_vertex: u32,
    /// The higher one.
    pub to_vertex: u32,
    /// Id in the [`MeshAdjacency`](drypoint_mesh::MeshAdjacency).
    pub edge: EdgeId,
    /// An [`EdgeClass`](drypoint_mesh::EdgeClass), as a number.
    pub edge_class: u32,
}

impl EdgePlanes {
    /// The planes of the faces of `wing`, which must have both.
    ///
    /// Normals are good to 2⁻⁵⁰, of slivers too, where f64 holds the differences of corners, and elsewhere
    /// to what [`EdgePlanes::in_f64`] says.
    pub fn new(positions: &[Vec3], wing: &Wing, frame: &Frame) -> Self {
        let [left, right] = [wing.left_face(), wing.right_face()]
            .map(|face| plane(positions, face, frame).as_vec4());
        Self { left, right }
    }

    /// The same planes, left and right, before they are rounded to f32. NaN where nothing is sure: where
    /// coordinates of one face differ by more than 2²⁹ in size, and it is a sliver whose normal turns by 2⁻³⁴
    /// radians or more when differences of its corners are rounded to f64.
    pub fn in_f64(positions: &[Vec3], wing: &Wing, frame: &Frame) -> [DVec4; 2] {
        [wing.left_face(), wing.right_face()].map(|face| {
            let is_sure = is_normal_sure(positions, face);
            if is_sure { plane(positions, face, frame) } else { DVec4::NAN }
        })
    }

    /// Twin of `is_contour` in shared/contour.wgsl: one face from the front, the other from behind.
    /// `viewpoint` is what [`Frame::viewpoint`] gives.
    pub fn is_contour(&self, viewpoint: Vec4) -> bool {
        is_front_facing(self.left, viewpoint) != is_front_facing(self.right, viewpoint)
    }

    /// How far from a plane in f64 `viewpoint` must be for f32 to be sure of its side, in frame units
    /// times the viewpoint's w.
    ///
    /// Let u = 2⁻²⁴. Rounding turns n by at most u, so that n · v is off by u|v|, and so it is by rounding
    /// v; −n · p is at most √3 in size, since coordinates are within 1, and off by u of that. Four
    /// products are added, in any order, fused or not. A shader may round each result to either neighbour,
    /// by 2u: another 8u(|v| + √3 w) at most. All that is below 10u(|v| + 2w).
    pub fn doubt(viewpoint: Vec4) -> f64 {
        let unit = 1.0 / f64::from(1u32 << 24);
        let viewpoint = viewpoint.as_dvec4();
        10.0 * unit * (viewpoint.truncate().length() + 2.0 * viewpoint.w)
    }

    /// Whether f32 may mistake the side of one of `planes`, which [`EdgePlanes::in_f64`] gives: then a GPU
    /// may find the edge where the exact definition does not, or the reverse. `viewpoint` is what
    /// [`Frame::viewpoint`] gives.
    pub fn is_doubtful(planes: &[DVec4; 2], viewpoint: Vec4) -> bool {
        !planes.iter().all(|&plane| is_side_sure(plane, viewpoint))
    }
}

/// Whether f32 knows on which side of a plane `viewpoint` is: of faces without area, for certain; of NaN,
/// never.
pub(crate) fn is_side_sure(plane: DVec4, viewpoint: Vec4) -> bool {
    plane == DVec4::ZERO || plane.dot(viewpoint.as_dvec4()).abs() > EdgePlanes::doubt(viewpoint)
}

/// Twin of `is_front_facing` in shared/contour.wgsl.
fn is_front_facing(plane: Vec4, viewpoint: Vec4) -> bool {
    height(plane, viewpoint) >= 0.0
}

/// How far the viewpoint is above a plane, as `is_front_facing` has it.
pub(crate) fn height(plane: Vec4, viewpoint: Vec4) -> f32 {
    let [x, y, z, w] = plane.to_array();
    let along_z = z.mul_add(viewpoint.z, w * viewpoint.w);
    x.mul_add(viewpoint.x, y.mul_add(viewpoint.y, along_z))
}

/// The plane of `face`, in the frame: from its corners in the order of their indices, so that it does not
/// depend on the edge that asks. Zero if they are collinear.
pub(crate) fn plane(positions: &[Vec3], face: [u32; 3], frame: &Frame) -> DVec4 {
    let mut sorted = face;
    sorted.sort_unstable();
    let is_turned = (0..3).all(|turn| [0, 1, 2].map(|i| face[(i + turn) % 3]) != sorted);
    let [a, b, c] = sorted.map(|vertex| positions[vertex as usize].as_dvec3());
    let (u, v) = (b - a, c - a);
    let normal = DVec3::new(
        difference_of_products(u.y, v.z, u.z, v.y),
        difference_of_products(u.z, v.x, u.x, v.z),
        difference_of_products(u.x, v.y, u.y, v.x),
    );
    // Exactly, for where differences of corners are rounded.
    if !has_area(sorted.map(|vertex| positions[vertex as usize])) || normal == DVec3::ZERO {
        return DVec4::ZERO;
    }
    let normal = (normal / normal.abs().max_element()).normalize();
    let plane = normal.extend(-normal.dot(frame.point(a)));
    if is_turned { -plane } else { plane }
}

/// Whether rounding the differences of corners turns the normal of `face` by less than 2⁻³⁴ radians.
pub(crate) fn is_normal_sure(positions: &[Vec3], mut face: [u32; 3]) -> bool {
    face.sort_unstable();
    let [a, b, c] = face.map(|vertex| positions[vertex as usize].as_dvec3());
    let [(u, lost_of_u), (v, lost_of_v)] = [b, c].map(|corner| {
        let difference = corner - a;
        // Knuth's two-sum: what rounding took.
        let a_seen = corner - difference;
        (difference, (corner - (difference + a_seen)) + (a_seen - a))
    });
    let turned = lost_of_u.length() * v.length() + lost_of_v.length() * u.length();
    turned <= u.cross(v).length() * f64::exp2(-34.0)
}

/// a b − c d, off by at most 1.5 units in the last place (Kahan; Jeannerod, Louvet and Muller, Further
/// Analysis of Kahan's Algorithm for the Accurate Computation of 2x2 Determinants, Mathematics of
/// Computation 82, 2013).
fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let product = c * d;
    let error = (-c).mul_add(d, product);
    a.mul_add(b, -product) + error
}
