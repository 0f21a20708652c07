//! What is hidden, compared with a naive test of every triangle and with what is known of shapes.
#![cfg(feature = "visibility")]

use drypoint_lines::{
    Camera, Drawing, LineClass, LineOptions, Occluders, Page, Segments, VisibilityParams,
};
use drypoint_mesh::{
    EdgeFilter, EdgeId, Mesh, MeshAdjacency, Viewpoint, contour_edges, io, shapes,
};
use glam::{DVec3, Vec3};

const PAGE: Page = Page { width: 500, height: 500, margin: 20.0 };

/// Neither closed gaps nor dropped specks.
const EXACT: VisibilityParams =
    VisibilityParams { step: 1.0, precision: 0.02, close_gaps: 0.0, drop_specks: 0.0 };

fn viewpoints(mesh: &Mesh) -> Vec<Viewpoint> {
    let bounds = mesh.bounds().unwrap();
    let eye = |x, y, z| bounds.center() + bounds.half_longest_side() * DVec3::new(x, y, z);
    vec![
        Viewpoint::at(eye(2.1, 1.7, 2.9)),
        Viewpoint::at(eye(-40.0, 1.3, -17.0)),
        // Inside, or at least within the box.
        Viewpoint::at(eye(0.11, -0.07, 0.13)),
        Viewpoint::from_direction(DVec3::new(-0.31, 0.23, 0.77)),
    ]
}

/// Whether a triangle hides `point`, by the formula of Möller and Trumbore (Fast, Minimum Storage
/// Ray-Triangle Intersection, 1997); `None` where f64 cannot tell.
fn naive(corners: [Vec3; 3], point: DVec3, viewpoint: Viewpoint) -> Option<bool> {
    const UNSURE: f64 = 1e-7;
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let (u, v, to_eye) = (b - a, c - a, viewpoint.from_point(point));
    let normal = u.cross(v);
    let determinant = -to_eye.dot(normal);
    if determinant.abs() <= 1e-12 * normal.length() * to_eye.length() {
        return if normal == DVec3::ZERO { Some(false) } else { None };
    }
    let across = to_eye.cross(point - a);
    let y = -v.dot(across) / determinant;
    let z = u.dot(across) / determinant;
    let most_outside = y.min(z).min(1.0 - y - z);
    if most_outside < -UNSURE {
        return Some(false);
    }
    let height = normal.dot(point - a);
    let t = height / determinant;
    let beyond = viewpoint.is_point() && t > 1.0;
    let largest = [a, b, c, point].map(|p| p.abs().max_element()).into_iter().fold(0.0, f64::max);
    let near = height.abs() < 1e-6 * largest * normal.length();
    if near || most_outside < UNSURE || (t - 1.0).abs() < UNSURE {
        return None;
    }
    Some(t > 0.0 && !beyond)
}

/// Compares samples of every `stride`th edge with the naive test. Counts those that it could tell.
fn check(name: &str, mesh: &Mesh, stride: usize) -> [usize; 2] {
    let adjacency = MeshAdjacency::new(mesh);
    let occluders = Occluders::new(mesh, &adjacency);
    let welded = |corners: &[u32; 3]| corners.map(|v| adjacency.representatives()[v as usize]);
    let mut counts = [0, 0];
    for viewpoint in viewpoints(mesh) {
        for edge in adjacency.edge_ids().step_by(stride) {
            let ends = adjacency.wing(edge).ends();
            let [a, b] = ends.map(|v| mesh.position(v).as_dvec3());
            for fraction in [0.12, 0.5, 0.83] {
                let point = a + fraction * (b - a);
                let others = mesh
                    .triangles()
                    .iter()
                    .filter(|t| !ends.iter().all(|end| welded(t).contains(end)))
                    .map(|t| naive(t.map(|v| mesh.position(v)), point, viewpoint));
                let (mut hidden, mut unsure) = (false, false);
                for answer in others {
                    hidden |= answer == Some(true);
                    unsure |= answer.is_none();
                }
                if hidden || !unsure {
                    let found = occluders.is_hidden(ends, fraction, viewpoint);
                    assert_eq!(found, hidden, "{name}: {ends:?} at {fraction} from {viewpoint:?}");
                    counts[usize::from(hidden)] += 1;
                }
            }
        }
    }
    counts
}

