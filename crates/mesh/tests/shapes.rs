//! The procedural meshes have the properties that they are asked for by.

use drypoint_mesh::shapes::{self, NamedMesh};
use drypoint_mesh::{Mesh, MeshAdjacency, TopologyReport, has_area, volume_side};

fn report(mesh: &Mesh) -> TopologyReport {
    *MeshAdjacency::new(mesh).report()
}

/// V − E + F of the welded mesh; 2 − 2 · genus on a closed one.
fn euler_characteristic(report: &TopologyReport) -> isize {
    let edges = report.interior + report.boundary + report.non_manifold;
    (report.welded_vertices + report.faces - report.collapsed).cast_signed() - edges.cast_signed()
}

/// Six times the enclosed volume.
fn volume(mesh: &Mesh) -> f64 {
    let Some(bounds) = mesh.bounds() else { return 0.0 };
    let corners = |t: &[u32; 3]| t.map(|v| mesh.position(v).as_dvec3() - bounds.center());
    mesh.triangles().iter().map(corners).map(|[a, b, c]| a.dot(b.cross(c))).sum()
}

#[track_caller]
fn check_closed(name: &str, mesh: &Mesh, genus: isize) {
    let report = report(mesh);
    assert!(report.faces > 0, "{name}");
    assert_eq!(
        [report.boundary, report.non_manifold, report.inconsistent],
        [0; 3],
        "{name}: {report:?}"
    );
    assert_eq!(euler_characteristic(&report), 2 - 2 * genus, "{name}: {report:?}");
    assert!(volume(mesh) > 0.0, "{name} is inside out");
}

fn genus(name: &str) -> isize {
    match name {
        "torus-knot" => 1,
        name if name.starts_with("cad-part") => 5,
        _ => 0,
    }
}

#[test]
fn closed_shapes_are_closed_and_face_outwards() {
    for NamedMesh { name, mesh } in shapes::closed() {
        check_closed(name, &mesh, genus(name));
        let report = report(&mesh);
        assert_eq!(report.degenerate, 0, "{name}");
        assert_eq!(report.welded_vertices, report.vertices, "{name}");
    }
    for NamedMesh { name, mesh } in shapes::far_from_origin() {
        check_closed(name, &mesh, 0);
    }
    // Every count around the steps at which a shape grows.
    for triangles in (0..3000).step_by(37) {
        for name in ["icosphere", "torus-knot", "bumpy-sphere", "cad-part", "split-sphere"] {
            check_closed(name, &shapes::by_name(name, triangles).unwrap(), genus(name));
        }
    }
}

/// Whether segment p–q passes through the inside of a triangle.
fn pierces(mesh: &Mesh, [p, q]: [u32; 2], triangle: &[u32; 3]) -> bool {
    let side =
        |a, b, c, d| volume_side([a, b, c].map(|v| mesh.position(v)), mesh.position(d)) as i8;
    let [a, b, c] = *triangle;
    let [at_p, at_q] = [p, q].map(|v| side(a, b, c, v));
    if at_p * at_q != -1 {
        return false;
    }
    let turns = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    turns == [1; 3] || turns == [-1; 3]
}

#[test]
fn closed_shapes_do_not_cross_themselves() {
    for NamedMesh { name, mesh } in shapes::closed() {
        let adjacency = MeshAdjacency::new(&mesh);
        for wing in adjacency.wings() {
            let [p, q] = wing.ends().map(|v| mesh.position(v));
            let (low, high) = (p.min(q), p.max(q));
            let near = mesh.triangles().iter().filter(|t| {
                let [a, b, c] = t.map(|v| mesh.position(v));
                a.min(b).min(c).cmple(high).all() && a.max(b).max(c).cmpge(low).all()
            });
            for triangle in near {
                assert!(!pierces(&mesh, wing.ends(), triangle), "{name}: {wing:?} {triangle:?}");
            }
        }
    }
}

#[test]
fn a_crossing_would_be_seen() {
    let mesh = shapes::tetrahedron();
    let mut positions = mesh.positions().to_vec();
    positions.extend([glam::Vec3::ZERO, glam::Vec3::new(-3.0, -2.0, -2.0)]);
    let mesh = Mesh::new(positions, mesh.triangles().to_vec()).unwrap();
    let pierced = mesh.triangles().iter().filter(|t| pierces(&mesh, [4, 5], t)).count();
    assert_eq!(pierced, 1);
}

#[test]
fn the_machined_part_has_every_kind_of_edge() {
    // 92 cells with two sides each, and 152 quadrangles of wall, counted in the plan.
    let smallest = report(&shapes::cad_part(0));
    assert_eq!(smallest.faces, 672);
    for triangles in [672, 2688, 50_000] {
        let report = report(&shapes::cad_part(triangles));
        assert!(report.convex > 200 && report.concave > 70, "{report:?}");
        assert!(report.flat > report.interior / 3, "{report:?}");
    }
    let bumpy = report(&shapes::bumpy_sphere(5000));
    assert!(bumpy.convex > 2000 && bumpy.concave > 1000, "{bumpy:?}");
    assert_eq!(report(&shapes::icosphere(5000)).concave, 0);
    assert_eq!((report(&shapes::cube()).convex, report(&shapes::cube()).flat), (12, 6));
}

