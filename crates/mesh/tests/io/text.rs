//! What is read from OBJ, PLY and STL.

use drypoint_mesh::io::{Format, parse};

use crate::files::{binary_stl, check, check_materials, check_parts, ply};

const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
const TWO: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

#[test]
fn obj_corners_are_written_in_many_ways() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    for face in [
        "f 1 2 3 4",
        "f 1/1 2/1 3/1 4/1\n",
        "f 1//1 2//1 3//1 4//1",
        "f 1/9/9 2/9/9 3/9/9 4/9/9",
        "f -4 -3 -2 -1",
        "f -4/-1/-1 2 -2//7 4",
        "f\t1  2 3\t4 \r\n",
        "f 1 2 \\\n3 4",
        "f 1 2\\\r\n 3\\\r\n 4\r\n",
        "f 1 2 3 4 # a square",
        "f 1 2 3\nf 1 3 4",
    ] {
        check(Format::Obj, (vertices.to_owned() + face).as_bytes(), &SQUARE, &TWO);
    }
}

#[test]
fn obj_vertices_have_weights_colours_and_comments() {
    let text = b"\xef\xbb\xbf# a comment ends here \\\n  v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\n\
        v 1. +1 -0e3 # here\nvn 0 0 1\nvt 0 0\nv .0 10.0E-1 0 1 .5 .5 .5\nmtllib a.mtl\n\
        usemtl \xff\xfe\ns off\nl 1 2\np 1\ncstype bezier\nf 1 2 3 4";
    check(Format::Obj, text, &SQUARE, &TWO);
}

