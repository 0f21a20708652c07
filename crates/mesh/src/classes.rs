//! What kind of edge it is, and which kinds to keep.

use std::cmp::Ordering;

use glam::Vec3;

use crate::facing::are_opposite;
use crate::{Mesh, Wing, volume_side};

/// What an edge is, whatever the viewpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
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
    /// Leaves out interior edges that can never be seen as contours: concave and flat ones, where
    /// any contour is hidden by a face of its own (Tsiapkolis and Bénard, CGF 2024, §4.1). Folds,
    /// edges beside faces without area, non-manifold and inconsistent edges are kept.
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
