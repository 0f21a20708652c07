//! Where f32 is accurate: around the middle of a mesh, in units of about its size.

use drypoint_bounds::{DoubleCone, SLACK};
use drypoint_mesh::Viewpoint;
use glam::{DVec3, Vec3, Vec4};

/// A space in which a mesh lies around the origin, with coordinates within 1 and the longest half-side
/// of its box above 1/2. Moved and scaled only, and scaled by a power of two.
///
/// A shader subtracts, multiplies and adds in f32. Around the origin that loses 2⁻²⁴ of a mesh's size; a
/// thousand sizes away from it, a thousand times as much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The origin, in model units.
    pub center: DVec3,
    /// Frame units for a model unit, a power of two above 0.
    pub scale: f64,
}

impl Frame {
    /// Around the box of `positions`. Around the origin, and not scaled, if there are none; not scaled
    /// if all are at one place.
    pub fn new(positions: impl IntoIterator<Item = Vec3>) -> Self {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for position in positions {
            low = low.min(position.as_dvec3());
            high = high.max(position.as_dvec3());
        }
        Self::of_box(low, high)
    }

    /// Around a box, in model units. Around the origin, and not scaled, if it holds nothing.
    pub(crate) fn of_box(low: DVec3, high: DVec3) -> Self {
        if !low.is_finite() {
            return Self { center: DVec3::ZERO, scale: 1.0 };
        }
        let half_side = (high - low).max_element() / 2.0;
        let scale = if half_side > 0.0 { 1.0 / power_of_two_above(half_side) } else { 1.0 };
        Self { center: (low + high) / 2.0, scale }
    }

    /// Where `position`, in model units, is in the frame.
    pub fn point(&self, position: DVec3) -> DVec3 {
        (position - self.center) * self.scale
    }

    /// A viewpoint as shaders take it: homogeneous, with w above 0 for a point and 0 for a direction,
    /// and no coordinate above 1. Rounded, by 2⁻²⁴ of each coordinate in the frame.
    pub fn viewpoint(&self, viewpoint: Viewpoint) -> Vec4 {
        self.homogeneous(viewpoint.xyz(), viewpoint.w())
    }

    /// The same of a viewpoint with any w from 0 on.
    pub(crate) fn homogeneous(&self, xyz: DVec3, w: f64) -> Vec4 {
        // So the scale need not be multiplied: that may be too much for f64.
        let (xyz, w) = (xyz - w * self.center, w / self.scale);
        // Of points that are near, w is 1. A power of two rounds nothing.
        let size = xyz.abs().max_element().max(w);
        let scale = if size > 0.0 { 1.0 / power_of_two_above(size) } else { 1.0 };
        (xyz.extend(w) * scale).as_vec4()
    }

    /// A bound of planes in model units as a bound of the same planes in the frame, grown by what
    /// rounding its center anew moves it. [`DoubleCone::ALWAYS`] if the result does not fit an f32.
    pub fn bound(&self, bound: &DoubleCone) -> DoubleCone {
        let center = self.point(bound.center.as_dvec3()).as_vec3();
        let tan_squared = f64::from(bound.tan_squared);
        // √3 · 2⁻²⁴ of the largest coordinate, over cos α along the axis, is what rounding moves it by.
        let moved = SLACK * f64::from(center.abs().max_element()) * (1.0 + tan_squared).sqrt();
        let apex_distance = f64::from(bound.apex_distance) * self.scale + moved;
        #[expect(clippy::cast_possible_truncation, reason = "rounded up next")]
        let apex_distance = (apex_distance as f32).next_up();
        if bound.axis == Vec3::ZERO || !center.is_finite() || !apex_distance.is_finite() {
            return DoubleCone::ALWAYS;
        }
        DoubleCone { center, apex_distance, ..*bound }
    }
}

/// The least power of two that is not below `size`, which is above 0. The largest there is beyond that.
fn power_of_two_above(size: f64) -> f64 {
    let exponent = size.log2().ceil().clamp(-1022.0, 1022.0);
    let power = exponent.exp2();
    if power < size { 2.0 * power } else { power }
}
