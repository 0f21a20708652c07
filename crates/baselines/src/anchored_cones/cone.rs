//! The two cones of a node, and the test of a viewpoint against them.
//!
//! With d the vector from an anchor to the viewpoint and h = n · d, a viewpoint is inside the cone
//! around n if and only if h > 0 and h² > sin² α d², α being the largest angle between n and a normal
//! of the node: the cones open by 90° − α. From inside the front one every face is seen from the
//! front, from inside the back one, around −n, every face from the back.
//!
//! # Why f64 is safe
//!
//! Let u = 2⁻⁵³. Rounding d turns it by 2 u at most; n is of unit length to within 2 u; h is off by
//! 4 u|d|, and the three products of the comparison by 5 u of themselves. What passes for inside is
//! so for cones that open wider by 16 u / cos α: below 1e-14 radians, as α is 80° at most. α was grown
//! by 2⁻²³ for normals that are off by 1e-7, and that leaves 1.9e-8. The anchors are safe as
//! they are stored (`bound.rs`).

use drypoint_mesh::Viewpoint;
use glam::DVec3;

/// The least height above an anchor that is culled: its square is far from where f64 loses digits,
/// and a viewpoint this close to an anchor is a chance of none.
const LEAST_HEIGHT: f64 = 1e-140;

/// Two anchored cones with one axis and one half-angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ConePair {
    /// Apex of the cone of viewpoints in front of every face, in model units.
    pub(super) front: DVec3,
    /// Apex of the cone of viewpoints behind every face.
    pub(super) back: DVec3,
    /// Unit vector, up to rounding, into the front cone.
    pub(super) axis: DVec3,
    /// sin² of the half-angle α of the normals, grown.
    pub(super) sin_squared: f64,
}

impl ConePair {
    /// Never culled: with a zero axis every height is 0.
    pub(super) const ALWAYS: Self =
        Self { front: DVec3::ZERO, back: DVec3::ZERO, axis: DVec3::ZERO, sin_squared: 1.0 };

    /// Whether the viewpoint is in neither cone, so that faces may look both ways: `false` is
    /// certain. Four dot products at most; `true` if anything is NaN or too large to square.
    #[inline]
    pub(super) fn may_hold_contour(&self, viewpoint: Viewpoint) -> bool {
        let is_inside = |anchor: DVec3, sign: f64| {
            let d = viewpoint.from_point(anchor);
            let h = sign * self.axis.dot(d);
            h > LEAST_HEIGHT && h * h > self.sin_squared * d.length_squared()
        };
        !is_inside(self.front, 1.0) && !is_inside(self.back, -1.0)
    }
}

/// Share of the unit ball around the origin that lies in a cone with its apex on its axis, at
/// `height`, which opens by 90° − α. 0 if the apex is above the ball; one below counts as on it.
///
/// The rim, where cone and sphere meet, is a circle of radius ρ at z along the axis. The sector of
/// the ball above it has the volume 2π (1 − z) / 3, and what lies between the sector's sides and the
/// cone's is π ρ² height / 3 less.
pub(super) fn share_of_ball(sin_alpha: f64, height: f64) -> f64 {
    let height = height.clamp(-1.0, 1.0);
    let (sin_squared, cos) = (1.0 - sin_alpha * sin_alpha, sin_alpha);
    let length = (1.0 - height * height * sin_squared).sqrt() - height * cos;
    let (z, rim_squared) = (height + length * cos, length * length * sin_squared);
    (0.5 * (1.0 - z) - 0.25 * rim_squared * height).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inside_and_outside() {
        // Normals within 30° of z: the cones open by 60°.
        let cones = ConePair {
            front: DVec3::new(1.0, 0.0, 2.0),
            back: DVec3::new(3.0, 0.0, -1.0),
            axis: DVec3::Z,
            sin_squared: 0.25,
        };
        let at = |x, z| cones.may_hold_contour(Viewpoint::at(DVec3::new(x, 0.0, z)));
        let at_anchors = [at(1.0, 2.0), at(1.0, 2.1), at(1.0, 1.9), at(3.0, -1.0)];
        assert_eq!(at_anchors, [true, false, true, true]);
        let above = [at(2.7, 3.0), at(2.8, 3.0), at(-0.7, 3.0), at(-0.8, 3.0)];
        assert_eq!(above, [false, true, false, true]);
        let below = [at(4.7, -2.0), at(4.8, -2.0), at(1.3, -2.0), at(1.2, -2.0)];
        assert_eq!(below, [false, true, false, true]);
        let along = |x, z| cones.may_hold_contour(Viewpoint::from_direction(DVec3::new(x, 0.0, z)));
        assert_eq!([along(1.7, 1.0), along(1.8, 1.0), along(0.0, 0.0)], [false, true, true]);
        assert_eq!([along(1.7e-60, -1e-60), along(1.8e-60, -1e-60)], [false, true]);
    }

    #[test]
    fn nothing_is_culled_from_nowhere() {
        let narrow = ConePair { axis: DVec3::Z, sin_squared: 1e-14, ..ConePair::ALWAYS };
        for viewpoint in [1.0, 1e30, f64::NAN].map(|z| Viewpoint::at(z * DVec3::Z)) {
            assert!(ConePair::ALWAYS.may_hold_contour(viewpoint));
        }
        for z in [0.0, 1e-150, 1e160, f64::NAN, f64::INFINITY] {
            assert!(narrow.may_hold_contour(Viewpoint::at(z * DVec3::Z)), "{z}");
            assert!(narrow.may_hold_contour(Viewpoint::from_direction(z * DVec3::Z)), "{z}");
        }
    }

    /// The same from the cubes of the distances to the sphere, summed over the directions in the cone.
    #[test]
    fn the_share_is_the_volume() {
        for alpha in [0.0, 0.3, 1.0, 1.5f64] {
            for height in [-1.0, -0.6, 0.0, 0.1, 0.9, 1.0] {
                let steps = 20_000;
                let lowest = alpha.sin();
                let step = (1.0 - lowest) / f64::from(steps);
                let cubed = |i: i32| {
                    let cos = lowest + (f64::from(i) + 0.5) * step;
                    let sin_squared = 1.0 - cos * cos;
                    ((1.0 - height * height * sin_squared).sqrt() - height * cos).powi(3)
                };
                let expected = 0.5 * step * (0..steps).map(cubed).sum::<f64>();
                let share = share_of_ball(alpha.sin(), height);
                assert!(
                    (share - expected).abs() < 1e-5,
                    "{alpha} {height}: {share} for {expected}"
                );
            }
        }
        assert_eq!(share_of_ball(0.3, 7.0), 0.0);
        assert_eq!(share_of_ball(0.3, -7.0), share_of_ball(0.3, -1.0));
    }
}
