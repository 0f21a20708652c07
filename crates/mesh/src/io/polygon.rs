//! Polygons to triangles.
//!
//! A polygon becomes the fan from its first corner wherever that covers it, as in every convex one,
//! so that files of quads give the triangles that everybody expects. So does one without area, and
//! one that crosses itself. Others are cut by the crate `earcut`, chosen over `earcutr` because it
//! keeps its own stack: a hostile polygon of many corners cannot overflow ours. Ear cutting drops
//! corners that repeat and spikes; they are put back as triangles without area, so that every edge
//! of the polygon meets the face on its other side.

use earcut::Earcut;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use robust::{Coord, orient2d};

use super::content::joined;

/// Above so many corners a polygon is always a fan: ear cutting takes quadratic time on hostile
/// ones, here up to a tenth of a second.
const MAX_CUT_CORNERS: usize = 4096;

/// Polygons that a thread takes at once: fewer are sooner cut than shared out.
const MIN_SHARE: usize = 1024;

/// Faces of any number of corners, kept until all vertices are known.
#[derive(Clone, Debug, Default)]
pub(super) struct Faces {
    triangles: Vec<[u32; 3]>,
    /// Faces of four corners and more; their fans hold their places among `triangles`.
    polygons: Vec<Polygon>,
    corners: Vec<u32>,
}

/// A run of `Faces::corners`, which ends where the next begins.
#[derive(Clone, Copy, Debug)]
struct Polygon {
    first_triangle: usize,
    first_corner: usize,
}

impl Faces {
    /// These triangles, each a face.
    pub(super) fn of_triangles(triangles: Vec<[u32; 3]>) -> Self {
        Self { triangles, ..Self::default() }
    }

    /// Makes room for so many triangles more.
    pub(super) fn reserve(&mut self, triangles: usize) {
        self.triangles.reserve(triangles);
    }

    /// All faces of pieces in a row.
    pub(super) fn joined(pieces: Vec<Self>) -> Self {
        let (mut polygons, mut corners, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        let (mut triangle_count, mut corner_count) = (0, 0);
        for piece in pieces {
            polygons.extend(piece.polygons.iter().map(|polygon| Polygon {
                first_triangle: triangle_count + polygon.first_triangle,
                first_corner: corner_count + polygon.first_corner,
            }));
            triangle_count += piece.triangles.len();
            corner_count += piece.corners.len();
            triangles.push(piece.triangles);
            corners.push(piece.corners);
        }
        Self { triangles: joined(triangles), polygons, corners: joined(corners) }
    }

    /// Adds a triangle.
    pub(super) fn push_triangle(&mut self, corners: [u32; 3]) {
        self.triangles.push(corners);
    }

    /// Adds a face of three corners or more.
    pub(super) fn push(&mut self, corners: &[u32]) {
        if corners.len() > 3 {
            let (first_triangle, first_corner) = (self.triangles.len(), self.corners.len());
            self.polygons.push(Polygon { first_triangle, first_corner });
            self.corners.extend(corners);
        }
        let fan = corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]);
        self.triangles.extend(fan);
    }

    /// How many triangles there are so far.
    pub(super) fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The corners of a polygon.
    fn corners_of(&self, index: usize) -> &[u32] {
        let end = self.polygons.get(index + 1).map_or(self.corners.len(), |p| p.first_corner);
        &self.corners[self.polygons[index].first_corner..end]
    }

    /// Removes every face with a corner of which `is_bad` holds.
    pub(super) fn remove_those_of(&mut self, is_bad: impl Fn(u32) -> bool) -> Removed {
        let (mut kept, mut removed) = (Self::default(), Removed::default());
        let (mut polygon, mut triangle) = (0, 0);
        while triangle < self.triangles.len() {
            let starts = |p: &Polygon| p.first_triangle == triangle;
            let is_polygon = self.polygons.get(polygon).is_some_and(starts);
            let corners =
                if is_polygon { self.corners_of(polygon) } else { &self.triangles[triangle] };
            let end = triangle + corners.len() - 2;
            if corners.iter().any(|&vertex| is_bad(vertex)) {
                removed.faces += 1;
                removed.triangles.extend(triangle..end);
            } else {
                kept.push(corners);
            }
            polygon += usize::from(is_polygon);
            triangle = end;
        }
        *self = kept;
        removed
    }

    /// All triangles, in the order of the faces. Every corner must be a vertex by now.
    pub(super) fn into_triangles(mut self, positions: &[Vec3]) -> Vec<[u32; 3]> {
        let cut = |cutter: &mut Cutter, index: usize| {
            let corners = self.corners_of(index);
            cutter.points.clear();
            cutter.points.extend(corners.iter().map(|&v| positions[v as usize].as_dvec3()));
            Some((index, cutter.cut()?))
        };
        // Most are fans, and stay as they are.
        let cuts: Vec<(usize, Vec<[usize; 3]>)> = (0..self.polygons.len())
            .into_par_iter()
            .with_min_len(MIN_SHARE)
            .map_init(Cutter::default, cut)
            .flatten_iter()
            .collect();
        for (index, cut) in cuts {
            let corners = self.corners_of(index);
            let cut: Vec<[u32; 3]> = cut.iter().map(|cut| cut.map(|c| corners[c])).collect();
            let first = self.polygons[index].first_triangle;
            self.triangles[first..first + cut.len()].copy_from_slice(&cut);
        }
        self.triangles
    }
}

