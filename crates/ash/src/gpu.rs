//! A device of one's own, for programs without one.

use std::ffi::CStr;
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;

use crate::commands::Commands;
use crate::device::{Limits, Origin};
use crate::execution::Executed;
use crate::instance::Instance;
use crate::{Device, Error};

/// A device without a window, with a queue.
#[derive(Debug)]
pub struct Gpu {
    device: Device,
    /// Functions, for what else is made from them.
    entry: Functions<ash::Entry>,
    instance: Functions<ash::Instance>,
    physical_device: vk::PhysicalDevice,
    family: u32,
    queue: vk::Queue,
    /// Commands are recorded and executed one after the other.
    pool: Mutex<vk::CommandPool>,
}

/// Hears what the validation layers say.
pub type Listener = Arc<dyn Fn(&str) + Send + Sync>;

/// How a [`Gpu`] is made.
#[derive(Clone, Default)]
pub struct GpuOptions {
    /// Asks for the validation layers, core and synchronisation, which tell here what is wrong.
    pub listener: Option<Listener>,
    /// Extensions of the instance that are enabled besides, as for a window.
    pub instance_extensions: Vec<&'static CStr>,
    /// Extensions of the device that are enabled besides.
    pub device_extensions: Vec<&'static CStr>,
    /// Lowers what work is cut to, as to try how it is split.
    pub lower: Option<fn(&mut Limits)>,
}

impl std::fmt::Debug for GpuOptions {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let is_validated = self.listener.is_some();
        let extensions = [&self.instance_extensions, &self.device_extensions];
        formatter
            .debug_struct("GpuOptions")
            .field("is_validated", &is_validated)
            .field("extensions", &extensions)
            .finish_non_exhaustive()
    }
}

/// Tables of functions, which have nothing to show.
struct Functions<T>(T);

impl<T> std::fmt::Debug for Functions<T> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("..")
    }
}

/// What is destroyed after all that was made from the device.
struct Owner {
    instance: Instance,
    device: ash::Device,
}

impl Gpu {
    /// The first of the fastest kind of devices that have mesh shaders: its own card before a shared one, before
    /// software. Some tens of milliseconds.
    ///
    /// # Errors
    /// If there is no Vulkan, or no such device.
    pub fn request() -> Result<Self, Error> {
        Self::request_with(&GpuOptions::default())
    }

    /// The same, with options.
    ///
    /// # Errors
    /// If there is no Vulkan, or no such device, or validation is asked for and not installed.
    pub fn request_with(options: &GpuOptions) -> Result<Self, Error> {
        let instance = Instance::new(options)?;
        let (physical, family) = instance.choose()?;
        let features = instance.optional_features(physical);
        let raw =
            instance.create_device((physical, family), features, &options.device_extensions)?;
        let owner = Owner { instance, device: raw.clone() };
        let (entry, functions) = (owner.instance.entry.clone(), owner.instance.raw.clone());
        // SAFETY: it was made right now, with all that is required, and goes with its owner.
        let device = unsafe {
            Device::new(
                &functions,
                physical,
                (&raw, features),
                Origin { owner: Some(Box::new(owner)), lower: options.lower },
            )
        }?;
        // SAFETY: the device was made with one queue of that family.
        let queue = unsafe { raw.get_device_queue(family, 0) };
        let flags = vk::CommandPoolCreateFlags::TRANSIENT;
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(family).flags(flags);
        // SAFETY: a pool of a family that the device has.
        let pool = unsafe { raw.create_command_pool(&info, None) };
        let pool = pool.map_err(|error| Error::of("a command pool", error))?;
        Ok(Self {
            device,
            entry: Functions(entry),
            instance: Functions(functions),
            physical_device: physical,
            family,
            queue,
            pool: Mutex::new(pool),
        })
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The loader's functions.
    pub fn entry(&self) -> &ash::Entry {
        &self.entry.0
    }

    /// The instance's functions.
    pub fn instance(&self) -> &ash::Instance {
        &self.instance.0
    }

    /// What the device was made from.
    pub fn physical_device(&self) -> vk::PhysicalDevice {
        self.physical_device
    }

    /// The family of the queue: graphics, compute and transfer.
    pub fn queue_family(&self) -> u32 {
        self.family
    }

    /// The queue. It must not be used by others while [`Gpu::run`] is.
    pub fn queue(&self) -> vk::Queue {
        self.queue
    }

    /// Records commands, executes them, and waits until they have executed. One call after the other: it must not
    /// be called from `record`, where it would wait for itself.
    ///
    /// # Errors
    /// That of `record`, when nothing is executed; or if the device is lost.
    pub fn run<T>(
        &self,
        record: impl FnOnce(&mut Commands) -> Result<T, Error>,
    ) -> Result<(T, Executed), Error> {
        let what = "commands";
        let pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        let raw = self.device.raw();
        let info =
            vk::CommandBufferAllocateInfo::default().command_pool(*pool).command_buffer_count(1);
        // SAFETY: the pool is ours, and locked.
        let buffer = unsafe { raw.allocate_command_buffers(&info) };
        let buffers = buffer.map_err(|error| Error::of(what, error))?;
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the buffer is new.
        let begun = unsafe { raw.begin_command_buffer(buffers[0], &begin) };
        // SAFETY: it is executed below, on the only queue, or freed; what it uses is kept until then.
        let mut commands = unsafe { Commands::from_raw(&self.device, buffers[0]) };
        let made =
            begun.map_err(|error| Error::of(what, error)).and_then(|()| record(&mut commands));
        let fate = commands.fate().clone();
        if commands.raw() != buffers[0] {
            // Those of another call: they are neither finished nor dropped here, and ours are lost.
            fate.abandon();
            std::mem::forget(commands);
            return Err(Error::Exchanged);
        }
        let recorded = commands.finish();
        let made = made.and_then(|made| self.execute(buffers[0]).map(|()| made));
        if made.is_err() {
            fate.abandon();
        }
        // SAFETY: it has executed, or was never submitted, or the device is lost.
        unsafe { raw.free_command_buffers(*pool, &buffers) };
        let made = made?;
        // SAFETY: it has executed.
        Ok((made, unsafe { recorded.assume_executed() }))
    }

    fn execute(&self, buffer: vk::CommandBuffer) -> Result<(), Error> {
        let (raw, buffers) = (self.device.raw(), [buffer]);
        let submit = [vk::SubmitInfo::default().command_buffers(&buffers)];
        // SAFETY: the buffer was begun and recorded; the queue is used here alone.
        let executed = unsafe {
            raw.end_command_buffer(buffer)
                .and_then(|()| raw.queue_submit(self.queue, &submit, vk::Fence::null()))
                .and_then(|()| raw.queue_wait_idle(self.queue))
        };
        executed.map_err(|error| Error::of("commands", error))
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        let pool = *self.pool.get_mut().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: whatever was executed has been waited for.
        unsafe { self.device.raw().destroy_command_pool(pool, None) };
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        // SAFETY: all that was made from the device has gone.
        unsafe { self.device.destroy_device(None) };
    }
}
