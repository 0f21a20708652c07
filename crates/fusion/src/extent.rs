//! Where a patch is: the two spheres, exactly and bounded from below.

use glam::DVec3;

use crate::columns::Columns;
use crate::geometry::EdgeShape;
use crate::lanes::{Lanes, Number};

/// Numbers by which [`Extent::least_radius`] knows a patch.
pub(crate) const TRAITS: usize = 10;

/// What is kept of a patch to know the sphere of any union that it enters.
pub(crate) trait Extent: Send + Sync {
    /// Of a single edge.
    fn of_edge(edge: &EdgeShape) -> Self;

    /// Of the union of two patches without a common edge.
    fn fused(&self, other: &Self) -> Self;

    /// Radius of the union's sphere, in half the longest side of the mesh's box. The same for (a, b)
    /// and (b, a), to the last bit.
    fn union_radius(&self, other: &Self) -> f64;

    /// What [`Extent::least_radius`] needs to know.
    fn traits(&self) -> [f64; TRAITS];

    /// A radius that the sphere of the union of two patches reaches at least, up to rounding.
    fn least_radius(a: &[Lanes; TRAITS], b: &[Lanes; TRAITS]) -> Lanes;
}

/// A line as six numbers: a point, and a unit vector along it.
type Line<T> = [T; 6];

/// Square of the distance from a point to a line.
#[inline(always)]
fn line_distance_squared<T: Number>(from: [T; 3], [x, y, z, u, v, w]: Line<T>) -> T {
    let [x, y, z] = [x - from[0], y - from[1], z - from[2]];
    length_squared([y * w - z * v, z * u - x * w, x * v - y * u])
}

#[inline(always)]
fn length_squared<T: Number>([x, y, z]: [T; 3]) -> T {
    x * x + y * y + z * z
}

/// [`SphereKind::Reduced`](crate::SphereKind::Reduced).
#[derive(Debug)]
pub(crate) struct ReducedExtent {
    lines: Columns<6>,
    midpoint_sum: DVec3,
    /// The line that is farthest from the patch's own center.
    farthest: Line<f64>,
}

impl ReducedExtent {
    fn new(lines: Columns<6>, midpoint_sum: DVec3) -> Self {
        let center = (midpoint_sum / lines.len() as f64).to_array();
        let distance = |line: &Line<f64>| line_distance_squared(center, *line);
        let farthest = lines.iter().max_by(|a, b| distance(a).total_cmp(&distance(b)));
        Self { farthest: farthest.unwrap_or_default(), lines, midpoint_sum }
    }
}

impl Extent for ReducedExtent {
    fn of_edge(edge: &EdgeShape) -> Self {
        let midpoint = 0.5 * (edge.ends[0] + edge.ends[1]);
        let [x, y, z] = midpoint.to_array();
        let [u, v, w] = edge.direction.to_array();
        Self::new(Columns::from_iter([[x, y, z, u, v, w]]), midpoint)
    }

    fn fused(&self, other: &Self) -> Self {
        let lines = self.lines.iter().chain(other.lines.iter()).collect();
        Self::new(lines, self.midpoint_sum + other.midpoint_sum)
    }

    fn union_radius(&self, other: &Self) -> f64 {
        let count = (self.lines.len() + other.lines.len()) as f64;
        let center = ((self.midpoint_sum + other.midpoint_sum) / count).to_array().map(Lanes::of);
        let farthest =
            |lines: &Columns<6>| lines.max_of(|line| line_distance_squared(center, line));
        farthest(&self.lines).max(farthest(&other.lines)).sqrt()
    }

    fn traits(&self) -> [f64; TRAITS] {
        let [x, y, z, u, v, w] = self.farthest;
        let sum = self.midpoint_sum;
        [sum.x, sum.y, sum.z, self.lines.len() as f64, x, y, z, u, v, w]
    }

    #[inline(always)]
    fn least_radius(a: &[Lanes; TRAITS], b: &[Lanes; TRAITS]) -> Lanes {
        let count = a[3] + b[3];
        let center = [(a[0] + b[0]) / count, (a[1] + b[1]) / count, (a[2] + b[2]) / count];
        let distance_squared = |&[_, _, _, _, x, y, z, u, v, w]: &[Lanes; TRAITS]| {
            line_distance_squared(center, [x, y, z, u, v, w])
        };
        distance_squared(a).larger(distance_squared(b)).sqrt()
    }
}

/// [`SphereKind::Mean`](crate::SphereKind::Mean).
#[derive(Debug)]
pub(crate) struct MeanExtent {
    /// Distinct, sorted.
    vertices: Vec<u32>,
    /// In the order of `vertices`.
    points: Columns<3>,
    sum: DVec3,
    min: DVec3,
    max: DVec3,
}

impl MeanExtent {
    /// Number of the vertices that both hold, and the sum of their positions.
    fn shared(&self, other: &Self) -> (usize, DVec3) {
        let (mut count, mut sum) = (0, DVec3::ZERO);
        if self.min.cmpgt(other.max).any() || other.min.cmpgt(self.max).any() {
            return (count, sum);
        }
        let (mut i, mut j) = (0, 0);
        while let (Some(a), Some(b)) = (self.vertices.get(i), other.vertices.get(j)) {
            if a == b {
                count += 1;
                sum += DVec3::from_array(self.points.get(i));
            }
            (i, j) = (i + usize::from(a <= b), j + usize::from(b <= a));
        }
        (count, sum)
    }
}

impl Extent for MeanExtent {
    fn of_edge(edge: &EdgeShape) -> Self {
        let [a, b] = edge.ends;
        Self {
            vertices: edge.vertices.to_vec(),
            points: Columns::from_iter([a.to_array(), b.to_array()]),
            sum: a + b,
            min: a.min(b),
            max: a.max(b),
        }
    }

    fn fused(&self, other: &Self) -> Self {
        let vertices = |extent: &Self| {
            let points: Vec<_> = extent.points.iter().collect();
            extent.vertices.iter().copied().zip(points).collect::<Vec<_>>()
        };
        let mut both = vertices(self);
        both.extend(vertices(other));
        both.sort_unstable_by_key(|&(vertex, _)| vertex);
        both.dedup_by_key(|&mut (vertex, _)| vertex);
        Self {
            vertices: both.iter().map(|&(vertex, _)| vertex).collect(),
            points: both.iter().map(|&(_, point)| point).collect(),
            sum: self.sum + other.sum - self.shared(other).1,
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    fn union_radius(&self, other: &Self) -> f64 {
        let (shared_count, shared_sum) = self.shared(other);
        let count = (self.vertices.len() + other.vertices.len() - shared_count) as f64;
        let center = (self.sum + other.sum - shared_sum) / count;
        let [x, y, z] = center.to_array().map(Lanes::of);
        let farthest =
            |points: &Columns<3>| points.max_of(|[a, b, c]| length_squared([a - x, b - y, c - z]));
        farthest(&self.points).max(farthest(&other.points)).sqrt()
    }

    fn traits(&self) -> [f64; TRAITS] {
        let ([a, b, c], [d, e, f]) = (self.min.to_array(), self.max.to_array());
        [a, b, c, d, e, f, 0.0, 0.0, 0.0, 0.0]
    }

    /// Half the longest side of the box around both: two vertices are that far apart.
    #[inline(always)]
    fn least_radius(a: &[Lanes; TRAITS], b: &[Lanes; TRAITS]) -> Lanes {
        let side = |i: usize| a[i + 3].larger(b[i + 3]) - a[i].smaller(b[i]);
        Lanes::of(0.5) * side(0).larger(side(1)).larger(side(2))
    }
}
