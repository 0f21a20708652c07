//! Frames under way: while the device draws one, the next is recorded.

use std::error::Error;

use ash::vk;
use drypoint_ash::{
    Commands, CountedByCompute, Device, Executed, FoundByMesh, Gpu, Recorded, Statistics, Timer,
};

use crate::swapchain::Image;

/// All frames, in turn.
pub(crate) struct Frames {
    frames: [Frame; 2],
    next: usize,
}

/// What one frame is recorded and waited for with.
pub(crate) struct Frame {
    device: Device,
    queue: vk::Queue,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    /// Signalled when the image is there to be drawn to.
    acquired: vk::Semaphore,
    /// Signalled when what was submitted has executed.
    executed: vk::Fence,
    /// None if the device has no clock.
    timer: Option<Timer>,
    submitted: Option<Submitted>,
}

struct Submitted {
    recorded: Recorded,
    asked: Asked,
}

/// What a frame is asked to count.
pub(crate) enum Asked {
    Mesh(FoundByMesh),
    Compute(CountedByCompute),
}

/// What a frame has counted.
#[derive(Clone, Copy, Default)]
pub(crate) struct Counted {
    pub(crate) statistics: Statistics,
    /// Mesh workgroups, and those of them that found nothing. None of compute shaders.
    pub(crate) workgroups: Option<[u64; 2]>,
    pub(crate) seconds: Option<f64>,
}

impl Frames {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Box<dyn Error>> {
        Ok(Self { frames: [Frame::new(gpu)?, Frame::new(gpu)?], next: 0 })
    }

    /// A frame to be recorded, once the device has done with it, and what it had counted.
    pub(crate) fn next(&mut self) -> Result<(&mut Frame, Option<Counted>), Box<dyn Error>> {
        let frame = &mut self.frames[self.next];
        self.next = 1 - self.next;
        let counted = frame.finish()?;
        Ok((frame, counted))
    }

    /// Waits until nothing is drawn or shown any more.
    pub(crate) fn wait(&self) -> Result<(), Box<dyn Error>> {
        // SAFETY: this thread alone uses the device's queue.
        Ok(unsafe { self.frames[0].device.raw().device_wait_idle() }?)
    }
}

impl Frame {
    fn new(gpu: &Gpu) -> Result<Self, Box<dyn Error>> {
        let mut frame = Self {
            device: gpu.device().clone(),
            queue: gpu.queue(),
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            acquired: vk::Semaphore::null(),
            executed: vk::Fence::null(),
            timer: Timer::new(gpu.device()).ok(),
            submitted: None,
        };
        let raw = gpu.device().raw();
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(gpu.queue_family())
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        let signalled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
        // SAFETY: a pool of the queue's family, and plain others.
        unsafe {
            frame.pool = raw.create_command_pool(&pool, None)?;
            frame.acquired = raw.create_semaphore(&Default::default(), None)?;
            frame.executed = raw.create_fence(&signalled, None)?;
        }
        let buffers = vk::CommandBufferAllocateInfo::default()
            .command_pool(frame.pool)
            .command_buffer_count(1);
        // SAFETY: the pool was just made.
        frame.commands = unsafe { raw.allocate_command_buffers(&buffers) }?[0];
        Ok(frame)
    }

    /// To be signalled when there is an image for what is executed next.
    pub(crate) fn acquired(&self) -> vk::Semaphore {
        self.acquired
    }

    /// Waits until what was submitted has executed, and takes what it counted.
    fn finish(&mut self) -> Result<Option<Counted>, Box<dyn Error>> {
        // SAFETY: the fence is signalled, or what signals it was submitted.
        unsafe { self.device.raw().wait_for_fences(&[self.executed], true, u64::MAX) }?;
        let Some(Submitted { recorded, asked }) = self.submitted.take() else { return Ok(None) };
        // SAFETY: it was submitted with this fence, which was just waited for.
        let executed = unsafe { recorded.assume_executed() };
        let mut counted = asked.read(&executed)?;
        counted.seconds = self.timer.as_ref().map(|timer| timer.seconds(&executed)).transpose()?;
        Ok(Some(counted))
    }

