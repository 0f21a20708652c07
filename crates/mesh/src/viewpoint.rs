//! Where we look from.

use glam::DVec3;

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
}
