//! A picture that no window shows.

use drypoint_shaders::{DepthOrder, View, divide_by_alpha};

use crate::Error;
use crate::depth_pass::{DepthPass, Surface};
use crate::device::checked;
use crate::found::Found;
use crate::line_pass::{LinePass, LineTarget, Lines};
use crate::output::read;

/// Lines on a background, off screen: the passes and textures that this takes, 9 bytes a pixel and as much
/// again to read them.
#[derive(Debug)]
pub struct Picture {
    device: wgpu::Device,
    size: [u32; 2],
    order: DepthOrder,
    color: wgpu::Texture,
    color_view: wgpu::TextureView,
    depth_view: wgpu::TextureView,
    target: LineTarget,
    depth_pass: DepthPass,
    line_pass: LinePass,
}

/// What is drawn of one model: its contours, the triangles that hide lines, and the lines.
#[derive(Clone, Debug)]
pub struct Subject<'a> {
    /// Prepared and recorded before.
    pub contours: Found<'a>,
    /// Made for them with [`Picture::depth_pass`].
    pub surface: &'a Surface,
    /// Made for them with [`Picture::line_pass`].
    pub lines: &'a Lines,
}

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

impl Picture {
    /// Of width and height in pixels. Depths run as `order` says.
    ///
    /// # Errors
    /// [`Error::PictureSize`] if the device allows no texture of that size, or if it has not enough memory.
    pub fn new(device: &wgpu::Device, size: [u32; 2], order: DepthOrder) -> Result<Self, Error> {
        let limit = device.limits().max_texture_dimension_2d;
        if !size.iter().all(|side| (1..=limit).contains(side)) {
            let [width, height] = size;
            return Err(Error::PictureSize { width, height, limit });
        }
        let color = texture(device, size, COLOR, wgpu::TextureUsages::COPY_SRC)?;
        let depth = texture(device, size, DEPTH, wgpu::TextureUsages::TEXTURE_BINDING)?;
        let [color_view, depth_view] =
            [&color, &depth].map(|t| t.create_view(&wgpu::TextureViewDescriptor::default()));
        let line_pass = LinePass::new(device, COLOR, 1)?;
        Ok(Self {
            device: device.clone(),
            size,
            order,
            target: LineTarget::new(&line_pass, &depth_view, order)?,
            color,
            color_view,
            depth_view,
            depth_pass: DepthPass::new(device, DEPTH, order)?,
            line_pass,
        })
    }

    /// To make [`Surface`]s with.
    pub fn depth_pass(&self) -> &DepthPass {
        &self.depth_pass
    }

    /// To make [`Lines`] with.
    pub fn line_pass(&self) -> &LinePass {
        &self.line_pass
    }

    /// Records the drawing of `subjects`, in place of what was drawn before.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn draw(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        view: &View,
        subjects: &[Subject<'_>],
    ) -> Result<(), Error> {
        self.depth_pass.prepare(encoder, view.scene_to_clip)?;
        self.line_pass.prepare(encoder, view.scene_to_clip, &view.lines)?;
        self.draw_depth(encoder, subjects);
        let lines: Vec<&Lines> = subjects.iter().map(|subject| subject.lines).collect();
        self.line_pass.cover(encoder, &self.target, &lines);
        let [r, g, b, a] = view.background_times_alpha().map(f64::from);
        let background = wgpu::Color { r, g, b, a };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("drypoint picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.color_view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(background),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        self.line_pass.ink(&mut pass, &self.target);
        Ok(())
    }

    fn draw_depth(&self, encoder: &mut wgpu::CommandEncoder, subjects: &[Subject<'_>]) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("drypoint depth"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth_view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(self.order.cleared()),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        for Subject { contours, surface, .. } in subjects {
            self.depth_pass.record(&mut pass, surface, contours.clone());
        }
    }

    /// Waits for the GPU and reads what was submitted last: red, green, blue and alpha of each pixel, a byte
    /// each, row by row from the top, not multiplied by alpha.
    ///
    /// # Errors
    /// If the device is lost or out of memory, or allows no buffer of that size.
    pub fn read(&self, queue: &wgpu::Queue) -> Result<Vec<u8>, Error> {
        let [width, height] = self.size;
        let row = 4 * width;
        let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(padded_row) * u64::from(height);
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let copy = crate::device::buffer(&self.device, "a picture", bytes, usage)?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(padded_row),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            self.color.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &copy, layout },
            self.color.size(),
        );
        queue.submit([encoder.finish()]);
        let padded = read(&self.device, queue, &copy, bytes)?;
        let rows = padded.chunks(padded_row as usize).flat_map(|padded| &padded[..row as usize]);
        let mut pixels: Vec<u8> = rows.copied().collect();
        pixels.as_chunks_mut().0.iter_mut().for_each(divide_by_alpha);
        Ok(pixels)
    }
}

fn texture(
    device: &wgpu::Device,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> Result<wgpu::Texture, Error> {
    let descriptor = wgpu::TextureDescriptor {
        label: Some("drypoint picture"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    };
    checked(device, "a picture", || device.create_texture(&descriptor))
}
