//! The validation layers are on: they object to what wgpu itself lets pass.

mod support;

#[test]
fn a_planted_error_is_heard() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    support::expect_silence();
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(
            "@vertex fn main() -> @builtin(position) vec4f { return vec4f(0.0); }".into(),
        ),
    });
    // An attribute that the shader does not read.
    let attribute = wgpu::VertexAttribute {
        format: wgpu::VertexFormat::Float32,
        offset: 0,
        shader_location: 0,
    };
    let buffers = [Some(wgpu::VertexBufferLayout {
        array_stride: 4,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &[attribute],
    })];
    let _ = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &buffers,
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(false),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    });
    let heard = std::mem::take(&mut *support::messages());
    assert!(
        heard.iter().any(|message| message.contains("not consumed")),
        "the Vulkan validation layers are not installed (Debian: vulkan-validationlayers), or do not \
         listen: {heard:?}"
    );
}
