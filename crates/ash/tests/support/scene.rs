//! What is drawn: three instances of a model, and to what.
#![allow(dead_code, reason = "each test program uses what it needs")]

use ash::vk;
use drypoint_ash::{Attached, Capacity, Gpu, Model, Placement};
use drypoint_fusion::PatchSet;
use drypoint_mesh::Viewpoint;
use glam::dcamera::rh::{proj::directx::perspective, view::look_at_mat4};
use glam::{DAffine3, DVec3, Mat4};

pub(crate) const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;
pub(crate) const SIZE: [u32; 2] = [300, 200];

pub(crate) const ATTACHED: Attached = Attached { color: FORMAT, depth: None };

/// Three instances beside one another, and the matrix to clip space.
pub(crate) fn scene() -> (Vec<Placement>, Mat4) {
    let eye = DVec3::new(1.0, 2.0, 9.0);
    let place = |x: f64| Placement {
        to_scene: DAffine3::from_translation(DVec3::new(x, 0.0, 0.2 * x)),
        viewpoint: Viewpoint::at(eye),
    };
    let lens = perspective(0.8, f64::from(SIZE[0]) / f64::from(SIZE[1]), 1.0, 30.0);
    let scene_to_clip = (lens * look_at_mat4(eye, DVec3::ZERO, DVec3::Y)).as_mat4();
    ([-2.5, 0.0, 2.5].map(place).to_vec(), scene_to_clip)
}

pub(crate) fn model(gpu: &Gpu, set: &PatchSet) -> Model {
    gpu.run(|commands| Model::new(commands, &[set])).expect("there is memory").0
}

pub(crate) const CAPACITY: Capacity = Capacity { placements: 3, segments: 20_000 };
