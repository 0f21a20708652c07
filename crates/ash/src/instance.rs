//! An instance of Vulkan of one's own.

use std::ffi::{CStr, c_void};

use ash::{ext, vk};

use crate::Error;
use crate::device::{OptionalFeatures, Properties, REQUIRED_EXTENSIONS, RequiredFeatures};
use crate::gpu::{GpuOptions, Listener};

/// What is destroyed after the device.
pub(crate) struct Instance {
    pub(crate) raw: ash::Instance,
    /// Its functions are those of the loader, which stays as long as this.
    pub(crate) entry: ash::Entry,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// The messenger refers to it.
    _listener: Option<Box<Listener>>,
}

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

impl Instance {
    pub(crate) fn new(options: &GpuOptions) -> Result<Self, Error> {
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
    pub(crate) fn choose(&self) -> Result<(vk::PhysicalDevice, u32), Error> {
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

    pub(crate) fn optional_features(&self, physical: vk::PhysicalDevice) -> OptionalFeatures {
        let mut mesh = vk::PhysicalDeviceMeshShaderFeaturesEXT::default();
        let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut mesh);
        // SAFETY: it is one of the instance's, and has mesh shaders.
        unsafe { self.raw.get_physical_device_features2(physical, &mut features) };
        let pipeline_statistics_query = features.features.pipeline_statistics_query == vk::TRUE;
        let mesh_shader_queries = mesh.mesh_shader_queries == vk::TRUE;
        OptionalFeatures { mesh_shader_queries, pipeline_statistics_query }
    }

    pub(crate) fn create_device(
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
