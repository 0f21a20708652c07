//! Where two triangles meet, exactly.
//!
//! Two triangles in different planes meet in one segment of the line that the planes have in common,
//! and each end of it is where a side of one triangle meets the other. Signs of exact orientation
//! tests decide where that is: at a vertex, where two sides cross, or where a side pierces the
//! triangle within. An end is named by what meets there, and not by where it is, so that all pairs of
//! triangles which share an end give it the same name, and segments join without gaps.

use glam::DVec3;
use robust::{Coord, orient2d};

use crate::occluders::{COPLANAR_ULPS, ULP, orientation};

/// A triangle, by its welded corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) id: u32,
    pub(super) corners: [u32; 3],
    pub(super) points: [DVec3; 3],
}

/// A point where two triangles meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Spot {
    /// A vertex of one or both.
    Vertex(u32),
    /// A side of one, from its lower to its higher vertex, pierces the other within.
    Pierced { side: [u32; 2], face: u32 },
    /// A side of each; the lower one first.
    Crossed([[u32; 2]; 2]),
}

/// The segment in which two triangles meet, one within the other or both with a side there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// The lower one first.
    pub(super) faces: [u32; 2],
    pub(super) ends: [Spot; 2],
    /// The side of each that lies in the plane of the other up to rounding, if just one does.
    pub(super) sides: [Option<[u32; 2]>; 2],
    /// A corner of one reaches through the other, and no further than rounding may have moved it.
    pub(super) is_tip: bool,
    /// Model units below which a distance from a plane is rounding.
    pub(super) tolerance: f64,
}

/// Where two faces with area meet; `None` if in no more than a point, in an edge that they share, or
/// if they lie in one plane up to rounding.
pub(super) fn meet(a: &Face, b: &Face) -> Option<Meeting> {
    let shared = a.corners.iter().filter(|corner| b.corners.contains(corner)).count();
    if shared > 1 {
        return None;
    }
    let of_a = a.volumes_with(b);
    if !meets_in_segment(of_a) {
        return None;
    }
    let of_b = b.volumes_with(a);
    if !meets_in_segment(of_b) {
        return None;
    }
    let mut ends = Ends::default();
    for (face, volumes, other) in [(a, of_a, b), (b, of_b, a)] {
        for i in 0..3 {
            let j = (i + 1) % 3;
            if volumes[i] == 0.0 && other.holds(face.corners[i], face.points[i]) {
                ends.push(Spot::Vertex(face.corners[i]));
            } else if are_opposite(volumes[i], volumes[j]) {
                ends.push_some(other.passed_by(face, [i, j]));
            }
        }
    }
    let tolerance = COPLANAR_ULPS * ULP * a.largest().max(b.largest());
    let near = [(of_a, b), (of_b, a)].map(|(volumes, other)| {
        let least = tolerance * other.normal().length();
        volumes.map(|volume| volume.abs() <= least)
    });
    if near.contains(&[true; 3]) {
        return None;
    }
    let side = |face: &Face, near: [bool; 3]| match near {
        [true, true, false] => Some(face.side([0, 1])),
        [false, true, true] => Some(face.side([1, 2])),
        [true, false, true] => Some(face.side([2, 0])),
        _ => None,
    };
    let sides = [side(a, near[0]), side(b, near[1])];
    let reaches = |volumes: [f64; 3], near: [bool; 3], is_above: bool| {
        (0..3).any(|i| !near[i] && (volumes[i] > 0.0) == is_above)
    };
    let is_tip = |side: Option<_>, volumes, near| {
        side.is_none() && !(reaches(volumes, near, true) && reaches(volumes, near, false))
    };
    Some(Meeting {
        faces: [a.id, b.id],
        ends: ends.both()?,
        sides,
        is_tip: is_tip(sides[0], of_a, near[0]) || is_tip(sides[1], of_b, near[1]),
        tolerance,
    })
}

/// Whether corners of these volumes with a face allow more than a point of it to be met.
fn meets_in_segment(volumes: [f64; 3]) -> bool {
    let zeros = volumes.iter().filter(|volume| **volume == 0.0).count();
    zeros == 2 || (0..3).any(|i| are_opposite(volumes[i], volumes[(i + 1) % 3]))
}

