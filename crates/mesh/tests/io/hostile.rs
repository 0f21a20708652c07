//! Whatever the bytes, a reader returns. What it returns may be a smaller mesh: half an OBJ file is
//! an OBJ file.

use drypoint_mesh::MeshAdjacency;
use drypoint_mesh::io::{Format, parse};
use proptest::collection::vec;
use proptest::prelude::*;

use crate::files::{CORNERS, Gltf, binary_stl, ply};

/// A small valid file of each kind.
fn valid() -> Vec<(Format, Vec<u8>)> {
    let declarations = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_index\n\
        element tristrips 1\nproperty list int int vertex_indices";
    let binaries = ["binary_little_endian", "binary_big_endian"].map(|encoding| {
        let mut bytes = ply(encoding, declarations).into_bytes();
        let turn = |mut value: [u8; 4]| {
            if encoding == "binary_big_endian" {
                value.reverse();
            }
            value
        };
        let corners = CORNERS.iter().chain(&[1.0, 1.0, 0.0]);
        bytes.extend(corners.flat_map(|x| turn(x.to_le_bytes())));
        bytes.push(4);
        let indices = [0, 1, 3, 2, 7, 0, 1, 2, -1, 2, 1, 3i32];
        bytes.extend(indices.iter().flat_map(|index| turn(index.to_le_bytes())));
        (Format::Ply, bytes)
    });
    let text = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n4 0 1 3 2\n7 0 1 2 -1 2 1 3\n";
    let obj = "# a\no b\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0\nv 0.5 0.1 2e-1\nvt 0 0\ng c\n\
        f 1/1 2/1 3/1 4/1\nf -1 -2 \\\n -3\nf 1 5 2 3 4\n";
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n\
        vertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    let (json, glb) = scene();
    let corners = [CORNERS[..3].try_into().unwrap(), [1.0; 3], [2.0, 0.5, 0.0]];
    [
        (Format::Obj, obj.into()),
        (Format::Ply, (ply("ascii", declarations) + text).into_bytes()),
        (Format::Stl, stl.into()),
        (Format::Stl, binary_stl(b"solid", &corners)),
        (Format::Gltf, json),
        (Format::Gltf, glb),
    ]
    .into_iter()
    .chain(binaries)
    .collect()
}

