//! The device that everything is made with: the caller's, or that of a [`Gpu`](crate::Gpu).

use std::ffi::CStr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::{ext, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};

use crate::Error;

/// A Vulkan device with mesh shaders. A clone is the same device.
#[derive(Clone)]
pub struct Device {
    shared: Arc<Shared>,
}

struct Shared {
    raw: ash::Device,
    mesh_shader: ext::mesh_shader::Device,
    /// What the device was made from, to ask about formats.
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    properties: Properties,
    features: OptionalFeatures,
    /// `None` while the device goes.
    allocator: Mutex<Option<Allocator>>,
    /// Goes last: destroys the device, if it is ours.
    _owner: Option<Box<dyn Send + Sync>>,
}

/// What comes with a device that is not the caller's.
#[derive(Default)]
pub(crate) struct Origin {
    /// Goes last.
    pub(crate) owner: Option<Box<dyn Send + Sync>>,
    /// Lowers what work is cut to.
    pub(crate) lower: Option<fn(&mut Limits)>,
}

/// What the device can do, as far as it matters here.
#[derive(Clone, Debug)]
pub(crate) struct Properties {
    pub(crate) name: String,
    pub(crate) is_software: bool,
    pub(crate) limits: vk::PhysicalDeviceLimits,
    pub(crate) mesh: MeshProperties,
}

/// What work is cut to. Lowered, it shows how work is split.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of a storage buffer that a shader sees.
    pub storage_range: u32,
    /// Workgroups of compute shaders along one dimension.
    pub compute_row: u32,
    /// Task workgroups along one dimension, and in all.
    pub task_grid: [u32; 2],
    /// Mesh workgroups along one dimension, and in all.
    pub mesh_grid: [u32; 2],
}

/// What it says about task and mesh shaders.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshProperties {
    /// Lanes of a workgroup that it allows, and those that it prefers.
    pub(crate) task_width: [u32; 2],
    pub(crate) mesh_width: [u32; 2],
    pub(crate) vertices: u32,
    pub(crate) primitives: u32,
    /// Task and mesh workgroups along one dimension, and in all.
    pub(crate) task_grid: [u32; 2],
    pub(crate) mesh_grid: [u32; 2],
}

/// Edges of all instances that one draw or dispatch tests at most: far less than counters of 32 bits hold, and than
/// what takes so long that a system takes the GPU away.
pub(crate) const MOST_TESTS: u32 = 1 << 28;

/// Storage buffers that a mesh shader sees.
const STORAGE_BUFFERS: u32 = 11;

/// Device extensions that must be enabled.
pub const REQUIRED_EXTENSIONS: [&CStr; 1] = [ext::mesh_shader::NAME];

/// Features that must be enabled: all members set here. Vulkan 1.3 itself is required too.
///
/// Both are pushed to the `VkDeviceCreateInfo` that a device is made with (`push_next`), after what the caller needs
/// besides was set in them. Where `VkPhysicalDeviceVulkan13Features` is in the chain, Vulkan wants
/// `dynamicRendering` set there in place of the first one.
#[derive(Clone, Copy, Debug)]
pub struct RequiredFeatures {
    /// Rendering without render passes.
    pub dynamic_rendering: vk::PhysicalDeviceDynamicRenderingFeatures<'static>,
    /// Task and mesh shaders.
    pub mesh_shader: vk::PhysicalDeviceMeshShaderFeaturesEXT<'static>,
}

/// Features that are used if they were enabled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OptionalFeatures {
    /// `meshShaderQueries`: [`Queries`](crate::Queries) count primitives that mesh shaders emit.
    pub mesh_shader_queries: bool,
    /// `pipelineStatisticsQuery`: [`Queries`](crate::Queries) count invocations of shaders.
    pub pipeline_statistics_query: bool,
}

impl Default for RequiredFeatures {
    fn default() -> Self {
        Self {
            dynamic_rendering: vk::PhysicalDeviceDynamicRenderingFeatures::default()
                .dynamic_rendering(true),
            mesh_shader: vk::PhysicalDeviceMeshShaderFeaturesEXT::default()
                .task_shader(true)
                .mesh_shader(true),
        }
    }
}

/// What subgroup operations the shaders need, in task and mesh stages.
const SUBGROUP_OPERATIONS: vk::SubgroupFeatureFlags = vk::SubgroupFeatureFlags::from_raw(
    vk::SubgroupFeatureFlags::BASIC.as_raw()
        | vk::SubgroupFeatureFlags::BALLOT.as_raw()
        | vk::SubgroupFeatureFlags::ARITHMETIC.as_raw(),
);

