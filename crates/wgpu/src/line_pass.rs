//! Segments as lines on the screen.

use drypoint_shaders::{Arguments, DepthOrder, INK, LINES, LineStyle, Raster, Stroke};
use glam::{Mat4, Vec2};
use wgpu::BufferUsages;

use crate::Error;
use crate::bindings::{READ, bind, layout, texture, uniform};
use crate::device::{buffer, checked, filled};
use crate::found::Found;
use crate::raster::Drawing;
use crate::staging::Staging;

const DRAWING: wgpu::ShaderStages = wgpu::ShaderStages::VERTEX_FRAGMENT;

/// Draws the segments of [`Contours`](crate::Contours) or
/// [`RigContours`](crate::RigContours) as lines of some pixels in width, with smooth edges and round ends,
/// where no surface hides them.
///
/// In two steps. [`cover`](Self::cover) finds how much of each pixel the lines cover; where several do, the
/// largest counts. So short segments join to one even line, and lines that are not opaque do not add up
/// where they cross. [`ink`](Self::ink) then blends the color into the caller's picture.
///
/// Lines are hidden by a depth texture, which may be that of [`DepthPass`](crate::DepthPass) or the
/// renderer's own. What is compared with it is the line's spine, not each pixel of its width, and it is
/// compared with the nine pixels around: a contour is visible if beside it something farther away is. The
/// usual bias that pulls lines towards the viewer has to be as large as what the surface's slope makes of half
/// the line's width, which has no limit at a contour, and it shows what lies close behind a surface. Here it
/// is no larger than rounding; a line fades within 1.12 to 1.5 pixels behind the border of what hides it.
#[derive(Debug)]
pub struct LinePass {
    device: wgpu::Device,
    target_layout: wgpu::BindGroupLayout,
    lines_layout: wgpu::BindGroupLayout,
    coverage_layout: wgpu::BindGroupLayout,
    covering: wgpu::RenderPipeline,
    inking: wgpu::RenderPipeline,
    stroke: wgpu::Buffer,
    stroke_bindings: wgpu::BindGroup,
    staging: Staging,
}

/// What coverage is kept in, 8 bits a pixel.
const COVERAGE: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

impl LinePass {
    /// For pictures of `format`, which must allow blending, with `sample_count` samples a pixel.
    ///
    /// # Errors
    /// If the device refuses the format, the count or a shader.
    pub fn new(
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        sample_count: u32,
    ) -> Result<Self, Error> {
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let size = size_of::<Stroke>() as u64;
        let stroke = buffer(device, "a line style", size, usage)?;
        checked(device, "the shaders of lines", || {
            let stroke_layout =
                layout(device, "a line style", DRAWING, &[uniform::<Stroke>(false)]);
            let depth = texture(wgpu::TextureSampleType::Depth);
            let target_layout =
                layout(device, "a line target", DRAWING, &[uniform::<Raster>(false), depth]);
            let lines_layout = layout(device, "lines", DRAWING, &[READ; 3]);
            let coverage = texture(wgpu::TextureSampleType::Float { filterable: false });
            let coverage_layout = layout(device, "the coverage of lines", DRAWING, &[coverage]);
            let layouts = [Some(&stroke_layout), Some(&target_layout), Some(&lines_layout)];
            let covering = covering(&layouts).pipeline(device);
            let layouts = [Some(&stroke_layout), Some(&coverage_layout)];
            let inking = inking(&layouts, format, sample_count).pipeline(device);
            let resources = vec![stroke.as_entire_binding()];
            let stroke_bindings =
                bind(device, "the bindings of a line style", &stroke_layout, resources)?;
            Ok(Self {
                staging: Staging::new(device, size)?,
                device: device.clone(),
                target_layout,
                lines_layout,
                coverage_layout,
                covering,
                inking,
                stroke,
                stroke_bindings,
            })
        })?
    }

