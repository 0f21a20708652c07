//! What brute force cannot be faster than.

use drypoint_shaders::{CONTOUR, Content, EdgePlanes, prelude};
use drypoint_wgpu::{Error, Gpu, Placement};
use wgpu::util::DeviceExt;

use super::Work;

const SOURCE: &str = include_str!("reading.wgsl");

/// Rounds of a workgroup's lanes, as many as brute force takes where there are many instances.
const ROUNDS: u32 = 32;

/// Reads the planes of all edges, for each instance anew.
pub(super) struct PlanesRead {
    pipeline: wgpu::ComputePipeline,
    /// Bindings of as many edges as one may have, and workgroups for an instance.
    pages: Vec<(wgpu::BindGroup, u32)>,
    instances: u32,
    /// Workgroups along one dimension.
    row: u32,
}

impl PlanesRead {
    /// With workgroups of `width` lanes.
    pub(super) fn new(gpu: &Gpu, content: &Content, width: u32) -> Self {
        let device = &gpu.device;
        let edges_per_workgroup = ROUNDS * width;
        let constant = format!("const EDGES_PER_WORKGROUP: u32 = {edges_per_workgroup}u;\n");
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("the floor"),
            source: wgpu::ShaderSource::Wgsl(
                (prelude(width) + &constant + CONTOUR + SOURCE).into(),
            ),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("the floor"),
            layout: None,
            module: &module,
            entry_point: Some("read_planes"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let layout = pipeline.get_bind_group_layout(0);
        let limits = device.limits();
        let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
            / size_of::<EdgePlanes>() as u64;
        let most = usize::try_from(most).unwrap_or(usize::MAX);
        let bind = |planes: &[EdgePlanes]| {
            let buffer = |contents: &[u8]| {
                device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some("the floor"),
                    contents,
                    usage: wgpu::BufferUsages::STORAGE,
                })
            };
            let buffers = [buffer(bytemuck::cast_slice(planes)), buffer(&[0; 16])];
            let resources = buffers.iter().map(wgpu::Buffer::as_entire_binding);
            let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
            let entries: Vec<_> = (0..).zip(resources).map(entry).collect();
            let descriptor =
                wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries };
            let blocks = planes.len().div_ceil(edges_per_workgroup as usize);
            let blocks = u32::try_from(blocks).expect("edges have a u32 each");
            (device.create_bind_group(&descriptor), blocks)
        };
        let pages = content.planes.chunks(most).map(bind).collect();
        Self { pipeline, pages, instances: 0, row: limits.max_compute_workgroups_per_dimension }
    }
}

impl Work for PlanesRead {
    fn prepare(
        &mut self,
        _: &mut wgpu::CommandEncoder,
        placements: &[Placement],
    ) -> Result<(), Error> {
        self.instances = u32::try_from(placements.len()).unwrap_or(u32::MAX);
        Ok(())
    }

    fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_pipeline(&self.pipeline);
        for (bindings, blocks) in &self.pages {
            pass.set_bind_group(0, bindings, &[]);
            // As many as there are rows may be too many, of thousands.
            let workgroups = blocks * self.instances;
            let rows = workgroups.div_ceil(self.row);
            pass.dispatch_workgroups(workgroups.div_ceil(rows.max(1)), rows, 1);
        }
    }
}
