//! Frames as Tsiapkolis and Bénard draw them (CGF 2024, Table 6): contours of all instances, and then
//! their lines, into a picture that nobody sees.

use std::time::Instant;

use drypoint_mesh::{Mesh, Viewpoint};
use drypoint_shaders::POSITIONS;
use drypoint_tests::report::{BRUTE_FORCE, GpuFrame, INSTANCES, OURS, Quartiles, TWO_LEVELS};
use drypoint_tests::viewpoints;
use drypoint_wgpu::{Arguments, Contours, Error, Gpu, Placement, Timer};
use glam::{DAffine3, DMat3, DVec3};

use super::variants::Variant;
use super::{Work, millis, submit};
use crate::Options;

const SOURCE: &str = include_str!("lines.wgsl");

pub(crate) const SIZE: wgpu::Extent3d =
    wgpu::Extent3d { width: 1920, height: 1080, depth_or_array_layers: 1 };

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Instances along the sides of the picture, each in a cell that is nearly square.
const GRID: [usize; 2] = [21, 12];
const _: () = assert!(GRID[0] * GRID[1] == INSTANCES);

/// What is drawn: without culling, and with.
const DRAWN: [&str; 3] = [BRUTE_FORCE, OURS, TWO_LEVELS];

/// Each instance in a cell of the picture, turned so that it shows what its viewpoint sees; drawn in
/// parallel, and so at one size.
pub(crate) fn placements(mesh: &Mesh) -> Vec<Placement> {
    let Some(bounds) = mesh.bounds() else { return Vec::new() };
    let (center, unit) = (bounds.center(), bounds.half_longest_side());
    let place = |(index, viewpoint): (usize, Viewpoint)| {
        let towards = (viewpoint.xyz() - center).normalize();
        let right = towards.any_orthonormal_vector();
        let turned = DMat3::from_cols(right, towards.cross(right), towards).transpose();
        // A mesh lies within √3 half-sides of its center; depth is within 0 ..= 1.
        let reach = 3f64.sqrt() * unit;
        let [columns, rows] = GRID.map(|count| count as f64);
        let size = DVec3::new(1.0 / columns, 1.0 / rows, 0.5) / reach;
        let matrix = DMat3::from_diagonal(size) * turned;
        let [column, row] = [index % GRID[0], index / GRID[0]].map(|number| number as f64 + 0.5);
        let cell = DVec3::new(2.0 * column / columns - 1.0, 1.0 - 2.0 * row / rows, 0.5);
        let to_scene = DAffine3::from_mat3_translation(matrix, cell - matrix * center);
        let viewpoint = Viewpoint::at(to_scene.transform_point3(viewpoint.xyz()));
        Placement { to_scene, viewpoint }
    };
    viewpoints::protocol(mesh).into_iter().enumerate().map(place).collect()
}

/// A pipeline that draws segments, and what it draws to.
struct Picture {
    pipeline: wgpu::RenderPipeline,
    texture: wgpu::Texture,
    view: wgpu::TextureView,
}

impl Picture {
    fn new(device: &wgpu::Device) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("lines"),
            source: wgpu::ShaderSource::Wgsl(format!("{POSITIONS}{SOURCE}").into()),
        });
        let compilation_options = wgpu::PipelineCompilationOptions::default();
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("lines"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("end_of_segment"),
                compilation_options: compilation_options.clone(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::LineList,
                ..Default::default()
            },
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("ink"),
                compilation_options,
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: SIZE,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Self { pipeline, texture, view }
    }

    fn bind(&self, device: &wgpu::Device, contours: &Contours) -> wgpu::BindGroup {
        let resources = [
            (0, contours.segments().as_entire_binding()),
            (2, contours.model().positions().as_entire_binding()),
            (3, wgpu::BindingResource::Buffer(contours.transforms())),
        ];
        let entries =
            resources.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("lines"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }

    fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        (bindings, contours): (&wgpu::BindGroup, &Contours),
        timer: &Timer,
    ) {
        let attachment = wgpu::RenderPassColorAttachment {
            view: &self.view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                store: wgpu::StoreOp::Store,
            },
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("lines"),
            color_attachments: &[Some(attachment)],
            depth_stencil_attachment: None,
            timestamp_writes: Some(timer.render_pass()),
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, bindings, &[]);
        pass.draw_indirect(contours.arguments(), Arguments::LINE_LIST);
    }
}

