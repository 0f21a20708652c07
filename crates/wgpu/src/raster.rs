//! What the pipelines that draw have in common.

/// Which way depths run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthOrder {
    /// From 0 at the near plane to 1 at the far plane, cleared to 1.
    #[default]
    Standard,
    /// From 1 at the near plane to 0 at the far plane or at infinity, cleared to 0: exact far away too, in
    /// a texture of f32.
    Reversed,
}

impl DepthOrder {
    /// What a depth texture is cleared to: farther than all.
    pub const fn cleared(self) -> f32 {
        match self {
            Self::Standard => 1.0,
            Self::Reversed => 0.0,
        }
    }

    pub(crate) const fn compare(self) -> wgpu::CompareFunction {
        match self {
            Self::Standard => wgpu::CompareFunction::LessEqual,
            Self::Reversed => wgpu::CompareFunction::GreaterEqual,
        }
    }

    pub(crate) const fn sign(self) -> f32 {
        match self {
            Self::Standard => 1.0,
            Self::Reversed => -1.0,
        }
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