fn are_opposite(a: f64, b: f64) -> bool {
    a > 0.0 && b < 0.0 || a < 0.0 && b > 0.0
}

impl Face {
    /// Six times the volume of each corner with `other`, with its exact sign.
    fn volumes_with(&self, other: &Self) -> [f64; 3] {
        std::array::from_fn(|i| match other.corners.contains(&self.corners[i]) {
            true => 0.0,
            false => other.volume_with(self.points[i]),
        })
    }

    /// Six times the volume with `point`, with its exact sign.
    pub(super) fn volume_with(&self, point: DVec3) -> f64 {
        let [a, b, c] = self.points;
        orientation(a, b, c, point)
    }

    /// Twice the area long.
    pub(super) fn normal(&self) -> DVec3 {
        let [a, b, c] = self.points;
        (b - a).cross(c - a)
    }

    /// The largest coordinate.
    fn largest(&self) -> f64 {
        self.points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max)
    }

    /// The side from corner to corner, from its lower to its higher vertex.
    fn side(&self, [i, j]: [usize; 2]) -> [u32; 2] {
        let [a, b] = [self.corners[i], self.corners[j]];
        [a.min(b), a.max(b)]
    }

    /// Whether a vertex in the plane of the face lies in it or on its border.
    fn holds(&self, vertex: u32, point: DVec3) -> bool {
        if self.corners.contains(&vertex) {
            return true;
        }
        // Seen along an axis on which the face is not edge-on, the largest of its normal first.
        let normal = self.normal().abs();
        let mut axes = [0, 1, 2];
        axes.sort_by(|&i, &j| normal[j].total_cmp(&normal[i]));
        let seen = axes.into_iter().find_map(|axis| {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
            let flat = |p: DVec3| Coord { x: p[u], y: p[v] };
            let [a, b, c] = self.points.map(flat);
            let turn = orient2d(a, b, c);
            let sides = [(a, b), (b, c), (c, a)];
            (turn != 0.0).then(|| {
                sides.iter().all(|&(p, q)| orient2d(p, q, flat(point)) * turn.signum() >= 0.0)
            })
        });
        seen.unwrap_or(false)
    }

    /// Where the face is met by the side of `other` between two corners on opposite sides of it.
    fn passed_by(&self, other: &Self, ends: [usize; 2]) -> Option<Spot> {
        let [from, to] = ends.map(|i| other.points[i]);
        let turns: [f64; 3] = std::array::from_fn(|i| {
            orientation(from, to, self.points[i], self.points[(i + 1) % 3])
        });
        if turns.iter().any(|turn| *turn > 0.0) && turns.iter().any(|turn| *turn < 0.0) {
            return None;
        }
        let touched = |i: usize| turns[i] == 0.0;
        let side = other.side(ends);
        Some(match [touched(0), touched(1), touched(2)] {
            [false, false, false] => Spot::Pierced { side, face: self.id },
            [true, false, false] => crossed(side, self.side([0, 1])),
            [false, true, false] => crossed(side, self.side([1, 2])),
            [false, false, true] => crossed(side, self.side([2, 0])),
            [true, _, true] => Spot::Vertex(self.corners[0]),
            [true, true, _] => Spot::Vertex(self.corners[1]),
            [_, true, true] => Spot::Vertex(self.corners[2]),
        })
    }
}

fn crossed(a: [u32; 2], b: [u32; 2]) -> Spot {
    Spot::Crossed([a.min(b), a.max(b)])
}

/// The ends found so far: no more than two, since each is an end of the same segment.
#[derive(Default)]
struct Ends {
    first: Option<Spot>,
    second: Option<Spot>,
}

impl Ends {
    fn push(&mut self, spot: Spot) {
        if self.first.is_none() {
            self.first = Some(spot);
        } else if self.first != Some(spot) {
            self.second.get_or_insert(spot);
        }
    }

    fn push_some(&mut self, spot: Option<Spot>) {
        if let Some(spot) = spot {
            self.push(spot);
        }
    }

    fn both(self) -> Option<[Spot; 2]> {
        Some([self.first?, self.second?])
    }
}
