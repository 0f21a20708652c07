//! What lines belong to, and what an SVG says of it.
#![cfg(all(feature = "visibility", feature = "svg"))]

use std::cmp::Ordering;
use std::collections::BTreeSet;

use drypoint_lines::{
    Camera, Drawing, FaceNames, HiddenLines, Intersections, LineClass, LineOptions, Occluders,
    Page, Segments, Style, VisibilityParams, to_svg,
};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, contour_edges, face_side, shapes};
use glam::{DVec3, Vec3};

const PAGE: Page = Page { width: 500, height: 500, margin: 20.0 };

/// Nothing dropped, so that lengths add up.
const EXACT: VisibilityParams =
    VisibilityParams { step: 1.0, precision: 0.005, close_gaps: 0.0, drop_specks: 0.0 };

/// Every class of lines of a mesh.
fn draw(mesh: &Mesh, materials: &FaceNames) -> (Drawing, Camera) {
    let points = mesh.positions().iter().map(|p| p.as_dvec3());
    let towards_viewer = DVec3::new(0.4, 0.7, 0.9);
    let camera = Camera::fit_perspective(points, towards_viewer, None, 40.0, PAGE).unwrap();
    let adjacency = MeshAdjacency::new(mesh);
    let intersections = Intersections::new(mesh, &adjacency);
    let mut contours = Vec::new();
    contour_edges(mesh, &adjacency, camera.viewpoint(), EdgeFilter::All, &mut contours);
    let options = LineOptions {
        boundary: true,
        crease_angle: Some(0.5),
        materials: Some(materials),
        intersections: Some(&intersections),
    };
    let segments = Segments::new(mesh, &adjacency, &contours, &options);
    (Drawing::new(&Occluders::new(mesh, &adjacency), &segments, &camera, &EXACT), camera)
}

/// Two balls that pass through each other, one of them red above and blue below.
fn balls() -> (Mesh, [FaceNames; 2]) {
    let ball = shapes::icosphere(1280);
    let count = u32::try_from(ball.triangles().len()).unwrap();
    let vertices = u32::try_from(ball.positions().len()).unwrap();
    let beside = ball.positions().iter().map(|&p| p + Vec3::new(1.1, 0.2, 0.0));
    let positions = ball.positions().iter().copied().chain(beside).collect();
    let turned = ball.triangles().iter().map(|t| t.map(|v| vertices + v));
    let triangles = ball.triangles().iter().copied().chain(turned).collect();
    let is_above = |face: u32| ball.corners(face).iter().map(|p| p.y).sum::<f32>() > 0.0;
    let colors = (0..count).map(|f| (if is_above(f) { "red" } else { "blue" }, f..f + 1));
    let names =
        [FaceNames::new([("left", 0..count), ("right", count..2 * count)]), FaceNames::new(colors)];
    (Mesh::new(positions, triangles).unwrap(), names)
}

#[test]
fn each_run_belongs_to_one_part_and_one_material() {
    let (mesh, [parts, materials]) = balls();
    let (plain, camera) = draw(&mesh, &materials);
    let mut drawing = plain.clone();
    drawing.label(&mesh, camera.viewpoint(), &parts, &materials);
    let is_front = |face: u32| face_side(mesh.corners(face), camera.viewpoint()) != Ordering::Less;
    for (layer, before) in drawing.layers.iter().zip(&plain.layers) {
        let lengths = [layer.visible_length(), layer.hidden_length()];
        for (found, expected) in
            lengths.into_iter().zip([before.visible_length(), before.hidden_length()])
        {
            assert!((found - expected).abs() < 1e-9 * expected.max(1.0), "cutting loses line");
        }
        for run in &layer.runs {
            let label = drawing.label_of(run).unwrap();
            assert_eq!(run.points.len(), run.segments.len() + usize::from(!run.closed));
            for segment in &run.segments {
                let [a, b] = segment.faces;
                let face = if !is_front(a) && is_front(b) { b } else { a };
                assert_eq!(label.part, parts.names()[parts.of(face)]);
                assert_eq!(label.material, materials.names()[materials.of(face)]);
            }
        }
    }
    // The right ball has no material, and where it meets the left one the line is of that.
    let of = |class: LineClass| -> BTreeSet<[&str; 2]> {
        let layer = drawing.layers.iter().find(|layer| layer.class == class).unwrap();
        let labels = layer.runs.iter().map(|run| drawing.label_of(run).unwrap());
        labels.map(|label| [&label.part[..], &label.material]).collect()
    };
    let left = [["left", "blue"], ["left", "red"]];
    assert_eq!(
        of(LineClass::Contour),
        [&left[..], &[["right", ""]]].concat().into_iter().collect()
    );
    assert_eq!(of(LineClass::Intersection), left.into_iter().collect());
    let around = |class: LineClass| plain.layers.iter().find(|l| l.class == class).unwrap().chains;
    assert_eq!((around(LineClass::Intersection), around(LineClass::Material)), (1, 1));
}

