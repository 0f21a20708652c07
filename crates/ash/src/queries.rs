//! What the device itself counts, and how long it took.

use std::sync::Arc;

use ash::vk;

use crate::commands::Commands;
use crate::execution::Executed;
use crate::{Device, Error};

/// What [`Queries`] count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Counting {
    /// Invocations of task and mesh shaders, and primitives that mesh shaders emit. Draws of vertex shaders are
    /// refused meanwhile.
    MeshShaders,
    /// Invocations of compute and vertex shaders, and primitives that are assembled from vertices. Draws of mesh
    /// shaders are refused meanwhile.
    Compute,
}

/// Counts, by the device, between a beginning and an end in one command buffer; and the time that passes.
#[derive(Debug)]
pub struct Queries {
    device: Device,
    counting: Counting,
    invocations: Arc<Pool>,
    /// None where invocations have it all.
    primitives: Option<Arc<Pool>>,
    /// None where the queue has no clock.
    timer: Option<Timer>,
    /// Of the commands that they are in.
    id: Option<u64>,
    /// Begun, and not ended yet.
    is_running: bool,
}

/// How long the device takes from a beginning to an end in one command buffer, whatever is drawn in between.
#[derive(Debug)]
pub struct Timer {
    device: Device,
    pool: Arc<Pool>,
    /// Of the commands that it is in.
    id: Option<u64>,
    /// Begun, and not ended yet.
    is_running: bool,
}

/// What the device has counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// Of task shaders: lanes, as are all invocations.
    pub task_invocations: u64,
    /// Of mesh shaders.
    pub mesh_invocations: u64,
    /// Of compute shaders.
    pub compute_invocations: u64,
    /// Of vertex shaders.
    pub vertex_invocations: u64,
    /// Lines or triangles that mesh shaders emit, or that are assembled from vertices. Where a pass draws nothing, a
    /// driver may count none (NVIDIA's 580).
    pub primitives: u64,
    /// From the beginning to the end, if the device has a clock.
    pub seconds: Option<f64>,
}

/// Queries of one kind.
#[derive(Debug)]
pub(crate) struct Pool {
    device: Device,
    raw: vk::QueryPool,
}

const OF_MESH_SHADERS: vk::QueryPipelineStatisticFlags = vk::QueryPipelineStatisticFlags::from_raw(
    vk::QueryPipelineStatisticFlags::TASK_SHADER_INVOCATIONS_EXT.as_raw()
        | vk::QueryPipelineStatisticFlags::MESH_SHADER_INVOCATIONS_EXT.as_raw(),
);
const OF_COMPUTE: vk::QueryPipelineStatisticFlags = vk::QueryPipelineStatisticFlags::from_raw(
    vk::QueryPipelineStatisticFlags::INPUT_ASSEMBLY_PRIMITIVES.as_raw()
        | vk::QueryPipelineStatisticFlags::VERTEX_SHADER_INVOCATIONS.as_raw()
        | vk::QueryPipelineStatisticFlags::COMPUTE_SHADER_INVOCATIONS.as_raw(),
);

impl Queries {
    /// To be used any number of times.
    ///
    /// # Errors
    /// [`Error::MissingFeature`] if the device was made without
    /// [`OptionalFeatures`](crate::OptionalFeatures) that this takes.
    pub fn new(device: &Device, counting: Counting) -> Result<Self, Error> {
        let features = device.features();
        let lacks = |feature| Err(Error::MissingFeature { feature, what: "counting" });
        if !features.pipeline_statistics_query {
            return lacks("pipelineStatisticsQuery");
        }
        let statistics = match counting {
            Counting::MeshShaders => OF_MESH_SHADERS,
            Counting::Compute => OF_COMPUTE,
        };
        let invocations = Pool::new(device, (vk::QueryType::PIPELINE_STATISTICS, 1), statistics)?;
        let none = vk::QueryPipelineStatisticFlags::empty();
        let primitives = match counting {
            Counting::Compute => None,
            Counting::MeshShaders if !features.mesh_shader_queries => {
                return lacks("meshShaderQueries");
            }
            Counting::MeshShaders => {
                Some(Pool::new(device, (vk::QueryType::MESH_PRIMITIVES_GENERATED_EXT, 1), none)?)
            }
        };
        let timer = match Timer::new(device) {
            Err(Error::MissingFeature { .. }) => None,
            timer => Some(timer?),
        };
        let device = device.clone();
        Ok(Self { device, counting, invocations, primitives, timer, id: None, is_running: false })
    }

    /// Begins to count. Outside of rendering. New queries are made where earlier ones are still under way.
    ///
    /// # Errors
    /// If the commands are of another device, or something is counted in them already, or there is not enough memory.
    pub fn begin(&mut self, commands: &mut Commands) -> Result<(), Error> {
        commands.check(&self.device, "queries")?;
        if commands.counting().is_some() {
            return Err(Error::Counting { what: "more queries" });
        }
        // What was counted before is not asked for any more.
        self.id = None;
        if Arc::strong_count(&self.invocations) > 1 {
            let fresh = Self::new(&self.device, self.counting)?;
            (self.invocations, self.primitives) = (fresh.invocations, fresh.primitives);
        }
        let pools = [Some(&self.invocations), self.primitives.as_ref()];
        commands.count(self.counting, pools.into_iter().flatten());
        (self.id, self.is_running) = (Some(commands.id()), true);
        self.timer.as_mut().map_or(Ok(()), |timer| timer.begin(commands))
    }

