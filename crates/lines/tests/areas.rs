//! Tinted areas: all that is visible, nothing that is hidden, nothing twice.
#![cfg(feature = "visibility")]

use drypoint_lines::{Area, Camera, Color, Occluders, Page, Tint, tinted_areas};
use drypoint_mesh::{Mesh, MeshAdjacency, shapes};
use glam::{DVec2, DVec3, Vec3};

const PAGE: Page = Page { width: 400, height: 300, margin: 20.0 };

fn tints(count: usize) -> Vec<Tint> {
    let tint = |i: usize| Tint { name: i.to_string(), color: Color::BLACK, spread: 0.0 };
    (0..count).map(tint).collect()
}

fn look(mesh: &Mesh, camera: &Camera, count: usize, thirds: &[[usize; 3]]) -> Vec<Area> {
    let adjacency = MeshAdjacency::new(mesh);
    let occluders = Occluders::new(mesh, &adjacency);
    tinted_areas(&occluders, &adjacency, camera, &tints(count), thirds)
}

/// Square pixels, holes taken off.
fn size(area: &Area) -> f64 {
    let ring = |ring: &Vec<DVec2>| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| 0.5 * a.perp_dot(*b)).sum::<f64>()
    };
    area.rings.iter().map(ring).sum()
}

/// A square of two triangles at a height, `half` wide.
fn square(center: Vec3, half: f32) -> ([Vec3; 4], [[u32; 3]; 2]) {
    let corner = |x: f32, y: f32| center + half * Vec3::new(x, y, 0.0);
    (
        [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        [[0, 1, 2], [0, 2, 3]],
    )
}

/// Squares, each with a tint of its own.
fn squares(all: &[(Vec3, f32)]) -> (Mesh, Vec<[usize; 3]>) {
    let (mut positions, mut triangles, mut thirds) = (vec![], vec![], vec![]);
    for (tint, &(center, half)) in all.iter().enumerate() {
        let (corners, faces) = square(center, half);
        let first = u32::try_from(positions.len()).unwrap();
        positions.extend(corners);
        triangles.extend(faces.map(|face| face.map(|v| v + first)));
        thirds.extend([[tint; 3]; 2]);
    }
    (Mesh::new(positions, triangles).unwrap(), thirds)
}

/// From +Z, 100 pixels a unit.
fn from_above() -> Camera {
    Camera::orthographic(DVec3::Z, DVec3::ZERO, None, 3.0, PAGE).unwrap()
}

#[test]
fn what_is_in_front_hides_what_is_behind() {
    let (mesh, thirds) = squares(&[(Vec3::ZERO, 1.0), (Vec3::new(0.5, 0.0, 1.0), 0.5)]);
    let areas = look(&mesh, &from_above(), 2, &thirds);
    let sizes: Vec<f64> = areas.iter().map(size).collect();
    // The small one is seen whole, to the digit; the large one as exactly as its border is cut.
    assert_eq!(sizes[1], 10_000.0);
    assert!((sizes[0] - 30_000.0).abs() < 200.0, "{sizes:?}");
    assert_eq!(areas[1].rings.len(), 1);
    let below = Camera::orthographic(-DVec3::Z, DVec3::ZERO, None, 3.0, PAGE).unwrap();
    let areas = look(&mesh, &below, 2, &thirds);
    assert_eq!((areas.len(), areas[0].tint.name.as_str(), size(&areas[0])), (1, "0", 40_000.0));
}

#[test]
fn thirds_share_a_face() {
    let (mesh, _) = squares(&[(Vec3::ZERO, 1.0)]);
    let areas = look(&mesh, &from_above(), 4, &[[0, 1, 2], [2, 1, 0]]);
    let sizes: Vec<f64> = areas.iter().map(size).collect();
    // The outer sides of the lower triangle are its first two, of the upper one its last two.
    for (size, part) in sizes.iter().zip([2.0, 2.0, 2.0]) {
        assert!((size - part * 20_000.0 / 3.0).abs() < 3.0, "{sizes:?}");
    }
    assert!((sizes.iter().sum::<f64>() - 40_000.0).abs() < 1e-6);
    assert_eq!(areas.len(), 3, "a tint without a third has no area");
}

#[test]
fn off_the_page_is_nothing_and_behind_the_eye_neither() {
    let (mesh, thirds) =
        squares(&[(Vec3::new(9.0, 0.0, 0.0), 1.0), (Vec3::new(2.0, 0.0, 0.0), 0.5)]);
    let areas = look(&mesh, &from_above(), 2, &thirds);
    assert_eq!(areas.iter().map(|area| area.tint.name.as_str()).collect::<Vec<_>>(), ["1"]);

    // A floor that reaches behind the eye fills the lower half of the page.
    let (floor, thirds) = squares(&[(Vec3::ZERO, 500.0)]);
    let eye = DVec3::new(0.1, 0.2, 1.0);
    let camera = Camera::perspective(eye, eye + DVec3::Y, Some(DVec3::Z), 60.0, PAGE).unwrap();
    let areas = look(&floor, &camera, 1, &thirds);
    let on_page = areas[0].rings.iter().flatten();
    assert!(on_page.clone().all(|p| p.y > 149.0) && on_page.clone().any(|p| p.y > 299.0));
}

#[test]
fn a_solid_covers_what_its_outline_encloses() {
    let mesh = shapes::icosphere(5_000);
    let points = mesh.positions().iter().map(|p| p.as_dvec3());
    let camera = Camera::fit_perspective(points, DVec3::ONE, None, 30.0, PAGE).unwrap();
    // Tints in no order at all: areas of many holes and islands.
    let thirds: Vec<[usize; 3]> =
        (0..mesh.triangles().len()).map(|i| [i * 7 % 11, i * 5 % 11, i * 3 % 11]).collect();
    let areas = look(&mesh, &camera, 11, &thirds);
    assert_eq!(areas.len(), 11);
    let covered: f64 = areas.iter().map(size).sum();
    let disc = std::f64::consts::PI * 130.0f64.powi(2);
    assert!((covered / disc - 1.0).abs() < 0.01, "{covered}, not {disc}");
    assert_eq!(look(&mesh, &camera, 11, &thirds), areas);
}

#[test]
fn faces_without_area_are_none() {
    let mesh = shapes::zero_area_fan();
    let thirds = vec![[0; 3]; mesh.triangles().len()];
    let areas = look(&mesh, &from_above(), 1, &thirds);
    assert!(areas.iter().map(size).all(|size| size > 0.0));
}
