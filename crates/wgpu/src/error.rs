//! What can go wrong.

use drypoint_shaders::PoseError;

/// Why something could not be made, recorded or read. Nothing was done then, unless it says so.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// No graphics driver offers what is needed.
    #[error("no GPU adapter is available: {reason}")]
    NoAdapter {
        /// What the drivers said.
        reason: String,
    },
    /// The adapter is there, but gave no device.
    #[error("{adapter} gives no device: {reason}")]
    NoDevice {
        /// Its name.
        adapter: String,
        /// What the driver said.
        reason: String,
    },
    /// The device lacks something that the call cannot do without.
    #[error("the GPU device lacks {feature}, which {what} needs")]
    MissingFeature {
        /// What it lacks.
        feature: &'static str,
        /// What needs it.
        what: &'static str,
    },
    /// The device was lost or destroyed. All that was made from it is void.
    #[error("the GPU device was lost")]
    DeviceLost,
    /// No memory is left for it.
    #[error("the GPU is out of memory for {what}")]
    OutOfMemory {
        /// What needed it.
        what: &'static str,
    },
    /// The device refused it: a fault of this crate, or of the driver.
    #[error("the GPU refused {what}: {reason}")]
    Refused {
        /// What it refused.
        what: &'static str,
        /// What it said.
        reason: String,
    },
    /// A buffer would be larger than the device's limits for one.
    #[error("{what} takes {bytes} bytes, this GPU device allows {limit} in one buffer")]
    TooLarge {
        /// What is in it.
        what: &'static str,
        /// Its size.
        bytes: u64,
        /// The device's limit.
        limit: u64,
    },
    /// More placements than there is room for.
    #[error("{given} placements are given, there is room for {capacity}")]
    TooManyPlacements {
        /// Number of placements given.
        given: usize,
        /// The capacity that the output was made with.
        capacity: u32,
    },
    /// Each instance needs a placement for each part of the model.
    #[error("{given} placements are not a multiple of the model's {parts} parts")]
    UnevenPlacements {
        /// Number of placements given.
        given: usize,
        /// Number of parts of the model.
        parts: u32,
    },
    /// A placement flattens its part, or is not finite: there is no viewpoint in its space.
    #[error("placement {index} has no inverse")]
    SingularPlacement {
        /// Its index.
        index: usize,
    },
    /// More instances of a rig than there is room for.
    #[error("{given} instances are given, there is room for {capacity}")]
    TooManyInstances {
        /// Number of instances given.
        given: usize,
        /// The capacity that the output was made with.
        capacity: u32,
    },
    /// The placement of an instance of a rig flattens it, or is not finite.
    #[error("the placement of instance {instance} has no inverse")]
    SingularInstance {
        /// Its index.
        instance: u32,
    },
    /// A pose has not as many carriers and weights as the rig.
    #[error("the pose of instance {instance} is of another rig")]
    OtherPose {
        /// Index of the instance.
        instance: u32,
    },
    /// A pose has a carrier or a weight that is not finite.
    #[error("the pose of instance {instance} is not finite")]
    InfinitePose {
        /// Index of the instance.
        instance: u32,
    },
    /// A rig is uploaded with the patches of its shapes, in their order.
    #[error("the patches are not those of the rig's shapes")]
    OtherPatches,
    /// A surface is made from the meshes that the model's parts were made from.
    #[error("the meshes of the surface are not those that the model was made from")]
    OtherMeshes,
    /// The device has no textures of that size.
    #[error("a picture of {width} x {height} pixels is not within 1 and {limit} pixels a side")]
    PictureSize {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
        /// Most pixels a side.
        limit: u32,
    },
    /// A model needs a part.
    #[error("a model needs at least one part")]
    NoParts,
    /// Patches were asked for from a model that was made without.
    #[error("the model was made from a mesh without patches: brute force is all it can do")]
    NoPatches,
    /// Not all contour edges fit the output; those that do are there.
    #[error("{needed} segments were found, there is room for {capacity}")]
    Overflow {
        /// Number of segments found.
        needed: u64,
        /// Number that fits.
        capacity: u32,
    },
}

impl From<PoseError> for Error {
    fn from(error: PoseError) -> Self {
        match error {
            PoseError::Singular(instance) => Self::SingularInstance { instance },
            PoseError::Other(instance) => Self::OtherPose { instance },
            PoseError::Infinite(instance) => Self::InfinitePose { instance },
        }
    }
}
