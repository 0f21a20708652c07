//! The double cone measured on the planes themselves, with no sphere in between.
//!
//! A plane j with unit normal n_j through p_j crosses the line o + h n at the height
//! h_j = n_j · (p_j − o) / (n_j · n). With t the largest |h_j|, the upper cone, whose apex is at
//! o + t n and whose sides climb at α, is in front of every plane: it starts above each, and none
//! climbs faster. So t is as small as the line and α allow; with o half-way between the highest
//! and the lowest crossing, as small as the line allows. A sphere's t, r / cos α, is never smaller:
//! planes that meet the sphere cross the line within that. For a cap of radius R of a ball it is
//! some R α, and here some R α² / 4.
//!
//! The axis is that of the smallest cap around the normals, the line is placed where the planes
//! cross it close together (`least_spread.rs`), and then both are rounded to f32. Only after that α
//! and t are measured, about what is stored, so that rounding either costs nothing else.
//!
//! # Why f32 is safe
//!
//! What `double_cone.rs` says about the arithmetic at run time holds here as it is: α grows by
//! [`SLACK`](crate::SLACK), and t by that share of itself over cos α. The center is no source of
//! error any more, so that t does not grow with its size. Left are, in f64:
//!
//! - **The normals.** Say each is off by an angle ε; the plane still passes through p_j. Then its angle
//!   to the axis grows by ε, which α pays, and its height above o is at most what comes of
//!   |n_j · (p_j − o)| + ε |p_j − o| for the numerator and n_j · n − ε for the denominator, which t
//!   pays. How far the face reaches and how far away the viewpoint is does not matter: that α and t
//!   hold the true plane is all that is asked for.
//! - **The points.** One that was computed, like the middle of an edge, is off its plane by some
//!   2⁻⁵³ of its coordinates, and p_j − o and the product lose as much again. The numerator grows by
//!   2⁻⁵⁰ times their size, a millionth of what f32 rounds them by.
//!
//! Measured, on 1.5 million views of worst planes (`ring_3_rim_of_the_tight_cone`): with no growth at
//! all 2.5 % are lost, 1 unit of [`SLACK`](crate::SLACK) loses 521, 2 lose 9, 3 none. Of normals that
//! are off by 1e-7, seen so, 0.5 % are lost for all of the slack if ε is 0, and none with the one below.

use glam::DVec3;

use crate::NormalCone;
use crate::cap::smallest_cap;
use crate::cone::is_unit;
use crate::double_cone::{DoubleCone, MAX_HALF_ANGLE};
use crate::least_spread::point_of_least_spread;
use crate::sphere::largest;

/// What a normal may be off by, in radians: 2⁻²³. The cross product of two f64 edge vectors is that
/// good down to corner angles of 1e-8.
const NORMAL_ERROR: f64 = 1.0 / (1u32 << 23) as f64;

/// What a height may be off by, as a share of the coordinates that went into it: 2⁻⁵⁰.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// An oriented plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Unit vector towards its front, trusted to 1e-7 radians.
    pub normal: DVec3,
    /// Any point on it, in model units. The middle of an edge serves both of its faces.
    pub point: DVec3,
}

impl DoubleCone {
    /// The tight bound: the narrowest cone around the normals, and the smallest distance between its
    /// apexes that holds the planes.
    ///
    /// [`DoubleCone::ALWAYS`] if there are none, if α is above [`MAX_HALF_ANGLE`], or if a normal is
    /// not of unit length or a number is NaN or does not fit an f32. Linear: 10 to 20 scans.
    pub fn tight(planes: impl Iterator<Item = Plane> + Clone) -> Self {
        let Some(cap) = smallest_cap(planes.clone().map(|plane| plane.normal)) else {
            return Self::ALWAYS;
        };
        Self::about(cap.axis, point_of_least_spread(&cap, planes.clone()), planes)
    }

    /// The tightest bound about the line through `point` along the unit `axis`, both rounded to f32
    /// first. Three scans.
    ///
    /// Never looser than what [`From`] makes of a sphere about the same line, but for what normals
    /// are trusted to: 1e-7 of the distance to the farthest of the planes' points. [`ALWAYS`] where
    /// [`DoubleCone::tight`] says.
    ///
    /// [`ALWAYS`]: DoubleCone::ALWAYS
    pub fn about(axis: DVec3, point: DVec3, planes: impl Iterator<Item = Plane> + Clone) -> Self {
        if !is_unit(axis) || planes.clone().next().is_none() {
            return Self::ALWAYS;
        }
        let stored_axis = axis.as_vec3();
        let axis = stored_axis.as_dvec3().normalize();
        let cone = NormalCone::around(axis, planes.clone().map(|plane| plane.normal));
        let half_angle = cone.half_angle() + NORMAL_ERROR;
        if half_angle > MAX_HALF_ANGLE {
            return Self::ALWAYS;
        }
        let heights = planes.clone().map(|p| p.normal.dot(p.point - point) / p.normal.dot(axis));
        let (low, high) = heights
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| {
                (low.min(height), high.max(height))
            });
        let center = (point + 0.5 * (low + high) * axis).as_vec3();
        let crossing = |plane: Plane| farthest_crossing(plane, center.as_dvec3(), axis);
        Self::inflated(center, stored_axis, half_angle, largest(planes.map(crossing)))
    }
}

/// How far from `center`, at most, a plane crosses the line along the unit `axis`. NaN if anything
/// is.
fn farthest_crossing(Plane { normal, point }: Plane, center: DVec3, axis: DVec3) -> f64 {
    let to_point = point - center;
    let size = point.abs().max_element() + center.abs().max_element();
    let doubt = NORMAL_ERROR * to_point.length() + ROUNDING * size;
    (normal.dot(to_point).abs() + doubt) / (normal.dot(axis) - NORMAL_ERROR)
}
