//! The bound of a finished patch, of any kind.

use drypoint_bounds::{DoubleCone, NormalCone, Plane, SpatializedNormalCone, Sphere};
use drypoint_mesh::EdgeId;
use glam::DVec3;

use crate::BoundKind;
use crate::geometry::{EdgeShape, Frame};

/// The bound that goes with the patch, in model units. Edges without a shape do not count.
pub(crate) fn bound(frame: &Frame, edges: &[EdgeId], kind: BoundKind) -> DoubleCone {
    let shapes: Vec<EdgeShape> = edges.iter().filter_map(|&edge| frame.shape(edge)).collect();
    let position = |vertex: u32| frame.mesh.position(vertex).as_dvec3();
    let lines = shapes.iter().map(|edge| edge.vertices.map(position));
    let normals = shapes.iter().flat_map(|edge| edge.normals);
    let (cone, sphere) = match kind {
        BoundKind::Mean => {
            (NormalCone::mean(normals), Sphere::mean(vertices(&shapes).map(position)))
        }
        BoundKind::Reduced => (NormalCone::mean(normals), Sphere::reduced(lines)),
        BoundKind::Minimal => (NormalCone::minimal(normals), Sphere::minimal(lines)),
        BoundKind::Tight => {
            let planes: Vec<Plane> = shapes.iter().zip(lines).flat_map(planes_of).collect();
            return DoubleCone::tight(planes.iter().copied());
        }
    };
    DoubleCone::from(SpatializedNormalCone { cone, sphere })
}

/// The planes of both faces, through the middle of the edge that they share: the point of each that
/// is nearest to the rest of the patch.
fn planes_of((shape, [tail, head]): (&EdgeShape, [DVec3; 2])) -> [Plane; 2] {
    shape.normals.map(|normal| Plane { normal, point: 0.5 * (tail + head) })
}

/// The distinct vertices of the edges.
fn vertices(shapes: &[EdgeShape]) -> impl Iterator<Item = u32> + Clone {
    let mut vertices: Vec<u32> = shapes.iter().flat_map(|edge| edge.vertices).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices.into_iter()
}
