//! Descriptor set layouts. Equal ones are compatible, so that each maker of sets or pipelines has its own.

use ash::vk::ShaderStageFlags as Stages;

use crate::binding::{IMAGE, Layout, STORAGE, STORAGE_PIECE, UNIFORM, UNIFORM_PIECE};
use crate::{Device, Error};

const FINDING: Stages = Stages::from_raw(
    Stages::COMPUTE.as_raw() | Stages::TASK_EXT.as_raw() | Stages::MESH_EXT.as_raw(),
);
const MESHING: Stages = Stages::from_raw(Stages::TASK_EXT.as_raw() | Stages::MESH_EXT.as_raw());
const DRAWING: Stages = Stages::from_raw(
    Stages::VERTEX.as_raw() | Stages::MESH_EXT.as_raw() | Stages::FRAGMENT.as_raw(),
);

/// Planes, ends, patches, super-patches and blocks of these.
pub(crate) fn model(device: &Device) -> Result<Layout, Error> {
    Layout::new(device, "a model", FINDING, &[STORAGE; 5])
}

/// Work, counters, viewpoints and segments.
pub(crate) fn extraction(device: &Device) -> Result<Layout, Error> {
    let types = [UNIFORM_PIECE, STORAGE, STORAGE, STORAGE];
    Layout::new(device, "extraction", Stages::COMPUTE, &types)
}

/// Work, counters, totals and arguments.
pub(crate) fn tally(device: &Device) -> Result<Layout, Error> {
    let types = [UNIFORM_PIECE, STORAGE, STORAGE, STORAGE];
    Layout::new(device, "totals", Stages::COMPUTE, &types)
}

/// Work, counters, viewpoints, segments and their number.
pub(crate) fn mesh_draws(device: &Device) -> Result<Layout, Error> {
    let types = [UNIFORM_PIECE, STORAGE_PIECE, STORAGE, STORAGE, STORAGE];
    Layout::new(device, "draws of mesh shaders", MESHING, &types)
}

/// How lines look.
pub(crate) fn stroke(device: &Device) -> Result<Layout, Error> {
    Layout::new(device, "a line style", DRAWING, &[UNIFORM])
}

/// The size of a picture, and its depths.
pub(crate) fn line_target(device: &Device) -> Result<Layout, Error> {
    Layout::new(device, "a line target", DRAWING, &[UNIFORM, IMAGE])
}

/// Both of these at once.
pub(crate) fn mesh_strokes(device: &Device) -> Result<Layout, Error> {
    Layout::new(device, "strokes of mesh shaders", DRAWING, &[UNIFORM, UNIFORM, IMAGE])
}

/// Segments, vertices and transforms.
pub(crate) fn segments(device: &Device) -> Result<Layout, Error> {
    Layout::new(device, "segments", DRAWING, &[STORAGE; 3])
}

/// Vertices and transforms.
pub(crate) fn mesh_vertices(device: &Device) -> Result<Layout, Error> {
    Layout::new(device, "vertices of mesh shaders", DRAWING, &[STORAGE; 2])
}

/// The matrix to clip space.
pub(crate) fn depth_view(device: &Device) -> Result<Layout, Error> {
    Layout::new(device, "a view", DRAWING, &[UNIFORM])
}

/// Part and transforms.
pub(crate) fn surface(device: &Device) -> Result<Layout, Error> {
    Layout::new(device, "a surface", DRAWING, &[UNIFORM_PIECE, STORAGE])
}

/// What lines cover of a picture.
pub(crate) fn coverage(device: &Device) -> Result<Layout, Error> {
    Layout::new(device, "the coverage of lines", DRAWING, &[IMAGE])
}
