//! Pipelines, and how a frame's work is recorded with them.

use std::sync::{Arc, OnceLock};

use drypoint_shaders::{
    BRUTE_FORCE, PATCHES, POSITIONS, PlanLimits, SUPER_PATCHES, Stage, TALLY, USUAL_WIDTH, WIDTHS,
    Work, prelude,
};

use crate::Error;
use crate::bindings::{READ, WRITE, layout, uniform};
use crate::contours::Contours;
use crate::device::checked;
use crate::rig_contours::RigContours;
use crate::rig_pipelines::RigPipelines;

/// How shaders are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExtractorOptions {
    /// Lanes in a workgroup, a power of two from 32 to 256. What the device allows is the most it gets.
    pub width: u32,
}

impl Default for ExtractorOptions {
    fn default() -> Self {
        Self { width: USUAL_WIDTH }
    }
}

/// Finds contour edges: the pipelines of one device, to be made once.
#[derive(Debug)]
pub struct Extractor {
    device: wgpu::Device,
    limits: PlanLimits,
    model_layout: wgpu::BindGroupLayout,
    work_layout: wgpu::BindGroupLayout,
    tally_layout: wgpu::BindGroupLayout,
    placing_layout: wgpu::BindGroupLayout,
    brute_force: wgpu::ComputePipeline,
    patches: wgpu::ComputePipeline,
    super_patches: wgpu::ComputePipeline,
    tally: wgpu::ComputePipeline,
    placing: wgpu::ComputePipeline,
    /// Made with the first rig.
    rig: OnceLock<Arc<RigPipelines>>,
}

