//! A device with the validation layers on, and what they say.
#![allow(dead_code, reason = "each test program uses what it needs")]

#[path = "../../../../shaders/tests/support/mod.rs"]
mod shared;

use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use drypoint_mesh::EdgeId;
use drypoint_mesh::rig::Skin;
use drypoint_wgpu::{
    Contours, Error, Extractor, Gpu, Method, Placement, RigContours, RigInstance, Segment,
};

#[allow(unused_imports, reason = "each test program uses what it needs")]
pub(crate) use shared::{Expected, example, is_without_gpu, patches, placements};

/// Warnings and errors of wgpu and of the validation layers, all tests of one program together.
static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

struct Listener;

impl log::Log for Listener {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.level() <= log::Level::Warn
    }

    fn log(&self, record: &log::Record<'_>) {
        if !self.enabled(record.metadata()) {
            return;
        }
        let said = record.args().to_string();
        // What a message is about comes as one of its own. Layers older than WGSL's number in SPIR-V object to
        // the note of where a shader comes from, and then check it all the same.
        if !said.trim_start().starts_with("objects:")
            && !said.contains("Invalid source language operand: 10")
        {
            messages().push(format!("{}: {said}", record.target()));
        }
    }

    fn flush(&self) {}
}

/// What was said so far.
pub(crate) fn messages() -> MutexGuard<'static, Vec<String>> {
    MESSAGES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Fails if anything was said.
#[track_caller]
pub(crate) fn expect_silence() {
    let said = messages();
    assert!(said.is_empty(), "the validation layers have something to say: {said:#?}");
}

/// A device with validation, and limits lowered by `adjust`.
pub(crate) fn gpu_with(adjust: &dyn Fn(&mut wgpu::Limits)) -> Gpu {
    static LISTENING: OnceLock<()> = OnceLock::new();
    LISTENING.get_or_init(|| {
        log::set_logger(&Listener).expect("no test has another");
        log::set_max_level(log::LevelFilter::Warn);
    });
    // Without DEBUG, wgpu installs the layers but does not listen to them.
    let flags = wgpu::InstanceFlags::VALIDATION | wgpu::InstanceFlags::DEBUG;
    match Gpu::request_with(flags, adjust) {
        Ok(gpu) => gpu,
        Err(error) => panic!(
            "{error}; install a Vulkan driver, as Mesa's software one (Debian: mesa-vulkan-drivers), or \
             set DRYPOINT_NO_GPU=1 to pass over the GPU tests"
        ),
    }
}

/// A device with validation.
pub(crate) fn gpu() -> Gpu {
    gpu_with(&|_| {})
}

/// Records one extraction, submits it, and reads what it finds, sorted.
pub(crate) fn extract(
    gpu: &Gpu,
    extractor: &Extractor,
    contours: &mut Contours,
    placements: &[Placement],
    method: Method,
) -> Result<Vec<Segment>, Error> {
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    contours.prepare(&mut encoder, placements, method)?;
    extractor
        .record(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default()), contours);
    gpu.queue.submit([encoder.finish()]);
    let mut segments = contours.read_segments(&gpu.queue)?;
    segments.sort_unstable();
    Ok(segments)
}

/// The same of a rig: the edges of each instance, sorted.
pub(crate) fn extract_rig(
    gpu: &Gpu,
    extractor: &Extractor,
    (contours, skin): (&mut RigContours, &Skin),
    instances: &[RigInstance<'_>],
    method: Method,
) -> Result<Vec<Vec<EdgeId>>, Error> {
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    contours.prepare(&mut encoder, instances, method)?;
    let descriptor = wgpu::ComputePassDescriptor::default();
    extractor.record_rig(&mut encoder.begin_compute_pass(&descriptor), contours);
    gpu.queue.submit([encoder.finish()]);
    let mut found = vec![Vec::new(); instances.len()];
    for segment in contours.read_segments(&gpu.queue)? {
        let edge = contours.edge(skin, &segment);
        found[edge.instance as usize].push(edge.edge);
    }
    found.iter_mut().for_each(|edges| edges.sort_unstable());
    Ok(found)
}
