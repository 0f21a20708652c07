//! Images that the window shows one after the other.

use std::error::Error;
use std::ffi::CStr;

use ash::{khr, vk};
use drypoint_ash::{Attachments, Commands, Device, Gpu, Rendering};
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::Window;

/// Goes before the window does.
pub(crate) struct Swapchain {
    /// Keeps the instance, which goes with it.
    device: Device,
    queue: vk::Queue,
    physical: vk::PhysicalDevice,
    surface_functions: khr::surface::Instance,
    functions: khr::swapchain::Device,
    surface: vk::SurfaceKHR,
    format: vk::SurfaceFormatKHR,
    raw: vk::SwapchainKHR,
    images: Vec<Image>,
    size: [u32; 2],
    /// What the window said when this was made.
    window_size: [u32; 2],
    /// The window is no longer what images were made for.
    is_outdated: bool,
}

/// One of the images.
#[derive(Clone, Copy)]
pub(crate) struct Image {
    index: u32,
    raw: vk::Image,
    view: vk::ImageView,
    attachments: Attachments,
    /// Signalled when it was drawn to.
    drawn: vk::Semaphore,
}

/// Of the instance and of the device.
pub(crate) fn extensions(window: &Window) -> Result<[Vec<&'static CStr>; 2], Box<dyn Error>> {
    let display = window.display_handle()?.as_raw();
    let required = ash_window::enumerate_required_extensions(display)?;
    // SAFETY: they are constants of Vulkan's headers.
    let name = |&name| unsafe { CStr::from_ptr(name) };
    Ok([required.iter().map(name).collect(), vec![khr::swapchain::NAME]])
}

impl Swapchain {
    /// In `window`, of that size, which goes after this.
    pub(crate) fn new(
        gpu: &Gpu,
        window: &Window,
        window_size: [u32; 2],
    ) -> Result<Self, Box<dyn Error>> {
        let (entry, instance, physical) = (gpu.entry(), gpu.instance(), gpu.physical_device());
        let display = window.display_handle()?.as_raw();
        let handle = window.window_handle()?.as_raw();
        // SAFETY: the instance has the extensions for this display, and the window stays longer.
        let surface =
            unsafe { ash_window::create_surface(entry, instance, display, handle, None) }?;
        let mut swapchain = Self {
            device: gpu.device().clone(),
            queue: gpu.queue(),
            physical,
            surface_functions: khr::surface::Instance::new(entry, instance),
            functions: khr::swapchain::Device::new(instance, gpu.device().raw()),
            surface,
            format: vk::SurfaceFormatKHR::default(),
            raw: vk::SwapchainKHR::null(),
            images: Vec::new(),
            size: [1; 2],
            window_size,
            is_outdated: true,
        };
        swapchain.format = swapchain.choose_format(gpu.queue_family())?;
        swapchain.remake(window_size)?;
        Ok(swapchain)
    }

    /// Colors are given as the eye sees them: a format that does not convert them, if there is one.
    fn choose_format(&self, family: u32) -> Result<vk::SurfaceFormatKHR, Box<dyn Error>> {
        let Self { surface_functions, physical, surface, .. } = self;
        // SAFETY: all are of the same instance.
        let (is_shown, formats) = unsafe {
            (
                surface_functions
                    .get_physical_device_surface_support(*physical, family, *surface)?,
                surface_functions.get_physical_device_surface_formats(*physical, *surface)?,
            )
        };
        if !is_shown {
            return Err("the device cannot show pictures in this window".into());
        }
        let wanted = [vk::Format::B8G8R8A8_UNORM, vk::Format::R8G8B8A8_UNORM];
        let right = formats.iter().find(|offered| wanted.contains(&offered.format));
        Ok(*right.or(formats.first()).ok_or("the window has no formats")?)
    }

    /// What images are to be drawn to as.
    pub(crate) fn attachments(&self) -> Attachments {
        Attachments { color: Some(self.format.format), depth: None, size: self.size }
    }

    /// Whether it is to be made anew for a window of that size.
    pub(crate) fn is_stale(&self, window_size: [u32; 2]) -> bool {
        self.is_outdated || self.window_size != window_size
    }

