//! Where surfaces pass through each other, compared with a naive test of every pair and with what is
//! known of shapes.
#![cfg(feature = "visibility")]

use std::f64::consts::TAU;

use drypoint_lines::{
    Camera, Chain, Drawing, FaceNames, Intersections, LineClass, LineOptions, Occluders, Page,
    Segments, VisibilityParams, chain,
};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, contour_edges, io, shapes};
use glam::{DQuat, DVec3, Vec3};
use proptest::prelude::*;

fn together(meshes: &[Mesh]) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for mesh in meshes {
        let first = u32::try_from(positions.len()).unwrap();
        positions.extend_from_slice(mesh.positions());
        triangles.extend(mesh.triangles().iter().map(|t| t.map(|v| first + v)));
    }
    Mesh::new(positions, triangles).unwrap()
}

fn moved(mesh: &Mesh, place: impl Fn(DVec3) -> DVec3) -> Mesh {
    let positions = mesh.positions().iter().map(|p| place(p.as_dvec3()).as_vec3()).collect();
    Mesh::new(positions, mesh.triangles().to_vec()).unwrap()
}

/// An upright box.
fn cuboid(min: [f64; 3], max: [f64; 3]) -> Mesh {
    let [min, max] = [min, max].map(DVec3::from_array);
    let cube = shapes::cube();
    let bounds = cube.bounds().unwrap();
    moved(&cube, |p| min + (p - bounds.min.as_dvec3()) / bounds.size() * (max - min))
}

