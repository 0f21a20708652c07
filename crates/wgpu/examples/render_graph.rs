//! Contours as two nodes of a renderer's own frame: `render_graph [OUT.png]`.
//!
//! The renderer has its own device, with the limits of plain WebGPU, its own camera, reversed depth, and
//! draws shaded instances as it always did. Drypoint finds contours in a compute pass of the same encoder,
//! and draws lines over the picture, hidden by the renderer's depth.
#![allow(clippy::print_stdout, reason = "the counts are what this program is for")]

use std::error::Error;
use std::ops::ControlFlow;

use drypoint_fusion::{FusionParams, fuse};
use drypoint_mesh::{EdgeFilter, Mesh, MeshAdjacency, Viewpoint, shapes};
use drypoint_wgpu::{
    Capacity, Contours, DepthOrder, Extractor, LinePass, LineStyle, LineTarget, Lines, Method,
    Model, Placement,
};
use glam::dcamera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};
use glam::{DAffine3, DVec3, Mat4};
use wgpu::util::DeviceExt;

const SIZE: u32 = 1000;
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Faces by their slope, as seen from above. The renderer's own shader.
const SHADING: &str = "
struct Corner { @builtin(position) position: vec4f, @location(0) place: vec3f }
@group(0) @binding(0) var<uniform> clip: array<mat4x4f, 9>;
@vertex fn corner(@location(0) p: vec3f, @builtin(instance_index) i: u32) -> Corner {
    return Corner(clip[i] * vec4f(p, 1.0), p);
}
@fragment fn shade(c: Corner) -> @location(0) vec4f {
    let normal = normalize(cross(dpdx(c.place), dpdy(c.place)));
    return vec4f(mix(vec3f(0.75, 0.80, 0.86), vec3f(0.97), abs(normal.y)), 1.0);
}
";

/// The renderer that was there before.
struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    color: wgpu::Texture,
    depth: wgpu::TextureView,
    shading: wgpu::RenderPipeline,
    clip: wgpu::Buffer,
    bindings: wgpu::BindGroup,
    positions: wgpu::Buffer,
    indices: wgpu::Buffer,
    index_count: u32,
}

/// What this adds to it.
struct ContourNodes {
    extractor: Extractor,
    contours: Contours,
    line_pass: LinePass,
    target: LineTarget,
    lines: Lines,
}

impl ContourNodes {
    fn new(renderer: &Renderer, mesh: &Mesh, instances: u32) -> Result<Self, Box<dyn Error>> {
        let adjacency = MeshAdjacency::new(mesh);
        let go_on = |_| ControlFlow::Continue(());
        let patches = fuse(mesh, &adjacency, EdgeFilter::Convex, &FusionParams::FAST, &go_on)?;
        let extractor = Extractor::new(&renderer.device)?;
        let model = Model::new(&extractor, &[&patches])?;
        let capacity = Capacity { placements: instances, segments: 100_000 };
        let contours = Contours::new(&extractor, &model, capacity)?;
        let line_pass = LinePass::new(&renderer.device, COLOR, 1)?;
        Ok(Self {
            target: LineTarget::new(&line_pass, &renderer.depth, DepthOrder::Reversed)?,
            lines: Lines::new(&line_pass, &contours)?,
            extractor,
            contours,
            line_pass,
        })
    }

    /// A node before anything that needs contours. It could run while shadows are drawn.
    fn find(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        placements: &[Placement],
    ) -> Result<(), drypoint_wgpu::Error> {
        self.contours.prepare(encoder, placements, Method::Patches)?;
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        self.extractor.record(&mut pass, &self.contours);
        Ok(())
    }

