//! Rigs made by hand, on which nothing is rounded: every answer is the definition's, to the last tie.

use drypoint_mesh::rig::{Influence, Offset, Pose, Rig, RigBuilder, Skin};
use drypoint_mesh::{EdgeFilter, EdgeId, Viewpoint, contour_edges, shapes};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use proptest::prelude::*;

/// Contours of a rig are those of the surface that it shows, by brute force.
#[track_caller]
fn check(rig: &Rig, skin: &Skin, pose: &Pose, viewpoint: Viewpoint) {
    let mesh = rig.mesh(pose).unwrap();
    let adjacency = rig.adjacency(&mesh);
    let [mut found, mut expected] = [(); 2].map(|()| Vec::new());
    skin.contour_edges(rig, pose, viewpoint, EdgeFilter::All, &mut found);
    contour_edges(&mesh, &adjacency, viewpoint, EdgeFilter::All, &mut expected);
    let mut found: Vec<_> = found.iter().map(|&e| skin.adjacency().wing(e).ends()).collect();
    let mut expected: Vec<_> = expected.iter().map(|&e| adjacency.wing(e).ends()).collect();
    found.sort_unstable();
    expected.sort_unstable();
    assert_eq!(found, expected, "from {viewpoint:?}");
}

fn follows(carrier: u32, weight: f64, position: Vec3) -> Influence {
    Influence { carrier, weight, position }
}

/// Several places of one mesh.
fn placed(mesh: &drypoint_mesh::Mesh, places: u32) -> Rig {
    let mut builder = RigBuilder::default();
    for place in 0..places {
        let carrier = builder.carrier(None, Some(place));
        let vertices: Vec<u32> = mesh
            .positions()
            .iter()
            .map(|&position| builder.vertex(&[follows(carrier, 1.0, position)], &[]))
            .collect();
        for triangle in mesh.triangles() {
            builder.triangle(triangle.map(|vertex| vertices[vertex as usize]));
        }
    }
    builder.finish()
}

#[test]
fn parts_of_one_shape_share_it() {
    let mesh = shapes::icosphere(300);
    let rig = placed(&mesh, 5);
    let skin = Skin::new(&rig).unwrap();
    assert_eq!((skin.parts().len(), skin.shapes().len()), (5, 1));
    assert_eq!((skin.loose().len(), skin.rigid_share()), (0, 1.0));
    let edges = skin.shapes()[0].edges(EdgeFilter::All).count();
    let mut of_parts: Vec<EdgeId> = skin
        .parts()
        .iter()
        .flat_map(|part| skin.shapes()[0].edges(EdgeFilter::All).map(|e| part.edge_in_rig(e)))
        .collect();
    of_parts.sort_unstable();
    of_parts.dedup();
    assert_eq!(of_parts.len(), 5 * edges);
    assert_eq!(of_parts, skin.edges(EdgeFilter::All).collect::<Vec<_>>());
}

#[test]
fn mirrored_places_keep_their_outside_outside() {
    let mesh = shapes::cube();
    let rig = placed(&mesh, 3);
    let skin = Skin::new(&rig).unwrap();
    let mut pose = rig.rest();
    pose.to_scene[1] = DAffine3::from_translation(DVec3::new(4.0, 0.0, 0.0))
        * DAffine3::from_scale(DVec3::new(-1.0, 2.0, 1.0));
    pose.to_scene[2] = DAffine3::from_translation(DVec3::new(0.0, 8.0, 0.0))
        * DAffine3::from_scale(DVec3::new(-1.0, -1.0, -0.5));
    assert_eq!(rig.mirrored(&pose), [false, true, true]);
    let posed = rig.mesh(&pose).unwrap();
    for place in posed.triangles().chunks(mesh.triangles().len()) {
        let volume = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| posed.position(v).as_dvec3());
            a.dot(b.cross(c))
        };
        assert!(place.iter().map(volume).sum::<f64>() > 0.0, "outward");
    }
    // In planes of faces too, where ties are decided.
    for x in -6..=6 {
        for y in [-7.0, -1.0, 0.0, 1.0, 2.0, 9.0] {
            let point = DVec3::new(f64::from(x), y, 5.0);
            check(&rig, &skin, &pose, Viewpoint::at(point));
            check(&rig, &skin, &pose, Viewpoint::from_direction(point));
        }
    }
}

#[test]
fn a_flattened_part_is_decided_where_it_lies() {
    let rig = placed(&shapes::icosphere(80), 2);
    let skin = Skin::new(&rig).unwrap();
    let mut pose = rig.rest();
    for scale in [DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.0, 0.0, 1.0), DVec3::ZERO] {
        pose.to_scene[0] = DAffine3::from_scale(scale);
        check(&rig, &skin, &pose, Viewpoint::at(DVec3::new(3.0, 4.0, 5.0)));
        check(&rig, &skin, &pose, Viewpoint::from_direction(DVec3::Y));
    }
}