/// A square in the plane z = 0, 2 · `half` wide, of two triangles.
fn floor(half: f64) -> Mesh {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let positions = corners.map(|[x, y]| (half * DVec3::new(x, y, 0.0)).as_vec3());
    Mesh::new(positions.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

/// The lines of intersection, each as its points and whether it is closed.
fn lines(mesh: &Mesh) -> Vec<(Vec<DVec3>, bool)> {
    let adjacency = MeshAdjacency::new(mesh);
    let intersections = Intersections::new(mesh, &adjacency);
    let options = LineOptions { intersections: Some(&intersections), ..Default::default() };
    let segments = Segments::new(mesh, &adjacency, &[], &options);
    let position = |end| segments.position(mesh, end);
    let chains = chain(position, segments.of(LineClass::Intersection));
    assert_eq!(chains.iter().map(|c| c.segments.len()).sum::<usize>(), intersections.len());
    let points = |chain: &Chain| {
        let ends = chain.segments.iter().map(|s| position(s.ends[0]));
        ends.chain(chain.segments.last().map(|s| position(s.ends[1]))).collect()
    };
    chains.iter().map(|chain| (points(chain), chain.closed)).collect()
}

fn length(points: &[DVec3]) -> f64 {
    points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// Turns that no coordinate survives without rounding, and one that changes nothing.
fn turns() -> impl Iterator<Item = DQuat> {
    let axis = |i: f64| DVec3::new(1.0 + i, (2.3 * i).sin(), 0.4 - 0.1 * i).normalize();
    let odd = (0..6).map(f64::from).map(move |i| DQuat::from_axis_angle(axis(i), 0.3 + 1.1 * i));
    [DQuat::IDENTITY].into_iter().chain(odd)
}

/// Number of lines, all of them closed or all open, and their length in all; as modelled, and turned
/// so that all is rounded.
#[track_caller]
fn check(what: &str, mesh: &Mesh, expected: usize, closed: bool, expected_length: f64) {
    for (turn, rotation) in turns().enumerate() {
        for offset in [DVec3::ZERO, DVec3::new(3.7, -8.1, 5.3)] {
            let mesh = moved(mesh, |p| rotation * (p + offset));
            let lines = lines(&mesh);
            let found: f64 = lines.iter().map(|line| length(&line.0)).sum();
            assert_eq!(lines.len(), expected, "{what}, turn {turn}, {offset}: {lines:?}");
            assert!(lines.iter().all(|line| line.1 == closed), "{what}, turn {turn}: {lines:?}");
            let apart = (found - expected_length).abs();
            assert!(apart < 1e-4 * expected_length.max(1.0), "{what}: {found} long");
        }
    }
}

#[test]
fn what_only_touches_has_no_line() {
    let [floor, block] = [floor(5.0), cuboid([-1.0, -1.0, 0.0], [1.0, 1.0, 2.0])];
    let on_floor = together(&[floor.clone(), block.clone()]);
    check("a box on a floor", &on_floor, 0, true, 0.0);
    let edge = moved(&block, |p| DVec3::new(p.x, p.y, p.x + p.z + 1.0));
    check("an edge on a floor", &together(&[floor.clone(), edge]), 0, true, 0.0);
    let beside = cuboid([1.0, -0.5, 0.3], [2.0, 0.7, 1.7]);
    check("boxes side by side", &together(&[block.clone(), beside]), 0, true, 0.0);
    let flush = cuboid([-1.0, -1.0, 2.0], [0.5, 1.0, 3.0]);
    check("a box flush upon another", &together(&[block.clone(), flush]), 0, true, 0.0);
    check("a surface stored twice", &together(&[block.clone(), block.clone()]), 0, true, 0.0);
    let patch = moved(&floor, |p| DVec3::new(0.31 * p.x + 0.2 * p.y, 0.4 * p.y - 0.1 * p.x, 0.0));
    check("a sheet in a sheet", &together(&[floor.clone(), patch]), 0, true, 0.0);
    let tip = shapes::tetrahedron();
    let lowest = tip.positions().iter().map(|p| p.z).fold(f32::MAX, f32::min);
    let apex = tip.positions().iter().find(|p| p.z == lowest).unwrap().as_dvec3();
    let on_tip = moved(&tip, |p| p - apex + DVec3::new(0.3, 0.1, 0.0));
    check("a body on its tip", &together(&[floor.clone(), on_tip]), 0, true, 0.0);
    let wall = moved(&floor, |p| DVec3::new(0.4 * p.x + 0.1, 0.2 * p.x, 0.2 * (p.y + 5.0)));
    check("a wall on a floor", &together(&[floor, wall]), 0, true, 0.0);
}

#[test]
fn a_t_junction_is_no_intersection() {
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    for bend in [0.0, 0.02, 1.0, -3.0] {
        for middle in [0.5, 0.31, 0.013] {
            // Two faces on one side of an edge, one on the other, whose vertex is in the middle.
            let points = [
                at(0.0, 0.0, 0.0),
                at(1.0, 0.7, 0.3),
                at(1.0, -1.0, bend),
                at(-0.3, 1.0, bend),
                middle * at(1.0, 0.7, 0.3),
            ];
            let positions = points.map(|p| p.as_vec3()).to_vec();
            let mesh = Mesh::new(positions, vec![[0, 2, 1], [0, 4, 3], [4, 1, 3]]).unwrap();
            check(&format!("a T-junction, {bend}, {middle}"), &mesh, 0, true, 0.0);
        }
    }
}

#[test]
fn what_passes_through_has_a_line() {
    let [floor, block] = [floor(5.0), cuboid([-1.0, -1.0, -0.7], [1.0, 1.0, 2.0])];
    check("a box in a floor", &together(&[floor.clone(), block.clone()]), 1, true, 8.0);
    let twice = together(&[floor.clone(), block.clone(), block.clone(), floor.clone()]);
    check("both stored twice", &twice, 1, true, 8.0);
    let bar = cuboid([-2.0, -0.5, 0.2], [2.0, 0.5, 0.6]);
    check("a bar through a box", &together(&[block, bar]), 2, true, 2.0 * (2.0 + 0.8));
    let wall = moved(&floor, |p| DVec3::new(0.4 * p.x, 0.1 * p.x, 0.2 * p.y));
    let wall_length = 10.0 * 0.4f64.hypot(0.1);
    check("a wall in a floor", &together(&[floor.clone(), wall]), 1, false, wall_length);
    let sheet = moved(&floor, |p| DVec3::new(p.x, 0.0, p.y));
    let cross = together(&[floor.clone(), sheet]);
    check("sheets as large as each other", &cross, 1, false, 10.0);
}

/// Faces around the z axis, of `ring` sides, with a row of edges in the plane z = 0. Those below it come
/// first.
fn tube(ring: u16) -> Mesh {
    let around = |i: u16, z: f64| {
        let angle = TAU * f64::from(i % ring) / f64::from(ring);
        DVec3::new(angle.cos(), angle.sin(), z).as_vec3()
    };
    let rows = [-1.0, 0.0, 0.8];
    let positions: Vec<Vec3> =
        rows.iter().flat_map(|&z| (0..ring).map(move |i| around(i, z))).collect();
    let row = u32::from(ring);
    let quads = (0..2).flat_map(|y| (0..row).map(move |x| [y * row + x, y * row + (x + 1) % row]));
    let triangles = quads.flat_map(|[a, b]| [[a, b, b + row], [a, b + row, a + row]]).collect();
    Mesh::new(positions, triangles).unwrap()
}

/// Edges of one surface, or of both, lie exactly in the other.
#[test]
fn what_passes_through_along_its_edges_has_a_line() {
    let ring = 24;
    let circumference = f64::from(ring) * 2.0 * (TAU / f64::from(ring) / 2.0).sin();
    let cut = together(&[floor(5.0), tube(ring)]);
    check("a tube in a floor", &cut, 1, true, circumference);
    // Two bent sheets with an edge on one line, cut at other places.
    let bent = |side: DVec3, at: [f64; 3]| {
        let line = at.map(|x| DVec3::new(x, 0.0, 0.0));
        let rims = [side, DVec3::new(0.0, -side.y, side.z)];
        let points: Vec<Vec3> = line
            .into_iter()
            .chain(rims.into_iter().flat_map(|rim| line.map(|p| p + rim)))
            .map(|p| p.as_vec3())
            .collect();
        let strip =
            |rim: u32| [[0, 1, rim], [1, rim + 1, rim], [1, 2, rim + 1], [2, rim + 2, rim + 1]];
        Mesh::new(points, [strip(3), strip(6)].concat()).unwrap()
    };
    let roof = bent(DVec3::new(0.0, 1.0, -0.5), [0.0, 0.4, 2.0]);
    let gutter = bent(DVec3::new(0.0, 1.0, 0.7), [-0.5, 0.9, 1.5]);
    check("a roof under a gutter", &together(&[roof.clone(), gutter]), 0, true, 0.0);
    let upright = moved(&roof, |p| DVec3::new(1.1 * p.x - 0.3, p.z + 0.5 * p.y, 2.0 * p.y));
    check("sheets through each other's bend", &together(&[roof, upright]), 1, false, 1.9);
}

/// Where surfaces cross along an edge that is drawn anyway, that is all there is.
#[test]
fn a_line_along_a_drawn_edge_is_drawn_once() {
    let mesh = together(&[tube(24), floor(5.0)]);
    let adjacency = MeshAdjacency::new(&mesh);
    let intersections = Intersections::new(&mesh, &adjacency);
    // The diagonal of the floor may cut two of them.
    assert!((24..=26).contains(&intersections.len()));
    let below = FaceNames::new([("below", 0..48)]);
    let options = LineOptions { intersections: Some(&intersections), ..Default::default() };
    let count = |options| {
        let segments = Segments::new(&mesh, &adjacency, &[], &options);
        [LineClass::Material, LineClass::Intersection].map(|class| segments.of(class).len())
    };
    assert_eq!(count(options), [0, intersections.len()]);
    assert_eq!(count(LineOptions { materials: Some(&below), ..options }), [24, 0]);
}

#[test]
fn balls_cross_in_a_circle() {
    let ball = shapes::icosphere(5120);
    for (turn, rotation) in turns().enumerate() {
        let other = moved(&ball, |p| rotation * p + DVec3::new(0.9, 0.3, -0.2));
        let mesh = together(&[ball.clone(), other]);
        let apart = DVec3::new(0.9, 0.3, -0.2);
        let radius = (1.0 - 0.25 * apart.length_squared()).sqrt();
        let lines = lines(&mesh);
        assert_eq!(lines.len(), 1, "turn {turn}");
        let (points, closed) = &lines[0];
        assert!(closed);
        let found = length(points);
        assert!((found / (TAU * radius) - 1.0).abs() < 2e-3, "turn {turn}: {found} long");
        for point in points {
            let from_center = point.distance(0.5 * apart);
            assert!((from_center - radius).abs() < 3e-3, "turn {turn}: {point}");
            let off_plane = (*point - 0.5 * apart).dot(apart.normalize()).abs();
            assert!(off_plane < 3e-3, "turn {turn}: {point}");
        }
    }
}

/// Closed surfaces cross in closed lines, whatever their triangles.
#[test]
fn lines_of_closed_surfaces_close() {
    let knot = shapes::torus_knot(3000);
    let shapes = [shapes::cad_part(672), shapes::bumpy_sphere(2000), shapes::icosphere(320)];
    for shape in shapes {
        for rotation in turns() {
            let turned = moved(&shape, |p| rotation * p * 1.3);
            let lines = lines(&together(&[knot.clone(), turned]));
            assert!(!lines.is_empty() && lines.iter().all(|line| line.1));
        }
    }
    for shapes::NamedMesh { name, mesh } in shapes::closed() {
        assert!(lines(&mesh).is_empty(), "{name} passes through itself");
    }
}

/// Whatever the triangles, nothing fails, and the order of faces changes no length.
#[test]
fn every_shape_crosses_every_other() {
    let all = shapes::all();
    for [a, b] in (0..all.len()).flat_map(|i| (0..i).map(move |j| [i, j])) {
        let what = [all[a].name, all[b].name];
        let [a, b] = [&all[a].mesh, &all[b].mesh];
        if a.triangles().len() + b.triangles().len() > 2000 {
            continue;
        }
        let total = |mesh| -> f64 { lines(&mesh).iter().map(|line| length(&line.0)).sum() };
        let [one, other] = [together(&[a.clone(), b.clone()]), together(&[b.clone(), a.clone()])];
        let (found, expected) = (total(one), total(other));
        assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{what:?}: {found}, {expected}");
    }
}

/// The same shapes at another scale cross in the same lines: to the bit if nothing is rounded.
#[test]
fn scale_changes_nothing() {
    let mesh = together(&[shapes::torus_knot(2000), shapes::bumpy_sphere(1000)]);
    let expected = lines(&mesh);
    assert!(!expected.is_empty());
    for scale in [2f64.powi(-100), 2f64.powi(-30), 2f64.powi(60), 2f64.powi(120)] {
        let found = lines(&moved(&mesh, |p| scale * p));
        let unscaled: Vec<_> = found
            .into_iter()
            .map(|(line, closed)| (line.into_iter().map(|p| p / scale).collect(), closed))
            .collect();
        assert_eq!(unscaled, expected, "{scale:e}");
    }
    for scale in [1e-38, 1e-36, 3e37] {
        let found: f64 = lines(&moved(&mesh, |p| scale * p)).iter().map(|l| length(&l.0)).sum();
        let expected: f64 = expected.iter().map(|line| scale * length(&line.0)).sum();
        assert!((found / expected - 1.0).abs() < 1e-3, "{scale:e}: {found:e}, {expected:e}");
    }
}

/// Where two triangles cross by the interval method (Möller, A Fast Triangle-Triangle Intersection
/// Test, 1997), in f64; `None` where that cannot tell.
fn naive(a: [DVec3; 3], b: [DVec3; 3]) -> Option<Option<[DVec3; 2]>> {
    const UNSURE: f64 = 1e-6;
    let normal = |[p, q, r]: [DVec3; 3]| (q - p).cross(r - p).normalize_or_zero();
    let [on_a, on_b] = [normal(a), normal(b)];
    let direction = on_a.cross(on_b);
    if direction.length() < UNSURE {
        return None;
    }
    let interval = |points: [DVec3; 3], normal: DVec3, origin: DVec3| {
        let heights = points.map(|p| normal.dot(p - origin));
        if heights.iter().any(|h| h.abs() < UNSURE) {
            return None;
        }
        let crossing = |i: usize| {
            let j = (i + 1) % 3;
            let t = heights[i] / (heights[i] - heights[j]);
            (heights[i] * heights[j] < 0.0).then(|| points[i].lerp(points[j], t))
        };
        Some((0..3).filter_map(crossing).collect::<Vec<_>>())
    };
    let [of_a, of_b] = [interval(a, on_b, b[0])?, interval(b, on_a, a[0])?];
    if of_a.is_empty() || of_b.is_empty() {
        return Some(None);
    }
    let along = |mut ends: Vec<DVec3>| {
        ends.sort_by(|p, q| direction.dot(*p).total_cmp(&direction.dot(*q)));
        ends
    };
    let [of_a, of_b] = [of_a, of_b].map(along);
    let at = |p: DVec3| direction.dot(p);
    let start = if at(of_a[0]) > at(of_b[0]) { of_a[0] } else { of_b[0] };
    let end = if at(of_a[1]) < at(of_b[1]) { of_a[1] } else { of_b[1] };
    let overlap = at(end) - at(start);
    if overlap.abs() < UNSURE {
        return None;
    }
    Some((overlap > 0.0).then_some([start, end]))
}

proptest! {
    #[test]
    fn pairs_cross_where_the_naive_test_says(
        points in proptest::collection::vec(
            (-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0).prop_map(|(x, y, z)| Vec3::new(x, y, z)), 6..30,
        ),
    ) {
        let count = u32::try_from(points.len() / 3).unwrap();
        let triangles: Vec<[u32; 3]> = (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let mesh = Mesh::new(points, triangles).unwrap();
        let adjacency = MeshAdjacency::new(&mesh);
        let intersections = Intersections::new(&mesh, &adjacency);
        let options = LineOptions { intersections: Some(&intersections), ..Default::default() };
        let segments = Segments::new(&mesh, &adjacency, &[], &options);
        let corners = |face: u32| mesh.corners(face).map(|p| p.as_dvec3());
        for [a, b] in (0..count).flat_map(|b| (0..b).map(move |a| [a, b])) {
            let mut found = segments.of(LineClass::Intersection).iter().filter(|s| s.faces == [a, b]);
            let Some(expected) = naive(corners(a), corners(b)) else { continue };
            let found = found.next().map(|s| s.ends.map(|end| segments.position(&mesh, end)));
            prop_assert_eq!(found.is_some(), expected.is_some(), "{:?}", [a, b]);
            if let (Some([p, q]), Some([start, end])) = (found, expected) {
                let straight = p.distance(start).max(q.distance(end));
                let turned = p.distance(end).max(q.distance(start));
                prop_assert!(straight.min(turned) < 1e-6);
            }
        }
    }

    #[test]
    fn soups_on_a_grid_do_no_harm(
        corners in proptest::collection::vec((0i8..4, 0i8..4, 0i8..4), 3..60),
    ) {
        let at = |&(x, y, z): &(i8, i8, i8)| Vec3::new(f32::from(x), f32::from(y), f32::from(z));
        let positions: Vec<Vec3> = corners.iter().map(at).collect();
        let count = u32::try_from(positions.len() / 3).unwrap();
        let triangles = (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let mesh = Mesh::new(positions, triangles).unwrap();
        for (points, _) in lines(&mesh) {
            prop_assert!(points.iter().all(|p| p.cmpge(DVec3::ZERO).all() && p.cmple(DVec3::splat(3.0)).all()));
            prop_assert!(points.windows(2).all(|pair| pair[0].distance(pair[1]) > 1e-9));
        }
    }
}

const PAGE: Page = Page { width: 500, height: 500, margin: 20.0 };

/// Neither closed gaps nor dropped specks.
const EXACT: VisibilityParams =
    VisibilityParams { step: 1.0, precision: 0.005, close_gaps: 0.0, drop_specks: 0.0 };

/// Pixels of the lines of intersection that are visible and hidden.
fn seen(mesh: &Mesh, camera: &Camera) -> [f64; 2] {
    let adjacency = MeshAdjacency::new(mesh);
    let intersections = Intersections::new(mesh, &adjacency);
    let mut contours = Vec::new();
    contour_edges(mesh, &adjacency, camera.viewpoint(), EdgeFilter::All, &mut contours);
    let options = LineOptions { intersections: Some(&intersections), ..Default::default() };
    let segments = Segments::new(mesh, &adjacency, &contours, &options);
    let drawing = Drawing::new(&Occluders::new(mesh, &adjacency), &segments, camera, &EXACT);
    let layer = drawing.layers.iter().find(|l| l.class == LineClass::Intersection).unwrap();
    [layer.visible_length(), layer.hidden_length()]
}

#[track_caller]
fn check_seen(found: [f64; 2], expected: [f64; 2], tolerance: f64) {
    let apart = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
    assert!(apart < tolerance, "{found:?} px visible and hidden, expected {expected:?}");
}

/// A box through a floor, from above and from below, from nearby and far away.
#[test]
fn a_box_hides_the_far_side_of_the_line_around_it() {
    let mesh = together(&[floor(4.0), cuboid([-1.0, -1.0, -0.7], [1.0, 1.0, 1.0])]);
    for rotation in turns() {
        let turned = moved(&mesh, |p| rotation * p);
        let camera = |towards_viewer: [f64; 3]| {
            let towards_viewer = rotation * DVec3::from_array(towards_viewer);
            let up = rotation * DVec3::Z;
            Camera::orthographic(towards_viewer, DVec3::ZERO, Some(up), 10.0, PAGE).unwrap()
        };
        for azimuth in [0.1, 0.785, 2.0, 3.5] {
            for height in [-0.6, 0.3, 1.0] {
                let towards = DVec3::new(f64::cos(azimuth), f64::sin(azimuth), height).normalize();
                // 50 pixels a unit. Two sides of the square face the viewer, two are behind.
                let on_page = |side: DVec3| 50.0 * side.reject_from(towards).length();
                let half = on_page(2.0 * DVec3::X) + on_page(2.0 * DVec3::Y);
                check_seen(seen(&turned, &camera(towards.to_array())), [half, half], 0.1);
            }
        }
    }
    let camera = Camera::perspective(DVec3::new(0.0, -6.0, 4.0), DVec3::ZERO, None, 40.0, PAGE);
    let camera = camera.unwrap();
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let corners = corners.map(|[x, y]| camera.project(DVec3::new(x, y, 0.0)).unwrap());
    let sides: [f64; 4] = std::array::from_fn(|i| corners[i].distance(corners[(i + 1) % 4]));
    // The sides that lead away from the viewer come together, behind the front.
    check_seen(seen(&mesh, &camera), [sides[0], sides[1] + sides[2] + sides[3]], 0.1);
}

/// The waist of two balls is a circle in the plane between them: seen from straight ahead as a line
/// whose far half is hidden, by symmetry.
#[test]
fn half_of_a_waist_is_visible() {
    let ball = shapes::icosphere(20_480);
    let apart = DVec3::new(0.613, 0.0, 0.0);
    let mesh = together(&[moved(&ball, |p| p - apart), moved(&ball, |p| p + apart)]);
    let camera = Camera::orthographic(DVec3::Z, DVec3::ZERO, None, 4.0, PAGE).unwrap();
    let width = 2.0 * (1.0 - apart.length_squared()).sqrt() * 125.0;
    check_seen(seen(&mesh, &camera), [width, width], 1.0);
}

/// The same lines on any number of threads.
#[test]
fn threads_change_nothing() {
    let knot = shapes::torus_knot(3000);
    let mesh = together(&[knot, shapes::bumpy_sphere(2000)]);
    let adjacency = MeshAdjacency::new(&mesh);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Intersections::new(&mesh, &adjacency))
    };
    let one = on(1);
    assert!(one.len() > 100);
    for threads in [2, 5] {
        assert_eq!(on(threads), one);
    }
}

#[test]
fn models_cross_themselves() {
    let Some(folder) = std::env::var_os("DRYPOINT_MODELS") else { return };
    let read = |name: &str| io::read(&std::path::Path::new(&folder).join(name)).unwrap().mesh;
    // The spout and the handle pass through the body; the lid touches it.
    let teapot = lines(&read("teapot.obj"));
    assert!(teapot.iter().map(|line| length(&line.0)).sum::<f64>() > 1.0, "{teapot:?}");
    assert!(lines(&read("spot.obj")).is_empty());
}