#[test]
fn every_shape_hides_what_the_naive_test_says() {
    let shapes = [
        shapes::closed(),
        shapes::with_boundary(),
        shapes::non_manifold(),
        shapes::inconsistent(),
        shapes::degenerate(),
        shapes::far_from_origin(),
    ];
    let mut total = [0, 0];
    for shapes::NamedMesh { name, mesh } in shapes.into_iter().flatten() {
        let counts = check(name, &mesh, 1 + mesh.triangles().len() / 150);
        total = [total[0] + counts[0], total[1] + counts[1]];
    }
    assert!(total[0] > 2000 && total[1] > 4000, "only {total:?} told");
}

#[test]
fn every_model_hides_what_the_naive_test_says() {
    let Some(folder) = std::env::var_os("DRYPOINT_MODELS") else { return };
    for name in ["stanford-bunny", "fandisk", "teapot", "suzanne", "sponza", "beetle-alt"] {
        let path = std::path::Path::new(&folder).join(name).with_extension("obj");
        let mesh = io::read(&path).unwrap().mesh;
        let counts = check(name, &mesh, 1 + mesh.triangles().len() / 20);
        assert!(counts[0] > 10 && counts[1] > 50, "{name}: only {counts:?} told");
    }
}

fn fitted(mesh: &Mesh, towards_viewer: DVec3) -> Camera {
    let points = mesh.triangles().iter().flatten().map(|&v| mesh.position(v).as_dvec3());
    Camera::fit_perspective(points, towards_viewer, None, 40.0, PAGE).unwrap()
}

fn contours(mesh: &Mesh, adjacency: &MeshAdjacency, camera: &Camera) -> Vec<EdgeId> {
    let mut contours = Vec::new();
    contour_edges(mesh, adjacency, camera.viewpoint(), EdgeFilter::All, &mut contours);
    contours
}

fn draw(
    mesh: &Mesh,
    camera: &Camera,
    options: LineOptions<'_>,
    params: &VisibilityParams,
) -> Drawing {
    let adjacency = MeshAdjacency::new(mesh);
    let contours = contours(mesh, &adjacency, camera);
    let segments = Segments::new(mesh, &adjacency, &contours, &options);
    Drawing::new(&Occluders::new(mesh, &adjacency), &segments, camera, params)
}

const EVERYTHING: LineOptions<'_> =
    LineOptions { boundary: true, crease_angle: Some(0.5), materials: None, intersections: None };

fn lengths(drawing: &Drawing) -> [f64; 2] {
    let sum = |length: fn(&drypoint_lines::Layer) -> f64| drawing.layers.iter().map(length).sum();
    [sum(|layer| layer.visible_length()), sum(|layer| layer.hidden_length())]
}

#[track_caller]
fn check_close(found: [f64; 2], expected: [f64; 2], tolerance: f64, what: &str) {
    let apart = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
    assert!(apart <= tolerance, "{what}: {found:?} px visible and hidden, expected {expected:?}");
}

/// The lengths found by walking lines step by step are those of very many samples.
#[test]
fn runs_end_where_lines_vanish() {
    const FINE: f64 = 0.1;
    let params = VisibilityParams { step: FINE, ..EXACT };
    for name in ["torus-knot", "bumpy-sphere", "cad-part", "mobius-strip", "cubes-sharing-an-edge"]
    {
        let mesh = shapes::by_name(name, 300).unwrap();
        let adjacency = MeshAdjacency::new(&mesh);
        let points = mesh.positions().iter().map(|p| p.as_dvec3());
        // A wide lens from nearby: fractions on paper are far from those in space.
        let towards_viewer = DVec3::new(0.3, 0.5, 0.8);
        let camera = Camera::fit_perspective(points, towards_viewer, None, 100.0, PAGE).unwrap();
        let contours = contours(&mesh, &adjacency, &camera);
        let segments = Segments::new(&mesh, &adjacency, &contours, &EVERYTHING);
        let occluders = Occluders::new(&mesh, &adjacency);
        let mut expected = [0.0, 0.0];
        for segment in LineClass::ALL.iter().flat_map(|&class| segments.of(class)) {
            let [a, b] = segment.ends.map(|v| mesh.position(v).as_dvec3());
            let [from, to] = [a, b].map(|p| camera.project(p).unwrap());
            let count = (from.distance(to) / FINE).ceil();
            let at = |i: f64| camera.project(a.lerp(b, i / count)).unwrap();
            for i in (0..).map(f64::from).take_while(|&i| i < count) {
                let fraction = (i + 0.5) / count;
                let hidden = occluders.is_hidden(segment.ends, fraction, camera.viewpoint());
                expected[usize::from(hidden)] += at(i).distance(at(i + 1.0));
            }
        }
        let drawing = Drawing::new(&occluders, &segments, &camera, &params);
        let runs: usize = drawing.layers.iter().map(|layer| layer.runs.len()).sum();
        check_close(lengths(&drawing), expected, 0.2 * FINE * runs as f64, name);
    }
}

