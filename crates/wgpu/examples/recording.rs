//! What the processor takes to record a frame of 252 instances: `recording [MODEL]`.
//!
//! Frames are recorded and dropped, not submitted: software Vulkan would draw them with the same processor,
//! whose caches would then hold nothing of ours.
#![allow(clippy::print_stdout, reason = "the times are what this program is for")]

use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

use drypoint_fusion::{CostModel, FusionParams, fuse};
use drypoint_mesh::{EdgeFilter, MeshAdjacency, Viewpoint, io, shapes};
use drypoint_wgpu::{Capacity, Contours, Extractor, Gpu, Method, Model, Placement};
use glam::{DAffine3, DVec3};

const INSTANCES: u32 = 252;
const FRAMES: usize = 2_000;

fn main() -> Result<(), Box<dyn Error>> {
    let mesh = match std::env::args().nth(1) {
        Some(path) => io::read(path.as_ref()).map_err(|error| format!("{path}: {error}"))?.mesh,
        None => shapes::torus_knot(20_000),
    };
    let adjacency = MeshAdjacency::new(&mesh);
    let params = FusionParams { cost: CostModel::GPU, ..FusionParams::FAST };
    let go_on = |_| ControlFlow::Continue(());
    let patches = fuse(&mesh, &adjacency, EdgeFilter::Convex, &params, &go_on)?;

    let gpu = Gpu::request()?;
    let extractor = Extractor::new(&gpu.device)?;
    let model = Model::new(&extractor, &[&patches])?;
    let capacity = Capacity { placements: INSTANCES, segments: 1 << 20 };
    let mut contours = Contours::new(&extractor, &model, capacity)?;

    let mut times = Vec::new();
    for frame in 0..FRAMES {
        let angle = frame as f64 * 0.01;
        let viewpoint = Viewpoint::at(DVec3::new(angle.cos(), 0.5, angle.sin()) * 20.0);
        let turned = |index| DAffine3::from_rotation_y(f64::from(index) + angle);
        let placed = |index| Placement { to_scene: turned(index), viewpoint };
        let placements: Vec<_> = (0..INSTANCES).map(placed).collect();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let start = Instant::now();
        contours.prepare(&mut encoder, &placements, Method::Patches)?;
        extractor.record(&mut encoder.begin_compute_pass(&Default::default()), &contours);
        let recorded = encoder.finish();
        times.push(start.elapsed());
        drop(recorded);
        gpu.device.poll(wgpu::PollType::Poll)?;
    }
    times.sort_unstable();
    let at = |share: usize| times[FRAMES * share / 100];
    println!(
        "{:.1?}, {:.1?} and {:.1?}: a quarter, half and nine in ten are below",
        at(25),
        at(50),
        at(90)
    );
    Ok(())
}