impl Device {
    /// Takes the caller's device, which stays the caller's.
    ///
    /// # Errors
    /// If the physical device lacks what is needed.
    ///
    /// # Safety
    /// `raw` was made from `physical_device` and `instance` with [`REQUIRED_EXTENSIONS`] and
    /// [`RequiredFeatures`] enabled, and with those of `features` that are set, and outlives this value, its clones, and
    /// all that is made from them; so does the instance.
    /// Whenever something that was made from it is dropped, the device does not execute commands that use it,
    /// and no other thread is destroying it.
    pub unsafe fn from_raw(
        instance: &ash::Instance,
        physical_device: vk::PhysicalDevice,
        raw: &ash::Device,
        features: OptionalFeatures,
    ) -> Result<Self, Error> {
        // SAFETY: the caller's promise.
        unsafe { Self::new(instance, physical_device, (raw, features), Origin::default()) }
    }

    /// # Safety
    /// As [`Device::from_raw`], until the owner is dropped, which may destroy the device.
    pub(crate) unsafe fn new(
        instance: &ash::Instance,
        physical_device: vk::PhysicalDevice,
        (raw, features): (&ash::Device, OptionalFeatures),
        Origin { owner, lower }: Origin,
    ) -> Result<Self, Error> {
        // SAFETY: the physical device is one of the instance's.
        let mut properties = unsafe { Properties::of(instance, physical_device) }
            .map_err(|reason| Error::NoDevice { reason })?;
        if let Some(lower) = lower {
            properties.lower(lower);
        }
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.clone(),
            device: raw.clone(),
            physical_device,
            debug_settings: gpu_allocator::AllocatorDebugSettings::default(),
            buffer_device_address: false,
            allocation_sizes: gpu_allocator::AllocationSizes::default(),
        });
        let what = "an allocator";
        let allocator =
            allocator.map_err(|error| Error::Refused { what, reason: error.to_string() })?;
        Ok(Self {
            shared: Arc::new(Shared {
                mesh_shader: ext::mesh_shader::Device::new(instance, raw),
                instance: instance.clone(),
                physical_device,
                raw: raw.clone(),
                properties,
                features,
                allocator: Mutex::new(Some(allocator)),
                _owner: owner,
            }),
        })
    }

    /// Functions of the device.
    pub fn raw(&self) -> &ash::Device {
        &self.shared.raw
    }

    /// Its name, and whether it is software.
    pub fn name(&self) -> String {
        let Properties { name, is_software, .. } = &self.shared.properties;
        if *is_software { format!("{name} (software)") } else { name.clone() }
    }

    /// Whether a processor does the work: its times say nothing about GPUs.
    pub fn is_software(&self) -> bool {
        self.shared.properties.is_software
    }

    /// Fails if images of that format cannot be used so.
    pub(crate) fn check_format(
        &self,
        (format, wanted): (vk::Format, vk::FormatFeatureFlags),
        what: &'static str,
    ) -> Result<(), Error> {
        let Shared { instance, physical_device, .. } = &*self.shared;
        // SAFETY: the device was made from both, which outlive it.
        let found =
            unsafe { instance.get_physical_device_format_properties(*physical_device, format) };
        let is_there = found.optimal_tiling_features.contains(wanted);
        if is_there { Ok(()) } else { Err(Error::Format { format, what }) }
    }

    pub(crate) fn mesh_shader(&self) -> &ext::mesh_shader::Device {
        &self.shared.mesh_shader
    }

    pub(crate) fn features(&self) -> OptionalFeatures {
        self.shared.features
    }

    pub(crate) fn limits(&self) -> &vk::PhysicalDeviceLimits {
        &self.shared.properties.limits
    }

    pub(crate) fn mesh_properties(&self) -> MeshProperties {
        self.shared.properties.mesh
    }

    /// Where memory comes from. `None` only while the device goes, when nobody can ask.
    pub(crate) fn allocator(&self) -> MutexGuard<'_, Option<Allocator>> {
        self.shared.allocator.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether both are the same device.
    pub(crate) fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.shared, &other.shared)
    }
}

impl std::fmt::Debug for Device {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Device").field("name", &self.name()).finish_non_exhaustive()
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        // It gives its memory back to the device, which goes after it.
        let allocator = self.allocator.get_mut().unwrap_or_else(PoisonError::into_inner);
        drop(allocator.take());
    }
}

impl Properties {
    /// Lowers what work is cut to, and raises nothing.
    fn lower(&mut self, lower: fn(&mut Limits)) {
        let (limits, mesh) = (&mut self.limits, &mut self.mesh);
        let row = &mut limits.max_compute_work_group_count;
        let given = Limits {
            storage_range: limits.max_storage_buffer_range,
            compute_row: row[0].min(row[1]),
            task_grid: mesh.task_grid,
            mesh_grid: mesh.mesh_grid,
        };
        let mut wanted = given;
        lower(&mut wanted);
        let lowest = |given: [u32; 2], wanted: [u32; 2]| {
            [given[0].min(wanted[0]).max(1), given[1].min(wanted[1]).max(1)]
        };
        limits.max_storage_buffer_range = given.storage_range.min(wanted.storage_range);
        [row[0], row[1]] = [given.compute_row.min(wanted.compute_row).max(1); 2];
        mesh.task_grid = lowest(given.task_grid, wanted.task_grid);
        mesh.mesh_grid = lowest(given.mesh_grid, wanted.mesh_grid);
    }

