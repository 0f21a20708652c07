//! Shapes that are one rectangle of quadrangles, bent and closed up.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::{build, wish};
use crate::Mesh;

/// A round tube along the (2, 3) torus knot, the trefoil. Closed, smooth, without
/// self-intersection, within 3.5 of the z axis and 1.5 of the plane z = 0. At least 192 triangles.
///
/// The quadrangles are about square; the count is met to within one ring. Linear.
pub fn torus_knot(triangles: usize) -> Mesh {
    const TUBE_RADIUS: f64 = 0.5;
    /// Length of the knot, divided by the circumference of the tube.
    const ASPECT: u32 = 10;
    let [along, around] = sides(triangles, ASPECT, [24, 4]);
    let mut positions = Vec::with_capacity((along * around) as usize);
    for j in 0..along {
        let frame = KnotFrame::new(TAU * f64::from(j) / f64::from(along));
        positions.extend((0..around).map(|i| {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(around)).sin_cos();
            let offset = cos * frame.outward + sin * frame.sideways;
            (frame.center + TUBE_RADIUS * offset).as_vec3()
        }));
    }
    build(positions, quadrangles(around, along, |i, j| (j % along) * around + i % around))
}

/// A point of the knot with two directions across it, of unit length.
struct KnotFrame {
    center: DVec3,
    outward: DVec3,
    /// Direction of the knot × `outward`.
    sideways: DVec3,
}

impl KnotFrame {
    /// The knot winds on a torus of radii 2 and 1, twice around its axis and three times through
    /// its hole. The normal of that torus gives a frame that closes without a twist.
    fn new(angle: f64) -> Self {
        let (sin2, cos2) = (2.0 * angle).sin_cos();
        let (sin3, cos3) = (3.0 * angle).sin_cos();
        let radial = DVec3::new(cos2, sin2, 0.0);
        let tangential = DVec3::new(-sin2, cos2, 0.0);
        let normal = cos3 * radial + sin3 * DVec3::Z;
        let along = 2.0 * (2.0 + cos3) * tangential - 3.0 * sin3 * radial + 3.0 * cos3 * DVec3::Z;
        Self {
            center: 2.0 * radial + normal,
            outward: normal,
            sideways: along.cross(normal).normalize(),
        }
    }
}

/// A sheet over the square −1 ..= 1 of the plane z = 0, with waves of height 0.15, seen from +z.
/// One boundary; convex and concave edges. At least 2 triangles; linear.
pub fn open_grid(triangles: usize) -> Mesh {
    let [columns, rows] = sides(triangles, 1, [1, 1]);
    let at = |i: u32, j: u32| {
        let (x, y) = (centered(i, columns), centered(j, rows));
        DVec3::new(x, y, 0.15 * (4.0 * x + y).sin() * (3.0 * y - x).cos()).as_vec3()
    };
    let width = columns + 1;
    let positions = (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j)));
    let positions = positions.map(|(i, j)| at(i, j)).collect();
    build(positions, quadrangles(columns, rows, |i, j| j * width + i))
}

/// A cylinder of radius 1 around the z axis, z in −1 ..= 1, without its lids: two boundaries. At
/// least 6 triangles; linear.
pub fn open_cylinder(triangles: usize) -> Mesh {
    let [around, rows] = sides(triangles, 3, [3, 1]);
    let positions = (0..=rows).flat_map(|j| (0..around).map(move |i| (i, j)));
    let at = |(i, j): (u32, u32)| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(around)).sin_cos();
        DVec3::new(cos, sin, centered(j, rows)).as_vec3()
    };
    let positions = positions.map(at).collect();
    build(positions, quadrangles(around, rows, |i, j| j * around + i % around))
}

/// A band of width 0.8 along the unit circle of the plane z = 0, closed after half a turn: one
/// boundary, one side. No winding can agree everywhere; the edges across the band at y = 0, x > 0
/// are the ones where the two faces disagree. At least 16 triangles; linear.
pub fn mobius_strip(triangles: usize) -> Mesh {
    let [along, across] = sides(triangles, 8, [8, 1]);
    let width = across + 1;
    let at = |i: u32, j: u32| -> Vec3 {
        let angle = TAU * f64::from(i) / f64::from(along);
        let (sin, cos) = angle.sin_cos();
        let (half_sin, half_cos) = (0.5 * angle).sin_cos();
        let out = 0.4 * centered(j, across);
        let radius = 1.0 + out * half_cos;
        DVec3::new(radius * cos, radius * sin, out * half_sin).as_vec3()
    };
    let positions = (0..along).flat_map(|i| (0..=across).map(move |j| (i, j)));
    let positions = positions.map(|(i, j)| at(i, j)).collect();
    let index = |i, j| if i == along { across - j } else { i * width + j };
    build(positions, quadrangles(along, across, index))
}

/// Numbers of columns and rows, each at least the given one, so that columns × rows quadrangles of
/// two triangles come near to `triangles`, and columns / rows to `aspect`.
fn sides(triangles: usize, aspect: u32, least: [u32; 2]) -> [u32; 2] {
    let quadrangles = wish(triangles) / 2;
    let rows = (quadrangles / aspect).isqrt().max(least[1]);
    [((quadrangles + rows / 2) / rows).max(least[0]), rows]
}

/// `step` of `steps`, spread over −1 ..= 1.
fn centered(step: u32, steps: u32) -> f64 {
    (2.0 * f64::from(step) - f64::from(steps)) / f64::from(steps)
}

/// Two triangles for each of columns × rows quadrangles. Their normal is the direction of growing
/// column × the direction of growing row; `index` names the vertex at (column, row).
fn quadrangles(columns: u32, rows: u32, index: impl Fn(u32, u32) -> u32) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(2 * columns as usize * rows as usize);
    for j in 0..rows {
        for i in 0..columns {
            let (low, high) = (index(i, j), index(i + 1, j + 1));
            triangles.push([low, index(i + 1, j), high]);
            triangles.push([low, high, index(i, j + 1)]);
        }
    }
    triangles
}
