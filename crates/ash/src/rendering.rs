//! Drawing, between the beginning and the end of rendering to images.

use ash::vk;
use drypoint_shaders::DepthOrder;

use crate::binding::Set;
use crate::commands::Commands;
use crate::memory::{Buffer, Image};
use crate::pipeline::{Formats, Pipeline};
use crate::queries::Counting;
use crate::{Device, Error};

/// Commands while images are drawn to.
#[derive(Debug)]
pub struct Rendering<'a> {
    commands: &'a mut Commands,
    formats: Formats,
    /// Whether rendering was begun here, and ends here.
    is_ours: bool,
}

/// What the caller draws to, when it has begun rendering itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attachments {
    /// Format of the only color attachment.
    pub color: Option<vk::Format>,
    /// Format of the depth attachment.
    pub depth: Option<vk::Format>,
    /// Width and height of what is drawn to, in pixels.
    pub size: [u32; 2],
}

/// Images to draw to; each is cleared first.
pub(crate) struct Targets<'a> {
    /// In the layout for color attachments, and what it is cleared to.
    pub(crate) color: Option<(&'a Image, vk::Format, [f32; 4])>,
    /// In the layout for depth attachments.
    pub(crate) depth: Option<(&'a Image, vk::Format, DepthOrder)>,
    pub(crate) size: [u32; 2],
}

impl Commands {
    /// Draws within the rendering that the caller has begun.
    ///
    /// # Safety
    /// Rendering is open in the command buffer, begun with these attachments, one sample a pixel, one layer and
    /// no view mask, and stays so until this value goes.
    pub unsafe fn in_rendering(&mut self, attachments: Attachments) -> Rendering<'_> {
        let Attachments { color, depth, size } = attachments;
        let rendering =
            Rendering { commands: self, formats: Formats { color, depth }, is_ours: false };
        rendering.set_viewport(size);
        rendering
    }

    pub(crate) fn render(&mut self, targets: &Targets<'_>) -> Rendering<'_> {
        self.end_rendering();
        let info = |image: &Image, layout, value| {
            vk::RenderingAttachmentInfo::default()
                .image_view(image.view())
                .image_layout(layout)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(value)
        };
        let color = targets.color.map(|(image, _, background)| {
            self.keep(image.kept());
            let value = vk::ClearValue { color: vk::ClearColorValue { float32: background } };
            info(image, vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, value)
        });
        let depth = targets.depth.map(|(image, _, order)| {
            self.keep(image.kept());
            let depth = vk::ClearDepthStencilValue { depth: order.cleared(), stencil: 0 };
            let value = vk::ClearValue { depth_stencil: depth };
            info(image, vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL, value)
        });
        let colors: Vec<_> = color.into_iter().collect();
        let [width, height] = targets.size;
        let area =
            vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        let mut begin = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .color_attachments(&colors);
        if let Some(depth) = &depth {
            begin = begin.depth_attachment(depth);
        }
        // SAFETY: no rendering is open; the images are kept, and in the layouts that are named.
        unsafe { self.device().raw().cmd_begin_rendering(self.raw(), &begin) };
        self.is_rendering = true;
        let formats = Formats {
            color: targets.color.map(|(_, format, _)| format),
            depth: targets.depth.map(|(_, format, _)| format),
        };
        let rendering = Rendering { commands: self, formats, is_ours: true };
        rendering.set_viewport(targets.size);
        rendering
    }
}

impl Rendering<'_> {
    /// The device.
    pub fn device(&self) -> &Device {
        self.commands.device()
    }

    pub(crate) fn commands(&self) -> &Commands {
        self.commands
    }

    pub(crate) fn check(&self, device: &Device, what: &'static str) -> Result<(), Error> {
        self.commands.check(device, what)
    }

    /// With y up, as WGSL has it.
    fn set_viewport(&self, [width, height]: [u32; 2]) {
        #[expect(clippy::cast_precision_loss, reason = "sides of images are exact in f32")]
        let [x, y] = [width as f32, height as f32];
        let viewport =
            vk::Viewport { x: 0.0, y, width: x, height: -y, min_depth: 0.0, max_depth: 1.0 };
        let scissor =
            vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        let (device, raw) = (self.commands.device().raw(), self.commands.raw());
        // SAFETY: of a size that images have.
        unsafe {
            device.cmd_set_viewport(raw, 0, &[viewport]);
            device.cmd_set_scissor(raw, 0, &[scissor]);
        }
    }

    /// Chooses a pipeline that draws to what is rendered to.
    pub(crate) fn bind(
        &mut self,
        pipeline: &Pipeline,
        what: &'static str,
        sets: &[(&Set, &[u32])],
    ) -> Result<(), Error> {
        if pipeline.formats() != self.formats {
            let (expected, given) = (pipeline.formats(), self.formats);
            return Err(Error::OtherAttachments {
                what,
                expected: expected.color,
                expected_depth: expected.depth,
                color: given.color,
                depth: given.depth,
            });
        }
        let other = if pipeline.is_mesh() { Counting::Compute } else { Counting::MeshShaders };
        if self.commands.counting() == Some(other) {
            return Err(Error::Counting { what });
        }
        self.commands.bind(pipeline, sets);
        Ok(())
    }

    pub(crate) fn draw(&mut self, vertices: u32) {
        // SAFETY: a pipeline of vertex shaders is bound with all that it needs.
        unsafe { self.device().raw().cmd_draw(self.commands.raw(), vertices, 1, 0, 0) };
    }

    /// Draws what four numbers at `offset` say.
    pub(crate) fn draw_indirect(&mut self, arguments: &Buffer, offset: u64) {
        assert!(offset + 16 <= arguments.size(), "the arguments are there");
        self.commands.keep(arguments.kept());
        let raw = self.commands.raw();
        // SAFETY: as above; arguments are kept, and written by our shaders.
        unsafe { self.device().raw().cmd_draw_indirect(raw, arguments.raw(), offset, 1, 16) };
    }

    /// Draws triangles of `positions` by `indices`, so many of them from the first.
    pub(crate) fn draw_indexed(
        &mut self,
        positions: &Buffer,
        (indices, range): (&Buffer, std::ops::Range<u32>),
        instances: u32,
    ) {
        self.commands.keep(positions.kept());
        self.commands.keep(indices.kept());
        let (device, raw) = (self.commands.device().raw(), self.commands.raw());
        let (first, count) = (range.start, range.end - range.start);
        // SAFETY: as above; both buffers are kept, and indices are of vertices in the first.
        unsafe {
            device.cmd_bind_vertex_buffers(raw, 0, &[positions.raw()], &[0]);
            device.cmd_bind_index_buffer(raw, indices.raw(), 0, vk::IndexType::UINT32);
            device.cmd_draw_indexed(raw, count, instances, first, 0, 0);
        }
    }

    /// Launches task workgroups, or mesh workgroups where the pipeline has no task shader.
    pub(crate) fn draw_mesh_tasks(&mut self, [x, y]: [u32; 2]) {
        let raw = self.commands.raw();
        // SAFETY: a pipeline of mesh shaders is bound with all that it needs; no more workgroups than the
        // device allows.
        unsafe { self.device().mesh_shader().cmd_draw_mesh_tasks(raw, x, y, 1) };
    }
}

impl Drop for Rendering<'_> {
    fn drop(&mut self) {
        if self.is_ours {
            self.commands.end_rendering();
        }
    }
}
