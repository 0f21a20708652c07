//! Shapes of a few triangles, each with one property that is easy to see by hand.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use super::{build, wish};
use crate::Mesh;

/// No vertex and no triangle.
pub fn empty() -> Mesh {
    Mesh::default()
}

/// The triangle (0, 0, 0), (1, 0, 0), (0, 1, 0), seen from +z: three boundary edges.
pub fn one_triangle() -> Mesh {
    mesh(&[[0, 0, 0], [1, 0, 0], [0, 1, 0]], vec![[0, 1, 2]])
}

/// The tetrahedron on four corners of the cube −1 ..= 1. Closed.
pub fn tetrahedron() -> Mesh {
    let triangles = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    mesh(&[[1, 1, 1], [-1, -1, 1], [1, -1, -1], [-1, 1, -1]], triangles)
}

/// The cube −1 ..= 1: 12 triangles, 12 convex edges, and a flat one across each side. Closed.
pub fn cube() -> Mesh {
    let positions: [[i8; 3]; 8] =
        [0, 1, 2, 3, 4, 5, 6, 7].map(|bits| [0, 1, 2].map(|axis| 2 * (bits >> axis & 1) - 1));
    mesh(&positions, BOX.to_vec())
}

/// Triangles of a box whose corner i has the bits of i, x lowest, as coordinates.
const BOX: [[u32; 3]; 12] = [
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
];

/// Two unit cubes at opposite sides of their one common edge, from (0, 0, 0) to (0, 0, 1): an edge
/// of four faces, its vertices shared.
pub fn cubes_sharing_an_edge() -> Mesh {
    let corner = |lowest: i8| move |i: i8| [(i & 1) + lowest, (i >> 1 & 1) + lowest, i >> 2];
    let first = [0, 1, 2, 3, 4, 5, 6, 7].map(corner(0));
    let positions = [first.as_slice(), &[0, 1, 2, 4, 5, 6].map(corner(-1))].concat();
    // Corners 3 and 7 of the second cube are corners 0 and 4 of the first.
    const SECOND: [u32; 8] = [8, 9, 10, 0, 11, 12, 13, 4];
    let second = BOX.map(|triangle| triangle.map(|corner| SECOND[corner as usize]));
    mesh(&positions, [BOX, second].concat())
}

/// `pages` triangles on one edge, the z axis from −1 to 1, spread over half a turn: an edge of
/// `pages` faces. Every other page is turned over, so that neighbours agree on their winding.
pub fn book(pages: usize) -> Mesh {
    let pages = wish(pages);
    let page = |page: u32| {
        let (sin, cos) = (PI * f64::from(page) / f64::from(pages)).sin_cos();
        DVec3::new(cos, sin, 0.0).as_vec3()
    };
    let positions = [Vec3::NEG_Z, Vec3::Z].into_iter().chain((0..pages).map(page)).collect();
    let triangle = |page| if page % 2 == 0 { [0, 1, page + 2] } else { [1, 0, page + 2] };
    build(positions, (0..pages).map(triangle).collect())
}

/// Two triangles back to back on the same three vertices. Closed, of volume 0; its three edges are
/// flat by their vertices, but folds: contours from everywhere outside the plane z = 0.
pub fn folded_sheet() -> Mesh {
    mesh(&[[0, 0, 0], [2, 0, 0], [0, 2, 0]], vec![[0, 1, 2], [0, 2, 1]])
}

/// Eight triangles around the origin, all along the x axis: no face has an area.
pub fn zero_area_fan() -> Mesh {
    let positions: Vec<[i8; 3]> = (0..10).map(|x| [x, 0, 0]).collect();
    mesh(&positions, (1..9).map(|i| [0, i, i + 1]).collect())
}

fn mesh(positions: &[[i8; 3]], triangles: Vec<[u32; 3]>) -> Mesh {
    let position = |p: &[i8; 3]| Vec3::from_array(p.map(f32::from));
    build(positions.iter().map(position).collect(), triangles)
}
