//! What compute shaders find of one model, and the memory that it takes.

use ash::vk::BufferUsageFlags as Usage;
use drypoint_shaders::{
    Arguments, Counters, Dispatch, Method, Placement, Plan, PlanLimits, Segment, Statistics,
    Totals, Work,
};

use crate::barrier::Use;
use crate::binding::{Resource, Set};
use crate::commands::Commands;
use crate::execution::{Download, Executed};
use crate::extractor::Extractor;
use crate::input::Input;
use crate::memory::Buffer;
use crate::model::Model;
use crate::{Error, layouts};

/// What there is room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capacity {
    /// Placements in a frame: instances times parts of the model. 64 bytes each.
    pub placements: u32,
    /// Segments in a frame, all instances together. 16 bytes each.
    pub segments: u32,
}

/// The contour edges of instances of one model, as compute shaders find them.
#[derive(Debug)]
pub struct Contours {
    model: Model,
    capacity: Capacity,
    limits: PlanLimits,
    pub(crate) input: Input,
    counters: Buffer,
    totals: Buffer,
    arguments: Buffer,
    segments: Buffer,
    pub(crate) work_set: Set,
    pub(crate) tally_set: Set,
    /// For what draws the segments.
    pub(crate) segment_set: Set,
    pub(crate) dispatches: Vec<Dispatch>,
}

impl Contours {
    /// Room for the contours of `model`.
    ///
    /// # Errors
    /// If there is not enough memory, or `capacity` is beyond what the device allows in one buffer; if the model is of
    /// another device, or was made in commands that were never executed.
    pub fn new(extractor: &Extractor, model: &Model, capacity: Capacity) -> Result<Self, Error> {
        let device = extractor.device();
        model.check(device)?;
        let make = |what, size: usize, usage| {
            let usage = usage | Usage::STORAGE_BUFFER | Usage::TRANSFER_DST | Usage::TRANSFER_SRC;
            Buffer::new(device, what, size as u64, usage)
        };
        let limits = extractor.limits();
        let instances = capacity.placements / model.part_count().max(1);
        let plan = |method| plan(limits, model, method, (instances, capacity));
        let methods = [Method::BruteForce, Method::Patches];
        let most = methods.map(|method| plan(method).most_dispatches()).into_iter().max();
        let input = Input::new(device, capacity.placements, most.unwrap_or(0))?;
        let counters = make("counters", size_of::<Counters>(), Usage::empty())?;
        let totals = make("totals", size_of::<Totals>(), Usage::empty())?;
        let arguments = make("arguments", size_of::<Arguments>(), Usage::INDIRECT_BUFFER)?;
        let segments = capacity.segments as usize * size_of::<Segment>();
        let segments = make("segments", segments, Usage::empty())?;
        let work = Resource::Piece(&input.work, size_of::<Work>() as u64);
        let [counted, added, arguing, found, seen] =
            [&counters, &totals, &arguments, &segments, &input.viewpoints].map(Resource::Buffer);
        let extracting = [work, counted, seen, found];
        let tallying = [work, counted, added, arguing];
        let layout = layouts::extraction(device)?;
        let work_set = Set::new(&layout, "the bindings of extraction", &extracting)?;
        let tally_set = Set::new(&layouts::tally(device)?, "the bindings of totals", &tallying)?;
        let drawing = [&segments, model.positions(), &input.transforms].map(Resource::Buffer);
        let segment_set =
            Set::new(&layouts::segments(device)?, "the bindings of segments", &drawing)?;
        Ok(Self {
            model: model.clone(),
            capacity,
            limits,
            input,
            counters,
            totals,
            arguments,
            segments,
            work_set,
            tally_set,
            segment_set,
            dispatches: Vec::new(),
        })
    }

