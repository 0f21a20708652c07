//! What is found of one rig, and the memory that it takes.

use drypoint_mesh::EdgeId;
use drypoint_mesh::rig::Skin;
use drypoint_shaders::{
    Method, PlanLimits, RigDispatch, RigInput, RigInstance, RigPlan, RigStep, Segment, Statistics,
    Transform,
};
use glam::{Vec3, Vec4};
use wgpu::BufferUsages;

use crate::Error;
use crate::device::{allow, beginning_with, buffer};
use crate::extractor::Extractor;
use crate::output::Output;
use crate::rig_frame::{FrameBindings, Sections};
use crate::rig_model::{RigModel, UploadedRig};
use crate::staging::Staging;

/// What there is room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RigCapacity {
    /// Instances in a frame, each with a pose of its own. 64 bytes for each rigid part and one more, 64 for each
    /// carrier, 4 for each morph target, 12 for each vertex and 4 for each face beside a loose edge.
    pub instances: u32,
    /// Segments in a frame, all instances together. 16 bytes each.
    pub segments: u32,
}

/// A contour edge of an instance of a rig.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RigEdge {
    /// The instance.
    pub instance: u32,
    /// Its id in [`Skin::adjacency`].
    pub edge: EdgeId,
}

/// The contour edges of instances of one rig, each in a pose of its own, on the GPU, and all that finding them
/// needs.
///
/// Every [`Segment`] is of a placement ([`RigLayout`](drypoint_shaders::RigLayout)): one of a rigid part names the
/// edge as the part's shape does, one of what is loose as the rig does; [`RigContours::edge`] tells which edge of
/// the rig it is. Vertices are those of [`RigContours::positions`].
///
/// To be prepared and recorded once for each submission: a second time overwrites the first.
#[derive(Debug)]
pub struct RigContours {
    model: RigModel,
    capacity: RigCapacity,
    sections: Sections,
    limits: PlanLimits,
    device: wgpu::Device,
    input_buffer: wgpu::Buffer,
    positions: wgpu::Buffer,
    output: Output,
    bindings: FrameBindings,
    dispatches: Vec<RigDispatch>,
    input: RigInput,
    work: Vec<u8>,
    staging: Staging,
}

impl RigContours {
    /// Room for the contours of instances of `model`.
    ///
    /// # Errors
    /// If the GPU has not enough memory, or `capacity` is beyond what the device allows in one buffer.
    pub fn new(
        extractor: &Extractor,
        model: &RigModel,
        capacity: RigCapacity,
    ) -> Result<Self, Error> {
        let device = extractor.device();
        let limits = extractor.plan_limits();
        // First, since dispatches count placements in 32 bits.
        let least = Sections::new(&device.limits(), model, capacity.instances, 1).size;
        allow(device, "the input of a frame", least, BufferUsages::STORAGE)?;
        let most_dispatches = most_dispatches(model, capacity, limits);
        let sections = Sections::new(&device.limits(), model, capacity.instances, most_dispatches);
        let counts = model.layout().counts;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let what = "the input of a frame";
        let input_buffer = buffer(device, what, sections.size, usage | BufferUsages::UNIFORM)?;
        let posed = u64::from(capacity.instances) * u64::from(counts.vertex_count);
        let vertices = u64::from(counts.first_vertex) + posed;
        let usage = usage | BufferUsages::VERTEX | BufferUsages::COPY_SRC;
        let size = vertices * size_of::<Vec3>() as u64;
        let what = "the vertices of a rig";
        let positions = beginning_with(device, what, &model.uploaded.positions, (size, usage))?;
        let sides = u64::from(capacity.instances) * u64::from(counts.face_count) * 4;
        let sides = buffer(device, "the sides of faces", sides, BufferUsages::STORAGE)?;
        let output = Output::new(device, capacity.segments)?;
        let buffers = (&input_buffer, &positions, &sides, &output);
        let bindings = FrameBindings::new(extractor, model, &sections, buffers)?;
        Ok(Self {
            bindings,
            model: model.clone(),
            capacity,
            sections,
            limits,
            positions,
            output,
            dispatches: Vec::with_capacity(most_dispatches),
            input: RigInput::default(),
            work: Vec::with_capacity(sections.stride * most_dispatches),
            staging: Staging::new(device, sections.size)?,
            device: device.clone(),
            input_buffer,
        })
    }

