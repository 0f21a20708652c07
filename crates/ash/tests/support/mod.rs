//! A device with the validation layers on, and what they say.
#![allow(dead_code, reason = "each test program uses what it needs")]

#[path = "../../../../shaders/tests/support/mod.rs"]
mod shared;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use drypoint_ash::{Error, Gpu, GpuOptions, Limits};

#[allow(unused_imports, reason = "each test program uses what it needs")]
pub(crate) use shared::{Expected, example, is_without_gpu, patches, placements};

/// Warnings and errors of the validation layers, all tests of one program together.
static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

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

/// As many primitives as contour edges, where nothing is drawn: NVIDIA's driver 580 counts none there.
#[track_caller]
pub(crate) fn expect_primitives(gpu: &Gpu, counted: u64, contour_edges: u64, what: &str) {
    let counts_none = !gpu.device().is_software() && counted == 0;
    assert!(counts_none || counted == contour_edges, "{what}: {counted} for {contour_edges}");
}

/// A device with validation.
pub(crate) fn gpu() -> Gpu {
    gpu_with(None)
}

/// The same with lower limits.
pub(crate) fn gpu_with(lower: Option<fn(&mut Limits)>) -> Gpu {
    let listener: drypoint_ash::Listener =
        Arc::new(|message: &str| messages().push(message.to_owned()));
    let options = GpuOptions { listener: Some(listener), lower, ..GpuOptions::default() };
    match Gpu::request_with(&options) {
        Ok(gpu) => gpu,
        Err(Error::NoValidation) => panic!(
            "{}; install it (Debian: vulkan-validationlayers), or set DRYPOINT_NO_GPU=1 to pass over the GPU \
             tests",
            Error::NoValidation
        ),
        Err(error) => panic!(
            "{error}; install a Vulkan driver, as Mesa's software one from 25 on (Debian: \
             mesa-vulkan-drivers of the backports), or set DRYPOINT_NO_GPU=1 to pass over the GPU tests"
        ),
    }
}