#[test]
fn obj_faces_may_come_before_their_vertices() {
    let text = b"f 1 2 3 4\nv 2 0 0\nv 0 1 0\nv 0.5 0 0\nv 0 -1 0\nf -4 -3 -2";
    let arrow = [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.0, 0.0], [0.0, -1.0, 0.0]];
    check(Format::Obj, text, &arrow, &[[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
}

#[test]
fn obj_parts_are_objects_and_groups() {
    let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\no empty\no a body \ng its arm\n\
        f 1 2 3 4\ng\xff\ng its arm\nf 1 2 3\nusemtl paint\nf 1 2 3\ng\nf 1 2 3\ng last";
    let model = parse(Format::Obj, text).unwrap();
    check_parts(&model, &[("", 0..1), ("its arm", 1..5), ("", 5..6)]);
    check_parts(&parse(Format::Obj, b"v 0 0 0\nf 1 1 1").unwrap(), &[("", 0..1)]);
}

#[test]
fn obj_materials_run_across_parts() {
    let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nusemtl nothing\nusemtl red wine\n\
        g a\nf 1 2 3 4\nusemtl red wine \ng b\nf 1 2 3\nusemtl\nf 1 2 3\nusemtl last\n";
    let model = parse(Format::Obj, text).unwrap();
    check_parts(&model, &[("", 0..1), ("a", 1..3), ("b", 3..5)]);
    check_materials(&model, &[("", 0..1), ("red wine", 1..4), ("", 4..5)]);
    // An empty name is that of what is before the first.
    let text = b"v 0 0 0\nf 1 1 1\nusemtl\ng\nf 1 1 1\nusemtl red\nf 1 1 1\n";
    let model = parse(Format::Obj, text).unwrap();
    check_materials(&model, &[("", 0..2), ("red", 2..3)]);
    check_parts(&model, &[("", 0..3)]);
}

#[test]
fn positions_are_rounded_once() {
    // Half-way between two f32 but for the last digit, which an f64 drops.
    let text = "1.00000005960464477540";
    let next = f32::from_bits(1.0f32.to_bits() + 1);
    assert_eq!(text.parse::<f64>(), Ok(1.0 + 2f64.powi(-24)));
    let obj = format!("v {text} 0 0\nf 1 1 1");
    let header = "element vertex 1\nproperty double x\nproperty double y\nproperty double z\n\
        element face 1\nproperty list uchar int vertex_indices";
    for (format, bytes) in
        [(Format::Obj, obj), (Format::Ply, ply("ascii", header) + text + " 0 0\n3 0 0 0\n")]
    {
        assert_eq!(parse(format, bytes.as_bytes()).unwrap().mesh.position(0).x, next, "{format}");
    }
}

/// A square with more properties and elements than are read.
const WIDE: &str = "comment a square\nobj_info x\nelement material 1\nproperty uchar red\n\
    property list uchar short weights\nelement vertex 4\nproperty double z\nproperty uchar red\n\
    property list ushort float extra\nproperty float x\nproperty short y\nelement empty 9\n\
    element face 1\nproperty float quality\nproperty list int uint vertex_index\n\
    property list uchar float texcoord";

#[test]
fn ply_rows_are_read_in_all_encodings() {
    let text = "7 2 -1 -2\n0 255 0 0 0\n\n0 255 1 9.5 1 0\n0 255 2 9 9 1 1\r\n0 255 0 0 1\n\
        0.5 4 0 1 2 3 0";
    check(Format::Ply, (ply("ascii", WIDE) + text).as_bytes(), &SQUARE, &TWO);
    for (encoding, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let mut bytes = ply(encoding, WIDE).into_bytes();
        let mut put = |value: &[u8]| {
            let start = bytes.len();
            bytes.extend_from_slice(value);
            if big {
                bytes[start..].reverse();
            }
        };
        put(&[7]);
        put(&[2]);
        put(&(-1i16).to_le_bytes());
        put(&(-2i16).to_le_bytes());
        for ([x, y, z], extra) in SQUARE.into_iter().zip([0u16, 1, 2, 0]) {
            put(&f64::from(z).to_le_bytes());
            put(&[255]);
            put(&extra.to_le_bytes());
            (0..extra).for_each(|_| put(&9f32.to_le_bytes()));
            put(&x.to_le_bytes());
            put(&i16::from(y == 1.0).to_le_bytes());
        }
        put(&0.5f32.to_le_bytes());
        put(&4i32.to_le_bytes());
        (0..4u32).for_each(|index| put(&index.to_le_bytes()));
        put(&[0]);
        check(Format::Ply, &bytes, &SQUARE, &TWO);
    }
}

#[test]
fn ply_strips_alternate_and_start_again() {
    let header = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        element tristrips 2\nproperty list int int vertex_indices";
    let rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n9 0 1 2 3 -1 3 2 1 0\n7 0 1 1 2 3 -1 2\n";
    let expected = [[0, 1, 2], [2, 1, 3], [3, 2, 1], [1, 2, 0], [1, 2, 3]];
    check(Format::Ply, (ply("ascii", header) + rows).as_bytes(), &SQUARE, &expected);
}

#[test]
fn stl_facets_keep_their_own_vertices() {
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.5, 0.0],
        [0.0, 1.5, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, -2.0],
    ];
    let facet = |c: &[[f32; 3]]| {
        let vertices: Vec<_> = c.iter().map(|[x, y, z]| format!("vertex {x} {y} {z}\n")).collect();
        format!(" facet normal nan 0 0\n  OUTER loop\n{}endloop\r\n\nendfacet\n", vertices.concat())
    };
    let (first, second) = (facet(&corners[..3]), facet(&corners[3..]));
    let triangles = [[0, 1, 2], [3, 4, 5]];
    let one = format!("solid\n{first}{second}endsolid");
    let model = check(Format::Stl, one.as_bytes(), &corners, &triangles);
    check_parts(&model, &[("", 0..2)]);
    let several = format!(
        "\nSOLID left side\n{first}endsolid left side\nsolid none\nendsolid\nsolid b\n{second}endsolid\n"
    );
    let model = check(Format::Stl, several.as_bytes(), &corners, &triangles);
    check_parts(&model, &[("left side", 0..1), ("b", 1..2)]);
    check_materials(&model, &[("", 0..2)]);

    for header in [*b"solid pretends", *b"binary rubbish"] {
        let mut bytes = binary_stl(&header, &corners);
        check(Format::Stl, &bytes, &corners, &triangles);
        bytes.extend(b"more");
        check(Format::Stl, &bytes, &corners, &triangles);
    }
}

#[test]
fn empty_lines_of_an_stl_are_looked_through_once() {
    // Above the size from which a text is read in pieces. Once for each of them would take hours.
    let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    let text = format!("solid a\n{facet}{}endsolid a\n", "\n".repeat(4_000_000));
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    check(Format::Stl, text.as_bytes(), &corners, &[[0, 1, 2]]);
}

#[test]
fn stl_agrees_with_another_reader() {
    let corners: Vec<[f32; 3]> =
        (0..30u8).map(|i| [f32::from(i).sin(), f32::from(i), 0.1]).collect();
    let bytes = binary_stl(b"", &corners);
    let theirs = stl_io::read_stl(&mut std::io::Cursor::new(&bytes)).unwrap();
    let model = parse(Format::Stl, &bytes).unwrap();
    let ours = model.mesh.triangles().iter().flatten().map(|&v| model.mesh.position(v).to_array());
    let theirs = theirs.faces.iter().flat_map(|f| f.vertices).map(|v| theirs.vertices[v].0);
    assert!(ours.eq(theirs));
}