    /// Takes what the next [`Extractor::record_rig`] is to find: `method` is how contour edges of rigid parts are
    /// found. Records copies of it into `encoder`, which must be submitted before or together with the pass that
    /// it is for.
    ///
    /// Some 50 ns for each rigid part and each carrier of each instance; allocates nothing once as many frames
    /// are under way as there ever are. A part that its carrier flattens is seen as what it is flattened to.
    ///
    /// # Errors
    /// If there are more instances than there is room for, if a placement has no inverse, if a pose is of another
    /// rig or not finite, or if the device is lost. Nothing is recorded then, and there is nothing to record or to
    /// draw until it succeeds again.
    pub fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        instances: &[RigInstance<'_>],
        method: Method,
    ) -> Result<(), Error> {
        self.dispatches.clear();
        self.input.clear();
        let room = self.capacity.instances;
        if instances.len() > room as usize {
            return Err(Error::TooManyInstances { given: instances.len(), capacity: room });
        }
        let UploadedRig { layout, .. } = &*self.model.uploaded;
        layout.place(instances, room, &mut self.input)?;
        #[expect(clippy::cast_possible_truncation, reason = "no more than the capacity, a u32")]
        let count = instances.len() as u32;
        plan(&self.model, method, count, self.capacity, self.limits)
            .dispatches(&mut |dispatch| self.dispatches.push(dispatch));
        self.work.clear();
        for dispatch in &self.dispatches {
            self.work.extend_from_slice(bytemuck::bytes_of(&dispatch.work));
            self.work.resize(self.work.len().next_multiple_of(self.sections.stride), 0);
        }
        let input = &self.input;
        let Sections { viewpoints, transforms, carriers, weights, work, .. } = self.sections;
        let of_frame: [(u64, &[u8]); 3] = [
            (carriers[0], bytemuck::cast_slice(&input.carriers)),
            (weights[0], bytemuck::cast_slice(&input.weights)),
            (work, &self.work),
        ];
        // Of each class and of what is loose, no more than there are instances.
        let classes = layout.classes.iter().map(|c| (c.placements_before, c.parts.len()));
        let placed = classes.chain([(layout.part_count(), 1)]).flat_map(|(before, each)| {
            let first = before as usize * room as usize;
            let placed = first..first + each * instances.len();
            let at = |[begin, _]: [u64; 2], size: usize| begin + (first * size) as u64;
            let seen: &[u8] = bytemuck::cast_slice(&input.viewpoints[placed.clone()]);
            let moved: &[u8] = bytemuck::cast_slice(&input.transforms[placed]);
            [
                (at(viewpoints, size_of::<Vec4>()), seen),
                (at(transforms, size_of::<Transform>()), moved),
            ]
        });
        let pieces = of_frame.into_iter().chain(placed);
        let written = self.staging.write(&self.device, encoder, &self.input_buffer, pieces);
        if written.is_err() {
            self.input.clear();
            self.dispatches.clear();
            return written;
        }
        self.output.clear(encoder);
        Ok(())
    }

    /// The rig that is looked at.
    pub fn model(&self) -> &RigModel {
        &self.model
    }

    /// What there is room for.
    pub fn capacity(&self) -> RigCapacity {
        self.capacity
    }

    /// Number of instances that it was prepared for last.
    pub fn instance_count(&self) -> u32 {
        u32::try_from(self.input.frames.len()).unwrap_or(u32::MAX)
    }

    /// [`Segment`]s of all instances, in any order; as many as the arguments say. Storage and vertex buffer.
    pub fn segments(&self) -> &wgpu::Buffer {
        &self.output.segments
    }

    /// [`Arguments`](drypoint_shaders::Arguments), to draw or to dispatch with. Indirect and storage buffer.
    pub fn arguments(&self) -> &wgpu::Buffer {
        &self.output.arguments
    }

