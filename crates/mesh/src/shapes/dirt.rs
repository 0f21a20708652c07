//! What exports, joins and conversions of units leave behind, beyond one defect on one sphere.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::{build, icosphere, wish};
use crate::Mesh;

/// An [`icosphere`] among vertices that no triangle uses: one before each of its own, far out, near
/// or upon it; the last ones are at the end of f32. Every third of its vertices is there twice, and
/// triangles name one or the other.
pub fn littered_sphere(triangles: usize) -> Mesh {
    let sphere = icosphere(triangles);
    let mut positions = Vec::with_capacity(3 * sphere.positions().len() + 2);
    let mut twins = Vec::with_capacity(sphere.positions().len());
    let mut add = |position: Vec3| {
        positions.push(position);
        u32::try_from(positions.len() - 1).expect("a shape has fewer vertices than triangles")
    };
    for (index, &position) in sphere.positions().iter().enumerate() {
        add(position * [1e6, 1.5, 1.0, 0.0][index % 4]);
        let own = add(position);
        twins.push([own, if index % 3 == 0 { add(position) } else { own }]);
    }
    add(Vec3::MAX);
    add(Vec3::MIN);
    let name = |(t, triangle): (usize, &[u32; 3])| triangle.map(|v| twins[v as usize][t % 2]);
    let triangles = sphere.triangles().iter().enumerate().map(name).collect();
    build(positions, triangles)
}

/// The cube −1 ..= 1 of six grids, each as fine as no neighbour: along every edge of the cube vertices
/// of one side lie exactly on edges of the other, so that what looks closed is all boundaries. At
/// least 84 triangles.
pub fn t_junctions(triangles: usize) -> Mesh {
    // Three pairs of sides, of n, 2n and some 4n squares along an edge: 4 (n² + 4 n² + 16 n²) triangles.
    let squares = wish(triangles).max(84) / 4;
    let n = (squares / 21).isqrt();
    let mut positions = Vec::new();
    let mut faces = Vec::new();
    for (axis, steps) in [n, 2 * n, (squares - 5 * n * n).isqrt()].into_iter().enumerate() {
        for side in [-1.0, 1.0f32] {
            let first = u32::try_from(positions.len()).expect("a shape has few vertices");
            let at = |i: u32| i as f32 / steps as f32 * 2.0 - 1.0;
            for j in 0..=steps {
                positions.extend((0..=steps).map(|i| {
                    let mut position = Vec3::splat(side);
                    // Turned over on the lower side, so that the outside stays outside.
                    position[(axis + 1) % 3] = side * at(i);
                    position[(axis + 2) % 3] = at(j);
                    position
                }));
            }
            let name = |i: u32, j: u32| first + j * (steps + 1) + i;
            for j in 0..steps {
                for i in 0..steps {
                    let (low, high) = (name(i, j), name(i + 1, j + 1));
                    faces.extend([[low, name(i + 1, j), high], [low, high, name(i, j + 1)]]);
                }
            }
        }
    }
    build(positions, faces)
}

/// Three [`icosphere`]s: one as it should be, a smaller one inside it that should face inwards and does
/// not, and one beside them that is turned inside out as a whole. Closed, of no consistent outside.
pub fn flipped_shells(triangles: usize) -> Mesh {
    let sphere = icosphere(triangles / 3);
    let count = u32::try_from(sphere.positions().len()).expect("a shape has few vertices");
    let placed = |scale: f32, x: f32| {
        sphere.positions().iter().map(move |p| scale * p + Vec3::new(x, 0.0, 0.0))
    };
    let positions = placed(1.0, 0.0).chain(placed(0.75, 0.0)).chain(placed(1.0, 2.5)).collect();
    let shell = |shell: u32| {
        sphere.triangles().iter().map(move |t| {
            let [a, b, c] = t.map(|v| v + shell * count);
            if shell == 2 { [a, c, b] } else { [a, b, c] }
        })
    };
    build(positions, (0..3).flat_map(shell).collect())
}

/// A cone of unit height over a disk of radius 1, all of its faces slivers about the apex and about the
/// middle of the disk. Closed; at 500 triangles each is 80 times as long as it is wide, and every
/// vertex but two has neighbours that are nearly collinear with it. At least 6 triangles.
pub fn sliver_fan(triangles: usize) -> Mesh {
    let around = (wish(triangles) / 2).max(3);
    let rim = |i: u32| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(around)).sin_cos();
        DVec3::new(cos, sin, 0.0).as_vec3()
    };
    let positions = [Vec3::Z, Vec3::ZERO].into_iter().chain((0..around).map(rim)).collect();
    let slivers = |i: u32| {
        let (here, next) = (2 + i, 2 + (i + 1) % around);
        [[0, here, next], [1, next, here]]
    };
    build(positions, (0..around).flat_map(slivers).collect())
}

/// A [`tetrahedron`](super::tetrahedron) in a thicket of faces without area: rows of collinear vertices from
/// each of its corners, all triangles of a row being three neighbours of it, or twice one and another;
/// many run along edges of the tetrahedron.
pub fn zero_area_thicket(triangles: usize) -> Mesh {
    let solid = super::tetrahedron();
    let mut positions = solid.positions().to_vec();
    let mut faces = solid.triangles().to_vec();
    let rows = 12;
    let per_row = (wish(triangles) / rows).max(1);
    for row in 0..rows {
        let from = row % 4;
        // Along the edges of the tetrahedron, and out of it.
        let direction = match row / 4 {
            0 => positions[((from + 1) % 4) as usize] - positions[from as usize],
            1 => positions[((from + 2) % 4) as usize] - positions[from as usize],
            _ => positions[from as usize],
        };
        // Eighths are exact, so that rows are collinear.
        let at = |step: u32| positions[from as usize] + direction * (step % 64) as f32 / 8.0;
        let new: Vec<Vec3> = (1..=per_row + 1).map(at).collect();
        let first = u32::try_from(positions.len()).expect("a shape has few vertices");
        positions.extend(new);
        faces.extend((0..per_row).map(|i| {
            let [previous, here] = [if i == 0 { from } else { first + i - 1 }, first + i];
            if i % 5 == 4 { [previous, here, previous] } else { [previous, here, here + 1] }
        }));
    }
    build(positions, faces)
}

/// That many times the triangle of [`one_triangle`](super::one_triangle), every other one turned over:
/// three edges of all those faces, and nothing else.
pub fn stack(triangles: usize) -> Mesh {
    let turned = |i: u32| if i.is_multiple_of(2) { [0, 1, 2] } else { [1, 0, 2] };
    let faces = (0..wish(triangles)).map(turned).collect();
    build(super::one_triangle().positions().to_vec(), faces)
}

/// Three [`icosphere`]s of radius 1e-20, 1 and 1e15 around (2e-20, 0, 0), (0, 2, 0) and (0, 0, 2e15): one
/// file of three units.
pub fn mixed_units(triangles: usize) -> Mesh {
    let sphere = icosphere(triangles / 3);
    let count = u32::try_from(sphere.positions().len()).expect("a shape has few vertices");
    let placed = [(1e-20, Vec3::X), (1.0, Vec3::Y), (1e15, Vec3::Z)].into_iter();
    let positions = placed
        .flat_map(|(unit, aside)| sphere.positions().iter().map(move |p| unit * (p + 2.0 * aside)));
    let shell = |shell: u32| sphere.triangles().iter().map(move |t| t.map(|v| v + shell * count));
    build(positions.collect(), (0..3).flat_map(shell).collect())
}
