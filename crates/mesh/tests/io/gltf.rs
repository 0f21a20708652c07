//! What is read from glTF and GLB.

use drypoint_mesh::io::{Format, parse, parse_in};

use crate::files::{CORNERS, Gltf, check, check_parts, one_triangle};

const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

#[test]
fn meshes_are_placed_and_welded() {
    // The second node doubles, turns by 180° about z and moves; the third mirrors.
    let nodes = r#"[{"name": "whole", "mesh": 0, "children": [1]},
        {"mesh": 0, "translation": [1, 0, 0], "rotation": [0, 0, 1, 0], "scale": [2, 2, 2]},
        {"mesh": 0, "matrix": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]"#;
    let [a, b, c] = TRIANGLE;
    let (d, e) = ([-1.0, 0.0, 0.0], [1.0, -2.0, 0.0]);
    let triangles = [[0, 1, 2], [1, 3, 4], [0, 2, 3]];
    for scenes in [
        r#", "scene": 0, "scenes": [{"nodes": [0, 2]}]"#,
        // No default scene: all of them. No scene: all nodes.
        r#", "scenes": [{"nodes": [0]}, {"nodes": [2, 0]}]"#,
        "",
    ] {
        let bytes = one_triangle(nodes, scenes);
        let model = check(Format::Gltf, &bytes, &[a, b, c, d, e], &triangles);
        check_parts(&model, &[("whole", 0..1), ("tri", 1..3)]);
    }
    let last = one_triangle(nodes, r#", "scene": 1, "scenes": [{"nodes": [0]}, {"nodes": [2]}]"#);
    check(Format::Gltf, &last, &[a, d, c], &[[0, 2, 1]]);
}

#[test]
fn a_child_moves_with_its_parent() {
    let nodes = r#"[{"mesh": 0, "translation": [1, 0, 0]},
        {"scale": [2, 2, 2], "children": [2]}, {"translation": [0, 0, 3], "children": [0]}]"#;
    let moved = TRIANGLE.map(|[x, y, _]| [2.0 * (x + 1.0), 2.0 * y, 6.0]);
    check(Format::Gltf, &one_triangle(nodes, ""), &moved, &[[0, 1, 2]]);
}