    /// Makes images as large as the window, once the device is idle. None, and `false`, while it has no size.
    pub(crate) fn remake(&mut self, window_size: [u32; 2]) -> Result<bool, Box<dyn Error>> {
        // SAFETY: both are of the same instance.
        let offered = unsafe {
            self.surface_functions
                .get_physical_device_surface_capabilities(self.physical, self.surface)
        }?;
        let mut extent = offered.current_extent;
        if extent.width == u32::MAX {
            let [least, most] = [offered.min_image_extent, offered.max_image_extent];
            extent.width = window_size[0].clamp(least.width, most.width);
            extent.height = window_size[1].clamp(least.height, most.height);
        }
        self.is_outdated = true;
        if extent.width == 0 || extent.height == 0 {
            return Ok(false);
        }
        let most = if offered.max_image_count == 0 { u32::MAX } else { offered.max_image_count };
        let alphas = [vk::CompositeAlphaFlagsKHR::OPAQUE, vk::CompositeAlphaFlagsKHR::INHERIT];
        let alpha =
            alphas.into_iter().find(|&alpha| offered.supported_composite_alpha.contains(alpha));
        let old = self.raw;
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(self.surface)
            .min_image_count((offered.min_image_count + 1).min(most))
            .image_format(self.format.format)
            .image_color_space(self.format.color_space)
            .image_extent(extent)
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::COLOR_ATTACHMENT)
            .pre_transform(offered.current_transform)
            .composite_alpha(alpha.ok_or("the window would be transparent")?)
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(true)
            .old_swapchain(old);
        // SAFETY: it asks for what is offered.
        let raw = unsafe { self.functions.create_swapchain(&info, None) }?;
        self.destroy_images();
        (self.raw, self.size) = (raw, [extent.width, extent.height]);
        self.make_images()?;
        (self.is_outdated, self.window_size) = (false, window_size);
        Ok(true)
    }

    fn make_images(&mut self) -> Result<(), vk::Result> {
        let device = self.device.raw();
        // SAFETY: the swapchain was just made.
        let images = unsafe { self.functions.get_swapchain_images(self.raw) }?;
        for (index, raw) in (0..).zip(images) {
            let info = vk::ImageViewCreateInfo::default()
                .image(raw)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(self.format.format)
                .subresource_range(WHOLE);
            // SAFETY: it is one of the swapchain's images.
            let view = unsafe { device.create_image_view(&info, None) }?;
            let drawn = vk::Semaphore::null();
            let attachments = self.attachments();
            self.images.push(Image { index, raw, view, attachments, drawn });
        }
        for image in &mut self.images {
            // SAFETY: a plain semaphore.
            image.drawn = unsafe { device.create_semaphore(&Default::default(), None) }?;
        }
        Ok(())
    }

    /// Destroys images and swapchain; the device is idle.
    fn destroy_images(&mut self) {
        // SAFETY: all are of this device, which does not use them any more.
        unsafe {
            for image in self.images.drain(..) {
                self.device.raw().destroy_image_view(image.view, None);
                self.device.raw().destroy_semaphore(image.drawn, None);
            }
            self.functions.destroy_swapchain(self.raw, None);
        }
        self.raw = vk::SwapchainKHR::null();
    }

    /// The next image to draw to, once `acquired` is signalled. None if the window has changed.
    pub(crate) fn acquire(
        &mut self,
        acquired: vk::Semaphore,
    ) -> Result<Option<Image>, Box<dyn Error>> {
        let no_fence = vk::Fence::null();
        // SAFETY: the semaphore is not signalled, and nothing waits for it; fewer images are in use than there are.
        let next =
            unsafe { self.functions.acquire_next_image(self.raw, u64::MAX, acquired, no_fence) };
        match next {
            Ok((index, is_suboptimal)) => {
                self.is_outdated |= is_suboptimal;
                Ok(self.images.get(index as usize).copied())
            }
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => {
                self.is_outdated = true;
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Shows an image when it was drawn to.
    pub(crate) fn present(&mut self, image: &Image) -> Result<(), Box<dyn Error>> {
        let (semaphores, swapchains, indices) = ([image.drawn], [self.raw], [image.index]);
        let info = vk::PresentInfoKHR::default()
            .wait_semaphores(&semaphores)
            .swapchains(&swapchains)
            .image_indices(&indices);
        // SAFETY: the image was acquired, and what signals its semaphore was submitted; this thread alone uses the
        // queue.
        match unsafe { self.functions.queue_present(self.queue, &info) } {
            Ok(is_suboptimal) => self.is_outdated |= is_suboptimal,
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => self.is_outdated = true,
            Err(error) => return Err(error.into()),
        }
        Ok(())
    }
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        // SAFETY: nobody else uses the device's queue. If the device is lost, nothing is used any more.
        let _ = unsafe { self.device.raw().device_wait_idle() };
        self.destroy_images();
        // SAFETY: its swapchain has gone.
        unsafe { self.surface_functions.destroy_surface(self.surface, None) };
    }
}

const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

impl Image {
    /// Signalled when it was drawn to.
    pub(crate) fn drawn(&self) -> vk::Semaphore {
        self.drawn
    }

    /// Makes it white, draws to it, and readies it to be shown.
    pub(crate) fn render(
        &self,
        commands: &mut Commands,
        draw: impl FnOnce(&mut Rendering<'_>) -> Result<(), drypoint_ash::Error>,
    ) -> Result<(), drypoint_ash::Error> {
        let device = commands.device().clone();
        let [width, height] = self.attachments.size;
        let to_draw = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
        self.transition(commands, vk::ImageLayout::UNDEFINED, to_draw);
        let white = vk::ClearValue { color: vk::ClearColorValue { float32: [1.0; 4] } };
        let colors = [vk::RenderingAttachmentInfo::default()
            .image_view(self.view)
            .image_layout(to_draw)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(white)];
        let begin = vk::RenderingInfo::default()
            .render_area(vk::Extent2D { width, height }.into())
            .layer_count(1)
            .color_attachments(&colors);
        // SAFETY: no rendering is open, and the image is in the layout that is named.
        unsafe { device.raw().cmd_begin_rendering(commands.raw(), &begin) };
        // SAFETY: it was begun with these attachments, and ends below.
        let drawn = draw(&mut unsafe { commands.in_rendering(self.attachments) });
        // SAFETY: it was begun above.
        unsafe { device.raw().cmd_end_rendering(commands.raw()) };
        self.transition(commands, to_draw, vk::ImageLayout::PRESENT_SRC_KHR);
        drawn
    }

    /// Before or after it is drawn to.
    fn transition(&self, commands: &mut Commands, from: vk::ImageLayout, to: vk::ImageLayout) {
        let drawing = vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT;
        let written = vk::AccessFlags::COLOR_ATTACHMENT_WRITE;
        let barrier = vk::ImageMemoryBarrier::default()
            .src_access_mask(written)
            .dst_access_mask(written)
            .old_layout(from)
            .new_layout(to)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.raw)
            .subresource_range(WHOLE);
        // SAFETY: no rendering is open; the image is the window's, which waits for all that was submitted.
        unsafe {
            commands.device().raw().cmd_pipeline_barrier(
                commands.raw(),
                drawing,
                drawing,
                vk::DependencyFlags::empty(),
                &[],
                &[],
                &[barrier],
            );
        }
    }
}
