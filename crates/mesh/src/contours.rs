//! The definition of a contour edge. Everything faster is compared with this.

use std::cmp::Ordering;

use glam::Vec3;

use crate::{EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, Wing, face_side, face_sides};

/// Writes to `contours` the contour edges of `mesh` seen from `viewpoint`, among those that
/// `filter` keeps, by id. What it held is replaced.
///
/// A face is front-facing if the viewpoint lies on its normal's side or exactly in its plane (the
/// tie rule of Sander et al., Silhouette Clipping, SIGGRAPH 2000), decided exactly; an edge is a
/// contour edge if one of its faces is front-facing and the other is not. A face without area holds
/// every viewpoint in its plane, so it is front-facing. The contours of a closed mesh close.
///
/// One exact sign per face, about 10 ns, and two look-ups per edge. Boundary edges are lines of a
/// class of their own, never contour edges.
pub fn contour_edges(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    viewpoint: Viewpoint,
    filter: EdgeFilter,
    contours: &mut Vec<EdgeId>,
) {
    let mut sides = Vec::with_capacity(mesh.triangles().len());
    face_sides(mesh, viewpoint, &mut sides);
    contours.clear();
    contours.extend(adjacency.edges(filter).filter(|&edge| {
        let [left, right] = adjacency.sides(edge);
        let left_side = sides[left.triangle() as usize];
        let right_side = sides[right.triangle() as usize];
        // Where the right face is wound the other way, the wing reads it turned over.
        let right_side =
            if adjacency.is_right_turned(edge) { right_side.reverse() } else { right_side };
        is_front(left_side) != is_front(right_side)
    }));
}

/// Whether the edge of `wing` is a contour edge seen from `viewpoint`, exactly: the same answer as
/// [`contour_edges`], from four of the mesh's `positions`. `false` on a boundary edge.
pub fn is_contour(positions: &[Vec3], wing: &Wing, viewpoint: Viewpoint) -> bool {
    let seen = |face: [u32; 3]| face_side(face.map(|v| positions[v as usize]), viewpoint);
    wing.right != Wing::NONE
        && is_front(seen(wing.left_face())) != is_front(seen(wing.right_face()))
}

/// Replaces `pairs` by the ends of `edges` as sorted vertex pairs, lower index first, none twice:
/// several wings of a non-manifold edge are one line.
pub fn contour_vertex_pairs(
    adjacency: &MeshAdjacency,
    edges: &[EdgeId],
    pairs: &mut Vec<[u32; 2]>,
) {
    pairs.clear();
    pairs.extend(edges.iter().map(|&edge| adjacency.wing(edge).ends()));
    pairs.sort_unstable();
    pairs.dedup();
}

/// The tie rule: a viewpoint in the plane of a face sees its front.
fn is_front(side: Ordering) -> bool {
    side != Ordering::Less
}
