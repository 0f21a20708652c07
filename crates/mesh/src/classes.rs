//! What kind of edge it is, and which kinds to keep.

use std::cmp::Ordering;

use bytemuck::{CheckedBitPattern, NoUninit};
use glam::Vec3;

use crate::facing::are_opposite;
use crate::{Mesh, Wing, volume_side};

/// What an edge is, whatever the viewpoint. One byte, its place in this list from 0: files of
/// patches hold it so.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, CheckedBitPattern, NoUninit)]
#[repr(u8)]
pub enum EdgeClass {
    /// Two faces; the surface bends away from the viewer outside. Exact: the right vertex lies
    /// behind the plane of the left face.
    Convex,
    /// Two faces, and all four vertices of the wing lie in one plane, exactly. The faces may lie
    /// beside each other, upon each other (a fold), or have no area.
    Flat,
    /// Two faces; the surface bends towards the viewer outside.
    Concave,
    /// One face.
    Boundary,
    /// Three faces or more.
    NonManifold,
    /// Two faces that disagree on which side is outside. Neither convex nor concave.
    Inconsistent,
}

/// Which edges to look at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum EdgeFilter {
    /// Leaves out the edges of two faces that cannot be seen as contours on a closed surface:
    /// flat ones, which are none, and concave ones, which lie in the solid as seen from any
    /// viewpoint that makes them contours, so that some face covers them (Tsiapkolis and Bénard,
    /// CGF 2024, §4.1). Folds, edges beside faces without area, non-manifold and inconsistent
    /// edges are kept.
    ///
    /// That takes a surface wound outwards, without boundary or self-intersection, and a viewpoint
    /// outside. The back of an open sheet shows its valleys as ridges, and so does a solid from
    /// within: where those may be seen, ask for [`All`](Self::All) and test visibility.
    #[default]
    Convex,
    /// Every edge of two faces or more, for uses that need hidden contours too: shadow volumes,
    /// gradients.
    All,
}

/// The class of an edge of two consistently wound faces.
pub(crate) fn interior_class(mesh: &Mesh, wing: &Wing) -> EdgeClass {
    match volume_side(wing.left_face().map(|v| mesh.position(v)), mesh.position(wing.right)) {
        Ordering::Less => EdgeClass::Convex,
        Ordering::Equal => EdgeClass::Flat,
        Ordering::Greater => EdgeClass::Concave,
    }
}

/// Whether the faces of a flat wing lie upon each other rather than side by side: a convex or a
/// concave edge of dihedral angle ±π, which is a contour from everywhere outside its plane. True
/// beside a face without area. Exact.
pub(crate) fn is_fold(mesh: &Mesh, wing: &Wing) -> bool {
    are_opposite([wing.left_face(), wing.right_face()].map(|f| f.map(|v| mesh.position(v))))
}

/// Dihedral angle of a wing in radians: 0 when flat, positive when convex, in −π ..= π; the angle
/// between the normals of its faces. 0 if either face has no area, or there is no right face.
pub fn dihedral_angle(mesh: &Mesh, wing: &Wing) -> f64 {
    if wing.right == Wing::NONE {
        return 0.0;
    }
    let corners = [wing.left_face(), wing.right_face()].map(|face| face.map(|v| mesh.position(v)));
    let [left, right] = corners.map(area_vector);
    let along = (corners[0][1].as_dvec3() - corners[0][0].as_dvec3()).normalize_or_zero();
    left.cross(right).dot(along).atan2(left.dot(right))
}

/// Normal of a face, as long as twice its area.
fn area_vector([a, b, c]: [Vec3; 3]) -> glam::DVec3 {
    let [a, b, c] = [a, b, c].map(|p| p.as_dvec3());
    (b - a).cross(c - a)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::{MeshAdjacency, shapes};

    /// The angles of all wings with a right face, sorted, none twice.
    #[track_caller]
    fn check_angles(mesh: &Mesh, expected: &[f64]) {
        let adjacency = MeshAdjacency::new(mesh);
        let edges = adjacency.edges(EdgeFilter::All);
        let mut angles: Vec<_> =
            edges.map(|edge| dihedral_angle(mesh, &adjacency.wing(edge))).collect();
        angles.sort_unstable_by(f64::total_cmp);
        angles.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
        assert_eq!(angles.len(), expected.len(), "{angles:?}");
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-12;
        assert!(angles.iter().zip(expected).all(is_near), "{angles:?}");
    }

    fn turned_over(mesh: &Mesh) -> Mesh {
        let triangles = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
        Mesh::new(mesh.positions().to_vec(), triangles).unwrap()
    }

    #[test]
    fn dihedral_angles_are_positive_where_convex() {
        let tetrahedral = (-1f64 / 3.0).acos();
        check_angles(&shapes::cube(), &[0.0, FRAC_PI_2]);
        check_angles(&turned_over(&shapes::cube()), &[-FRAC_PI_2, 0.0]);
        check_angles(&shapes::tetrahedron(), &[tetrahedral]);
        check_angles(&turned_over(&shapes::tetrahedron()), &[-tetrahedral]);
        check_angles(&shapes::zero_area_fan(), &[0.0]);
        let fold = shapes::folded_sheet();
        let wing = MeshAdjacency::new(&fold).wings()[0];
        assert_eq!(dihedral_angle(&fold, &wing).abs(), PI);
        let alone = shapes::one_triangle();
        assert_eq!(dihedral_angle(&alone, &MeshAdjacency::new(&alone).wings()[0]), 0.0);
    }

    #[test]
    fn a_face_turned_over_is_read_as_the_wing_says() {
        // Two halves of a unit square, one of them upside down.
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
        let mesh = Mesh::new(positions, vec![[0, 1, 2], [1, 2, 3]]).unwrap();
        let adjacency = MeshAdjacency::new(&mesh);
        let inner = adjacency.edges(EdgeFilter::All).next().unwrap();
        assert_eq!(adjacency.class(inner), EdgeClass::Inconsistent);
        assert_eq!(dihedral_angle(&mesh, &adjacency.wing(inner)), 0.0);
    }
}