    /// A node after the depth is complete.
    fn draw(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        color: &wgpu::TextureView,
        scene_to_clip: Mat4,
    ) -> Result<(), drypoint_wgpu::Error> {
        self.line_pass.prepare(encoder, scene_to_clip, &LineStyle::default())?;
        self.line_pass.cover(encoder, &self.target, &[&self.lines]);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment(color, wgpu::LoadOp::Load))],
            ..Default::default()
        });
        self.line_pass.ink(&mut pass, &self.target);
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or("render-graph.png".to_owned());
    let mesh = shapes::torus_knot(20_000);
    let renderer = Renderer::new(&mesh)?;
    let to_scene: Vec<_> = (0..9).map(place).collect();
    let mut nodes = ContourNodes::new(&renderer, &mesh, 9)?;

    let eye = DVec3::new(9.0, 14.0, 24.0);
    let lens = perspective_infinite_reverse(36f64.to_radians(), 1.0, 0.1);
    let scene_to_clip = lens * look_at_mat4(eye, DVec3::ZERO, DVec3::Y);
    let viewpoint = Viewpoint::at(eye);
    let placed = |&to_scene: &DAffine3| Placement { to_scene, viewpoint };
    let placements: Vec<_> = to_scene.iter().map(placed).collect();

    let color = renderer.color.create_view(&Default::default());
    let mut encoder = renderer.device.create_command_encoder(&Default::default());
    nodes.find(&mut encoder, &placements)?;
    let to_clip = |placed: &DAffine3| (scene_to_clip * *placed).as_mat4();
    renderer.shade(&mut encoder, &color, &to_scene.iter().map(to_clip).collect::<Vec<_>>());
    nodes.draw(&mut encoder, &color, scene_to_clip.as_mat4())?;
    renderer.queue.submit([encoder.finish()]);

    println!("{:?}", nodes.contours.read_statistics(&renderer.queue)?);
    renderer.save(&path)
}

/// In three rows, every other one a mirror image.
fn place(index: u32) -> DAffine3 {
    let [column, row] = [index % 3, index / 3].map(f64::from);
    let mirror = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
    DAffine3::from_translation(DVec3::new(column - 1.0, 0.0, row - 1.0) * 6.5)
        * DAffine3::from_rotation_y(f64::from(index))
        * DAffine3::from_scale(DVec3::new(mirror, 1.0, 1.0))
}

impl Renderer {
    fn new(mesh: &Mesh) -> Result<Self, Box<dyn Error>> {
        let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        let instance = wgpu::Instance::new(descriptor);
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        let texture = |format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let buffer = |contents: &[u8], usage| {
            let descriptor = wgpu::util::BufferInitDescriptor { label: None, contents, usage };
            device.create_buffer_init(&descriptor)
        };
        let shading = shading(&device);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let clip = buffer(bytemuck::cast_slice(&[Mat4::IDENTITY; 9]), usage);
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &shading.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: clip.as_entire_binding() }],
        });
        let depth = texture(DEPTH, wgpu::TextureUsages::TEXTURE_BINDING);
        let positions = bytemuck::cast_slice(mesh.positions());
        let indices = mesh.triangles().as_flattened();
        Ok(Self {
            color: texture(COLOR, wgpu::TextureUsages::COPY_SRC),
            depth: depth.create_view(&Default::default()),
            positions: buffer(positions, wgpu::BufferUsages::VERTEX),
            indices: buffer(bytemuck::cast_slice(indices), wgpu::BufferUsages::INDEX),
            index_count: u32::try_from(indices.len())?,
            shading,
            clip,
            bindings,
            device,
            queue,
        })
    }

    /// The node that draws the scene.
    fn shade(&self, encoder: &mut wgpu::CommandEncoder, color: &wgpu::TextureView, clip: &[Mat4]) {
        self.queue.write_buffer(&self.clip, 0, bytemuck::cast_slice(clip));
        let white = wgpu::LoadOp::Clear(wgpu::Color::WHITE);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment(color, white))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.shading);
        pass.set_bind_group(0, &self.bindings, &[]);
        pass.set_vertex_buffer(0, self.positions.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.index_count, 0, 0..9);
    }

    fn save(&self, path: &str) -> Result<(), Box<dyn Error>> {
        // Rows of 4000 bytes are copied at a distance of 4096.
        let row = (4 * SIZE).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let copy = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row * SIZE),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row),
            rows_per_image: None,
        };
        let to = wgpu::TexelCopyBufferInfo { buffer: &copy, layout };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(self.color.as_image_copy(), to, self.color.size());
        self.queue.submit([encoder.finish()]);
        copy.map_async(wgpu::MapMode::Read, .., |result| result.expect("nothing else maps it"));
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let padded = copy.get_mapped_range(..)?;
        let rows = padded.chunks(row as usize).flat_map(|padded| &padded[..4 * SIZE as usize]);
        let mut png = png::Encoder::new(std::fs::File::create(path)?, SIZE, SIZE);
        png.set_color(png::ColorType::Rgba);
        png.write_header()?.write_image_data(&rows.copied().collect::<Vec<u8>>())?;
        Ok(())
    }
}

fn shading(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(SHADING.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPassColorAttachment<'_> {
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}
