//! The bound as the papers give it: a normal cone and a sphere.

use drypoint_mesh::Viewpoint;

use crate::{NormalCone, Sphere};

/// What the test below may be off by, as a share of the distance: some 10 units of 2⁻⁵³.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Bounds a set of planes: every normal is in the cone, every plane meets the sphere.
///
/// Johnson and Cohen, Spatialized Normal Cone Hierarchies, I3D 2001; for the two faces of every
/// edge of a patch, Tsiapkolis and Bénard, Patch Decomposition for Efficient Mesh Contours
/// Extraction, CGF 2024, §3. Build it with [`NormalCone::mean`] and [`Sphere::mean`] or
/// [`Sphere::reduced`] for theirs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpatializedNormalCone {
    /// Holds the normals.
    pub cone: NormalCone,
    /// Met by the planes.
    pub sphere: Sphere,
}

impl SpatializedNormalCone {
    /// Whether one plane may face the viewpoint and another face away: `false` is certain. With s
    /// the unit vector from the center of the sphere towards the viewpoint and d their distance, it
    /// survives if
    ///
    /// ```text
    /// |axis · s| ≤ sin(α + β),   sin β = radius / d     (β = 0 for an orthographic view)
    /// ```
    ///
    /// or α + β reaches 90° (Tsiapkolis and Bénard, eq. 1). Here times d, so that nothing is
    /// divided, with the sine of the sum in terms of its parts. In f64 and grown by its rounding:
    /// the reference that [`DoubleCone`](crate::DoubleCone) is compared with, and not for speed.
    ///
    /// Always `true` if the cone is open, the viewpoint is inside the sphere, or anything is NaN.
    pub fn may_hold_contour(&self, viewpoint: Viewpoint) -> bool {
        let NormalCone { axis, sin, cos } = self.cone;
        let to_viewpoint = viewpoint.from_point(self.sphere.center);
        let distance = to_viewpoint.length();
        let radius = viewpoint.w() * self.sphere.radius;
        // sin β < cos α, and not if anything is NaN.
        let is_below_a_right_angle = radius < cos * distance;
        if !is_below_a_right_angle {
            return true;
        }
        let tangent = ((distance - radius) * (distance + radius)).sqrt();
        let height = axis.dot(to_viewpoint).abs();
        let is_culled = height > sin * tangent + cos * radius + ROUNDING * distance;
        !is_culled
    }

    /// Probability that it survives, for viewpoints at `distance` from the center of the sphere in
    /// a direction drawn uniformly: H = sin(α + β), 1 if α + β reaches 90° (Tsiapkolis and Bénard,
    /// eq. 3). `distance` in model units, infinite for orthographic views; 1 if it is NaN.
    pub fn acceptance(&self, distance: f64) -> f64 {
        acceptance(&self.cone, self.sphere.radius, distance)
    }
}

/// sin(α + asin(radius / distance)).
pub(crate) fn acceptance(cone: &NormalCone, radius: f64, distance: f64) -> f64 {
    let is_below_a_right_angle = radius < cone.cos * distance;
    if !is_below_a_right_angle {
        return 1.0;
    }
    let sin_beta = radius / distance;
    let cos_beta = ((1.0 - sin_beta) * (1.0 + sin_beta)).sqrt();
    (cone.sin * cos_beta + cone.cos * sin_beta).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn bound(half_angle: f64, radius: f64) -> SpatializedNormalCone {
        let cone = NormalCone { axis: DVec3::Z, sin: half_angle.sin(), cos: half_angle.cos() };
        SpatializedNormalCone { cone, sphere: Sphere { center: DVec3::X, radius } }
    }

    /// Half-angle 30°, radius 0.5, viewpoint at distance 1 from the center, so β is 30° too and the
    /// patch is culled within 30° of the axis, up or down.
    #[test]
    fn angles_add_up() {
        let bound = bound(30f64.to_radians(), 0.5);
        let at = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            bound.may_hold_contour(Viewpoint::at(DVec3::new(1.0 + sin, 0.0, cos)))
        };
        assert_eq!([0.0, 29.9, 30.1, 90.0].map(at), [false, false, true, true]);
        assert_eq!([180.0, 150.1, 149.9].map(at), [false, false, true]);
        let towards = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let direction = 1e-5 * DVec3::new(sin, 0.0, cos);
            bound.may_hold_contour(Viewpoint::from_direction(direction))
        };
        assert_eq!([59.9, 60.1, 120.1, 119.9].map(towards), [false, true, false, true]);
    }

    #[test]
    fn what_is_not_bounded_survives() {
        let above = Viewpoint::at(DVec3::new(1.0, 0.0, 9.0));
        let may_hold = |bound: SpatializedNormalCone| bound.may_hold_contour(above);
        assert!(!may_hold(bound(0.1, 0.5)));
        assert!(may_hold(bound(0.1, 9.0)), "inside the sphere");
        assert!(may_hold(bound(0.1, f64::INFINITY)));
        assert!(may_hold(bound(0.1, f64::NAN)));
        assert!(may_hold(bound(f64::NAN, 0.5)));
        assert!(may_hold(SpatializedNormalCone { cone: NormalCone::OPEN, ..bound(0.1, 0.5) }));
        assert!(bound(0.1, 0.5).may_hold_contour(Viewpoint::at(DVec3::NAN)));
        assert!(bound(0.1, 0.5).may_hold_contour(Viewpoint::from_direction(DVec3::ZERO)));
    }

    #[test]
    fn acceptance_is_a_sine() {
        let bound = bound(30f64.to_radians(), 0.5);
        assert!((bound.acceptance(1.0) - 60f64.to_radians().sin()).abs() < 1e-14);
        assert!((bound.acceptance(f64::INFINITY) - 0.5).abs() < 1e-14);
        assert_eq!([0.5, 0.0, -1.0, f64::NAN].map(|d| bound.acceptance(d)), [1.0; 4]);
        let open = SpatializedNormalCone { cone: NormalCone::OPEN, ..bound };
        assert_eq!(open.acceptance(f64::INFINITY), 1.0);
    }
}
