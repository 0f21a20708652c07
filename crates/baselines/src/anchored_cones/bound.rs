//! The cones of a set of planes.
//!
//! The axis comes first (`gilbert.rs`), and with it the half-angle. Then the anchors, of which each
//! is a linear program of its own (`linear_program.rs`): the lowest point along the axis in front of
//! all planes, and the highest one behind them. As heights over the plane across the axis, with
//! `base` as the origin, plane j is at n_j · (p_j − base − x) / (n_j · n), so that these are the
//! lowest point of what is highest, and the highest of what is lowest.
//!
//! # Why the anchors are safe
//!
//! What the programs say of a place across is taken as it comes: a wrong one makes the bound looser,
//! not false. The height there is measured on every plane, and is off by some 2⁻⁵³ of the coordinates
//! that went into it, as is the anchor when it is stored. And a normal may be off by ε, about p_j: an
//! anchor b in front of the plane as it is known may then lie ε |b − p_j| behind the true one. So it
//! moves along the axis by
//!
//! ```text
//! t = max_j (n_j · (p_j − b) + ε |p_j − b| + 2⁻⁴⁹ (|p_j| + |b|)) / (n_j · n − ε)
//! ```
//!
//! or not at all if that is below 0. The cosine in the denominator is above 0.17.

use drypoint_bounds::{MAX_HALF_ANGLE, Plane};
use glam::{DVec2, DVec3};

use super::cone::{ConePair, share_of_ball};
use super::gilbert::nearest_to_origin;
use super::linear_program::{Height, lowest_place};

/// What a normal may be off by, in radians: 2⁻²³. It is trusted to 1e-7.
const NORMAL_ERROR: f64 = 1.0 / (1u32 << 23) as f64;

/// What a height may be off by, as a share of the coordinates that went into it: 2⁻⁴⁹.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Where viewpoints are, when nothing else is known: anywhere in a ball, with equal chances.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    /// In model units.
    pub(super) center: DVec3,
    /// Above 0.
    pub(super) radius: f64,
}

/// The cones of a set of planes, and what is worth to be known of them.
#[derive(Clone, Debug)]
pub(super) struct Bound {
    pub(super) cones: ConePair,
    /// Probability that a viewpoint is in neither cone, 0 ..= 1.
    pub(super) open: f64,
    /// The planes that hold it up, a dozen at most or so: those by which the axis was found, and
    /// those on which the anchors rest.
    pub(super) support: Vec<u32>,
}

/// Makes bounds; keeps room for them.
#[derive(Debug)]
pub(super) struct Bounder<'a> {
    planes: &'a [Plane],
    ball: Ball,
    /// How far, across the axis, an anchor may be from the planes' first point; in model units.
    reach: f64,
    normals: Vec<DVec3>,
    heights: Vec<Height>,
}

impl<'a> Bounder<'a> {
    pub(super) fn new(planes: &'a [Plane], ball: Ball, reach: f64) -> Self {
        Self { planes, ball, reach, normals: Vec::new(), heights: Vec::new() }
    }

    /// The cones of the planes of these numbers. `None` if there are none, if the normals spread
    /// wider than [`MAX_HALF_ANGLE`], or if anything is not finite. Some 10 scans.
    pub(super) fn bound(&mut self, numbers: &[u32]) -> Option<Bound> {
        let plane = |number: &u32| &self.planes[*number as usize];
        self.normals.clear();
        self.normals.extend(numbers.iter().map(|number| plane(number).normal));
        let nearest = nearest_to_origin(&self.normals, MAX_HALF_ANGLE.cos())?;
        let axis = nearest.point.normalize();
        let half_angle = half_angle(axis, &self.normals) + NORMAL_ERROR;
        if half_angle.is_nan() || half_angle > MAX_HALF_ANGLE {
            return None;
        }
        let base = plane(numbers.first()?).point;
        let (right, up) = axis.any_orthonormal_pair();
        let frame = Frame { base, axis, right, up };
        self.heights.clear();
        self.heights.extend(numbers.iter().map(|number| frame.height(plane(number))));
        let mut support = nearest.support().to_vec();
        let front = self.anchor(numbers, &frame, 1.0, &mut support);
        let mut back_support = nearest.support().to_vec();
        self.heights.iter_mut().for_each(|height| *height = -*height);
        let back = self.anchor(numbers, &frame, -1.0, &mut back_support);
        support.extend(back_support);
        support.sort_unstable();
        support.dedup();
        let sin = half_angle.sin();
        let cones = ConePair { front, back, axis, sin_squared: sin * sin };
        let is_finite = front.is_finite() && back.is_finite();
        is_finite.then(|| Bound {
            cones,
            open: self.open(&cones, sin),
            support: support.into_iter().map(|index| numbers[index]).collect(),
        })
    }