    /// Records what draws to `image`, and submits it. After [`Frames::next`] gave the frame, and with the
    /// semaphore that the image was acquired with.
    pub(crate) fn execute(
        &mut self,
        image: &Image,
        draw: impl FnOnce(&mut Commands) -> Result<Asked, drypoint_ash::Error>,
    ) -> Result<(), Box<dyn Error>> {
        self.begin()?;
        // SAFETY: the buffer is of the only queue's family and was begun; it is recorded here alone and submitted
        // below, once; what it uses is kept until its fence was waited for.
        let mut commands = unsafe { Commands::from_raw(&self.device, self.commands) };
        let asked = self.record(&mut commands, draw);
        let recorded = commands.finish();
        let asked = asked?;
        self.submit(image)?;
        self.submitted = Some(Submitted { recorded, asked });
        Ok(())
    }

    fn begin(&self) -> Result<(), vk::Result> {
        let raw = self.device.raw();
        let flags = vk::CommandPoolResetFlags::empty();
        let once = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: whatever was recorded from this pool has executed.
        unsafe {
            raw.reset_command_pool(self.pool, flags)?;
            raw.begin_command_buffer(self.commands, &once)
        }
    }

    fn record(
        &mut self,
        commands: &mut Commands,
        draw: impl FnOnce(&mut Commands) -> Result<Asked, drypoint_ash::Error>,
    ) -> Result<Asked, Box<dyn Error>> {
        if let Some(timer) = &mut self.timer {
            timer.begin(commands)?;
        }
        let asked = draw(commands)?;
        if let Some(timer) = &mut self.timer {
            timer.end(commands)?;
        }
        // SAFETY: it was begun, and no rendering is open.
        unsafe { self.device.raw().end_command_buffer(commands.raw()) }?;
        Ok(asked)
    }

    fn submit(&self, image: &Image) -> Result<(), vk::Result> {
        let (raw, commands) = (self.device.raw(), [self.commands]);
        let (acquired, drawn) = ([self.acquired], [image.drawn()]);
        // All of a frame waits for its image, so that the timer does not count the time until there is one.
        let stages = [vk::PipelineStageFlags::ALL_COMMANDS];
        let submit = [vk::SubmitInfo::default()
            .wait_semaphores(&acquired)
            .wait_dst_stage_mask(&stages)
            .command_buffers(&commands)
            .signal_semaphores(&drawn)];
        // SAFETY: the commands were recorded, the image was acquired with that semaphore, nothing else was submitted
        // with the fence, and this thread alone uses the queue.
        unsafe {
            raw.reset_fences(&[self.executed])?;
            raw.queue_submit(self.queue, &submit, self.executed)
        }
    }
}

impl Drop for Frame {
    fn drop(&mut self) {
        let raw = self.device.raw();
        // SAFETY: nothing uses them once the device is idle, or lost.
        unsafe {
            let _ = raw.device_wait_idle();
            raw.destroy_fence(self.executed, None);
            raw.destroy_semaphore(self.acquired, None);
            raw.destroy_command_pool(self.pool, None);
        }
    }
}

impl Asked {
    fn read(&self, executed: &Executed) -> Result<Counted, drypoint_ash::Error> {
        let seconds = None;
        match self {
            Self::Mesh(found) => {
                let all = found.statistics(executed)?;
                let workgroups = Some([all.mesh_workgroups, all.idle_mesh_workgroups]);
                Ok(Counted { statistics: all.found, workgroups, seconds })
            }
            Self::Compute(counted) => {
                Ok(Counted { statistics: counted.statistics(executed)?, workgroups: None, seconds })
            }
        }
    }
}
