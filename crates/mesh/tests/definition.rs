//! `MeshAdjacency` and `contour_edges` against the definition written a second time.

mod oracle;

use std::collections::BTreeMap;

use drypoint_mesh::shapes::{self, NamedMesh};
use drypoint_mesh::{
    EdgeFilter, EdgeId, HalfEdge, Mesh, MeshAdjacency, Viewpoint, contour_edges,
    contour_vertex_pairs, is_contour,
};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

/// Edges, classes and contours of `mesh` are those of the oracle, from every viewpoint.
#[track_caller]
fn check(name: &str, mesh: &Mesh, viewpoints: &[Viewpoint]) {
    let adjacency = MeshAdjacency::new(mesh);
    let (meetings, report) = oracle::meetings(mesh);
    assert_eq!(*adjacency.report(), report, "{name}");
    assert_eq!(adjacency.representatives(), oracle::representatives(mesh), "{name}");
    check_edges(name, mesh, &adjacency, &meetings);
    for &viewpoint in viewpoints {
        check_contours(name, mesh, &adjacency, &meetings, viewpoint);
    }
}

#[track_caller]
fn check_edges(name: &str, mesh: &Mesh, adjacency: &MeshAdjacency, meetings: &[oracle::Meeting]) {
    assert_eq!(adjacency.wings().len(), meetings.len(), "{name}");
    let welded = oracle::representatives(mesh);
    for (edge, meeting) in adjacency.edge_ids().zip(meetings) {
        let [left, right] = meeting.half_edges;
        assert_eq!(adjacency.sides(edge), [HalfEdge(left), HalfEdge(right)], "{name}");
        assert_eq!(adjacency.class(edge), meeting.class, "{name}: {meeting:?}");
        assert_eq!(adjacency.is_right_turned(edge), meeting.is_turned, "{name}: {meeting:?}");
        assert_eq!(
            adjacency.keeps(edge, EdgeFilter::Convex),
            meeting.is_kept,
            "{name}: {meeting:?}"
        );
        assert_eq!(adjacency.keeps(edge, EdgeFilter::All), right != oracle::NONE, "{name}");
        let wing = adjacency.wing(edge);
        let corners = |half| oracle::corners_from(mesh, half).map(|v| welded[v as usize]);
        assert_eq!(wing.left_face(), corners(left), "{name}");
        if right == oracle::NONE {
            assert_eq!(wing.right, oracle::NONE, "{name}");
        } else {
            let [tail, head, third] = corners(right);
            let turned_over =
                if meeting.is_turned { [head, tail, third] } else { [tail, head, third] };
            assert_eq!(wing.right_face(), turned_over, "{name}");
        }
    }
}

#[track_caller]
fn check_contours(
    name: &str,
    mesh: &Mesh,
    adjacency: &MeshAdjacency,
    meetings: &[oracle::Meeting],
    viewpoint: Viewpoint,
) {
    let expected = oracle::contours(mesh, meetings, viewpoint);
    for filter in [EdgeFilter::All, EdgeFilter::Convex] {
        let wanted = |&edge: &EdgeId| {
            expected[edge.index()] && (filter == EdgeFilter::All || meetings[edge.index()].is_kept)
        };
        let wanted: Vec<_> = adjacency.edge_ids().filter(wanted).collect();
        // What the buffer held is replaced.
        let mut found = vec![EdgeId(7)];
        contour_edges(mesh, adjacency, viewpoint, filter, &mut found);
        assert_eq!(found, wanted, "{name} from {viewpoint:?}, {filter:?}");
        let mut pairs = vec![[9, 9]];
        contour_vertex_pairs(adjacency, &found, &mut pairs);
        let mut wanted: Vec<_> = wanted.iter().map(|&edge| adjacency.wing(edge).ends()).collect();
        wanted.sort_unstable();
        wanted.dedup();
        assert_eq!(pairs, wanted, "{name}");
    }
    for edge in adjacency.edge_ids() {
        let alone = is_contour(mesh.positions(), &adjacency.wing(edge), viewpoint);
        assert_eq!(alone, expected[edge.index()], "{name}: {edge:?} from {viewpoint:?}");
    }
}