    /// Vertices that segments count in, three f32 each, to be moved by the transform of the segment's placement:
    /// those of all shapes, then for each instance those that were posed. Storage and vertex buffer.
    pub fn positions(&self) -> &wgpu::Buffer {
        &self.positions
    }

    /// A [`Transform`] from the space of each placement to that of the scene, to bind as storage.
    pub fn transforms(&self) -> wgpu::BufferBinding<'_> {
        let [offset, size] = self.sections.transforms;
        let size = wgpu::BufferSize::new(size);
        wgpu::BufferBinding { buffer: &self.input_buffer, offset, size }
    }

    /// Asks for the statistics of what `encoder` holds by now: to be called after the pass has ended.
    pub fn request_statistics(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.output.request_statistics(encoder);
    }

    /// The newest statistics that have come since the last call, as
    /// [`Contours::newest_statistics`](crate::Contours::newest_statistics).
    pub fn newest_statistics(&mut self) -> Option<Statistics> {
        self.output.newest_statistics()
    }

    /// Waits for the GPU and reads the statistics of what was submitted last, of rigid parts and loose edges
    /// together.
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

    /// Which edge of the rig a segment is. `skin` is what the model was made of.
    ///
    /// # Panics
    /// If it is of another rig, or the segment of other contours.
    pub fn edge(&self, skin: &Skin, segment: &Segment) -> RigEdge {
        let (instance, part) =
            self.model.layout().placed(segment.placement, self.capacity.instances);
        let edge = match part {
            Some(part) => skin.parts()[part as usize].edge_in_rig(segment.edge),
            None => segment.edge,
        };
        RigEdge { instance, edge }
    }

    /// Records what it was prepared for.
    pub(crate) fn record(&self, extractor: &Extractor, pass: &mut wgpu::ComputePass<'_>) {
        let uploaded = &*self.model.uploaded;
        for (index, dispatch) in self.dispatches.iter().enumerate() {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "offsets in a binding are below 2^32"
            )]
            let offset = (index * self.sections.stride) as u32;
            let loose = match dispatch.step {
                RigStep::Vertices => Some((0, &uploaded.pipelines.vertices)),
                RigStep::Faces => Some((1, &uploaded.pipelines.faces)),
                RigStep::LooseEdges => Some((2, &uploaded.pipelines.edges)),
                RigStep::Parts { class, stage, chunk } => {
                    pass.set_pipeline(extractor.of_stage(stage));
                    pass.set_bind_group(0, &uploaded.chunk_bindings[class][chunk], &[]);
                    pass.set_bind_group(1, &self.bindings.parts, &[offset]);
                    None
                }
            };
            if let Some((number, pipeline)) = loose {
                pass.set_pipeline(&pipeline.pipeline);
                pass.set_bind_group(0, &uploaded.loose_bindings[number], &[]);
                pass.set_bind_group(1, &self.bindings.loose[number], &[offset]);
            }
            pass.dispatch_workgroups(dispatch.grid[0], dispatch.grid[1], 1);
            if !matches!(dispatch.step, RigStep::Vertices | RigStep::Faces) {
                extractor.tally(pass, &self.bindings.tally, offset);
            }
        }
    }

    pub(crate) fn output(&self) -> &Output {
        &self.output
    }
}

fn plan(
    model: &RigModel,
    method: Method,
    instances: u32,
    capacity: RigCapacity,
    limits: PlanLimits,
) -> RigPlan<'_> {
    let UploadedRig { layout, chunks, loose_edges, .. } = &*model.uploaded;
    RigPlan {
        layout,
        classes: chunks,
        loose_edges: *loose_edges,
        method,
        instances,
        most_instances: capacity.instances,
        segment_capacity: capacity.segments,
        limits,
    }
}

fn most_dispatches(model: &RigModel, capacity: RigCapacity, limits: PlanLimits) -> usize {
    let methods = [Method::BruteForce, Method::Patches].into_iter();
    let count =
        |method| plan(model, method, capacity.instances, capacity, limits).most_dispatches();
    methods.map(count).max().unwrap_or(0)
}
