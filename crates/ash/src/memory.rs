//! Buffers and images, with the memory that they lie in.

use std::sync::{Arc, OnceLock};

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use crate::{Device, Error};

/// A buffer. A clone is the same; it goes with the last.
#[derive(Clone, Debug)]
pub(crate) struct Buffer {
    shared: Arc<SharedBuffer>,
}

#[derive(Debug)]
struct SharedBuffer {
    device: Device,
    raw: vk::Buffer,
    /// Set right after the buffer is made, unless there is no memory.
    allocation: OnceLock<Allocation>,
    size: u64,
}

/// An image of one level and one sample, with a view of all of it.
#[derive(Clone, Debug)]
pub(crate) struct Image {
    shared: Arc<SharedImage>,
}

#[derive(Debug)]
struct SharedImage {
    device: Device,
    raw: vk::Image,
    /// Both set right after the image is made, unless there is no memory.
    allocation: OnceLock<Allocation>,
    view: OnceLock<vk::ImageView>,
    aspect: vk::ImageAspectFlags,
    size: [u32; 2],
}

impl Buffer {
    /// In the device's own memory, which nobody else sees. At least 16 bytes, as a binding may not be smaller
    /// than what a shader expects there.
    pub(crate) fn new(
        device: &Device,
        what: &'static str,
        size: u64,
        usage: vk::BufferUsageFlags,
    ) -> Result<Self, Error> {
        Self::make(device, what, size, (usage, MemoryLocation::GpuOnly))
    }

    /// In memory that both sides see, with `bytes` in it, to be copied from.
    pub(crate) fn to_upload(
        device: &Device,
        what: &'static str,
        bytes: &[u8],
    ) -> Result<Self, Error> {
        let kind = (vk::BufferUsageFlags::TRANSFER_SRC, MemoryLocation::CpuToGpu);
        let mut buffer = Self::make(device, what, bytes.len() as u64, kind)?;
        // There is no clone yet, so that nobody else sees it.
        let allocation =
            Arc::get_mut(&mut buffer.shared).and_then(|shared| shared.allocation.get_mut());
        let memory = allocation.and_then(Allocation::mapped_slice_mut);
        let memory = memory.ok_or(Error::OutOfMemory { what })?;
        memory[..bytes.len()].copy_from_slice(bytes);
        Ok(buffer)
    }

    /// In memory that both sides see, to be copied to.
    pub(crate) fn to_download(
        device: &Device,
        what: &'static str,
        size: u64,
    ) -> Result<Self, Error> {
        Self::make(
            device,
            what,
            size,
            (vk::BufferUsageFlags::TRANSFER_DST, MemoryLocation::GpuToCpu),
        )
    }

    fn make(
        device: &Device,
        what: &'static str,
        size: u64,
        (usage, location): (vk::BufferUsageFlags, MemoryLocation),
    ) -> Result<Self, Error> {
        let size = size.next_multiple_of(4).max(16);
        if usage.contains(vk::BufferUsageFlags::STORAGE_BUFFER) {
            let limit = u64::from(device.limits().max_storage_buffer_range);
            if size > limit {
                return Err(Error::TooLarge { what, bytes: size, limit });
            }
        }
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: a plain buffer of one queue family at a time.
        let raw = unsafe { device.raw().create_buffer(&info, None) };
        let raw = raw.map_err(|error| Error::of(what, error))?;
        let shared = Arc::new(SharedBuffer {
            device: device.clone(),
            raw,
            allocation: OnceLock::new(),
            size,
        });
        // SAFETY: it was made from this device.
        let requirements = unsafe { device.raw().get_buffer_memory_requirements(raw) };
        let allocation = allocate(device, what, requirements, (location, true))?;
        // SAFETY: the memory was allocated for this buffer, which has none yet.
        unsafe { device.raw().bind_buffer_memory(raw, allocation.memory(), allocation.offset()) }
            .map_err(|error| Error::of(what, error))?;
        shared.allocation.set(allocation).expect("it was just made");
        Ok(Self { shared })
    }

    /// Whether both are the same.
    pub(crate) fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.shared, &other.shared)
    }

    pub(crate) fn raw(&self) -> vk::Buffer {
        self.shared.raw
    }

    pub(crate) fn size(&self) -> u64 {
        self.shared.size
    }

    /// What is in memory that both sides see.
    pub(crate) fn bytes(&self) -> &[u8] {
        self.shared.allocation.get().and_then(Allocation::mapped_slice).unwrap_or(&[])
    }

    /// What keeps it.
    pub(crate) fn kept(&self) -> Arc<dyn std::any::Any + Send + Sync> {
        self.shared.clone()
    }
}

