//! Mesh files of a few triangles that use as much of their formats as such files can, and soups.

use drypoint_mesh::{Mesh, shapes};

type Seeds = Vec<(String, Vec<u8>)>;

fn named<const N: usize>(seeds: [(&str, &str); N]) -> Seeds {
    seeds.map(|(name, text)| (name.to_owned(), text.as_bytes().to_vec())).into()
}

pub(crate) fn obj() -> Seeds {
    named([
        ("square", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"),
        (
            "names",
            "# a\nmtllib a.mtl\no b\nv 0 0 0 1\nv 1 0 0 .5 .5 .5\nv 1 1 0\nv 0 1 0\ng c\nusemtl d\ns 1\n\
             f 1/1 2/1 3/1 4/1\nusemtl e\nf -1//1 -2//2 \\\n -3//3\ng c f\nf 1/1/1 2/1/1 3/1/1\nl 1 2\np 1\n",
        ),
        (
            "concave",
            "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\nf 5 4 3 2 1\nf 1 1 2 3\n",
        ),
        ("ahead", "f 1 2 3\r\nf 3 2 1\r\nv 1e-30 0 0\r\nv +1.5E30 -0.0 .5\r\nv 0 5. 1e39\r\n"),
        (
            "strange",
            "\u{feff}v nan inf -inf\nv 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 2 3 4 # b\nf 9 1 2\n",
        ),
    ])
}

pub(crate) fn ply() -> Seeds {
    let vertex = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    let face = "element face 1\nproperty list uchar int vertex_indices\n";
    let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    let rows = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
    let mut seeds = named([
        ("ascii", &format!("ply\nformat ascii 1.0\n{vertex}{face}end_header\n{rows}4 0 1 3 2\n")),
        (
            "strips",
            &format!(
                "ply\nformat ascii 1.0\ncomment a\nobj_info b\n{vertex}{strips}end_header\n{rows}\
                 7 0 1 2 -1 2 1 3\n"
            ),
        ),
        (
            "others",
            &format!(
                "ply\r\nformat ascii 1.0\r\n{face}element vertex 3\nproperty double z\nproperty int8 a\n\
                 property list uint8 ushort b\nproperty double y\nproperty double x\nelement c 2\n\
                 property uint d\nend_header\n3 0 1 2\n0 -1 2 5 6 1e30 nan\n1 2 0 1 2\n3 4 1 9 5 6\n7\n8\n"
            ),
        ),
    ]);
    for (encoding, is_big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let text = format!("ply\nformat {encoding} 1.0\n{vertex}{face}{strips}end_header\n");
        let mut bytes = text.into_bytes();
        let mut number = |mut four: [u8; 4]| {
            if is_big {
                four.reverse();
            }
            bytes.extend(four);
        };
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.5f32]
            .iter()
            .for_each(|x| number(x.to_le_bytes()));
        bytes.push(4);
        let mut number = |mut four: [u8; 4]| {
            if is_big {
                four.reverse();
            }
            bytes.extend(four);
        };
        [0, 1, 3, 2, 7, 0, 1, 2, -1, 2, 1, 3i32].iter().for_each(|i| number(i.to_le_bytes()));
        seeds.push((encoding.to_owned(), bytes));
    }
    seeds
}

pub(crate) fn stl() -> Seeds {
    let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    let mut seeds = named([
        ("text", &format!("solid a\n{facet}endsolid a\n")),
        (
            "solids",
            &format!(
                "solid a\n{facet}{facet}endsolid\n\nSOLID\n{facet}endsolid b\nsolid c\nendsolid\n"
            ),
        ),
        ("numbers", &format!("solid\n{}endsolid\n", facet.replace("1 0 0", "nan 1e-30 1e39"))),
    ]);
    for (name, header) in [("binary", "a"), ("solid", "solid b")] {
        let mut bytes = header.as_bytes().to_vec();
        bytes.resize(80, 0);
        bytes.extend(2u32.to_le_bytes());
        for z in [0.0, 1.0f32] {
            bytes.extend([0; 12]);
            let corners = [0.0, 0.0, z, 1.0, 0.0, z, 0.0, 1.0, z];
            bytes.extend(corners.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        seeds.push((name.to_owned(), bytes));
    }
    seeds
}

/// One triangle: three positions, indices, joints, weights and two matrices.
fn buffer() -> Vec<u8> {
    let mut bytes: Vec<u8> = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0f32]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    bytes.extend([0, 0, 1, 0, 2, 0, 0, 0]);
    bytes.extend([0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0]);
    bytes.extend([255, 0, 0, 0, 128, 127, 0, 0, 255, 0, 0, 0]);
    for _ in 0..2 {
        bytes.extend(
            (0..16).map(|i| if i % 5 == 0 { 1.0f32 } else { 0.0 }).flat_map(f32::to_le_bytes),
        );
    }
    // Two keys of an animation and their translations.
    bytes.extend([0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0f32].iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

const VIEWS: &str = r#""bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8},
{"buffer":0,"byteOffset":44,"byteLength":12,"byteStride":4},{"buffer":0,"byteOffset":56,"byteLength":12},
{"buffer":0,"byteOffset":68,"byteLength":128},{"buffer":0,"byteOffset":196,"byteLength":8},
{"buffer":0,"byteOffset":204,"byteLength":24}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},
{"bufferView":2,"componentType":5121,"count":3,"type":"VEC4"},
{"bufferView":3,"componentType":5121,"count":3,"type":"VEC4","normalized":true},
{"bufferView":4,"componentType":5126,"count":2,"type":"MAT4"},
{"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,
"indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":0}}},
{"bufferView":5,"componentType":5126,"count":2,"type":"SCALAR"},
{"bufferView":6,"componentType":5126,"count":2,"type":"VEC3"}]"#;