#[test]
fn open_shapes_have_their_boundary() {
    for NamedMesh { name, mesh } in shapes::with_boundary() {
        let report = report(&mesh);
        assert!(report.boundary > 0, "{name}");
        assert_eq!([report.non_manifold, report.degenerate], [0; 2], "{name}");
        let sides = if name == "open-cylinder" || name == "mobius-strip" { 0 } else { 1 };
        assert_eq!(euler_characteristic(&report), sides, "{name}: {report:?}");
        assert_eq!(report.inconsistent > 0, name == "mobius-strip", "{name}");
    }
    assert_eq!(report(&shapes::one_triangle()).boundary, 3);
    assert_eq!(report(&shapes::mobius_strip(0)).inconsistent, 1);
    assert_eq!(report(&shapes::empty()), TopologyReport::default());
}

#[test]
fn dirty_shapes_are_as_dirty_as_they_say() {
    let shared = report(&shapes::cubes_sharing_an_edge());
    assert_eq!((shared.non_manifold, shared.interior, shared.vertices), (1, 34, 14));
    for pages in [0, 1, 2, 3, 40] {
        let book = report(&shapes::book(pages));
        assert_eq!(book.non_manifold, usize::from(pages > 2));
        assert_eq!(book.interior, usize::from(pages == 2));
        assert_eq!(book.boundary, 2 * pages + usize::from(pages == 1));
    }
    for NamedMesh { name, mesh } in shapes::non_manifold() {
        assert!(report(&mesh).non_manifold > 0, "{name}");
    }
    for NamedMesh { name, mesh } in shapes::inconsistent() {
        assert!(report(&mesh).inconsistent > 0, "{name}");
    }
    for NamedMesh { name, mesh } in shapes::duplicate_vertices() {
        let report = report(&mesh);
        assert!(report.welded_vertices < report.vertices, "{name}");
    }
    // No two of the turned triangles of this size are neighbours.
    assert_eq!(report(&shapes::flipped_sphere(20)).inconsistent, 9);
    assert_eq!(report(&shapes::folded_sheet()).flat, 3);
    assert_eq!(report(&shapes::zero_area_fan()).degenerate, 8);
    let sliver = shapes::sliver_sphere(1000);
    check_closed("sliver-sphere", &sliver, 0);
    let report = report(&sliver);
    let [ninth, all] = [report.collapsed / 3, report.degenerate];
    assert!(ninth > 50 && all > report.collapsed, "{report:?}");
    let collinear = |t: &&[u32; 3]| !has_area(t.map(|v| sliver.position(v)));
    assert_eq!(sliver.triangles().iter().filter(collinear).count(), all);
}

#[test]
fn what_exports_leave_behind_is_there() {
    let far = report(&shapes::far_sphere(1280));
    assert!(
        far.collapsed > 20 && far.degenerate > far.collapsed && far.non_manifold > 0,
        "{far:?}"
    );
    let littered = report(&shapes::littered_sphere(320));
    let used: std::collections::BTreeSet<_> =
        shapes::littered_sphere(320).triangles().iter().flatten().copied().collect();
    assert!(used.len() * 4 < littered.vertices * 3, "{littered:?}");
    assert!(littered.welded_vertices < littered.vertices, "{littered:?}");
    assert_eq!((littered.interior, littered.boundary, littered.non_manifold), (480, 0, 0));
    let junctions = report(&shapes::t_junctions(84));
    assert_eq!((junctions.faces, junctions.inconsistent, junctions.degenerate), (84, 0, 0));
    assert_eq!(junctions.boundary, 2 * 4 * (1 + 2 + 4), "{junctions:?}");
    assert!((volume(&shapes::t_junctions(84)) - 6.0 * 8.0).abs() < 1e-9);
    check_closed("flipped-shells", &shapes::flipped_shells(240), -2);
    check_closed("sliver-fan", &shapes::sliver_fan(500), 0);
    let thicket = report(&shapes::zero_area_thicket(1200));
    assert!(thicket.degenerate >= 1200 && thicket.faces == thicket.degenerate + 4, "{thicket:?}");
    let stack = report(&shapes::stack(20));
    assert_eq!((stack.non_manifold, stack.faces, stack.degenerate), (3, 20, 0));
    check_closed("mixed-units", &shapes::mixed_units(240), -2);
}

#[test]
fn shapes_come_near_to_the_count_and_are_the_same_every_time() {
    for &name in shapes::NAMES {
        let count = |wish| shapes::by_name(name, wish).unwrap().triangles().len();
        let sized = count(100_000) > 100;
        // The machined part grows in steps of its plan.
        for wish in [5_000, 100_000] {
            let off = count(wish).abs_diff(wish);
            assert!(!sized || off * 10 <= wish, "{name} {wish}: off by {off}");
        }
        let off = count(100_000).abs_diff(100_000);
        assert!(!sized || off * 50 <= 100_000, "{name}: off by {off}");
        assert_eq!(shapes::by_name(name, 777), shapes::by_name(name, 777));
    }
    assert_eq!(shapes::by_name("dodecahedron", 12), None);
    assert_eq!(shapes::icosphere(0).triangles().len(), 20);
    assert_eq!(shapes::icosphere(60).triangles().len(), 80);
    assert_eq!(shapes::icosphere(40).triangles().len(), 20);
}

#[test]
fn all_shapes_are_small_and_have_names_of_their_own() {
    let all = shapes::all();
    let mut names: Vec<_> = all.iter().map(|shape| shape.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all.len());
    assert!(all.iter().all(|shape| shape.mesh.triangles().len() <= 5000));
    let extent =
        |mesh: &Mesh| mesh.positions().iter().map(|p| p.abs().max_element()).fold(0.0, f32::max);
    let sizes = shapes::far_from_origin().into_iter().map(|shape| extent(&shape.mesh));
    let sizes = sizes.map(|size| size.log10().floor()).collect::<Vec<_>>();
    assert_eq!(sizes, [4.0, -20.0, 20.0, -30.0, 30.0]);
}
