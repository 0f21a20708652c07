//! What a device lacks is an error, not a panic.

mod support;

use drypoint_wgpu::{Error, Extractor, ExtractorOptions, Timer};

#[test]
fn what_a_device_lacks_is_named() {
    if support::is_without_gpu() {
        return;
    }
    let few = support::gpu_with(&|limits| limits.max_storage_buffers_per_shader_stage = 6);
    let error = Extractor::new(&few.device).expect_err("it takes seven");
    let feature = "seven storage buffers in a shader";
    assert_eq!(error, Error::MissingFeature { feature, what: "extraction" });

    let narrow = support::gpu_with(&|limits| limits.max_compute_invocations_per_workgroup = 16);
    let error = Extractor::new(&narrow.device).expect_err("it takes 32 lanes");
    let feature = "workgroups of 32 lanes";
    assert_eq!(error, Error::MissingFeature { feature, what: "extraction" });

    // As wide as the device allows.
    let narrow = support::gpu_with(&|limits| limits.max_compute_invocations_per_workgroup = 128);
    let options = ExtractorOptions { width: 256 };
    let extractor = Extractor::with_options(&narrow.device, &options).expect("shaders compile");
    assert_eq!(extractor.width(), 128);

    let descriptor = wgpu::DeviceDescriptor::default();
    let plain = pollster::block_on(few.adapter.request_device(&descriptor));
    let (device, queue) = plain.expect("it needs nothing");
    let error = Timer::new(&device, &queue).expect_err("it needs time stamps");
    assert_eq!(error, Error::MissingFeature { feature: "time stamps", what: "a timer" });
    // Plain WebGPU is enough for the rest.
    Extractor::new(&device).expect("shaders compile");
    support::expect_silence();
}
