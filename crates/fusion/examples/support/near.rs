//! Viewpoints that Tsiapkolis and Bénard leave out.

use drypoint_mesh::{Mesh, Viewpoint};
use glam::DVec3;

/// Faces over and under which near viewpoints are.
const FACES: usize = 100;

/// How far along their normals.
const OFFSETS: [f64; 7] = [0.0, 0.01, -0.01, 0.1, -0.1, 0.5, -0.5];

/// Near viewpoints anywhere in the box.
const IN_THE_BOX: u32 = 300;

/// On, in and beside the surface.
pub(crate) fn near_viewpoints(mesh: &Mesh) -> Vec<Viewpoint> {
    let faces = mesh.triangles();
    let over = |i: usize| {
        let face = faces[(2 * i + 1) * faces.len() / (2 * FACES)];
        let [a, b, c] = face.map(|vertex| mesh.position(vertex).as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or_zero();
        OFFSETS.map(|offset| (a + b + c) / 3.0 + offset * normal)
    };
    // Evenly spread: multiples of the plastic number's powers (Roberts, 2018), in a box of side 2.
    let inside = |i: u32| {
        let share = (f64::from(i) * DVec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5)).fract();
        let half = mesh.bounds().map_or(DVec3::ZERO, |bounds| bounds.max.as_dvec3());
        half * (2.0 * share - 1.0)
    };
    (0..FACES).flat_map(over).chain((1..=IN_THE_BOX).map(inside)).map(Viewpoint::at).collect()
}