/// A skinned strip with sparse positions, as JSON and as GLB.
fn scene() -> (Vec<u8>, Vec<u8>) {
    let mut gltf = Gltf::default();
    gltf.floats(&[0.0; 9], "VEC3");
    gltf.data(&[1, 2], 2, r#""componentType": 5121, "type": "SCALAR""#);
    gltf.floats(&CORNERS[3..], "VEC3");
    gltf.shorts(&[0, 1, 2, 0]);
    gltf.data(&[0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0], 3, r#""componentType": 5121, "type": "VEC4""#);
    gltf.data(&[255; 12], 3, r#""componentType": 5121, "type": "VEC4", "normalized": true"#);
    gltf.floats(&[1.0; 32], "MAT4");
    gltf.accessor(
        r#""bufferView": 0, "count": 3, "componentType": 5126, "type": "VEC3", "sparse": {"count": 2,
        "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 2}}"#,
    );
    let rest = r#""scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"children": [1, 2]},
        {"mesh": 0, "rotation": [0, 0, 1, 0]}, {"mesh": 0, "skin": 0}],
        "skins": [{"joints": [0, 1], "inverseBindMatrices": 6}], "meshes": [{"primitives": [
        {"attributes": {"POSITION": 7, "JOINTS_0": 4, "WEIGHTS_0": 5}, "indices": 3, "mode": 5},
        {"attributes": {"POSITION": 0}, "mode": 6}]}]"#;
    let zeros = "A".repeat(4 * gltf.binary().len().div_ceil(3));
    let json = gltf.json(&format!(r#""uri": "data:;base64,{zeros}","#), rest);
    (json.into_bytes(), gltf.glb(rest))
}

#[test]
fn the_valid_files_are_valid() {
    for (format, bytes) in valid() {
        let model = parse(format, &bytes).unwrap_or_else(|error| panic!("{format}: {error}"));
        assert!(model.parts.last().unwrap().triangles.end as usize == model.mesh.triangles().len());
    }
}

/// A change of a file.
#[derive(Clone, Debug)]
enum Damage {
    Flip { at: prop::sample::Index, bits: u8 },
    Digit { at: prop::sample::Index, digit: u8 },
    Truncate { at: prop::sample::Index },
    Remove { at: prop::sample::Index, count: usize },
    Repeat { at: prop::sample::Index, count: usize },
}

fn damage() -> impl Strategy<Value = Damage> {
    let at = any::<prop::sample::Index>;
    prop_oneof![
        3 => (at(), 1u8..).prop_map(|(at, bits)| Damage::Flip { at, bits }),
        4 => (at(), b'-'..=b'9').prop_map(|(at, digit)| Damage::Digit { at, digit }),
        1 => at().prop_map(|at| Damage::Truncate { at }),
        1 => (at(), 1usize..9).prop_map(|(at, count)| Damage::Remove { at, count }),
        1 => (at(), 1usize..99).prop_map(|(at, count)| Damage::Repeat { at, count }),
    ]
}

fn apply(damage: &Damage, bytes: &mut Vec<u8>) {
    let length = bytes.len().max(1);
    bytes.resize(length, 0);
    match *damage {
        Damage::Flip { ref at, bits } => bytes[at.index(length)] ^= bits,
        // Numbers are what hostile files are made of: change the next digit, if there is one.
        Damage::Digit { ref at, digit } => {
            let start = at.index(length);
            if let Some(found) = bytes[start..].iter_mut().find(|byte| byte.is_ascii_digit()) {
                *found = digit;
            }
        }
        Damage::Truncate { ref at } => bytes.truncate(at.index(length)),
        Damage::Remove { ref at, count } => {
            let start = at.index(length);
            bytes.drain(start..(start + count).min(length));
        }
        Damage::Repeat { ref at, count } => {
            let start = at.index(length);
            let piece = bytes[start..(start + count).min(length)].to_vec();
            bytes.splice(start..start, piece);
        }
    }
}

/// A few hundred kilobytes that ask for a hundred million triangles are refused before any is read.
#[test]
fn meshes_are_not_placed_beyond_measure() {
    let mut gltf = Gltf::default();
    gltf.floats(&CORNERS, "VEC3");
    let corners: Vec<u8> = [0, 1, 2].repeat(100_000);
    gltf.data(&corners, corners.len(), r#""componentType": 5121, "type": "SCALAR""#);
    let mesh = r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]"#;
    let bytes = gltf.glb(&format!(r#"{mesh}, "nodes": [{}]"#, [r#"{"mesh": 0}"#; 1000].join(", ")));
    let error = parse(Format::Gltf, &bytes).unwrap_err().to_string();
    assert!(
        error.starts_with("nodes[671]: repeats data until it needs far more memory"),
        "{error}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn damaged_files_never_panic(file in 0usize..8, damages in vec(damage(), 1..6)) {
        let (format, mut bytes) = valid().swap_remove(file);
        damages.iter().for_each(|damage| apply(damage, &mut bytes));
        match parse(format, &bytes) {
            Ok(model) => drop(MeshAdjacency::new(&model.mesh)),
            Err(error) => prop_assert!(!error.to_string().contains('\n')),
        }
    }

    #[test]
    fn noise_never_panics(start in 0usize..8, kept in 0usize..60, noise in vec(any::<u8>(), 0..300)) {
        let (format, mut bytes) = valid().swap_remove(start);
        bytes.truncate(kept);
        bytes.extend(noise);
        if let Err(error) = parse(format, &bytes) {
            prop_assert!(!error.to_string().contains('\n'));
        }
        Format::of_content(&bytes);
    }

    #[test]
    fn polygons_of_any_shape_give_all_their_triangles(
        corners in vec(([-3i8..4, -3i8..4, -1i8..2], any::<bool>()), 3..60),
    ) {
        let mut text = String::new();
        for ([x, y, z], flat) in &corners {
            text += &format!("v {x} {y} {}\n", if *flat { 0 } else { *z });
        }
        let face: Vec<String> = (1..=corners.len()).map(|v| v.to_string()).collect();
        let text = format!("{text}f {}\n", face.join(" "));
        let model = parse(Format::Obj, text.as_bytes()).unwrap();
        prop_assert_eq!(model.mesh.triangles().len(), corners.len() - 2);
        // Whatever the shape, the outline of the triangles is the polygon.
        let mut edges: Vec<(u32, u32, i32)> = model.mesh.triangles().iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
            .map(|(a, b)| if a < b { (a, b, 1) } else { (b, a, -1) })
            .collect();
        edges.sort_unstable();
        let mut outline: Vec<(u32, u32)> = Vec::new();
        for edge in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            match edge.iter().map(|edge| edge.2).sum() {
                0 => {}
                1 => outline.push((edge[0].0, edge[0].1)),
                -1 => outline.push((edge[0].1, edge[0].0)),
                _ => outline.push((u32::MAX, u32::MAX)),
            }
        }
        outline.sort_unstable();
        let count = u32::try_from(corners.len()).unwrap();
        prop_assert_eq!(outline, Vec::from_iter((0..count).map(|i| (i, (i + 1) % count))));
    }
}
