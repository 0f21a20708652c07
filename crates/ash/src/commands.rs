//! Recording into a command buffer of the caller's.

use std::any::Any;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use ash::vk;

use crate::binding::Set;
use crate::memory::{Buffer, Image};
use crate::pipeline::Pipeline;
use crate::queries::{Counting, Pool};
use crate::{Device, Error};

/// Records into a command buffer, and keeps what is recorded from going before it has executed.
#[derive(Debug)]
pub struct Commands {
    device: Device,
    raw: vk::CommandBuffer,
    id: u64,
    kept: Vec<Arc<dyn Any + Send + Sync>>,
    /// What is being counted, and where.
    counting: Option<(Counting, Vec<Arc<Pool>>)>,
    fate: Fate,
}

/// Whether commands came to nothing: what they were to write holds anything then.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fate {
    is_abandoned: Arc<AtomicBool>,
}

impl Fate {
    /// The commands will never execute.
    pub(crate) fn abandon(&self) {
        self.is_abandoned.store(true, Ordering::Release);
    }

    /// Fails if it is so, for what was made in them.
    pub(crate) fn check(&self, what: &'static str) -> Result<(), Error> {
        if self.is_abandoned.load(Ordering::Acquire) {
            Err(Error::Abandoned { what })
        } else {
            Ok(())
        }
    }
}

/// What a command buffer uses: to be kept until it has executed, or will not be any more.
#[derive(Debug)]
#[must_use = "what the commands use goes with it"]
pub struct Recorded {
    id: u64,
    _kept: Vec<Arc<dyn Any + Send + Sync>>,
}

/// That commands have executed: what they were to download can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Executed {
    id: u64,
}

/// What was copied to where the processor sees it, once the commands have executed.
#[derive(Debug)]
pub(crate) struct Download {
    what: &'static str,
    id: u64,
    buffer: Buffer,
}

/// What touches memory, for barriers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Use {
    stages: vk::PipelineStageFlags,
    access: vk::AccessFlags,
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
    const READ_BY_HOST: Self = Self::new(vk::PipelineStageFlags::HOST, vk::AccessFlags::HOST_READ);
    /// Shaders and arguments of all kinds.
    pub(crate) const USED_BY_SHADERS: Self =
        Self::USED_BY_COMPUTE.and(Self::USED_BY_DRAWING).and(Self::READ_AS_ARGUMENTS);
}

/// Most bytes of one update, a limit of Vulkan.
const UPDATE: usize = 65_536;