impl Extractor {
    /// Compiles the shaders, with [`ExtractorOptions::default`]. Milliseconds, or seconds on some drivers.
    ///
    /// # Errors
    /// If the device has not what plain WebGPU has, or the driver refuses a shader.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Self::with_options(device, &ExtractorOptions::default())
    }

    /// The same with options of one's own.
    ///
    /// # Errors
    /// As [`Extractor::new`].
    pub fn with_options(device: &wgpu::Device, options: &ExtractorOptions) -> Result<Self, Error> {
        let given = device.limits();
        if given.max_storage_buffers_per_shader_stage < 7 {
            let feature = "seven storage buffers in a shader";
            return Err(Error::MissingFeature { feature, what: "extraction" });
        }
        let most =
            given.max_compute_invocations_per_workgroup.min(given.max_compute_workgroup_size_x);
        let fits = |width: &u32| *width <= most.min(options.width.max(WIDTHS[0]));
        let Some(width) = WIDTHS.into_iter().rev().find(fits) else {
            let feature = "workgroups of 32 lanes";
            return Err(Error::MissingFeature { feature, what: "extraction" });
        };
        checked(device, "the shaders of extraction", || Self::build(device, width))
    }

    fn build(device: &wgpu::Device, width: u32) -> Self {
        let layout = |label, types: &[wgpu::BindingType]| {
            layout(device, label, wgpu::ShaderStages::COMPUTE, types)
        };
        let work = uniform::<Work>(true);
        let model_layout = layout("a model", &[READ; 4]);
        let work_layout = layout("extraction", &[work, WRITE, READ, WRITE]);
        let tally_layout = layout("totals", &[work, WRITE, WRITE, WRITE]);
        let placing_layout = layout("placed segments", &[READ, READ, READ, READ, WRITE]);
        let of_extraction = [Some(&model_layout), Some(&work_layout)];
        let extraction = |source: &str, entry: &str| {
            pipeline(device, &of_extraction, &(prelude(width) + source), entry)
        };
        let limits = PlanLimits {
            width,
            row: device.limits().max_compute_workgroups_per_dimension,
            edges: 1 << 28,
        };
        Self {
            limits,
            brute_force: extraction(BRUTE_FORCE, "brute_force"),
            patches: extraction(PATCHES, "patches_and_edges"),
            super_patches: extraction(SUPER_PATCHES, "super_patches_to_edges"),
            tally: pipeline(device, &[None, Some(&tally_layout)], TALLY, "tally"),
            placing: pipeline(device, &[Some(&placing_layout)], POSITIONS, "place_segments"),
            device: device.clone(),
            rig: OnceLock::new(),
            model_layout,
            work_layout,
            tally_layout,
            placing_layout,
        }
    }

    /// Records what `contours` was prepared for. Any number of them may share a pass, which may be timed
    /// ([`Timer`](crate::Timer)). The pass must come after [`Contours::prepare`] in the order of submission.
    ///
    /// Some microseconds on the CPU, unless the work has to be split.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>, contours: &Contours) {
        for (index, dispatch) in contours.dispatches.iter().enumerate() {
            let offset = contours.work_offset(index);
            pass.set_pipeline(self.of_stage(dispatch.stage));
            pass.set_bind_group(0, &contours.model().content.bindings[dispatch.chunk], &[]);
            pass.set_bind_group(1, &contours.work_bindings, &[offset]);
            pass.dispatch_workgroups(dispatch.grid[0], dispatch.grid[1], 1);
            self.tally(pass, &contours.tally_bindings, offset);
        }
    }

    /// The same of a rig. Both kinds may share a pass.
    pub fn record_rig(&self, pass: &mut wgpu::ComputePass<'_>, contours: &RigContours) {
        contours.record(self, pass);
    }

    pub(crate) fn of_stage(&self, stage: Stage) -> &wgpu::ComputePipeline {
        match stage {
            Stage::Edges => &self.brute_force,
            Stage::Patches => &self.patches,
            Stage::SuperPatches => &self.super_patches,
        }
    }

    /// Records what comes after a dispatch that finds contour edges.
    pub(crate) fn tally(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        bindings: &wgpu::BindGroup,
        offset: u32,
    ) {
        pass.set_pipeline(&self.tally);
        pass.set_bind_group(1, bindings, &[offset]);
        pass.dispatch_workgroups(1, 1, 1);
    }

    /// The shaders of rigs, compiled when they are first asked for.
    pub(crate) fn rig_pipelines(&self) -> Result<Arc<RigPipelines>, Error> {
        if let Some(known) = self.rig.get() {
            return Ok(Arc::clone(known));
        }
        let made = checked(&self.device, "the shaders of rigs", || {
            RigPipelines::build(&self.device, self.limits.width)
        })?;
        Ok(Arc::clone(self.rig.get_or_init(|| Arc::new(made))))
    }

    /// The device it was made for.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Lanes in a workgroup.
    pub fn width(&self) -> u32 {
        self.limits.width
    }

    pub(crate) fn plan_limits(&self) -> PlanLimits {
        self.limits
    }

    pub(crate) fn model_layout(&self) -> &wgpu::BindGroupLayout {
        &self.model_layout
    }

    pub(crate) fn work_layout(&self) -> &wgpu::BindGroupLayout {
        &self.work_layout
    }

    pub(crate) fn tally_layout(&self) -> &wgpu::BindGroupLayout {
        &self.tally_layout
    }

    pub(crate) fn placing_layout(&self) -> &wgpu::BindGroupLayout {
        &self.placing_layout
    }

    pub(crate) fn placing(&self) -> &wgpu::ComputePipeline {
        &self.placing
    }
}

pub(crate) fn pipeline(
    device: &wgpu::Device,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    source: &str,
    entry: &str,
) -> wgpu::ComputePipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(entry),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(entry),
        bind_group_layouts: layouts,
        immediate_size: 0,
    });
    // Shaders begin by writing what they read in workgroup memory.
    let compilation_options = wgpu::PipelineCompilationOptions {
        zero_initialize_workgroup_memory: false,
        ..Default::default()
    };
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(&layout),
        module: &module,
        entry_point: Some(entry),
        compilation_options,
        cache: None,
    })
}
