//! The validation layers are on: they object to what wgpu itself lets pass.

mod support;

const SOURCE: &str = "
@vertex fn corners() -> @builtin(position) vec4f { return vec4f(0.0); }
// There is no such attachment.
@fragment fn shade() -> @location(1) vec4f { return vec4f(0.0); }
";

/// A program of its own, since all tests of one hear the same messages.
#[test]
fn a_planted_error_is_heard() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    support::expect_silence();
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(SOURCE.into()),
    });
    let _ = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
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
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    });
    let heard = std::mem::take(&mut *support::messages());
    assert!(
        heard.iter().any(|message| message.contains("writes to output location 1")),
        "the Vulkan validation layers are not installed (Debian: vulkan-validationlayers), or nobody \
         listens to them: {heard:?}"
    );
}