/// Whether each pixel of the picture has ink, row by row. Waits.
fn ink(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Vec<bool>, Error> {
    let bytes_per_row = 4 * SIZE.width;
    let copy = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture"),
        size: u64::from(bytes_per_row * SIZE.height),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(bytes_per_row),
        rows_per_image: None,
    };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &copy, layout },
        SIZE,
    );
    encoder.map_buffer_on_submit(&copy, wgpu::MapMode::Read, .., |_| {});
    submit(gpu, encoder)?;
    let view = copy.slice(..).get_mapped_range().map_err(|_| Error::DeviceLost)?;
    Ok(view.chunks_exact(4).map(|pixel| pixel[0] < u8::MAX).collect())
}

/// What a frame took.
struct Frame {
    extraction: f64,
    drawing: f64,
    /// Microseconds of the processor.
    recording: f64,
}

struct Frames<'a> {
    gpu: &'a Gpu,
    picture: Picture,
    timers: [Timer; 2],
}

impl<'a> Frames<'a> {
    fn new(gpu: &'a Gpu) -> Result<Self, Error> {
        let timer = || Timer::new(&gpu.device, &gpu.queue);
        Ok(Self { gpu, picture: Picture::new(&gpu.device), timers: [timer()?, timer()?] })
    }

    fn draw(
        &mut self,
        variant: &mut Variant<'_>,
        bindings: &wgpu::BindGroup,
        placements: &[Placement],
    ) -> Result<Frame, Error> {
        let device = &self.gpu.device;
        let [extraction, drawing] = &mut self.timers;
        let mut encoder = device.create_command_encoder(&Default::default());
        let start = Instant::now();
        variant.prepare(&mut encoder, placements)?;
        let timestamp_writes = Some(extraction.compute_pass());
        let descriptor = wgpu::ComputePassDescriptor { label: None, timestamp_writes };
        variant.record(&mut encoder.begin_compute_pass(&descriptor));
        let extracted = encoder.finish();
        let recording = 1e6 * start.elapsed().as_secs_f64();
        let mut encoder = device.create_command_encoder(&Default::default());
        self.picture.record(&mut encoder, (bindings, &variant.contours), drawing);
        extraction.request(&mut encoder);
        drawing.request(&mut encoder);
        self.gpu.queue.submit([extracted]);
        submit(self.gpu, encoder)?;
        Ok(Frame { extraction: millis(extraction)?, drawing: millis(drawing)?, recording })
    }
}

/// Most frames for each round: one is little, and what recording takes varies.
pub(crate) const MOST_FRAMES: u32 = 30;

/// Seconds for a round, unless a frame takes more.
pub(crate) fn seconds_per_round(options: &Options) -> f64 {
    if options.quick { 0.2 } else { 1.0 }
}