const SCENES: [(&str, &str); 4] = [
    (
        "plain",
        r#""meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"nodes":[{"mesh":0}]"#,
    ),
    (
        "skinned",
        r#""scene":0,"scenes":[{"nodes":[0]}],"skins":[{"joints":[1,0],"inverseBindMatrices":4,"skeleton":0}],
"nodes":[{"children":[1,2]},{"name":"j","rotation":[0,0,1,0],"translation":[0,0,1]},{"mesh":0,"skin":0}],
"meshes":[{"name":"m","weights":[0],"primitives":[{"attributes":{"POSITION":5,"JOINTS_0":2,"WEIGHTS_0":3},"mode":5,
"material":0,"targets":[{"POSITION":0}]},{"attributes":{"POSITION":0},"mode":6}]}],"materials":[{"name":"red"}],
"animations":[{"channels":[{"sampler":0,"target":{"node":1,"path":"translation"}}],"samplers":[{"input":6,
"interpolation":"LINEAR","output":7}]}]"#,
    ),
    (
        "tree",
        r#""scenes":[{"nodes":[0]},{"nodes":[2]}],"nodes":[{"children":[1],"scale":[-1,2,3]},{"mesh":0,
"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1]},{"mesh":0,"name":"n"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":0},"mode":4},{"attributes":{"POSITION":0},"mode":1}]}],
"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"]"#,
    ),
    (
        "moving",
        r#""nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"animations":[{"name":"turn",
"channels":[{"sampler":0,"target":{"node":0,"path":"scale"}},{"sampler":1,"target":{"node":0,"path":"rotation"}}],
"samplers":[{"input":6,"output":7,"interpolation":"STEP"},{"input":6,"output":3}]}]"#,
    ),
];

pub(crate) fn gltf() -> Seeds {
    let binary = buffer();
    let length = binary.len();
    let uri = format!("data:application/octet-stream;base64,{}", base64(&binary));
    let mut seeds = Seeds::new();
    for (name, scene) in SCENES {
        let json = |uri: &str| {
            format!(
                r#"{{"asset":{{"version":"2.0"}},"buffers":[{{{uri}"byteLength":{length}}}],{VIEWS},{scene}}}"#
            )
        };
        seeds.push((format!("{name}.gltf"), json(&format!(r#""uri":"{uri}","#)).into_bytes()));
        seeds.push((format!("{name}.glb"), glb(&json(""), &binary)));
    }
    seeds
}

fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (name, chunk, filler) in [(b"JSON", json.as_bytes(), b' '), (b"BIN\0", binary, 0)] {
        let length = chunk.len().next_multiple_of(4);
        bytes.extend((length as u32).to_le_bytes());
        bytes.extend(name);
        bytes.extend(chunk);
        bytes.resize(bytes.len() + length - chunk.len(), filler);
    }
    let length = (bytes.len() as u32).to_le_bytes();
    bytes[8..12].copy_from_slice(&length);
    bytes
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let word = three.iter().fold(0u32, |word, &byte| word << 8 | u32::from(byte));
        let word = word << (8 * (3 - three.len()));
        for place in 0..=three.len() {
            text.push(char::from(LETTERS[(word >> (18 - 6 * place) & 63) as usize]));
        }
        text.extend(std::iter::repeat_n('=', 3 - three.len()));
    }
    text
}

/// Small shapes as the soup spells them: vertices as f32, faces, then viewpoints of each kind.
pub(crate) fn soups() -> Seeds {
    let shapes = [
        ("cube", shapes::cube()),
        ("book", shapes::book(5)),
        ("folded-sheet", shapes::folded_sheet()),
        ("fan", shapes::zero_area_fan()),
        ("tetrahedron", shapes::tetrahedron()),
        ("icosphere", shapes::icosphere(20)),
        ("strip", shapes::mobius_strip(16)),
        ("slivers", shapes::sliver_sphere(20)),
        ("grid", shapes::open_grid(8)),
        ("tiny", shapes::tiny_sphere(20)),
        ("huge", shapes::huge_sphere(20)),
        ("moved", shapes::moved_sphere(20)),
    ];
    let numbered = shapes.into_iter().enumerate();
    numbered.map(|(preset, (name, mesh))| (name.to_owned(), soup(preset as u8, &mesh))).collect()
}

fn soup(preset: u8, mesh: &Mesh) -> Vec<u8> {
    let mut bytes = vec![preset];
    for position in mesh.positions() {
        bytes.push(3);
        bytes.extend(position.to_array().iter().flat_map(|x| x.to_le_bytes()));
    }
    for triangle in mesh.triangles() {
        bytes.push(7);
        bytes.extend(triangle.map(|v| v as u8));
    }
    bytes.extend([12, 0, 20, 30, 40, 0, 0]);
    bytes.extend([13, 1, 2, 1, 0, 0, 0]);
    bytes.extend([13, 2, 20, 251, 0, 0, 0]);
    bytes.extend([14, 3, 2, 1, 1, 80, 0]);
    bytes.extend([15, 0, 1, 2, 253, 0, 0]);
    bytes.extend([15, 2, 1, 3, 0, 0, 0]);
    bytes
}
