//! Spheres with what goes wrong in real files.

use glam::{DVec3, Vec3};

use super::{build, bumpy_sphere, icosphere, wish};
use crate::Mesh;

/// An [`icosphere`] whose triangles each have three vertices of their own, as STL files do. Closed
/// once its vertices are welded.
pub fn split_sphere(triangles: usize) -> Mesh {
    let sphere = icosphere(triangles);
    let positions = sphere.triangles().iter().flatten().map(|&v| sphere.position(v)).collect();
    let own = (0..).zip(sphere.triangles()).map(|(t, _): (u32, _)| [3 * t, 3 * t + 1, 3 * t + 2]);
    build(positions, own.collect())
}

/// An [`icosphere`] with every seventh triangle turned over, the first one among them: around those
/// two faces disagree at every edge.
pub fn flipped_sphere(triangles: usize) -> Mesh {
    let sphere = icosphere(triangles);
    let flip = |(t, &[a, b, c]): (usize, &[u32; 3])| if t % 7 == 0 { [a, c, b] } else { [a, b, c] };
    let flipped = sphere.triangles().iter().enumerate().map(flip).collect();
    build(sphere.positions().to_vec(), flipped)
}

/// An [`icosphere`] with every fifth triangle there twice, the first one among them: edges of three
/// faces. The count includes them.
pub fn duplicated_sphere(triangles: usize) -> Mesh {
    let wish = wish(triangles) as usize;
    let sphere = icosphere(wish - wish / 6);
    let twice = sphere.triangles().iter().step_by(5);
    let all = sphere.triangles().iter().chain(twice).copied().collect();
    build(sphere.positions().to_vec(), all)
}

/// A closed sphere with three kinds of faces without area among its own; the surface is that of an
/// [`icosphere`] rounded to multiples of 2⁻²⁰.
///
/// Of every nine triangles, by index, the first is cut in two at the middle of its first edge, and
/// a triangle of three *collinear* vertices fills the slit; the fourth gets a second vertex at
/// the position of its second, joined by two *collapsed* triangles; and beside the seventh there
/// is one that names a vertex twice. Welded, every edge still has two faces. The count includes
/// them, to within a ninth.
pub fn sliver_sphere(triangles: usize) -> Mesh {
    // Nine triangles become 9 + 2 + 2 + 1.
    let wish = wish(triangles) as usize;
    let sphere = icosphere(wish - wish / 14 * 5);
    // 21 bits at most, so that the middle of two positions is exact.
    let round = |p: &Vec3| (*p * 1_048_576.0).round() / 1_048_576.0;
    let mut positions: Vec<Vec3> = sphere.positions().iter().map(round).collect();
    let mut all = Vec::with_capacity(sphere.triangles().len() / 9 * 14 + 14);
    for (t, &[a, b, c]) in sphere.triangles().iter().enumerate() {
        let mut add_vertex = |position| {
            positions.push(position);
            u32::try_from(positions.len() - 1).expect("a shape has fewer vertices than triangles")
        };
        let [at_a, at_b] = [a, b].map(|v| round(&sphere.position(v)));
        match t % 9 {
            0 => {
                let middle = add_vertex(at_a.midpoint(at_b));
                all.extend([[a, middle, c], [middle, b, c], [a, b, middle]]);
            }
            3 => {
                let twin = add_vertex(at_b);
                all.extend([[a, twin, c], [a, b, twin], [twin, b, c]]);
            }
            6 => all.extend([[a, b, c], [a, a, b]]),
            _ => all.push([a, b, c]),
        }
    }
    build(positions, all)
}

/// A [`bumpy_sphere`] around (10⁴, −2·10⁴, 3·10⁴), where f32 steps are 2⁻¹⁰ to 2⁻⁹: up to some
/// thousand triangles it stays a closed surface with rough edges, far more of them collapse.
pub fn moved_sphere(triangles: usize) -> Mesh {
    mapped(&bumpy_sphere(triangles), |p| p + DVec3::new(1e4, -2e4, 3e4))
}

/// A [`bumpy_sphere`] of radius about 10⁻²⁰.
pub fn tiny_sphere(triangles: usize) -> Mesh {
    mapped(&bumpy_sphere(triangles), |p| 1e-20 * p)
}

/// A [`bumpy_sphere`] of radius about 10²⁰.
pub fn huge_sphere(triangles: usize) -> Mesh {
    mapped(&bumpy_sphere(triangles), |p| 1e20 * p)
}

/// A [`bumpy_sphere`] of radius about 10⁻³⁰.
pub fn dust_sphere(triangles: usize) -> Mesh {
    mapped(&bumpy_sphere(triangles), |p| 1e-30 * p)
}

/// A [`bumpy_sphere`] of radius about 10³⁰.
pub fn vast_sphere(triangles: usize) -> Mesh {
    mapped(&bumpy_sphere(triangles), |p| 1e30 * p)
}

/// A [`bumpy_sphere`] around (3·10⁶, 2·10⁶, −3·10⁶), a million times its size away, where f32 steps are 2⁻³
/// to 2⁻²: what was a sphere is some blocks, with collapsed faces, faces without area and faces upon each
/// other.
pub fn far_sphere(triangles: usize) -> Mesh {
    mapped(&bumpy_sphere(triangles), |p| p + DVec3::new(3e6, 2e6, -3e6))
}

fn mapped(mesh: &Mesh, map: impl Fn(DVec3) -> DVec3) -> Mesh {
    let positions = mesh.positions().iter().map(|p| map(p.as_dvec3()).as_vec3()).collect();
    build(positions, mesh.triangles().to_vec())
}
