//! Pipelines for what is loose of a rig.

use drypoint_shaders::{RIG_EDGES, RIG_FACES, RIG_VERTICES, RigCounts, Work, prelude};

use crate::bindings::{READ, WRITE, layout, uniform};
use crate::extractor::pipeline;

/// A pipeline, and the layouts of what it reads of a model and of a frame.
#[derive(Debug)]
pub(crate) struct RigPipeline {
    pub(crate) pipeline: wgpu::ComputePipeline,
    pub(crate) model_layout: wgpu::BindGroupLayout,
    pub(crate) frame_layout: wgpu::BindGroupLayout,
}

/// The pipelines of one device.
#[derive(Debug)]
pub(crate) struct RigPipelines {
    pub(crate) vertices: RigPipeline,
    pub(crate) faces: RigPipeline,
    pub(crate) edges: RigPipeline,
}

impl RigPipelines {
    pub(crate) fn build(device: &wgpu::Device, width: u32) -> Self {
        let make =
            |entry, source: &str, model: &[wgpu::BindingType], frame: &[wgpu::BindingType]| {
                let layout = |types: &[wgpu::BindingType]| {
                    layout(device, entry, wgpu::ShaderStages::COMPUTE, types)
                };
                let model_layout = layout(&[&[uniform::<RigCounts>(false)], model].concat());
                let frame_layout = layout(&[&[uniform::<Work>(true)], frame].concat());
                let layouts = [Some(&model_layout), Some(&frame_layout)];
                let pipeline = pipeline(device, &layouts, &(prelude(width) + source), entry);
                RigPipeline { pipeline, model_layout, frame_layout }
            };
        Self {
            vertices: make("pose_vertices", RIG_VERTICES, &[READ; 3], &[READ, READ, WRITE]),
            faces: make("find_sides", RIG_FACES, &[READ; 2], &[READ, READ, READ, WRITE]),
            edges: make("test_loose_edges", RIG_EDGES, &[READ], &[WRITE, READ, WRITE]),
        }
    }
}
