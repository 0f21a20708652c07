//! What of a glTF file can move.

use drypoint_mesh::io::{Format, parse};
use drypoint_mesh::rig::Rig;
use glam::DVec3;

use crate::files::{CORNERS, Gltf};

/// The rig of a document; its rest is the mesh.
#[track_caller]
fn rig(bytes: &[u8]) -> Rig {
    let model = parse(Format::Gltf, bytes).unwrap_or_else(|error| panic!("{error}"));
    let rig = model.rig.expect("something moves");
    assert_eq!(model.rig_vertices.len(), rig.vertex_count());
    let rest = rig.mesh(&rig.rest()).unwrap();
    assert_eq!(rest.triangles().len(), model.mesh.triangles().len());
    for (a, b) in rest.triangles().iter().zip(model.mesh.triangles()) {
        assert_eq!(a.map(|vertex| model.rig_vertices[vertex as usize]), *b);
        assert_eq!(a.map(|v| rest.position(v)), b.map(|v| model.mesh.position(v)));
    }
    rig
}

/// Where the corner (1, 0, 0) is at a time of the first animation.
#[track_caller]
fn check(rig: &Rig, seconds: f64, expected: [f64; 3]) {
    let found = rig.position(1, &rig.pose_at(0, seconds));
    assert!(found.distance(DVec3::from_array(expected)) < 1e-6, "at {seconds}: {found}");
}

/// A triangle at a node, with an animation of one channel.
fn animated(path: &str, interpolation: &str, times: &[f32], values: (&[f32], &str)) -> Vec<u8> {
    let mut gltf = Gltf::default();
    gltf.floats(&CORNERS, "VEC3");
    gltf.floats(times, "SCALAR");
    gltf.floats(values.0, values.1);
    gltf.glb(&format!(
        r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "nodes": [{{"mesh": 0, "translation": [0, 0, 1]}}], "animations": [{{"name": "go",
            "samplers": [{{"input": 1, "output": 2, "interpolation": "{interpolation}"}}],
            "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "{path}"}}}}]}}]"#
    ))
}

#[test]
fn nothing_moves_in_a_still_scene() {
    let mut gltf = Gltf::default();
    gltf.floats(&CORNERS, "VEC3");
    let rest = r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0, "children": [1]}, {}]"#;
    let model = parse(Format::Gltf, &gltf.glb(rest)).unwrap();
    assert_eq!((model.rig, model.rig_vertices), (None, vec![]));
}

#[test]
fn nodes_move_by_steps_lines_and_splines() {
    let (times, values) = ([1.0, 3.0], [1.0, 0.0, 0.0, 5.0, 0.0, 8.0]);
    let step = rig(&animated("translation", "STEP", &times, (&values, "VEC3")));
    assert_eq!((step.animations()[0].name.as_str(), step.animations()[0].duration()), ("go", 3.0));
    check(&step, 0.0, [2.0, 0.0, 0.0]);
    check(&step, 2.9, [2.0, 0.0, 0.0]);
    check(&step, 3.0, [6.0, 0.0, 8.0]);
    let linear = rig(&animated("translation", "LINEAR", &times, (&values, "VEC3")));
    check(&linear, 1.5, [3.0, 0.0, 2.0]);
    check(&linear, 9.0, [6.0, 0.0, 8.0]);
    // In-tangent, value, out-tangent: from rest to rest.
    let keys = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3], [0.0; 3], [5.0, 0.0, 8.0], [0.0; 3]].concat();
    let spline = rig(&animated("translation", "CUBICSPLINE", &times, (&keys, "VEC3")));
    check(&spline, 1.5, [1.0 + 1.0 + 4.0 * 0.156_25, 0.0, 8.0 * 0.156_25]);
    check(&spline, 2.0, [4.0, 0.0, 4.0]);
    // A quarter turn about z, half of it.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turns = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half];
    let turning = rig(&animated("rotation", "LINEAR", &times, (&turns, "VEC4")));
    check(&turning, 2.0, [f64::from(half), f64::from(half), 1.0]);
    let growing = rig(&animated("scale", "LINEAR", &times, (&values, "VEC3")));
    check(&growing, 3.0, [5.0, 0.0, 1.0]);
}

#[test]
fn a_node_that_is_a_matrix_moves_as_well() {
    let mut gltf = Gltf::default();
    gltf.floats(&CORNERS, "VEC3");
    gltf.floats(&[0.0], "SCALAR");
    gltf.floats(&[0.0, 7.0, 0.0], "VEC3");
    let bytes = gltf.glb(
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0, "matrix": [2,0,0,0, 0,2,0,0, 0,0,2,0, 5,5,5,1]}], "animations": [{
            "samplers": [{"input": 1, "output": 2}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]"#,
    );
    let rig = rig(&bytes);
    assert_eq!(rig.animations()[0].name, "animation 0");
    check(&rig, 0.0, [2.0, 7.0, 0.0]);
}

#[test]
fn morph_targets_displace_by_weights() {
    for (rest, at_rest) in [("", 0.0), (r#", "weights": [0.25]"#, 0.25)] {
        let mut gltf = Gltf::default();
        gltf.floats(&CORNERS, "VEC3");
        gltf.floats(&[0.0, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0], "VEC3");
        gltf.floats(&[0.0, 1.0], "SCALAR");
        gltf.floats(&[1.0, 3.0], "SCALAR");
        let bytes = gltf.glb(&format!(
            r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}},
                "targets": [{{"POSITION": 1}}]}}]{rest}}}],
            "nodes": [{{"mesh": 0, "scale": [1, 1, -1]}}], "animations": [{{
                "samplers": [{{"input": 2, "output": 3}}],
                "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "weights"}}}}]}}]"#
        ));
        let rig = rig(&bytes);
        assert_eq!(rig.position(1, &rig.rest()), DVec3::new(1.0, 0.0, -4.0 * at_rest));
        check(&rig, 0.5, [1.0, 0.0, -8.0]);
        // The two others follow the node alone.
        let rigid: Vec<bool> = (0..3).map(|v| rig.rigid_carrier(v).is_some()).collect();
        assert_eq!(rigid, [true, false, true]);
    }
}