/// Viewpoints inside, near and far, and exactly on a vertex, an edge and the planes of faces.
fn viewpoints(mesh: &Mesh) -> Vec<Viewpoint> {
    let mut points = vec![DVec3::ZERO, DVec3::new(0.3, -7.1, 2.4), DVec3::splat(1e6)];
    let mut directions =
        vec![DVec3::ZERO, DVec3::X, DVec3::NEG_Z, DVec3::new(0.3, -0.2, 0.6), DVec3::ONE];
    if let Some(bounds) = mesh.bounds() {
        let reach = bounds.half_longest_side();
        points.extend(
            [DVec3::ZERO, DVec3::X, DVec3::new(-0.3, 2.0, 3.0)]
                .map(|p| bounds.center() + reach * p),
        );
    }
    for triangle in [0, mesh.triangles().len() / 2, mesh.triangles().len().saturating_sub(1)] {
        let Some(corners) = mesh.triangles().get(triangle) else { continue };
        let [a, b, c] = corners.map(|v| mesh.position(v).as_dvec3());
        points.extend([a, 0.5 * (b + c), b + (c - a), 0.25 * (a + a + b + c)]);
        directions.extend([b - a, (b - a) + 2.0 * (c - a)]);
    }
    let points = points.into_iter().map(Viewpoint::at);
    points.chain(directions.into_iter().map(Viewpoint::from_direction)).collect()
}

#[test]
fn every_shape_agrees_with_the_oracle() {
    for NamedMesh { name, mesh } in shapes::all() {
        check(name, &mesh, &viewpoints(&mesh));
    }
}

#[test]
fn many_faces_at_one_edge_are_paired_up_to_a_limit() {
    for pages in [2, 3, 15, 16, 17, 18, 40] {
        let mesh = shapes::book(pages);
        check("book", &mesh, &viewpoints(&mesh));
        let wings = MeshAdjacency::new(&mesh).wings().len() - 2 * pages;
        // Every pair; above 16 pages 15 for each, but for the last that have fewer after them.
        let expected = if pages <= 16 { pages * (pages - 1) / 2 } else { 15 * pages - 120 };
        assert_eq!(wings, expected, "{pages} pages");
    }
    // Linear, not quadratic.
    let wings = MeshAdjacency::new(&shapes::book(30_000)).wings().len();
    assert_eq!(wings, 30_000 * (2 + 15) - 120);
}

/// Number of contour edges at each vertex.
fn contour_degrees(mesh: &Mesh, viewpoint: Viewpoint) -> BTreeMap<u32, usize> {
    let adjacency = MeshAdjacency::new(mesh);
    let (mut contours, mut degrees) = (Vec::new(), BTreeMap::new());
    contour_edges(mesh, &adjacency, viewpoint, EdgeFilter::All, &mut contours);
    for vertex in contours.iter().flat_map(|&edge| adjacency.wing(edge).ends()) {
        *degrees.entry(vertex).or_default() += 1;
    }
    degrees
}

fn is_closed_manifold(mesh: &Mesh) -> bool {
    let report = *MeshAdjacency::new(mesh).report();
    report.boundary + report.non_manifold + report.inconsistent == 0
}

#[test]
fn contours_of_closed_shapes_close() {
    let closed = [shapes::closed(), shapes::degenerate(), shapes::duplicate_vertices()].concat();
    for NamedMesh { name, mesh } in closed.into_iter().filter(|s| is_closed_manifold(&s.mesh)) {
        for viewpoint in viewpoints(&mesh) {
            let degrees = contour_degrees(&mesh, viewpoint);
            assert!(degrees.values().all(|d| d % 2 == 0), "{name} from {viewpoint:?}");
        }
    }
}

#[test]
fn degenerate_shapes_are_closed_too() {
    let [sliver, fold] = [shapes::sliver_sphere(500), shapes::folded_sheet()];
    assert!(is_closed_manifold(&sliver) && is_closed_manifold(&fold));
    let from = Viewpoint::at(DVec3::new(5.0, 1.0, 0.5));
    assert!(contour_degrees(&sliver, from).len() > 20);
    assert_eq!(contour_degrees(&fold, from), BTreeMap::from([(0, 2), (1, 2), (2, 2)]));
}