/// What a sample sees from within a hair of a vertex is what one sees a little further on.
#[test]
fn visibility_does_not_change_at_a_vertex() {
    for name in ["bumpy-sphere", "torus-knot", "cad-part"] {
        let mesh = shapes::by_name(name, 3000).unwrap();
        let adjacency = MeshAdjacency::new(&mesh);
        let occluders = Occluders::new(&mesh, &adjacency);
        for viewpoint in viewpoints(&mesh) {
            for edge in adjacency.edge_ids() {
                let [a, b] = adjacency.wing(edge).ends();
                for ends in [[a, b], [b, a]] {
                    let [near, further] =
                        [1e-13, 1e-4].map(|f| occluders.is_hidden(ends, f, viewpoint));
                    assert_eq!(near, further, "{name}: {ends:?} from {viewpoint:?}");
                }
            }
        }
    }
}

/// The same shape at another scale, or elsewhere, looks the same.
#[test]
fn no_line_hides_behind_its_own_faces_at_any_scale() {
    for name in ["torus-knot", "bumpy-sphere", "cad-part"] {
        let mesh = shapes::by_name(name, 2000).unwrap();
        let view = |mesh: &Mesh| {
            let camera = fitted(mesh, DVec3::new(0.4, 0.6, 0.7));
            lengths(&draw(mesh, &camera, EVERYTHING, &EXACT))
        };
        let placed = |scale: f64, offset: f64| {
            let place = |p: &Vec3| (scale * (p.as_dvec3() + offset)).as_vec3();
            Mesh::new(mesh.positions().iter().map(place).collect(), mesh.triangles().to_vec())
                .unwrap()
        };
        let expected = view(&mesh);
        let total = expected[0] + expected[1];
        for (scale, offset, tolerance) in [
            (2f64.powi(-90), 0.0, 0.0),
            (2f64.powi(90), 0.0, 0.0),
            (1e-6, 0.0, 1e-3),
            (1e6, 0.0, 1e-3),
            (1e-35, 0.0, 1e-3),
            (1e35, 0.0, 1e-3),
            (1.0, 100.0, 0.03),
        ] {
            let found = view(&placed(scale, offset));
            check_close(found, expected, tolerance * total, &format!("{name} {scale} {offset}"));
        }
    }
}

#[test]
fn the_contour_of_a_ball_is_one_visible_ring() {
    for (triangles, scale) in [(20, 1.0), (1280, 1e-20), (20_480, 1e6)] {
        let ball = shapes::icosphere(triangles);
        let positions = ball.positions().iter().map(|&p| p * scale).collect();
        let ball = Mesh::new(positions, ball.triangles().to_vec()).unwrap();
        for towards_viewer in [DVec3::Z, DVec3::ONE, DVec3::new(-0.3, 0.1, 0.2)] {
            let camera = fitted(&ball, towards_viewer);
            let layer = draw(&ball, &camera, LineOptions::default(), &EXACT).layers.remove(0);
            assert_eq!((layer.class, layer.chains, layer.runs.len()), (LineClass::Contour, 1, 1));
            let run = &layer.runs[0];
            assert!(run.closed && run.visible);
            assert_eq!((run.points.len(), run.segments.len()), (layer.segments, layer.segments));
        }
    }
}

