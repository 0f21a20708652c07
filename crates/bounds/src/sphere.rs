//! Spheres that every plane of a patch meets.

use glam::DVec3;

use crate::least_ball::center_of_least_ball;

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

    /// The smallest ball that meets the line through each edge: never larger than the Reduced Sphere,
    /// for some 90 scans instead of 2. At the origin if there are none.
    ///
    /// A convex program, solved to where r² is at most 1e-8 R² + 1e-6 d² above the least of any
    /// ball's, R being the radius of the Reduced Sphere and d how far that ball's center is from its
    /// center. So a center far off along lines that are almost parallel, where there is little to
    /// gain, is left alone. The radius is then measured, and errs to the safe side as all others do.
    pub fn minimal(edges: impl Iterator<Item = [DVec3; 2]> + Clone) -> Self {
        let reduced = Self::reduced(edges.clone());
        let center = center_of_least_ball(reduced.center, reduced.radius, edges.clone());
        let minimal = Self::meeting_lines(center, edges);
        if minimal.radius < reduced.radius { minimal } else { reduced }
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
pub(crate) fn largest(distances: impl Iterator<Item = f64>) -> f64 {
    distances.map(|d| if d.is_nan() { f64::INFINITY } else { d }).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

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
        assert_eq!(Sphere::minimal(unknown.into_iter()).radius, f64::INFINITY);
        check(Sphere::minimal([].into_iter()), DVec3::ZERO, 0.0);
        check(Sphere::minimal(EDGES.into_iter().take(1)), DVec3::Y, 0.0);
        check(Sphere::minimal([[DVec3::Y; 2]; 3].into_iter()), DVec3::Y, 0.0);
    }

    #[track_caller]
    fn check_minimal(edges: &[[DVec3; 2]], expected: f64) {
        let sphere = Sphere::minimal(edges.iter().copied());
        let error = sphere.radius - expected;
        assert!((-1e-14..1e-4).contains(&error), "{sphere:?}, not {expected}");
    }

    #[test]
    fn the_minimal_sphere_is_seen_by_hand() {
        // Parallel lines: half their distance, however many are on one side and wherever along them.
        check_minimal(&EDGES, 1.0);
        check_minimal(&[EDGES[0], EDGES[0], EDGES[0], EDGES[1]], 1.0);
        let slid = EDGES[1].map(|end| end + 1e3 * DVec3::X);
        check_minimal(&[EDGES[0], slid], 1.0);
        assert!(Sphere::minimal([EDGES[0], slid].into_iter()).center.x.abs() < 1e3);
        // Lines that cross meet a point; skew ones have half their distance between them.
        check_minimal(
            &[[DVec3::X, DVec3::Y], [DVec3::X, DVec3::NEG_Z], [DVec3::ZERO, DVec3::X]],
            0.0,
        );
        check_minimal(&[[DVec3::ZERO, DVec3::X], [DVec3::Z, DVec3::new(5.0, 1.0, 1.0)]], 0.5);
        // Points: a regular tetrahedron's corners lie on a ball of radius √3, one is inside.
        let corners = [[1.0; 3], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0], [0.5; 3]];
        check_minimal(&corners.map(|corner| [DVec3::from_array(corner); 2]), 3f64.sqrt());
    }

    /// Edges around a direction of any spread: in all directions to almost parallel.
    fn edges() -> impl Strategy<Value = Vec<[DVec3; 2]>> {
        let vector = || [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array);
        let edges = proptest::collection::vec((vector(), vector()), 1..40);
        (edges, vector(), -6.0..1.0f64, -9.0..9.0f64).prop_map(|(edges, common, spread, size)| {
            let (spread, size) = (10f64.powf(spread), 10f64.powf(size));
            let edge = |(tail, along)| [tail, tail + common + spread * along];
            edges.into_iter().map(|e| edge(e).map(|end| size * end)).collect()
        })
    }

    proptest! {
        /// The radius is convex in the center: if no center nearby is better, none is.
        #[test]
        fn no_other_center_is_better(
            edges in edges(), turn in 0.0..6.3f64, z in -1.0..1.0f64, step in -6.0..2.0f64,
        ) {
            let reduced = Sphere::reduced(edges.iter().copied());
            let best = Sphere::minimal(edges.iter().copied());
            prop_assert!(best.radius <= reduced.radius);
            let across = (1.0 - z * z).sqrt();
            let direction = DVec3::new(across * turn.cos(), across * turn.sin(), z);
            let center = best.center + 10f64.powf(step) * reduced.radius * direction;
            let other = Sphere::meeting_lines(center, edges.iter().copied());
            let far = center.distance_squared(reduced.center);
            let allowed = 1e-8 * reduced.radius.powi(2) + 1e-6 * far;
            let size = Sphere::holding(reduced.center, edges.iter().flatten().copied()).radius;
            let least = (other.radius.powi(2) + allowed).sqrt() + 1e-14 * size;
            prop_assert!(best.radius <= least, "{best:?}, but {other:?}");
        }
    }
}
