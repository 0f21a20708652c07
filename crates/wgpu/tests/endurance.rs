//! Frame after frame: no memory grows, nothing waits, and what goes wrong is an error.

mod support;

use std::time::Duration;

use drypoint_fusion::Levels;
use drypoint_mesh::{Viewpoint, shapes};
use drypoint_wgpu::{Capacity, Contours, Error, Extractor, Gpu, Method, Model, Placement, Timer};
use glam::DVec3;
use support::patches;

const FRAMES: u32 = 10_000;

fn setup(gpu: &Gpu) -> (Extractor, Contours) {
    let extractor = Extractor::new(&gpu.device).expect("shaders compile");
    let set = patches(&shapes::icosphere(80), Levels::One);
    let model = Model::new(&extractor, &[&set]).expect("there is memory");
    let capacity = Capacity { placements: 2, segments: 500 };
    let contours = Contours::new(&extractor, &model, capacity).expect("there is memory");
    (extractor, contours)
}

fn orbit(frame: u32) -> [Placement; 2] {
    let angle = f64::from(frame) * 0.01;
    [3.0, 8.0].map(|distance| {
        let from = DVec3::new(angle.cos(), 0.3, angle.sin()) * distance;
        Placement::at_origin(Viewpoint::at(from))
    })
}

/// Resident memory of this process, in bytes.
fn resident() -> u64 {
    let system = sysinfo::System::new_with_specifics(
        sysinfo::RefreshKind::nothing()
            .with_processes(sysinfo::ProcessRefreshKind::nothing().with_memory()),
    );
    let this = sysinfo::get_current_pid().expect("there is a process");
    system.process(this).expect("it runs").memory()
}

#[test]
fn ten_thousand_frames_take_no_more_memory_than_a_hundred() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    let (extractor, mut contours) = setup(&gpu);
    let mut timer = Timer::new(&gpu.device, &gpu.queue).expect("software Vulkan has time stamps");
    let (mut statistics_seen, mut times_seen, mut longest) = (0, 0, Duration::ZERO);
    let (mut settled, mut objects) = (0, None);
    for frame in 0..FRAMES {
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        contours.prepare(&mut encoder, &orbit(frame), Method::Patches).expect("it fits");
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: None,
                timestamp_writes: Some(timer.compute_pass()),
            });
            extractor.record(&mut pass, &contours);
        }
        contours.request_statistics(&mut encoder);
        timer.request(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        if let Some(statistics) = contours.newest_statistics() {
            statistics_seen += 1;
            assert!(statistics.segments > 0 && statistics.overflow().is_none());
        }
        if let Some(time) = timer.newest() {
            times_seen += 1;
            longest = longest.max(time);
        }
        // As presenting would: frames do not pile up.
        if frame % 2 == 1 {
            gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device is there");
        }
        if frame == 1_000 {
            settled = resident();
            objects = Some(contours.staging_buffers());
        }
    }
    assert!(statistics_seen > FRAMES / 8, "{statistics_seen} statistics came");
    assert!(times_seen > FRAMES / 8, "{times_seen} times came");
    assert!(longest > Duration::ZERO);
    assert_eq!(Some(contours.staging_buffers()), objects);
    let grown = resident().saturating_sub(settled);
    // Nine thousand frames that kept a kilobyte each would be three times as much.
    assert!(grown < 3 << 20, "{grown} bytes more after {FRAMES} frames");
    support::expect_silence();
}

/// What a surface that is lost after recording does, or an error on the way to `submit`.
#[test]
fn encoders_that_are_dropped_keep_nothing() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    let (extractor, mut contours) = setup(&gpu);
    let mut timer = Timer::new(&gpu.device, &gpu.queue).expect("software Vulkan has time stamps");
    let mut frame = |index: u32, is_submitted: bool| {
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        contours.prepare(&mut encoder, &orbit(index), Method::Patches).expect("it fits");
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: None,
                timestamp_writes: Some(timer.compute_pass()),
            });
            extractor.record(&mut pass, &contours);
        }
        contours.request_statistics(&mut encoder);
        timer.request(&mut encoder);
        if is_submitted {
            gpu.queue.submit([encoder.finish()]);
        } else {
            drop(encoder);
        }
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device is there");
        let arrived = [contours.newest_statistics().is_some(), timer.newest().is_some()];
        (arrived, contours.staging_buffers())
    };
    let (arrived, staging) = frame(0, true);
    assert_eq!(arrived, [true; 2]);
    for index in 1..50 {
        assert_eq!(frame(index, false), ([false; 2], staging));
    }
    for index in 50..60 {
        assert_eq!(frame(index, true), ([true; 2], staging));
    }
    support::expect_silence();
}

#[test]
fn a_lost_device_is_an_error() {
    if support::is_without_gpu() {
        return;
    }
    let gpu = support::gpu();
    let (extractor, mut contours) = setup(&gpu);
    let found = support::extract(&gpu, &extractor, &mut contours, &orbit(0), Method::Patches);
    found.expect("the device is there");
    gpu.device.destroy();
    let found = support::extract(&gpu, &extractor, &mut contours, &orbit(1), Method::Patches);
    assert_eq!(found, Err(Error::DeviceLost));
    let set = patches(&shapes::icosphere(80), Levels::One);
    let error = Model::new(&extractor, &[&set]).expect_err("the device is lost");
    assert_eq!(error, Error::DeviceLost);
}
