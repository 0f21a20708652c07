//! Where a part is, and where it is seen from.

use drypoint_mesh::Viewpoint;
use drypoint_shaders::Frame;
use glam::{DAffine3, Vec4};

/// Where a rigid part lies in the scene, and from where in the scene it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// From the space of the part, in model units, to that of the scene. Mirrored and unevenly scaled
    /// ones too, as long as there is an inverse.
    pub to_scene: DAffine3,
    /// In the space of the scene.
    pub viewpoint: Viewpoint,
}

impl Placement {
    /// A part that lies in the scene as it is.
    pub const fn at_origin(viewpoint: Viewpoint) -> Self {
        Self { to_scene: DAffine3::IDENTITY, viewpoint }
    }

    /// The viewpoint in the part's own space: which faces are seen from the front is the same there, up to
    /// a mirror that turns all of them over. `None` if the part is flattened.
    pub fn viewpoint_of_part(&self) -> Option<Viewpoint> {
        let from_scene = self.to_scene.inverse();
        let xyz = self.viewpoint.xyz();
        let (xyz, viewpoint) = if self.viewpoint.is_point() {
            let xyz = from_scene.transform_point3(xyz);
            (xyz, Viewpoint::at(xyz))
        } else {
            let xyz = from_scene.transform_vector3(xyz);
            (xyz, Viewpoint::from_direction(xyz))
        };
        xyz.is_finite().then_some(viewpoint)
    }

    /// The same as a shader takes it.
    pub(crate) fn viewpoint_in(&self, frame: &Frame) -> Option<Vec4> {
        self.viewpoint_of_part().map(|viewpoint| frame.viewpoint(viewpoint))
    }
}
