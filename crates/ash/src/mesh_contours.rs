//! What task and mesh shaders find of one model while they draw it.

use ash::vk::BufferUsageFlags as Usage;
use drypoint_shaders::{
    Culling, Draw, DrawCounters, DrawPlan, Method, Placement, Segment, Statistics, Work,
};

use crate::Error;
use crate::barrier::Use;
use crate::binding::{Resource, Set};
use crate::commands::Commands;
use crate::contours::{Capacity, segments};
use crate::execution::{Download, Executed};
use crate::input::Input;
use crate::layouts;
use crate::memory::Buffer;
use crate::mesh_pass::{MeshLimits, MeshPass};
use crate::model::Model;

/// Instances of one model to be drawn by a [`MeshPass`], and what is counted meanwhile. No list of contour edges
/// takes memory, unless the pass records them.
#[derive(Debug)]
pub struct MeshContours {
    model: Model,
    capacity: Capacity,
    pub(crate) input: Input,
    counters: Buffer,
    /// From the counters of one draw to those of the next.
    stride: u32,
    segments: Buffer,
    segment_count: Buffer,
    pub(crate) work_set: Set,
    pub(crate) vertex_set: Set,
    pub(crate) draws: Vec<Draw>,
    /// What draws are cut for.
    pub(crate) limits: MeshLimits,
}

impl MeshContours {
    /// Room for instances of `model`; and for that many segments, if `pass` records them: otherwise that part of
    /// `capacity` does not count, and no segments are there to be read.
    ///
    /// # Errors
    /// If there is not enough memory, or `capacity` is beyond what the device allows in one buffer; if the model is of
    /// another device, or was made in commands that were never executed.
    pub fn new(pass: &MeshPass, model: &Model, capacity: Capacity) -> Result<Self, Error> {
        let device = pass.device();
        model.check(device)?;
        let make = |what, size: u64| {
            let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_DST | Usage::TRANSFER_SRC;
            Buffer::new(device, what, size, usage)
        };
        let limits = pass.limits();
        let segment_capacity = if pass.records() { capacity.segments } else { 0 };
        let capacity = Capacity { segments: segment_capacity, ..capacity };
        let instances = capacity.placements / model.part_count().max(1);
        let count = |method| plan(limits, model, method, (instances, capacity)).count();
        let draws = count(Method::BruteForce).max(count(Method::Patches)).max(1);
        let input = Input::new(device, capacity.placements, draws)?;
        let size = size_of::<DrawCounters>() as u64;
        let stride =
            size.next_multiple_of(device.limits().min_storage_buffer_offset_alignment.max(4));
        let counters = make("counters", stride * draws as u64)?;
        let segments = u64::from(capacity.segments) * size_of::<Segment>() as u64;
        let segments = make("segments", segments)?;
        let segment_count = make("the number of segments", 4)?;
        let work = Resource::Piece(&input.work, size_of::<Work>() as u64);
        let counted = Resource::Piece(&counters, size);
        let [seen, found, number, positions, transforms] =
            [&input.viewpoints, &segments, &segment_count, model.positions(), &input.transforms]
                .map(Resource::Buffer);
        let work_set = Set::new(
            &layouts::mesh_draws(device)?,
            "the bindings of draws",
            &[work, counted, seen, found, number],
        )?;
        let vertex_set = Set::new(
            &layouts::mesh_vertices(device)?,
            "the bindings of vertices",
            &[positions, transforms],
        )?;
        Ok(Self {
            model: model.clone(),
            capacity,
            input,
            counters,
            stride: u32::try_from(stride).unwrap_or(u32::MAX),
            segments,
            segment_count,
            work_set,
            vertex_set,
            draws: Vec::new(),
            limits,
        })
    }

    /// Records what the next [`MeshPass::record`] is to draw: part p of instance i is at
    /// `i * part_count + p` of `placements`. In the same commands, and outside of rendering.
    ///
    /// # Errors
    /// If there are more placements than there is room for or not one for each part, if one has no inverse, or
    /// if patches are asked for where there are none. Nothing is recorded then, and there is nothing to draw until
    /// it succeeds again.
    pub fn prepare(
        &mut self,
        commands: &mut Commands,
        placements: &[Placement],
        method: Method,
    ) -> Result<(), Error> {
        self.model.check(commands.device())?;
        self.draws.clear();
        self.input.place(&self.model, placements, method)?;
        let instances = self.input.count() / self.model.part_count();
        plan(self.limits, &self.model, method, (instances, self.capacity))
            .draws(&mut |draw| self.draws.push(draw));
        self.input.record(commands, self.draws.iter().map(|draw| &draw.work));
        commands.clear(&self.counters);
        commands.clear(&self.segment_count);
        commands.barrier(Use::COPIED_TO, Use::USED_BY_SHADERS);
        Ok(())
    }

