//! What the readers say of bad files: one line each, with the place.

use std::fs;

use drypoint_mesh::io::{Format, ReadOptions, parse_with, read};

use crate::files::{CORNERS, Gltf, binary_stl, glb, one_triangle, ply};

#[track_caller]
fn check(format: Format, bytes: impl AsRef<[u8]>, message: &str) {
    let strict = ReadOptions { strict: true };
    let error = parse_with(format, bytes.as_ref(), None, &strict).unwrap_err().to_string();
    assert_eq!(error, message);
    assert!(!error.contains('\n'));
}

#[test]
fn bad_files_are_named_by_their_content() {
    let folder = tempfile::tempdir().unwrap();
    let obj = "# made by hand\nv 0 0 0\nf 1 1 1\n";
    let ascii_ply = ply("ascii", "element vertex 0");
    let stl = binary_stl(b"", &[[0.0; 3]; 3]);
    let gltf = r#" {"asset": {"version": "2.0"}}"#;
    let cases: [(&str, &[u8], &str); 15] = [
        ("a.obj", b"", "is empty"),
        ("a.PLY", b"", "is empty"),
        ("a.obj", ascii_ply.as_bytes(), "has extension .obj but is a PLY file"),
        ("a.ply", obj.as_bytes(), "has extension .ply but is an OBJ file"),
        ("a.ply", &stl, "has extension .ply but is an STL file"),
        ("a.glb", b"solid x\nendsolid x", "has extension .glb but is an STL file"),
        ("a.stl", gltf.as_bytes(), "has extension .stl but is a glTF file"),
        ("a.Stl", &one_triangle("[]", ""), "has extension .Stl but is a glTF file"),
        ("a.gltf", obj.as_bytes(), "has extension .gltf but is an OBJ file"),
        (
            "a.fbx",
            b"Kaydara",
            "has the unknown extension .fbx; only .obj, .ply, .stl, .gltf, .glb can be read",
        ),
        ("a", obj.as_bytes(), "has no extension; only .obj, .ply, .stl, .gltf, .glb can be read"),
        ("a.obj", b"\x7fELF\x02\x01\x01\x00", "byte 7: is zero, so this is no text file"),
        ("a.obj", b"\xef\xbb\xbfv 0 \x00", "byte 7: is zero, so this is no text file"),
        ("a.ply", b"\x89PNG\r\n", "line 1: expected \"ply\", found \"\u{fffd}PNG\""),
        ("a.glb", b"\x89PNG\r\n", "byte 0: is no valid glTF: expected value at line 1 column 1"),
    ];
    for (name, bytes, message) in cases {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        assert_eq!(read(&path).unwrap_err().to_string(), message, "{name}");
    }
    for name in ["missing.obj", "missing.fbx"] {
        let error = read(&folder.path().join(name)).unwrap_err().to_string();
        assert!(error.starts_with("cannot be read: "), "{error}");
    }
    let error = read(folder.path().with_extension("obj").join("x").as_path()).unwrap_err();
    assert!(error.to_string().starts_with("cannot be read: "));
}

#[test]
fn bad_obj_lines_are_counted_from_1() {
    let check = |text: &str, message: &str| check(Format::Obj, text, message);
    check("\n\nv 0 1,5 0", "line 3: \"1,5\" is not a number");
    check("v 0 0", "line 1: has 2 numbers, but 3 are needed");
    check("v 1 2 # 3", "line 1: has 2 numbers, but 3 are needed");
    let finite = "which is no finite position";
    check("v 0 0 0\nv 0 nan 0", &format!("line 2: vertex 2 is at (0, NaN, 0), {finite}"));
    check("v 0 0 -inf", &format!("line 1: vertex 1 is at (0, 0, -inf), {finite}"));
    check("v 1e39 0 0", &format!("line 1: vertex 1 is at (inf, 0, 0), {finite}"));
    check("v 0 0 0\nf 1 1 0", "line 2: uses vertex 0, but OBJ counts from 1");
    check("v 0 0 0\nf 1 1 2/1\n", "line 2: uses vertex 2, but there are only 1");
    check(
        "f 1 2 3\nf 4 1 1\nf 5 1 1\nv 0 0 0\nv 0 0 0\nv 0 0 0",
        "line 2: uses vertex 4, but there are only 3",
    );
    let far = "line 2: uses vertex 4294967297, but there are only 1";
    check("v 0 0 0\nf 1 1 4294967297", far);
    check("v 0 0 0\nf 1 1 -2", "line 2: uses vertex -2, but only 1 come before");
    check("v 0 0 0\nf 1 1 x/1", "line 2: \"x/1\" is not a vertex index");
    check(
        "v 0 0 0\nf 1 1 99999999999999999999",
        "line 2: \"99999999999999999999\" is not a vertex index",
    );
    check("v 0 0 0\nf 1 1 1.0", "line 2: \"1.0\" is not a vertex index");
    check("v 0 0 0\nf 1 1", "line 2: has 2 corners, but a face needs 3");
    check("v 0 0 0\n\nf\\\n1 \\\n x", "line 3: \"x\" is not a vertex index");
    check("v 0 0 0\nl 1 1", "has no faces");
    check("v 0 0 0\nf 1 1 1\nf \u{1b}\"\u{7}", "line 3: \"\\u{1b}\"\\u{7}\" is not a vertex index");
    let long = format!("v 0 0 {}", "9x".repeat(99));
    check(&long, &format!("line 1: \"{}…\" is not a number", "9x".repeat(20)));
}