/// The back of a box lies exactly behind its front. Its outline must not vanish between the two.
#[test]
fn a_box_seen_from_the_front_has_its_outline() {
    for towards_viewer in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z] {
        let cube = shapes::cube();
        let points = cube.positions().iter().map(|p| p.as_dvec3());
        let camera = Camera::fit_orthographic(points, towards_viewer, None, PAGE).unwrap();
        let drawing = draw(&cube, &camera, LineOptions::default(), &EXACT);
        check_close(lengths(&drawing), [4.0 * 460.0, 0.0], 1e-6, "the front of a box");
    }
}

/// Lines far behind a wall of triangles whose edges and corners the lines of sight meet.
#[test]
fn no_line_of_sight_slips_between_triangles() {
    let steps = 8u16;
    let at = |i: u16| f32::from(i) - 4.0;
    let mut positions: Vec<Vec3> =
        (0..=steps).flat_map(|y| (0..=steps).map(move |x| Vec3::new(at(x), at(y), 1.0))).collect();
    let row = u32::from(steps) + 1;
    let mut triangles: Vec<[u32; 3]> = (0..row - 1)
        .flat_map(|y| (0..row - 1).map(move |x| row * y + x))
        .flat_map(|v| [[v, v + 1, v + row + 1], [v, v + row + 1, v + row]])
        .collect();
    // Triangles far behind, one edge of each on a line of the grid.
    let first = u32::try_from(positions.len()).unwrap();
    let lines = [[-3.0, 0.0, 3.0, 0.0], [1.0, -3.0, 1.0, 3.0], [-3.0, -3.0, 3.0, 3.0]];
    for (i, [x, y, u, v]) in (0..).zip(lines) {
        positions.extend([Vec3::new(x, y, -5.0), Vec3::new(u, v, -5.0), Vec3::new(u, v, -6.0)]);
        triangles.push([0, 1, 2].map(|corner| first + 3 * i + corner));
    }
    let mesh = Mesh::new(positions, triangles).unwrap();
    let adjacency = MeshAdjacency::new(&mesh);
    let occluders = Occluders::new(&mesh, &adjacency);
    for i in 0..3 {
        for sixth in (1..96).map(|i| f64::from(i) / 96.0) {
            let ends = [first + 3 * i, first + 3 * i + 1];
            let viewpoint = Viewpoint::from_direction(DVec3::Z);
            assert!(occluders.is_hidden(ends, sixth, viewpoint), "line {i} at {sixth}");
        }
    }
}

/// Two sheets in one tilted plane, cut into other triangles: f32 puts neither before the other.
#[test]
fn surfaces_modelled_twice_do_not_hide_their_lines() {
    let tilt = |x: f64, y: f64| {
        (DVec3::new(0.6, 0.13, 0.7) * x + DVec3::new(-0.2, 0.9, 0.3) * y).as_vec3()
    };
    let mut positions = vec![tilt(-9.1, -9.3), tilt(9.7, -8.9), tilt(9.2, 9.9), tilt(-9.4, 9.6)];
    let mut triangles = vec![[0, 1, 2], [0, 2, 3]];
    let ring = 24u16;
    positions.extend((0..ring).map(|i| {
        let (sin, cos) = (f64::from(i) * 0.261_799).sin_cos();
        tilt(1.0 + 5.3 * cos, 0.7 + 5.3 * sin)
    }));
    positions.push(tilt(1.0, 0.7));
    let ring = u32::from(ring);
    triangles.extend((0..ring).map(|i| [4 + ring, 4 + i, 4 + (i + 1) % ring]));
    let mesh = Mesh::new(positions, triangles).unwrap();
    let camera = fitted(&mesh, DVec3::new(-0.5, -0.2, 1.0));
    let drawing = draw(&mesh, &camera, EVERYTHING, &EXACT);
    assert_eq!(lengths(&drawing)[1], 0.0);
}

#[test]
fn from_inside_a_room_its_edges_are_seen() {
    let cube = shapes::cube();
    let eye = DVec3::new(0.0, 0.0, 0.999);
    let camera = Camera::perspective(eye, DVec3::ZERO, None, 90.0, PAGE).unwrap();
    let drawing = draw(&cube, &camera, EVERYTHING, &EXACT);
    // The far wall is 2 / 1.999 of the page's half; four edges run from it to the corners of the
    // page, the four of the near wall are behind the eye.
    let half = 250.0 / 1.999;
    let to_corners = 4.0 * (250.0 - half) * 2f64.sqrt();
    check_close(lengths(&drawing), [8.0 * half + to_corners, 0.0], 1e-6, "a room");
}

