//! What shaders read and write of a frame of a rig.

use drypoint_shaders::{CarrierTransform, Transform, Work};
use glam::Vec4;

use crate::Error;
use crate::bindings::bind;
use crate::extractor::Extractor;
use crate::output::Output;
use crate::rig_model::RigModel;

/// Where each kind of input lies in its buffer, in bytes: begin and size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sections {
    pub(crate) viewpoints: [u64; 2],
    pub(crate) transforms: [u64; 2],
    pub(crate) carriers: [u64; 2],
    pub(crate) weights: [u64; 2],
    pub(crate) work: u64,
    /// From one dispatch's work to the next.
    pub(crate) stride: usize,
    pub(crate) size: u64,
}

impl Sections {
    pub(crate) fn new(
        limits: &wgpu::Limits,
        model: &RigModel,
        instances: u32,
        dispatches: usize,
    ) -> Self {
        let layout = model.layout();
        let storage = u64::from(limits.min_storage_buffer_offset_alignment.max(16));
        let uniform = limits.min_uniform_buffer_offset_alignment.max(16);
        let mut end = 0_u64;
        let mut section = |count: u32, size: usize| {
            let begin = end.next_multiple_of(storage);
            let size = (u64::from(instances) * u64::from(count)).max(1) * size as u64;
            end = begin + size;
            [begin, size]
        };
        let placements = layout.part_count() + 1;
        let viewpoints = section(placements, size_of::<Vec4>());
        let transforms = section(placements, size_of::<Transform>());
        let carriers = section(layout.counts.carrier_count, size_of::<CarrierTransform>());
        let weights = section(layout.counts.morph_count, size_of::<f32>());
        let work = end.next_multiple_of(u64::from(uniform));
        let stride = size_of::<Work>().next_multiple_of(uniform as usize);
        let size = work + (stride * dispatches.max(1)) as u64;
        Self { viewpoints, transforms, carriers, weights, work, stride, size }
    }
}

/// What shaders read and write of a frame.
#[derive(Debug)]
pub(crate) struct FrameBindings {
    /// Of posing vertices, of finding sides, of testing loose edges.
    pub(crate) loose: [wgpu::BindGroup; 3],
    /// Of what finds contours of rigid parts.
    pub(crate) parts: wgpu::BindGroup,
    pub(crate) tally: wgpu::BindGroup,
}

impl FrameBindings {
    /// Of the input, the vertices, the sides of faces and the output.
    pub(crate) fn new(
        extractor: &Extractor,
        model: &RigModel,
        sections: &Sections,
        (input, positions, sides, output): (&wgpu::Buffer, &wgpu::Buffer, &wgpu::Buffer, &Output),
    ) -> Result<Self, Error> {
        let device = extractor.device();
        let part = |[offset, size]: [u64; 2]| {
            let (buffer, size) = (input, wgpu::BufferSize::new(size));
            wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset, size })
        };
        let work = || part([sections.work, size_of::<Work>() as u64]);
        let [viewpoints, carriers, weights] =
            [sections.viewpoints, sections.carriers, sections.weights].map(part);
        let [counted, added, arguing, found, positioned, sided] = [
            &output.counters,
            &output.totals,
            &output.arguments,
            &output.segments,
            positions,
            sides,
        ]
        .map(wgpu::Buffer::as_entire_binding);
        let bind = |layout, resources| bind(device, "the bindings of a frame", layout, resources);
        let pipelines = &model.uploaded.pipelines;
        let vertices = vec![work(), carriers.clone(), weights, positioned.clone()];
        let faces = vec![work(), carriers, viewpoints.clone(), positioned, sided.clone()];
        let edges = vec![work(), counted.clone(), sided, found.clone()];
        let extraction = vec![work(), counted.clone(), viewpoints, found];
        Ok(Self {
            loose: [
                bind(&pipelines.vertices.frame_layout, vertices)?,
                bind(&pipelines.faces.frame_layout, faces)?,
                bind(&pipelines.edges.frame_layout, edges)?,
            ],
            parts: bind(extractor.work_layout(), extraction)?,
            tally: bind(extractor.tally_layout(), vec![work(), counted, added, arguing])?,
        })
    }
}
