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

/// The axis of the smallest cap around unit vectors, to within rounding; `None` if there are none,
/// or they lie so far apart that no cap below a hemisphere holds them. Linear in each of a few
/// scans. Ties go to the vector that comes first.
pub(crate) fn axis_of_smallest_cap(
    directions: impl Iterator<Item = DVec3> + Clone,
) -> Option<DVec3> {
    let mut axis = directions.clone().next()?;
    let mut radius_squared = 0.0;
    let mut support = vec![axis];
    for _ in 0..MAX_SCANS {
        let farthest = farthest_from(axis, directions.clone())?;
        if farthest.distance_squared(axis) <= radius_squared {
            break;
        }
        support.push(farthest);
        let cap = cap_of_support(&support)?;
        if cap.radius_squared <= radius_squared {
            break;
        }
        (axis, radius_squared, support) = (cap.axis, cap.radius_squared, cap.support);
    }
    Some(axis)
}

fn farthest_from(axis: DVec3, directions: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    directions
        .map(|d| (d.distance_squared(axis), d))
        .reduce(|a, b| if b.0 > a.0 { b } else { a })
        .map(|(_, d)| d)
}

struct Cap {
    axis: DVec3,
    /// Square of the chord from the axis to the rim: grows with the angle, without cancellation.
    radius_squared: f64,
    /// The two or three directions on its rim.
    support: Vec<DVec3>,
}

/// The smallest cap around up to four directions: of all caps held up by two or three of them, the
/// one whose axis is nearest to its farthest direction. No other can be smaller.
fn cap_of_support(directions: &[DVec3]) -> Option<Cap> {
    let mut smallest: Option<Cap> = None;
    let mut consider = |axis: DVec3, support: &[DVec3]| {
        let Some(axis) = axis.try_normalize() else { return };
        let radius_squared =
            directions.iter().map(|d| d.distance_squared(axis)).fold(0.0, f64::max);
        if smallest.as_ref().is_none_or(|cap| radius_squared < cap.radius_squared) {
            smallest = Some(Cap { axis, radius_squared, support: support.to_vec() });
        }
    };
    for (i, &a) in directions.iter().enumerate() {
        for (j, &b) in directions.iter().enumerate().skip(i + 1) {
            consider(a + b, &[a, b]);
            for &c in &directions[j + 1..] {
                consider(circumcenter(a, b, c), &[a, b, c]);
            }
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