#[test]
fn a_ring_of_two_parts_is_cut_in_two() {
    let (ball, [_, halves]) = balls();
    let half = ball.triangles().len() / 2;
    let ball = Mesh::new(ball.positions().to_vec(), ball.triangles()[..half].to_vec()).unwrap();
    let adjacency = MeshAdjacency::new(&ball);
    let points = ball.positions().iter().map(|p| p.as_dvec3());
    let camera = Camera::fit_orthographic(points, DVec3::Z, None, PAGE).unwrap();
    let mut contours = Vec::new();
    contour_edges(&ball, &adjacency, camera.viewpoint(), EdgeFilter::All, &mut contours);
    let segments = Segments::new(&ball, &adjacency, &contours, &LineOptions::default());
    let mut drawing = Drawing::through_glass(&ball, &segments, &camera);
    let ring = drawing.layers[0].runs.clone();
    assert!(ring.len() == 1 && ring[0].closed);
    drawing.label(&ball, camera.viewpoint(), &halves, &FaceNames::default());
    let runs = &drawing.layers[0].runs;
    assert!(runs.len() == 2 && runs.iter().all(|run| !run.closed));
    assert_ne!(runs[0].label, runs[1].label);
    assert_eq!(runs[0].points.last(), runs[1].points.first());
    assert_eq!(runs[1].points.last(), runs[0].points.first());
    // One label leaves it as it is.
    drawing.layers[0].runs = ring;
    drawing.label(&ball, camera.viewpoint(), &FaceNames::default(), &FaceNames::default());
    assert!(drawing.layers[0].runs.len() == 1 && drawing.layers[0].runs[0].closed);
}

#[test]
fn an_svg_names_what_lines_belong_to() {
    let (mesh, [_, materials]) = balls();
    let half = u32::try_from(mesh.triangles().len() / 2).unwrap();
    let awkward = "a \"b\" & 'c' <d>\u{1}\n";
    let parts = FaceNames::new([("", 0..half), (awkward, half..2 * half)]);
    let (mut drawing, camera) = draw(&mesh, &materials);
    let style = Style { hidden: HiddenLines::Dashed, ..Style::default() };
    let plain = to_svg(&drawing, &style, "balls");
    assert!(!plain.contains("data-part") && !plain.contains("data-material"));
    drawing.label(&mesh, camera.viewpoint(), &parts, &materials);
    let svg = to_svg(&drawing, &style, "balls");
    let document = roxmltree::Document::parse(&svg).unwrap();
    let paths: Vec<_> = document.descendants().filter(|node| node.has_tag_name("path")).collect();
    assert!(paths.len() > 10);
    let found = |name| -> BTreeSet<Option<&str>> {
        paths.iter().map(|path| path.attribute(name)).collect()
    };
    assert_eq!(found("data-part"), [None, Some("a \"b\" & 'c' <d>")].into());
    assert_eq!(found("data-material"), [None, Some("blue"), Some("red")].into());
    for path in &paths {
        let group = path.parent().unwrap().attribute("class").unwrap();
        let crosses = group.starts_with("intersection");
        assert_eq!(path.has_attribute("data-faces"), crosses);
        assert_eq!(path.has_attribute("data-edges"), !crosses);
        for pair in path.attribute("data-faces").into_iter().flat_map(|text| text.split(' ')) {
            let (low, high) = pair.split_once(',').unwrap();
            let [low, high] = [low, high].map(|face| face.parse::<u32>().unwrap());
            assert!(low < half && (half..2 * half).contains(&high), "{pair}");
        }
    }
}
