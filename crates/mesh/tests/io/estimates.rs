//! What files are expected to hold, before they are read.

use std::fmt::Write as _;
use std::fs;

use drypoint_mesh::io::{Estimate, estimate, read};
use drypoint_mesh::{Mesh, shapes};

use crate::files::{binary_stl, ply};

/// Expects of a file what is in it, within so many percent.
#[track_caller]
fn check(name: &str, bytes: &[u8], percent: u64) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    let found = estimate(&path).unwrap().unwrap();
    let mesh = read(&path).unwrap().mesh;
    assert_eq!(found.bytes, bytes.len() as u64);
    for (found, there) in [
        (found.vertices, mesh.positions().len() as u64),
        (found.triangles, mesh.triangles().len() as u64),
    ] {
        assert!(100 * found.abs_diff(there) <= percent * there, "{name}: {found} for {there}");
    }
}

fn obj(mesh: &Mesh) -> String {
    let mut text = String::new();
    for p in mesh.positions() {
        writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap();
    }
    for t in mesh.triangles() {
        writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1).unwrap();
    }
    text
}

const DECLARATIONS: &str = "property float x\nproperty float y\nproperty float z\nelement face";

#[test]
fn files_hold_about_what_is_expected() {
    // Some times as large as what is looked at.
    let mesh = shapes::bumpy_sphere(200_000);
    let [vertices, faces] = [mesh.positions().len(), mesh.triangles().len()];
    let text = obj(&mesh);
    check("large.obj", text.as_bytes(), 10);
    check("small.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3", 0);

    let header = format!("element vertex {vertices}\n{DECLARATIONS} {faces}");
    let text = text.replace("v ", "").replace("f ", "3 ");
    let lines: Vec<&str> =
        text.lines().take(vertices).chain((0..faces).map(|_| "3 0 1 2")).collect();
    let list = "\nproperty list uchar int vertex_indices";
    check("large.ply", (ply("ascii", &(header.clone() + list)) + &lines.join("\n")).as_bytes(), 0);
    for corners in [3u8, 4] {
        let mut bytes = ply("binary_little_endian", &(header.clone() + list)).into_bytes();
        let positions = mesh.positions().iter().flat_map(|p| p.to_array());
        bytes.extend(positions.flat_map(f32::to_le_bytes));
        for _ in 0..faces {
            bytes.push(corners);
            bytes.extend((0..u32::from(corners)).flat_map(u32::to_le_bytes));
        }
        check("quads.ply", &bytes, 0);
    }

    let corners: Vec<[f32; 3]> =
        mesh.triangles().iter().flatten().map(|&v| mesh.position(v).to_array()).collect();
    check("binary.stl", &binary_stl(b"", &corners), 0);
    let mut text = "solid\n".to_owned();
    for facet in corners.chunks_exact(3) {
        text += "facet normal 0 0 1\nouter loop\n";
        for [x, y, z] in facet {
            writeln!(text, "vertex {x} {y} {z}").unwrap();
        }
        text += "endloop\nendfacet\n";
    }
    check("text.stl", (text + "endsolid\n").as_bytes(), 5);
}

#[test]
fn headers_are_not_believed() {
    let folder = tempfile::tempdir().unwrap();
    let expect = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        estimate(&path).unwrap()
    };
    let header = format!(
        "element vertex 3\n{DECLARATIONS} 2147483648\nproperty list uchar int vertex_indices"
    );
    for encoding in ["ascii", "binary_big_endian"] {
        let bytes = ply(encoding, &header).into_bytes();
        let found = expect("a.ply", &[bytes, vec![0; 1000]].concat()).unwrap();
        assert!(found.vertices <= 3 && found.triangles < 1000, "{found:?}");
    }
    let mut stl = binary_stl(b"", &[[0.0; 3]; 3]);
    stl[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let found = expect("a.stl", &stl).unwrap();
    assert_eq!(found, Estimate { bytes: 134, vertices: 6, triangles: 2 });
    assert_eq!(expect("a.ply", b"plywood"), None);
    assert_eq!(expect("a.glb", b"glTF"), None);
    assert_eq!(expect("a.obj", b"").unwrap(), Estimate::default());
    assert_eq!(estimate(folder.path()).unwrap(), None);
    assert!(estimate(&folder.path().join("missing.obj")).is_err());
}
