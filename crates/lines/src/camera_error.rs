//! What makes a view impossible.

use glam::DVec3;

/// Why there is no such view.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// A coordinate is NaN, infinite or beyond 1e60.
    #[error("{what} is ({}, {}, {}), which is not finite or beyond 1e60", point.x, point.y, point.z)]
    Coordinates {
        /// The parameter.
        what: &'static str,
        /// Its value.
        point: DVec3,
    },
    /// The eye is where it looks.
    #[error("eye and target are both at ({}, {}, {})", eye.x, eye.y, eye.z)]
    EyeAtTarget {
        /// That point.
        eye: DVec3,
    },
    /// The direction towards the viewer is zero.
    #[error("the direction of the view is (0, 0, 0)")]
    NoDirection,
    /// The direction that points up is zero.
    #[error("the direction up is (0, 0, 0)")]
    NoUp,
    /// The direction that was to point up points at the viewer, or away.
    #[error("up ({}, {}, {}) is parallel to the view", up.x, up.y, up.z)]
    UpParallel {
        /// That direction.
        up: DVec3,
    },
    /// The field of view is not between 0 and 180 degrees.
    #[error("a field of view of {degrees} degrees is not between 0 and 180")]
    FieldOfView {
        /// What was asked for.
        degrees: f64,
    },
    /// An orthographic view of no height.
    #[error("a view {height} units high is not above 0")]
    Height {
        /// What was asked for.
        height: f64,
    },
    /// A page without area, or too large.
    #[error("a page of {width} x {height} pixels is not between 1 and 65535 on each side")]
    Page {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// A margin that leaves no page.
    #[error("a margin of {margin} pixels leaves nothing of a page of {width} x {height}")]
    Margin {
        /// Pixels.
        margin: f64,
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
}