const VERTICES: &str = "element vertex 3\nproperty float x\nproperty float y\nproperty float z";
const FACES: &str = "element face 2\nproperty list uchar int vertex_indices";

#[test]
fn bad_ply_headers_are_refused() {
    let check = |text: &str, message: &str| check(Format::Ply, text, message);
    check("ply", "line 1: the file ends before end_header");
    check("plywood\n", "line 1: expected \"ply\", found \"plywood\"");
    check("ply\nend_header\n", "line 2: has no format line");
    check("ply\nformat ascii 2.0\n", "line 2: expected version 1.0, found \"format ascii 2.0\"");
    let formats = "format ascii, binary_little_endian or binary_big_endian";
    check(
        "ply\nformat text 1.0\n",
        &format!("line 2: expected {formats}, found \"format text 1.0\""),
    );
    let header = |declarations: &str| ply("ascii", declarations);
    check(&header("element face"), "line 3: expected element NAME COUNT, found \"element face\"");
    check(
        &header("element face -1"),
        "line 3: expected element NAME COUNT, found \"element face -1\"",
    );
    check(&header("property int x"), "line 3: expected an element first, found \"property int x\"");
    let property = |text: &str| header(&format!("element e 1\n{text}"));
    check(&property("property"), "line 4: expected property TYPE NAME, found \"property\"");
    check(
        &property("property half x"),
        "line 4: expected property TYPE NAME, found \"property half x\"",
    );
    check(
        &property("property int"),
        "line 4: expected a name for the property, found \"property int\"",
    );
    let list = "property list float int x";
    check(
        &property(list),
        &format!("line 4: expected an integer type for the length, found \"{list}\""),
    );
    check(&property("element e 2"), "line 4: declares \"e\" a second time");
    check(&property("property int x\nproperty int x"), "line 5: declares \"x\" a second time");
    // Found among many, without comparing each to each.
    let many: String = (0..400_000).map(|i| format!("property int x{i}\n")).collect();
    check(
        &property(&format!("{many}property int x0")),
        "line 400004: declares \"x0\" a second time",
    );
    check(&property("vertex 3"), "line 4: expected a header line, found \"vertex 3\"");
    check(&header("element face 0"), "line 4: has no list vertex_indices of face");
    check(&header(FACES), "line 5: has no element vertex");
    check(
        &header("element vertex 3\nproperty list int int x"),
        "line 5: has no property x of vertex",
    );
    check(&header(&VERTICES.replace("float z", "float w")), "line 7: has no property z of vertex");
}