/// A coordinate of a tiny grid, so that vertices coincide and faces degenerate all the time.
fn grid_position() -> impl Strategy<Value = Vec3> {
    let coordinate = || prop_oneof![Just(-0.0f32), (0i8..3).prop_map(f32::from)];
    [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from_array)
}

/// On vertices, edges, in planes of faces and between them; and as often at infinity.
fn grid_viewpoint() -> impl Strategy<Value = Viewpoint> {
    let half = || (-3i8..8).prop_map(|x| 0.5 * f64::from(x));
    ([half(), half(), half()], any::<bool>()).prop_map(|(xyz, is_point)| {
        let xyz = DVec3::from_array(xyz);
        if is_point { Viewpoint::at(xyz) } else { Viewpoint::from_direction(xyz - 1.0) }
    })
}

/// Up to `most` triangles, of any corners, on few vertices.
fn soup(most: usize) -> impl Strategy<Value = Mesh> {
    (prop::collection::vec(grid_position(), 3..12)).prop_flat_map(move |positions| {
        let corner = 0..u32::try_from(positions.len()).unwrap();
        let triangle = [corner.clone(), corner.clone(), corner];
        prop::collection::vec(triangle, 0..most)
            .prop_map(move |triangles| Mesh::new(positions.clone(), triangles).unwrap())
    })
}

/// The octahedron's or a torus' triangles on vertices at random places of the grid: closed as long
/// as no vertices meet, and often when they do.
fn crumpled() -> impl Strategy<Value = Mesh> {
    let connectivity = prop_oneof![
        Just(shapes::tetrahedron()),
        Just(shapes::cube()),
        Just(shapes::icosphere(20)),
        Just(shapes::torus_knot(0)),
    ];
    connectivity.prop_flat_map(|mesh| {
        prop::collection::vec([0i8..5, 0i8..5, 0i8..5], mesh.positions().len()).prop_map(
            move |places| {
                let positions = places.iter().map(|p| Vec3::from_array(p.map(f32::from)));
                Mesh::new(positions.collect(), mesh.triangles().to_vec()).unwrap()
            },
        )
    })
}

/// Two faces on one edge, all exactly in the plane z = 0, often as thin as a hair: vertices on one
/// line but for a step that f64 loses beside the others.
fn thin_pair() -> impl Strategy<Value = Mesh> {
    let coordinate = || {
        let hair = (-7i8..8, -60i32..-45).prop_map(|(m, e)| f32::from(m) * 2f32.powi(e));
        prop_oneof![(-3i8..4).prop_map(f32::from), hair]
    };
    let position = [coordinate(), coordinate()].prop_map(|[x, y]| Vec3::new(x, y, 0.0));
    prop::collection::vec(position, 4)
        .prop_map(|positions| Mesh::new(positions, vec![[0, 1, 2], [1, 0, 3]]).unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn sparse_soups_agree_with_the_oracle(
        mesh in soup(14), viewpoints in prop::collection::vec(grid_viewpoint(), 6),
    ) {
        check("soup", &mesh, &viewpoints);
    }

    #[test]
    fn crumpled_shapes_agree_with_the_oracle_and_their_contours_close(
        mesh in crumpled(), viewpoints in prop::collection::vec(grid_viewpoint(), 3),
    ) {
        check("crumpled", &mesh, &viewpoints);
        if is_closed_manifold(&mesh) {
            for viewpoint in viewpoints {
                let degrees = contour_degrees(&mesh, viewpoint);
                prop_assert!(degrees.values().all(|d| d % 2 == 0), "{:?}", degrees);
            }
        }
    }

    #[test]
    fn folds_are_told_from_flats_exactly(mesh in thin_pair()) {
        check("thin pair", &mesh, &[]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// So many faces on so few vertices that edges have more than 16.
    #[test]
    fn dense_soups_agree_with_the_oracle(
        mesh in soup(150), viewpoints in prop::collection::vec(grid_viewpoint(), 4),
    ) {
        check("dense soup", &mesh, &viewpoints);
    }
}
