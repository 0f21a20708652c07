//! The bound as it is evaluated at run time: two cones, apex to apex.
//!
//! Let w be the vector from the center to the viewpoint, h = axis · w its height, p = w − h axis
//! what is left across the axis, and t = r / cos α. The test of Tsiapkolis and Bénard (CGF 2024,
//! eq. 1), times the distance and sorted by h and |p|, says that a patch is culled if and only if
//!
//! ```text
//! |h| > t   and   (|h| − t)² > tan² α · |p|²
//! ```
//!
//! which is the pair of anchored cones of Sander et al. (Silhouette Clipping, SIGGRAPH 2000) with
//! apexes at center ± t axis and half-angle 90° − α. From inside the upper one, all faces are seen
//! from the front, from inside the lower one, all from the back.
//!
//! # Why f32 is safe
//!
//! Let u = 2⁻²⁴, half a unit in the last place of 1. Compared with exact arithmetic on the stored
//! floats, rounding w, the axis' length and the three products and two sums of h makes h wrong by
//! at most 5 u|w|. Of the errors of p, those along the axis only lengthen it; w, the three products
//! and three subtractions turn it by at most 2.5 u|w|. Squares, sum and factor add 2 u|p|, and
//! (|h| − t)² adds 1.5 u (|h| − t). Where the test tips, |w| ≤ t + |p| / cos α, so that all that
//! together is at most
//!
//! ```text
//! (5 + 2.5 tan α) u t   +   (5 / cos α + 3.5 tan α + 2.5 tan α / cos α) u |p|
//! ```
//!
//! Growing t by 8 u t / cos α pays for the first term. Growing α by 8 u makes the cone wider by
//! 8 u |p| / cos² α there, which pays for the second at any α below 90°. Rounding the center of a
//! sphere moves it by √3 u times its largest coordinate at most, for which t grows by 8 u of that,
//! over cos α; `tight.rs` measures t about the rounded one instead. Multiplications and additions may
//! be fused or taken in any order: that only takes roundings away.
//!
//! Measured, on a million worst planes each (`ring_3_rim_of_the_double_cone`): 2 units lose some,
//! 3 none.

use bytemuck::{Pod, Zeroable};
use drypoint_mesh::Viewpoint;
use glam::Vec3;

use crate::cone::is_unit;
use crate::spatialized::acceptance;
use crate::{NormalCone, SpatializedNormalCone};

/// What pays for f32, 8 units of 2⁻²⁴: the half-angle α grows by that many radians, and t by that
/// share of itself and of the size of the center's coordinates, whose own rounding is larger than
/// the patch if it is far from the origin. Over cos α, as t is radius over cos α.
pub const SLACK: f64 = 8.0 / (1u32 << 24) as f64;

/// The largest half-angle α that is culled at all, in radians: 80°. Wider cones are seldom culled,
/// and the tangent grows beyond what the slack was made for.
pub const MAX_HALF_ANGLE: f64 = 80.0 * std::f64::consts::PI / 180.0;

/// The least |h| − t that is culled, in model units: 2⁻⁴⁷. Its square is 2²⁵ times what squares
/// lose that f32 cannot hold (those below 2⁻¹²⁶, three times 1 + tan² 80°), so that nothing is
/// culled by mistake at any scale, even where such numbers are flushed to zero. The price: a mesh
/// smaller than 1e-14 units is never culled.
pub const MIN_CLEARANCE: f32 = 1.0 / (1u64 << 47) as f32;

/// Two cones of viewpoints, apex to apex: from inside either, no plane that it bounds is seen
/// from another side than the rest.
///
/// 8 floats, as a GPU reads them; [`Zeroable::zeroed`] is [`DoubleCone::ALWAYS`]. Squares of the
/// distance to the viewpoint must fit an f32: from beyond 1e19 units, nothing is culled.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct DoubleCone {
    /// The point half-way between the apexes, in model units.
    pub center: Vec3,
    /// Distance t from the center to each apex along the axis, in model units; 0 or more, rounded
    /// up. For a sphere of radius r it is r / cos α.
    pub apex_distance: f32,
    /// Unit vector, up to rounding, into the cone from which all planes are seen from the front.
    /// Zero in [`DoubleCone::ALWAYS`].
    pub axis: Vec3,
    /// tan² of the half-angle α of the normals, rounded up; the cones open by 90° − α.
    pub tan_squared: f32,
}