#[test]
fn bad_ply_rows_are_named() {
    let text = |faces: &str| {
        let header = ply("ascii", &format!("{VERTICES}\n{FACES}"));
        format!("{header}0 0 0\n1 0 0\n0 1 0\n{faces}")
    };
    let check_text = |faces: &str, message: &str| check(Format::Ply, text(faces), message);
    check_text("3 0 1 2\n", "line 13: the file ends after 1 of 2 rows of \"face\"");
    check_text("3 0 1 3\n", "line 13: uses vertex 3, but there are only 3");
    check_text("3 0 1 -2\n", "line 13: \"-2\" is not a vertex index");
    check_text("3 0 1 2.5\n", "line 13: \"2.5\" is not a vertex index");
    check_text("3 0 1\n", "line 13: has 3 numbers, but 4 are needed");
    check_text("\n3 0 1 2 0\n", "line 14: has \"0\" left over");
    check_text("2 0 1\n", "line 13: has 2 corners, but a face needs 3");
    check_text("-1 0 1\n", "line 13: expected the length of a list, found \"-1\"");
    check_text("999999999999 0 1\n", "line 13: has 3 numbers, but 4 are needed");
    let vertices = |rows: &str| ply("ascii", VERTICES) + rows;
    check(Format::Ply, vertices("0 0 0\n0 0 0 0\n"), "line 9: has \"0\" left over");
    check(Format::Ply, vertices("0 0 0\n0 x 0\n"), "line 9: \"x\" is not a number");
    let message = "line 8: vertex 0 is at (0, inf, 0), which is no finite position";
    check(Format::Ply, vertices("0 1e99 0\n"), message);
    check(Format::Ply, vertices("0 0 0\n0 0 0\n0 0 0\n"), "has no faces");
    let many = ply("ascii", &VERTICES.replace('3', "1000000000000000000")) + "0 0 0\n";
    let message = "line 8: the file ends after 1 of 1000000000000000000 rows of \"vertex\"";
    check(Format::Ply, many, message);
    // Nothing to read, and quickly.
    let nothing = "element vertex 0\nproperty int x\nproperty int y\nproperty int z\nelement e 1000000000000000000";
    check(Format::Ply, ply("ascii", nothing), "has no faces");
}

#[test]
fn bad_binary_ply_rows_are_named() {
    let file = |declarations: &str, rows: &[&[u8]]| {
        let mut bytes = ply("binary_big_endian", declarations).into_bytes();
        rows.iter().for_each(|row| bytes.extend_from_slice(row));
        bytes
    };
    let both = format!("{VERTICES}\n{}", FACES.replace("int", "char"));
    let start = file(&both, &[]).len();
    let check = |rows: &[&[u8]], what: &str, at: usize, message: &str| {
        check(Format::Ply, file(&both, rows), &format!("{what} (byte {}): {message}", start + at));
    };
    let ends = |rows, of: &str| format!("the file ends after {rows} rows of \"{of}\"");
    check(&[], "vertex 0", 0, &ends("0 of 3", "vertex"));
    check(&[&[0; 30]], "vertex 2", 28, &ends("2 of 3", "vertex"));
    check(&[&[0; 36], &[3, 0, 0]], "face 0", 39, &ends("0 of 2", "face"));
    check(&[&[0; 36], &[3, 0, 1, 2]], "face 1", 40, &ends("1 of 2", "face"));
    check(&[&[0; 36], &[3, 0, 1, 3]], "face 0", 40, "uses vertex 3, but there are only 3");
    check(&[&[0; 36], &[3, 0, 255, 2]], "face 0", 40, "\"-1\" is not a vertex index");
    check(&[&[0; 36], &[0]], "face 0", 37, "has 0 corners, but a face needs 3");
    let message = "vertex 1 is at (0, NaN, 0), which is no finite position";
    check(&[&[0; 16], &f32::NAN.to_be_bytes(), &[0; 9]], "vertex 1", 24, message);
    let declared = VERTICES.replace('3', "1000000000000000000");
    let many = file(&declared, &[&[0; 36]]);
    let end = many.len();
    let message = "the file ends after 3 of 1000000000000000000 rows of \"vertex\"";
    self::check(Format::Ply, many, &format!("vertex 3 (byte {end}): {message}"));
    let skipped =
        file(&format!("{VERTICES}\nproperty list uint double far"), &[&[0; 12], &[255; 4]]);
    let message = "the file ends after 0 of 3 rows of \"vertex\"";
    let end = skipped.len();
    self::check(Format::Ply, skipped, &format!("vertex 0 (byte {end}): {message}"));
}

