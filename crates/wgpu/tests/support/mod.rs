//! A device with the validation layers on, and what they say.

use std::sync::{Mutex, MutexGuard, OnceLock};

use drypoint_wgpu::Gpu;

/// Warnings and errors of wgpu and of the validation layers, all tests of one program together.
static MESSAGES: Mutex<Vec<String>> = Mutex::new(Vec::new());

struct Listener;

impl log::Log for Listener {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.level() <= log::Level::Warn
    }

    fn log(&self, record: &log::Record<'_>) {
        if self.enabled(record.metadata()) {
            messages().push(format!("{}: {}", record.target(), record.args()));
        }
    }

    fn flush(&self) {}
}

/// What was said so far.
pub(crate) fn messages() -> MutexGuard<'static, Vec<String>> {
    MESSAGES.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Fails if anything was said.
#[track_caller]
pub(crate) fn expect_silence() {
    let said = messages();
    assert!(said.is_empty(), "the validation layers have something to say: {said:#?}");
}

/// Whether the machine says that it has no GPU, not even software: tests are passed over then. Without
/// that, having none is a failure.
pub(crate) fn is_without_gpu() -> bool {
    std::env::var_os("DRYPOINT_NO_GPU").is_some_and(|value| value == "1")
}

/// A device with validation, and limits lowered by `adjust`.
pub(crate) fn gpu_with(adjust: &dyn Fn(&mut wgpu::Limits)) -> Gpu {
    static LISTENING: OnceLock<()> = OnceLock::new();
    LISTENING.get_or_init(|| {
        log::set_logger(&Listener).expect("no test has another");
        log::set_max_level(log::LevelFilter::Warn);
    });
    // Without DEBUG: source in SPIR-V is more than old layers understand.
    match Gpu::request_with(wgpu::InstanceFlags::VALIDATION, adjust) {
        Ok(gpu) => gpu,
        Err(error) => panic!(
            "{error}; install a Vulkan driver, as Mesa's software one (Debian: mesa-vulkan-drivers), or \
             set DRYPOINT_NO_GPU=1 to pass over the GPU tests"
        ),
    }
}

pub(crate) fn gpu() -> Gpu {
    gpu_with(&|_| {})
}
