//! Where we look from.

use glam::{DAffine3, DVec3};

/// A point, or a direction at infinity, from which a mesh is seen: homogeneous, w = 1 or 0.
///
/// In f64, so that a viewpoint given in decimals or taken from a camera's matrix is not moved
/// before the exact predicates see it. Coordinates are finite, and 0 or within 1e-60 and 1e60 in
/// size: there the predicates are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    xyz: DVec3,
    w: f64,
}

impl Viewpoint {
    /// The viewpoint of a perspective view: the center of projection, in model units.
    pub const fn at(position: DVec3) -> Self {
        Self { xyz: position, w: 1.0 }
    }

    /// The viewpoint of an orthographic view: the direction from the scene **towards** the viewer,
    /// of any length above 0. From the zero direction every face is seen edge-on.
    pub const fn from_direction(towards_viewer: DVec3) -> Self {
        Self { xyz: towards_viewer, w: 0.0 }
    }

    /// The point or the direction.
    pub const fn xyz(&self) -> DVec3 {
        self.xyz
    }

    /// 1 for a point, 0 for a direction.
    pub const fn w(&self) -> f64 {
        self.w
    }

    /// Whether it is a point, seen in perspective.
    pub fn is_point(&self) -> bool {
        self.w != 0.0
    }

    /// The vector from `point` towards the viewpoint: xyz − w · point. Its length means nothing for
    /// a direction.
    pub fn from_point(&self, point: DVec3) -> DVec3 {
        self.xyz - self.w * point
    }

    /// The same viewpoint in a space that `to_scene` places in the scene: there each face is seen from
    /// the same side, if corners are turned over where `to_scene` mirrors. Rounded in f64.
    ///
    /// `None` if that space is flattened, or so small or so large that the viewpoint would leave the range
    /// that it may be in.
    pub fn carried_into(&self, to_scene: &DAffine3) -> Option<Self> {
        // Homogeneous, so that one rule serves both: a direction feels no translation.
        let relative = self.from_point(to_scene.translation);
        let xyz = to_scene.matrix3.inverse() * relative;
        let is_in_range = |x: f64| x == 0.0 || (1e-60..=1e60).contains(&x.abs());
        let is_flat = self.w == 0.0 && xyz == DVec3::ZERO && self.xyz != DVec3::ZERO;
        let carried = xyz.to_array().into_iter().all(is_in_range) && !is_flat;
        carried.then_some(Self { xyz, w: self.w })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DQuat};

    #[test]
    fn a_viewpoint_is_carried_with_its_kind() {
        let to_scene = DAffine3 {
            matrix3: DMat3::from_diagonal(DVec3::new(2.0, -4.0, 1.0)),
            translation: DVec3::new(1.0, 1.0, 1.0),
        };
        let carried = |viewpoint: Viewpoint| viewpoint.carried_into(&to_scene).unwrap();
        let point = DVec3::new(5.0, 9.0, -1.0);
        assert_eq!(carried(Viewpoint::at(point)), Viewpoint::at(DVec3::new(2.0, -2.0, -2.0)));
        assert_eq!(
            carried(Viewpoint::from_direction(point)),
            Viewpoint::from_direction(DVec3::new(2.5, -2.25, -1.0))
        );
    }

    #[test]
    fn no_viewpoint_is_carried_into_a_flat_space() {
        let view = [Viewpoint::at(DVec3::ONE), Viewpoint::from_direction(DVec3::ONE)];
        for scale in [0.0, 1e-100, f64::NAN, f64::INFINITY] {
            let scale = DVec3::new(1.0, scale, 1.0);
            let rotation = DQuat::from_rotation_x(0.3);
            let to_scene = DAffine3::from_scale_rotation_translation(scale, rotation, DVec3::ZERO);
            for viewpoint in view {
                assert_eq!(viewpoint.carried_into(&to_scene), None, "{scale}");
            }
        }
    }
}
