//! An image of the test's own, made and drawn to as a renderer does it.
#![allow(dead_code, reason = "each test program uses what it needs")]

use ash::vk;
use drypoint_ash::{Attachments, Commands, Error, Executed, Gpu, Rendering};

/// Four bytes of each pixel of an image that was cleared to zero, prepared for by `prepare` and drawn to by `draw`.
pub(crate) fn render<T>(
    gpu: &Gpu,
    (format, size): (vk::Format, [u32; 2]),
    prepare: impl FnOnce(&mut Commands) -> Result<T, Error>,
    draw: impl FnOnce(&mut Rendering<'_>, &mut T) -> Result<(), Error>,
) -> (Vec<[u8; 4]>, T, Executed) {
    let target = Target::new(gpu, format, size);
    let (made, executed) = gpu
        .run(|commands| {
            let mut made = prepare(commands)?;
            target.draw(commands, |rendering| draw(rendering, &mut made))?;
            Ok(made)
        })
        .expect("it is drawn");
    (target.pixels(), made, executed)
}

/// An image, and a buffer that it is copied to.
struct Target<'a> {
    gpu: &'a Gpu,
    format: vk::Format,
    extent: vk::Extent2D,
    image: vk::Image,
    view: vk::ImageView,
    buffer: vk::Buffer,
    /// Of the image and of the buffer.
    memory: [vk::DeviceMemory; 2],
}

const COLOR: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

impl<'a> Target<'a> {
    fn new(gpu: &'a Gpu, format: vk::Format, [width, height]: [u32; 2]) -> Self {
        let device = gpu.device().raw();
        let image = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width, height, depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC);
        let size = 4 * u64::from(width) * u64::from(height);
        let buffer =
            vk::BufferCreateInfo::default().size(size).usage(vk::BufferUsageFlags::TRANSFER_DST);
        // SAFETY: a small image and a small buffer, each with memory of its own.
        unsafe {
            let image = device.create_image(&image, None).expect("an image is made");
            let needed = device.get_image_memory_requirements(image);
            let of_image = allocate(gpu, needed, vk::MemoryPropertyFlags::DEVICE_LOCAL);
            device.bind_image_memory(image, of_image, 0).expect("it is bound");
            let view = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(COLOR);
            let view = device.create_image_view(&view, None).expect("a view is made");
            let buffer = device.create_buffer(&buffer, None).expect("a buffer is made");
            let needed = device.get_buffer_memory_requirements(buffer);
            let seen =
                vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
            let of_buffer = allocate(gpu, needed, seen);
            device.bind_buffer_memory(buffer, of_buffer, 0).expect("it is bound");
            let (extent, memory) = (vk::Extent2D { width, height }, [of_image, of_buffer]);
            Self { gpu, format, extent, image, view, buffer, memory }
        }
    }

    fn draw(
        &self,
        commands: &mut Commands,
        draw: impl FnOnce(&mut Rendering<'_>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let (device, raw) = (self.gpu.device().raw(), commands.raw());
        let color = [vk::RenderingAttachmentInfo::default()
            .image_view(self.view)
            .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)];
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: self.extent };
        let begin =
            vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&color);
        let size = [self.extent.width, self.extent.height];
        self.transition(
            commands,
            (vk::ImageLayout::UNDEFINED, vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL),
            vk::AccessFlags::COLOR_ATTACHMENT_WRITE,
        );
        // SAFETY: the image is in the layout that is named, and stays until the commands have executed.
        unsafe { device.cmd_begin_rendering(raw, &begin) };
        // SAFETY: it was begun with this attachment.
        let drawn = draw(&mut unsafe {
            commands.in_rendering(Attachments { color: Some(self.format), depth: None, size })
        });
        // SAFETY: as above.
        unsafe { device.cmd_end_rendering(raw) };
        self.transition(
            commands,
            (vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, vk::ImageLayout::TRANSFER_SRC_OPTIMAL),
            vk::AccessFlags::TRANSFER_READ,
        );
        let layers = vk::ImageSubresourceLayers::default()
            .aspect_mask(vk::ImageAspectFlags::COLOR)
            .layer_count(1);
        let [width, height] = size;
        let region = vk::BufferImageCopy::default()
            .image_subresource(layers)
            .image_extent(vk::Extent3D { width, height, depth: 1 });
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let after = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ);
        // SAFETY: the buffer has room for the image.
        unsafe {
            device.cmd_copy_image_to_buffer(raw, self.image, layout, self.buffer, &[region]);
            device.cmd_pipeline_barrier(
                raw,
                vk::PipelineStageFlags::TRANSFER,
                vk::PipelineStageFlags::HOST,
                vk::DependencyFlags::empty(),
                &[after],
                &[],
                &[],
            );
        }
        drawn
    }

    fn transition(
        &self,
        commands: &Commands,
        (from, to): (vk::ImageLayout, vk::ImageLayout),
        access: vk::AccessFlags,
    ) {
        let barrier = vk::ImageMemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
            .dst_access_mask(access)
            .old_layout(from)
            .new_layout(to)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.image)
            .subresource_range(COLOR);
        // SAFETY: outside of rendering.
        unsafe {
            self.gpu.device().raw().cmd_pipeline_barrier(
                commands.raw(),
                vk::PipelineStageFlags::ALL_COMMANDS,
                vk::PipelineStageFlags::ALL_COMMANDS,
                vk::DependencyFlags::empty(),
                &[],
                &[],
                &[barrier],
            );
        }
    }

    /// What was copied.
    fn pixels(&self) -> Vec<[u8; 4]> {
        let device = self.gpu.device().raw();
        let count = self.extent.width as usize * self.extent.height as usize;
        // SAFETY: the commands have executed, and memory is as large as the buffer.
        unsafe {
            let memory = self.memory[1];
            let pointer = device
                .map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())
                .expect("it is mapped");
            let pixels = std::slice::from_raw_parts(pointer.cast::<[u8; 4]>(), count).to_vec();
            device.unmap_memory(memory);
            pixels
        }
    }
}

impl Drop for Target<'_> {
    fn drop(&mut self) {
        let device = self.gpu.device().raw();
        // SAFETY: the commands have executed, or were never submitted.
        unsafe {
            device.destroy_image_view(self.view, None);
            device.destroy_image(self.image, None);
            device.destroy_buffer(self.buffer, None);
            self.memory.iter().for_each(|memory| device.free_memory(*memory, None));
        }
    }
}

/// Memory of its own.
///
/// # Safety
/// The requirements are those of something that was made from the device.
pub(crate) unsafe fn allocate(
    gpu: &Gpu,
    needed: vk::MemoryRequirements,
    wanted: vk::MemoryPropertyFlags,
) -> vk::DeviceMemory {
    // SAFETY: the physical device is one of the instance's.
    let types =
        unsafe { gpu.instance().get_physical_device_memory_properties(gpu.physical_device()) };
    let fits = |(index, ty): (u32, &vk::MemoryType)| {
        (needed.memory_type_bits >> index & 1 == 1 && ty.property_flags.contains(wanted))
            .then_some(index)
    };
    let index = (0..).zip(types.memory_types_as_slice()).find_map(fits).expect("there is memory");
    let info =
        vk::MemoryAllocateInfo::default().allocation_size(needed.size).memory_type_index(index);
    // SAFETY: of a type that the device has.
    unsafe { gpu.device().raw().allocate_memory(&info, None) }.expect("there is memory")
}
