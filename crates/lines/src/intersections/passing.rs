//! Whether surfaces pass through each other where they meet along an edge.
//!
//! A box that stands on a floor touches it along its edges, and by rounding it stands a little in the
//! floor here and a little above it there. A cylinder with a ring of edges in the floor passes through
//! it. What tells them apart are the faces around the edge: those of the box end there or lie in the
//! floor, those of the cylinder go on below.

use std::collections::HashMap;

use drypoint_mesh::{MeshAdjacency, Wing};
use glam::DVec3;

use super::find::Faces;
use super::meeting::Meeting;
use crate::occluders::orientation;

/// The third corners of the faces around edges.
pub(super) struct Apexes<'a> {
    faces: Faces<'a>,
    around: HashMap<[u32; 2], Vec<DVec3>>,
}

impl<'a> Apexes<'a> {
    /// Those around the sides of `meetings` that lie in the plane of the other face. Looks at every
    /// edge of the mesh if there are any.
    pub(super) fn new(faces: Faces<'a>, adjacency: &MeshAdjacency, meetings: &[Meeting]) -> Self {
        let sides = meetings.iter().flat_map(|meeting| meeting.sides).flatten();
        let mut around: HashMap<[u32; 2], Vec<u32>> = sides.map(|side| (side, vec![])).collect();
        if !around.is_empty() {
            for wing in adjacency.wings() {
                let [a, b] = wing.ends().map(|v| faces.welded(v));
                if let Some(apexes) = around.get_mut(&[a.min(b), a.max(b)]) {
                    let found = [wing.left, wing.right].into_iter().filter(|&v| v != Wing::NONE);
                    apexes.extend(found);
                }
            }
        }
        let placed = around.into_iter().map(|(side, mut apexes)| {
            apexes.sort_unstable();
            apexes.dedup();
            (side, apexes.into_iter().map(|v| faces.point(v)).collect())
        });
        Self { faces, around: placed.collect() }
    }

    /// Whether the surfaces of the two faces are on both sides of each other along what they have in
    /// common, by more than rounding.
    pub(super) fn pass(&self, meeting: &Meeting) -> bool {
        let [a, b] = meeting.faces;
        let tolerance = meeting.tolerance;
        match meeting.sides {
            [None, None] => true,
            [Some(side), None] => self.are_on_both_sides(&self.around[&side], b, tolerance),
            [None, Some(side)] => self.are_on_both_sides(&self.around[&side], a, tolerance),
            [Some(of_a), Some(of_b)] => {
                let axis = of_a.map(|v| self.faces.point(v));
                Turns { axis, tolerance }.alternate(&self.around[&of_a], &self.around[&of_b])
            }
        }
    }

    fn are_on_both_sides(&self, apexes: &[DVec3], face: u32, tolerance: f64) -> bool {
        let face = self.faces.face(face);
        let least = tolerance * face.normal().length();
        let is_on = |side: i8| apexes.iter().any(|&p| beyond(face.volume_with(p), least) == side);
        is_on(1) && is_on(-1)
    }
}

/// 1, 0 or −1: a volume beyond what is rounding.
fn beyond(volume: f64, least: f64) -> i8 {
    if volume.abs() <= least { 0 } else { 2 * i8::from(volume > 0.0) - 1 }
}

/// Half-planes around a line, each by a point in it.
struct Turns {
    axis: [DVec3; 2],
    /// Model units.
    tolerance: f64,
}

impl Turns {
    /// Whether two of `a` have one of `b` between them on either side: going around the line, they
    /// take turns. Half-planes that coincide take none.
    fn alternate(&self, a: &[DVec3], b: &[DVec3]) -> bool {
        // Faces without area are no half-planes.
        let is_off = |p: &DVec3| self.off_axis(*p).length() > self.tolerance;
        let [a, b] = [a, b].map(|p| p.iter().copied().filter(&is_off).collect::<Vec<_>>());
        let part = |from: DVec3, to: DVec3| {
            let places: Vec<_> = b.iter().filter_map(|&p| self.is_between(from, to, p)).collect();
            places.contains(&true) && places.contains(&false)
        };
        (1..a.len()).any(|i| a[..i].iter().any(|&before| part(a[i], before)))
    }

    /// Whether one passes `point` on the way around from one half-plane to another; `None` if it is
    /// in one of them.
    fn is_between(&self, from: DVec3, to: DVec3, point: DVec3) -> Option<bool> {
        if self.coincide(from, point) || self.coincide(to, point) || self.coincide(from, to) {
            return None;
        }
        let [after_from, before_to] = [self.side(from, point), self.side(point, to)];
        Some(match self.side(from, to) {
            // Half a turn or more.
            0 => after_from > 0,
            -1 => after_from > 0 || before_to > 0,
            _ => after_from > 0 && before_to > 0,
        })
    }

    /// 1 if one comes to `to` from `from` by less than half a turn, −1 if by more, 0 if by none or by
    /// half a turn.
    fn side(&self, from: DVec3, to: DVec3) -> i8 {
        let [start, end] = self.axis;
        let area = (end - start).cross(from - start).length();
        beyond(orientation(start, end, from, to), self.tolerance * area)
    }

    fn coincide(&self, a: DVec3, b: DVec3) -> bool {
        self.side(a, b) == 0 && self.off_axis(a).dot(self.off_axis(b)) > 0.0
    }

    /// The shortest way from the line to a point.
    fn off_axis(&self, point: DVec3) -> DVec3 {
        let [start, end] = self.axis;
        (point - start).reject_from_normalized((end - start).normalize_or(DVec3::X))
    }
}
