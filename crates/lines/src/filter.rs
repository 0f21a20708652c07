//! Which contours a drawing needs.

use drypoint_mesh::{EdgeFilter, HalfEdge, Mesh, MeshAdjacency, Viewpoint};

/// The filter under which no visible contour is lost and no noise is won.
///
/// [`EdgeFilter::Convex`] if the viewpoint is outside the box of the mesh and every shell is closed,
/// manifold and wound outward: a concave contour edge then lies inside a solid, so some face covers
/// it. Where faces of a scan are within rounding of their neighbours such an edge may still look
/// visible, and is a speck. [`EdgeFilter::All`] on every other mesh, where concave contours can be
/// seen. Surfaces that pass through themselves are not looked for. Linear.
pub fn filter_for_drawing(
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    viewpoint: Viewpoint,
) -> EdgeFilter {
    let report = adjacency.report();
    let closed = report.boundary == 0 && report.non_manifold == 0 && report.inconsistent == 0;
    if closed && is_outside_box(mesh, viewpoint) && all_shells_are_outward(mesh, adjacency) {
        EdgeFilter::Convex
    } else {
        EdgeFilter::All
    }
}

fn is_outside_box(mesh: &Mesh, viewpoint: Viewpoint) -> bool {
    mesh.bounds().is_some_and(|bounds| {
        let (eye, min, max) = (viewpoint.xyz(), bounds.min.as_dvec3(), bounds.max.as_dvec3());
        !viewpoint.is_point() || eye.cmplt(min).any() || eye.cmpgt(max).any()
    })
}

/// Whether every connected part of a closed mesh encloses a positive volume.
fn all_shells_are_outward(mesh: &Mesh, adjacency: &MeshAdjacency) -> bool {
    let mut parents: Vec<u32> = (0..).take(mesh.triangles().len()).collect();
    fn root(parents: &mut [u32], mut face: u32) -> u32 {
        while parents[face as usize] != face {
            parents[face as usize] = parents[parents[face as usize] as usize];
            face = parents[face as usize];
        }
        face
    }
    for edge in adjacency.edge_ids() {
        let [left, right] = adjacency.sides(edge);
        if right != HalfEdge::NONE {
            let (left, right) =
                (root(&mut parents, left.triangle()), root(&mut parents, right.triangle()));
            parents[left.max(right) as usize] = left.min(right);
        }
    }
    // About the center of the box, so that the volumes of the cones do not cancel far away.
    let center = mesh.bounds().map_or_else(Default::default, |bounds| bounds.center());
    let mut volumes = vec![None; parents.len()];
    for face in (0..).take(parents.len()) {
        if !adjacency.is_without_area(face) {
            let [a, b, c] = mesh.corners(face).map(|p| p.as_dvec3() - center);
            let volume = volumes[root(&mut parents, face) as usize].get_or_insert(0.0);
            *volume += a.dot(b.cross(c));
        }
    }
    volumes.into_iter().flatten().all(|volume| volume > 0.0)
}

#[cfg(test)]
mod tests {
    use drypoint_mesh::shapes;
    use glam::{DVec3, Vec3};

    use super::*;

    #[track_caller]
    fn check(mesh: &Mesh, viewpoint: Viewpoint, expected: EdgeFilter) {
        let adjacency = MeshAdjacency::new(mesh);
        assert_eq!(filter_for_drawing(mesh, &adjacency, viewpoint), expected);
    }

    /// A cube, and another beside it, turned inside out if `turned`.
    fn two_cubes(turned: bool) -> Mesh {
        let cube = shapes::cube();
        let count = u32::try_from(cube.positions().len()).unwrap();
        let beside = |p: &Vec3| *p + 5.0 * Vec3::X;
        let positions = cube.positions().iter().copied().chain(cube.positions().iter().map(beside));
        let second = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| v + count);
            if turned { [a, c, b] } else { [a, b, c] }
        };
        let triangles = cube.triangles().iter().copied().chain(cube.triangles().iter().map(second));
        Mesh::new(positions.collect(), triangles.collect()).unwrap()
    }

    #[test]
    fn solids_seen_from_outside_need_convex_edges_only() {
        let outside = Viewpoint::at(DVec3::new(9.0, 8.0, 7.0));
        check(&shapes::cube(), outside, EdgeFilter::Convex);
        check(&two_cubes(false), outside, EdgeFilter::Convex);
        check(&shapes::cad_part(2_000), Viewpoint::from_direction(DVec3::Z), EdgeFilter::Convex);
        check(&shapes::cube(), Viewpoint::at(DVec3::splat(0.1)), EdgeFilter::All);
        check(&two_cubes(true), outside, EdgeFilter::All);
        check(&shapes::open_grid(200), outside, EdgeFilter::All);
        check(&shapes::flipped_sphere(500), outside, EdgeFilter::All);
        check(&shapes::folded_sheet(), outside, EdgeFilter::All);
        check(&shapes::cubes_sharing_an_edge(), outside, EdgeFilter::All);
        check(&Mesh::default(), outside, EdgeFilter::All);
    }
}