#[test]
fn edges_of_several_parts_and_of_bending_faces_are_loose() {
    // Two triangles of one part, one of another and one that bends, in a strip.
    let mut builder = RigBuilder::default();
    let [a, b] = [None, Some(0)].map(|mesh| builder.carrier(None, mesh));
    let morph = builder.morph(0, 0.0);
    let at = |x: u8, y: u8| Vec3::new(f32::from(x), f32::from(y), 0.0);
    let rigid =
        |builder: &mut RigBuilder, position| builder.vertex(&[follows(a, 1.0, position)], &[]);
    let low: Vec<u32> = (0..3).map(|x| rigid(&mut builder, at(x, 0))).collect();
    let high: Vec<u32> = (0..2).map(|x| rigid(&mut builder, at(x, 1))).collect();
    let blended = builder.vertex(&[follows(a, 0.5, at(2, 1)), follows(b, 0.5, at(2, 1))], &[]);
    let by = Offset { morph, influence: 0, by: Vec3::Z };
    let morphed = builder.vertex(&[follows(a, 1.0, at(3, 0))], &[by]);
    builder.triangle([low[0], low[1], high[0]]);
    builder.triangle([low[1], high[1], high[0]]);
    builder.triangle([low[1], low[2], high[1]]);
    builder.triangle([low[2], blended, high[1]]);
    builder.triangle([low[2], morphed, blended]);
    let rig = builder.finish();
    let skin = Skin::new(&rig).unwrap();
    assert_eq!(skin.parts().len(), 1);
    let rigid: Vec<bool> = (0..5).map(|face| skin.part_of_face(face).is_some()).collect();
    assert_eq!(rigid, [true, true, true, false, false]);
    // The edges within the first three faces; those at the fourth, and beyond it.
    assert_eq!((skin.shapes()[0].edges(EdgeFilter::All).count(), skin.loose().len()), (2, 2));
    assert_eq!(skin.rigid_share(), 0.5);
    let kept = |filter| skin.edges(filter).count();
    assert_eq!((kept(EdgeFilter::All), kept(EdgeFilter::Convex)), (4, 2), "flat ones are not kept");
}

#[test]
fn an_edge_where_a_third_part_meets_is_loose() {
    // Two faces of one part make a concave edge, which Convex would drop, and a third of another part
    // makes it one that is never dropped.
    let mut builder = RigBuilder::default();
    let [a, b] = [None, Some(0)].map(|mesh| builder.carrier(None, mesh));
    let ends = [Vec3::ZERO, Vec3::X]
        .map(|p| builder.vertex(&[follows(a, 0.5, p), follows(b, 0.5, p)], &[]));
    let wings = [(a, Vec3::new(0.0, 1.0, 1.0)), (a, Vec3::new(0.0, -1.0, 1.0)), (b, Vec3::Y)]
        .map(|(carrier, p)| builder.vertex(&[follows(carrier, 1.0, p)], &[]));
    builder.triangle([ends[0], ends[1], wings[0]]);
    builder.triangle([ends[1], ends[0], wings[1]]);
    builder.triangle([ends[0], ends[1], wings[2]]);
    let rig = builder.finish();
    let skin = Skin::new(&rig).unwrap();
    assert_eq!((skin.parts().len(), skin.loose().len()), (0, 3), "one wing per pair of faces");
}

/// A transform without rounding: axes exchanged and turned, scaled by powers of two or to nothing.
fn exact_transform() -> impl Strategy<Value = DAffine3> {
    let axes = prop::sample::select(vec![[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 0, 2], [0, 2, 1]]);
    let scale = prop::sample::select(vec![1.0, -1.0, 2.0, -0.5, 4.0, 1.0, 2.0, 0.0]);
    let scales = [scale.clone(), scale.clone(), scale];
    let moves = [-4i8..4, -4..4, -4..4];
    (axes, scales, moves).prop_map(|(axes, scales, moves)| {
        let unit = [DVec3::X, DVec3::Y, DVec3::Z];
        let columns: [DVec3; 3] = std::array::from_fn(|i| scales[i] * unit[axes[i]]);
        DAffine3 {
            matrix3: DMat3::from_cols_array_2d(&columns.map(|c| c.to_array())),
            translation: DVec3::from_array(moves.map(f64::from)),
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Any triangles on vertices that follow any of three carriers, alone or by halves.
    #[test]
    fn contours_are_those_of_the_posed_mesh(
        vertices in prop::collection::vec(
            ([-3i8..4, -3..4, -3..4], 0u32..3, 0u32..6, [-1i8..2, 0..1, 0..2]), 4..14),
        triangles in prop::collection::vec([0usize..14, 0..14, 0..14], 1..30),
        transforms in prop::collection::vec(exact_transform(), 3),
        viewpoint in ([-5i8..6, -5..6, -5..6], any::<bool>()),
    ) {
        let whole = |p: [i8; 3]| Vec3::from_array(p.map(f32::from));
        let mut builder = RigBuilder::default();
        let carriers = [0, 1, 2].map(|mesh| builder.carrier(None, Some(mesh)));
        let morph = builder.morph(0, 0.0);
        let vertices: Vec<u32> = vertices.into_iter().map(|(position, first, second, by)| {
            let (position, by) = (whole(position), whole(by));
            let first = carriers[first as usize];
            match carriers.get(second as usize) {
                Some(&second) if second != first => {
                    let halves = [first, second].map(|c| follows(c, 0.5, 2.0 * position));
                    builder.vertex(&halves, &[Offset { morph, influence: 1, by: 2.0 * by }])
                }
                _ => builder.vertex(&[follows(first, 1.0, position)], &[]),
            }
        }).collect();
        for triangle in triangles {
            builder.triangle(triangle.map(|vertex| vertices[vertex % vertices.len()]));
        }
        let rig = builder.finish();
        let skin = Skin::new(&rig).unwrap();
        let pose = Pose { to_scene: transforms, weights: vec![1.0] };
        let (at, is_point) = viewpoint;
        let at = whole(at).as_dvec3();
        let viewpoint =
            if is_point { Viewpoint::at(at) } else { Viewpoint::from_direction(at) };
        check(&rig, &skin, &pose, viewpoint);
    }
}
