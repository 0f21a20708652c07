//! Where the middle of many planes is.

use glam::{Mat3, Vec3};

use super::table::Plane;

/// How strongly the center of a bound is drawn to the middle of its edges, where planes leave it
/// free.
const STAY: f32 = 2e-3;

/// Sums over edges, by which the center of a union is found.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    /// Of n nᵀ: the diagonal, and xy, xz, yz.
    squares: [Vec3; 2],
    /// Of n times the plane's offset.
    offsets: Vec3,
    midpoints: Vec3,
    edges: f32,
}

impl Sums {
    pub(crate) fn of_edge(planes: [Plane; 2], midpoint: Vec3) -> Self {
        let mut sums = Self { midpoints: midpoint, edges: 1.0, ..Self::default() };
        for Plane { normal: n, offset } in planes {
            sums.squares[0] += n * n;
            sums.squares[1] += Vec3::new(n.x * n.y, n.x * n.z, n.y * n.z);
            sums.offsets += offset * n;
        }
        sums
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            squares: [self.squares[0] + other.squares[0], self.squares[1] + other.squares[1]],
            offsets: self.offsets + other.offsets,
            midpoints: self.midpoints + other.midpoints,
            edges: self.edges + other.edges,
        }
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        Self {
            squares: [self.squares[0] - other.squares[0], self.squares[1] - other.squares[1]],
            offsets: self.offsets - other.offsets,
            midpoints: self.midpoints - other.midpoints,
            edges: self.edges - other.edges,
        }
    }

    /// The mean of as many.
    pub(crate) fn over(&self, count: f32) -> Self {
        Self {
            squares: self.squares.map(|squares| squares / count),
            offsets: self.offsets / count,
            midpoints: self.midpoints / count,
            edges: self.edges / count,
        }
    }

    /// How many edges.
    pub(crate) fn edges(&self) -> f32 {
        self.edges
    }

    /// The point that is nearest to the planes by the sum of squares, not far from the edges.
    pub(crate) fn center(&self) -> Vec3 {
        let middle = self.midpoints / self.edges;
        let ([xx, yy, zz], [xy, xz, yz]) = (self.squares[0].to_array(), self.squares[1].to_array());
        let columns = [xx, xy, xz, xy, yy, yz, xz, yz, zz];
        let squares = Mat3::from_cols_array(&columns);
        let held = squares + Mat3::from_diagonal(Vec3::splat(STAY * self.edges));
        middle + held.inverse() * (self.offsets - squares * middle)
    }
}