#[test]
fn places_of_one_mesh_are_apart_and_carried() {
    let mut gltf = Gltf::default();
    gltf.floats(&CORNERS, "VEC3");
    let bytes = gltf.glb(
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]},
            {"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}, {"mesh": 0, "scale": [-1, 1, 1], "children": [2]}, {"mesh": 1}]"#,
    );
    let rig = rig(&bytes);
    let carriers: Vec<_> = rig.carriers().iter().map(|c| (c.node, c.mesh)).collect();
    // What hangs from a place, and is placed once, goes with it and is no part of the repeated mesh.
    assert_eq!(carriers, [(Some(0), Some(0)), (Some(1), Some(0)), (Some(1), None)]);
    assert_eq!(rig.vertex_count(), 9);
    let moves: Vec<bool> = rig.nodes().iter().map(|node| node.moves).collect();
    assert_eq!(moves, [true, true, false]);
}

#[test]
fn keys_that_make_no_curve_are_refused() {
    let check = |times: &[f32], values: &[f32], message: &str| {
        let bytes = animated("translation", "LINEAR", times, (values, "VEC3"));
        let error = parse(Format::Gltf, &bytes).unwrap_err().to_string();
        assert_eq!(error, format!("animations[0].samplers[0]: {message}"));
    };
    check(&[0.0, 1.0], &[0.0; 3], "has 3 numbers where its keys need 6");
    check(
        &[1.0, 0.0],
        &[0.0; 6],
        "has a key 1 that is before the one before it, or at no finite time",
    );
    check(&[0.0], &[0.0, f32::NAN, 0.0], "has a number 1 that is not finite");
}

#[test]
fn channels_that_move_no_node_are_passed_over() {
    let document = |target: &str, node: &str| {
        let mut gltf = Gltf::default();
        gltf.floats(&CORNERS, "VEC3");
        gltf.floats(&[0.0], "SCALAR");
        gltf.floats(&[0.0, 7.0, 0.0], "VEC3");
        gltf.glb(&format!(
            r#""extensionsUsed": ["KHR_animation_pointer"],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "nodes": [{{"mesh": {node}}}], "animations": [{{
                "samplers": [{{"input": 1, "output": 2}}],
                "channels": [{{"sampler": 0, "target": {{{target}}}}},
                    {{"sampler": 0, "target": {{"node": 0, "path": "translation"}}}}]}}]"#
        ))
    };
    let pointer = r#""path": "pointer", "extensions": {"KHR_animation_pointer":
        {"pointer": "/materials/0/alphaCutoff"}}"#;
    for target in [pointer, r#""path": "rotation""#] {
        let rig = rig(&document(target, "0"));
        assert_eq!(rig.animations()[0].channels.len(), 1);
        check(&rig, 0.0, [1.0, 7.0, 0.0]);
        // What else is wrong is still told.
        let error = parse(Format::Gltf, &document(target, "true")).unwrap_err().to_string();
        assert!(error.contains("invalid type: boolean"), "{error}");
    }
}

#[test]
fn what_follows_joints_by_no_number_is_nowhere() {
    for (weight, dropped) in [(f32::NAN, 1), (f32::INFINITY, 1), (0.0, 0)] {
        let mut gltf = Gltf::default();
        gltf.floats(&[&CORNERS[..], &[0.0, 0.0, 1.0]].concat(), "VEC3");
        gltf.data(&[0; 16], 4, r#""componentType": 5121, "type": "VEC4""#);
        let one = [1.0, 0.0, 0.0, 0.0];
        gltf.floats(&[one, one, one, [weight, 0.0, 0.0, 0.0]].concat(), "VEC4");
        gltf.shorts(&[0, 1, 2, 0, 1, 3]);
        let bytes = gltf.glb(
            r#""meshes": [{"primitives": [{"attributes":
                {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}, "indices": 3}]}],
            "nodes": [{"mesh": 0, "skin": 0}, {}], "skins": [{"joints": [1]}]"#,
        );
        let model = parse(Format::Gltf, &bytes).unwrap();
        assert_eq!((model.dropped.vertices, model.dropped.faces), (dropped, dropped), "{weight}");
    }
}

#[test]
fn weights_leave_a_sheared_node_as_it_is() {
    let mut gltf = Gltf::default();
    gltf.floats(&CORNERS, "VEC3");
    gltf.floats(&[0.0], "SCALAR");
    gltf.floats(&[1.0], "SCALAR");
    let bytes = gltf.glb(
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{}]}]}, {
            "primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0, "matrix": [1,0,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1], "children": [1]},
            {"mesh": 1, "rotation": [0, 0, 0, 1]}], "animations": [{"samplers": [
            {"input": 1, "output": 2}], "channels": [
            {"sampler": 0, "target": {"node": 0, "path": "weights"}}]}]"#,
    );
    let rig = rig(&bytes);
    assert!(matches!(rig.nodes()[0].rest, drypoint_mesh::rig::Local::Matrix(_)));
    assert_eq!(rig.position(2, &rig.pose_at(0, 0.0)), DVec3::new(1.0, 1.0, 0.0));
}
