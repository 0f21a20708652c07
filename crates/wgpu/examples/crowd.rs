//! What a crowd takes: the contours of many animated characters, each in a pose of its own, seen from one viewpoint.
//!
//! ```sh
//! cargo run --release -p drypoint-wgpu --example crowd -- BrainStem.glb 252
//! ```
//!
//! Medians of 60 frames, through patches and without in turn: the processor's time to record a frame, poses not
//! counted, and the GPU's to find the contours.
#![allow(clippy::print_stdout, reason = "the times are what this program is for")]

use std::error::Error;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use drypoint_fusion::{CostModel, FusionParams, fuse_shapes};
use drypoint_mesh::rig::{Pose, Skin};
use drypoint_mesh::{EdgeFilter, Viewpoint, io};
use drypoint_wgpu::{
    Extractor, Gpu, Method, Placement, RigCapacity, RigContours, RigInstance, RigModel, Statistics,
    Timer,
};
use glam::{DAffine3, DVec3};

const FRAMES: usize = 60;

/// What one way takes.
struct Measured {
    method: Method,
    recording: Vec<Duration>,
    extraction: Vec<Duration>,
    /// Of the last frame.
    statistics: Statistics,
}

impl Measured {
    fn report(self) -> Result<(), Box<dyn Error>> {
        let Self { method, recording, extraction, statistics } = self;
        if let Some(needed) = statistics.overflow() {
            return Err(format!("{needed} contour edges do not fit").into());
        }
        let [recording, extraction] = [recording, extraction].map(median);
        let (found, tested) = (statistics.segments, statistics.edges_tested);
        println!(
            "{method:?}: {recording:.1?} to record, {extraction:.1?} on the GPU; {found} contour edges of {tested} tested"
        );
        Ok(())
    }
}

/// The median.
fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times[times.len() / 2]
}

/// One instance beside another in as many rows as columns, as far apart as they are large, and a viewpoint before them.
fn rows(center: DVec3, size: f64, count: u32) -> Vec<Placement> {
    let row = f64::from(count).sqrt().ceil();
    let viewpoint = Viewpoint::at(center + DVec3::new(0.0, size, (row + 1.0) * size));
    let place = |index: u32| {
        let index = f64::from(index);
        let [x, z] = [index % row - 0.5 * row, -(index / row).floor()];
        let to_scene = DAffine3::from_translation(size * DVec3::new(x, 0.0, z));
        Placement { to_scene, viewpoint }
    };
    (0..count).map(place).collect()
}

/// Records what `prepare` prepares, and waits until it is found: how long either took.
fn timed<'a>(
    gpu: &Gpu,
    extractor: &Extractor,
    timer: &mut Timer,
    prepare: impl FnOnce(&mut wgpu::CommandEncoder) -> Result<&'a RigContours, Box<dyn Error>>,
) -> Result<[Duration; 2], Box<dyn Error>> {
    let start = Instant::now();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let contours = prepare(&mut encoder)?;
    let timestamp_writes = Some(timer.compute_pass());
    let descriptor = wgpu::ComputePassDescriptor { label: None, timestamp_writes };
    extractor.record_rig(&mut encoder.begin_compute_pass(&descriptor), contours);
    timer.request(&mut encoder);
    let commands = encoder.finish();
    let recorded = start.elapsed();
    gpu.queue.submit([commands]);
    gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok([recorded, timer.newest().ok_or("the GPU did not tell the time")?])
}

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let count = args.get(1).and_then(|count| count.parse().ok()).filter(|&count| count > 0);
    let ([model, _], Some(count)) = (&args[..], count) else {
        return Err("crowd MODEL.glb COUNT".into());
    };
    let rig = io::read(model.as_ref())
        .map_err(|error| format!("{model}: {error}"))?
        .rig
        .ok_or("nothing in the model moves")?;
    if rig.animations().is_empty() {
        return Err("the model has no animation".into());
    }
    let skin = Skin::new(&rig)?;
    let params = FusionParams { cost: CostModel::GPU, ..FusionParams::DEFAULT };
    let go_on = |_| ControlFlow::Continue(());
    let patches = fuse_shapes(&skin, EdgeFilter::Convex, &params, &go_on)?;

    let gpu = Gpu::request()?;
    let extractor = Extractor::new(&gpu.device)?;
    let model = RigModel::new(&extractor, &rig, &skin, &patches)?;
    let capacity = RigCapacity { instances: count, segments: 1 << 23 };
    let mut contours = RigContours::new(&extractor, &model, capacity)?;
    let mut timer = Timer::new(&gpu.device, &gpu.queue)?;

    let bounds = rig.mesh(&rig.rest())?.bounds().ok_or("the model is empty")?;
    let placements = rows(bounds.center(), (bounds.max - bounds.min).as_dvec3().length(), count);
    let mut measured = [Method::BruteForce, Method::Patches].map(|method| Measured {
        method,
        recording: Vec::new(),
        extraction: Vec::new(),
        statistics: Statistics::default(),
    });
    // The first frame is that of a driver that gets ready.
    for frame in 0..=FRAMES {
        let seconds = |index: u32| frame as f64 / 60.0 + f64::from(index) * 0.037;
        let poses: Vec<Pose> = (0..count).map(|index| rig.pose_at(0, seconds(index))).collect();
        let instance = |(pose, &placement)| RigInstance { pose, placement };
        let instances: Vec<_> = poses.iter().zip(&placements).map(instance).collect();
        for Measured { method, recording, extraction, statistics } in &mut measured {
            let [recorded, found] = timed(&gpu, &extractor, &mut timer, |encoder| {
                contours.prepare(encoder, &instances, *method)?;
                Ok(&contours)
            })?;
            if frame > 0 {
                recording.push(recorded);
                extraction.push(found);
            }
            *statistics = contours.read_statistics(&gpu.queue)?;
        }
    }
    println!("{}, {count} instances", gpu.name());
    measured.into_iter().try_for_each(Measured::report)
}