#[test]
fn bad_stl_files_are_refused() {
    let check = |bytes: &[u8], message: &str| check(Format::Stl, bytes, message);
    let mut bytes = binary_stl(b"solid", &[[0.0; 3]; 6]);
    let wanted = |needed: u64, available: u64| {
        format!(
            "byte 0: is neither STL text, which begins with \"solid\", nor a whole binary STL, which \
             would have {needed} bytes, not {available}"
        )
    };
    check(&bytes[..83], &wanted(84, 83));
    check(&bytes[..183], &wanted(184, 183));
    check(b"\x93\x00 garbage", &wanted(84, 10));
    bytes[83] = 255;
    check(&bytes, &wanted(213_909_504_184, 184));
    check(&binary_stl(b"", &[]), "has no faces");
    let mut corners = [[0.0; 3]; 6];
    corners[4][2] = f32::NEG_INFINITY;
    let message = "facet 1 (byte 134): vertex 4 is at (0, 0, -inf), which is no finite position";
    check(&binary_stl(b"", &corners), message);
    let check = |text: &str, message: &str| check(text.as_bytes(), message);
    check("solid\nendsolid", "has no faces");
    check("solid\n", "line 1: the file ends before endsolid");
    check("solid x\nfacet normal 0 0 1\n outer loop", "line 3: the file ends before endfacet");
    check("solid\nendsolid\nfacet", "line 3: expected solid, found \"facet\"");
    check("solid\nvertex 0 0 0", "line 2: expected facet or endsolid, found \"vertex 0 0 0\"");
    check("solid\nfacet\nendsolid", "line 3: expected vertex or endfacet, found \"endsolid\"");
    check("solid\nfacet\nvertex 0 0 0\nendfacet", "line 4: has 1 vertices, but a facet has 3");
    check("solid\nfacet\nvertex 0 0", "line 3: has 2 numbers, but 3 are needed");
    check("solid\nfacet\nvertex 0 0 0 0", "line 3: has \"0\" left over");
    check("solid\nfacet\nvertex 0 a 0", "line 3: \"a\" is not a number");
    let message = "line 3: vertex 0 is at (NaN, 0, 0), which is no finite position";
    check("solid\nfacet\nvertex nan 0 0", message);
}

