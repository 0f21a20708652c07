//! Vertices that are not finite, and what is left without them.

use std::ops::Range;

use drypoint_mesh::io::{Dropped, Format, ReadOptions, parse, parse_with};
use glam::Vec3;

use crate::files::{binary_stl, check_materials, check_parts, ply};

/// Ways to write a coordinate of no finite position.
const NOWHERE: [&str; 8] = ["nan", "NaN", "-nan", "inf", "-Infinity", "1e999", "-4e38", "1e39"];

/// Checks what is left, by numbers of the file, and that it is an error to be strict.
#[track_caller]
fn check(format: Format, bytes: &[u8], triangles: &[[u32; 3]], dropped: Dropped, place: &str) {
    let model = parse(format, bytes).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(model.mesh.triangles(), triangles);
    assert_eq!(model.dropped, dropped);
    assert!(model.mesh.positions().iter().all(|position| position.is_finite()));
    for (vertex, &position) in (0..).zip(model.mesh.positions()) {
        let is_used = triangles.iter().flatten().any(|&v| v == vertex);
        assert!(is_used || position == Vec3::ZERO || format == Format::Stl, "{vertex}");
    }
    let strict = ReadOptions { strict: true };
    let error = parse_with(format, bytes, None, &strict).unwrap_err().to_string();
    assert!(error.starts_with(place) && error.ends_with("which is no finite position"), "{error}");
}

#[test]
fn obj_faces_of_such_vertices_are_dropped() {
    for nowhere in NOWHERE {
        let text = format!(
            "v 1 0 0\nv 1 2 0\nv 3 4 {nowhere}\nv 0 7 0\nv 1 5 1\nv {nowhere} 0 0 # unused\n\
             o a\nusemtl red\nf 1 2 3\nf 1 2 4 5\no b\nf 1 2 -4 4\no c\nusemtl blue\nf 2 4 5\n\
             o d\nf 5 4 3"
        );
        let dropped = Dropped { vertices: 2, faces: 3 };
        let triangles = [[0, 1, 3], [0, 3, 4], [1, 3, 4]];
        check(Format::Obj, text.as_bytes(), &triangles, dropped, "line 3: vertex 3 is at (3, 4,");
        let model = parse(Format::Obj, text.as_bytes()).unwrap();
        let red: Range<u32> = 0..2;
        check_parts(&model, &[("a", red.clone()), ("c", 2..3)]);
        check_materials(&model, &[("red", red), ("blue", 2..3)]);
    }
}

const DECLARATIONS: &str = "element vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
    element face 2\nproperty list uchar int vertex_indices\n\
    element tristrips 1\nproperty list int int vertex_indices";

#[test]
fn ply_faces_of_such_vertices_are_dropped() {
    let dropped = Dropped { vertices: 1, faces: 3 };
    let triangles = [[0, 3, 1], [3, 4, 0]];
    for nowhere in NOWHERE {
        let text = ply("ascii", DECLARATIONS)
            + &format!(
                "1 0 0\n1 2 0\n3 {nowhere} 4\n0 7 0\n1 5 1\n3 0 3 1\n4 0 1 2 3\n5 1 2 3 4 0\n"
            );
        check(Format::Ply, text.as_bytes(), &triangles, dropped, "line 14: vertex 2 is at (3, ");
    }
    for (encoding, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let header = ply(encoding, DECLARATIONS);
        for nowhere in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut bytes = header.clone().into_bytes();
            let value = |bits: u32| if big { bits.to_be_bytes() } else { bits.to_le_bytes() };
            let corners =
                [[1., 0., 0.], [1., 2., 0.], [3., nowhere, 4.], [0., 7., 0.], [1., 5., 1.]];
            bytes.extend(corners.into_iter().flatten().flat_map(|x: f32| value(x.to_bits())));
            bytes.push(3);
            bytes.extend([0, 3, 1].map(value).concat());
            bytes.push(4);
            bytes.extend([0, 1, 2, 3].map(value).concat());
            bytes.extend([5, 1, 2, 3, 4, 0].map(value).concat());
            let place = format!("vertex 2 (byte {}): vertex 2 is at (3, ", header.len() + 36);
            check(Format::Ply, &bytes, &triangles, dropped, &place);
        }
    }
}

