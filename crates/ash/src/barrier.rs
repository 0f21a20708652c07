//! What barriers lie between.

use ash::vk;

/// What touches memory, for barriers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Use {
    pub(crate) stages: vk::PipelineStageFlags,
    pub(crate) access: vk::AccessFlags,
}

/// Reads of whatever draws: of vertices and in shaders.
const DRAWING: vk::PipelineStageFlags = vk::PipelineStageFlags::from_raw(
    vk::PipelineStageFlags::VERTEX_INPUT.as_raw()
        | vk::PipelineStageFlags::VERTEX_SHADER.as_raw()
        | vk::PipelineStageFlags::TASK_SHADER_EXT.as_raw()
        | vk::PipelineStageFlags::MESH_SHADER_EXT.as_raw()
        | vk::PipelineStageFlags::FRAGMENT_SHADER.as_raw(),
);

impl Use {
    const fn new(stages: vk::PipelineStageFlags, access: vk::AccessFlags) -> Self {
        Self { stages, access }
    }

    pub(crate) const fn and(self, other: Self) -> Self {
        Self {
            stages: vk::PipelineStageFlags::from_raw(self.stages.as_raw() | other.stages.as_raw()),
            access: vk::AccessFlags::from_raw(self.access.as_raw() | other.access.as_raw()),
        }
    }

    /// Whatever came before.
    pub(crate) const ANYTHING: Self =
        Self::new(vk::PipelineStageFlags::ALL_COMMANDS, vk::AccessFlags::MEMORY_WRITE);
    pub(crate) const COPIED_TO: Self =
        Self::new(vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_WRITE);
    pub(crate) const COPIED_FROM: Self =
        Self::new(vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_READ);
    pub(crate) const WRITTEN_BY_COMPUTE: Self =
        Self::new(vk::PipelineStageFlags::COMPUTE_SHADER, vk::AccessFlags::SHADER_WRITE);
    pub(crate) const READ_BY_COMPUTE: Self = Self::new(
        vk::PipelineStageFlags::COMPUTE_SHADER,
        vk::AccessFlags::from_raw(
            vk::AccessFlags::SHADER_READ.as_raw() | vk::AccessFlags::UNIFORM_READ.as_raw(),
        ),
    );
    pub(crate) const USED_BY_COMPUTE: Self = Self::WRITTEN_BY_COMPUTE.and(Self::READ_BY_COMPUTE);
    pub(crate) const READ_BY_DRAWING: Self = Self::new(
        DRAWING,
        vk::AccessFlags::from_raw(
            vk::AccessFlags::SHADER_READ.as_raw()
                | vk::AccessFlags::UNIFORM_READ.as_raw()
                | vk::AccessFlags::INDEX_READ.as_raw()
                | vk::AccessFlags::VERTEX_ATTRIBUTE_READ.as_raw(),
        ),
    );
    pub(crate) const WRITTEN_BY_DRAWING: Self = Self::new(DRAWING, vk::AccessFlags::SHADER_WRITE);
    pub(crate) const USED_BY_DRAWING: Self = Self::READ_BY_DRAWING.and(Self::WRITTEN_BY_DRAWING);
    pub(crate) const READ_AS_ARGUMENTS: Self =
        Self::new(vk::PipelineStageFlags::DRAW_INDIRECT, vk::AccessFlags::INDIRECT_COMMAND_READ);
    pub(crate) const SAMPLED: Self =
        Self::new(vk::PipelineStageFlags::FRAGMENT_SHADER, vk::AccessFlags::SHADER_READ);
    pub(crate) const DRAWN_TO: Self = Self::new(
        vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT,
        vk::AccessFlags::from_raw(
            vk::AccessFlags::COLOR_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::COLOR_ATTACHMENT_WRITE.as_raw(),
        ),
    );
    pub(crate) const DEPTH_TESTED: Self = Self::new(
        vk::PipelineStageFlags::from_raw(
            vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS.as_raw()
                | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS.as_raw(),
        ),
        vk::AccessFlags::from_raw(
            vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
                | vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
        ),
    );
    pub(crate) const READ_BY_HOST: Self =
        Self::new(vk::PipelineStageFlags::HOST, vk::AccessFlags::HOST_READ);
    /// Shaders and arguments of all kinds.
    pub(crate) const USED_BY_SHADERS: Self =
        Self::USED_BY_COMPUTE.and(Self::USED_BY_DRAWING).and(Self::READ_AS_ARGUMENTS);
}