    /// The lowest point along `sign` times the axis that is in front of every plane, if the planes are
    /// turned over where `sign` is −1, not 1, and the heights with them.
    fn anchor(&self, numbers: &[u32], frame: &Frame, sign: f64, support: &mut Vec<usize>) -> DVec3 {
        let place = lowest_place(&self.heights, self.reach, support);
        let height = largest(self.heights.iter().map(|height| height.at(place)));
        let up = sign * frame.axis;
        let anchor = frame.base + place.x * frame.right + place.y * frame.up + height * up;
        let lift = |number: &u32| {
            let Plane { normal, point } = self.planes[*number as usize];
            let to_point = point - anchor;
            let size = point.abs().max_element() + anchor.abs().max_element();
            let doubt = NORMAL_ERROR * to_point.length() + ROUNDING * size;
            (sign * normal.dot(to_point) + doubt) / (normal.dot(frame.axis) - NORMAL_ERROR)
        };
        anchor + largest(numbers.iter().map(lift).chain([0.0])) * up
    }

    /// Probability that a viewpoint in the ball is in neither cone. How far the anchors are from the
    /// line through its center along the axis is left out: as a share of the radius, it counts by its
    /// square only.
    fn open(&self, cones: &ConePair, sin: f64) -> f64 {
        let height = |anchor: DVec3| (anchor - self.ball.center).dot(cones.axis) / self.ball.radius;
        let front = share_of_ball(sin, height(cones.front));
        let back = share_of_ball(sin, -height(cones.back));
        (1.0 - front - back).clamp(0.0, 1.0)
    }
}

/// The plane across the axis.
struct Frame {
    base: DVec3,
    axis: DVec3,
    right: DVec3,
    up: DVec3,
}

impl Frame {
    fn height(&self, plane: &Plane) -> Height {
        let rise = plane.normal.dot(self.axis);
        Height {
            at_start: plane.normal.dot(plane.point - self.base) / rise,
            slope: -DVec2::new(plane.normal.dot(self.right), plane.normal.dot(self.up)) / rise,
        }
    }
}

/// The largest angle between the unit `axis` and a normal, in radians, to within rounding. NaN if
/// anything is.
fn half_angle(axis: DVec3, normals: &[DVec3]) -> f64 {
    // Of a narrow cone, √(1 − cos²) is lost to cancellation.
    let sin = largest(normals.iter().map(|normal| normal.cross(axis).length_squared())).sqrt();
    sin.atan2(-largest(normals.iter().map(|normal| -normal.dot(axis))))
}

/// The largest of some values; NaN if one is.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
    values.fold(f64::NEG_INFINITY, larger)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BALL: Ball = Ball { center: DVec3::ZERO, radius: 10.0 };

    fn plane(normal: DVec3, point: DVec3) -> Plane {
        Plane { normal: normal.normalize(), point }
    }

    fn bound(planes: &[Plane]) -> Option<Bound> {
        let numbers: Vec<u32> = (0..).take(planes.len()).collect();
        Bounder::new(planes, BALL, 5.0).bound(&numbers)
    }

    /// The sides of a pyramid with its tip at `tip`, each at 45°.
    fn pyramid(tip: DVec3) -> Vec<Plane> {
        let sides = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
        sides.map(|side| plane(DVec3::Z + side, tip + side - DVec3::Z)).to_vec()
    }

    #[test]
    fn both_anchors_are_the_tip_of_a_pyramid() {
        let tip = DVec3::new(1.0, 2.0, 3.0);
        let bound = bound(&pyramid(tip)).unwrap();
        let ConePair { front, back, axis, sin_squared } = bound.cones;
        assert!(axis.distance(DVec3::Z) < 1e-12, "{axis}");
        assert!((sin_squared - 0.5).abs() < 1e-6 && sin_squared > 0.5, "{sin_squared}");
        assert!((front.z - tip.z).abs() < 1e-5 && front.z > tip.z, "{front}");
        assert!(back.distance(tip) < 10.0 && back.z < tip.z, "{back}");
        assert!((2..=4).contains(&bound.support.len()), "{:?}", bound.support);
    }

    /// A pyramid without its tip: the front cone may start above the top, the back one below it.
    #[test]
    fn each_anchor_is_where_its_own_planes_allow() {
        let tip = DVec3::new(1.0, 2.0, 3.0);
        let top = plane(DVec3::Z, tip - DVec3::Z);
        let bound = bound(&[pyramid(tip), vec![top]].concat()).unwrap();
        assert!(bound.cones.front.distance(tip) < 1e-5, "{}", bound.cones.front);
        assert!((bound.cones.back.z - top.point.z).abs() < 1e-5, "{}", bound.cones.back);
        assert!((bound.open - 0.5f64.sqrt()).abs() < 0.2, "{}", bound.open);
    }

    #[test]
    fn what_cannot_be_bounded_has_no_cones() {
        assert!(bound(&[]).is_none());
        let fold = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let side = |sign: f64| plane(DVec3::new(sign * sin, 0.0, cos), DVec3::ZERO);
            bound(&[side(1.0), side(-1.0)])
        };
        assert!(fold(79.9).is_some());
        assert!(fold(80.0).is_none());
        assert!(fold(90.0).is_none());
        let up = plane(DVec3::Z, DVec3::ZERO);
        assert!(bound(&[up, Plane { normal: DVec3::NAN, ..up }]).is_none());
        assert!(bound(&[up, Plane { point: DVec3::NAN, ..up }]).is_none());
        assert!(bound(&[up, Plane { point: f64::MAX * DVec3::ONE, ..up }]).is_none());
    }
}
