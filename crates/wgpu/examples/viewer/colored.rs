//! Each face in the color of a patch that holds an edge of it.

use std::collections::HashMap;

use drypoint_fusion::PatchSet;
use drypoint_mesh::{Mesh, weld_by_position};
use drypoint_wgpu::Contours;
use glam::Mat4;
use wgpu::util::DeviceExt;

use crate::target::{DEPTH, Target};

pub(crate) struct ColoredPatches {
    pipeline: wgpu::RenderPipeline,
    vertices: wgpu::Buffer,
    vertex_count: u32,
    view: wgpu::Buffer,
    bindings: wgpu::BindGroup,
}

/// A position and a color, as they lie in the buffer.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Vertex {
    position: [f32; 3],
    color: [u8; 4],
}

impl ColoredPatches {
    /// Where `contours` was prepared to have instances.
    pub(crate) fn new(
        target: &Target,
        mesh: &Mesh,
        patches: &PatchSet,
        contours: &Contours,
    ) -> Self {
        let device = &target.device;
        let vertices = vertices(mesh, patches);
        let pipeline = pipeline(device, target.format());
        let view = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("view of colored faces"),
            size: size_of::<Mat4>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self {
            bindings: bind(device, &pipeline, &view, contours),
            pipeline,
            vertex_count: u32::try_from(vertices.len()).unwrap_or(u32::MAX),
            vertices: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("colored faces"),
                contents: bytemuck::cast_slice(&vertices),
                usage: wgpu::BufferUsages::VERTEX,
            }),
            view,
        }
    }

    /// Where other `contours` of the same model have instances.
    pub(crate) fn follow(&mut self, device: &wgpu::Device, contours: &Contours) {
        self.bindings = bind(device, &self.pipeline, &self.view, contours);
    }

    /// Draws `instances` over the depth of the same faces.
    pub(crate) fn draw(
        &self,
        queue: &wgpu::Queue,
        pass: &mut wgpu::RenderPass<'_>,
        scene_to_clip: &Mat4,
        instances: u32,
    ) {
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(scene_to_clip));
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bindings, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..self.vertex_count, 0..instances);
    }
}

fn bind(
    device: &wgpu::Device,
    pipeline: &wgpu::RenderPipeline,
    view: &wgpu::Buffer,
    contours: &Contours,
) -> wgpu::BindGroup {
    let transforms = wgpu::BindingResource::Buffer(contours.transforms());
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("colored faces"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: view.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: transforms },
        ],
    })
}

fn vertices(mesh: &Mesh, patches: &PatchSet) -> Vec<Vertex> {
    // Faces are known by the lowest vertices at their corners' places, as wings name them.
    let sorted = |mut face: [u32; 3]| {
        face.sort_unstable();
        face
    };
    let mut patch_of = HashMap::new();
    for (index, patch) in patches.patches().iter().enumerate() {
        let range = patch.edges().start as usize..patch.edges().end as usize;
        for wing in &patches.wings()[range] {
            patch_of.entry(sorted(wing.left_face())).or_insert(index);
            patch_of.entry(sorted(wing.right_face())).or_insert(index);
        }
    }
    let welded = weld_by_position(mesh.positions());
    let of_face = |&face: &[u32; 3]| {
        let patch = patch_of.get(&sorted(face.map(|vertex| welded[vertex as usize])));
        let color = patch.map_or([200; 4], |&patch| color(patch));
        face.map(|vertex| Vertex { position: mesh.position(vertex).to_array(), color })
    };
    mesh.triangles().iter().flat_map(of_face).collect()
}

/// Pale, and unlike those of the patches before and after.
fn color(patch: usize) -> [u8; 4] {
    let hue = (patch as f32 * 0.618_034).fract() * 6.0;
    let channel = |shift: f32| {
        let distance = ((hue + shift) % 6.0 - 3.0).abs();
        #[expect(clippy::cast_possible_truncation, reason = "from 140 to 242")]
        let channel = (255.0 * (0.55 + 0.4 * (distance - 1.0).clamp(0.0, 1.0))) as u8;
        channel
    };
    [channel(0.0), channel(4.0), channel(2.0), 255]
}

fn pipeline(device: &wgpu::Device, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("colored.wgsl"));
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Unorm8x4];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("colored faces"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &attributes,
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::LessEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
