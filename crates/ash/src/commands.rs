//! Recording into a command buffer of the caller's.

use std::any::Any;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use ash::vk;

use crate::barrier::Use;
use crate::binding::Set;
use crate::execution::{Download, Fate, Recorded};
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
    /// Whether rendering was begun by us, and not ended: its value may have been forgotten.
    pub(crate) is_rendering: bool,
    fate: Fate,
    is_finished: bool,
}

/// Most bytes of one update, a limit of Vulkan.
const UPDATE: usize = 65_536;

impl Commands {
    /// Records into the caller's command buffer.
    ///
    /// # Safety
    /// `raw` is of `device` and of a queue family with graphics and compute, the same for all that is made from
    /// `device`; it is being recorded, by this thread alone, and is no secondary one. What is recorded by other means
    /// meanwhile leaves no rendering open and no query active at calls on this value. It executes no more than once
    /// for each recording, after all that was recorded before it, on one queue or with semaphores between; if it never
    /// does, what was made and prepared in it is not used any more. [`Commands::finish`] is called, after an error
    /// too, and what it gives is kept until the command buffer has executed, or will not be any more.
    pub unsafe fn from_raw(device: &Device, raw: vk::CommandBuffer) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        let id = NEXT.fetch_add(1, Ordering::Relaxed);
        Self {
            device: device.clone(),
            raw,
            id,
            kept: Vec::new(),
            counting: None,
            is_rendering: false,
            fate: Fate::default(),
            is_finished: false,
        }
    }

    /// Ends recording through this value; the command buffer may be recorded on by other means. Pipelines, descriptor
    /// sets, viewport and scissor are others then.
    pub fn finish(mut self) -> Recorded {
        self.end_rendering();
        self.end_counting();
        self.is_finished = true;
        Recorded { id: self.id, _kept: std::mem::take(&mut self.kept) }
    }

    /// Ends rendering that was begun here, if it is still open.
    pub(crate) fn end_rendering(&mut self) {
        if std::mem::take(&mut self.is_rendering) {
            // SAFETY: it was begun in these commands.
            unsafe { self.device.raw().cmd_end_rendering(self.raw) };
        }
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

    /// Begins the only query of each pool, after what was counted before.
    pub(crate) fn count<'a>(
        &mut self,
        counting: Counting,
        pools: impl Iterator<Item = &'a Arc<Pool>>,
    ) {
        self.end_counting();
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
    }

    /// Ends what was begun, if anything was.
    pub(crate) fn end_counting(&mut self) {
        self.end_rendering();
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
        self.end_rendering();
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
        self.end_rendering();
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
        self.end_rendering();
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
        self.end_rendering();
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
        self.end_rendering();
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
        Ok(self.downloaded(what, target, buffer.size()))
    }

    /// Copies an image of 4 bytes a pixel, which is in the layout to be copied from.
    pub(crate) fn download_image(
        &mut self,
        what: &'static str,
        image: &Image,
    ) -> Result<Download, Error> {
        self.end_rendering();
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
        Ok(self.downloaded(what, target, size))
    }

    fn downloaded(&self, what: &'static str, buffer: Buffer, size: u64) -> Download {
        let size = usize::try_from(size).expect("it lies in memory");
        Download { what, id: self.id, buffer, size }
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
        self.end_rendering();
        // SAFETY: a compute pipeline is bound with all that it needs.
        unsafe { self.device.raw().cmd_dispatch(self.raw, x, y, 1) };
    }
}

impl Drop for Commands {
    fn drop(&mut self) {
        if !self.is_finished {
            self.fate.abandon();
        }
    }
}
