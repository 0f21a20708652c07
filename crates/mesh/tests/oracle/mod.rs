//! The definition of a contour edge, written a second time: slow, by ordered maps and whole
//! numbers, and without a line of the code that it judges.

mod exact;

use std::collections::BTreeMap;

use drypoint_mesh::{EdgeClass, Mesh, TopologyReport, Viewpoint};
use exact::{determinant_sign, difference, exact, side};
use glam::DVec3;
use num_rational::BigRational;

/// The missing right half-edge of a boundary edge.
pub(crate) const NONE: u32 = u32::MAX;
/// Up to one face more than this, all faces of an edge are paired.
const MAX_PAIRED: usize = 15;

/// Two faces, or one, that meet at an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Meeting {
    /// `3 * triangle + corner` on both sides, the lower one left.
    pub(crate) half_edges: [u32; 2],
    pub(crate) class: EdgeClass,
    /// Both run along the edge in the same direction.
    pub(crate) is_turned: bool,
    /// Kept where only edges that can be seen on a closed surface are.
    pub(crate) is_kept: bool,
}

/// A position as loaded, −0 as 0.
type Place = [u32; 3];

fn place(mesh: &Mesh, vertex: u32) -> Place {
    mesh.position(vertex).to_array().map(|x| if x == 0.0 { 0 } else { x.to_bits() })
}

/// For each vertex the first at the same place.
pub(crate) fn representatives(mesh: &Mesh) -> Vec<u32> {
    let mut first = BTreeMap::new();
    let vertices = 0..u32::try_from(mesh.positions().len()).unwrap();
    vertices.map(|v| *first.entry(place(mesh, v)).or_insert(v)).collect()
}

/// Corners of the face of a half-edge, from where it starts.
pub(crate) fn corners_from(mesh: &Mesh, half_edge: u32) -> [u32; 3] {
    let corners = mesh.triangles()[half_edge as usize / 3];
    [0, 1, 2].map(|i| corners[(half_edge as usize + i) % 3])
}

/// All meetings, by their half-edges, and what the mesh is made of.
// Long because a judge should be read from top to bottom, with nothing elsewhere to trust.
pub(crate) fn meetings(mesh: &Mesh) -> (Vec<Meeting>, TopologyReport) {
    let mut at_edge: BTreeMap<[Place; 2], Vec<u32>> = BTreeMap::new();
    let mut report = TopologyReport {
        faces: mesh.triangles().len(),
        vertices: mesh.positions().len(),
        welded_vertices: (0..)
            .zip(representatives(mesh))
            .filter(|&(v, w): &(u32, u32)| v == w)
            .count(),
        ..Default::default()
    };
    for (t, corners) in (0..).zip(mesh.triangles()) {
        let places = corners.map(|v| place(mesh, v));
        report.degenerate += usize::from(normal(mesh, t) == [0, 0, 0].map(whole));
        if places[0] == places[1] || places[1] == places[2] || places[2] == places[0] {
            report.collapsed += 1;
            continue;
        }
        for i in 0..3 {
            let mut ends = [places[i], places[(i + 1) % 3]];
            ends.sort_unstable();
            at_edge.entry(ends).or_default().push(3 * t + u32::try_from(i).unwrap());
        }
    }
    let mut meetings = Vec::new();
    for faces in at_edge.values() {
        let class = |left, right| match faces.len() {
            1 => EdgeClass::Boundary,
            2 => class_of_two(mesh, left, right),
            _ => EdgeClass::NonManifold,
        };
        match class(faces[0], *faces.last().unwrap()) {
            EdgeClass::Boundary => report.boundary += 1,
            EdgeClass::NonManifold => report.non_manifold += 1,
            EdgeClass::Convex => report.convex += 1,
            EdgeClass::Flat => report.flat += 1,
            EdgeClass::Concave => report.concave += 1,
            EdgeClass::Inconsistent => report.inconsistent += 1,
        }
        for (i, &left) in faces.iter().enumerate() {
            let others = faces.iter().skip(i + 1).take(MAX_PAIRED);
            meetings.extend(others.map(|&right| Meeting {
                half_edges: [left, right],
                class: class(left, right),
                is_turned: is_turned(mesh, left, right),
                is_kept: is_kept(mesh, left, right, class(left, right)),
            }));
        }
        if let [only] = faces[..] {
            meetings.push(Meeting {
                half_edges: [only, NONE],
                class: EdgeClass::Boundary,
                is_turned: false,
                is_kept: false,
            });
        }
    }
    report.interior = report.convex + report.flat + report.concave + report.inconsistent;
    meetings.sort_unstable_by_key(|meeting| meeting.half_edges);
    (meetings, report)
}

/// For each meeting whether it is a contour edge.
pub(crate) fn contours(mesh: &Mesh, meetings: &[Meeting], viewpoint: Viewpoint) -> Vec<bool> {
    let sides: Vec<i8> = mesh
        .triangles()
        .iter()
        .map(|corners| {
            let [a, b, c] = corners.map(|v| mesh.position(v).as_dvec3());
            if viewpoint.is_point() {
                side([a, b, c], viewpoint.xyz())
            } else {
                determinant_sign([[b, a], [c, a], [viewpoint.xyz(), DVec3::ZERO]])
            }
        })
        .collect();
    let is_contour = |meeting: &Meeting| {
        let [left, right] = meeting.half_edges;
        if right == NONE {
            return false;
        }
        let right = sides[right as usize / 3];
        let right = if meeting.is_turned { -right } else { right };
        (sides[left as usize / 3] >= 0) != (right >= 0)
    };
    meetings.iter().map(is_contour).collect()
}

fn is_turned(mesh: &Mesh, left: u32, right: u32) -> bool {
    let [left, right] = [left, right].map(|half| place(mesh, corners_from(mesh, half)[0]));
    left == right
}

fn class_of_two(mesh: &Mesh, left: u32, right: u32) -> EdgeClass {
    if is_turned(mesh, left, right) {
        return EdgeClass::Inconsistent;
    }
    let face = corners_from(mesh, left).map(|v| mesh.position(v).as_dvec3());
    match side(face, mesh.position(corners_from(mesh, right)[2]).as_dvec3()) {
        -1 => EdgeClass::Convex,
        0 => EdgeClass::Flat,
        _ => EdgeClass::Concave,
    }
}

/// A flat edge is dropped if the faces have parallel normals of the same direction.
fn is_kept(mesh: &Mesh, left: u32, right: u32, class: EdgeClass) -> bool {
    match class {
        EdgeClass::Boundary | EdgeClass::Concave => false,
        EdgeClass::Convex | EdgeClass::NonManifold | EdgeClass::Inconsistent => true,
        EdgeClass::Flat => {
            let [left, right] = [left, right].map(|half| normal(mesh, half / 3));
            let [x, y, z] = [0, 1, 2].map(|i| &left[i] * &right[i]);
            x + y + z <= whole(0)
        }
    }
}

/// Normal of a triangle, twice as long as its area, exactly.
fn normal(mesh: &Mesh, triangle: u32) -> [BigRational; 3] {
    let [a, b, c] = mesh.corners(triangle).map(|p| exact(p.as_dvec3()));
    let u = difference(&b, &a);
    let v = difference(&c, &a);
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &u[i] * &v[j] - &u[j] * &v[i])
}

fn whole(x: i32) -> BigRational {
    BigRational::from_integer(x.into())
}