impl DoubleCone {
    /// Never culled: with a zero axis every height is 0. What has no bound gets this one.
    pub const ALWAYS: Self =
        Self { center: Vec3::ZERO, apex_distance: 0.0, axis: Vec3::ZERO, tan_squared: 0.0 };

    /// Whether one plane may face the viewpoint and another face away: `false` is certain.
    ///
    /// The vector to the viewpoint is taken in f64 and then rounded once, so that a viewpoint close
    /// to a mesh far from the origin is not moved. A shader that is given a viewpoint of f32 gets
    /// the same vector from one f32 subtraction. The direction of an orthographic view is
    /// normalized first, so that its squares fit; a shader should be handed it so. To take the
    /// contours from one viewpoint and cull from another, rounded one loses edges.
    pub fn may_hold_contour(&self, viewpoint: Viewpoint) -> bool {
        if viewpoint.is_point() {
            let to_viewpoint = viewpoint.from_point(self.center.as_dvec3());
            self.may_hold_contour_towards(to_viewpoint.as_vec3(), 1.0)
        } else {
            self.may_hold_contour_towards(viewpoint.xyz().normalize_or_zero().as_vec3(), 0.0)
        }
    }

    /// The same, in f32 alone, operation by operation as a shader does it: `to_viewpoint` is the
    /// vector from the center, and `w` is 1, or 0 for an orthographic view, where only angles count.
    ///
    /// About 20 multiplications and additions. `true` if anything is NaN, or too large to square.
    #[inline]
    pub fn may_hold_contour_towards(&self, to_viewpoint: Vec3, w: f32) -> bool {
        let height = self.axis.dot(to_viewpoint);
        // As a vector: the difference of squares |to_viewpoint|² − height² is noise near the axis.
        let across = to_viewpoint - height * self.axis;
        let clearance = height.abs() - w * self.apex_distance;
        // NaN, and infinity on both sides, are not culled.
        let is_culled = clearance > MIN_CLEARANCE
            && clearance * clearance > self.tan_squared * across.length_squared();
        !is_culled
    }

    /// Probability that it survives, for viewpoints at `distance` from its center in a direction
    /// drawn uniformly: H = sin(α + asin(t cos α / distance)), 1 if that angle reaches 90°
    /// (Tsiapkolis and Bénard, CGF 2024, eq. 3). `distance` in model units, infinite for
    /// orthographic views; 1 if it is NaN.
    pub fn acceptance(&self, distance: f64) -> f64 {
        let tan = f64::from(self.tan_squared).sqrt();
        // A zero axis makes this 0: open.
        let cos = self.axis.as_dvec3().length() / tan.hypot(1.0);
        let cone = NormalCone { axis: self.axis.as_dvec3(), sin: tan * cos, cos };
        acceptance(&cone, f64::from(self.apex_distance) * cos, distance)
    }

    /// Grown by what pays for the arithmetic at run time, and rounded up. What it is measured about
    /// is stored as it is: α is `half_angle`, in radians, and t is `apex_distance`, in model units.
    ///
    /// [`DoubleCone::ALWAYS`] if a number is NaN or does not fit an f32.
    pub(crate) fn inflated(center: Vec3, axis: Vec3, half_angle: f64, apex_distance: f64) -> Self {
        let half_angle = half_angle + SLACK;
        let growth = SLACK * apex_distance / half_angle.cos();
        let bound = Self {
            center,
            apex_distance: round_up(apex_distance + growth),
            axis,
            tan_squared: round_up(half_angle.tan().powi(2)),
        };
        if bound.center.is_finite() && bound.apex_distance.is_finite() {
            bound
        } else {
            Self::ALWAYS
        }
    }
}

