//! What every baseline is tested by: the definition, and its own cull boundaries.

use std::ops::Range;

use drypoint_bounds::DoubleCone;
use drypoint_mesh::{
    EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, contour_edges, is_contour, shapes,
};
use glam::DVec3;

use crate::Statistics;
use crate::edges::Edges;

/// Both.
pub(crate) const FILTERS: [EdgeFilter; 2] = [EdgeFilter::All, EdgeFilter::Convex];

/// Whether `extract` gives what the definition does, and counts it.
#[track_caller]
pub(crate) fn agrees(
    mesh: &Mesh,
    filter: EdgeFilter,
    viewpoints: impl IntoIterator<Item = Viewpoint>,
    extract: impl Fn(Viewpoint, &mut Vec<EdgeId>) -> Statistics,
) {
    let adjacency = MeshAdjacency::new(mesh);
    let kept = adjacency.edges(filter).count();
    let (mut expected, mut found) = (Vec::new(), vec![EdgeId(u32::MAX)]);
    for viewpoint in viewpoints {
        contour_edges(mesh, &adjacency, viewpoint, filter, &mut expected);
        let statistics = extract(viewpoint, &mut found);
        found.sort_unstable();
        assert_eq!(found, expected, "{filter:?} from {viewpoint:?}");
        assert_eq!(statistics.contour_edges, expected.len());
        assert!((expected.len()..=kept).contains(&statistics.edges_tested), "{statistics:?}");
    }
}

/// Around the mesh, near and far, at a point and at infinity; and where ties and near misses live:
/// on vertices, edges and faces, in the planes of faces and a hair beside them.
pub(crate) fn viewpoints(mesh: &Mesh) -> Vec<Viewpoint> {
    let Some(bounds) = mesh.bounds() else { return vec![Viewpoint::at(DVec3::Z)] };
    let (center, unit) = (bounds.center(), bounds.half_longest_side());
    let mut viewpoints = vec![Viewpoint::at(center), Viewpoint::from_direction(DVec3::ZERO)];
    for direction in shapes::icosphere(80).positions().iter().map(|p| p.as_dvec3()) {
        let around = [0.6, 1.5, 10.0, 1e4].map(|d| Viewpoint::at(center + unit * d * direction));
        viewpoints.extend(around);
        viewpoints.push(Viewpoint::from_direction(direction));
    }
    let triangles = mesh.triangles();
    for triangle in triangles.iter().step_by(triangles.len().div_ceil(24)) {
        let [a, b, c] = triangle.map(|v| mesh.position(v).as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let hair = 1e-7 * (a.length() + (b - a).length()) * normal;
        let outside = a + 7.0 * (b - a) - 5.0 * (c - a);
        let on_plane = [a, 0.5 * (a + b), (a + b + c) / 3.0, outside];
        let beside = [outside + hair, outside - hair, a + 0.1 * unit * normal];
        viewpoints.extend(on_plane.into_iter().chain(beside).map(Viewpoint::at));
        let along = b - a;
        viewpoints.extend([along, along + hair, along - hair].map(Viewpoint::from_direction));
    }
    viewpoints
}

/// Looks from the surface that divides what `bound` culls from what it does not, where |h| is
/// t + tan α |p|, and a few roundings to either side, in the direction where one of the planes
/// reaches farthest: none of these `edges` may be a contour edge where the bound culls. Returns how
/// often it did.
#[track_caller]
pub(crate) fn culls_no_contour(
    bound: DoubleCone,
    edges: &Edges<'_>,
    places: Range<u32>,
    unit: f64,
) -> usize {
    let wings = &edges.wings()[places.start as usize..places.end as usize];
    let faces: Vec<[u32; 3]> =
        wings.iter().flat_map(|wing| [wing.left_face(), wing.right_face()]).collect();
    let corner = |vertex: u32| edges.positions()[vertex as usize].as_dvec3();
    let (center, axis) = (bound.center.as_dvec3(), bound.axis.as_dvec3());
    let (apex, tan) = (f64::from(bound.apex_distance), f64::from(bound.tan_squared).sqrt());
    let mut culled = 0;
    for (side, exponent) in [1.0, -1.0].into_iter().flat_map(|s| (-4..=3).map(move |e| (s, e))) {
        let distance = unit * 10f64.powi(exponent);
        for w in [0.0, 1.0] {
            // Plane j is on its own side of viewpoints at `distance` from the axis, towards its
            // normal, whose height is at least (w n·(p − o) + distance sin θ) / cos θ.
            let reach = |face: &[u32; 3]| {
                let [a, b, c] = face.map(corner);
                let normal = (b - a).cross(c - a).normalize_or_zero();
                let (cos, sin) = (normal.dot(axis), normal.cross(axis).length());
                let height = side * w * normal.dot(a - center) + distance * sin;
                (height / cos, -side * normal)
            };
            let farthest = faces.iter().map(reach).max_by(|a, b| a.0.total_cmp(&b.0));
            let across = farthest.map_or(DVec3::X, |(_, towards)| towards);
            let across = (across - axis.dot(across) * axis).normalize_or_zero();
            let height = w * apex + tan * distance;
            for step in -1..4 {
                let nudge = f64::from(step) * (height + distance) / f64::from(1u32 << 24);
                let offset = side * (height + nudge) * axis + distance * across;
                let viewpoint = if w == 0.0 {
                    Viewpoint::from_direction(offset)
                } else {
                    Viewpoint::at(center + offset)
                };
                if !bound.may_hold_contour(viewpoint) {
                    culled += 1;
                    let is_lost = |wing: &_| is_contour(edges.positions(), wing, viewpoint);
                    assert!(!wings.iter().any(is_lost), "{bound:?} from {viewpoint:?}");
                }
            }
        }
    }
    culled
}