/// What was taken out of [`Faces`].
#[derive(Debug, Default)]
pub(super) struct Removed {
    /// How many faces.
    pub(super) faces: usize,
    /// The numbers of their triangles, in order.
    pub(super) triangles: Vec<usize>,
}

/// Cuts polygons, one after the other, in the same memory.
#[derive(Default)]
struct Cutter {
    points: Vec<DVec3>,
    shadow: Vec<[f64; 2]>,
    earcut: Earcut<f64>,
    indices: Vec<u32>,
}

impl Cutter {
    /// The corners, from 0, of the n − 2 triangles that cover the polygon `self.points`; `None` if
    /// the fan from the first corner is as good.
    fn cut(&mut self) -> Option<Vec<[usize; 3]>> {
        self.cast_shadow();
        let fan = (1..self.points.len() - 1).map(|i| [0, i, i + 1]);
        if self.points.len() > MAX_CUT_CORNERS || !self.turn_over_any(fan) {
            return None;
        }
        self.earcut.earcut_slice(&self.shadow, &[], &mut self.indices);
        let index = |corner: u32| corner as usize;
        let cut = self.indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]].map(index));
        let mut triangles: Vec<[usize; 3]> = cut.collect();
        fill(self.points.len(), &mut triangles)?;
        let covers = triangles.len() == self.points.len() - 2;
        (covers && !self.turn_over_any(triangles.iter().copied())).then_some(triangles)
    }

    /// Projects the polygon along the axis closest to its Newell normal, so that it runs
    /// counter-clockwise. Along an axis, not along the normal: coordinates so stay exact, and
    /// corners that lie on a straight line still do.
    fn cast_shadow(&mut self) {
        let next = self.points.iter().cycle().skip(1);
        let normal = self.points.iter().zip(next).fold(DVec3::ZERO, |sum, (p, q)| {
            let (d, s) = (*p - *q, *p + *q);
            sum + DVec3::new(d.y * s.z, d.z * s.x, d.x * s.y)
        });
        let axis = normal.abs().max_position();
        let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
        let (x, y) = if normal[axis] < 0.0 { (y, x) } else { (x, y) };
        self.shadow.clear();
        self.shadow.extend(self.points.iter().map(|p| [p[x], p[y]]));
    }

    /// Whether some triangle runs clockwise in the shadow: exactly.
    fn turn_over_any(&self, mut triangles: impl Iterator<Item = [usize; 3]>) -> bool {
        let at = |i: usize| Coord { x: self.shadow[i][0], y: self.shadow[i][1] };
        triangles.any(|[a, b, c]| orient2d(at(a), at(b), at(c)) < 0.0)
    }
}