impl Drop for SharedBuffer {
    fn drop(&mut self) {
        // SAFETY: commands that use it keep it until they have executed.
        unsafe { self.device.raw().destroy_buffer(self.raw, None) };
        free(&self.device, self.allocation.take());
    }
}

impl Image {
    pub(crate) fn new(
        device: &Device,
        what: &'static str,
        [width, height]: [u32; 2],
        (format, usage): (vk::Format, vk::ImageUsageFlags),
    ) -> Result<Self, Error> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width, height, depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(usage);
        // SAFETY: the caller has checked the size, and the format where not every device must have it for that use.
        let raw = unsafe { device.raw().create_image(&info, None) };
        let raw = raw.map_err(|error| Error::of(what, error))?;
        let aspect = if usage.contains(vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT) {
            vk::ImageAspectFlags::DEPTH
        } else {
            vk::ImageAspectFlags::COLOR
        };
        let shared = Arc::new(SharedImage {
            device: device.clone(),
            raw,
            allocation: OnceLock::new(),
            view: OnceLock::new(),
            aspect,
            size: [width, height],
        });
        // SAFETY: it was made from this device.
        let requirements = unsafe { device.raw().get_image_memory_requirements(raw) };
        let allocation = allocate(device, what, requirements, (MemoryLocation::GpuOnly, false))?;
        // SAFETY: the memory was allocated for this image, which has none yet.
        unsafe { device.raw().bind_image_memory(raw, allocation.memory(), allocation.offset()) }
            .map_err(|error| Error::of(what, error))?;
        shared.allocation.set(allocation).expect("it was just made");
        let info = vk::ImageViewCreateInfo::default()
            .image(raw)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(format)
            .subresource_range(shared.range());
        // SAFETY: a view of all of an image, in its own format.
        let view = unsafe { device.raw().create_image_view(&info, None) };
        shared.view.set(view.map_err(|error| Error::of(what, error))?).expect("it was just made");
        Ok(Self { shared })
    }

    pub(crate) fn raw(&self) -> vk::Image {
        self.shared.raw
    }

    pub(crate) fn device(&self) -> &Device {
        &self.shared.device
    }

    pub(crate) fn view(&self) -> vk::ImageView {
        *self.shared.view.get().expect("an image that was made has a view")
    }

    pub(crate) fn size(&self) -> [u32; 2] {
        self.shared.size
    }

    pub(crate) fn range(&self) -> vk::ImageSubresourceRange {
        self.shared.range()
    }

    pub(crate) fn kept(&self) -> Arc<dyn std::any::Any + Send + Sync> {
        self.shared.clone()
    }
}

impl SharedImage {
    fn range(&self) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange::default().aspect_mask(self.aspect).level_count(1).layer_count(1)
    }
}

impl Drop for SharedImage {
    fn drop(&mut self) {
        // SAFETY: commands that use it keep it until they have executed.
        unsafe {
            if let Some(view) = self.view.take() {
                self.device.raw().destroy_image_view(view, None);
            }
            self.device.raw().destroy_image(self.raw, None);
        }
        free(&self.device, self.allocation.take());
    }
}

fn allocate(
    device: &Device,
    what: &'static str,
    requirements: vk::MemoryRequirements,
    (location, linear): (MemoryLocation, bool),
) -> Result<Allocation, Error> {
    let description = AllocationCreateDesc {
        name: what,
        requirements,
        location,
        linear,
        allocation_scheme: AllocationScheme::GpuAllocatorManaged,
    };
    let mut allocator = device.allocator();
    let allocator = allocator.as_mut().ok_or(Error::DeviceLost)?;
    allocator.allocate(&description).map_err(|error| match error {
        gpu_allocator::AllocationError::OutOfMemory => Error::OutOfMemory { what },
        other => Error::Refused { what, reason: other.to_string() },
    })
}

fn free(device: &Device, allocation: Option<Allocation>) {
    if let (Some(allocation), Some(allocator)) = (allocation, device.allocator().as_mut()) {
        // It fails only for memory of another allocator.
        let _ = allocator.free(allocation);
    }
}
