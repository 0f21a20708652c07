//! Pipelines: compute, vertex and mesh ones.

use std::any::Any;
use std::sync::Arc;

use ash::vk;

use crate::binding::Layout;
use crate::shader::Shader;
use crate::{Device, Error};

/// A pipeline. A clone is the same.
#[derive(Clone, Debug)]
pub(crate) struct Pipeline {
    shared: Arc<SharedPipeline>,
}

#[derive(Debug)]
struct SharedPipeline {
    device: Device,
    raw: vk::Pipeline,
    layout: vk::PipelineLayout,
    point: vk::PipelineBindPoint,
    formats: Formats,
    /// Whether it has a mesh shader.
    is_mesh: bool,
    _layouts: Vec<Layout>,
}

/// What a pipeline draws to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Formats {
    pub(crate) color: Option<vk::Format>,
    pub(crate) depth: Option<vk::Format>,
}

/// How a color is joined with what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Blending {
    Replace,
    /// Colors are multiplied by their alpha.
    Over,
    Larger,
}

/// Pipelines that draw: on both sides of triangles, with viewport and scissor set when it is recorded.
pub(crate) struct Drawing<'a> {
    pub(crate) what: &'static str,
    /// Stages with their shaders and entry points.
    pub(crate) stages: &'a [(vk::ShaderStageFlags, &'a Shader<'a>, &'a str)],
    pub(crate) layouts: &'a [&'a Layout],
    /// For vertex shaders; a buffer of three f32 a vertex, or none.
    pub(crate) has_positions: bool,
    pub(crate) topology: vk::PrimitiveTopology,
    pub(crate) formats: Formats,
    pub(crate) blending: Blending,
    pub(crate) depth: Option<vk::CompareOp>,
}

impl Pipeline {
    pub(crate) fn compute(
        device: &Device,
        (what, source, entry): (&'static str, &str, &str),
        layouts: &[&Layout],
    ) -> Result<Self, Error> {
        let shader = Shader::new(device, what, source)?;
        let name = entry_name(entry);
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(shader.raw())
            .name(&name);
        let layout = PipelineLayout::new(device, what, layouts)?;
        let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout.raw);
        // SAFETY: the layout has what the shader binds.
        let made = unsafe {
            device.raw().create_compute_pipelines(vk::PipelineCache::null(), &[info], None)
        };
        layout.complete(made, vk::PipelineBindPoint::COMPUTE, (Formats::default(), false))
    }

    pub(crate) fn raw(&self) -> vk::Pipeline {
        self.shared.raw
    }

    pub(crate) fn layout(&self) -> vk::PipelineLayout {
        self.shared.layout
    }

    pub(crate) fn point(&self) -> vk::PipelineBindPoint {
        self.shared.point
    }

    pub(crate) fn is_mesh(&self) -> bool {
        self.shared.is_mesh
    }

    pub(crate) fn formats(&self) -> Formats {
        self.shared.formats
    }

    pub(crate) fn kept(&self) -> Arc<dyn Any + Send + Sync> {
        self.shared.clone()
    }
}

impl Drawing<'_> {
    /// Compiles it.
    pub(crate) fn pipeline(&self, device: &Device) -> Result<Pipeline, Error> {
        let names: Vec<_> = self.stages.iter().map(|(_, _, entry)| entry_name(entry)).collect();
        let infos = self.stages.iter().zip(&names).map(|(&(stage, shader, _), name)| {
            let info = vk::PipelineShaderStageCreateInfo::default().stage(stage);
            info.module(shader.raw()).name(name)
        });
        let stages: Vec<_> = infos.collect();
        let has = |wanted| self.stages.iter().any(|(stage, ..)| *stage == wanted);
        let layout = PipelineLayout::new(device, self.what, self.layouts)?;
        let colors: Vec<vk::Format> = self.formats.color.into_iter().collect();
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&colors)
            .depth_attachment_format(self.formats.depth.unwrap_or_default());
        let (buffers, attributes) = ([positions()], [position()]);
        let buffers = if self.has_positions { &buffers[..] } else { &[] };
        let attributes = if self.has_positions { &attributes[..] } else { &[] };
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(buffers)
            .vertex_attribute_descriptions(attributes);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(self.topology);
        let viewport =
            vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let draws = has(vk::ShaderStageFlags::FRAGMENT) || self.formats.depth.is_some();
        let rasterization = vk::PipelineRasterizationStateCreateInfo::default()
            .rasterizer_discard_enable(!draws)
            .line_width(1.0);
        let multisample = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(self.depth.is_some())
            .depth_write_enable(self.depth.is_some())
            .depth_compare_op(self.depth.unwrap_or(vk::CompareOp::ALWAYS));
        let attachments: Vec<_> = colors.iter().map(|_| self.blending.attachment()).collect();
        let blending = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
        let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
        let mut info = vk::GraphicsPipelineCreateInfo::default()
            .push_next(&mut rendering)
            .stages(&stages)
            .viewport_state(&viewport)
            .rasterization_state(&rasterization)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blending)
            .dynamic_state(&dynamic)
            .layout(layout.raw);
        if has(vk::ShaderStageFlags::VERTEX) {
            info = info.vertex_input_state(&vertex_input).input_assembly_state(&assembly);
        }
        // SAFETY: the layout has what the shaders bind, and all that is pointed to is still there.
        let made = unsafe {
            device.raw().create_graphics_pipelines(vk::PipelineCache::null(), &[info], None)
        };
        let is_mesh = has(vk::ShaderStageFlags::MESH_EXT);
        layout.complete(made, vk::PipelineBindPoint::GRAPHICS, (self.formats, is_mesh))
    }
}

