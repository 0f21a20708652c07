//! What the pipelines that draw have in common.

use drypoint_shaders::DepthOrder;

pub(crate) const fn compare(order: DepthOrder) -> wgpu::CompareFunction {
    match order {
        DepthOrder::Standard => wgpu::CompareFunction::LessEqual,
        DepthOrder::Reversed => wgpu::CompareFunction::GreaterEqual,
    }
}

/// A pipeline from one source, which draws triangles on both sides.
pub(crate) struct Drawing<'a> {
    pub(crate) label: &'static str,
    pub(crate) source: &'static str,
    pub(crate) layouts: &'a [Option<&'a wgpu::BindGroupLayout>],
    pub(crate) vertex: &'static str,
    pub(crate) buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    pub(crate) topology: wgpu::PrimitiveTopology,
    pub(crate) depth: Option<wgpu::DepthStencilState>,
    /// The fragment shader and what it writes to.
    pub(crate) fragment: Option<(&'static str, wgpu::ColorTargetState)>,
    pub(crate) sample_count: u32,
}

impl Drawing<'_> {
    pub(crate) fn pipeline(self, device: &wgpu::Device) -> wgpu::RenderPipeline {
        let label = Some(self.label);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label,
            source: wgpu::ShaderSource::Wgsl(self.source.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: self.layouts,
            immediate_size: 0,
        });
        let (fragment, target) = self.fragment.unzip();
        let targets = [target];
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(self.vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: self.buffers,
            },
            primitive: wgpu::PrimitiveState { topology: self.topology, ..Default::default() },
            depth_stencil: self.depth,
            multisample: wgpu::MultisampleState { count: self.sample_count, ..Default::default() },
            fragment: fragment.map(|entry_point| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