    /// What the physical device can do, or what it lacks.
    ///
    /// # Safety
    /// It is one of the instance's, which is of Vulkan 1.1 or later.
    pub(crate) unsafe fn of(
        instance: &ash::Instance,
        physical_device: vk::PhysicalDevice,
    ) -> Result<Self, String> {
        // SAFETY: the caller's promise.
        let basic = unsafe { instance.get_physical_device_properties(physical_device) };
        let name = basic.device_name_as_c_str().unwrap_or(c"?").to_string_lossy().into_owned();
        let lacks = |what: &str| Err(format!("{name} lacks {what}"));
        if basic.api_version < vk::API_VERSION_1_3 {
            return lacks("Vulkan 1.3");
        }
        // SAFETY: the caller's promise.
        let extensions = unsafe { instance.enumerate_device_extension_properties(physical_device) };
        let extensions = extensions.map_err(|error| format!("{name}: {error}"))?;
        let has = |wanted: &CStr| {
            extensions.iter().any(|e| e.extension_name_as_c_str().is_ok_and(|name| name == wanted))
        };
        if !REQUIRED_EXTENSIONS.into_iter().all(has) {
            return lacks("VK_EXT_mesh_shader");
        }
        let mut mesh_features = vk::PhysicalDeviceMeshShaderFeaturesEXT::default();
        let mut rendering = vk::PhysicalDeviceDynamicRenderingFeatures::default();
        let mut features = vk::PhysicalDeviceFeatures2::default()
            .push_next(&mut mesh_features)
            .push_next(&mut rendering);
        let mut mesh = vk::PhysicalDeviceMeshShaderPropertiesEXT::default();
        let mut subgroups = vk::PhysicalDeviceSubgroupProperties::default();
        let mut properties =
            vk::PhysicalDeviceProperties2::default().push_next(&mut mesh).push_next(&mut subgroups);
        // SAFETY: the caller's promise, and all structs are of Vulkan 1.3 or of an extension that is there.
        unsafe {
            instance.get_physical_device_features2(physical_device, &mut features);
            instance.get_physical_device_properties2(physical_device, &mut properties);
        }
        let flags = [
            (mesh_features.task_shader, "task shaders"),
            (mesh_features.mesh_shader, "mesh shaders"),
            (rendering.dynamic_rendering, "dynamic rendering"),
        ];
        if let Some((_, what)) = flags.into_iter().find(|(flag, _)| *flag == vk::FALSE) {
            return lacks(what);
        }
        if basic.limits.max_per_stage_descriptor_storage_buffers < STORAGE_BUFFERS {
            return lacks("11 storage buffers in a shader");
        }
        let stages = vk::ShaderStageFlags::TASK_EXT | vk::ShaderStageFlags::MESH_EXT;
        if !subgroups.supported_stages.contains(stages)
            || !subgroups.supported_operations.contains(SUBGROUP_OPERATIONS)
        {
            return lacks("subgroup operations in task and mesh shaders");
        }
        Ok(Self {
            mesh: MeshProperties::new(&mesh),
            is_software: basic.device_type == vk::PhysicalDeviceType::CPU,
            limits: basic.limits,
            name,
        })
    }
}

impl MeshProperties {
    fn new(mesh: &vk::PhysicalDeviceMeshShaderPropertiesEXT<'_>) -> Self {
        let width = |most: u32, along_x: u32, preferred: u32| {
            let most = most.min(along_x);
            [most, preferred.min(most)]
        };
        let grid = |along: [u32; 3], all: u32| [along[0].min(along[1]), all];
        Self {
            task_width: width(
                mesh.max_task_work_group_invocations,
                mesh.max_task_work_group_size[0],
                mesh.max_preferred_task_work_group_invocations,
            ),
            mesh_width: width(
                mesh.max_mesh_work_group_invocations,
                mesh.max_mesh_work_group_size[0],
                mesh.max_preferred_mesh_work_group_invocations,
            ),
            vertices: mesh.max_mesh_output_vertices,
            primitives: mesh.max_mesh_output_primitives,
            task_grid: grid(mesh.max_task_work_group_count, mesh.max_task_work_group_total_count),
            mesh_grid: grid(mesh.max_mesh_work_group_count, mesh.max_mesh_work_group_total_count),
        }
    }
}
