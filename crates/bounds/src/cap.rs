//! The smallest cap of the unit sphere around some directions.
//!
//! Barequet and Elber, Optimal Bounding Cones of Vectors in Three Dimensions, Information
//! Processing Letters 93, 2005: below a hemisphere, the smallest cap is where the smallest ball
//! around the directions, taken as points, cuts the sphere. Two or three of them hold it up. They
//! propose Welzl's method, whose expected linear time rests on a random order; here the farthest
//! point outside is taken in instead (Gärtner, Fast and Robust Smallest Enclosing Balls, ESA 1999),
//! which needs no order, and 2 to 6 scans on patches of up to 80 edges of a bumpy ball.

use glam::DVec3;

/// Scans after which a cap is taken as it is. The radius grows with each, so that only rounding could
/// keep it going for so long.
const MAX_SCANS: usize = 64;

/// The smallest cap around unit vectors, to within rounding; `None` if there are none, or they lie so
/// far apart that no cap below a hemisphere holds them. Linear in each of a few scans. Ties go to the
/// vector that comes first.
pub(crate) fn smallest_cap(directions: impl Iterator<Item = DVec3> + Clone) -> Option<Cap> {
    let first = directions.clone().next()?;
    let mut cap = Cap { axis: first, radius_squared: 0.0, support: [first; 3], count: 1 };
    for _ in 0..MAX_SCANS {
        let farthest = farthest_from(cap.axis, directions.clone())?;
        if farthest.distance_squared(cap.axis) <= cap.radius_squared {
            break;
        }
        let [a, b, c] = cap.support;
        let wider = cap_of_support(&[a, b, c, farthest], cap.count)?;
        if wider.radius_squared <= cap.radius_squared {
            break;
        }
        cap = wider;
    }
    Some(cap)
}

fn farthest_from(axis: DVec3, directions: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    directions
        .map(|d| (d.distance_squared(axis), d))
        .reduce(|a, b| if b.0 > a.0 { b } else { a })
        .map(|(_, d)| d)
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Cap {
    /// Unit length, up to rounding.
    pub(crate) axis: DVec3,
    /// Square of the chord from the axis to the rim: grows with the angle, without cancellation.
    pub(crate) radius_squared: f64,
    /// The one to three directions on its rim come first.
    support: [DVec3; 3],
    count: usize,
}

impl Cap {
    /// Tangent of its half-angle, roughly; infinite or below zero from a hemisphere on.
    pub(crate) fn tan(&self) -> f64 {
        let (sin_squared, cos) = (
            self.radius_squared * (1.0 - 0.25 * self.radius_squared),
            1.0 - 0.5 * self.radius_squared,
        );
        sin_squared.sqrt() / cos
    }
}

/// The smallest cap around the first `count` of four directions and the last: of all caps held up by
/// the last and one or two others, the one whose axis is nearest to its farthest direction. If the
/// last lies outside the smallest cap of the others, no other can be smaller.
fn cap_of_support(&[a, b, c, last]: &[DVec3; 4], count: usize) -> Option<Cap> {
    let others = &[a, b, c][..count];
    let mut smallest: Option<Cap> = None;
    let mut consider = |axis: DVec3, support: [DVec3; 3], count: usize| {
        let Some(axis) = axis.try_normalize() else { return };
        let farthest = |radius: f64, d: &DVec3| radius.max(d.distance_squared(axis));
        let radius_squared = others.iter().fold(last.distance_squared(axis), farthest);
        if smallest.is_none_or(|cap| radius_squared < cap.radius_squared) {
            smallest = Some(Cap { axis, radius_squared, support, count });
        }
    };
    for (i, &a) in others.iter().enumerate() {
        consider(a + last, [last, a, a], 2);
        for &b in &others[i + 1..] {
            consider(circumcenter(last, a, b), [last, a, b], 3);
        }
    }
    smallest
}

/// The center of the circle through three points, which lies on the axis of the cap they hold up.
/// Not their plane's normal: that is noise where a cap is narrower than 1e-8, and the center is not.
/// NaN if the points are collinear.
fn circumcenter(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let (u, v) = (b - a, c - a);
    let normal = u.cross(v);
    let offset = u.length_squared() * v.cross(normal) + v.length_squared() * normal.cross(u);
    a + offset / (2.0 * normal.length_squared())
}
