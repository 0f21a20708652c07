//! Where a line along an axis crosses some planes closest together.
//!
//! Seen along the axis, plane j has the height c − g · x above the place x, so that the spread of
//! heights, which is twice the distance t of a double cone about that line, is a convex function made
//! of flat pieces: to find its least value is to fit a plane to the points (g, c) so that the largest
//! error is least. It is found by cutting planes: each scan gives the two planes that are farthest
//! apart at one place, their difference bounds the spread everywhere from below, and the next place
//! is where the bounds known so far are lowest. Two or three of them hold it down.
//!
//! The spread alone would not do: where normals are spread along one direction, as on a cylinder, it
//! hardly depends on the other, and the best place may be far away along it. Close viewpoints lose by
//! that, since the cones widen from there. So a place costs tan α |x|² / (reach ·
//! [`REACHES_TO_VIEWPOINT`]) as well.

use glam::{DVec2, DVec3};

use crate::Plane;
use crate::cap::Cap;

/// Scans after which a place is taken as it is. Patches of the bunny need 6, on the mean.
const MAX_SCANS: usize = 24;

/// How close to the least cost the search ends, as a share of it.
const TOLERANCE: f64 = 1e-2;

/// Distance of the viewpoints to which the place of the center is fitted, in units of the distance
/// of the farthest of the points from their mean. Anything from 3 to 1000 changes what is tested by
/// 0.1 % at most.
const REACHES_TO_VIEWPOINT: f64 = 10.0;

/// A plane as seen along the axis.
#[derive(Clone, Copy, Debug)]
struct Height {
    /// Above the start.
    at_start: f64,
    /// How much lower it is one unit farther along either direction across the axis.
    fall: DVec2,
}

/// Bounds the spread of heights at x from below: `at_start − fall · x`.
type Cut = Height;

/// A point on the line along the axis of `cap`, which holds the normals, on which the planes are
/// close together: never farther apart than on the line through the mean of their points, and no
/// farther from it than the farthest of these points. A few scans.
pub(crate) fn point_of_least_spread(
    cap: &Cap,
    planes: impl Iterator<Item = Plane> + Clone,
) -> DVec3 {
    let count = planes.clone().count().max(1) as f64;
    let start = planes.clone().map(|plane| plane.point).sum::<DVec3>() / count;
    let reach_squared = planes.clone().map(|p| p.point.distance_squared(start)).fold(0.0, f64::max);
    let reach = reach_squared.sqrt();
    let (right, up) = cap.axis.any_orthonormal_pair();
    let height = |plane: Plane| {
        let cos = plane.normal.dot(cap.axis);
        Height {
            at_start: plane.normal.dot(plane.point - start) / cos,
            fall: DVec2::new(plane.normal.dot(right), plane.normal.dot(up)) / cos,
        }
    };
    let heights: Vec<Height> = planes.map(height).collect();
    let stiffness = cap.tan() / (REACHES_TO_VIEWPOINT * reach);
    if !(stiffness > 0.0 && stiffness.is_finite()) {
        return start;
    }
    let place = place_of_least_cost(&heights, stiffness).clamp_length_max(reach);
    start + place.x * right + place.y * up
}

/// Where spread + `stiffness` |x|² is least, to within [`TOLERANCE`].
fn place_of_least_cost(heights: &[Height], stiffness: f64) -> DVec2 {
    let cost = |cut: &Cut, place: DVec2| cut.at(place) + stiffness * place.length_squared();
    let first = widest(heights, DVec2::ZERO);
    let (mut best, mut least) = (DVec2::ZERO, cost(&first, DVec2::ZERO));
    // Repeated ones say nothing new, and do no harm.
    let mut cuts = [first; 4];
    let mut bound = f64::NEG_INFINITY;
    for _ in 0..MAX_SCANS {
        let lowest = lowest_of_cuts(&cuts, stiffness);
        // The bound grows with each cut, or only rounding is left.
        let goes_on = lowest.cost > bound && least - lowest.cost > TOLERANCE * least;
        if !goes_on {
            break;
        }
        bound = lowest.cost;
        let cut = widest(heights, lowest.place);
        if cost(&cut, lowest.place) < least {
            (best, least) = (lowest.place, cost(&cut, lowest.place));
        }
        let [i, j, k] = lowest.support;
        cuts = [cut, cuts[i], cuts[j], cuts[k]];
    }
    best
}

impl Height {
    fn at(&self, place: DVec2) -> f64 {
        self.at_start - self.fall.dot(place)
    }

    fn above(&self, other: &Self) -> Cut {
        Self { at_start: self.at_start - other.at_start, fall: self.fall - other.fall }
    }
}

/// The highest plane at `place` above the lowest.
fn widest(heights: &[Height], place: DVec2) -> Cut {
    let mut ends = [heights[0]; 2];
    let mut range = [heights[0].at(place); 2];
    for height in heights {
        let at = height.at(place);
        if at < range[0] {
            (ends[0], range[0]) = (*height, at);
        }
        if at > range[1] {
            (ends[1], range[1]) = (*height, at);
        }
    }
    ends[1].above(&ends[0])
}