    /// Takes the look of lines, and the matrix from the space of the scene to clip space with which the depth
    /// texture was drawn, for what is recorded into `encoder` from here on.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        scene_to_clip: Mat4,
        style: &LineStyle,
    ) -> Result<(), Error> {
        let stroke = style.stroke(scene_to_clip);
        let bytes = bytemuck::bytes_of(&stroke);
        self.staging.write(&self.device, encoder, &self.stroke, [(0, bytes)])
    }

    /// Records a render pass that finds what `lines` cover of `target`. Replaces what covered it before.
    pub fn cover(&self, encoder: &mut wgpu::CommandEncoder, target: &LineTarget, lines: &[&Lines]) {
        let attachment = wgpu::RenderPassColorAttachment {
            view: &target.coverage,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store: wgpu::StoreOp::Store,
            },
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("drypoint lines"),
            color_attachments: &[Some(attachment)],
            ..Default::default()
        });
        pass.set_pipeline(&self.covering);
        pass.set_bind_group(0, &self.stroke_bindings, &[]);
        pass.set_bind_group(1, &target.bindings, &[]);
        for lines in lines {
            pass.set_bind_group(2, &lines.bindings, &[]);
            pass.draw_indirect(&lines.arguments, Arguments::QUADS);
        }
    }

    /// Blends the color into what `pass` draws to, which is as large as `target`, by what covers that. No
    /// depth attachment; colors are multiplied by their alpha.
    pub fn ink(&self, pass: &mut wgpu::RenderPass<'_>, target: &LineTarget) {
        pass.set_pipeline(&self.inking);
        pass.set_bind_group(0, &self.stroke_bindings, &[]);
        pass.set_bind_group(1, &target.coverage_bindings, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn covering<'a>(layouts: &'a [Option<&'a wgpu::BindGroupLayout>]) -> Drawing<'a> {
    let larger = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Max,
    };
    let target = wgpu::ColorTargetState {
        format: COVERAGE,
        blend: Some(wgpu::BlendState { color: larger, alpha: larger }),
        write_mask: wgpu::ColorWrites::ALL,
    };
    Drawing {
        label: "drypoint lines",
        source: LINES,
        layouts,
        vertex: "stroke_vertex",
        buffers: &[],
        topology: wgpu::PrimitiveTopology::TriangleStrip,
        depth: None,
        fragment: Some(("stroke_coverage", target)),
        sample_count: 1,
    }
}

fn inking<'a>(
    layouts: &'a [Option<&'a wgpu::BindGroupLayout>],
    format: wgpu::TextureFormat,
    sample_count: u32,
) -> Drawing<'a> {
    let target = wgpu::ColorTargetState {
        format,
        blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        write_mask: wgpu::ColorWrites::ALL,
    };
    Drawing {
        label: "drypoint ink",
        source: INK,
        layouts,
        vertex: "whole_screen",
        buffers: &[],
        topology: wgpu::PrimitiveTopology::TriangleList,
        depth: None,
        fragment: Some(("ink", target)),
        sample_count,
    }
}

/// What a [`LinePass`] draws of one [`Found`]: all segments.
#[derive(Debug)]
pub struct Lines {
    bindings: wgpu::BindGroup,
    arguments: wgpu::Buffer,
}

impl Lines {
    /// Takes no memory of its own.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn new<'a>(pass: &LinePass, contours: impl Into<Found<'a>>) -> Result<Self, Error> {
        let found = contours.into();
        let resources = vec![
            found.output.segments.as_entire_binding(),
            found.positions.as_entire_binding(),
            wgpu::BindingResource::Buffer(found.transforms),
        ];
        let label = "the bindings of lines";
        Ok(Self {
            bindings: bind(&pass.device, label, &pass.lines_layout, resources)?,
            arguments: found.output.arguments.clone(),
        })
    }
}

/// What lines cover of a picture, and what hides them there. To be made anew when the picture changes size.
#[derive(Debug)]
pub struct LineTarget {
    coverage: wgpu::TextureView,
    bindings: wgpu::BindGroup,
    coverage_bindings: wgpu::BindGroup,
}

impl LineTarget {
    /// As large as the texture of `depth`, a byte a pixel. That has one sample a pixel, one level, the usage
    /// [`TEXTURE_BINDING`](wgpu::TextureUsages::TEXTURE_BINDING), and no stencil in this view.
    ///
    /// # Errors
    /// If the device refuses `depth`, or has not enough memory.
    pub fn new(
        pass: &LinePass,
        depth: &wgpu::TextureView,
        order: DepthOrder,
    ) -> Result<Self, Error> {
        let device = &pass.device;
        let depth_texture = depth.texture();
        let size = depth_texture.size();
        let coverage = checked(device, "the coverage of lines", || {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("the coverage of lines"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: COVERAGE,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        })?;
        #[expect(clippy::cast_precision_loss, reason = "sides of textures are exact in f32")]
        let size = Vec2::new(size.width as f32, size.height as f32);
        let depth_step = depth_step(depth_texture.format());
        let raster = Raster { size, depth_sign: order.sign(), depth_step };
        let raster = filled(device, "a line target", &[raster], BufferUsages::UNIFORM)?;
        let resources = vec![raster.as_entire_binding(), wgpu::BindingResource::TextureView(depth)];
        let bindings =
            bind(device, "the bindings of a line target", &pass.target_layout, resources)?;
        let resources = vec![wgpu::BindingResource::TextureView(&coverage)];
        let label = "the bindings of coverage";
        let coverage_bindings = bind(device, label, &pass.coverage_layout, resources)?;
        Ok(Self { coverage, bindings, coverage_bindings })
    }
}

/// How far two values of a depth texture are apart, 0 if they are f32.
fn depth_step(format: wgpu::TextureFormat) -> f32 {
    match format {
        wgpu::TextureFormat::Depth16Unorm => 1.0 / 65_535.0,
        wgpu::TextureFormat::Depth32Float | wgpu::TextureFormat::Depth32FloatStencil8 => 0.0,
        _ => 1.0 / 16_777_215.0,
    }
}
