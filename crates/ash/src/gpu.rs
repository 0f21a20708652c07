//! A device of one's own, for programs without one.

use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex, PoisonError};

use ash::{ext, vk};

use crate::commands::{Commands, Executed};
use crate::device::{
    Limits, OptionalFeatures, Origin, Properties, REQUIRED_EXTENSIONS, RequiredFeatures,
};
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

/// What is destroyed after the device.
struct Instance {
    raw: ash::Instance,
    /// Its functions are those of the loader, which stays as long as this.
    entry: ash::Entry,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// The messenger refers to it.
    _listener: Option<Box<Listener>>,
}

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

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

    /// Records commands, executes them, and waits until they have executed.
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

impl Instance {
    fn new(options: &GpuOptions) -> Result<Self, Error> {
        // SAFETY: the system's own loader of Vulkan.
        let entry = unsafe { ash::Entry::load() }
            .map_err(|error| Error::NoVulkan { reason: error.to_string() })?;
        let application = vk::ApplicationInfo::default()
            .application_name(c"drypoint")
            .api_version(vk::API_VERSION_1_3);
        let mut extensions: Vec<_> =
            options.instance_extensions.iter().map(|name| name.as_ptr()).collect();
        let mut layers = Vec::new();
        if options.listener.is_some() {
            // SAFETY: the loader is there.
            let found = unsafe { entry.enumerate_instance_layer_properties() }.unwrap_or_default();
            let is_wanted = |layer: &vk::LayerProperties| {
                layer.layer_name_as_c_str().is_ok_and(|name| name == VALIDATION)
            };
            if !found.iter().any(is_wanted) {
                return Err(Error::NoValidation);
            }
            layers.push(VALIDATION.as_ptr());
            extensions.push(ext::debug_utils::NAME.as_ptr());
        }
        let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut validation =
            vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .enabled_extension_names(&extensions)
            .enabled_layer_names(&layers);
        if options.listener.is_some() {
            info = info.push_next(&mut validation);
        }
        // SAFETY: all that is pointed to is still there.
        let raw = unsafe { entry.create_instance(&info, None) };
        let raw = raw.map_err(|error| Error::NoVulkan { reason: error.to_string() })?;
        let mut instance = Self { raw, entry, messenger: None, _listener: None };
        if let Some(listener) = &options.listener {
            instance.listen(Box::new(listener.clone()))?;
        }
        Ok(instance)
    }

    fn listen(&mut self, listener: Box<Listener>) -> Result<(), Error> {
        let functions = ext::debug_utils::Instance::new(&self.entry, &self.raw);
        let heard: *const Listener = &*listener;
        let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(
                vk::DebugUtilsMessageSeverityFlagsEXT::WARNING
                    | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
            )
            .message_type(
                vk::DebugUtilsMessageTypeFlagsEXT::GENERAL
                    | vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION,
            )
            .pfn_user_callback(Some(hear))
            .user_data(heard.cast_mut().cast::<c_void>());
        // SAFETY: the listener stays where it is until the messenger is destroyed.
        let messenger = unsafe { functions.create_debug_utils_messenger(&info, None) };
        let messenger = messenger.map_err(|error| Error::of("a messenger", error))?;
        self.messenger = Some((functions, messenger));
        self._listener = Some(listener);
        Ok(())
    }

    /// A physical device, and a family of queues that can do all.
    fn choose(&self) -> Result<(vk::PhysicalDevice, u32), Error> {
        // SAFETY: the instance is there.
        let devices = unsafe { self.raw.enumerate_physical_devices() };
        let devices = devices.map_err(|error| Error::NoDevice { reason: error.to_string() })?;
        let mut lacks = Vec::new();
        let mut best: Option<(u32, vk::PhysicalDevice, u32)> = None;
        for physical in devices {
            // SAFETY: it is one of the instance's, which is of Vulkan 1.3.
            let basic = unsafe { self.raw.get_physical_device_properties(physical) };
            // SAFETY: as above.
            if let Err(reason) = unsafe { Properties::of(&self.raw, physical) } {
                lacks.push(reason);
                continue;
            }
            let rank = match basic.device_type {
                vk::PhysicalDeviceType::DISCRETE_GPU => 3,
                vk::PhysicalDeviceType::INTEGRATED_GPU => 2,
                vk::PhysicalDeviceType::VIRTUAL_GPU => 1,
                _ => 0,
            };
            let Some(family) = self.family(physical) else {
                lacks.push("no family of queues does graphics and compute".to_owned());
                continue;
            };
            if best.is_none_or(|(other, ..)| rank > other) {
                best = Some((rank, physical, family));
            }
        }
        let (_, physical, family) = best.ok_or_else(|| {
            let nothing = || "there is none at all".to_owned();
            let reason = if lacks.is_empty() { nothing() } else { lacks.join("; ") };
            Error::NoDevice { reason }
        })?;
        Ok((physical, family))
    }

    fn family(&self, physical: vk::PhysicalDevice) -> Option<u32> {
        // SAFETY: it is one of the instance's.
        let families = unsafe { self.raw.get_physical_device_queue_family_properties(physical) };
        let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        let index = families.iter().position(|family| family.queue_flags.contains(wanted))?;
        u32::try_from(index).ok()
    }

    fn optional_features(&self, physical: vk::PhysicalDevice) -> OptionalFeatures {
        let mut mesh = vk::PhysicalDeviceMeshShaderFeaturesEXT::default();
        let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut mesh);
        // SAFETY: it is one of the instance's, and has mesh shaders.
        unsafe { self.raw.get_physical_device_features2(physical, &mut features) };
        let pipeline_statistics_query = features.features.pipeline_statistics_query == vk::TRUE;
        let mesh_shader_queries = mesh.mesh_shader_queries == vk::TRUE;
        OptionalFeatures { mesh_shader_queries, pipeline_statistics_query }
    }

    fn create_device(
        &self,
        (physical, family): (vk::PhysicalDevice, u32),
        features: OptionalFeatures,
        more_extensions: &[&'static CStr],
    ) -> Result<ash::Device, Error> {
        let priorities = [1.0];
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(family)
            .queue_priorities(&priorities)];
        let mut required = RequiredFeatures::default();
        required.mesh_shader.mesh_shader_queries = features.mesh_shader_queries.into();
        let basic = vk::PhysicalDeviceFeatures::default()
            .pipeline_statistics_query(features.pipeline_statistics_query);
        let extensions = REQUIRED_EXTENSIONS.iter().chain(more_extensions);
        let extensions: Vec<_> = extensions.map(|name| name.as_ptr()).collect();
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .enabled_features(&basic)
            .push_next(&mut required.dynamic_rendering)
            .push_next(&mut required.mesh_shader);
        // SAFETY: all that is asked for is there, or the driver says that it is not.
        let device = unsafe { self.raw.create_device(physical, &info, None) };
        device.map_err(|error| Error::NoDevice { reason: error.to_string() })
    }
}

/// Hands a message on to the listener.
///
/// # Safety
/// `user_data` points to the listener, and `data` to a message.
unsafe extern "system" fn hear(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user_data: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan's promise, and that of whoever made the messenger.
    let (listener, message) =
        unsafe { (&*user_data.cast::<Listener>(), (*data).message_as_c_str()) };
    listener(&message.unwrap_or(c"").to_string_lossy());
    vk::FALSE
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: all that was made from the instance has gone.
        unsafe {
            if let Some((functions, messenger)) = self.messenger.take() {
                functions.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        // SAFETY: all that was made from the device has gone.
        unsafe { self.device.destroy_device(None) };
    }
}