struct Lowest {
    place: DVec2,
    cost: f64,
    /// Indices of the cuts that hold it up; there may be fewer than three.
    support: [usize; 3],
}

/// Where the highest of four cuts, plus stiffness |x|², is lowest. Of all places that one, two
/// or three of them alone would give, it is the one where the highest of all is lowest.
fn lowest_of_cuts(cuts: &[Cut; 4], stiffness: f64) -> Lowest {
    let mut lowest = Lowest { place: DVec2::ZERO, cost: f64::INFINITY, support: [0; 3] };
    let mut consider = |place: DVec2, support: [usize; 3]| {
        let highest = cuts.iter().map(|cut| cut.at(place)).fold(f64::NEG_INFINITY, f64::max);
        let cost = highest + stiffness * place.length_squared();
        // Not if it is NaN.
        if cost < lowest.cost {
            lowest = Lowest { place, cost, support };
        }
    };
    for (i, &a) in cuts.iter().enumerate() {
        consider(a.fall / (2.0 * stiffness), [i; 3]);
        for (j, &b) in cuts.iter().enumerate().skip(i + 1) {
            consider(lowest_on_crease(a, b, stiffness), [i, j, j]);
            for (k, &c) in cuts.iter().enumerate().skip(j + 1) {
                consider(crossing(a.above(&b), a.above(&c)), [i, j, k]);
            }
        }
    }
    lowest
}

/// Where two cuts are equal and cost least. NaN if they are nowhere equal.
fn lowest_on_crease(a: Cut, b: Cut, stiffness: f64) -> DVec2 {
    let crease = a.above(&b);
    let free = b.fall / (2.0 * stiffness);
    free + crease.at(free) / crease.fall.length_squared() * crease.fall
}

/// Where both are 0. Not finite if they are parallel.
fn crossing(a: Cut, b: Cut) -> DVec2 {
    (a.at_start * b.fall - b.at_start * a.fall).perp() / b.fall.perp_dot(a.fall)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cap::smallest_cap;
    use proptest::prelude::*;

    fn heights() -> impl Strategy<Value = Vec<Height>> {
        let height = [-1.0..1.0f64, -1.0..1.0, -1.0..1.0]
            .prop_map(|[at_start, x, y]| Height { at_start, fall: DVec2::new(x, y) });
        (proptest::collection::vec(height, 1..30), -6.0..0.0f64).prop_map(|(mut heights, flat)| {
            heights.iter_mut().for_each(|height| height.fall.y *= 10f64.powf(flat));
            heights
        })
    }

    fn cost(heights: &[Height], stiffness: f64, place: DVec2) -> f64 {
        widest(heights, place).at(place) + stiffness * place.length_squared()
    }

    #[test]
    fn two_lines_cross() {
        let cut = |at_start, x, y| Height { at_start, fall: DVec2::new(x, y) };
        // 3 = x, 4 = 2 y.
        assert_eq!(crossing(cut(3.0, 1.0, 0.0), cut(4.0, 0.0, 2.0)), DVec2::new(3.0, 2.0));
        let place = lowest_on_crease(cut(3.0, 1.0, 5.0), cut(0.0, 0.0, 5.0), 0.5);
        assert!(place.distance(DVec2::new(3.0, 5.0)) < 1e-14, "{place}");
    }

    /// Three planes that cross far away: that is no place for a center.
    #[test]
    fn the_place_is_near_the_points() {
        let plane = |turn: f64| {
            let point = DVec3::new(turn.cos(), turn.sin(), 0.0);
            let normal = (DVec3::Z - 0.1 * point).normalize();
            Plane { normal, point: point + 0.1 * point.dot(point + 9.0 * DVec3::X) * DVec3::Z }
        };
        let planes: Vec<Plane> = [0.0, 2.0, 4.0].map(plane).to_vec();
        let cap = smallest_cap(planes.iter().map(|plane| plane.normal)).unwrap();
        let place = point_of_least_spread(&cap, planes.iter().copied());
        let across = (place - planes.iter().map(|p| p.point).sum::<DVec3>() / 3.0).cross(cap.axis);
        assert!((1.0..1.6).contains(&across.length()), "{place}");
    }

    proptest! {
        /// The cost is convex: if no place nearby is better, none is.
        #[test]
        fn no_other_place_is_better(
            heights in heights(), stiffness in -5.0..1.0f64, turn in 0.0..6.3f64, step in -6.0..1.0f64,
        ) {
            let stiffness = 10f64.powf(stiffness);
            let best = place_of_least_cost(&heights, stiffness);
            let least = cost(&heights, stiffness, best);
            let other = best + 10f64.powf(step) * DVec2::from_angle(turn);
            let allowed = (1.0 - TOLERANCE) * least - 1e-12;
            prop_assert!(cost(&heights, stiffness, other) >= allowed);
            prop_assert!(least <= cost(&heights, stiffness, DVec2::ZERO));
        }
    }
}
