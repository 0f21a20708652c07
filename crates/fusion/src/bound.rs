//! The bound of a finished patch, of any kind.

use drypoint_bounds::{DoubleCone, NormalCone, Plane, SpatializedNormalCone, Sphere};
use drypoint_mesh::EdgeId;
use glam::DVec3;

use crate::BoundKind;
use crate::geometry::{EdgeShape, Frame};

/// The bound that goes with the patch, in model units. All its edges have a shape.
pub(crate) fn bound(frame: &Frame, edges: &[EdgeId], kind: BoundKind) -> DoubleCone {
    let cone_and_sphere = match kind {
        BoundKind::Mean => mean,
        BoundKind::Reduced => reduced,
        BoundKind::Minimal => minimal,
        BoundKind::Tight => return DoubleCone::tight(planes(frame, edges).iter().copied()),
    };
    let shapes: Vec<EdgeShape> = edges.iter().filter_map(|&edge| frame.shape(edge)).collect();
    let (cone, sphere) = cone_and_sphere(frame, &shapes);
    DoubleCone::from(SpatializedNormalCone { cone, sphere })
}

fn mean(frame: &Frame, shapes: &[EdgeShape]) -> (NormalCone, Sphere) {
    let mut vertices: Vec<u32> = shapes.iter().flat_map(|edge| edge.vertices).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let positions = vertices.into_iter().map(|vertex| position(frame, vertex));
    (NormalCone::mean(normals(shapes)), Sphere::mean(positions))
}

fn reduced(frame: &Frame, shapes: &[EdgeShape]) -> (NormalCone, Sphere) {
    (NormalCone::mean(normals(shapes)), Sphere::reduced(lines(frame, shapes)))
}

fn minimal(frame: &Frame, shapes: &[EdgeShape]) -> (NormalCone, Sphere) {
    (NormalCone::minimal(normals(shapes)), Sphere::minimal(lines(frame, shapes)))
}

fn normals(shapes: &[EdgeShape]) -> impl Iterator<Item = DVec3> + Clone {
    shapes.iter().flat_map(|edge| edge.normals)
}

fn lines(frame: &Frame, shapes: &[EdgeShape]) -> impl Iterator<Item = [DVec3; 2]> + Clone {
    shapes.iter().map(|edge| edge.vertices.map(|vertex| position(frame, vertex)))
}

fn position(frame: &Frame, vertex: u32) -> DVec3 {
    frame.mesh.position(vertex).as_dvec3()
}

/// The planes of the faces beside the edges, once each, through the middle of an edge of theirs: of
/// all points, it is one that is near to the rest of the patch.
fn planes(frame: &Frame, edges: &[EdgeId]) -> Vec<Plane> {
    let mut sides: Vec<(u64, EdgeId)> = Vec::with_capacity(2 * edges.len());
    for &edge in edges {
        let ([left, right], is_turned) = frame.triangles(edge);
        // A face that one edge sees turned over is another plane.
        sides.push((2 * u64::from(left), edge));
        sides.push((2 * u64::from(right) + u64::from(is_turned), edge));
    }
    sides.sort_unstable();
    sides.dedup_by_key(|(side, _)| *side);
    let plane = |(side, edge): (u64, EdgeId)| {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "half of it is the index of a triangle"
        )]
        let normal = frame.normal((side / 2) as u32);
        let normal = if side % 2 == 1 { -normal } else { normal };
        Plane { normal, point: frame.middle(edge) }
    };
    sides.into_iter().map(plane).collect()
}
