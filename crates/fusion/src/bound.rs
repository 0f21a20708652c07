//! The bound of a finished patch, of any kind.

use drypoint_bounds::{DoubleCone, NormalCone, SpatializedNormalCone, Sphere};
use drypoint_mesh::EdgeId;
use glam::DVec3;

use crate::BoundKind;
use crate::geometry::Frame;

/// The bound that goes with the patch, in model units.
pub(crate) fn bound(frame: &Frame, edges: &[EdgeId], kind: BoundKind) -> DoubleCone {
    let shapes: Vec<_> = edges.iter().filter_map(|&edge| frame.shape(edge)).collect();
    let position = |vertex: u32| frame.mesh.position(vertex).as_dvec3();
    let sphere = match kind {
        BoundKind::Mean => {
            let mut vertices: Vec<u32> = shapes.iter().flat_map(|edge| edge.vertices).collect();
            vertices.sort_unstable();
            vertices.dedup();
            Sphere::mean(vertices.iter().map(|&vertex| position(vertex)))
        }
        _ => Sphere::reduced(shapes.iter().map(|e| e.vertices.map(position))),
    };
    let normals: Vec<DVec3> = shapes.iter().flat_map(|edge| edge.normals).collect();
    let cone = match kind {
        BoundKind::Mean | BoundKind::Reduced => NormalCone::mean(normals.iter().copied()),
        BoundKind::Minimal | BoundKind::Tight => NormalCone::minimal(normals.iter().copied()),
    };
    DoubleCone::from(SpatializedNormalCone { cone, sphere })
}
