//! What can go wrong.

use ash::vk;

/// Why something could not be made, recorded or read. Nothing was done then, unless it says so.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// There is no Vulkan on this system.
    #[error("no Vulkan driver can be loaded: {reason}")]
    NoVulkan {
        /// What the loader said.
        reason: String,
    },
    /// None of the devices can do what is needed.
    #[error("no Vulkan device has what mesh shaders need: {reason}")]
    NoDevice {
        /// What each of them lacks.
        reason: String,
    },
    /// Validation was asked for, and is not installed.
    #[error("the Vulkan validation layer VK_LAYER_KHRONOS_validation is not installed")]
    NoValidation,
    /// The device lacks something that the call cannot do without.
    #[error("the Vulkan device lacks {feature}, which {what} needs")]
    MissingFeature {
        /// What it lacks.
        feature: &'static str,
        /// What needs it.
        what: &'static str,
    },
    /// The device was lost. All that was made from it is void.
    #[error("the Vulkan device was lost")]
    DeviceLost,
    /// No memory is left for it.
    #[error("the Vulkan device is out of memory for {what}")]
    OutOfMemory {
        /// What needed it.
        what: &'static str,
    },
    /// The driver refused it.
    #[error("the Vulkan driver refused {what}: {reason}")]
    Refused {
        /// What it refused.
        what: &'static str,
        /// What it said.
        reason: String,
    },
    /// A shader is not valid.
    #[error("the shader of {what} is not valid: {reason}")]
    Shader {
        /// What it is of.
        what: &'static str,
        /// What the compiler says, with line and column.
        reason: String,
    },
    /// A buffer would be larger than the device's limits for one.
    #[error("{what}: {bytes} bytes are needed, this Vulkan device allows {limit} in one buffer")]
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
    /// Contours were made for mesh shaders with workgroups of other sizes, or that record segments where these do not,
    /// or the reverse.
    #[error(
        "the contours were made for mesh shaders with other workgroups, or that record segments where these do not"
    )]
    OtherPass,
    /// It was made in commands that were never executed.
    #[error("{what} was made in commands that were never executed")]
    Abandoned {
        /// What.
        what: &'static str,
    },
    /// Contours are found and drawn in the commands that they were prepared in.
    #[error("the contours were not prepared in these commands")]
    Unprepared,
    /// A pass was recorded before its look and its matrix: see [`MeshPass::prepare`](crate::MeshPass::prepare).
    #[error("the pass was not prepared: it has no matrix and no look of lines")]
    NoStyle,
    /// A surface goes with the contours that it was made for.
    #[error("the surface was made for other contours")]
    OtherContours,
    /// Queries are under way that do not go with it: see [`Counting`](crate::Counting).
    #[error("while shaders are counted, there cannot be {what}")]
    Counting {
        /// What.
        what: &'static str,
    },
    /// A pass of mesh shaders was to have more lanes or edges in a workgroup than the device or this crate allows.
    #[error("{asked} lanes were asked for {what}, 1 to {most} are allowed")]
    Lanes {
        /// What they are of.
        what: &'static str,
        /// How many were asked for.
        asked: u32,
        /// How many are allowed.
        most: u32,
    },
    /// Each round of a mesh workgroup has an edge for every lane.
    #[error("{edges} edges of a mesh workgroup are not a multiple of its {lanes} lanes")]
    UnevenLanes {
        /// Edges that were asked for.
        edges: u32,
        /// Lanes of the workgroup.
        lanes: u32,
    },
    /// What is rendered to has other formats than the pipeline was made for.
    #[error(
        "{what} is made for {expected:?} and {expected_depth:?} for depth, rendering is to {color:?} and {depth:?}"
    )]
    OtherAttachments {
        /// What is recorded.
        what: &'static str,
        /// Color that it is made for.
        expected: Option<vk::Format>,
        /// Depth that it is made for.
        expected_depth: Option<vk::Format>,
        /// Color that is rendered to.
        color: Option<vk::Format>,
        /// Depth that is rendered to.
        depth: Option<vk::Format>,
    },
    /// The device cannot draw to images of that format as it would have to.
    #[error("the Vulkan device cannot use the format {format:?} for {what}")]
    Format {
        /// The format.
        format: vk::Format,
        /// For what.
        what: &'static str,
    },
    /// What a call was given changed places with that of another.
    #[error("the commands were exchanged for others while they were recorded")]
    Exchanged,
    /// A surface is made from the meshes that the model's parts were made from.
    #[error("the meshes of the surface are not those that the model was made from")]
    OtherMeshes,
    /// The device has no images of that size.
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
    /// A content was put together by other means, and not well.
    #[error("the content of the model refers to {what} that are not there")]
    Inconsistent {
        /// To what.
        what: &'static str,
    },
    /// Patches were asked for from a model that was made without.
    #[error("the model was made from a mesh without patches: brute force is all it can do")]
    NoPatches,
    /// Not all contour edges fit the output.
    #[error("{needed} segments were found, there is room for {capacity}")]
    Overflow {
        /// Number of segments found.
        needed: u64,
        /// Number that fits.
        capacity: u32,
    },
    /// Two things that must be of one device are not.
    #[error("made for another Vulkan device: {what}")]
    OtherDevice {
        /// What.
        what: &'static str,
    },
    /// What is to be read was recorded into other commands than those that were executed.
    #[error("not begun and ended in these commands, or asked for in others: {what}")]
    OtherCommands {
        /// What.
        what: &'static str,
    },
}

impl Error {
    /// What a call of the driver came back with.
    pub(crate) fn of(what: &'static str, result: vk::Result) -> Self {
        match result {
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY
            | vk::Result::ERROR_OUT_OF_HOST_MEMORY
            | vk::Result::ERROR_OUT_OF_POOL_MEMORY
            | vk::Result::ERROR_TOO_MANY_OBJECTS => Self::OutOfMemory { what },
            vk::Result::ERROR_DEVICE_LOST => Self::DeviceLost,
            other => Self::Refused { what, reason: other.to_string() },
        }
    }
}