#[test]
fn bad_gltf_containers_are_refused() {
    let check = |bytes: &[u8], message: &str| check(Format::Gltf, bytes, message);
    let whole = one_triangle(r#"[{"mesh": 0}]"#, "");
    check(b"glTF", "byte 8: needs 12 bytes, but there are only 0");
    check(b"glTF\x02\0\0\0\x0b\0\0\0", "byte 8: needs 12 bytes, but there are only 11");
    check(b"glTF\x01\0\0\0\x0c\0\0\0", "byte 0: is no valid glTF: unsupported version");
    let (needed, there) = (whole.len() - 12, whole.len() - 13);
    let message = format!("byte 12: needs {needed} bytes, but there are only {there}");
    check(&whole[..whole.len() - 1], &message);
    check(&glb("[", b""), "byte 0: is no valid glTF: EOF while parsing a list at line 1 column 4");
    check(b"{", "byte 0: is no valid glTF: EOF while parsing an object at line 1 column 1");
    check(b"{}", "byte 0: is no valid glTF: missing field `asset` at line 1 column 2");
    // A picture of megabytes may be where it does not belong.
    let start = format!("byte 0: is no valid glTF: invalid type: string \"{}", "é".repeat(58));
    let end = "é".repeat(34) + "\", expected struct Asset at line 1 column 2011";
    check(format!(r#"{{"asset":"{}"}}"#, "é".repeat(1000)).as_bytes(), &format!("{start}…{end}"));
    check(br#"{"asset": {"version": "2.0"}}"#, "has no faces");
    let required =
        r#"{"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_draco_mesh_compression"]}"#;
    let message =
        "requires the glTF extension \"KHR_draco_mesh_compression\", which is not supported";
    check(required.as_bytes(), message);
}

#[test]
fn bad_gltf_buffers_are_refused() {
    let check = |uri: &str, message: &str| {
        let text =
            format!(r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 4{uri}}}]}}"#);
        check(Format::Gltf, text, message);
    };
    check("", "buffers[0]: has no uri and no data in this file");
    check(r#", "uri": "data:;base64,AAA=""#, "buffers[0]: needs 4 bytes, but there are only 2");
    check(r#", "uri": "data:;base64,AA*A""#, "buffers[0]: is not valid base64 data");
    check(r#", "uri": "data:text/plain,AAAA""#, "buffers[0]: is not valid base64 data");
    check(r#", "uri": "x.bin""#, "buffers[0]: is not within these bytes");
    check(r#", "uri": "https://example.org/x.bin""#, "buffers[0]: is not a file beside this one");
    check(r#", "uri": "/etc/passwd""#, "buffers[0]: is not a file beside this one");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gltf");
    for (uri, start) in
        [("x%20y.bin", "the file \"x%20y.bin\" cannot be read: "), (".", "is not a file beside")]
    {
        let text = format!(
            r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 4, "uri": "{uri}"}}]}}"#
        );
        fs::write(&path, text).unwrap();
        let error = read(&path).unwrap_err().to_string();
        assert!(error.starts_with(&format!("buffers[0]: {start}")), "{error}");
    }
}

#[test]
fn bad_gltf_nodes_are_refused() {
    let check = |nodes: &str, message: &str| check(Format::Gltf, one_triangle(nodes, ""), message);
    check("[]", "has no faces");
    check(r#"[{"children": [1]}, {"children": [0]}]"#, "nodes[0]: is its own ancestor");
    check(r#"[{"children": [0]}]"#, "nodes[0]: is its own ancestor");
    check(r#"[{"children": [1, 1]}, {}]"#, "nodes[1]: has two parents");
    check(r#"[{"children": [2]}, {"children": [2]}, {}]"#, "nodes[2]: has two parents");
    check(r#"[{"children": [7]}]"#, "nodes[0]: uses nodes[7], but there are only 1");
    check(r#"[{"mesh": 1}]"#, "nodes[0]: uses meshes[1], but there are only 1");
    check(r#"[{"mesh": 0, "skin": 0}]"#, "nodes[0]: uses skins[0], but there are only 0");
    let message =
        "meshes[0].primitives[0]: vertex 0 is at (inf, 0, 0), which is no finite position";
    check(
        r#"[{"translation": [3e38, 0, 0], "children": [1]}, {"mesh": 0, "translation": [3e38, 0, 0]}]"#,
        message,
    );
    let check = |scenes: &str, message: &str| {
        self::check(Format::Gltf, one_triangle("[]", scenes), message)
    };
    check(r#", "scene": 0"#, "scene: uses scenes[0], but there are only 0");
    check(r#", "scenes": [{"nodes": [3]}]"#, "scenes: uses nodes[3], but there are only 0");
}

/// A file of one primitive, made of these fields and accessors.
fn primitive(primitive: &str, add: impl Fn(&mut Gltf)) -> Vec<u8> {
    let mut gltf = Gltf::default();
    add(&mut gltf);
    gltf.glb(&format!(
        r#""meshes": [{{"primitives": [{{{primitive}}}]}}], "nodes": [{{"mesh": 0}}]"#
    ))
}

/// Checks a file whose positions are this accessor, beside a view of 36 bytes.
#[track_caller]
fn check_accessor(fields: &str, message: &str) {
    let bytes = primitive(r#""attributes": {"POSITION": 0}"#, |gltf| {
        gltf.view(&[0; 36]);
        gltf.accessor(fields);
    });
    check(Format::Gltf, bytes, message);
}

#[test]
fn bad_gltf_accessors_are_refused() {
    let only = r#""attributes": {"POSITION": 0}"#;
    let indexed = r#""attributes": {"POSITION": 0}, "indices": 1"#;
    let of = "meshes[0].primitives[0]";
    check(
        Format::Gltf,
        primitive(only, |_| {}),
        &format!("{of}: uses accessors[0], but there are only 0"),
    );
    check(
        Format::Gltf,
        primitive(r#""attributes": {}"#, |_| {}),
        &format!("{of}: has no attribute POSITION"),
    );
    let bytes = primitive(indexed, |gltf| {
        gltf.floats(&CORNERS, "VEC3");
        gltf.shorts(&[0, 1, 3]);
    });
    check(Format::Gltf, bytes, &format!("{of}: uses vertex 3, but there are only 3"));
    let mode = format!(r#"{only}, "mode": 7"#);
    let bytes = primitive(&mode, |gltf| {
        gltf.floats(&CORNERS, "VEC3");
    });
    check(Format::Gltf, bytes, &format!("{of}: is not a known primitive mode"));

    let check = check_accessor;
    let floats = r#""componentType": 5126, "type": "VEC3""#;
    check(&format!(r#""count": 3, {floats}"#), "accessors[0]: has no bufferView");
    let view = r#""bufferView": 0"#;
    let wrong = "accessors[0]: is not VEC3 of numbers";
    check(&format!(r#"{view}, "count": 3, "componentType": 5126, "type": "VEC2""#), wrong);
    check(&format!(r#"{view}, "count": 3, "componentType": 5125, "type": "VEC3""#), wrong);
    check(&format!(r#"{view}, "count": 3, "componentType": 1, "type": "VEC3""#), wrong);
    let short = |needed: u64| format!("accessors[0]: needs {needed} bytes, but there are only 36");
    check(&format!(r#"{view}, "count": 4, {floats}"#), &short(48));
    check(&format!(r#"{view}, "count": 3, "byteOffset": 4, {floats}"#), &short(40));
    check(&format!(r#"{view}, "count": 18446744073709551615, {floats}"#), &short(u64::MAX));
    check(
        &format!(r#"{view}, "count": 1, "byteOffset": 18446744073709551615, {floats}"#),
        &short(u64::MAX),
    );
    check(&format!(r#"{view}, "count": 0, {floats}"#), "has no faces");
    check(
        &format!(r#""bufferView": 9, "count": 3, {floats}"#),
        "accessors[0]: uses bufferViews[9], but there are only 1",
    );
}

#[test]
fn bad_sparse_gltf_accessors_are_refused() {
    let check = check_accessor;
    let floats = r#""componentType": 5126, "type": "VEC3""#;
    let short = |needed: u64| format!("accessors[0]: needs {needed} bytes, but there are only 36");
    let sparse = |count: u64, sparse: u64, component: u16| {
        format!(
            r#""count": {count}, {floats}, "sparse": {{"count": {sparse}, "values": {{"bufferView": 0}},
            "indices": {{"bufferView": 0, "componentType": {component}}}}}"#
        )
    };
    check(&sparse(3, 4, 5121), &short(48));
    check(&sparse(0, 1, 5121), "accessors[0]: uses vertex 0, but there are only 0");
    check(&sparse(3, 1, 5126), "accessors[0]: is not sparse by unsigned integers");
    check(&sparse(1 << 40, 1, 5121), &short(12 << 40));
}

#[test]
fn bad_gltf_views_are_refused() {
    let rest =
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}]"#;
    let check = |view: &str, message: &str| {
        let json = format!(
            r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 36}}], "bufferViews": [{{{view}}}],
            "accessors": [{{"bufferView": 0, "count": 3, "componentType": 5126, "type": "VEC3"}}], {rest}}}"#
        );
        check(Format::Gltf, glb(&json, &[0; 36]), message);
    };
    let view = "bufferViews[0]";
    check(
        r#""buffer": 1, "byteLength": 36"#,
        &format!("{view}: uses buffers[1], but there are only 1"),
    );
    check(
        r#""buffer": 0, "byteLength": 37"#,
        &format!("{view}: needs 37 bytes, but there are only 36"),
    );
    let message = format!("{view}: needs {} bytes, but there are only 36", u64::MAX);
    check(r#""buffer": 0, "byteOffset": 9, "byteLength": 18446744073709551615"#, &message);
    let message = format!("{view}: steps by 8 bytes over elements of 12");
    check(r#""buffer": 0, "byteLength": 36, "byteStride": 8"#, &message);
}

#[test]
fn bad_gltf_skins_are_refused() {
    let check = |joints: &str, binds: usize, bytes: [u8; 12], message: &str| {
        let mut gltf = Gltf::default();
        gltf.floats(&CORNERS, "VEC3");
        gltf.floats(&vec![0.0; 16 * binds], "MAT4");
        gltf.data(&bytes, 3, r#""componentType": 5121, "type": "VEC4""#);
        gltf.data(&[9; 12], 3, r#""componentType": 5121, "type": "VEC4""#);
        let rest = format!(
            r#""nodes": [{{"mesh": 0, "skin": 0}}], "skins": [{{"joints": {joints}, "inverseBindMatrices": 1}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}}}}]}}]"#
        );
        check(Format::Gltf, gltf.glb(&rest), message);
    };
    check("[8]", 1, [0; 12], "skins[0]: uses nodes[8], but there are only 1");
    check("[0, 0]", 1, [0; 12], "skins[0]: has 2 joints, but only 1 inverse bind matrices");
    let message = "meshes[0].primitives[0]: vertex 1 follows joint 1, but there are only 1";
    check("[0]", 1, [0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0], message);
}
