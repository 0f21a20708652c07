//! What is found of one model, and the memory that it takes.

use drypoint_shaders::{
    Dispatch, Method, Placement, Plan, PlanLimits, Segment, Statistics, Transform, Work, place,
};
use glam::Vec4;
use wgpu::BufferUsages;

use crate::Error;
use crate::bindings::bind;
use crate::device::{allow, buffer};
use crate::extractor::Extractor;
use crate::model::Model;
use crate::output::Output;
use crate::staging::Staging;

/// What there is room for. One buffer holds the segments, which on devices with common limits of 128 MiB are
/// 8.4 million: where more are to be expected, share instances out to several [`Contours`] of one model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capacity {
    /// Placements in a frame: instances times parts of the model. 64 bytes each.
    pub placements: u32,
    /// Segments in a frame, all instances together. 16 bytes each.
    pub segments: u32,
}

/// The contour edges of instances of one model, on the GPU, and all that finding them needs.
///
/// To be prepared and recorded once for each submission: a second time overwrites the first.
#[derive(Debug)]
pub struct Contours {
    model: Model,
    capacity: Capacity,
    limits: PlanLimits,
    device: wgpu::Device,
    input: wgpu::Buffer,
    layout: InputLayout,
    output: Output,
    pub(crate) work_bindings: wgpu::BindGroup,
    pub(crate) tally_bindings: wgpu::BindGroup,
    pub(crate) dispatches: Vec<Dispatch>,
    /// The input of a frame as it is being written.
    viewpoints: Vec<Vec4>,
    transforms: Vec<Transform>,
    work: Vec<u8>,
    staging: Staging,
}

/// Where each kind of input lies in its buffer.
#[derive(Clone, Copy, Debug)]
struct InputLayout {
    transforms: u64,
    work: u64,
    /// From one dispatch's work to the next.
    stride: usize,
    size: u64,
}

impl InputLayout {
    fn new(limits: &wgpu::Limits, placements: u32, dispatches: usize) -> Self {
        let align = |size: u64, to: u32| size.next_multiple_of(u64::from(to.max(16)));
        let storage = limits.min_storage_buffer_offset_alignment;
        let uniform = limits.min_uniform_buffer_offset_alignment;
        let placements = u64::from(placements.max(1));
        let transforms = align(placements * size_of::<Vec4>() as u64, storage);
        let work = transforms + placements * size_of::<Transform>() as u64;
        let work = align(work, uniform);
        let stride = size_of::<Work>().next_multiple_of(uniform.max(16) as usize);
        Self { transforms, work, stride, size: work + (stride * dispatches.max(1)) as u64 }
    }
}

