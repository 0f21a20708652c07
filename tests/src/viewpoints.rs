//! From where meshes are looked at.

use drypoint_mesh::{Mesh, Viewpoint};
use fastrand::Rng;
use glam::{DVec3, Vec3};

/// Distances of the measuring protocol of Tsiapkolis and Bénard (CGF 2024, §4.3), in units of half
/// the longest side of the mesh's box.
pub const DISTANCES: [f64; 6] = [5.0, 10.0, 25.0, 50.0, 75.0, 100.0];

/// The 42 vertices of an icosahedron subdivided once, on the unit sphere.
pub fn directions() -> Vec<DVec3> {
    // The vertices of an icosahedron: all (0, ±1, ±φ) and their cyclic permutations.
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut corners = Vec::new();
    for (i, j) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        corners.push(DVec3::new(0.0, i, j * golden));
        corners.push(DVec3::new(i, j * golden, 0.0));
        corners.push(DVec3::new(j * golden, 0.0, i));
    }
    // Its edges are 2 long; the next distance between corners is 2 φ.
    let mut directions = corners.clone();
    for (index, a) in corners.iter().enumerate() {
        let neighbours = corners[index + 1..].iter().filter(|b| a.distance(**b) < 2.5);
        directions.extend(neighbours.map(|b| a + b));
    }
    directions.into_iter().map(DVec3::normalize).collect()
}

/// The 252 viewpoints of the protocol: 42 directions × 6 distances around the mesh. Empty for a
/// mesh without triangles.
pub fn protocol(mesh: &Mesh) -> Vec<Viewpoint> {
    let Some(bounds) = mesh.bounds() else { return Vec::new() };
    let (center, unit) = (bounds.center(), bounds.half_longest_side());
    let around = |distance: f64| {
        directions().into_iter().map(move |d| Viewpoint::at(center + unit * distance * d))
    };
    DISTANCES.into_iter().flat_map(around).collect()
}

/// A spiral of ten turns around the mesh from the lower pole to the upper, ten half-lengths away. Empty
/// for a mesh without triangles.
pub fn spiral(mesh: &Mesh, count: usize) -> Vec<Viewpoint> {
    let Some(bounds) = mesh.bounds() else { return Vec::new() };
    let (center, unit) = (bounds.center(), bounds.half_longest_side());
    let viewpoint = |index: usize| {
        let along = index as f64 / count.saturating_sub(1).max(1) as f64;
        let (sin, cos) = (20.0 * std::f64::consts::PI * along).sin_cos();
        let height = 2.0 * along - 1.0;
        let radius = (1.0 - height * height).sqrt();
        Viewpoint::at(center + 10.0 * unit * DVec3::new(radius * cos, radius * sin, height))
    };
    (0..count).map(viewpoint).collect()
}

/// Orthographic views: the 42 directions and the six axes, which many faces of made things graze.
pub fn orthographic() -> Vec<Viewpoint> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    directions().into_iter().chain(axes).map(Viewpoint::from_direction).collect()
}

/// Viewpoints where ties and near misses live: on vertices, on edges, on faces, in the planes of
/// faces outside them, a hair beside those planes, and in the middle of the mesh. About `6 * count`
/// of them, spread over the mesh's triangles.
pub fn hostile(mesh: &Mesh, count: usize) -> Vec<Viewpoint> {
    let Some(bounds) = mesh.bounds() else { return Vec::new() };
    let triangles = mesh.triangles();
    let mut viewpoints = vec![Viewpoint::at(bounds.center())];
    for index in 0..count.min(triangles.len()) {
        let triangle = triangles[index * triangles.len() / count.min(triangles.len())];
        let [a, b, c] = triangle.map(|v| mesh.position(v).as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let hair = 1e-7 * (a.length() + (b - a).length());
        let outside = a + 7.0 * (b - a) - 5.0 * (c - a);
        let middle = (a + b + c) / 3.0;
        viewpoints.extend(
            [a, 0.5 * (a + b), middle, outside, outside + hair * normal, outside - hair * normal]
                .map(Viewpoint::at),
        );
    }
    viewpoints
}

/// Viewpoints on, in and beside the surface, which the protocol leaves out: at a few distances
/// along the normals of triangles spread over the mesh, in units of half the longest side.
pub fn near(mesh: &Mesh, count: usize) -> Vec<Viewpoint> {
    let Some(bounds) = mesh.bounds() else { return Vec::new() };
    let triangles = mesh.triangles();
    let count = count.min(triangles.len());
    let mut viewpoints = Vec::new();
    for index in 0..count {
        let corners: [Vec3; 3] =
            triangles[index * triangles.len() / count].map(|v| mesh.position(v));
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let heights = [-0.1, 0.0, 0.01, 0.1, 0.5, 1.0];
        let height = heights[index % heights.len()] * bounds.half_longest_side();
        viewpoints.push(Viewpoint::at((a + b + c) / 3.0 + height * normal));
    }
    viewpoints
}

/// Viewpoints at random on, in and beside the surface: on vertices and faces, from a
/// ten-millionth to one half of the longest side off them along their normals to either side, and
/// anywhere in the box. The same each time. Empty for a mesh without triangles.
pub fn near_at_random(mesh: &Mesh, count: usize) -> Vec<Viewpoint> {
    let Some(bounds) = mesh.bounds().filter(|_| !mesh.triangles().is_empty()) else {
        return Vec::new();
    };
    let (center, unit) = (bounds.center(), bounds.half_longest_side());
    let mut rng = Rng::with_seed(0);
    let viewpoint = |_| {
        let triangle = mesh.triangles()[rng.usize(..mesh.triangles().len())];
        let [a, b, c] = triangle.map(|v| mesh.position(v).as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let (s, t) = (rng.f64(), rng.f64());
        let on_face = a + s * (b - a) + t * (1.0 - s) * (c - a);
        let height = if rng.bool() { unit } else { -unit } * 10f64.powf(-7.0 * rng.f64());
        Viewpoint::at(match rng.u8(..8) {
            0 => a,
            1 => on_face,
            2 => center + unit * DVec3::from_array(std::array::from_fn(|_| 2.0 * rng.f64() - 1.0)),
            3 => a + height * normal,
            _ => on_face + height * normal,
        })
    };
    (0..count).map(viewpoint).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use drypoint_mesh::shapes;

    #[test]
    fn there_are_42_directions_all_different() {
        let directions = directions();
        assert_eq!(directions.len(), 42);
        for (index, a) in directions.iter().enumerate() {
            assert!(directions[..index].iter().all(|b| a.distance(*b) > 0.5), "{a} twice");
        }
        assert!(directions.iter().sum::<DVec3>().length() < 1e-9, "not even");
    }

    #[test]
    fn the_spiral_goes_from_pole_to_pole() {
        let mesh = shapes::icosphere(20);
        let unit = mesh.bounds().unwrap().half_longest_side();
        let spiral = spiral(&mesh, 100);
        assert_eq!(spiral.len(), 100);
        assert!(spiral.iter().all(|v| (v.xyz().length() - 10.0 * unit).abs() < 1e-6));
        assert!(spiral[0].xyz().z < -9.9 * unit && spiral[99].xyz().z > 9.9 * unit);
        let steps = spiral.windows(2).map(|pair| pair[0].xyz().distance(pair[1].xyz()));
        assert!(steps.fold(0.0, f64::max) < 8.0 * unit);
    }

    #[test]
    fn the_protocol_has_252_viewpoints() {
        assert_eq!(protocol(&shapes::icosphere(20)).len(), 252);
    }
}