#[test]
fn stl_facets_of_such_vertices_are_dropped() {
    let dropped = Dropped { vertices: 1, faces: 1 };
    for nowhere in NOWHERE {
        let facet =
            |x: &str| format!("facet\nvertex {x} 1 0\nvertex 1 0 0\nvertex 2 3 0\nendfacet\n");
        let text = format!(
            "solid a\n{}{}endsolid\nsolid b\n{}endsolid",
            facet("1"),
            facet(nowhere),
            facet("2")
        );
        let triangles = [[0, 1, 2], [6, 7, 8]];
        check(Format::Stl, text.as_bytes(), &triangles, dropped, "line 8: vertex 3 is at (");
        let model = parse(Format::Stl, text.as_bytes()).unwrap();
        check_parts(&model, &[("a", 0..1), ("b", 1..2)]);
        // Vertices of dropped facets that are somewhere stay there.
        assert_eq!(model.mesh.position(4), Vec3::X);
    }
    let corners = [[1.0; 3], [2.0; 3], [f32::NAN, 0.0, 0.0], [3.0; 3], [4.0; 3], [5.0; 3]];
    let bytes = binary_stl(b"", &corners);
    let place = "facet 0 (byte 84): vertex 2 is at (NaN, ";
    check(Format::Stl, &bytes, &[[3, 4, 5]], dropped, place);
}

#[test]
fn a_file_of_nothing_else_is_refused() {
    let obj = "v nan 0 0\nv 0 0 0\nf 1 2 2\nf 2 1 1 2\n";
    let header = ply("ascii", &DECLARATIONS.replace("vertex 5", "vertex 1"));
    let rows = "inf 0 0\n3 0 0 0\n3 0 0 0\n0\n";
    let stl = "solid\nfacet\nvertex 0 0 nan\nvertex 0 0 0\nvertex 0 0 0\nendfacet\nendsolid";
    for (format, text, count) in [
        (Format::Obj, obj.to_owned(), 2),
        (Format::Ply, header + rows, 2),
        (Format::Stl, stl.to_owned(), 1),
    ] {
        let error = parse(format, text.as_bytes()).unwrap_err().to_string();
        let expected =
            format!("has no face without a vertex at no finite position; faces left out: {count}");
        assert_eq!(error, expected, "{format}");
    }
    // What has no faces says so, whatever its vertices.
    assert_eq!(parse(Format::Obj, b"v nan 0 0\n").unwrap_err().to_string(), "has no faces");
}

#[test]
fn gltf_faces_of_such_vertices_are_dropped() {
    // A face each of sound vertices and of one that is nowhere; in a scene that stands still, and in one
    // whose mesh is placed twice.
    let mut positions = crate::files::CORNERS.to_vec();
    positions.extend([f32::NAN, 0.0, 0.0]);
    for (nodes, faces) in [(r#"{"mesh": 0}"#, 1), (r#"{"mesh": 0}, {"mesh": 0}"#, 2)] {
        let mut gltf = crate::files::Gltf::default();
        gltf.floats(&positions, "VEC3");
        gltf.shorts(&[0, 1, 2, 0, 1, 3]);
        let bytes = gltf.glb(&format!(
            r#""meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
            "nodes": [{nodes}]"#
        ));
        let dropped = Dropped { vertices: faces, faces };
        let place = "meshes[0].primitives[0]: vertex 3 is at (NaN, 0, 0), ";
        check(Format::Gltf, &bytes, &vec![[0, 1, 2]; faces], dropped, place);
    }
}
