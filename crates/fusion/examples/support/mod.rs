//! What the tables measure patches by: the viewpoints of Tsiapkolis and Bénard, CGF 2024, §4.3.

use drypoint_mesh::Viewpoint;
use glam::DVec3;

/// The 42 vertices of an icosahedron subdivided once, at distances 5, 10, 25, 50, 75 and 100.
pub(crate) fn far_viewpoints() -> Vec<Viewpoint> {
    let distances = [5.0, 10.0, 25.0, 50.0, 75.0, 100.0];
    let at = |direction: DVec3| distances.map(|distance| Viewpoint::at(distance * direction));
    directions().into_iter().flat_map(at).collect()
}

/// Vertices of an icosahedron subdivided once: its own, and the middles of its edges.
fn directions() -> Vec<DVec3> {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let mut vertices = Vec::new();
    for one in [-1.0, 1.0] {
        for long in [-golden, golden] {
            let (a, b, c) = (0.0, one, long);
            vertices.extend([DVec3::new(a, b, c), DVec3::new(b, c, a), DVec3::new(c, a, b)]);
        }
    }
    let mut directions: Vec<DVec3> = vertices.iter().map(|v| v.normalize()).collect();
    for (i, a) in vertices.iter().enumerate() {
        let neighbours = vertices[..i].iter().filter(|b| a.distance(**b) < 2.1);
        directions.extend(neighbours.map(|b| (a + b).normalize()));
    }
    directions
}