/// Rounds outward, so that whatever `bound` keeps, in f64, is kept in f32. What rounding turned the
/// axis by is measured; [`SLACK`] pays for the rest, and for the arithmetic at run time.
///
/// [`DoubleCone::ALWAYS`] if α is above [`MAX_HALF_ANGLE`], the axis is not of unit length, or a
/// number is NaN or does not fit an f32.
impl From<SpatializedNormalCone> for DoubleCone {
    fn from(bound: SpatializedNormalCone) -> Self {
        let SpatializedNormalCone { cone, sphere } = bound;
        let (axis, center) = (cone.axis.as_vec3(), sphere.center.as_vec3());
        let tilt = axis.as_dvec3().cross(cone.axis).length();
        if cone.half_angle() > MAX_HALF_ANGLE || !is_unit(cone.axis) {
            return Self::ALWAYS;
        }
        let half_angle = cone.half_angle() + tilt;
        let wider = half_angle + SLACK;
        let moved = SLACK * f64::from(center.abs().max_element()) / wider.cos();
        Self::inflated(center, axis, half_angle, sphere.radius / wider.cos() + moved)
    }
}

/// The least f32 that is not below `x`.
fn round_up(x: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "the next line mends what is lost")]
    let nearest = x as f32;
    if f64::from(nearest) < x { nearest.next_up() } else { nearest }
}

#[cfg(test)]
mod tests {
    use std::mem::offset_of;

    use glam::DVec3;

    use super::*;
    use crate::Sphere;

    fn bound(half_angle: f64, center: DVec3, radius: f64) -> SpatializedNormalCone {
        let cone = NormalCone { axis: DVec3::Z, sin: half_angle.sin(), cos: half_angle.cos() };
        SpatializedNormalCone { cone, sphere: Sphere { center, radius } }
    }

    fn double(half_angle: f64, radius: f64) -> DoubleCone {
        DoubleCone::from(bound(half_angle, DVec3::X, radius))
    }

    #[test]
    fn a_gpu_reads_eight_floats() {
        assert_eq!(size_of::<DoubleCone>(), 32);
        assert_eq!(offset_of!(DoubleCone, center), 0);
        assert_eq!(offset_of!(DoubleCone, apex_distance), 12);
        assert_eq!(offset_of!(DoubleCone, axis), 16);
        assert_eq!(offset_of!(DoubleCone, tan_squared), 28);
    }

    /// Half-angle 45° and radius √½ put the apexes at ±1 and let the cones open by 45°.
    #[test]
    fn the_apexes_are_where_they_should_be() {
        let cone = double(45f64.to_radians(), 0.5f64.sqrt());
        assert!((cone.apex_distance - 1.0).abs() < 1e-5 && cone.apex_distance > 1.0);
        assert!((cone.tan_squared - 1.0).abs() < 1e-5 && cone.tan_squared > 1.0);
        let at = |x, z| cone.may_hold_contour(Viewpoint::at(DVec3::new(1.0 + x, 0.0, z)));
        let heights = [0.999, 1.001, -0.999, -1.001];
        assert_eq!(heights.map(|z| at(0.0, z)), [true, false, true, false]);
        assert_eq!(heights.map(|z| at(5.0, 5.0 * z)), [true; 4]);
        assert_eq!(heights.map(|z| at(5.0, z + 5.0 * z.signum())), [true, false, true, false]);
        let along = |x, z| cone.may_hold_contour(Viewpoint::from_direction(DVec3::new(x, 0.0, z)));
        assert_eq!(heights.map(|z| along(1e-20, 1e-20 * z)), [true, false, true, false]);
        assert_eq!(heights.map(|z| along(1e30, 1e30 * z)), [true, false, true, false]);
    }

