//! Where a part is, and where it is seen from.

use drypoint_mesh::Viewpoint;
use glam::{DAffine3, Vec4};

use crate::{Frame, Transform};

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
    /// a mirror that turns all of them over. `None` if the part is flattened, or as small or as large as
    /// [`Viewpoint::carried_into`] says.
    pub fn viewpoint_of_part(&self) -> Option<Viewpoint> {
        self.viewpoint.carried_into(&self.to_scene)
    }

    /// The same as a shader takes it, in the `frame` of the part.
    fn viewpoint_in(&self, frame: &Frame) -> Option<Vec4> {
        self.viewpoint_of_part().map(|viewpoint| frame.viewpoint(viewpoint))
    }
}

/// What shaders read of placements: part p of instance i is at `i * frames.len() + p`. Replaces what the
/// vectors hold; some 50 ns each.
///
/// # Errors
/// The index of a placement without an inverse. Both vectors are empty then.
pub fn place(
    frames: &[Frame],
    placements: &[Placement],
    viewpoints: &mut Vec<Vec4>,
    transforms: &mut Vec<Transform>,
) -> Result<(), usize> {
    viewpoints.clear();
    transforms.clear();
    for (index, placement) in placements.iter().enumerate() {
        let Some(viewpoint) = placement.viewpoint_in(&frames[index % frames.len()]) else {
            viewpoints.clear();
            transforms.clear();
            return Err(index);
        };
        viewpoints.push(viewpoint);
        transforms.push(Transform::from(placement.to_scene));
    }
    Ok(())
}
