//! Spheres, smooth and bumpy, of any number of triangles.

use glam::DVec3;

use super::{build, wish};
use crate::Mesh;

/// A geodesic sphere of radius 1 around the origin: the icosahedron, each face cut into n²
/// triangles and pushed out onto the sphere. Closed.
///
/// n ≥ 1 is chosen so that 20 n² comes nearest to `triangles`. Vertices are shared; only sums,
/// products and square roots go into them, so they are the same on every machine. Linear: 10 M
/// triangles take half a second.
pub fn icosphere(triangles: usize) -> Mesh {
    let sphere = Icosphere::new(triangles);
    build(sphere.directions().map(|d| d.as_vec3()).collect(), sphere.triangles())
}

/// An [`icosphere`] with hills and valleys of up to a third of its radius: three octaves of smooth
/// noise along the radius. Closed, without self-intersection, with convex and concave edges.
///
/// The noise is the same for every count, so a larger count is the same ball in more detail.
pub fn bumpy_sphere(triangles: usize) -> Mesh {
    let sphere = Icosphere::new(triangles);
    let bump = |d: DVec3| ((1.0 + 0.33 * octaves(d)) * d).as_vec3();
    build(sphere.directions().map(bump).collect(), sphere.triangles())
}

/// The icosahedron's corners, up to their length.
fn corners() -> [DVec3; 12] {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let signs = [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)];
    std::array::from_fn(|corner| {
        let (short, long) = signs[corner % 4];
        match corner / 4 {
            0 => DVec3::new(short, long, 0.0),
            1 => DVec3::new(0.0, short, long),
            _ => DVec3::new(long, 0.0, short),
        }
    })
}

/// The icosahedron's faces, counter-clockwise from outside.
const FACES: [[u32; 3]; 20] = [
    [0, 11, 5],
    [0, 5, 1],
    [0, 1, 7],
    [0, 7, 10],
    [0, 10, 11],
    [1, 5, 9],
    [5, 11, 4],
    [11, 10, 2],
    [10, 7, 6],
    [7, 1, 8],
    [3, 9, 4],
    [3, 4, 2],
    [3, 2, 6],
    [3, 6, 8],
    [3, 8, 9],
    [4, 9, 5],
    [2, 4, 11],
    [6, 2, 10],
    [8, 6, 7],
    [9, 8, 1],
];

/// Numbers the vertices of the cut icosahedron: 12 corners, then n − 1 on each edge, then
/// (n − 1)(n − 2)/2 inside each face.
struct Icosphere {
    n: u32,
    /// Ends of the 30 edges, lower corner first.
    edges: Vec<[u32; 2]>,
    /// The edge between two corners.
    edge_between: [[u32; 12]; 12],
}

impl Icosphere {
    fn new(triangles: usize) -> Self {
        let wish = wish(triangles);
        let count = |n: u32| 20 * n * n;
        let mut n = (wish / 20).isqrt().max(1);
        if count(n + 1).abs_diff(wish) < count(n).abs_diff(wish) {
            n += 1;
        }
        let directed = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
        let mut edges: Vec<_> = FACES.into_iter().flat_map(directed).collect();
        // Each edge is met once in each direction.
        edges.retain(|[low, high]| low < high);
        let mut edge_between = [[0; 12]; 12];
        for (edge, &[low, high]) in (0..).zip(&edges) {
            edge_between[low as usize][high as usize] = edge;
            edge_between[high as usize][low as usize] = edge;
        }
        Self { n, edges, edge_between }
    }

    /// Unit vectors of all vertices, in the order of their numbers.
    fn directions(&self) -> impl Iterator<Item = DVec3> + '_ {
        let (n, corners) = (self.n, corners());
        let on_edge = move |ends: &[u32; 2]| {
            let [low, high] = ends.map(|corner| corners[corner as usize]);
            (1..n).map(move |k| f64::from(n - k) * low + f64::from(k) * high)
        };
        let in_face = move |face: [u32; 3]| {
            let [a, b, c] = face.map(|corner| corners[corner as usize]);
            let row = move |j: u32| {
                (1..n - j)
                    .map(move |i| f64::from(n - i - j) * a + f64::from(i) * b + f64::from(j) * c)
            };
            (1..n).flat_map(row)
        };
        let on_edges = self.edges.iter().flat_map(on_edge);
        let all = corners.into_iter().chain(on_edges).chain(FACES.into_iter().flat_map(in_face));
        all.map(DVec3::normalize)
    }

    fn triangles(&self) -> Vec<[u32; 3]> {
        let n = self.n;
        let mut triangles = Vec::with_capacity(20 * (n * n) as usize);
        for face in 0..20 {
            for j in 0..n {
                for i in 0..n - j {
                    let at = |i, j| self.vertex(face, i, j);
                    triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                    if i + j + 1 < n {
                        triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                    }
                }
            }
        }
        triangles
    }

    /// Number of the vertex i steps along the face's first edge and j along its last.
    fn vertex(&self, face: u32, i: u32, j: u32) -> u32 {
        let n = self.n;
        let [a, b, c] = FACES[face as usize];
        let on_edge = |tail: u32, head: u32, from_tail: u32| {
            let from_low = if tail < head { from_tail } else { n - from_tail };
            12 + self.edge_between[tail as usize][head as usize] * (n - 1) + from_low - 1
        };
        match (n - i - j, i, j) {
            (_, 0, 0) => a,
            (0, _, 0) => b,
            (0, 0, _) => c,
            (_, _, 0) => on_edge(a, b, i),
            (0, _, _) => on_edge(b, c, j),
            (_, 0, _) => on_edge(a, c, j),
            _ => {
                // Row j of the inside has n − 1 − j vertices.
                let before = (j - 1) * (n - 1) - j * (j - 1) / 2;
                12 + 30 * (n - 1) + face * ((n - 1) * (n - 2) / 2) + before + i - 1
            }
        }
    }
}

/// Smooth noise within −1 ..= 1, of three octaves.
fn octaves(p: DVec3) -> f64 {
    [(2.0, 0.6), (4.0, 0.28), (8.0, 0.12)]
        .into_iter()
        .map(|(frequency, amplitude)| amplitude * noise(frequency * p))
        .sum()
}

/// Values at the corners of the unit lattice, within −1 ..= 1, blended with continuous second
/// derivative (Perlin, Improving Noise, SIGGRAPH 2002, eq. 2).
fn noise(p: DVec3) -> f64 {
    let cell = p.floor();
    let at = p - cell;
    let [u, v, w] = at.to_array().map(|t| t * t * t * (t * (6.0 * t - 15.0) + 10.0));
    let value = |x, y, z| lattice_value(cell + DVec3::new(x, y, z));
    let lerp = |a: f64, b: f64, t: f64| a + t * (b - a);
    let along_x = |y, z| lerp(value(0.0, y, z), value(1.0, y, z), u);
    let along_y = |z| lerp(along_x(0.0, z), along_x(1.0, z), v);
    lerp(along_y(0.0), along_y(1.0), w)
}

/// A value within −1 ..= 1 that looks random, the same for the same lattice point: the bits of its
/// coordinates through the finalizer of SplitMix64.
fn lattice_value(point: DVec3) -> f64 {
    // Adding 0 turns −0 into 0.
    let mut hash = point.to_array().into_iter().fold(1u64, |hash, x| {
        (hash ^ (x + 0.0).to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
    });
    hash = (hash ^ (hash >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    hash = (hash ^ (hash >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    // The upper 52 bits as the fraction of a number in 1 .. 2.
    2.0 * (f64::from_bits((hash >> 12) | 1f64.to_bits()) - 1.0) - 1.0
}
