//! Two passes: compute shaders find contour edges, and an indirect draw of them follows.

use drypoint_shaders::{
    BRUTE_FORCE, PATCHES, PlanLimits, SUPER_PATCHES, Stage, TALLY, USUAL_WIDTH, prelude,
};

use crate::barrier::Use;
use crate::commands::Commands;
use crate::contours::Contours;
use crate::device::MOST_TESTS;
use crate::pipeline::Pipeline;
use crate::{Device, Error, layouts};

/// Compute pipelines, one of them for each way to find contour edges; those of `drypoint-wgpu`.
#[derive(Debug)]
pub struct Extractor {
    device: Device,
    limits: PlanLimits,
    brute_force: Pipeline,
    patches: Pipeline,
    super_patches: Pipeline,
    tally: Pipeline,
}

impl Extractor {
    /// Compiles all shaders: some tens of milliseconds.
    ///
    /// # Errors
    /// If the driver refuses a shader.
    pub fn new(device: &Device) -> Result<Self, Error> {
        let limits = device.limits();
        let model = layouts::model(device)?;
        let extraction = layouts::extraction(device)?;
        let found = |source: &str, entry| {
            // Every device of Vulkan has workgroups of 128 lanes.
            let source = prelude(USUAL_WIDTH) + source;
            Pipeline::compute(device, ("extraction", &source, entry), &[&model, &extraction])
        };
        let tally = layouts::tally(device)?;
        Ok(Self {
            limits: PlanLimits {
                width: USUAL_WIDTH,
                row: limits.max_compute_work_group_count[0]
                    .min(limits.max_compute_work_group_count[1]),
                edges: MOST_TESTS,
            },
            brute_force: found(BRUTE_FORCE, "brute_force")?,
            patches: found(PATCHES, "patches_and_edges")?,
            super_patches: found(SUPER_PATCHES, "super_patches_to_edges")?,
            tally: Pipeline::compute(device, ("totals", TALLY, "tally"), &[&model, &tally])?,
            device: device.clone(),
        })
    }

    /// The device it was made for.
    pub fn device(&self) -> &Device {
        &self.device
    }

    pub(crate) fn limits(&self) -> PlanLimits {
        self.limits
    }

    /// Records what `contours` was prepared for, once. Outside of rendering.
    ///
    /// # Errors
    /// If the commands are of another device, or not those that the contours were prepared in.
    pub fn record(&self, commands: &mut Commands, contours: &Contours) -> Result<(), Error> {
        commands.check(&self.device, "the extractor")?;
        contours.input.check(commands)?;
        for (index, dispatch) in contours.dispatches.iter().enumerate() {
            let pipeline = match dispatch.stage {
                Stage::Edges => &self.brute_force,
                Stage::Patches => &self.patches,
                Stage::SuperPatches => &self.super_patches,
            };
            let model = (contours.model().bindings(dispatch.chunk), &[][..]);
            let offset = [contours.input.offset(index)];
            commands.bind(pipeline, &[model, (&contours.work_set, &offset)]);
            commands.dispatch(dispatch.grid);
            commands.barrier(Use::WRITTEN_BY_COMPUTE, Use::USED_BY_COMPUTE);
            commands.bind(&self.tally, &[model, (&contours.tally_set, &offset)]);
            commands.dispatch([1, 1]);
            commands.barrier(Use::WRITTEN_BY_COMPUTE, Use::USED_BY_COMPUTE);
        }
        let after = Use::READ_AS_ARGUMENTS.and(Use::READ_BY_DRAWING).and(Use::COPIED_FROM);
        commands.barrier(Use::WRITTEN_BY_COMPUTE, after);
        Ok(())
    }
}