impl Blending {
    fn attachment(self) -> vk::PipelineColorBlendAttachmentState {
        let (factor, operation) = match self {
            Self::Replace => (vk::BlendFactor::ZERO, vk::BlendOp::ADD),
            Self::Over => (vk::BlendFactor::ONE_MINUS_SRC_ALPHA, vk::BlendOp::ADD),
            Self::Larger => (vk::BlendFactor::ONE, vk::BlendOp::MAX),
        };
        vk::PipelineColorBlendAttachmentState::default()
            .blend_enable(self != Self::Replace)
            .src_color_blend_factor(vk::BlendFactor::ONE)
            .dst_color_blend_factor(factor)
            .color_blend_op(operation)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(factor)
            .alpha_blend_op(operation)
            .color_write_mask(vk::ColorComponentFlags::RGBA)
    }
}

fn entry_name(entry: &str) -> std::ffi::CString {
    std::ffi::CString::new(entry).expect("names in WGSL have no zero byte")
}

fn positions() -> vk::VertexInputBindingDescription {
    vk::VertexInputBindingDescription::default().stride(12)
}

fn position() -> vk::VertexInputAttributeDescription {
    vk::VertexInputAttributeDescription::default().format(vk::Format::R32G32B32_SFLOAT)
}

/// The layout of a pipeline that is being made.
struct PipelineLayout<'a> {
    device: &'a Device,
    what: &'static str,
    raw: vk::PipelineLayout,
    layouts: Vec<Layout>,
}

impl<'a> PipelineLayout<'a> {
    fn new(device: &'a Device, what: &'static str, layouts: &[&Layout]) -> Result<Self, Error> {
        let raw: Vec<_> = layouts.iter().map(|layout| layout.raw()).collect();
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&raw);
        // SAFETY: all layouts are of this device.
        let raw = unsafe { device.raw().create_pipeline_layout(&info, None) };
        let raw = raw.map_err(|error| Error::of(what, error))?;
        Ok(Self { device, what, raw, layouts: layouts.iter().copied().cloned().collect() })
    }

    /// The pipeline of what the driver gave.
    fn complete(
        self,
        made: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
        point: vk::PipelineBindPoint,
        (formats, is_mesh): (Formats, bool),
    ) -> Result<Pipeline, Error> {
        let raw = made.map(|pipelines| pipelines[0]).map_err(|(_, error)| {
            // SAFETY: nobody else has seen the layout.
            unsafe { self.device.raw().destroy_pipeline_layout(self.raw, None) };
            Error::of(self.what, error)
        })?;
        let device = self.device.clone();
        let (layout, layouts) = (self.raw, self.layouts);
        let shared =
            SharedPipeline { device, raw, layout, point, formats, is_mesh, _layouts: layouts };
        Ok(Pipeline { shared: Arc::new(shared) })
    }
}

impl Drop for SharedPipeline {
    fn drop(&mut self) {
        // SAFETY: commands that use it keep it until they have executed.
        unsafe {
            self.device.raw().destroy_pipeline(self.raw, None);
            self.device.raw().destroy_pipeline_layout(self.layout, None);
        }
    }
}