impl Commands {
    /// Records into the caller's command buffer.
    ///
    /// # Safety
    /// `raw` is of `device` and of a queue family with graphics and compute; it is being recorded, by this thread
    /// alone, and is no secondary one. What is recorded by other means meanwhile leaves no rendering open at
    /// calls on this value. It executes no more than once for each recording, after all that was recorded before
    /// it, on one queue or with semaphores between; if it never does, what was made and prepared in it is not used
    /// any more. [`Commands::finish`] is called, after an error too, and what it gives is kept until the command
    /// buffer has executed, or will not be any more.
    pub unsafe fn from_raw(device: &Device, raw: vk::CommandBuffer) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        let id = NEXT.fetch_add(1, Ordering::Relaxed);
        Self {
            device: device.clone(),
            raw,
            id,
            kept: Vec::new(),
            counting: None,
            fate: Fate::default(),
        }
    }

    /// Ends recording through this value; the command buffer may be recorded on by other means.
    pub fn finish(mut self) -> Recorded {
        self.end_counting();
        Recorded { id: self.id, _kept: self.kept }
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The command buffer.
    pub fn raw(&self) -> vk::CommandBuffer {
        self.raw
    }

    /// What becomes of them.
    pub(crate) fn fate(&self) -> &Fate {
        &self.fate
    }

    /// What tells these commands from others.
    pub(crate) fn id(&self) -> u64 {
        self.id
    }

    /// Begins the only query of each pool.
    pub(crate) fn count<'a>(
        &mut self,
        counting: Counting,
        pools: impl Iterator<Item = &'a Arc<Pool>>,
    ) -> Result<(), Error> {
        if self.counting.is_some() {
            return Err(Error::Counting { what: "more queries" });
        }
        let pools: Vec<_> = pools.cloned().collect();
        for pool in &pools {
            self.keep(pool.clone());
            let flags = vk::QueryControlFlags::empty();
            // SAFETY: no rendering is open, and nothing else is counted; the pool is kept, and no commands used it
            // before, but such as have executed.
            unsafe {
                self.device.raw().cmd_reset_query_pool(self.raw, pool.raw(), 0, 1);
                self.device.raw().cmd_begin_query(self.raw, pool.raw(), 0, flags);
            }
        }
        self.counting = Some((counting, pools));
        Ok(())
    }

    /// Ends what was begun, if anything was.
    pub(crate) fn end_counting(&mut self) {
        for pool in self.counting.take().into_iter().flat_map(|(_, pools)| pools) {
            // SAFETY: it was begun in these commands, and not ended.
            unsafe { self.device.raw().cmd_end_query(self.raw, pool.raw(), 0) };
        }
    }

    /// What is being counted.
    pub(crate) fn counting(&self) -> Option<Counting> {
        self.counting.as_ref().map(|(counting, _)| *counting)
    }

    pub(crate) fn check(&self, device: &Device, what: &'static str) -> Result<(), Error> {
        if self.device.is(device) { Ok(()) } else { Err(Error::OtherDevice { what }) }
    }

    pub(crate) fn keep(&mut self, kept: Arc<dyn Any + Send + Sync>) {
        self.kept.push(kept);
    }

    /// All that is done before and of `before` is done before what is of `after`.
    pub(crate) fn barrier(&mut self, before: Use, after: Use) {
        let memory = vk::MemoryBarrier::default()
            .src_access_mask(before.access)
            .dst_access_mask(after.access);
        // SAFETY: no rendering is open; stages are those of the features that the device must have.
        unsafe {
            self.device.raw().cmd_pipeline_barrier(
                self.raw,
                before.stages,
                after.stages,
                vk::DependencyFlags::empty(),
                &[memory],
                &[],
                &[],
            );
        }
    }

    /// The same for an image, which goes from one layout to another; what was in it is lost if the first one
    /// is undefined.
    pub(crate) fn transition(
        &mut self,
        image: &Image,
        (before, from): (Use, vk::ImageLayout),
        (after, to): (Use, vk::ImageLayout),
    ) {
        self.keep(image.kept());
        let barrier = vk::ImageMemoryBarrier::default()
            .src_access_mask(before.access)
            .dst_access_mask(after.access)
            .old_layout(from)
            .new_layout(to)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(image.raw())
            .subresource_range(image.range());
        // SAFETY: as for a barrier; the image is kept.
        unsafe {
            self.device.raw().cmd_pipeline_barrier(
                self.raw,
                before.stages,
                after.stages,
                vk::DependencyFlags::empty(),
                &[],
                &[],
                &[barrier],
            );
        }
    }

    /// Writes `bytes`, a multiple of 4, to the beginning of a buffer. They lie in the command buffer until then.
    pub(crate) fn update(&mut self, buffer: &Buffer, bytes: &[u8]) {
        assert!(bytes.len() as u64 <= buffer.size(), "there is room for what is written");
        self.keep(buffer.kept());
        for (piece, bytes) in (0..).zip(bytes.chunks(UPDATE)) {
            let offset = piece * UPDATE as u64;
            // SAFETY: the buffer is kept, and has room.
            unsafe { self.device.raw().cmd_update_buffer(self.raw, buffer.raw(), offset, bytes) };
        }
    }

    /// Makes all of a buffer 0.
    pub(crate) fn clear(&mut self, buffer: &Buffer) {
        self.keep(buffer.kept());
        // SAFETY: the buffer is kept.
        unsafe {
            self.device.raw().cmd_fill_buffer(self.raw, buffer.raw(), 0, vk::WHOLE_SIZE, 0);
        }
    }

    /// A new buffer of the device's own with `bytes` in it, once this has executed and a barrier came.
    pub(crate) fn upload(
        &mut self,
        what: &'static str,
        bytes: &[u8],
        usage: vk::BufferUsageFlags,
    ) -> Result<Buffer, Error> {
        let size = bytes.len() as u64;
        let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
        let buffer = Buffer::new(&self.device, what, size, usage)?;
        if size > 0 {
            let staging = Buffer::to_upload(&self.device, what, bytes)?;
            self.copy(&staging, &buffer, size);
        }
        Ok(buffer)
    }

    /// Copies the first `size` bytes.
    fn copy(&mut self, from: &Buffer, to: &Buffer, size: u64) {
        assert!(size <= from.size().min(to.size()), "it is there, and there is room for it");
        self.keep(from.kept());
        self.keep(to.kept());
        let region = vk::BufferCopy::default().size(size);
        // SAFETY: both are kept, and as large as that.
        unsafe { self.device.raw().cmd_copy_buffer(self.raw, from.raw(), to.raw(), &[region]) };
    }

    /// Copies a buffer, after a barrier that the caller has recorded.
    pub(crate) fn download(
        &mut self,
        what: &'static str,
        buffer: &Buffer,
    ) -> Result<Download, Error> {
        let target = Buffer::to_download(&self.device, what, buffer.size())?;
        self.copy(buffer, &target, buffer.size());
        self.barrier(Use::COPIED_TO, Use::READ_BY_HOST);
        Ok(Download { what, id: self.id, buffer: target })
    }

    /// Copies an image of 4 bytes a pixel, which is in the layout to be copied from.
    pub(crate) fn download_image(
        &mut self,
        what: &'static str,
        image: &Image,
    ) -> Result<Download, Error> {
        let [width, height] = image.size();
        let size = 4 * u64::from(width) * u64::from(height);
        let target = Buffer::to_download(&self.device, what, size)?;
        self.keep(image.kept());
        self.keep(target.kept());
        let layers = vk::ImageSubresourceLayers::default()
            .aspect_mask(image.range().aspect_mask)
            .layer_count(1);
        let region = vk::BufferImageCopy::default()
            .image_subresource(layers)
            .image_extent(vk::Extent3D { width, height, depth: 1 });
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        // SAFETY: both are kept, and the buffer has room for all pixels.
        unsafe {
            self.device.raw().cmd_copy_image_to_buffer(
                self.raw,
                image.raw(),
                layout,
                target.raw(),
                &[region],
            );
        }
        self.barrier(Use::COPIED_TO, Use::READ_BY_HOST);
        Ok(Download { what, id: self.id, buffer: target })
    }

    /// Chooses a pipeline and what it binds: for each set in turn, offsets of its pieces.
    pub(crate) fn bind(&mut self, pipeline: &Pipeline, sets: &[(&Set, &[u32])]) {
        self.keep(pipeline.kept());
        let device = self.device.raw();
        // SAFETY: pipeline and sets are kept, and the sets are of the layouts that the pipeline was made with.
        unsafe { device.cmd_bind_pipeline(self.raw, pipeline.point(), pipeline.raw()) };
        for (index, (set, offsets)) in (0..).zip(sets) {
            self.kept.push(set.kept());
            // SAFETY: as above; offsets are of pieces within their buffers.
            unsafe {
                self.device.raw().cmd_bind_descriptor_sets(
                    self.raw,
                    pipeline.point(),
                    pipeline.layout(),
                    index,
                    &[set.raw()],
                    offsets,
                );
            }
        }
    }

    pub(crate) fn dispatch(&mut self, [x, y]: [u32; 2]) {
        // SAFETY: a compute pipeline is bound with all that it needs.
        unsafe { self.device.raw().cmd_dispatch(self.raw, x, y, 1) };
    }
}

impl Recorded {
    /// That what was recorded has executed.
    ///
    /// # Safety
    /// The command buffer was submitted once and has executed, as a fence or waiting for the device has told.
    pub unsafe fn assume_executed(self) -> Executed {
        Executed { id: self.id }
    }
}

impl Executed {
    /// Whether it is that of the commands of this number.
    pub(crate) fn is_of(&self, id: Option<u64>) -> bool {
        id == Some(self.id)
    }
}

impl Download {
    /// What was copied.
    pub(crate) fn read(&self, executed: &Executed) -> Result<&[u8], Error> {
        if !executed.is_of(Some(self.id)) {
            return Err(Error::OtherCommands { what: self.what });
        }
        Ok(self.buffer.bytes())
    }
}