    /// The model that is looked at.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Records a copy of what was counted, and of the segments if they are recorded. After the rendering in which
    /// it was drawn.
    ///
    /// # Errors
    /// If there is not enough memory, or nothing was prepared, or not on this device.
    pub fn download(&self, commands: &mut Commands) -> Result<FoundByMesh, Error> {
        self.model.check(commands.device())?;
        self.input.check_once()?;
        commands.barrier(Use::WRITTEN_BY_DRAWING.and(Use::COPIED_TO), Use::COPIED_FROM);
        Ok(FoundByMesh {
            counters: commands.download("counters", &self.counters)?,
            stride: self.stride as usize,
            draws: self.draws.clone(),
            segments: self
                .limits
                .shape
                .records
                .then(|| commands.download("segments", &self.segments))
                .transpose()?,
            capacity: if self.limits.shape.records { self.capacity.segments } else { u32::MAX },
        })
    }

    pub(crate) fn counters_offset(&self, draw: usize) -> u32 {
        u32::try_from(draw).unwrap_or(u32::MAX) * self.stride
    }
}

fn plan<'a>(
    limits: MeshLimits,
    model: &'a Model,
    method: Method,
    (instances, capacity): (u32, Capacity),
) -> DrawPlan<'a> {
    DrawPlan {
        chunks: model.chunks(),
        block_counts: model.block_counts(),
        part_count: model.part_count(),
        method,
        instances,
        segment_capacity: capacity.segments,
        limits: limits.of(method),
    }
}

/// What [`MeshContours`] held when the commands executed.
#[derive(Debug)]
pub struct FoundByMesh {
    counters: Download,
    stride: usize,
    draws: Vec<Draw>,
    /// None if they are not recorded.
    segments: Option<Download>,
    capacity: u32,
}

/// What one frame of mesh shaders found, tested and launched, all instances together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshStatistics {
    /// Contour edges and tests. Where segments are not recorded, the capacity is `u32::MAX`.
    pub found: Statistics,
    /// Patches that were not culled, counted piece by piece (those of more than
    /// [`MAX_PIECE`](drypoint_shaders::MAX_PIECE) edges), and such pieces of edges that no patch holds.
    pub survivors: u64,
    /// Mesh workgroups that task shaders launched, or that were drawn without them.
    pub mesh_workgroups: u64,
    /// Mesh workgroups with edges to test, of which none was a contour edge.
    pub idle_mesh_workgroups: u64,
}

impl FoundByMesh {
    /// What was found, tested and launched.
    ///
    /// # Errors
    /// If it was asked for in other commands than those that have executed.
    pub fn statistics(&self, executed: &Executed) -> Result<MeshStatistics, Error> {
        let bytes = self.counters.read(executed)?;
        let found = Statistics { capacity: self.capacity, ..Statistics::default() };
        let mut all = MeshStatistics { found, ..MeshStatistics::default() };
        for (bytes, Draw { culling, work, grid, .. }) in bytes.chunks(self.stride).zip(&self.draws)
        {
            let draw: DrawCounters =
                bytemuck::pod_read_unaligned(&bytes[..size_of::<DrawCounters>()]);
            let found = &mut all.found;
            found.segments += u64::from(draw.segments);
            found.edges_tested += u64::from(draw.edges_tested);
            found.patches_tested += u64::from(draw.patches_tested);
            found.patches_accepted += u64::from(draw.patches_accepted);
            found.super_patches_tested += u64::from(draw.super_patches_tested);
            found.super_patches_accepted += u64::from(draw.super_patches_accepted);
            all.survivors += u64::from(draw.groups_accepted);
            all.mesh_workgroups += u64::from(draw.mesh_workgroups);
            if *culling == Culling::Nothing {
                found.edges_tested += u64::from(work.item_count) * u64::from(work.instance_count);
                all.mesh_workgroups += grid.iter().copied().map(u64::from).product::<u64>();
            }
            all.idle_mesh_workgroups += u64::from(draw.idle_mesh_workgroups);
        }
        Ok(all)
    }

    /// All segments, in any order; none if the pass records none.
    ///
    /// # Errors
    /// [`Error::Overflow`] if not all fit, or if it was asked for in other commands.
    pub fn segments(&self, executed: &Executed) -> Result<Vec<Segment>, Error> {
        let found = self.statistics(executed)?.found;
        let all = self.segments.as_ref().map(|download| segments(download, executed, &found));
        all.unwrap_or(Ok(Vec::new()))
    }
}