    /// Ends, in the same commands. Outside of rendering.
    ///
    /// # Errors
    /// [`Error::OtherCommands`] if it was not begun in them.
    pub fn end(&mut self, commands: &mut Commands) -> Result<(), Error> {
        if self.id != Some(commands.id()) || !self.is_running {
            return Err(Error::OtherCommands { what: "queries" });
        }
        self.is_running = false;
        if let Some(timer) = &mut self.timer {
            timer.end(commands)?;
        }
        commands.end_counting();
        Ok(())
    }

    /// What was counted.
    ///
    /// # Errors
    /// [`Error::OtherCommands`] if it was recorded into other commands than those that have executed, or if the
    /// device is lost.
    pub fn read(&self, executed: &Executed) -> Result<Counts, Error> {
        if !executed.is_of(self.id) || self.is_running {
            return Err(Error::OtherCommands { what: "queries" });
        }
        let mut counts = Counts::default();
        match self.counting {
            Counting::MeshShaders => {
                let [task, mesh] = self.invocations.read()?;
                (counts.task_invocations, counts.mesh_invocations) = (task, mesh);
            }
            Counting::Compute => {
                let [primitives, vertex, compute] = self.invocations.read()?;
                counts.primitives = primitives;
                (counts.vertex_invocations, counts.compute_invocations) = (vertex, compute);
            }
        }
        if let Some(pool) = &self.primitives {
            [counts.primitives] = pool.read()?;
        }
        counts.seconds = self.timer.as_ref().map(|timer| timer.seconds(executed)).transpose()?;
        Ok(counts)
    }
}

impl Timer {
    /// To be used any number of times.
    ///
    /// # Errors
    /// [`Error::MissingFeature`] if the device has no clock.
    pub fn new(device: &Device) -> Result<Self, Error> {
        if device.limits().timestamp_compute_and_graphics == vk::FALSE {
            let feature = "timestampComputeAndGraphics";
            return Err(Error::MissingFeature { feature, what: "a timer" });
        }
        let none = vk::QueryPipelineStatisticFlags::empty();
        let pool = Pool::new(device, (vk::QueryType::TIMESTAMP, 2), none)?;
        Ok(Self { device: device.clone(), pool, id: None, is_running: false })
    }

    /// Begins, when all that was recorded before is done. Outside of rendering. New queries are made where earlier
    /// ones are still under way.
    ///
    /// # Errors
    /// If the commands are of another device.
    pub fn begin(&mut self, commands: &mut Commands) -> Result<(), Error> {
        commands.check(&self.device, "a timer")?;
        self.id = None;
        if Arc::strong_count(&self.pool) > 1 {
            self.pool = Self::new(&self.device)?.pool;
        }
        (self.id, self.is_running) = (Some(commands.id()), true);
        commands.keep(self.pool.clone());
        let raw = commands.raw();
        // SAFETY: no rendering is open, and the pool is kept; no commands used its two queries before, but such as
        // have executed.
        unsafe { self.device.raw().cmd_reset_query_pool(raw, self.pool.raw, 0, 2) };
        self.write(raw, 0);
        Ok(())
    }

    /// Ends, in the same commands, when all that was recorded before is done.
    ///
    /// # Errors
    /// [`Error::OtherCommands`] if it was not begun in them.
    pub fn end(&mut self, commands: &mut Commands) -> Result<(), Error> {
        if self.id != Some(commands.id()) || !self.is_running {
            return Err(Error::OtherCommands { what: "a timer" });
        }
        self.is_running = false;
        self.write(commands.raw(), 1);
        Ok(())
    }

    fn write(&self, commands: vk::CommandBuffer, index: u32) {
        let stage = vk::PipelineStageFlags::BOTTOM_OF_PIPE;
        // SAFETY: the pool is kept, and the query was reset in these commands.
        unsafe { self.device.raw().cmd_write_timestamp(commands, stage, self.pool.raw, index) };
    }

    /// How long it took.
    ///
    /// # Errors
    /// [`Error::OtherCommands`] if it was not begun and ended in the commands that have executed, or if the device
    /// is lost.
    pub fn seconds(&self, executed: &Executed) -> Result<f64, Error> {
        if !executed.is_of(self.id) || self.is_running {
            return Err(Error::OtherCommands { what: "a timer" });
        }
        let [[begin], [end]] = [self.pool.read_from(0)?, self.pool.read_from(1)?];
        let period = f64::from(self.device.limits().timestamp_period);
        Ok(1e-9 * period * end.saturating_sub(begin) as f64)
    }
}

impl Pool {
    fn new(
        device: &Device,
        (ty, count): (vk::QueryType, u32),
        statistics: vk::QueryPipelineStatisticFlags,
    ) -> Result<Arc<Self>, Error> {
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(ty)
            .query_count(count)
            .pipeline_statistics(statistics);
        // SAFETY: the features that the type takes are enabled, which the caller has asked.
        let raw = unsafe { device.raw().create_query_pool(&info, None) };
        let raw = raw.map_err(|error| Error::of("queries", error))?;
        Ok(Arc::new(Self { device: device.clone(), raw }))
    }

    pub(crate) fn raw(&self) -> vk::QueryPool {
        self.raw
    }

    fn read<const N: usize>(&self) -> Result<[u64; N], Error> {
        self.read_from(0)
    }

    /// The numbers of one query.
    fn read_from<const N: usize>(&self, query: u32) -> Result<[u64; N], Error> {
        let mut numbers = [[0; N]];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: the query was used in commands that have executed, and has so many numbers.
        let read = unsafe {
            self.device.raw().get_query_pool_results(self.raw, query, &mut numbers, flags)
        };
        read.map_err(|error| Error::of("queries", error))?;
        Ok(numbers[0])
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        // SAFETY: commands that use it keep it until they have executed.
        unsafe { self.device.raw().destroy_query_pool(self.raw, None) };
    }
}