/// Of a line along the x axis from `from` to `to`, with an upright bar between −half_width and
/// half_width in front of it: the ranges of x that are visible. A unit is 50 pixels. The line is
/// alone as a contour, and one side of a closed chain as a boundary.
fn beside_bar(
    half_width: f32,
    [from, to]: [f32; 2],
    class: LineClass,
    params: &VisibilityParams,
) -> Vec<[f64; 2]> {
    let bar = [[-1.0, -9.0], [1.0, -9.0], [1.0, 9.0], [-1.0, 9.0]]
        .map(|[x, y]| Vec3::new(half_width * x, y, 1.0));
    let line = [Vec3::new(from, 0.0, 0.0), Vec3::new(to, 0.0, 0.0), Vec3::new(to, 0.0, -9.0)];
    let triangles = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6]];
    let mesh = Mesh::new([&bar[..], &line[..]].concat(), triangles).unwrap();
    let camera = Camera::orthographic(DVec3::Z, DVec3::ZERO, None, 10.0, PAGE).unwrap();
    let adjacency = MeshAdjacency::new(&mesh);
    let edge = adjacency.edge_ids().find(|&e| adjacency.wing(e).ends() == [4, 5]).unwrap();
    let options = LineOptions { boundary: class == LineClass::Boundary, ..Default::default() };
    let contours = if class == LineClass::Contour { vec![edge] } else { vec![] };
    let segments = Segments::new(&mesh, &adjacency, &contours, &options);
    let drawing = Drawing::new(&Occluders::new(&mesh, &adjacency), &segments, &camera, params);
    let mut found = Vec::new();
    for run in drawing.layers.iter().flat_map(|layer| &layer.runs).filter(|run| run.visible) {
        let along = run.segments.iter().map(|segment| segment.edge);
        for (i, _) in along.enumerate().filter(|(_, e)| *e == Some(edge)) {
            let ends = [run.points[i], run.points[(i + 1) % run.points.len()]];
            let [a, b] = ends.map(|p| (p.x - 250.0) / 50.0);
            found.push([a.min(b), a.max(b)]);
        }
    }
    found.sort_by(|a, b| a[0].total_cmp(&b[0]));
    found
}

#[track_caller]
fn check_bar(half_width: f32, line: [f32; 2], expected: &[[f64; 2]]) {
    let found = beside_bar(half_width, line, LineClass::Contour, &EXACT);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() * 50.0 < 0.02, "{found} is not {expected}");
    }
}

#[test]
fn a_line_ends_where_a_bar_begins() {
    check_bar(0.513, [-4.0, 4.0], &[[-4.0, -0.513], [0.513, 4.0]]);
    check_bar(0.513, [-0.4, 4.0], &[[0.513, 4.0]]);
    check_bar(0.513, [-0.4, 0.4], &[]);
    check_bar(0.513, [0.6, 4.0], &[[0.6, 4.0]]);
    // Hidden for a fifth of a pixel only, nearer to its end than the first sample.
    check_bar(0.513, [0.509, 4.0], &[[0.513, 4.0]]);
    check_bar(0.513, [-4.0, -0.509], &[[-4.0, -0.513]]);
}

#[test]
fn a_hair_does_not_break_a_line() {
    let params = VisibilityParams { step: 0.1, ..Default::default() };
    for class in [LineClass::Contour, LineClass::Boundary] {
        assert_eq!(beside_bar(0.007, [-4.0, 4.0], class, &params), [[-4.0, 4.0]]);
        assert_eq!(beside_bar(0.008, [-4.0, 4.0], class, &params).len(), 2);
    }
}

#[test]
fn nothing_is_drawn_of_nothing() {
    let empty = shapes::empty();
    let camera = fitted(&empty, DVec3::ONE);
    assert_eq!(lengths(&draw(&empty, &camera, EVERYTHING, &EXACT)), [0.0, 0.0]);
    let flat = shapes::zero_area_fan();
    let camera = fitted(&flat, DVec3::ONE);
    assert_eq!(lengths(&draw(&flat, &camera, EVERYTHING, &EXACT))[1], 0.0);
}
