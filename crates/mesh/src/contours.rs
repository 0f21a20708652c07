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
pub(crate) fn is_front(side: Ordering) -> bool {
    side != Ordering::Less
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::shapes;

    /// The expected numbers of contour edges can be seen by hand.
    #[track_caller]
    fn check(mesh: &Mesh, viewpoint: Viewpoint, filter: EdgeFilter, expected: usize) {
        let adjacency = MeshAdjacency::new(mesh);
        let mut contours = Vec::new();
        contour_edges(mesh, &adjacency, viewpoint, filter, &mut contours);
        assert_eq!(contours.len(), expected, "{contours:?}");
    }

    #[track_caller]
    fn check_point(mesh: &Mesh, xyz: [f64; 3], expected: usize) {
        check(mesh, Viewpoint::at(DVec3::from_array(xyz)), EdgeFilter::All, expected);
    }

    #[track_caller]
    fn check_direction(mesh: &Mesh, xyz: [f64; 3], expected: usize) {
        check(mesh, Viewpoint::from_direction(DVec3::from_array(xyz)), EdgeFilter::All, expected);
    }

    #[test]
    fn a_cube_shows_the_outline_of_the_sides_it_turns_to_us() {
        let cube = shapes::cube();
        check_point(&cube, [0.0, 0.0, 9.0], 4); // One side.
        check_point(&cube, [0.0, 9.0, 9.0], 6); // Two sides.
        check_point(&cube, [9.0, 9.0, 9.0], 6); // Three sides.
        check_point(&cube, [0.5, 0.0, 0.0], 0); // Inside: every face looks away.
        // In a plane of a side: that side is front too, by the tie rule.
        check_point(&cube, [0.0, 1.0, 9.0], 6);
        check_point(&cube, [0.0, 1.0, 0.0], 4);
        check_point(&cube, [1.0, 1.0, 1.0], 6);
    }

    #[test]
    fn from_infinity_sides_seen_edge_on_are_front() {
        let cube = shapes::cube();
        check_direction(&cube, [3.0, 2.0, 1.0], 6);
        check_direction(&cube, [0.0, 0.0, 1e-9], 4); // All but the side that looks away.
        check_direction(&cube, [0.0, 0.0, 0.0], 0); // Nothing looks away.
    }

    #[test]
    fn a_boundary_is_no_contour() {
        for z in [-1.0, 0.0, 1.0] {
            check_point(&shapes::one_triangle(), [0.3, 0.3, z], 0);
        }
        check_point(&shapes::empty(), [0.0, 0.0, 1.0], 0);
    }

    #[test]
    fn a_fold_is_a_contour_from_outside_its_plane() {
        check_point(&shapes::folded_sheet(), [0.5, 0.5, -2.0], 3);
        check_point(&shapes::folded_sheet(), [0.5, 0.5, 0.0], 0);
        let outside = Viewpoint::at(DVec3::new(0.5, 0.5, -2.0));
        check(&shapes::folded_sheet(), outside, EdgeFilter::Convex, 3);
    }

    #[test]
    fn wings_of_one_edge_are_one_pair() {
        let cubes = shapes::cubes_sharing_an_edge();
        let adjacency = MeshAdjacency::new(&cubes);
        let viewpoint = Viewpoint::at(DVec3::new(5.0, -4.0, 0.5));
        let (mut contours, mut pairs) = (Vec::new(), Vec::new());
        contour_edges(&cubes, &adjacency, viewpoint, EdgeFilter::All, &mut contours);
        contour_vertex_pairs(&adjacency, &contours, &mut pairs);
        // Two sides of each cube have an outline of six edges. The one they share has six wings, of
        // which two join a front and a back face across the outline.
        assert_eq!((contours.len(), pairs.len()), (12, 11));
    }
}