    /// Records what the next [`Extractor::record`] is to find: part p of instance i is at
    /// `i * part_count + p` of `placements`. In the same commands, and outside of rendering.
    ///
    /// # Errors
    /// If there are more placements than there is room for or not one for each part, if one has no inverse, or
    /// if patches are asked for where there are none. Nothing is recorded then, and there is nothing to find until
    /// it succeeds again.
    pub fn prepare(
        &mut self,
        commands: &mut Commands,
        placements: &[Placement],
        method: Method,
    ) -> Result<(), Error> {
        self.model.check(commands.device())?;
        self.dispatches.clear();
        self.input.place(&self.model, placements, method)?;
        let instances = self.input.count() / self.model.part_count();
        plan(self.limits, &self.model, method, (instances, self.capacity))
            .dispatches(&mut |dispatch| self.dispatches.push(dispatch));
        self.input.record(commands, self.dispatches.iter().map(|dispatch| &dispatch.work));
        for counted in [&self.counters, &self.totals, &self.arguments] {
            commands.clear(counted);
        }
        commands.barrier(Use::COPIED_TO, Use::USED_BY_SHADERS);
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

    /// Records a copy of all that was found, after [`Extractor::record`] and outside of rendering. The copy
    /// has room for all that there is room for here.
    ///
    /// # Errors
    /// If there is not enough memory, or nothing was prepared, or not on this device.
    pub fn download(&self, commands: &mut Commands) -> Result<FoundByCompute, Error> {
        Ok(FoundByCompute {
            counted: self.download_statistics(commands)?,
            segments: commands.download("segments", &self.segments)?,
        })
    }

    /// The same of statistics alone: some bytes, for each frame.
    ///
    /// # Errors
    /// If there is not enough memory, or nothing was prepared, or not on this device.
    pub fn download_statistics(&self, commands: &mut Commands) -> Result<CountedByCompute, Error> {
        self.model.check(commands.device())?;
        self.input.check_once()?;
        commands.barrier(Use::WRITTEN_BY_COMPUTE.and(Use::COPIED_TO), Use::COPIED_FROM);
        let totals = commands.download("totals", &self.totals)?;
        Ok(CountedByCompute { totals, capacity: self.capacity.segments })
    }

    pub(crate) fn arguments(&self) -> &Buffer {
        &self.arguments
    }
}

fn plan<'a>(
    limits: PlanLimits,
    model: &'a Model,
    method: Method,
    (instances, capacity): (u32, Capacity),
) -> Plan<'a> {
    Plan {
        chunks: model.chunks(),
        part_count: model.part_count(),
        method,
        instances,
        segment_capacity: capacity.segments,
        limits,
    }
}

/// What [`Contours`] held when the commands executed.
#[derive(Debug)]
pub struct FoundByCompute {
    counted: CountedByCompute,
    segments: Download,
}

/// What [`Contours`] had counted when the commands executed.
#[derive(Debug)]
pub struct CountedByCompute {
    totals: Download,
    capacity: u32,
}

impl CountedByCompute {
    /// What was found and tested.
    ///
    /// # Errors
    /// If it was asked for in other commands than those that have executed.
    pub fn statistics(&self, executed: &Executed) -> Result<Statistics, Error> {
        let bytes = &self.totals.read(executed)?[..size_of::<Totals>()];
        Ok(Statistics::new(&bytemuck::pod_read_unaligned(bytes), self.capacity))
    }
}

impl FoundByCompute {
    /// What was found and tested.
    ///
    /// # Errors
    /// If it was asked for in other commands than those that have executed.
    pub fn statistics(&self, executed: &Executed) -> Result<Statistics, Error> {
        self.counted.statistics(executed)
    }

    /// All segments, in any order.
    ///
    /// # Errors
    /// [`Error::Overflow`] if not all fit, or if it was asked for in other commands.
    pub fn segments(&self, executed: &Executed) -> Result<Vec<Segment>, Error> {
        segments(&self.segments, executed, &self.statistics(executed)?)
    }
}

/// Those that were found.
pub(crate) fn segments(
    download: &Download,
    executed: &Executed,
    statistics: &Statistics,
) -> Result<Vec<Segment>, Error> {
    if let Some(needed) = statistics.overflow() {
        return Err(Error::Overflow { needed, capacity: statistics.capacity });
    }
    let count = usize::try_from(statistics.segments).unwrap_or(usize::MAX);
    let bytes = download.read(executed)?;
    Ok(bytemuck::pod_collect_to_vec(&bytes[..count * size_of::<Segment>()]))
}
