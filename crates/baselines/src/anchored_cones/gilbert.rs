//! The point of a convex hull of unit vectors that is closest to the origin.
//!
//! Gilbert, Johnson and Keerthi, A Fast Procedure for Computing the Distance Between Complex Objects
//! in Three-Dimensional Space, IEEE Journal of Robotics and Automation 4(2), 1988. Its direction is
//! the one that maximises the least n · n_j, and what it maximises is its length.
//!
//! On the sphere the closest points of a simplex are plain: of two vectors the middle, of three the
//! center of their circle, if that is inside the triangle.

use glam::DVec3;

/// Scans after which a point is taken as it is. It comes closer with each, so that only rounding could
/// keep it going for so long.
const MAX_SCANS: usize = 64;

/// A point of the hull, and the corners of the simplex that holds it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub(super) point: DVec3,
    support: [usize; 3],
    count: usize,
}

impl Nearest {
    /// Indices of the one to three vectors that it is a mean of.
    pub(super) fn support(&self) -> &[usize] {
        &self.support[..self.count]
    }
}

/// The point of the hull of unit `vectors` closest to the origin, to within rounding; `None` if
/// there are none, or if it is closer than `least`, 0 or more, as it is when the hull holds the
/// origin. Ties go to the vector that comes first. A few scans.
pub(super) fn nearest_to_origin(vectors: &[DVec3], least: f64) -> Option<Nearest> {
    let mut nearest = Nearest { point: *vectors.first()?, support: [0; 3], count: 1 };
    for _ in 0..MAX_SCANS {
        let lowest = lowest_along(vectors, nearest.point);
        if vectors[lowest].dot(nearest.point) >= nearest.point.length_squared() {
            break;
        }
        let Some(closer) = with_corner(vectors, &nearest, lowest) else { break };
        if closer.point.length_squared() >= nearest.point.length_squared() {
            break;
        }
        nearest = closer;
        if nearest.point.length_squared() < least * least {
            return None;
        }
    }
    // Four corners around the origin end the search, too; then a vector looks the other way.
    let lowest = lowest_along(vectors, nearest.point);
    (vectors[lowest].dot(nearest.point) > 0.0).then_some(nearest)
}

fn lowest_along(vectors: &[DVec3], direction: DVec3) -> usize {
    let mut lowest = (f64::INFINITY, 0);
    for (index, vector) in vectors.iter().enumerate() {
        let height = vector.dot(direction);
        if height < lowest.0 {
            lowest = (height, index);
        }
    }
    lowest.1
}

/// The closest point of the simplex of the old corners and one more, whose closest point is not
/// among the old ones'. `None` only if two vectors are opposite.
fn with_corner(vectors: &[DVec3], old: &Nearest, corner: usize) -> Option<Nearest> {
    let mut nearest: Option<Nearest> = None;
    let mut consider = |point: DVec3, support: [usize; 3], count: usize| {
        let is_closer = nearest.is_none_or(|n| point.length_squared() < n.point.length_squared());
        if is_closer && point != DVec3::ZERO {
            nearest = Some(Nearest { point, support, count });
        }
    };
    for (i, &a) in old.support().iter().enumerate() {
        consider(0.5 * (vectors[corner] + vectors[a]), [corner, a, a], 2);
        for &b in &old.support()[i + 1..] {
            if let Some(point) = middle_of_acute([corner, a, b].map(|index| vectors[index])) {
                consider(point, [corner, a, b], 3);
            }
        }
    }
    nearest
}

/// The center of the circle through three points, if it is inside their triangle.
fn middle_of_acute([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let sides = [b.distance_squared(c), c.distance_squared(a), a.distance_squared(b)];
    let around = sides.iter().sum::<f64>();
    let weights = sides.map(|side| side * (around - 2.0 * side));
    let sum = weights.iter().sum::<f64>();
    let is_inside = weights.iter().all(|&weight| weight > 0.0) && sum > 0.0;
    is_inside.then(|| (weights[0] * a + weights[1] * b + weights[2] * c) / sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        let coordinate = || -1.0..1.0f64;
        (coordinate(), coordinate(), coordinate())
            .prop_map(|(x, y, z)| DVec3::new(x, y, z))
            .prop_filter_map("no direction", |v| v.try_normalize())
    }

    /// Of all vectors, middles of pairs and feet of triples that have nothing below them, the
    /// farthest: the hull lies beyond the plane through each, so that none is farther than the closest.
    fn by_brute_force(vectors: &[DVec3]) -> Option<DVec3> {
        let is_lowest =
            |point: &DVec3| vectors.iter().all(|v| v.dot(*point) >= point.length_squared() - 1e-12);
        let mut points = vectors.to_vec();
        for (i, &a) in vectors.iter().enumerate() {
            for (j, &b) in vectors.iter().enumerate().skip(i + 1) {
                points.push(0.5 * (a + b));
                let normal = |c: DVec3| (b - a).cross(c - a).normalize_or_zero();
                // The foot of the plane through three of them.
                points.extend(vectors[j + 1..].iter().map(|&c| normal(c).dot(a) * normal(c)));
            }
        }
        points.retain(|point| point.length() > 1e-6 && is_lowest(point));
        points.into_iter().max_by(|a, b| a.length().total_cmp(&b.length()))
    }

    #[track_caller]
    fn check(vectors: &[DVec3]) {
        let found = nearest_to_origin(vectors, 0.0);
        match by_brute_force(vectors) {
            Some(point) => {
                let found = found.unwrap();
                assert!(found.point.distance(point) < 1e-6, "{} for {point}", found.point);
                let is_held = |&index: &usize| {
                    (vectors[index].dot(point) - point.length_squared()).abs() < 1e-6
                };
                assert!(found.support().iter().all(is_held));
            }
            None => assert!(found.is_none_or(|found| found.point.length() < 1e-5)),
        }
    }

    #[test]
    fn few_vectors() {
        check(&[DVec3::X]);
        check(&[DVec3::X, DVec3::X, DVec3::Y]);
        check(&[DVec3::X, DVec3::Y, DVec3::Z]);
        check(&[DVec3::X, DVec3::NEG_X]);
        check(&[DVec3::X, DVec3::NEG_X, DVec3::Y]);
        assert!(nearest_to_origin(&[], 0.0).is_none());
        assert!(nearest_to_origin(&[DVec3::X, DVec3::Y], 0.7).is_some());
        assert!(nearest_to_origin(&[DVec3::X, DVec3::Y], 0.8).is_none());
    }

    proptest! {
        #[test]
        fn it_is_the_closest(
            mut vectors in prop::collection::vec(vector(), 1..12), axis in vector(), width in -7.0..1.0f64,
        ) {
            check(&vectors);
            for v in &mut vectors {
                *v = (axis + 10f64.powf(width) * *v).normalize();
            }
            let nearest = nearest_to_origin(&vectors, 0.0);
            if width < -0.5 {
                // Of a narrow cone the angle is what counts.
                let widest = |axis: DVec3| vectors.iter().map(|v| v.cross(axis).length()).fold(0.0, f64::max);
                let expected = widest(by_brute_force(&vectors).unwrap_or(axis).normalize());
                prop_assert!(widest(nearest.unwrap().point.normalize()) <= expected + 2e-8);
            }
        }
    }
}
