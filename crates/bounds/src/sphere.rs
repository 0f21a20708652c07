//! Spheres that every plane of a patch meets.

use glam::DVec3;

/// What a computed distance may be off by, as a share of the distances that went into it.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A ball that meets every plane it bounds.
///
/// Both planes of an edge hold the whole line through it, so it is enough that the ball meets that
/// line: it need not hold the edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// In model units.
    pub center: DVec3,
    /// In model units, 0 or more, rounded up. Infinite if a position was NaN or infinite.
    pub radius: f64,
}

impl Sphere {
    /// The Mean Sphere (Johnson and Cohen, I3D 2001): the center is the mean of `vertices`, which
    /// should be distinct, and the ball holds them all. Two scans. At the origin if there are none.
    pub fn mean(vertices: impl Iterator<Item = DVec3> + Clone) -> Self {
        Self::holding(mean(vertices.clone()), vertices)
    }

    /// The Reduced Sphere (Tsiapkolis and Bénard, CGF 2024, §3.1): the center is the mean of the
    /// midpoints of `edges`, and the ball reaches as far as the farthest line through one. Two
    /// scans. At the origin if there are none.
    pub fn reduced(edges: impl Iterator<Item = [DVec3; 2]> + Clone) -> Self {
        let midpoints = edges.clone().map(|[tail, head]| 0.5 * (tail + head));
        Self::meeting_lines(mean(midpoints), edges)
    }

    /// The smallest ball around `center` that holds these points. One scan.
    pub fn holding(center: DVec3, points: impl Iterator<Item = DVec3>) -> Self {
        Self { center, radius: largest(points.map(|p| (1.0 + ROUNDING) * p.distance(center))) }
    }

    /// The smallest ball around `center` that meets the line through each edge; where the ends of
    /// an edge are equal, that point. One scan.
    ///
    /// This is how a union is measured again: the center of the Reduced Sphere of a union is that
    /// of its parts, weighted by their numbers of edges.
    pub fn meeting_lines(center: DVec3, edges: impl Iterator<Item = [DVec3; 2]>) -> Self {
        let distance = |[tail, head]: [DVec3; 2]| {
            let (along, to_center) = (head - tail, center - tail);
            let from_tail = to_center.length();
            if along == DVec3::ZERO {
                return (1.0 + ROUNDING) * from_tail;
            }
            along.cross(to_center).length() / along.length() + ROUNDING * from_tail
        };
        Self { center, radius: largest(edges.map(distance)) }
    }
}

/// Mean of the points, zero if there are none.
fn mean(points: impl Iterator<Item = DVec3>) -> DVec3 {
    let (sum, count) =
        points.fold((DVec3::ZERO, 0.0), |(sum, count), point| (sum + point, count + 1.0));
    if count > 0.0 { sum / count } else { DVec3::ZERO }
}

/// The largest, at least 0; infinite if any is NaN, which `f64::max` would pass over.
fn largest(distances: impl Iterator<Item = f64>) -> f64 {
    distances.map(|d| if d.is_nan() { f64::INFINITY } else { d }).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(sphere: Sphere, center: DVec3, radius: f64) {
        assert!(sphere.center.distance(center) <= 1e-14, "{sphere:?}");
        assert!(sphere.radius >= radius && sphere.radius <= radius + 2e-14, "{sphere:?}");
    }

    /// Two edges of length 2 along x, at y = ±1.
    const EDGES: [[DVec3; 2]; 2] = [
        [DVec3::new(-1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)],
        [DVec3::new(3.0, -1.0, 0.0), DVec3::new(1.0, -1.0, 0.0)],
    ];

    #[test]
    fn the_mean_sphere_holds_the_vertices() {
        check(Sphere::mean(EDGES.into_iter().flatten()), DVec3::X, 5f64.sqrt());
    }

    #[test]
    fn the_reduced_sphere_meets_the_lines() {
        check(Sphere::reduced(EDGES.into_iter()), DVec3::X, 1.0);
        // The lines, not the edges: far along them nothing changes.
        let sphere = Sphere::meeting_lines(DVec3::new(7.0, 0.0, 0.0), EDGES.into_iter());
        check(Sphere { center: DVec3::X, ..sphere }, DVec3::X, 1.0);
        check(Sphere::reduced(EDGES.into_iter().take(1)), DVec3::Y, 0.0);
    }

    #[test]
    fn an_edge_without_length_is_a_point() {
        let edges = [EDGES[0], [DVec3::new(0.0, 4.0, 4.0); 2]];
        let center = DVec3::new(0.0, 2.5, 2.0);
        check(Sphere::reduced(edges.into_iter()), center, 6.25f64.sqrt());
    }

    #[test]
    fn degenerate_input_is_safe() {
        check(Sphere::mean([].into_iter()), DVec3::ZERO, 0.0);
        check(Sphere::reduced([].into_iter()), DVec3::ZERO, 0.0);
        let unknown = [EDGES[0], [DVec3::NAN, DVec3::X], EDGES[1]];
        assert_eq!(Sphere::reduced(unknown.into_iter()).radius, f64::INFINITY);
        assert_eq!(Sphere::mean(unknown.into_iter().flatten()).radius, f64::INFINITY);
    }
}