#[test]
fn primitives_are_lists_strips_and_fans_or_left_out() {
    let mut gltf = Gltf::default();
    let square = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let positions = gltf.floats(&square, "VEC3");
    let plain = gltf.shorts(&[2, 3, 0]);
    let strip = gltf.data(&[0, 1, 3, 2, 2, 2], 6, r#""componentType": 5121, "type": "SCALAR""#);
    let wide: Vec<u8> = [3u32, 0, 1, 2].iter().flat_map(|i| i.to_le_bytes()).collect();
    let fan = gltf.data(&wide, 4, r#""componentType": 5125, "type": "SCALAR""#);
    let primitive =
        |rest: String| format!(r#"{{"attributes": {{"POSITION": {positions}}}{rest}}}"#);
    let primitives = [
        primitive(format!(r#", "indices": {plain}"#)),
        primitive(r#", "mode": 0"#.to_owned()),
        primitive(r#", "mode": 3"#.to_owned()),
        primitive(format!(r#", "indices": {strip}, "mode": 5"#)),
        primitive(format!(r#", "indices": {fan}, "mode": 6"#)),
        // Without indices, and one vertex too many for a triangle.
        primitive(String::new()),
    ]
    .join(", ");
    let rest = format!(r#""meshes": [{{"primitives": [{primitives}]}}], "nodes": [{{"mesh": 0}}]"#);
    let [a, b, c, d] = [0, 3, 6, 9].map(|i| [square[i], square[i + 1], square[i + 2]]);
    // In order of first use: c, d, a, b.
    let triangles = [[0, 1, 2], [2, 3, 1], [3, 0, 1], [2, 3, 1], [3, 0, 1], [2, 3, 0]];
    let model = check(Format::Gltf, &gltf.glb(&rest), &[c, d, a, b], &triangles);
    let parts = [("node 0/0", 0..1), ("node 0/3", 1..3), ("node 0/4", 3..5), ("node 0/5", 5..6)];
    check_parts(&model, &parts);
}

#[test]
fn buffers_lie_in_the_file_in_the_text_or_beside_it() {
    let mut gltf = Gltf::default();
    gltf.floats(&CORNERS, "VEC3");
    let rest =
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}]"#;
    let base64 = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let inline =
        gltf.json(&format!(r#""uri": "data:application/gltf-buffer;base64,{base64}","#), rest);
    check(Format::Gltf, inline.as_bytes(), &TRIANGLE, &[[0, 1, 2]]);

    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("its data.bin"), gltf.binary()).unwrap();
    let outside = gltf.json(r#""uri": "its%20data.bin","#, rest);
    let model = parse_in(Format::Gltf, outside.as_bytes(), Some(folder.path())).unwrap();
    assert_eq!(model, parse(Format::Gltf, inline.as_bytes()).unwrap());
    let path = folder.path().join("model.GLTF");
    std::fs::write(&path, outside).unwrap();
    assert_eq!(drypoint_mesh::io::read(&path).unwrap(), model);
}

#[test]
fn sparse_accessors_replace_some_elements() {
    let [a, b, c] = TRIANGLE;
    for (base, first) in [(r#""bufferView": 0,"#, [9.0; 3]), ("", a)] {
        let mut gltf = Gltf::default();
        gltf.floats(&[9.0; 9], "VEC3");
        gltf.data(&[1, 2], 2, r#""componentType": 5121, "type": "SCALAR""#);
        gltf.floats(&CORNERS[3..], "VEC3");
        gltf.accessor(&format!(
            r#"{base} "count": 3, "componentType": 5126, "type": "VEC3", "sparse": {{"count": 2,
            "indices": {{"bufferView": 1, "componentType": 5121}}, "values": {{"bufferView": 2}}}}"#
        ));
        let bytes = gltf.glb(
            r#""meshes": [{"primitives": [{"attributes": {"POSITION": 3}}]}], "nodes": [{"mesh": 0}]"#,
        );
        check(Format::Gltf, &bytes, &[first, b, c], &[[0, 1, 2]]);
    }
}

#[test]
fn integer_positions_are_read_as_quantized() {
    let mut gltf = Gltf::default();
    let shorts: Vec<u8> =
        [0i16, 0, 0, 32767, 0, 0, 0, -32768, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let kind = r#""componentType": 5122, "type": "VEC3", "normalized": true"#;
    gltf.data(&shorts, 3, kind);
    gltf.data(&[0, 0, 0, 255, 0, 0, 0, 7, 0], 3, r#""componentType": 5121, "type": "VEC3""#);
    let rest = r#""extensionsRequired": ["KHR_mesh_quantization", "KHR_materials_unlit"],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}, {"attributes": {"POSITION": 1}}]}],
        "nodes": [{"mesh": 0}]"#;
    let positions =
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [255.0, 0.0, 0.0], [0.0, 7.0, 0.0]];
    check(Format::Gltf, &gltf.glb(rest), &positions, &[[0, 1, 2], [0, 3, 4]]);
}

#[test]
fn skinned_meshes_rest_on_their_joints() {
    let mut gltf = Gltf::default();
    gltf.floats(&CORNERS, "VEC3");
    // The second joint is bound 10 up and rests 20 up: vertices that follow it go 10 up. The node's
    // own transform is unused.
    let mut binds = [[0.0f32; 16]; 2];
    (0..16).step_by(5).for_each(|i| (binds[0][i], binds[1][i]) = (1.0, 1.0));
    binds[1][14] = -10.0;
    gltf.floats(&binds.concat(), "MAT4");
    let joints = [[0, 1, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0]].concat();
    gltf.data(&joints, 3, r#""componentType": 5121, "type": "VEC4""#);
    // All on joint 0; all on joint 1; half and half, not quite adding up to 1.
    let weights = [[255, 0, 0, 0], [255, 0, 0, 0], [100, 100, 0, 0]].concat();
    gltf.data(&weights, 3, r#""componentType": 5121, "type": "VEC4", "normalized": true"#);
    let rest = r#""meshes": [{"primitives": [{"attributes":
            {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}}]}],
        "skins": [{"joints": [1, 2], "inverseBindMatrices": 1}],
        "nodes": [{"mesh": 0, "skin": 0, "scale": [5, 5, 5]}, {"children": [2]},
            {"translation": [0, 0, 20]}]"#;
    let expected = [[0.0, 0.0, 0.0], [1.0, 0.0, 10.0], [0.0, 1.0, 5.0]];
    check(Format::Gltf, &gltf.glb(rest), &expected, &[[0, 1, 2]]);
}