impl Contours {
    /// Room for the contours of `model`.
    ///
    /// # Errors
    /// If the GPU has not enough memory, or `capacity` is beyond what the device allows in one buffer.
    pub fn new(extractor: &Extractor, model: &Model, capacity: Capacity) -> Result<Self, Error> {
        let device = extractor.device();
        let limits = extractor.plan_limits();
        let transforms = u64::from(capacity.placements) * size_of::<Transform>() as u64;
        allow(device, "the placements of a frame", transforms, BufferUsages::STORAGE)?;
        let dispatches = most_dispatches(model, capacity, limits);
        let layout = InputLayout::new(&device.limits(), capacity.placements, dispatches);
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::UNIFORM;
        let input = buffer(device, "the input of a frame", layout.size, usage)?;
        let output = Output::new(device, capacity.segments)?;
        let part = |offset, size| {
            let size = wgpu::BufferSize::new(size);
            wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: &input, offset, size })
        };
        let work = || part(layout.work, size_of::<Work>() as u64);
        let viewpoints = part(0, u64::from(capacity.placements.max(1)) * size_of::<Vec4>() as u64);
        let [counted, added, arguing, found] =
            [&output.counters, &output.totals, &output.arguments, &output.segments]
                .map(wgpu::Buffer::as_entire_binding);
        let extracting = vec![work(), counted.clone(), viewpoints, found];
        let tallying = vec![work(), counted, added, arguing];
        Ok(Self {
            work_bindings: bind(
                device,
                "the bindings of extraction",
                extractor.work_layout(),
                extracting,
            )?,
            tally_bindings: bind(
                device,
                "the bindings of totals",
                extractor.tally_layout(),
                tallying,
            )?,
            model: model.clone(),
            capacity,
            limits,
            device: device.clone(),
            layout,
            output,
            dispatches: Vec::with_capacity(dispatches),
            viewpoints: Vec::with_capacity(capacity.placements as usize),
            transforms: Vec::with_capacity(capacity.placements as usize),
            work: Vec::with_capacity(layout.stride * dispatches),
            staging: Staging::new(device, layout.size)?,
            input,
        })
    }

    /// Takes what the next [`Extractor::record`] is to find: part p of instance i is at
    /// `i * part_count + p` of `placements`. Records copies of it into `encoder`, which must be submitted
    /// before or together with the pass that it is for.
    ///
    /// Linear in placements, some 50 ns each, and allocates nothing once as many frames are under way as
    /// there ever are.
    ///
    /// # Errors
    /// If there are more placements than there is room for or not one for each part, if one has no inverse,
    /// if patches are asked for where there are none, or if the device is lost. Nothing is recorded then, and there is
    /// nothing to record or to draw until it succeeds again.
    pub fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        placements: &[Placement],
        method: Method,
    ) -> Result<(), Error> {
        self.dispatches.clear();
        self.transforms.clear();
        self.check(placements, method)?;
        let frames = &self.model.content.frames;
        place(frames, placements, &mut self.viewpoints, &mut self.transforms)
            .map_err(|index| Error::SingularPlacement { index })?;
        #[expect(clippy::cast_possible_truncation, reason = "no more than the capacity, a u32")]
        let instances = (placements.len() / self.model.content.frames.len()) as u32;
        plan(&self.model, method, instances, self.capacity, self.limits)
            .dispatches(&mut |dispatch| self.dispatches.push(dispatch));
        self.work.clear();
        for dispatch in &self.dispatches {
            self.work.extend_from_slice(bytemuck::bytes_of(&dispatch.work));
            self.work.resize(self.work.len().next_multiple_of(self.layout.stride), 0);
        }
        let pieces: [(u64, &[u8]); 3] = [
            (0, bytemuck::cast_slice(&self.viewpoints)),
            (self.layout.transforms, bytemuck::cast_slice(&self.transforms)),
            (self.layout.work, &self.work),
        ];
        if let Err(error) = self.staging.write(&self.device, encoder, &self.input, pieces) {
            self.transforms.clear();
            self.dispatches.clear();
            return Err(error);
        }
        self.output.clear(encoder);
        Ok(())
    }

    fn check(&self, placements: &[Placement], method: Method) -> Result<(), Error> {
        let parts = self.model.part_count();
        if method == Method::Patches && !self.model.has_patches() && self.model.edge_count() > 0 {
            return Err(Error::NoPatches);
        }
        if placements.len() > self.capacity.placements as usize {
            let capacity = self.capacity.placements;
            return Err(Error::TooManyPlacements { given: placements.len(), capacity });
        }
        if !placements.len().is_multiple_of(parts as usize) {
            return Err(Error::UnevenPlacements { given: placements.len(), parts });
        }
        Ok(())
    }

    /// The model that is looked at.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// What there is room for.
    pub fn capacity(&self) -> Capacity {
        self.capacity
    }

    /// [`Segment`]s, in any order; as many as the arguments say. Storage and vertex buffer.
    pub fn segments(&self) -> &wgpu::Buffer {
        &self.output.segments
    }

    /// [`Arguments`](drypoint_shaders::Arguments), to draw or to dispatch with. Indirect and storage buffer.
    pub fn arguments(&self) -> &wgpu::Buffer {
        &self.output.arguments
    }

    /// A [`Transform`](drypoint_shaders::Transform) for each placement, to bind as storage.
    pub fn transforms(&self) -> wgpu::BufferBinding<'_> {
        let size = u64::from(self.capacity.placements.max(1)) * size_of::<Transform>() as u64;
        let size = wgpu::BufferSize::new(size);
        wgpu::BufferBinding { buffer: &self.input, offset: self.layout.transforms, size }
    }

    /// Buffers through which the input of frames goes: as many as frames were ever under way at once, and at
    /// least three.
    pub fn staging_buffers(&self) -> usize {
        self.staging.count()
    }

    /// Asks for the statistics of what `encoder` holds by now: to be called after the pass has ended.
    pub fn request_statistics(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.output.request_statistics(encoder);
    }

    /// The newest statistics that have come since the last call, some frames after they were asked for.
    /// They come when the device is polled, which submitting does too.
    pub fn newest_statistics(&mut self) -> Option<Statistics> {
        self.output.newest_statistics()
    }

    /// Waits for the GPU and reads the statistics of what was submitted last.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn read_statistics(&self, queue: &wgpu::Queue) -> Result<Statistics, Error> {
        self.output.read_statistics(queue)
    }

    /// Waits for the GPU and reads all segments of what was submitted last, in any order.
    ///
    /// # Errors
    /// [`Error::Overflow`] if not all fit, or if the device is lost.
    pub fn read_segments(&self, queue: &wgpu::Queue) -> Result<Vec<Segment>, Error> {
        self.output.read_segments(queue)
    }

    pub(crate) fn output(&self) -> &Output {
        &self.output
    }

    /// Number of placements that it was prepared for last.
    pub fn placement_count(&self) -> u32 {
        u32::try_from(self.transforms.len()).unwrap_or(u32::MAX)
    }

    pub(crate) fn work_offset(&self, dispatch: usize) -> u32 {
        #[expect(clippy::cast_possible_truncation, reason = "offsets in a binding are below 2^32")]
        let offset = (dispatch * self.layout.stride) as u32;
        offset
    }
}

fn plan(
    model: &Model,
    method: Method,
    instances: u32,
    capacity: Capacity,
    limits: PlanLimits,
) -> Plan<'_> {
    let (chunks, part_count) = (&model.content.chunks, model.part_count());
    let segment_capacity = capacity.segments;
    Plan { chunks, part_count, method, instances, segment_capacity, limits }
}

fn most_dispatches(model: &Model, capacity: Capacity, limits: PlanLimits) -> usize {
    let instances = capacity.placements / model.part_count().max(1);
    let methods = [Method::BruteForce, Method::Patches].into_iter();
    let count = |method| plan(model, method, instances, capacity, limits).most_dispatches();
    methods.map(count).max().unwrap_or(0)
}