/// Frames without culling and with it, in turn.
pub(super) fn measure(
    gpu: &Gpu,
    variants: &mut [Variant<'_>],
    mesh: &Mesh,
    options: &Options,
) -> Result<Vec<GpuFrame>, String> {
    let say = |error: Error| error.to_string();
    let placements = placements(mesh);
    let mut drawn: Vec<&mut Variant<'_>> =
        variants.iter_mut().filter(|variant| DRAWN.contains(&variant.name)).collect();
    let mut frames = Frames::new(gpu).map_err(say)?;
    let bind = |variant: &&mut Variant<'_>| frames.picture.bind(&gpu.device, &variant.contours);
    let bindings: Vec<wgpu::BindGroup> = drawn.iter().map(bind).collect();
    let mut taken: Vec<Vec<Frame>> = drawn.iter().map(|_| Vec::new()).collect();
    let mut draw_all = || -> Result<f64, Error> {
        let start = Instant::now();
        for ((variant, bindings), taken) in drawn.iter_mut().zip(&bindings).zip(&mut taken) {
            taken.push(frames.draw(variant, bindings, &placements)?);
        }
        Ok(start.elapsed().as_secs_f64())
    };
    // The first frame is that of a driver that gets ready.
    draw_all().map_err(say)?;
    let seconds = draw_all().map_err(say)?;
    let per_round = f64::from(MOST_FRAMES).min(seconds_per_round(options) / seconds).max(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "30 at most")]
    let frame_count = per_round as u32 * options.rounds();
    for _ in 0..frame_count {
        draw_all().map_err(say)?;
    }
    taken.iter_mut().for_each(|taken| drop(taken.drain(..2)));
    let ink = ink(gpu, &frames.picture.texture).map_err(say)?;
    let both = |frames: &[Frame]| -> Vec<f64> {
        frames.iter().map(|frame| frame.extraction + frame.drawing).collect()
    };
    let mut report = Vec::new();
    for (variant, own) in drawn.iter().zip(&taken) {
        let lines = variant.contours.read_statistics(&gpu.queue).map_err(say)?.segments;
        if lines > 0 && !ink.contains(&true) {
            return Err("lines on the GPU: none was drawn".to_owned());
        }
        let quartiles = |value: fn(&Frame) -> f64| Quartiles::of(own.iter().map(value));
        report.push(GpuFrame {
            name: variant.name.to_owned(),
            lines,
            extraction: quartiles(|frame| frame.extraction),
            drawing: quartiles(|frame| frame.drawing),
            both: Quartiles::of(both(own)),
            over_brute_force: Quartiles::of_ratios(&both(&taken[0]), &both(own)),
            recording: quartiles(|frame| frame.recording),
        });
    }
    Ok(report)
}

#[cfg(test)]
mod tests {
    use drypoint_mesh::{MeshAdjacency, shapes};
    use drypoint_shaders::Content;
    use drypoint_wgpu::Extractor;

    use super::super::FILTER;
    use super::super::check::Seen;
    use super::*;

    #[test]
    fn every_instance_is_in_its_cell() {
        let Some(gpu) = super::super::tests::gpu() else { return };
        let mesh = shapes::bumpy_sphere(500);
        let adjacency = MeshAdjacency::new(&mesh);
        let placements = placements(&mesh);
        let seen = Seen::new(&mesh, &adjacency, &placements);
        let content = Content::without_patches(&mesh, &adjacency, FILTER);
        let extractor = Extractor::new(&gpu.device).unwrap();
        let mut variant = Variant::new(&extractor, BRUTE_FORCE, &content, seen.capacity()).unwrap();
        let mut frames = Frames::new(&gpu).unwrap();
        let bindings = frames.picture.bind(&gpu.device, &variant.contours);
        let frame = frames.draw(&mut variant, &bindings, &placements).unwrap();
        assert!(frame.extraction > 0.0 && frame.drawing > 0.0 && frame.recording > 0.0);
        let found = variant.contours.read_segments(&gpu.queue).unwrap();
        seen.compare(&found, &content.frames[0]).unwrap();

        let ink = ink(&gpu, &frames.picture.texture).unwrap();
        let mut counts = [0; INSTANCES];
        for (index, _) in ink.iter().enumerate().filter(|(_, ink)| **ink) {
            let [x, y] = [index % SIZE.width as usize, index / SIZE.width as usize];
            let cell = [x * GRID[0] / SIZE.width as usize, y * GRID[1] / SIZE.height as usize];
            counts[cell[1] * GRID[0] + cell[0]] += 1;
        }
        // The outline of a ball that fills more than half of a cell, and less than all of it.
        let [least, most] = [counts.iter().min().unwrap(), counts.iter().max().unwrap()];
        assert!(*least > 80 && *most < 2000, "{counts:?}");
        let [width, height] = [SIZE.width as usize, SIZE.height as usize];
        let border = (0..width).flat_map(|x| [x, (height - 1) * width + x]);
        assert!(border.into_iter().all(|pixel| !ink[pixel]), "lines are cut off");
    }
}