/// Adds triangles until their common outline is the polygon of `corner_count` corners. `None` if
/// that cannot be: the triangles overlap.
fn fill(corner_count: usize, triangles: &mut Vec<[usize; 3]>) -> Option<()> {
    // The outline less the triangles, as directed edges, of which opposite ones cancel.
    let outline = (0..corner_count).map(|i| (i, (i + 1) % corner_count));
    let inner = triangles.iter().flat_map(|&[a, b, c]| [(b, a), (c, b), (a, c)]);
    let mut edges: Vec<(usize, usize, i32)> =
        outline.chain(inner).map(|(a, b)| if a < b { (a, b, 1) } else { (b, a, -1) }).collect();
    edges.sort_unstable();
    let mut next = vec![usize::MAX; corner_count];
    for edge in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (a, b, _) = edge[0];
        let (from, to) = match edge.iter().map(|edge| edge.2).sum() {
            0 => continue,
            1 => (a, b),
            -1 => (b, a),
            _ => return None,
        };
        if next[from] != usize::MAX {
            return None;
        }
        next[from] = to;
    }
    // What is left are loops without area.
    for first in 0..corner_count {
        let mut corner = std::mem::replace(&mut next[first], usize::MAX);
        if corner == usize::MAX {
            continue;
        }
        loop {
            let after = std::mem::replace(next.get_mut(corner)?, usize::MAX);
            if after == first || after == usize::MAX {
                break;
            }
            triangles.push([first, corner, after]);
            corner = after;
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangulates one polygon in space, whose corners are also its vertices.
    fn triangles(points: &[[f32; 3]]) -> Vec<[u32; 3]> {
        let positions: Vec<Vec3> = points.iter().map(|&p| p.into()).collect();
        let mut faces = Faces::default();
        faces.push(&(0..).take(points.len()).collect::<Vec<u32>>());
        faces.into_triangles(&positions)
    }

    /// Lays `points` in the three coordinate planes and a tilted one, both ways round, from every
    /// first corner, and checks that the triangles cover them: the outline is the polygon's, none is
    /// turned over, and the areas add up.
    #[track_caller]
    fn check_covered(points: &[[f32; 2]]) {
        let count = points.len();
        let mut ways = Vec::new();
        for first in 0..count {
            let mut turned = points.to_vec();
            turned.rotate_left(first);
            ways.push(turned.clone());
            turned.reverse();
            ways.push(turned);
        }
        for flat in ways {
            let laid: [fn([f32; 2]) -> [f32; 3]; 4] = [
                |[x, y]| [x, y, 7.0],
                |[x, y]| [7.0, x, y],
                |[x, y]| [y, 7.0, x],
                |[x, y]| [x, y, 2.0 * x - 0.5 * y],
            ];
            for lay in laid {
                let found = triangles(&flat.iter().map(|&p| lay(p)).collect::<Vec<_>>());
                assert_eq!(found.len(), count - 2, "{flat:?}");
                let at = |v: u32| {
                    let [x, y] = flat[v as usize];
                    Coord { x, y }
                };
                let areas = found.iter().map(|&[a, b, c]| orient2d(at(a), at(b), at(c)));
                let total: f64 =
                    (2..).take(count - 2).map(|i| orient2d(at(0), at(i - 1), at(i))).sum();
                assert!(areas.clone().all(|area| area * total >= 0.0), "{found:?}");
                assert!((areas.sum::<f64>() - total).abs() <= 1e-9 * total.abs());
                let mut rest = Vec::from_iter((0..count).map(|i| (i, (i + 1) % count)));
                for &[a, b, c] in &found {
                    for (a, b) in [(a, b), (b, c), (c, a)].map(|(a, b)| (a as usize, b as usize)) {
                        match rest.iter().position(|&edge| edge == (a, b)) {
                            Some(found) => drop(rest.swap_remove(found)),
                            None => rest.push((b, a)),
                        }
                    }
                }
                assert_eq!(rest, [], "{found:?}");
            }
        }
    }

    #[test]
    fn a_convex_polygon_is_a_fan() {
        let pentagon = [[0.0, 0.0], [2.0, 0.0], [3.0, 2.0], [1.0, 3.0], [-1.0, 2.0]];
        let raised = pentagon.map(|[x, y]| [x, y, x + y]);
        assert_eq!(triangles(&raised), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        check_covered(&pentagon);
    }

    #[test]
    fn a_folded_quad_is_a_fan() {
        let quad = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.4], [1.0, 1.0, 0.0], [0.0, 1.0, 0.4]];
        assert_eq!(triangles(&quad), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn an_arrowhead_is_cut_from_its_notch() {
        let arrow = [[2.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.0, -1.0]];
        check_covered(&arrow);
    }

    #[test]
    fn corners_on_straight_lines_are_kept() {
        // An L with a corner in the middle of each side.
        check_covered(&[
            [0.0, 0.0],
            [1.0, 0.0],
            [2.0, 0.0],
            [2.0, 0.5],
            [2.0, 1.0],
            [1.5, 1.0],
            [1.0, 1.0],
            [1.0, 1.5],
            [1.0, 2.0],
            [0.5, 2.0],
            [0.0, 2.0],
            [0.0, 1.0],
        ]);
        // A comb, above the size from which `earcut` searches along a curve.
        let teeth = (0..60u8).map(|i| [f32::from(i), if i % 2 == 0 { 1.0 } else { 9.0 }]);
        let bottom = (0..60u8).rev().map(|i| [f32::from(i), 0.0]);
        check_covered(&teeth.chain(bottom).collect::<Vec<_>>());
    }

    #[test]
    fn corners_that_repeat_and_spikes_are_kept() {
        let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        for corner in 0..l.len() {
            let mut repeated = l.to_vec();
            repeated.insert(corner, l[corner]);
            check_covered(&repeated);
        }
        let mut spiked = l.to_vec();
        spiked.splice(3..4, [[1.0, 1.0], [0.5, 0.5], [1.0, 1.0]]);
        check_covered(&spiked);
    }

    #[test]
    fn a_bridge_to_a_hole_is_passed_twice() {
        let outer = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0], [0.0, 0.0]];
        let hole = [[3.0, 3.0], [3.0, 6.0], [6.0, 6.0], [6.0, 3.0], [3.0, 3.0]];
        check_covered(&[outer, hole].concat());
    }

    #[test]
    fn a_polygon_without_area_is_a_fan() {
        let line = [[0.0; 3], [1.0; 3], [2.0; 3], [0.5; 3]];
        assert_eq!(triangles(&line), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(triangles(&[[5.0; 3]; 5]), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    }

    #[test]
    fn a_crossing_polygon_is_a_fan() {
        let star: Vec<[f32; 3]> = (0..5u8)
            .map(|i| (f32::from(i) * 0.8 * std::f32::consts::PI).sin_cos())
            .map(|(x, y)| [x, y, 0.0])
            .collect();
        assert_eq!(triangles(&star), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        let bow = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(triangles(&bow), [[0, 1, 2], [0, 2, 3]]);
    }
}