    #[test]
    fn what_has_no_bound_gets_always() {
        assert_eq!(DoubleCone::ALWAYS, DoubleCone::zeroed());
        let always = [
            bound(80.1f64.to_radians(), DVec3::X, 0.5),
            bound(f64::NAN, DVec3::X, 0.5),
            bound(0.1, DVec3::X, f64::NAN),
            bound(0.1, DVec3::X, f64::INFINITY),
            bound(0.1, DVec3::X, 1e39),
            bound(0.1, DVec3::splat(1e39), 0.5),
            bound(0.1, DVec3::NAN, 0.5),
            SpatializedNormalCone { cone: NormalCone::OPEN, ..bound(0.1, DVec3::X, 0.5) },
            SpatializedNormalCone {
                cone: NormalCone { axis: DVec3::NAN, ..bound(0.1, DVec3::X, 0.5).cone },
                ..bound(0.1, DVec3::X, 0.5)
            },
        ];
        for bound in always {
            assert_eq!(DoubleCone::from(bound), DoubleCone::ALWAYS, "{bound:?}");
        }
        assert_ne!(double(79.9f64.to_radians(), 0.5), DoubleCone::ALWAYS);
        assert_eq!(DoubleCone::ALWAYS.acceptance(f64::INFINITY), 1.0);
        for viewpoint in [
            Viewpoint::at(DVec3::Z),
            Viewpoint::at(1e30 * DVec3::Z),
            Viewpoint::at(DVec3::NAN),
            Viewpoint::from_direction(DVec3::Z),
            Viewpoint::from_direction(DVec3::ZERO),
        ] {
            assert!(DoubleCone::ALWAYS.may_hold_contour(viewpoint));
        }
    }

    /// The axis is +Z and t is a thousandth; `viewpoint` and t are in units of 10^`exponent`.
    fn may_hold_contour_at_scale(exponent: i32, half_angle: f64, viewpoint: DVec3) -> bool {
        let scale = 10f64.powi(exponent);
        let cone =
            DoubleCone::from(bound(half_angle, DVec3::ZERO, 1e-3 * half_angle.cos() * scale));
        cone.may_hold_contour(Viewpoint::at(scale * viewpoint))
    }

    /// Where f32 loses the squares of p before those of the height, the latter win.
    #[test]
    fn nothing_is_culled_because_squares_overflow_or_vanish() {
        for (exponent, half_angle) in (-44..=38).flat_map(|e| [(e, 1e-3f64), (e, 1.2)]) {
            for x in 1..200 {
                let across = 0.1 * f64::from(x) * DVec3::new(1.0, 1.0, 0.0);
                // Below the cone by one part in a hundred.
                let height = 1e-3 + 0.99 * half_angle.tan() * across.length();
                for viewpoint in [across + height * DVec3::Z, across - height * DVec3::Z] {
                    let may_hold = may_hold_contour_at_scale(exponent, half_angle, viewpoint);
                    assert!(may_hold, "α {half_angle}, {viewpoint} · 1e{exponent}");
                }
            }
        }
    }

    #[test]
    fn most_scales_are_culled() {
        for exponent in -44..=38 {
            let far_above = may_hold_contour_at_scale(exponent, 1e-3, DVec3::new(1.0, 0.0, 9.0));
            let far_below = may_hold_contour_at_scale(exponent, 1e-3, DVec3::new(1.0, 0.0, -9.0));
            let is_in_range = (-15..=19).contains(&exponent);
            assert_eq!([!far_above, !far_below], [is_in_range; 2], "1e{exponent}");
        }
    }

    #[test]
    fn acceptance_follows_the_bound() {
        let (half_angle, radius) = (0.4, 0.3);
        let (bound, cone) = (bound(half_angle, DVec3::X, radius), double(half_angle, radius));
        for distance in [0.0, 0.3, 0.34, 1.0, 10.0, f64::INFINITY] {
            let difference = cone.acceptance(distance) - bound.acceptance(distance);
            assert!((0.0..1e-5).contains(&difference), "{distance}: {difference}");
        }
        assert_eq!(cone.acceptance(f64::NAN), 1.0);
    }
}
